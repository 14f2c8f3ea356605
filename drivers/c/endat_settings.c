/**
 * @file endat_settings.c
 * Settings of channels, triggers and interrupts; kind of positions.
 */
#include "endat.h"
#include "endat_internal.h"

/** Fewest system clocks in an EnDat clock, if DATA is not sampled on both edges. */
#define SINGLE_EDGE_PERIOD_MIN 4u

/* Compilation fails unless the words of a channel are consecutive. */
typedef char endat_settings_follow[((ENDAT_MAP_CONFIG_LIMITS_WORD(0u) - ENDAT_MAP_CONFIG_FRAME_WORD(0u)) == (ENDAT_SETTINGS_WORDS - 1u))
                                       ? 1
                                       : -1];

uint32_t endat_period(const endat_card *card, uint32_t clock_hz)
{
    return (clock_hz == 0u) ? 0u : ((card->system_hz / clock_hz) + (((card->system_hz % clock_hz) != 0u) ? 1u : 0u));
}

endat_error endat_read_settings_words(const endat_card *card, uint32_t channel, uint32_t *words)
{
    uint32_t n;
    endat_error error = ENDAT_OK;

    for (n = 0u; n < ENDAT_SETTINGS_WORDS; n++) {
        words[n] = 0u;
        if (error == ENDAT_OK) {
            error = endat_read_word(card, ENDAT_MAP_CONFIG_FRAME_WORD(channel) + n, &words[n]);
        }
    }
    return error;
}

/** Restores the trigger sources, also after a failed access: all channels depend on them. */
static endat_error give_back(const endat_card *card, uint32_t sources)
{
    endat_error error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, sources);

    if (error != ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, sources);
    }
    return error;
}

endat_error endat_without_triggers(const endat_card *card, uint32_t channel, endat_action act, const void *what)
{
    uint32_t sources = 0u;
    endat_error error = endat_read_word(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, &sources);

    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD,
                                    sources & ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_DISABLED_MASK);
        if (error == ENDAT_OK) {
            error = act(card, channel, what);
        }
        const endat_error given_back = give_back(card, sources);
        error = (error == ENDAT_OK) ? given_back : error;
    }
    return error;
}

static endat_error write_words(const endat_card *card, uint32_t channel, const void *what)
{
    const uint32_t *const words = (const uint32_t *)what;
    uint32_t n;
    endat_error error = ENDAT_OK;

    for (n = 0u; (n < ENDAT_SETTINGS_WORDS) && (error == ENDAT_OK); n++) {
        error = endat_write_checked(card, ENDAT_MAP_CONFIG_FRAME_WORD(channel) + n, words[n]);
    }
    return error;
}

endat_error endat_write_settings_words(const endat_card *card, uint32_t channel, const uint32_t *words)
{
    /* A frame between two writes would use half of the settings. */
    return endat_without_triggers(card, channel, write_words, words);
}

endat_error endat_read_settings(const endat_card *card, uint32_t channel, endat_settings *settings)
{
    uint32_t words[ENDAT_SETTINGS_WORDS] = {0u, 0u, 0u};
    endat_error error = endat_needs_endat(card, channel);

    if (error == ENDAT_OK) {
        error = endat_read_settings_words(card, channel, words);
    }
    settings->period_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES, words[0]);
    settings->position_bits = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_FRAME_POSITION_BITS, words[0]);
    settings->command = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_FRAME_COMMAND, words[0]);
    settings->first_low_extra_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_FIRST_LOW_EXTRA_CYCLES, words[1]);
    settings->start_window_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_START_WINDOW_CYCLES, words[1]);
    settings->filter_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, words[1]);
    settings->start_timeout_us = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US, words[2]);
    settings->recovery_limit_cycles = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_LIMITS_RECOVERY_LIMIT_CYCLES, words[2]);
    return error;
}

