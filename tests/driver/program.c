/* The driver at a card on a bench: a line goes out for what a hook has to do, and the answer comes back. */
#include "scenarios.h"
#include "endat_transports.h"
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char answer[4096];
static endat_spi spi;
static endat_parallel parallel;
static endat_uart uart;

void check(int is_true, int line, const char *expected, const char *format, ...)
{
    va_list more;

    if (is_true)
        return;
    printf("# line %d: not %s: ", line, expected);
    va_start(more, format);
    vprintf(format, more);
    va_end(more);
    printf("\n");
    exit(1);
}

static void request(void)
{
    printf("\n");
    fflush(stdout);
    if (fgets(answer, sizeof answer, stdin) == NULL)
        exit(3);
    answer[strcspn(answer, "\n")] = 0;
}

uint64_t ask(const char *format, ...)
{
    va_list more;

    va_start(more, format);
    vprintf(format, more);
    va_end(more);
    request();
    return strtoull(answer, NULL, 16);
}

static void put_bytes(const uint8_t *bytes, uint32_t count)
{
    for (uint32_t n = 0; n < count; n++)
        printf("%02x", bytes[n]);
    request();
}

static void take_bytes(uint8_t *bytes, uint32_t count)
{
    for (uint32_t n = 0; n < count; n++) {
        unsigned value = 0;
        check(sscanf(answer + 2 * n, "%2x", &value) == 1, __LINE__, "enough bytes", "%s", answer);
        bytes[n] = (uint8_t)value;
    }
}

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    (void)context;
    *value = (uint32_t)ask("r %" PRIx32, word_address);
    return ENDAT_OK;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    (void)context;
    ask("w %" PRIx32 " %" PRIx32, word_address, value);
    return ENDAT_OK;
}

static uint32_t now_us(void *context)
{
    (void)context;
    return (uint32_t)ask("now");
}

static void wait_us(void *context, uint32_t us)
{
    (void)context;
    ask("delay %" PRIx32, us);
}

static endat_error transfer(void *context, const uint8_t *sent, uint8_t *received, uint32_t count)
{
    (void)context;
    printf("spi ");
    put_bytes(sent, count);
    take_bytes(received, count);
    return ENDAT_OK;
}

static uint16_t get(void *context, uint32_t bus_register)
{
    (void)context;
    return (uint16_t)ask("get %" PRIx32, bus_register);
}

static void put(void *context, uint32_t bus_register, uint16_t value)
{
    (void)context;
    ask("put %" PRIx32 " %x", bus_register, value);
}

static endat_error send_bytes(void *context, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    printf("send ");
    put_bytes(bytes, count);
    return ENDAT_OK;
}

static endat_error receive_bytes(void *context, uint8_t *bytes, uint32_t count)
{
    (void)context;
    ask("receive %" PRIx32, count);
    take_bytes(bytes, count);
    return ENDAT_OK;
}

uint32_t disturbed(void)
{
    return spi.disturbed;
}

void make_link(const char *kind, endat_link *link)
{
    memset(link, 0, sizeof *link);
    if (strcmp(kind, "spi") == 0) {
        spi.transfer = transfer;
        spi.tries = 8;
        endat_spi_link(&spi, link);
    } else if (strcmp(kind, "parallel") == 0) {
        parallel.get = get;
        parallel.put = put;
        endat_parallel_link(&parallel, link);
    } else if (strcmp(kind, "uart") == 0) {
        uart.send = send_bytes;
        uart.receive = receive_bytes;
        endat_uart_link(&uart, link);
    } else {
        link->read = read_word;
        link->write = write_word;
    }
    link->now_us = now_us;
    link->wait_us = wait_us;
}

#define MS 1000u

static endat_card card;
static endat_moment moment;

/* Triggers, and compares what came with what the encoders have sent. */
static void measure_well(void)
{
    endat_error error = endat_measure(&card, &moment, 5 * MS);

    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    for (uint32_t n = 0; n < moment.channels; n++) {
        const endat_result *result = &moment.channel[n];
        const uint64_t sent = ask("position %" PRIx32, n);
        CHECK(result->fresh && result->valid && !result->stale && result->fits, "channel %u, cause %u", (unsigned)n, result->cause);
        CHECK(result->position == sent, "%" PRIx64 " instead of %" PRIx64, result->position, sent);
        CHECK(result->width_bits == (n == 0 ? 29 : 25), "%u bits", result->width_bits);
    }
}

