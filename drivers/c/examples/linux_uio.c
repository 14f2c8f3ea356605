/**
 * @file linux_uio.c
 * A card on the bus of a system on chip, from user space over UIO: who it is, a parameter, and positions for as long as they are good.
 *
 *   cc -std=c99 -O2 -I.. -o endat_uio linux_uio.c ../endat*.c && ./endat_uio /dev/uio0
 */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "endat.h"

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    *value = ((volatile uint32_t *)context)[word_address];
    return ENDAT_OK;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    ((volatile uint32_t *)context)[word_address] = value;
    return ENDAT_OK;
}

static uint32_t now_us(void *context)
{
    struct timespec now;

    (void)context;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u);
}

static void wait_us(void *context, uint32_t us)
{
    const struct timespec span = {(time_t)(us / 1000000u), (long)(us % 1000000u) * 1000L};

    (void)context;
    (void)nanosleep(&span, NULL);
}

static void show(const endat_moment *moment)
{
    uint32_t n;

    for (n = 0u; n < moment->channels; n++) {
        const endat_result *const result = &moment->channel[n];
        printf("channel %" PRIu32 ": %" PRId64 ", %s, %s\n", n, endat_signed(result->position, result->width_bits),
               (result->fresh && !result->stale) ? "fresh" : "old", endat_cause_text(result->cause));
        if (result->cause != 0u) {
            printf("  %s %s\n", endat_cause_meaning(result->cause), endat_cause_remedy(result->cause));
        }
    }
}

static endat_error run(endat_card *card)
{
    endat_moment moment;
    endat_error error = endat_try_link(card);
    uint32_t n;

    printf("%" PRIu32 " channels, register map %" PRIu32 ".%" PRIu32 ", configuration %08" PRIx32 ", %" PRIu32 " Hz\n", card->channels,
           card->version >> 24u, (card->version >> 16u) & 0xFFu, card->configuration_hash, card->system_hz);
    for (n = 0u; (n < card->channels) && (error == ENDAT_OK); n++) {
        const endat_error is_ready = endat_wait_ready(card, n, 5000u);
        endat_answer answer;
        printf("channel %" PRIu32 ": %s\n", n, endat_error_text(is_ready));
        if ((is_ready == ENDAT_OK) && (endat_read_parameter(card, n, 0xA1u, 0x0Du, 500u, &answer) == ENDAT_OK)) {
            printf("  word 13 of its memory: 0x%04x\n", answer.data);
        }
    }
    if (error == ENDAT_OK) {
        error = endat_set_triggers(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK, 0u);
    }
    for (n = 0u; (n < 10u) && (error == ENDAT_OK); n++) {
        error = endat_measure(card, &moment, 5000u);
        if ((error == ENDAT_OK) || (error == ENDAT_ERROR_TIMEOUT)) {
            show(&moment);
            error = ENDAT_OK;
        }
        wait_us(NULL, 100000u);
    }
    return error;
}

int main(int count, char **arguments)
{
    const char *const path = (count > 1) ? arguments[1] : "/dev/uio0";
    const int file = open(path, O_RDWR | O_SYNC);
    void *const map = (file >= 0) ? mmap(NULL, ENDAT_MAP_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
    endat_card card;
    endat_link link;
    endat_error error;

    if (map == MAP_FAILED) {
        perror(path);
        return 2;
    }
    (void)memset(&link, 0, sizeof link);
    link.context = map;
    link.read = read_word;
    link.write = write_word;
    link.now_us = now_us;
    link.wait_us = wait_us;
    error = endat_open(&card, &link, 0u);
    if (error == ENDAT_OK) {
        error = run(&card);
    }
    if (error != ENDAT_OK) {
        fprintf(stderr, "%s: %s\n", path, endat_error_text(error));
    }
    (void)munmap(map, ENDAT_MAP_BYTES);
    (void)close(file);
    return (error == ENDAT_OK) ? 0 : 1;
}
