/* The driver without a card: words that a card would not say, and numbers. */
#include "endat_internal.h"
#include "endat_transports.h"
#include "scenarios.h"
#include <inttypes.h>
#include <string.h>

static uint32_t memory[0x800];
static endat_error told;
static uint32_t stuck_at;
static unsigned reads;

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    (void)context;
    reads++;
    *value = memory[word_address];
    return told;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    (void)context;
    if (word_address != stuck_at)
        memory[word_address] = value;
    return told;
}

static const endat_link link = {NULL, read_word, write_word, NULL, NULL, NULL};

static void good_card(void)
{
    memset(memory, 0, sizeof memory);
    told = ENDAT_OK;
    stuck_at = 0;
    memory[ENDAT_MAP_CARD_ID_WORD] = ENDAT_MAP_ID;
    memory[ENDAT_MAP_CARD_VERSION_WORD] = ENDAT_MAP_MAJOR << 24 | (ENDAT_MAP_MINOR + 1) << 16;
    memory[ENDAT_MAP_CARD_CAPABILITIES_WORD] = ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS << 16 | 48u << 8 | 3u;
    memory[ENDAT_MAP_CARD_SYSTEM_HZ_WORD] = 100000000;
    memory[ENDAT_MAP_CARD_CONFIGURATION_HASH_WORD] = 0x12345678;
    memory[ENDAT_MAP_CARD_PROTOCOLS_WORD] = 2;
}

/* What an encoder says of itself, from its words. */
static void plates(void)
{
    static const struct {
        uint16_t words[6];
        const char *id, *serial;
    } all[] = {
#include "plates.h"
    };
    const uint32_t is_read = ENDAT_MAP_SERVICE_ALARMS_IS_READ_MASK;
    endat_card card;
    endat_name_plate plate;
    char text[ENDAT_NUMBER_BYTES];

    good_card();
    memory[ENDAT_MAP_CARD_PROTOCOLS_WORD] = 0;
    memory[ENDAT_MAP_CARD_CAPABILITIES_WORD] |= ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE << 16;
    CHECK(endat_open(&card, &link, 0) == ENDAT_OK, "%s", "open");
    CHECK(endat_serial(&card, 1, text) == ENDAT_NOTHING && text[0] == 0, "%s", text);
    for (unsigned n = 0; n < sizeof all / sizeof all[0]; n++) {
        const uint32_t first = ENDAT_MAP_SERVICE_ENCODER_TYPE_WORD(1) - 1;

        for (uint32_t at = first; at <= ENDAT_MAP_SERVICE_SERIAL_2_WORD(1); at++)
            memory[at] = is_read;
        for (uint32_t word = 0; word < 6; word++)
            memory[ENDAT_MAP_SERVICE_ID_0_WORD(1) + word] = is_read | all[n].words[word];
        CHECK(endat_id(&card, 1, text) == ENDAT_OK && strcmp(text, all[n].id) == 0, "%s", text);
        CHECK(endat_serial(&card, 1, text) == ENDAT_OK && strcmp(text, all[n].serial) == 0, "%s", text);
        memory[ENDAT_MAP_SERVICE_POSITION_BITS_WORD(1)] = is_read | 0x4025;
        memory[ENDAT_MAP_SERVICE_ENCODER_TYPE_WORD(1)] = is_read | 0x8000;
        memory[ENDAT_MAP_SERVICE_STEPS_HIGH_WORD(1)] = is_read | 0x0200;
        memory[ENDAT_MAP_SERVICE_REVOLUTIONS_WORD(1)] = is_read | 4096;
        CHECK(endat_read_name_plate(&card, 1, &plate) == ENDAT_OK && strcmp(plate.serial, all[n].serial) == 0, "%s", plate.serial);
        CHECK(plate.position_bits == 37 && plate.rotary && plate.steps == 33554432 && plate.revolutions == 4096, "%u",
              (unsigned)plate.steps);
    }
    memory[ENDAT_MAP_SERVICE_SERIAL_1_WORD(1)] = 0;
    CHECK(endat_read_name_plate(&card, 1, &plate) == ENDAT_NOTHING && plate.serial[0] == 0, "%s", plate.serial);
}

