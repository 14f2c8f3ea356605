/**
 * @file endat.c
 * The card: identity, words, results.
 */
#include "endat.h"
#include "endat_internal.h"
#include <stddef.h>

/** Polls per microsecond without a clock: more than any bus can do, so that no limit comes too early. */
#define LOOKS_PER_US 10u
/** Number of tries to read one instant word by word before the results are held. */
#define MOMENT_TRIES 3u
/** Pause between two polls of results. */
#define RESULT_PAUSE_US 5u
/** CRC5 of EnDat: generator, first and last value. */
#define CRC5_POLYNOMIAL 0x0Bu
#define CRC5_ONES 0x1Fu

void endat_wait_begin(endat_wait *wait, const endat_card *card, uint32_t limit_us)
{
    wait->link = &card->link;
    wait->started_us = (card->link.now_us != NULL) ? card->link.now_us(card->link.context) : 0u;
    wait->passed_us = 0u;
    wait->looks = 0u;
    wait->limit_us = limit_us;
}

bool endat_wait_more(endat_wait *wait, uint32_t pause_us)
{
    const endat_link *link = wait->link;

    if (link->wait_us != NULL) {
        link->wait_us(link->context, pause_us);
    }
    if (link->now_us != NULL) {
        wait->passed_us = link->now_us(link->context) - wait->started_us;
    } else if (link->wait_us != NULL) {
        wait->passed_us += pause_us;
    } else {
        wait->looks++;
        if (wait->looks >= LOOKS_PER_US) {
            wait->looks = 0u;
            wait->passed_us++;
        }
    }
    return wait->passed_us < wait->limit_us;
}

uint32_t endat_ms(uint32_t ms)
{
    return (ms < (UINT32_MAX / 1000u)) ? (ms * 1000u) : UINT32_MAX;
}

uint32_t endat_protocol(const endat_card *card, uint32_t channel)
{
    return (channel < ENDAT_CHANNELS_MAX) ? endat_protocol_of(card->protocols, channel) : ENDAT_PROTOCOL_ENDAT;
}

static endat_error needs_protocol(const endat_card *card, uint32_t channel, uint32_t protocol)
{
    endat_error error = ENDAT_OK;

    if (channel >= card->channels) {
        error = ENDAT_ERROR_ARGUMENT;
    } else if (endat_protocol(card, channel) != protocol) {
        error = ENDAT_ERROR_PROTOCOL;
    } else {
        error = ENDAT_OK;
    }
    return error;
}

endat_error endat_needs_endat(const endat_card *card, uint32_t channel)
{
    return needs_protocol(card, channel, ENDAT_PROTOCOL_ENDAT);
}

endat_error endat_needs_t_format(const endat_card *card, uint32_t channel)
{
    return needs_protocol(card, channel, ENDAT_PROTOCOL_T_FORMAT);
}

endat_error endat_needs_service(const endat_card *card, uint32_t channel)
{
    endat_error error = endat_needs_endat(card, channel);

    if ((error == ENDAT_OK) && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS)) {
        error = ENDAT_ERROR_PART;
    }
    return error;
}

const char *endat_error_text(endat_error error)
{
    static const char *const texts[ENDAT_ERRORS] = {
        "done",
        "nothing available",
        "argument outside the supported range: see the register map, and endat_card for the parts of this card",
        "the bus rejected the access or did not answer: check base address, clock and reset of the card",
        "check sum wrong in all tries: check the lines, lower the serial clock",
        "no card answers: check base address, byte order and, on SPI, the mode",
        "the card has another major version of the register map: use the driver that was generated with the card",
        "the card has another configuration: load the bitstream that belongs to this program",
        "the card does not have this part: generate a card with it",
        "the channel has another protocol, which does not support this: see endat_protocol()",
        "timeout: check that a trigger is enabled and the encoder is plugged in",
        "still under way: ask again",
        "the setting reads back with another value: check for a second master and a disturbed link",
        "no encoder: check plug, supply and both lines of DATA; the card recovers automatically",
        "the encoder could not be initialised: endat_failed_step() returns the step; check the cause of the last result",
        "the encoder rejected the request: endat_refusal_text() has the reason",
        "the trigger source \"register\" is not enabled: endat_set_triggers()",
        "a set of the stream was damaged: the link is disturbed, or another program reads it",
        "the exchange with the T-format encoder failed: endat_cause_text() of the reply's cause has the reason",
        "the card or its service has restarted, or another master has sent a request: send it again, write alarms and additional data again",
    };
    const uint32_t number = (uint32_t)error;

    return (number < (uint32_t)ENDAT_ERRORS) ? texts[number] : "unknown";
}