/* Leaves a cycle. */
static void pause_us(uint32_t us)
{
    ask("delay %" PRIx32, us);
}

static void open_card(const char *kind, uint32_t hash)
{
    endat_link link;
    endat_error error;

    make_link(kind, &link);
    error = endat_open(&card, &link, hash ^ 1u);
    CHECK(error == ENDAT_ERROR_CONFIGURATION && card.channels == 0, "%s", endat_error_text(error));
    error = endat_open(&card, &link, hash);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    CHECK(card.channels == 2 && (card.system_hz == 8000000 || endat_protocol(&card, 0) != ENDAT_PROTOCOL_ENDAT || endat_protocol(&card, 1) != ENDAT_PROTOCOL_ENDAT), "%u channels", (unsigned)card.channels);
    error = endat_try_link(&card);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
}

static void wait_for_both(void)
{
    for (uint32_t n = 0; n < card.channels; n++) {
        const endat_error error = endat_wait_ready(&card, n, 1000);
        CHECK(error == ENDAT_OK, "channel %u: %s", (unsigned)n, endat_error_text(error));
    }
}

static void parameters(void)
{
    endat_answer got;
    endat_error error = endat_read_parameter(&card, 0, 0xA1, 0x0D, 200, &got);
    uint16_t bits = 0;
    endat_name_plate plate;

    CHECK(error == ENDAT_OK && got.data == 0x801D && got.address == 0x0D, "%s: %x", endat_error_text(error), got.data);
    error = endat_read_plate(&card, ENDAT_MAP_SERVICE_POSITION_BITS_WORD(1), &bits);
    CHECK(error == ENDAT_OK && (bits & 0x3F) == 25, "%s: %x", endat_error_text(error), bits);
    error = endat_read_name_plate(&card, 1, &plate);
    CHECK(error == ENDAT_OK && strcmp(plate.id, "123456") == 0 && strcmp(plate.serial, "1") == 0 && plate.position_bits == 25, "%s: %s, %s",
          endat_error_text(error), plate.id, plate.serial);
    error = endat_write_parameter(&card, 1, 0xA9, 3, 0x1234, 200, &got);
    CHECK(error == ENDAT_OK && got.time_us > 100, "%s", endat_error_text(error));
    error = endat_read_parameter(&card, 1, 0xA9, 3, 200, &got);
    CHECK(error == ENDAT_OK && got.data == 0x1234, "%s: %x", endat_error_text(error), got.data);
    /* An address that the area does not have. */
    error = endat_read_parameter(&card, 0, 0xA1, 0xF0, 200, &got);
    CHECK(error == ENDAT_ERROR_REFUSED && got.refusal == ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_NO_ANSWER, "%s: %s",
          endat_error_text(error), endat_refusal_text(got.refusal));
    error = endat_send(&card, 0, 0x3F, 0, 0, 200, &got);
    CHECK(error == ENDAT_ERROR_REFUSED && got.refusal == ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_UNKNOWN_COMMAND, "%u", got.refusal);
    /* One that rides on a trigger which never comes is given up, and the next one goes through. */
    error = endat_send(&card, 0, ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_SELECT_MEMORY, 0xA1, 0, 5, &got);
    CHECK(error == ENDAT_ERROR_TIMEOUT, "%s", endat_error_text(error));
    error = endat_read_parameter(&card, 0, 0xA1, 0x0D, 200, &got);
    CHECK(error == ENDAT_OK && got.data == 0x801D, "%s: %x", endat_error_text(error), got.data);
    pause_us(40 * MS);
}

