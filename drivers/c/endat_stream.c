/**
 * @file endat_stream.c
 * The stream of sample sets, read word by word from the card's buffer: over any bus.
 */
#include "endat.h"
#include "endat_internal.h"
#include <stddef.h>

#define CRC16_POLYNOMIAL 0x1021u
/** Bytes before the samples, of a sample, of its additional data, and of the check sum. */
#define HEAD_BYTES 8u
#define SAMPLE_BYTES 8u
#define INFO_BYTES 8u
#define CRC_BYTES 2u
/** Types of a set. */
#define TYPE_PLAIN 1u
#define TYPE_INFOS 2u
#define TYPE_RUN 3u
/** Bits of a sample's status: those of the upper half of result.status, and two in unused places. */
#define STATUS_SHIFT 16u
#define TAKEN 0x0020u
#define MISSING 0x8000u

uint32_t endat_crc16(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    uint32_t sum = crc;
    uint32_t n;
    uint32_t bit;

    for (n = 0u; n < count; n++) {
        sum ^= (uint32_t)bytes[n] << 8u;
        for (bit = 0u; bit < 8u; bit++) {
            sum = (((sum & 0x8000u) != 0u) ? ((sum << 1u) ^ CRC16_POLYNOMIAL) : (sum << 1u)) & 0xFFFFu;
        }
    }
    return sum;
}

endat_error endat_stream_start(const endat_card *card, endat_stream *stream, bool collects)
{
    const uint32_t collect = collects ? ENDAT_MAP_CARD_STREAM_CONTROL_COLLECT_MASK : 0u;
    endat_error error = endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_STREAM) ? ENDAT_OK : ENDAT_ERROR_PART;

    stream->count = 0u;
    stream->left = 0u;
    stream->word = 0u;
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_STREAM_CONTROL_WORD, 0u);
    }
    if (error == ENDAT_OK) {
        error = endat_write_word(card, ENDAT_MAP_CARD_STREAM_CLEAR_WORD, ENDAT_MAP_CARD_STREAM_CLEAR_CLEAR_MASK);
    }
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_CARD_STREAM_CONTROL_WORD, collect);
    }
    return error;
}

/** Little-endian number. */
static uint64_t number(const uint8_t *bytes, uint32_t count)
{
    uint64_t value = 0u;
    uint32_t n;

    for (n = count; n > 0u; n--) {
        value = (value << 8u) | bytes[n - 1u];
    }
    return value;
}

/** Decodes COBS in place; returns the number of bytes, 0 if it is damaged. */
static uint32_t decode(uint8_t *bytes, uint32_t count)
{
    uint32_t from = 0u;
    uint32_t to = 0u;

    while (from < count) {
        const uint32_t code = bytes[from];
        uint32_t n;

        if ((code == 0u) || ((from + code) > count)) {
            return 0u;
        }
        for (n = 1u; n < code; n++) {
            bytes[to] = bytes[from + n];
            to++;
        }
        from += code;
        if (from < count) {
            bytes[to] = 0u;
            to++;
        }
    }
    return to;
}