bool endat_has(const endat_card *card, uint32_t features)
{
    return (card->features & features) == features;
}

endat_error endat_read_word(const endat_card *card, uint32_t word_address, uint32_t *value)
{
    *value = 0u;
    return card->link.read(card->link.context, word_address, value);
}

endat_error endat_write_word(const endat_card *card, uint32_t word_address, uint32_t value)
{
    return card->link.write(card->link.context, word_address, value);
}

endat_error endat_write_checked(const endat_card *card, uint32_t word_address, uint32_t value)
{
    endat_error error = ENDAT_OK;
    uint32_t found = ~value;
    uint32_t tries = 0u;

    while ((error == ENDAT_OK) && (found != value) && (tries < 2u)) {
        error = endat_write_word(card, word_address, value);
        if (error == ENDAT_OK) {
            error = endat_read_word(card, word_address, &found);
        }
        tries++;
    }
    if ((error == ENDAT_OK) && (found != value)) {
        error = ENDAT_ERROR_READ_BACK;
    }
    return error;
}

endat_error endat_open(endat_card *card, const endat_link *link, uint32_t hash)
{
    uint32_t words[6] = {0u, 0u, 0u, 0u, 0u, 0u};
    const uint32_t addresses[6] = {
        ENDAT_MAP_CARD_ID_WORD,        ENDAT_MAP_CARD_VERSION_WORD,            ENDAT_MAP_CARD_CAPABILITIES_WORD,
        ENDAT_MAP_CARD_SYSTEM_HZ_WORD, ENDAT_MAP_CARD_CONFIGURATION_HASH_WORD, ENDAT_MAP_CARD_PROTOCOLS_WORD,
    };
    endat_error error = ENDAT_OK;
    uint32_t n;

    if ((card == NULL) || (link == NULL) || (link->read == NULL) || (link->write == NULL)) {
        return ENDAT_ERROR_ARGUMENT;
    }
    card->link = *link;
    card->channels = 0u;
    for (n = 0u; (n < 6u) && (error == ENDAT_OK); n++) {
        error = endat_read_word(card, addresses[n], &words[n]);
    }
    if (error != ENDAT_OK) {
        return error;
    }
    card->version = words[1];
    card->system_hz = words[3];
    card->configuration_hash = words[4];
    card->features = ENDAT_MAP_GET(ENDAT_MAP_CARD_CAPABILITIES_FEATURES, words[2]);
    card->max_position_bits = ENDAT_MAP_GET(ENDAT_MAP_CARD_CAPABILITIES_MAX_POSITION_BITS, words[2]);
    card->more_features = ENDAT_MAP_GET(ENDAT_MAP_CARD_PROTOCOLS_FEATURES, words[5]);
    card->protocols = words[5];
    n = ENDAT_MAP_GET(ENDAT_MAP_CARD_CAPABILITIES_CHANNELS, words[2]);
    if (words[0] != ENDAT_MAP_ID) {
        error = ENDAT_ERROR_NO_CARD;
    } else if (ENDAT_MAP_GET(ENDAT_MAP_CARD_VERSION_MAJOR, words[1]) != ENDAT_MAP_MAJOR) {
        error = ENDAT_ERROR_VERSION;
    } else if ((n == 0u) || (n > ENDAT_CHANNELS_MAX) || (card->system_hz == 0u)) {
        error = ENDAT_ERROR_NO_CARD;
    } else if ((hash != 0u) && (hash != card->configuration_hash)) {
        error = ENDAT_ERROR_CONFIGURATION;
    } else {
        card->channels = n;
    }
    return error;
}

