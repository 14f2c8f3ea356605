/**
 * @file endat_t_format.c
 * The port of a T-format encoder: requests in addition to triggers, the encoder's EEPROM, settings.
 */
#include "endat.h"
#include "endat_internal.h"

/** Upper limit of an exchange: the longest configurable pauses, and all fields at the slowest bit rate. */
#define EXCHANGE_US 2000u

/** Waits until a bit of the answer is set, or cleared. */
static endat_error answer_when(const endat_card *card, uint32_t channel, uint32_t mask, bool is_set, endat_wait *wait, uint32_t *answer)
{
    bool is_in_time = true;
    endat_error error = ENDAT_ERROR_BUSY;

    while (error == ENDAT_ERROR_BUSY) {
        error = endat_read_word(card, ENDAT_MAP_T_FORMAT_ANSWER_WORD(channel), answer);
        if ((error == ENDAT_OK) && (((*answer & mask) != 0u) != is_set)) {
            /* The last poll comes after the last pause. */
            error = is_in_time ? ENDAT_ERROR_BUSY : ENDAT_ERROR_TIMEOUT;
            is_in_time = is_in_time && endat_wait_more(wait, ENDAT_REQUEST_PAUSE_US);
        }
    }
    return error;
}

/** A request word; its parts fit. */
static uint32_t request_word(uint32_t id, uint32_t address, uint32_t data)
{
    return ENDAT_MAP_PUT(ENDAT_MAP_T_FORMAT_SEND_ID, id) | ENDAT_MAP_PUT(ENDAT_MAP_T_FORMAT_SEND_ADDRESS, address) |
           ENDAT_MAP_PUT(ENDAT_MAP_T_FORMAT_SEND_DATA, data);
}

/** Sends a request when none is pending, and waits for the end of the exchange. */
static endat_error exchange_once(const endat_card *card, uint32_t channel, uint32_t request, uint32_t *answer)
{
    endat_wait wait;
    endat_error error = endat_write_word(card, ENDAT_MAP_T_FORMAT_SEND_WORD(channel), request);

    if (error == ENDAT_OK) {
        endat_wait_begin(&wait, card, EXCHANGE_US);
        error = answer_when(card, channel, ENDAT_MAP_T_FORMAT_ANSWER_DONE_MASK, true, &wait, answer);
    }
    return error;
}

/** True if a request clears something. */
static bool is_reset(uint32_t id)
{
    return (id == ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_ERRORS) || (id == ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_SINGLE_TURN) ||
           (id == ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_MULTI_TURN);
}

/** True if this cause comes with a good reply. */
static bool is_alarm(uint8_t cause)
{
    return (cause == ENDAT_CAUSE_COUNTING_ERROR) || (cause == ENDAT_CAUSE_MULTI_TURN_ALARM);
}

/** Makes sure that the previous answer, if any, has another ID than the next request. */
static endat_error tell_apart(const endat_card *card, uint32_t channel, uint32_t id, endat_wait *wait)
{
    uint32_t answer = 0u;
    endat_error error = answer_when(card, channel, ENDAT_MAP_T_FORMAT_ANSWER_BUSY_MASK, false, wait, &answer);
    const uint32_t other = (id == ENDAT_MAP_T_FORMAT_SEND_ID_ENCODER_ID) ? ENDAT_MAP_T_FORMAT_SEND_ID_SINGLE_TURN
                                                                         : ENDAT_MAP_T_FORMAT_SEND_ID_ENCODER_ID;
    const bool is_done = (answer & ENDAT_MAP_T_FORMAT_ANSWER_DONE_MASK) != 0u;

    /* Resets must be consecutive. */
    if ((error == ENDAT_OK) && is_done && (ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_ANSWER_ID, answer) == id) && !is_reset(id)) {
        error = exchange_once(card, channel, request_word(other, 0u, 0u), &answer);
    }
    return error;
}

static void clear_reply(endat_reply *reply)
{
    reply->cause = 0u;
    reply->id = 0u;
    reply->data = 0u;
}

static endat_error exchange_within(const endat_card *card, uint32_t channel, uint32_t request, endat_wait *wait, endat_reply *reply)
{
    const uint32_t id = ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_SEND_ID, request);
    uint32_t answer = 0u;
    bool is_in_time = true;
    bool is_lost = true;
    /* After a lost write the previous answer remains; another ID in between distinguishes it. */
    endat_error error = tell_apart(card, channel, id, wait);

    clear_reply(reply);
    while ((error == ENDAT_OK) && is_lost) {
        error = exchange_once(card, channel, request, &answer);
        if (error == ENDAT_OK) {
            reply->cause = endat_cause_of(ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_ANSWER_CAUSE, answer), ENDAT_PROTOCOL_T_FORMAT);
            reply->id = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_ANSWER_ID, answer);
            reply->data = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_ANSWER_DATA, answer);
            is_lost = (reply->id != id);
            if ((reply->cause != 0u) && !is_alarm(reply->cause)) {
                error = ENDAT_ERROR_EXCHANGE;
            } else if (is_lost && !is_in_time) {
                clear_reply(reply);
                error = ENDAT_ERROR_TIMEOUT;
            } else if (is_lost) {
                is_in_time = endat_wait_more(wait, ENDAT_REQUEST_PAUSE_US);
            } else {
                error = ENDAT_OK;
            }
        }
    }
    return error;
}