static void identities(void)
{
    endat_card card;
    endat_answer answer;

    good_card();
    CHECK(endat_open(&card, &link, 0) == ENDAT_OK && card.channels == 3 && card.max_position_bits == 48, "%u", (unsigned)card.channels);
    CHECK(endat_has(&card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS), "%x", (unsigned)card.features);
    CHECK(endat_read_parameter(&card, 1, 0, 0, 1, &answer) == ENDAT_ERROR_PROTOCOL, "%s", "T-format");
    CHECK(endat_open(&card, &link, 0x12345679) == ENDAT_ERROR_CONFIGURATION, "%s", "hash");
    CHECK(endat_open(NULL, &link, 0) == ENDAT_ERROR_ARGUMENT && endat_open(&card, NULL, 0) == ENDAT_ERROR_ARGUMENT, "%s", "NULL");
    memory[ENDAT_MAP_CARD_ID_WORD] = 0x74446E45; /* the bytes the other way round */
    CHECK(endat_open(&card, &link, 0) == ENDAT_ERROR_NO_CARD && card.channels == 0, "%s", "byte order");
    good_card();
    memory[ENDAT_MAP_CARD_VERSION_WORD] = (ENDAT_MAP_MAJOR + 1) << 24;
    CHECK(endat_open(&card, &link, 0) == ENDAT_ERROR_VERSION, "%s", "major version");
    for (unsigned n = 0; n < 256; n++) {
        good_card();
        memory[ENDAT_MAP_CARD_CAPABILITIES_WORD] = 48u << 8 | n;
        CHECK((endat_open(&card, &link, 0) == ENDAT_OK) == (n > 0 && n <= 8), "%u channels", n);
    }
    good_card();
    told = ENDAT_ERROR_LINK;
    CHECK(endat_open(&card, &link, 0) == ENDAT_ERROR_LINK, "%s", "a bus that refuses");
    good_card();
    CHECK(endat_open(&card, &link, 0) == ENDAT_OK && endat_try_link(&card) == ENDAT_OK, "%s", "the link");
    stuck_at = ENDAT_MAP_CARD_CONFIG_HOLD_WORD;
    CHECK(endat_try_link(&card) == ENDAT_ERROR_READ_BACK, "%s", "writes that do not arrive");
}

/* Only the next number is that of the request, also where the count begins again; another one is of a card that was restarted. */
static void requests(void)
{
    static const struct {
        uint32_t before, now, busy;
        endat_error error;
    } rows[] = {
        {5, 5, 0, ENDAT_ERROR_BUSY},      {5, 6, 1, ENDAT_ERROR_BUSY},      {5, 6, 0, ENDAT_OK},
        {5, 7, 0, ENDAT_ERROR_RESTARTED}, {5, 0, 1, ENDAT_ERROR_RESTARTED}, {0xFFFF, 0, 0, ENDAT_OK},
        {0, 0xFFFF, 0, ENDAT_ERROR_RESTARTED},
    };
    endat_card card;
    endat_request request;
    endat_answer answer;

    good_card();
    memory[ENDAT_MAP_CARD_PROTOCOLS_WORD] = 0;
    CHECK(endat_open(&card, &link, 0) == ENDAT_OK, "%s", "requests");
    for (unsigned n = 0; n < sizeof rows / sizeof rows[0]; n++) {
        uint32_t *const state = &memory[ENDAT_MAP_SERVICE_REQUEST_STATE_WORD(0u)];

        memory[ENDAT_MAP_SERVICE_STATE_WORD(0u)] = 1u << 16;
        *state = ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED, rows[n].before);
        CHECK(endat_request_begin(&card, &request, 0, 9, 1, 0) == ENDAT_OK, "request %u", n);
        *state = ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED, rows[n].now) |
                 ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_STATE_BUSY, rows[n].busy);
        CHECK(endat_request_poll(&card, &request, &answer) == rows[n].error, "answer %u", n);
    }
}