endat_error endat_try_link(const endat_card *card)
{
    const uint32_t patterns[4] = {0x00AA5501u, 0x0055AAFEu, 0x00010280u, 0x00000000u};
    uint32_t n;
    endat_error error = ENDAT_OK;

    for (n = 0u; (n < 4u) && (error == ENDAT_OK); n++) {
        const uint32_t scratch = ENDAT_MAP_PUT(ENDAT_MAP_CARD_CONFIG_HOLD_SCRATCH, patterns[n]);
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, scratch);
    }
    return error;
}

/** Number of words in a result of this card. */
static uint32_t result_words(const endat_card *card)
{
    return endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS) ? ENDAT_MAP_RESULT_WORDS_WITH_INFOS : ENDAT_MAP_RESULT_WORDS;
}

/** Reads the words of all results in rising order. */
static endat_error look(const endat_card *card, uint32_t words[ENDAT_BURST_WORDS])
{
    const uint32_t each = result_words(card);
    const uint32_t base = ENDAT_MAP_RESULT_BASE_WORD;
    const uint32_t stride = ENDAT_MAP_RESULT_STRIDE_WORDS;
    endat_error error = ENDAT_OK;
    uint32_t channel;
    uint32_t n;

    if (card->link.read_burst != NULL) {
        return card->link.read_burst(card->link.context, base, (stride * (card->channels - 1u)) + each, words);
    }
    for (channel = 0u; channel < card->channels; channel++) {
        for (n = 0u; (n < each) && (error == ENDAT_OK); n++) {
            const uint32_t at = (stride * channel) + n;
            error = endat_read_word(card, base + at, &words[at]);
        }
    }
    return error;
}

/** True if no result has come since these words were read: all of them belong to one instant. */
static endat_error is_same(const endat_card *card, const uint32_t words[ENDAT_BURST_WORDS], bool *same)
{
    endat_error error = ENDAT_OK;
    uint32_t channel;

    *same = true;
    for (channel = 0u; (channel < card->channels) && (error == ENDAT_OK); channel++) {
        uint32_t status = 0u;
        error = endat_read_word(card, ENDAT_MAP_RESULT_STATUS_WORD(channel), &status);
        *same = *same && (status == words[ENDAT_MAP_RESULT_STRIDE_WORDS * channel]);
    }
    return error;
}

/** Reads the words while the card holds its results. */
static endat_error look_held(const endat_card *card, uint32_t words[ENDAT_BURST_WORDS])
{
    uint32_t word = 0u;
    endat_error error = endat_read_word(card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, &word);

    word &= ~(uint32_t)ENDAT_MAP_CARD_CONFIG_HOLD_HOLD_MASK;
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, word | ENDAT_MAP_CARD_CONFIG_HOLD_HOLD_MASK);
        if (error == ENDAT_OK) {
            error = look(card, words);
        }
        /* Release after every error, too: frozen results would be worse. */
        endat_error let_go = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, word);
        if (let_go != ENDAT_OK) {
            let_go = endat_write_checked(card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, word);
        }
        error = (error == ENDAT_OK) ? let_go : error;
    }
    return error;
}

static endat_error look_at_one_moment(const endat_card *card, uint32_t words[ENDAT_BURST_WORDS])
{
    endat_error error = ENDAT_OK;
    bool same = (card->link.read_burst != NULL);
    uint32_t tries;

    if (same) {
        return look(card, words);
    }
    for (tries = 0u; (tries < MOMENT_TRIES) && !same && (error == ENDAT_OK); tries++) {
        error = look(card, words);
        if (error == ENDAT_OK) {
            error = is_same(card, words, &same);
        }
    }
    return ((error == ENDAT_OK) && !same) ? look_held(card, words) : error;
}

static uint32_t crc5_step(uint32_t crc, uint32_t bit)
{
    const uint32_t feedback = ((crc >> 4u) ^ bit) & 1u;

    return ((crc << 1u) & CRC5_ONES) ^ ((feedback != 0u) ? CRC5_POLYNOMIAL : 0u);
}