endat_error endat_exchange(const endat_card *card, uint32_t channel, uint32_t id, uint32_t address, uint32_t data, uint32_t limit_ms,
                           endat_reply *reply)
{
    endat_wait wait;
    endat_error error = endat_needs_t_format(card, channel);

    clear_reply(reply);
    if ((error == ENDAT_OK) && !(ENDAT_FITS(ENDAT_MAP_T_FORMAT_SEND_ID, id) && ENDAT_FITS(ENDAT_MAP_T_FORMAT_SEND_ADDRESS, address) &&
                                 ENDAT_FITS(ENDAT_MAP_T_FORMAT_SEND_DATA, data))) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        endat_wait_begin(&wait, card, endat_ms(limit_ms));
        error = exchange_within(card, channel, request_word(id, address, data), &wait, reply);
    }
    return error;
}

/** An exchange with the EEPROM, after the end of an earlier write. */
static endat_error eeprom(const endat_card *card, uint32_t channel, uint32_t request, endat_wait *wait, endat_reply *reply)
{
    endat_error error = exchange_within(card, channel, request, wait, reply);
    bool is_in_time = true;

    while ((error == ENDAT_ERROR_EXCHANGE) && (reply->cause == ENDAT_CAUSE_EEPROM_BUSY) && is_in_time) {
        is_in_time = endat_wait_more(wait, ENDAT_REQUEST_PAUSE_US);
        error = exchange_within(card, channel, request, wait, reply);
    }
    if ((error == ENDAT_ERROR_EXCHANGE) && (reply->cause == ENDAT_CAUSE_EEPROM_BUSY)) {
        error = ENDAT_ERROR_BUSY;
    }
    return error;
}

/** Checks for a T-format channel and a valid address. */
static endat_error needs_address(const endat_card *card, uint32_t channel, uint32_t address)
{
    endat_error error = endat_needs_t_format(card, channel);

    if ((error == ENDAT_OK) && !ENDAT_FITS(ENDAT_MAP_T_FORMAT_SEND_ADDRESS, address)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    return error;
}

endat_error endat_read_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint32_t limit_ms, endat_reply *reply)
{
    endat_wait wait;
    endat_error error = needs_address(card, channel, address);

    clear_reply(reply);
    if (error == ENDAT_OK) {
        endat_wait_begin(&wait, card, endat_ms(limit_ms));
        error = eeprom(card, channel, request_word(ENDAT_MAP_T_FORMAT_SEND_ID_READ_EEPROM, address, 0u), &wait, reply);
    }
    return error;
}

endat_error endat_write_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint8_t data, uint32_t limit_ms,
                               endat_reply *reply)
{
    endat_wait wait;
    endat_error error = needs_address(card, channel, address);

    clear_reply(reply);
    if (error == ENDAT_OK) {
        endat_wait_begin(&wait, card, endat_ms(limit_ms));
        error = eeprom(card, channel, request_word(ENDAT_MAP_T_FORMAT_SEND_ID_WRITE_EEPROM, address, data), &wait, reply);
    }
    if (error == ENDAT_OK) {
        error = eeprom(card, channel, request_word(ENDAT_MAP_T_FORMAT_SEND_ID_READ_EEPROM, address, 0u), &wait, reply);
    }
    if ((error == ENDAT_OK) && (reply->data != data)) {
        error = ENDAT_ERROR_READ_BACK;
    }
    return error;
}

/** Reset request, its limit, and the reply. */
typedef struct {
    uint32_t id;
    uint32_t limit_ms;
    endat_reply *reply;
} reset_request;

static endat_error reset_in_a_row(const endat_card *card, uint32_t channel, const void *what)
{
    const reset_request *const reset = (const reset_request *)what;
    uint32_t n;
    endat_error error = ENDAT_OK;

    for (n = 0u; (n < ENDAT_MAP_T_FORMAT_RESETS_IN_A_ROW) && (error == ENDAT_OK); n++) {
        error = endat_exchange(card, channel, reset->id, 0u, 0u, reset->limit_ms, reset->reply);
    }
    if (error == ENDAT_OK) {
        error = endat_exchange(card, channel, ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING, 0u, 0u, reset->limit_ms, reset->reply);
    }
    if ((error == ENDAT_OK) && (reset->reply->cause != 0u)) {
        error = ENDAT_ERROR_EXCHANGE;
    }
    return error;
}