/* The result of the programming page: 29 bits, fits; then with every bit of it wrong. */
static void positions(void)
{
    static const uint32_t words[3] = {0x00C00002, 0x01235678, 0x1D5F0000};
    endat_card card;
    endat_moment moment;

    good_card();
    CHECK(endat_open(&card, &link, 0) == ENDAT_OK, "%s", "open");
    memcpy(&memory[ENDAT_MAP_RESULT_STATUS_WORD(2)], words, sizeof words);
    CHECK(endat_read_moment(&card, &moment) == ENDAT_OK && moment.channels == 3, "%s", "read");
    CHECK(moment.channel[2].fresh && moment.channel[2].fits && moment.channel[2].position == 0x01235678, "%" PRIx64,
          moment.channel[2].position);
    for (unsigned bit = 0; bit < 29; bit++) {
        memory[ENDAT_MAP_RESULT_POSITION_LOW_WORD(2)] = words[1] ^ 1u << bit;
        CHECK(endat_read_moment(&card, &moment) == ENDAT_OK, "%s", "read");
        CHECK(!moment.channel[2].fresh && !moment.channel[2].valid && !moment.channel[2].fits, "bit %u", bit);
        CHECK(moment.channel[2].cause == ENDAT_CAUSE_UPSET, "bit %u", bit);
    }
    /* A code is one of its channel's protocol; what both have is one cause. */
    static const uint8_t same_code[][3] = {
        {3, ENDAT_CAUSE_START_WINDOW, ENDAT_CAUSE_NO_ANSWER},
        {8, ENDAT_CAUSE_TRIGGER_OVERRUN, ENDAT_CAUSE_FIELD_MISSING},
        {16, ENDAT_CAUSE_OWN_ECHO, ENDAT_CAUSE_TRIGGER_OVERRUN},
    };
    for (unsigned n = 0; n < sizeof same_code / sizeof same_code[0]; n++) {
        memory[ENDAT_MAP_RESULT_STATUS_WORD(0)] = memory[ENDAT_MAP_RESULT_STATUS_WORD(1)] = (uint32_t)same_code[n][0] << 16;
        CHECK(endat_read_moment(&card, &moment) == ENDAT_OK, "%s", "read");
        CHECK(moment.channel[0].cause == same_code[n][1] && moment.channel[1].cause == same_code[n][2], "code %u: %u, %u",
              same_code[n][0], moment.channel[0].cause, moment.channel[1].cause);
    }
    /* Nobody tells the time: looks are counted, and a limit ends. */
    memory[ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD] = ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK;
    reads = 0;
    CHECK(endat_measure(&card, &moment, 50) == ENDAT_ERROR_TIMEOUT && reads > 500, "%u reads", reads);
    /* No service has begun: it is waited for, not taken for a failure. */
    CHECK(endat_status(&card, 0) == ENDAT_ERROR_BUSY && endat_wait_ready(&card, 0, 1) == ENDAT_ERROR_TIMEOUT, "%s", "start");
}

static void numbers(void)
{
    CHECK(endat_signed(0x0FFFFFFF, 29) == 0x0FFFFFFF && endat_signed(0x10000000, 29) == -0x10000000, "%s", "29 bits");
    CHECK(endat_signed(0x1FFFFFFF, 29) == -1 && endat_signed(1, 1) == -1 && endat_signed(5, 0) == 0, "%s", "corners");
    CHECK(endat_signed(UINT64_C(1) << 47, 48) == -(INT64_C(1) << 47), "%s", "48 bits");
    CHECK(endat_signed(UINT64_C(1) << 63, 64) == INT64_MIN && endat_signed(UINT64_MAX, 64) == -1, "%s", "64 bits");
    CHECK(endat_difference(0x1FFFFFFE, 1, 29) == 3 && endat_difference(1, 0x1FFFFFFE, 29) == -3, "%s", "over the end");
    CHECK(endat_crc16(ENDAT_CRC16_START, (const uint8_t *)"123456789", 9) == 0x29B1, "%s", "CRC-16");
}