static endat_error take_apart(const endat_card *card, endat_stream *stream, endat_set *set)
{
    const uint8_t *const bytes = stream->bytes;
    const uint32_t length = decode(stream->bytes, stream->count);
    const uint32_t type = (uint32_t)bytes[0] >> 4u;
    const uint32_t low = (uint32_t)bytes[0] & 0x0Fu;
    const uint32_t samples = (type == TYPE_RUN) ? 1u : low;
    const uint32_t each = (type == TYPE_INFOS) ? (SAMPLE_BYTES + INFO_BYTES) : SAMPLE_BYTES;
    const uint32_t expected = HEAD_BYTES + (each * samples) + CRC_BYTES;
    uint32_t n;

    if ((length != expected) || (samples == 0u) || (samples > ENDAT_CHANNELS_MAX)) {
        return ENDAT_ERROR_SET;
    }
    if (endat_crc16(ENDAT_CRC16_START, bytes, length - CRC_BYTES) != (uint32_t)number(&bytes[length - CRC_BYTES], CRC_BYTES)) {
        return ENDAT_ERROR_SET;
    }
    if ((type != TYPE_PLAIN) && (type != TYPE_INFOS) && (type != TYPE_RUN)) {
        return ENDAT_NOTHING;
    }
    set->type = (uint8_t)type;
    set->first = (uint8_t)((type == TYPE_RUN) ? low : 0u);
    set->count = (uint8_t)samples;
    set->lost = bytes[1];
    set->sequence = (uint16_t)number(&bytes[2], 2u);
    set->timestamp = (uint32_t)number(&bytes[4], 4u);
    for (n = 0u; n < samples; n++) {
        const uint8_t *const own = &bytes[HEAD_BYTES + (each * n)];
        const uint32_t status = (uint32_t)number(&own[6], 2u);
        const uint32_t word = status << STATUS_SHIFT;
        endat_sample *const sample = &set->sample[n];

        sample->position = number(own, 6u);
        sample->cause = endat_cause_of(ENDAT_MAP_GET(ENDAT_MAP_RESULT_STATUS_CAUSE, word), endat_protocol(card, set->first + n));
        sample->valid = (word & ENDAT_MAP_RESULT_STATUS_VALID_MASK) != 0u;
        sample->fresh = (word & ENDAT_MAP_RESULT_STATUS_FRESH_MASK) != 0u;
        sample->taken = (status & TAKEN) != 0u;
        sample->missing = (status & MISSING) != 0u;
    }
    return ENDAT_OK;
}

/** Processes a byte; ENDAT_NOTHING until a set is complete. */
static endat_error take_byte(const endat_card *card, endat_stream *stream, uint8_t byte, endat_set *set)
{
    endat_error error = ENDAT_NOTHING;

    if (byte != 0u) {
        if (stream->count < sizeof stream->bytes) {
            stream->bytes[stream->count] = byte;
        }
        stream->count++;
    } else if (stream->count > sizeof stream->bytes) {
        error = ENDAT_ERROR_SET;
        stream->count = 0u;
    } else if (stream->count > 0u) {
        error = take_apart(card, stream, set);
        stream->count = 0u;
    } else {
        /* Empty frame between two zeros. */
        error = ENDAT_NOTHING;
    }
    return error;
}

endat_error endat_stream_next(const endat_card *card, endat_stream *stream, endat_set *set)
{
    /* At most the bytes of one buffer in a call, so that it returns even if the card writes faster than the host reads. */
    uint32_t words = ENDAT_SET_BYTES;
    endat_error error = endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_STREAM) ? ENDAT_NOTHING : ENDAT_ERROR_PART;
    bool is_empty = false;

    while ((error == ENDAT_NOTHING) && !is_empty) {
        if (stream->left > 0u) {
            const uint8_t byte = (uint8_t)(stream->word >> 24u);
            stream->word <<= 8u;
            stream->left--;
            error = take_byte(card, stream, byte, set);
        } else {
            uint32_t state = 0u;
            endat_error read = endat_read_word(card, ENDAT_MAP_CARD_STREAM_STATE_WORD, &state);

            is_empty = (ENDAT_MAP_GET(ENDAT_MAP_CARD_STREAM_STATE_BYTES, state) == 0u) || (words == 0u);
            if ((read == ENDAT_OK) && !is_empty) {
                words--;
                /* Missing bytes read 0, which separates sets. */
                read = endat_read_word(card, ENDAT_MAP_CARD_STREAM_DATA_WORD, &stream->word);
                stream->left = (read == ENDAT_OK) ? 4u : 0u;
            }
            error = (read == ENDAT_OK) ? ENDAT_NOTHING : read;
        }
    }
    return error;
}