endat_error endat_reset_encoder(const endat_card *card, uint32_t channel, uint32_t id, uint32_t limit_ms, endat_reply *reply)
{
    const reset_request what = {id, limit_ms, reply};
    endat_error error = endat_needs_t_format(card, channel);

    clear_reply(reply);
    if ((error == ENDAT_OK) && !is_reset(id)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_without_triggers(card, channel, reset_in_a_row, &what);
    }
    return error;
}

endat_error endat_read_fields(const endat_card *card, uint32_t channel, endat_fields *fields)
{
    uint32_t word = 0u;
    uint32_t parts = 0u;
    endat_error error = endat_needs_t_format(card, channel);

    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_T_FORMAT_FIELDS_WORD(channel), &word);
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_T_FORMAT_PARTS_WORD(channel), &parts);
    }
    fields->status = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_FIELDS_STATUS, word);
    fields->encoder_id = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_FIELDS_ENCODER_ID, word);
    fields->alarm = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_FIELDS_ALARM, word);
    fields->crc = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_FIELDS_CRC, word);
    fields->has_single_turn = ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_PARTS_SINGLE_VALID, parts) != 0u;
    fields->has_multi_turn = ENDAT_MAP_GET(ENDAT_MAP_T_FORMAT_PARTS_MULTI_VALID, parts) != 0u;
    return error;
}

endat_error endat_read_t_format_settings(const endat_card *card, uint32_t channel, endat_t_format_settings *settings)
{
    uint32_t words[ENDAT_SETTINGS_WORDS] = {0u, 0u, 0u};
    endat_error error = endat_needs_t_format(card, channel);

    if (error == ENDAT_OK) {
        error = endat_read_settings_words(card, channel, words);
    }
    settings->bit_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES, words[0]);
    settings->request_id = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_REQUEST_ID, words[1]);
    settings->filter_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, words[1]);
    settings->reply_gap_us = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US, words[2]);
    settings->field_gap_us = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_LIMITS_FIELD_GAP_US, words[2]);
    return error;
}

static bool are_allowed(const endat_t_format_settings *s)
{
    const bool is_bit = (s->bit_cycles >= ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_T_FORMAT_MIN) &&
                        (s->bit_cycles <= ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_T_FORMAT_MAX);
    const bool is_gap = (s->reply_gap_us >= ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_T_FORMAT_MIN) &&
                        (s->reply_gap_us <= ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_T_FORMAT_MAX);
    /* A trigger may neither access the EEPROM nor clear something. */
    const bool is_request = (s->request_id == ENDAT_MAP_T_FORMAT_SEND_ID_SINGLE_TURN) ||
                            (s->request_id == ENDAT_MAP_T_FORMAT_SEND_ID_MULTI_TURN) ||
                            (s->request_id == ENDAT_MAP_T_FORMAT_SEND_ID_ENCODER_ID) ||
                            (s->request_id == ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING);
    /* A filter of half a bit removes all bits. */
    const bool is_filter = ENDAT_FITS(ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, s->filter_cycles) &&
                           ((2u * s->filter_cycles) < s->bit_cycles);

    return is_bit && is_gap && is_request && is_filter && ENDAT_FITS(ENDAT_MAP_CONFIG_LIMITS_FIELD_GAP_US, s->field_gap_us);
}

endat_error endat_write_t_format_settings(const endat_card *card, uint32_t channel, const endat_t_format_settings *settings)
{
    uint32_t words[ENDAT_SETTINGS_WORDS] = {0u, 0u, 0u};
    endat_error error = endat_needs_t_format(card, channel);

    if ((error == ENDAT_OK) && !are_allowed(settings)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_read_settings_words(card, channel, words);
    }
    if (error == ENDAT_OK) {
        words[0] = ENDAT_WITH(words[0], ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES, settings->bit_cycles);
        words[1] = ENDAT_WITH(words[1], ENDAT_MAP_CONFIG_TIMING_REQUEST_ID, settings->request_id);
        words[1] = ENDAT_WITH(words[1], ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, settings->filter_cycles);
        words[2] = ENDAT_WITH(words[2], ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US, settings->reply_gap_us);
        words[2] = ENDAT_WITH(words[2], ENDAT_MAP_CONFIG_LIMITS_FIELD_GAP_US, settings->field_gap_us);
        error = endat_write_settings_words(card, channel, words);
    }
    return error;
}
