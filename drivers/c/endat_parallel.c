/**
 * @file endat_parallel.c
 * Words through the window of the parallel bus.
 */
#include "endat_transports.h"
#include <stddef.h>

/** Registers of the bus. */
#define WINDOW 5u
#define LOW_HALF 6u
#define HIGH_HALF 7u
/** Bits of the window. */
#define BUSY 0x8000u
#define NO_READ 0x4000u
#define ADDRESS_BITS 0x07FFu
/** Polls of the window until it must be free: the longest access takes some hundred system clocks, a poll several. */
#define LOOKS 1000u

static endat_error wait_for_window(endat_parallel *parallel)
{
    uint32_t looks = LOOKS;

    while (((parallel->get(parallel->context, WINDOW) & BUSY) != 0u) && (looks > 0u)) {
        looks--;
    }
    return (looks > 0u) ? ENDAT_OK : ENDAT_ERROR_LINK;
}

/* Each write of the window also sets the channel of registers 0 to 4, which the driver does not use. */
static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    endat_parallel *const parallel = (endat_parallel *)context;
    endat_error error = wait_for_window(parallel);

    if (word_address > ADDRESS_BITS) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        parallel->put(parallel->context, WINDOW, (uint16_t)word_address);
        error = wait_for_window(parallel);
    }
    if (error == ENDAT_OK) {
        const uint32_t low = parallel->get(parallel->context, LOW_HALF);
        *value = ((uint32_t)parallel->get(parallel->context, HIGH_HALF) << 16u) | low;
    }
    return error;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    endat_parallel *const parallel = (endat_parallel *)context;
    endat_error error = wait_for_window(parallel);

    if (word_address > ADDRESS_BITS) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        parallel->put(parallel->context, WINDOW, (uint16_t)(word_address | NO_READ));
        parallel->put(parallel->context, LOW_HALF, (uint16_t)(value & 0xFFFFu));
        parallel->put(parallel->context, HIGH_HALF, (uint16_t)(value >> 16u));
        error = wait_for_window(parallel);
    }
    return error;
}

void endat_parallel_link(endat_parallel *parallel, endat_link *link)
{
    link->context = parallel;
    link->read = read_word;
    link->write = write_word;
    link->read_burst = NULL;
    link->now_us = NULL;
    link->wait_us = NULL;
}