static void additional_data(void)
{
    const uint8_t list[1] = {0x4C};
    const uint8_t wrong[1] = {0xA1};
    uint16_t content = 0;
    uint16_t sequence = 0;
    endat_error error = endat_select_infos(&card, 0, wrong, 1);

    CHECK(error == ENDAT_ERROR_ARGUMENT, "%s", endat_error_text(error));
    error = endat_select_infos(&card, 0, list, 1);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    /* The card finds out what comes: one or two frames end with the pause of an aborted one. */
    for (int n = 0; n < 4; n++) {
        if (endat_measure(&card, &moment, 5 * MS) == ENDAT_OK && moment.channel[0].info[0].came)
            break;
        pause_us(32 * MS);
    }
    CHECK(endat_measure(&card, &moment, 5 * MS) == ENDAT_OK && moment.channel[0].fresh, "cause %u", moment.channel[0].cause);
    CHECK(moment.channel[0].info[0].good && moment.channel[0].info[0].number == 0x0C, "%u", moment.channel[0].info[0].number);
    CHECK(moment.channel[0].info[0].content == 2954 && !moment.channel[1].info[0].came, "%u", moment.channel[0].info[0].content);
    error = endat_read_info(&card, 0, 0, &content, &sequence);
    CHECK(error == ENDAT_OK && content == 2954, "%s: %u", endat_error_text(error), content);
    CHECK((uint16_t)(moment.channel[0].sequence - sequence) < 2, "%u", sequence);
    error = endat_select_infos(&card, 0, list, 0);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    pause_us(200);
}

static void settings(void)
{
    endat_settings before;
    endat_settings now;
    endat_error error = endat_read_settings(&card, 0, &before);
    uint32_t sources = 0;

    CHECK(error == ENDAT_OK && before.position_bits == 29 && before.period_cycles == endat_period(&card, 1000000), "%u",
          (unsigned)before.period_cycles);
    now = before;
    now.period_cycles = 3;
    CHECK(endat_write_settings(&card, 0, &now) == ENDAT_ERROR_ARGUMENT, "period %u", 3u);
    now = before;
    now.command = ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_PARAMETER;
    CHECK(endat_write_settings(&card, 0, &now) == ENDAT_ERROR_ARGUMENT, "command %u", (unsigned)now.command);
    now = before;
    now.start_window_cycles = 64;
    CHECK(endat_write_settings(&card, 0, &now) == ENDAT_ERROR_ARGUMENT, "window %u", 64u);
    now = before;
    now.period_cycles = endat_period(&card, 500000);
    now.start_window_cycles = before.start_window_cycles + 1;
    error = endat_write_settings(&card, 0, &now);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    error = endat_read_word(&card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD, &sources);
    CHECK(error == ENDAT_OK && sources == ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK, "sources %x", (unsigned)sources);
    measure_well();
    pause_us(200);
    error = endat_write_settings(&card, 0, &before);
    CHECK(error == ENDAT_OK && endat_read_settings(&card, 0, &now) == ENDAT_OK, "%s", endat_error_text(error));
    CHECK(now.period_cycles == before.period_cycles && now.start_window_cycles == before.start_window_cycles, "%u",
          (unsigned)now.period_cycles);
    CHECK(endat_set_triggers(&card, 0, 0) == ENDAT_OK, "%s", "no sources");
    error = endat_measure(&card, &moment, 1 * MS);
    CHECK(error == ENDAT_ERROR_TRIGGER_OFF, "%s", endat_error_text(error));
    CHECK(endat_set_triggers(&card, sources, 3) == ENDAT_ERROR_ARGUMENT, "%s", "period of the timer");
    CHECK(endat_set_triggers(&card, sources, 0) == ENDAT_OK, "%s", "sources again");
    CHECK(endat_calibrate(&card, 3) == ENDAT_OK, "%s", "calibrate");
    measure_well();
    pause_us(200);
    /* A timer that has a trigger under way at nearly every moment. */
    error = endat_set_triggers(&card, sources | ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_MASK, card.system_hz / 1000000u);
    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    for (int n = 0; n < 6; n++) {
        error = endat_measure(&card, &moment, 1 * MS);
        CHECK(error == ENDAT_OK && moment.channel[0].fresh && !moment.channel[0].stale && !moment.channel[1].stale, "%s %d",
              endat_error_text(error), n);
    }
    CHECK(endat_set_triggers(&card, sources, 0) == ENDAT_OK, "%s", "sources again");
    pause_us(200);
}

static void wrong_crc(void)
{
    endat_error error;
    uint64_t held;

    measure_well();
    held = moment.channel[0].position;
    pause_us(200);
    ask("crc 0");
    error = endat_measure(&card, &moment, 5 * MS);
    CHECK(error == ENDAT_OK && !moment.channel[0].fresh && moment.channel[0].valid, "%s", endat_error_text(error));
    CHECK(moment.channel[0].cause == ENDAT_CAUSE_CRC, "%s", endat_cause_text(moment.channel[0].cause));
    CHECK(moment.channel[0].position == held && moment.channel[1].fresh, "%" PRIx64, moment.channel[0].position);
    pause_us(200);
    measure_well();
    pause_us(200);
}