static bool are_allowed(const endat_card *card, const endat_settings *s)
{
    const uint32_t least = endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_DOUBLE_EDGE)
                               ? ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_MIN
                               : SINGLE_EDGE_PERIOD_MIN;
    const bool is_frame = (s->period_cycles >= least) && (s->period_cycles <= ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_MAX) &&
                          (s->position_bits >= ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_MIN) &&
                          (s->position_bits <= card->max_position_bits);
    const bool is_command = (s->command == ENDAT_MAP_CONFIG_FRAME_COMMAND_SEND_POSITION) ||
                            (s->command == ENDAT_MAP_CONFIG_FRAME_COMMAND_SEND_POSITION_ADD_INFO);
    const bool is_timing = ENDAT_FITS(ENDAT_MAP_CONFIG_TIMING_FIRST_LOW_EXTRA_CYCLES, s->first_low_extra_cycles) &&
                           ENDAT_FITS(ENDAT_MAP_CONFIG_TIMING_START_WINDOW_CYCLES, s->start_window_cycles) &&
                           ENDAT_FITS(ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, s->filter_cycles);
    const bool are_limits = ENDAT_FITS(ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US, s->start_timeout_us) &&
                            ENDAT_FITS(ENDAT_MAP_CONFIG_LIMITS_RECOVERY_LIMIT_CYCLES, s->recovery_limit_cycles);

    return is_frame && is_command && is_timing && are_limits;
}

endat_error endat_write_settings(const endat_card *card, uint32_t channel, const endat_settings *settings)
{
    uint32_t words[ENDAT_SETTINGS_WORDS] = {0u, 0u, 0u};
    endat_error error = endat_needs_endat(card, channel);

    if ((error == ENDAT_OK) && !are_allowed(card, settings)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_read_settings_words(card, channel, words);
    }
    if (error != ENDAT_OK) {
        return error;
    }
    words[0] = ENDAT_WITH(words[0], ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES, settings->period_cycles);
    words[0] = ENDAT_WITH(words[0], ENDAT_MAP_CONFIG_FRAME_POSITION_BITS, settings->position_bits);
    words[0] = ENDAT_WITH(words[0], ENDAT_MAP_CONFIG_FRAME_COMMAND, settings->command);
    words[1] = ENDAT_WITH(words[1], ENDAT_MAP_CONFIG_TIMING_FIRST_LOW_EXTRA_CYCLES, settings->first_low_extra_cycles);
    words[1] = ENDAT_WITH(words[1], ENDAT_MAP_CONFIG_TIMING_START_WINDOW_CYCLES, settings->start_window_cycles);
    words[1] = ENDAT_WITH(words[1], ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES, settings->filter_cycles);
    words[2] = ENDAT_WITH(words[2], ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US, settings->start_timeout_us);
    words[2] = ENDAT_WITH(words[2], ENDAT_MAP_CONFIG_LIMITS_RECOVERY_LIMIT_CYCLES, settings->recovery_limit_cycles);
    return endat_write_settings_words(card, channel, words);
}

endat_error endat_set_triggers(const endat_card *card, uint32_t sources, uint32_t period_cycles)
{
    const uint32_t all = ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_PIN_MASK | ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_MASK |
                         ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK;
    const bool is_period = (period_cycles == 0u) || ((period_cycles >= ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_MIN) &&
                                                     (period_cycles <= ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_MAX));
    uint32_t word = 0u;
    endat_error error = (is_period && ((sources & ~all) == 0u)) ? ENDAT_OK : ENDAT_ERROR_ARGUMENT;

    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, &word);
    }
    if ((error == ENDAT_OK) && (period_cycles != 0u)) {
        /* The period is written while the timer is stopped. */
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD,
                                    word & ~(uint32_t)ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_MASK);
        if (error == ENDAT_OK) {
            error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_WORD, period_cycles);
        }
        if (error != ENDAT_OK) {
            (void)give_back(card, word);
        }
    }
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, (word & ~all) | sources);
    }
    return error;
}

endat_error endat_set_alarm(const endat_card *card, uint32_t channel, uint32_t n, uint32_t m)
{
    endat_error error = endat_needs_service(card, channel);

    if ((error == ENDAT_OK) && ((m < ENDAT_MAP_SERVICE_THRESHOLD_M_MIN) || (m > ENDAT_MAP_SERVICE_THRESHOLD_M_MAX) || (n > m))) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_SERVICE_THRESHOLD_WORD(channel),
                                    ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_THRESHOLD_N, n) | ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_THRESHOLD_M, m));
    }
    return error;
}

endat_error endat_enable_interrupts(const endat_card *card, uint32_t events)
{
    if (!endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INTERRUPT)) {
        return ENDAT_ERROR_PART;
    }
    return endat_write_checked(card, ENDAT_MAP_INTERRUPT_MASK_WORD, events);
}

endat_error endat_take_interrupts(const endat_card *card, uint32_t *events)
{
    endat_error error = ENDAT_ERROR_PART;

    *events = 0u;
    if (endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INTERRUPT)) {
        error = endat_read_word(card, ENDAT_MAP_INTERRUPT_STATUS_WORD, events);
    }
    /* Clear only the events that were read; new ones remain. */
    if ((error == ENDAT_OK) && (*events != 0u)) {
        error = endat_write_word(card, ENDAT_MAP_INTERRUPT_CLEAR_WORD, *events);
    }
    return error;
}