static void texts(void)
{
    CHECK(strcmp(endat_cause_text(ENDAT_CAUSE_NO_START_BIT), "no start bit") == 0, "%s", endat_cause_text(2));
    CHECK(strcmp(endat_cause_text(ENDAT_CAUSE_NO_HEADER), "no header") == 0, "%s", endat_cause_text(ENDAT_CAUSE_NO_HEADER));
    CHECK(strcmp(endat_cause_text(18), "unknown") == 0 && strcmp(endat_cause_text(UINT32_MAX), "unknown") == 0, "%s", "beyond");
    for (uint32_t n = 0; n < 64; n++)
        CHECK(endat_cause_text(n)[0] && endat_cause_meaning(n)[0] && endat_cause_remedy(n)[0], "cause %u", (unsigned)n);
    for (int n = 0; n < (int)ENDAT_ERRORS; n++)
        CHECK(endat_error_text((endat_error)n) && endat_error_text((endat_error)n)[0], "error %d", n);
    CHECK(strcmp(endat_error_text(ENDAT_ERRORS), "unknown") == 0, "%s", "beyond");
    CHECK(strcmp(endat_refusal_text(9), "cancelled by the host") == 0, "%s", endat_refusal_text(9));
    CHECK(strcmp(endat_step_text(1), "reset") == 0, "%s", endat_step_text(1));
}

/* The frame of the stream page, in a register that gives four bytes at a time; then with every bit wrong. */
static const uint8_t frame[28] = {0x02, 0x12, 0x06, 0x34, 0x12, 0xEF, 0xCD, 0xAB, 0x05, 0x67, 0x45, 0x23, 0x01, 0x01,
                                  0x02, 0xE0, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x05, 0x20, 0x80, 0x1D, 0xD6, 0x00};
static uint8_t buffer[64];
static uint32_t at;
static uint32_t filled;

static endat_error read_stream(void *context, uint32_t word_address, uint32_t *value)
{
    (void)context;
    *value = memory[word_address];
    if (word_address == ENDAT_MAP_CARD_STREAM_STATE_WORD) {
        *value = filled - at;
    } else if (word_address == ENDAT_MAP_CARD_STREAM_DATA_WORD) {
        *value = 0;
        for (int n = 0; n < 4; n++)
            *value = *value << 8 | (at < filled ? buffer[at++] : 0u);
    }
    return ENDAT_OK;
}

static void streams(void)
{
    const endat_link from_stream = {NULL, read_stream, write_word, NULL, NULL, NULL};
    endat_stream stream;
    endat_card card;
    endat_set set;

    good_card();
    memory[ENDAT_MAP_CARD_CAPABILITIES_WORD] = ENDAT_MAP_CARD_CAPABILITIES_FEATURES_STREAM << 16 | 48u << 8 | 2u;
    CHECK(endat_open(&card, &from_stream, 0) == ENDAT_OK, "%s", "open");
    for (unsigned bit = 0; bit <= 8 * 27; bit++) {
        memcpy(buffer, frame, 28);
        memcpy(buffer + 28, frame, 28);
        if (bit < 8 * 27)
            buffer[bit / 8] ^= (uint8_t)(1u << bit % 8);
        at = 0;
        filled = 56;
        CHECK(endat_stream_start(&card, &stream, true) == ENDAT_OK, "%s", "start");
        endat_error error = endat_stream_next(&card, &stream, &set);
        if (bit < 8 * 27) {
            /* A wrong bit may make another zero: then the damaged set is two. */
            CHECK(error == ENDAT_ERROR_SET, "bit %u: %s", bit, endat_error_text(error));
            while (error == ENDAT_ERROR_SET)
                error = endat_stream_next(&card, &stream, &set);
        }
        CHECK(error == ENDAT_OK && set.sequence == 0x1234 && set.timestamp == 0x00ABCDEF && set.count == 2, "bit %u", bit);
        CHECK(set.sample[0].position == 0x01234567 && set.sample[0].fresh && set.sample[0].taken, "bit %u", bit);
        CHECK(!set.sample[1].fresh && set.sample[1].taken && set.sample[1].missing, "bit %u", bit);
    }
}

/* An SPI on which nobody answers, and one that is always disturbed. */
static unsigned transfers;