static void alarms(void)
{
    endat_state state = {0};

    CHECK(endat_set_alarm(&card, 0, 1, 17) == ENDAT_ERROR_ARGUMENT, "%s", "17 frames");
    CHECK(endat_set_alarm(&card, 0, 1, 4) == ENDAT_OK, "%s", "threshold");
    wrong_crc();
    CHECK(endat_read_state(&card, 0, &state) == ENDAT_OK && state.alarm && state.endat22 && state.initialised, "%d", state.alarm);
    CHECK(endat_read_state(&card, 1, &state) == ENDAT_OK && !state.alarm && !state.unplugged && state.starts == 1, "%u", state.starts);
    CHECK(endat_set_alarm(&card, 0, 0, 4) == ENDAT_OK && endat_clear(&card, 0) == ENDAT_OK, "%s", "clear");
    pause_us(1 * MS);
    CHECK(endat_read_state(&card, 0, &state) == ENDAT_OK && !state.alarm, "%d", state.alarm);
}

static void interrupts(void)
{
    const uint32_t result_1 = ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_RESULT << ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_SHIFT;
    uint32_t events = 0;

    CHECK(endat_take_interrupts(&card, &events) == ENDAT_OK, "%s", "take");
    CHECK(endat_take_interrupts(&card, &events) == ENDAT_OK && events == 0, "%x", (unsigned)events);
    CHECK(ask("irq") == 0 && endat_enable_interrupts(&card, result_1) == ENDAT_OK, "%s", "irq_o");
    measure_well();
    CHECK(ask("irq") == 1, "%s", "irq_o");
    CHECK(endat_take_interrupts(&card, &events) == ENDAT_OK && (events & result_1) != 0, "%x", (unsigned)events);
    CHECK(ask("irq") == 0 && endat_enable_interrupts(&card, 0) == ENDAT_OK, "%s", "irq_o");
    pause_us(200);
}

static void initialise_again(void)
{
    uint32_t step = 1;

    CHECK(endat_initialise(&card, 0) == ENDAT_OK, "%s", "initialise");
    pause_us(1 * MS);
    CHECK(endat_status(&card, 0) == ENDAT_ERROR_BUSY, "%s", endat_error_text(endat_status(&card, 0)));
    wait_for_both();
    CHECK(endat_failed_step(&card, 0, &step) == ENDAT_OK && step == 0, "%s", endat_step_text(step));
    measure_well();
    pause_us(200);
}

/* The encoder of channel 1 is there, and never answers. */
static void broken(void)
{
    uint32_t step = 0;

    CHECK(endat_wait_ready(&card, 0, 1000) == ENDAT_OK, "%s", endat_error_text(endat_status(&card, 0)));
    CHECK(endat_wait_ready(&card, 1, 2000) == ENDAT_ERROR_INITIALISATION, "%s", endat_error_text(endat_status(&card, 1)));
    CHECK(endat_failed_step(&card, 1, &step) == ENDAT_OK && step != 0, "%s", endat_step_text(step));
}

/* The plug of channel 0 is pulled, and put back. */
static void plug(int has_service)
{
    endat_answer got;
    endat_error error;
    uint16_t good;

    measure_well();
    good = moment.channel[0].sequence;
    pause_us(200);
    ask("unplug 0 20 0");
    pause_us(10 * MS);
    error = endat_measure(&card, &moment, 2 * MS);
    CHECK(!moment.channel[0].fresh || (moment.channel[0].stale && moment.channel[0].sequence == good), "%s", endat_error_text(error));
    CHECK(moment.channel[1].fresh, "channel 1: %s", endat_cause_text(moment.channel[1].cause));
    CHECK(endat_status(&card, 0) == ENDAT_ERROR_UNPLUGGED, "%s, cause %u", endat_error_text(endat_status(&card, 0)),
          moment.channel[0].cause);
    CHECK(endat_status(&card, 1) == ENDAT_OK, "%s", endat_error_text(endat_status(&card, 1)));
    if (has_service) {
        error = endat_measure(&card, &moment, 2 * MS);
        CHECK(error == ENDAT_ERROR_TIMEOUT && moment.channel[0].stale && moment.channel[1].fresh, "%s", endat_error_text(error));
        error = endat_read_parameter(&card, 0, 0xA1, 0x0D, 200, &got);
        CHECK(error == ENDAT_ERROR_UNPLUGGED, "%s", endat_error_text(error));
        error = endat_wait_ready(&card, 0, 5);
        CHECK(error == ENDAT_ERROR_UNPLUGGED, "%s", endat_error_text(error));
        error = endat_wait_ready(&card, 0, 2000);
        CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    } else {
        pause_us(50 * MS);
        (void)endat_measure(&card, &moment, 5 * MS);
        pause_us(32 * MS);
    }
    measure_well();
    CHECK(endat_status(&card, 0) == ENDAT_OK, "%s", endat_error_text(endat_status(&card, 0)));
    pause_us(200);
}