static uint64_t lowest(uint32_t bits)
{
    return (bits < 64u) ? (((uint64_t)1 << bits) - 1u) : UINT64_MAX;
}

/** Lowest bit of turns in a position of T-format, and bits of a position. */
#define T_FORMAT_TURNS_AT 24u
#define POSITION_BITS 48u

/** True if the range fits the positions of the protocol. */
static bool is_range(const endat_range *range, bool is_t_format)
{
    const uint32_t most = is_t_format ? T_FORMAT_TURNS_AT : POSITION_BITS;

    return (range->single_turn_bits > 0u) && (range->single_turn_bits <= most) &&
           ((range->turns_at + range->multi_turn_bits) <= POSITION_BITS);
}

endat_error endat_read_range(const endat_card *card, uint32_t channel, endat_range *range)
{
    uint32_t words[ENDAT_SETTINGS_WORDS] = {0u, 0u, 0u};
    const bool is_t_format = endat_protocol(card, channel) == ENDAT_PROTOCOL_T_FORMAT;
    endat_error error = (channel < card->channels) ? ENDAT_OK : ENDAT_ERROR_ARGUMENT;

    if (error == ENDAT_OK) {
        error = endat_read_settings_words(card, channel, words);
    }
    const uint32_t bits = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_FRAME_POSITION_BITS, words[0]);
    const uint32_t turns = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_MULTI_TURN_BITS, words[1]);
    const uint32_t asked = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_TIMING_REQUEST_ID, words[1]);
    const uint32_t single = (bits > turns) ? (bits - turns) : 0u;
    /* Other T-format requests bring no turns: the turns in a position are from the last reply with turns. */
    const bool has_turns = !is_t_format || (asked == ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING) ||
                           (asked == ENDAT_MAP_T_FORMAT_SEND_ID_MULTI_TURN);

    range->kind = ENDAT_MAP_GET(ENDAT_MAP_CONFIG_LIMITS_RANGE, words[2]);
    range->single_turn_bits = single;
    range->multi_turn_bits = has_turns ? turns : 0u;
    range->turns_at = is_t_format ? T_FORMAT_TURNS_AT : single;
    if ((range->kind != ENDAT_MAP_CONFIG_LIMITS_RANGE_ROTARY) || !is_range(range, is_t_format)) {
        range->kind = (range->kind == ENDAT_MAP_CONFIG_LIMITS_RANGE_LINEAR) ? range->kind : ENDAT_MAP_CONFIG_LIMITS_RANGE_UNKNOWN;
        range->single_turn_bits = 0u;
        range->multi_turn_bits = 0u;
        range->turns_at = 0u;
    }
    return error;
}

endat_error endat_turns(const endat_range *range, uint64_t position, uint32_t *turn, uint64_t *step)
{
    const bool is_rotary = range->kind == ENDAT_MAP_CONFIG_LIMITS_RANGE_ROTARY;

    *turn = is_rotary ? (uint32_t)((position >> range->turns_at) & lowest(range->multi_turn_bits)) : 0u;
    *step = is_rotary ? (position & lowest(range->single_turn_bits)) : 0u;
    return is_rotary ? ENDAT_OK : ENDAT_NOTHING;
}

endat_error endat_moved(const endat_range *range, uint64_t from, uint64_t to, int64_t *steps)
{
    uint32_t turns[2] = {0u, 0u};
    uint64_t angles[2] = {0u, 0u};
    endat_error error = ENDAT_OK;

    *steps = 0;
    if (range->kind == ENDAT_MAP_CONFIG_LIMITS_RANGE_LINEAR) {
        *steps = endat_difference(from, to, 64u);
    } else {
        error = endat_turns(range, from, &turns[0], &angles[0]);
    }
    if ((error == ENDAT_OK) && (range->kind == ENDAT_MAP_CONFIG_LIMITS_RANGE_ROTARY)) {
        (void)endat_turns(range, to, &turns[1], &angles[1]);
        const uint32_t bits = range->single_turn_bits;
        *steps = endat_difference(((uint64_t)turns[0] << bits) | angles[0], ((uint64_t)turns[1] << bits) | angles[1],
                                  bits + range->multi_turn_bits);
    }
    return error;
}
