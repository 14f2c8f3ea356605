/**
 * @file bare_metal.c
 * A memory-mapped card (AXI4-Lite, APB, Wishbone) without an operating system: reads positions and a parameter, and handles an encoder that is unplugged
 * and plugged in again.
 *
 *   cc -std=c99 -DENDAT_BASE=MY_CARD_BASE_ADDRESS -DENDAT_HASH=MY_CARD_CARD_CONFIGURATION_HASH_RESET -include my_card_registers.h ...
 */
#include "endat.h"
#include <stddef.h>

#ifndef ENDAT_BASE
#define ENDAT_BASE 0x43C00000u
#endif
#ifndef ENDAT_HASH
#define ENDAT_HASH 0u /* any card */
#endif

/* Board functions: a microsecond counter, and a consumer of positions. Replace both. */
uint32_t board_us(void);
void board_take_position(uint32_t channel, int64_t position, bool is_good);
void board_tell(const char *what, const char *text);

/* A word of the card on a byte-addressed bus. Device memory: no cache, no reordering. */
static volatile uint32_t *word_at(void *context, uint32_t word_address)
{
    return (volatile uint32_t *)context + word_address;
}

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    *value = *word_at(context, word_address);
    return ENDAT_OK;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    *word_at(context, word_address) = value;
    return ENDAT_OK;
}

static uint32_t now_us(void *context)
{
    (void)context;
    return board_us();
}

/* Reads the data of the encoder once. */
static void look_at_the_encoder(const endat_card *card, uint32_t channel)
{
    endat_answer answer;
    /* Word 13 of the encoder's memory: number of position bits. */
    const endat_error error = endat_read_parameter(card, channel, 0xA1u, 0x0Du, 500u, &answer);

    if (error == ENDAT_ERROR_REFUSED) {
        board_tell("parameter", endat_refusal_text(answer.refusal));
    } else if ((error != ENDAT_OK) && (error != ENDAT_ERROR_PART)) {
        board_tell("parameter", endat_error_text(error));
    } else {
        /* answer.data has the word, on a card with requests. */
    }
}

/* One turn of the control loop. */
static void step(const endat_card *card)
{
    endat_moment moment;
    endat_error error = endat_measure(card, &moment, 1000u);
    uint32_t n;

    if ((error != ENDAT_OK) && (error != ENDAT_ERROR_TIMEOUT)) {
        board_tell("card", endat_error_text(error));
        return;
    }
    for (n = 0u; n < moment.channels; n++) {
        const endat_result *const result = &moment.channel[n];
        const bool is_good = result->fresh && !result->stale;

        board_take_position(n, endat_signed(result->position, result->width_bits), is_good);
        if (!is_good && (result->cause != 0u)) {
            board_tell(endat_cause_text(result->cause), endat_cause_remedy(result->cause));
        }
        /* The card recovers automatically when the encoder is plugged in; until then its triggers are lost. */
        if (!is_good && (endat_status(card, n) == ENDAT_ERROR_UNPLUGGED)) {
            board_tell("encoder", endat_error_text(ENDAT_ERROR_UNPLUGGED));
            if (endat_wait_ready(card, n, 5000u) == ENDAT_OK) {
                look_at_the_encoder(card, n);
            }
        }
    }
}

/** Returns only if no card is found. */
void endat_run(void)
{
    const endat_link link = {(void *)(uintptr_t)ENDAT_BASE, read_word, write_word, NULL, now_us, NULL};
    endat_card card;
    endat_error error = endat_open(&card, &link, ENDAT_HASH);
    uint32_t n;

    if (error == ENDAT_OK) {
        error = endat_try_link(&card);
    }
    for (n = 0u; (n < card.channels) && (error == ENDAT_OK); n++) {
        if (endat_wait_ready(&card, n, 5000u) == ENDAT_OK) {
            look_at_the_encoder(&card, n);
        }
    }
    if (error == ENDAT_OK) {
        error = endat_set_triggers(&card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK, 0u);
    }
    if (error != ENDAT_OK) {
        board_tell("card", endat_error_text(error));
        return;
    }
    for (;;) {
        step(&card);
    }
}