static void stream(void)
{
    static endat_stream reader;
    endat_set set;
    endat_error error = endat_stream_start(&card, &reader, 1);
    uint16_t sequence = 0;

    CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
    CHECK(endat_stream_next(&card, &reader, &set) == ENDAT_NOTHING, "%s", "empty");
    for (int n = 0; n < 5; n++) {
        measure_well();
        pause_us(300);
        if (n == 2)
            continue;
        for (int sets = (n == 3) ? 2 : 1; sets > 0; sets--) {
            error = endat_stream_next(&card, &reader, &set);
            CHECK(error == ENDAT_OK && set.count == 2 && set.first == 0 && set.lost == 0, "%s", endat_error_text(error));
            CHECK(sequence == 0 || set.sequence == (uint16_t)(sequence + 1), "%u", set.sequence);
            sequence = set.sequence;
        }
        for (uint32_t c = 0; c < 2; c++) {
            const endat_sample *sample = &set.sample[c];
            CHECK(sample->taken && sample->fresh && sample->valid && !sample->missing && sample->cause == 0, "%u", sample->cause);
            CHECK(sample->position == moment.channel[c].position, "%" PRIx64, sample->position);
        }
    }
    error = endat_stream_next(&card, &reader, &set);
    CHECK(error == ENDAT_NOTHING, "%s", endat_error_text(error));
    CHECK(endat_stream_start(&card, &reader, 0) == ENDAT_OK, "%s", "stop");
}

/* Everything, on a card that has everything. */
static void journey(void)
{
    CHECK(endat_status(&card, 0) == ENDAT_ERROR_BUSY, "%s", endat_error_text(endat_status(&card, 0)));
    CHECK(endat_wait_ready(&card, 0, 1) == ENDAT_ERROR_TIMEOUT, "%s", "too early");
    wait_for_both();
    measure_well();
    pause_us(200);
    settings();
    parameters();
    measure_well();
    pause_us(200);
    wrong_crc();
    alarms();
    interrupts();
    initialise_again();
    stream();
    plug(1);
    additional_data();
}

/* A position, a parameter, a plug. */
static void short_journey(void)
{
    endat_answer got;
    endat_error error;

    wait_for_both();
    measure_well();
    pause_us(200);
    error = endat_read_parameter(&card, 1, 0xA1, 0x0D, 200, &got);
    CHECK(error == ENDAT_OK && got.data == 0x8019, "%s: %x", endat_error_text(error), got.data);
    pause_us(40 * MS);
    wrong_crc();
    plug(1);
}

/* A card without any part. */
static void bare(void)
{
    endat_stream reader;
    endat_answer got;
    uint32_t events;

    CHECK(endat_wait_ready(&card, 0, 10) == ENDAT_OK, "%s", "nothing to wait for");
    CHECK(endat_read_parameter(&card, 0, 0xA1, 0x0D, 10, &got) == ENDAT_ERROR_PART, "%s", "requests");
    CHECK(endat_initialise(&card, 0) == ENDAT_ERROR_PART, "%s", "initialise");
    CHECK(endat_stream_start(&card, &reader, 1) == ENDAT_ERROR_PART, "%s", "stream");
    CHECK(endat_take_interrupts(&card, &events) == ENDAT_ERROR_PART, "%s", "interrupt");
    CHECK(endat_read_parameter(&card, 2, 0xA1, 0x0D, 10, &got) == ENDAT_ERROR_ARGUMENT, "%s", "channel 2");
    measure_well();
    pause_us(200);
    wrong_crc();
    plug(0);
}