/** True if a position matches the CRC received with it, over F1 = 0, F2 = 1 if it was sent, and the position, LSB first. */
static bool fits_crc(uint64_t position, uint32_t high)
{
    const uint32_t width = ENDAT_MAP_GET(ENDAT_MAP_RESULT_POSITION_HIGH_WIDTH, high);
    uint32_t crc = crc5_step(CRC5_ONES, 0u);
    uint32_t bit;

    if (width == 0u) {
        return true;
    }
    if ((high & ENDAT_MAP_RESULT_POSITION_HIGH_F2_MASK) != 0u) {
        crc = crc5_step(crc, 1u);
    }
    for (bit = 0u; bit < width; bit++) {
        crc = crc5_step(crc, (uint32_t)(position >> bit) & 1u);
    }
    return ((position >> width) == 0u) && ((crc ^ CRC5_ONES) == ENDAT_MAP_GET(ENDAT_MAP_RESULT_POSITION_HIGH_CRC, high));
}

/* Additional data 1 and 2 have the same fields. */
static endat_info info_of(uint32_t word)
{
    endat_info info;

    info.came = (word & ENDAT_MAP_RESULT_INFO_1_CAME_MASK) != 0u;
    info.good = (word & ENDAT_MAP_RESULT_INFO_1_GOOD_MASK) != 0u;
    info.busy = (word & ENDAT_MAP_RESULT_INFO_1_BUSY_MASK) != 0u;
    info.reference_mark = (word & ENDAT_MAP_RESULT_INFO_1_REFERENCE_MARK_MASK) != 0u;
    info.warning = (word & ENDAT_MAP_RESULT_INFO_1_WARNING_MASK) != 0u;
    info.number = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_INFO_1_SIGN, word);
    info.content = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_INFO_1_CONTENT, word);
    return info;
}

/** Index of a word in a result. */
#define AT(name) (ENDAT_MAP_RESULT_##name##_WORD(0u) - ENDAT_MAP_RESULT_BASE_WORD)

static void take_apart(const uint32_t *words, bool has_infos, uint32_t protocol, endat_result *result)
{
    const uint32_t status = words[AT(STATUS)];
    const uint32_t high = words[AT(POSITION_HIGH)];
    const uint32_t evidence = words[AT(EVIDENCE)];
    const uint32_t age = words[AT(AGE_RECOVERY)];
    const uint32_t upper_bits = ENDAT_MAP_GET(ENDAT_MAP_RESULT_POSITION_HIGH_VALUE, high);
    const uint64_t upper = upper_bits;
    const uint32_t delay_low = ENDAT_MAP_GET(ENDAT_MAP_RESULT_EVIDENCE_DELAY_CYCLES, evidence);
    const uint32_t delay_high = ENDAT_MAP_GET(ENDAT_MAP_RESULT_AGE_RECOVERY_DELAY_HIGH, age);

    result->position = (upper << 32u) | words[AT(POSITION_LOW)];
    result->timestamp = words[AT(TIMESTAMP)];
    result->sequence = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_STATUS_SEQUENCE, status);
    result->age_us = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_AGE_RECOVERY_AGE_US, age);
    result->delay_cycles = (uint16_t)((delay_high << 10u) | delay_low);
    result->recovery_cycles = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_AGE_RECOVERY_RECOVERY_CYCLES, age);
    result->width_bits = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_POSITION_HIGH_WIDTH, high);
    result->special_bits =
        (protocol == ENDAT_PROTOCOL_SSI) ? (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_RESULT_STATUS_LINE, status) : 0u;
    result->cause = endat_cause_of(ENDAT_MAP_GET(ENDAT_MAP_RESULT_STATUS_CAUSE, status), protocol);
    result->valid = (status & ENDAT_MAP_RESULT_STATUS_VALID_MASK) != 0u;
    result->fresh = (status & ENDAT_MAP_RESULT_STATUS_FRESH_MASK) != 0u;
    result->stale = (age & ENDAT_MAP_RESULT_AGE_RECOVERY_STALE_MASK) != 0u;
    result->fits = fits_crc(result->position, high);
    result->info[0] = info_of(has_infos ? words[AT(INFO_1)] : 0u);
    result->info[1] = info_of(has_infos ? words[AT(INFO_2)] : 0u);
    if (!result->fits) {
        result->valid = false;
        result->fresh = false;
        result->cause = (uint8_t)ENDAT_CAUSE_UPSET;
    }
}