static endat_error dead(void *context, const uint8_t *sent, uint8_t *received, uint32_t count)
{
    (void)sent;
    transfers++;
    memset(received, *(const int *)context, count);
    return ENDAT_OK;
}

static void serial(void)
{
    int level = 0xFF;
    endat_spi spi = {.context = &level, .transfer = dead, .tries = 4};
    endat_link over_spi;
    endat_card card;

    endat_spi_link(&spi, &over_spi);
    CHECK(endat_open(&card, &over_spi, 0) == ENDAT_ERROR_CHECKSUM && transfers == 4, "%u transfers", transfers);
    level = 0;
    CHECK(endat_open(&card, &over_spi, 0) == ENDAT_ERROR_CHECKSUM && spi.disturbed == 8, "%u", (unsigned)spi.disturbed);
}

/*
 * A card on SPI as the page on buses has it: words, check sums, the state of the last write. Frames of a list are disturbed: the command
 * byte comes as another one, or a byte of the rest is wrong.
 */
static unsigned frames;
static unsigned spoilt[2];
static bool loses_command;
static bool was_bad;

static endat_error fake_card(void *context, const uint8_t *sent, uint8_t *received, uint32_t count)
{
    uint8_t came[ENDAT_SPI_BYTES];
    const bool is_spoilt = (frames == spoilt[0] || frames == spoilt[1]);
    uint32_t address;

    (void)context;
    frames++;
    memcpy(came, sent, count);
    if (is_spoilt)
        came[loses_command ? 0 : 6] ^= 0x80;
    address = (uint32_t)came[1] << 8 | came[2];
    memset(received, 0, count);
    received[0] = was_bad ? 0xA2 : 0xA0;
    if (came[0] == 2) {
        const uint32_t crc = endat_crc16(ENDAT_CRC16_START, came, 8);
        was_bad = (crc != ((uint32_t)came[8] << 8 | came[9]));
        if (!was_bad)
            memory[address] = (uint32_t)came[4] << 24 | (uint32_t)came[5] << 16 | (uint32_t)came[6] << 8 | came[7];
    } else if (came[0] == 3) {
        const uint32_t word = memory[address];
        uint32_t crc;
        for (int n = 0; n < 4; n++)
            received[5 + n] = (uint8_t)(word >> (24 - 8 * n));
        crc = endat_crc16(endat_crc16(ENDAT_CRC16_START, came, 4), &received[5], 4);
        received[9] = (uint8_t)(crc >> 8);
        received[10] = (uint8_t)crc;
        if (is_spoilt)
            received[6] ^= 1;
    }
    return ENDAT_OK;
}

/* Any two frames around a write are disturbed, in either way: it is told as done exactly when it has arrived. */
static void confirmed_writes(void)
{
    endat_spi spi = {.transfer = fake_card, .tries = 3};
    endat_link over_spi;

    endat_spi_link(&spi, &over_spi);
    for (unsigned ways = 0; ways < 2; ways++) {
        for (unsigned first = 0; first < 12; first++) {
            for (unsigned second = first; second < 12; second++) {
                endat_error error;
                good_card();
                was_bad = false;
                frames = 0;
                loses_command = (ways == 1);
                spoilt[0] = first;
                spoilt[1] = second;
                error = over_spi.write(over_spi.context, 0x100, 0x12345678);
                CHECK((error == ENDAT_OK) == (memory[0x100] == 0x12345678), "frames %u and %u: %s", first, second, endat_error_text(error));
                CHECK(error == ENDAT_OK, "frames %u and %u: %s", first, second, endat_error_text(error));
            }
        }
    }
    /* Without it nobody knows. */
    good_card();
    spi.unconfirmed = true;
    frames = 0;
    spoilt[0] = 0;
    CHECK(over_spi.write(over_spi.context, 0x100, 1) == ENDAT_OK && memory[0x100] == 0 && frames == 1, "%u frames", frames);
}

void alone(void)
{
    identities();
    plates();
    requests();
    positions();
    numbers();
    texts();
    streams();
    serial();
    confirmed_writes();
}
