/**
 * @file endat_internal.h
 * Shared by the files of the driver; not for programs.
 */
#ifndef ENDAT_INTERNAL_H
#define ENDAT_INTERNAL_H

#include "endat.h"

/** A wait with a limit. */
typedef struct {
    const endat_link *link; /**< Link, for its clock. */
    uint32_t started_us;    /**< Start time. */
    uint32_t passed_us;     /**< Sum of the pauses, without a clock. */
    uint32_t looks;         /**< Number of polls, without a clock and without waits. */
    uint32_t limit_us;      /**< Limit. */
} endat_wait;

void endat_wait_begin(endat_wait *wait, const endat_card *card, uint32_t limit_us);

/** Pauses; false after the limit. */
bool endat_wait_more(endat_wait *wait, uint32_t pause_us);

/** Milliseconds to microseconds, saturating. */
uint32_t endat_ms(uint32_t ms);

/** Protocol of a channel, ENDAT_PROTOCOL_..., from the word card.protocols. */
uint32_t endat_protocol_of(uint32_t word, uint32_t channel);

/** The cause, ENDAT_CAUSE_..., of a code of a channel's protocol. */
uint8_t endat_cause_of(uint32_t code, uint32_t protocol);

/** Checks for an EnDat channel. */
endat_error endat_needs_endat(const endat_card *card, uint32_t channel);

/** Checks for an EnDat channel and the part requests. */
endat_error endat_needs_service(const endat_card *card, uint32_t channel);

/** Checks for a T-format channel. */
endat_error endat_needs_t_format(const endat_card *card, uint32_t channel);

/** Pause between two polls of a request, in microseconds. */
#define ENDAT_REQUEST_PAUSE_US 50u

/** A word with another number in a field. */
#define ENDAT_WITH(word, field, value) (((word) & ~(uint32_t)field##_MASK) | ENDAT_MAP_PUT(field, value))
/** True if a number fits its field. */
#define ENDAT_FITS(field, value) (ENDAT_MAP_GET(field, ENDAT_MAP_PUT(field, value)) == (value))

/** Words of a channel's settings: frame, timing, limits. */
#define ENDAT_SETTINGS_WORDS 3u
/** Reads these words. */
endat_error endat_read_settings_words(const endat_card *card, uint32_t channel, uint32_t *words);
/** Writes them while all trigger sources are disabled, and reads them back. */
endat_error endat_write_settings_words(const endat_card *card, uint32_t channel, const uint32_t *words);

/** Action on a channel. */
typedef endat_error (*endat_action)(const endat_card *card, uint32_t channel, const void *what);
/** Executes an action while all trigger sources are disabled. */
endat_error endat_without_triggers(const endat_card *card, uint32_t channel, endat_action act, const void *what);

/** CRC-16/CCITT-FALSE; start value ENDAT_CRC16_START. */
#define ENDAT_CRC16_START 0xFFFFu
uint32_t endat_crc16(uint32_t crc, const uint8_t *bytes, uint32_t count);

#endif