/* Reads that are so far apart that results come between: the moment is one all the same. */
static void torn(void)
{
    wait_for_both();
    measure_well();
    CHECK(endat_set_triggers(&card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_MASK, card.system_hz / 5000) == ENDAT_OK, "%s",
          "timer");
    ask("slow 14");
    for (int n = 0; n < 12; n++) {
        uint32_t hold = 1;
        const endat_error error = endat_read_moment(&card, &moment);
        CHECK(error == ENDAT_OK, "%s", endat_error_text(error));
        CHECK(moment.channel[0].timestamp == moment.channel[1].timestamp, "%" PRIu32 " and %" PRIu32, moment.channel[0].timestamp,
              moment.channel[1].timestamp);
        CHECK(moment.channel[0].fits && moment.channel[0].fresh && moment.channel[1].fresh, "%u", moment.channel[0].cause);
        CHECK(endat_read_word(&card, ENDAT_MAP_CARD_CONFIG_HOLD_WORD, &hold) == ENDAT_OK && (hold & 1) == 0, "%s", "hold");
    }
}

/* Good positions only, while one of some frames is disturbed; then parameters and settings, if asked for. */
static void noisy(int positions, int has_more)
{
    wait_for_both();
    for (int n = 0; n < positions; n++) {
        measure_well();
        pause_us(200);
    }
    if (has_more) {
        parameters();
        settings();
    }
    CHECK(disturbed() > 0, "%u frames went out again", (unsigned)disturbed());
}

/* The emitted card with the emitted encoder, which knows 100011 and says address and inverted address. */
static void emitted(void)
{
    endat_answer got;
    endat_error error;

    wait_for_both();
    measure_well();
    pause_us(200);
    error = endat_send(&card, 0, ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_PARAMETER, 0x0D, 0, 200, &got);
    CHECK(error == ENDAT_OK && got.address == 0x0D && got.data == 0xF20D, "%s: %x", endat_error_text(error), got.data);
    pause_us(2 * MS);
    wrong_crc();
    plug(1);
}

/* The program of the page, which wants to see a plug pulled. */
endat_error first_angles(const endat_link *link);
static unsigned shown;

void show_position(int64_t position)
{
    static uint64_t shown_frames;
    const uint64_t sent = ask("position 0");
    const uint64_t frames = ask("frames 0");

    CHECK(position == endat_signed(sent, 29), "%" PRId64, position);
    CHECK(frames > shown_frames, "%" PRId64 " is an old position", position);
    shown_frames = frames;
    shown++;
    pause_us(200);
}

void show_text(const char *text)
{
    printf("# %s\n", text);
}

static void page(void)
{
    endat_link link;
    endat_error error;

    make_link("words", &link);
    ask("unplug 0 18 64");
    error = first_angles(&link);
    CHECK(error == ENDAT_OK && shown > 10, "%s, %u positions", endat_error_text(error), shown);
}

int main(int count, char **arguments)
{
    const char *scenario = (count > 2) ? arguments[2] : "";

    if (strcmp(scenario, "alone") == 0) {
        alone();
        return 0;
    }
    if (count != 4)
        return 2;
    if (strcmp(scenario, "page") == 0) {
        page();
        return 0;
    }
    open_card(arguments[1], (uint32_t)strtoul(arguments[3], NULL, 16));
    if (strcmp(scenario, "journey") == 0)
        journey();
    else if (strcmp(scenario, "short") == 0)
        short_journey();
    else if (strcmp(scenario, "bare") == 0)
        bare();
    else if (strcmp(scenario, "torn") == 0)
        torn();
    else if (strcmp(scenario, "noisy") == 0)
        noisy(30, 1);
    else if (strcmp(scenario, "noisy positions") == 0)
        noisy(20, 0);
    else if (strcmp(scenario, "broken") == 0)
        broken();
    else if (strcmp(scenario, "emitted") == 0)
        emitted();
    else if (strcmp(scenario, "t_format") == 0)
        t_format(&card);
    else
        return 2;
    CHECK(ask("violations") == 0, "%s", "the encoders saw something wrong");
    return 0;
}