endat_error endat_read_moment(const endat_card *card, endat_moment *moment)
{
    const bool has_infos = endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS);
    uint32_t words[ENDAT_BURST_WORDS] = {0};
    endat_error error = ENDAT_OK;
    bool fits = false;
    uint32_t tries;
    uint32_t n;

    moment->channels = 0u;
    for (tries = 0u; (tries < 2u) && !fits && (error == ENDAT_OK); tries++) {
        error = look_at_one_moment(card, words);
        fits = true;
        for (n = 0u; (n < card->channels) && (error == ENDAT_OK); n++) {
            take_apart(&words[ENDAT_MAP_RESULT_STRIDE_WORDS * n], has_infos, endat_protocol(card, n), &moment->channel[n]);
            fits = fits && moment->channel[n].fits;
        }
    }
    if (error == ENDAT_OK) {
        moment->channels = card->channels;
    }
    return error;
}

endat_error endat_trigger(const endat_card *card)
{
    return endat_write_word(card, ENDAT_MAP_CARD_TRIGGER_NOW_WORD, ENDAT_MAP_CARD_TRIGGER_NOW_TRIGGER_MASK);
}

endat_error endat_measure(const endat_card *card, endat_moment *moment, uint32_t limit_us)
{
    uint16_t before[ENDAT_CHANNELS_MAX] = {0};
    uint16_t under_way[ENDAT_CHANNELS_MAX] = {0};
    bool is_over = false;
    bool in_time = true;
    endat_wait wait;
    uint32_t n;
    endat_error error = endat_read_moment(card, moment);

    for (n = 0u; (error == ENDAT_OK) && (n < moment->channels); n++) {
        before[n] = moment->channel[n].sequence;
        /* The next result belongs to an earlier trigger. */
        under_way[n] = moment->channel[n].stale ? 1u : 0u;
    }
    if (error == ENDAT_OK) {
        error = endat_trigger(card);
    }
    endat_wait_begin(&wait, card, limit_us);
    while ((error == ENDAT_OK) && !is_over && in_time) {
        bool any_new = false;
        bool any_stale = false;

        /* The last poll comes after the last pause. */
        in_time = endat_wait_more(&wait, RESULT_PAUSE_US);
        error = endat_read_moment(card, moment);
        for (n = 0u; (error == ENDAT_OK) && (n < moment->channels); n++) {
            const uint16_t results = (uint16_t)(moment->channel[n].sequence - before[n]);

            any_new = any_new || (results != 0u);
            /* Other trigger sources continue: a result after the start of this call is not stale for it. */
            if (results > under_way[n]) {
                moment->channel[n].stale = false;
            }
            any_stale = any_stale || moment->channel[n].stale;
        }
        is_over = any_new && !any_stale;
    }
    if ((error == ENDAT_OK) && !is_over) {
        uint32_t sources = 0u;
        error = endat_read_word(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, &sources);
        if (error == ENDAT_OK) {
            const bool is_on = (sources & ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK) != 0u;
            error = is_on ? ENDAT_ERROR_TIMEOUT : ENDAT_ERROR_TRIGGER_OFF;
        }
    }
    return error;
}

endat_error endat_calibrate(const endat_card *card, uint32_t channels)
{
    return endat_write_word(card, ENDAT_MAP_CARD_CALIBRATE_WORD, ENDAT_MAP_PUT(ENDAT_MAP_CARD_CALIBRATE_CHANNELS, channels));
}

int64_t endat_signed(uint64_t position, uint32_t width_bits)
{
    const uint64_t half = (width_bits > 0u) ? ((uint64_t)1 << ((width_bits - 1u) & 63u)) : 0u;
    const uint64_t span = half << 1u;
    const uint64_t value = (width_bits < 64u) ? (position & (span - 1u)) : position;
    const uint64_t above = value - half;
    const uint64_t greatest = half - 1u;

    if (width_bits == 0u) {
        return 0;
    }
    return (value < half) ? (int64_t)value : (((int64_t)above - (int64_t)greatest) - 1);
}

int64_t endat_difference(uint64_t from, uint64_t to, uint32_t width_bits)
{
    return endat_signed(to - from, width_bits);
}
