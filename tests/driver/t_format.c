/* The calls for a T-format encoder, at a card that has one at channel 1; its timer triggers both channels. */
#include "scenarios.h"
#include <string.h>

enum { ENDAT, T_FORMAT };
#define LIMIT_MS 50u

static void content(endat_error error, int line)
{
    check(error == ENDAT_OK, line, "ENDAT_OK", "%s", endat_error_text(error));
}
#define GOOD(call) content((call), __LINE__)
#define IS(call, wanted) CHECK((call) == (wanted), "%s", endat_error_text(call))

static uint64_t turns(const endat_card *card)
{
    endat_moment moment;

    GOOD(endat_read_moment(card, &moment));
    CHECK(moment.channel[T_FORMAT].fresh, "cause %u", moment.channel[T_FORMAT].cause);
    return moment.channel[T_FORMAT].position >> 24;
}

static void requests(const endat_card *card)
{
    endat_reply reply;
    endat_fields fields;

    GOOD(endat_exchange(card, T_FORMAT, ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING, 0, 0, LIMIT_MS, &reply));
    CHECK(reply.id == ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING && reply.cause == 0, "ID %u, cause %u", reply.id, reply.cause);
    GOOD(endat_read_fields(card, T_FORMAT, &fields));
    CHECK(fields.encoder_id == 0x17 && fields.alarm == 0, "%x", fields.encoder_id);
    CHECK(fields.has_single_turn && fields.has_multi_turn, "parts");
    IS(endat_exchange(card, T_FORMAT, 4, 0, 0, LIMIT_MS, &reply), ENDAT_ERROR_EXCHANGE);
    CHECK(reply.cause == ENDAT_CAUSE_UNKNOWN_COMMAND, "%s", endat_cause_text(reply.cause));
    IS(endat_exchange(card, T_FORMAT, 16, 0, 0, LIMIT_MS, &reply), ENDAT_ERROR_ARGUMENT);
    IS(endat_exchange(card, ENDAT, 3, 0, 0, LIMIT_MS, &reply), ENDAT_ERROR_PROTOCOL);
    IS(endat_exchange(card, 2, 3, 0, 0, LIMIT_MS, &reply), ENDAT_ERROR_ARGUMENT);
}

static void eeprom(const endat_card *card)
{
    endat_reply reply;

    for (uint32_t address = 1; address < 4; address++)
        GOOD(endat_write_eeprom(card, T_FORMAT, address, (uint8_t)(0x5A + address), LIMIT_MS, &reply));
    for (uint32_t address = 1; address < 4; address++) {
        GOOD(endat_read_eeprom(card, T_FORMAT, address, LIMIT_MS, &reply));
        CHECK(reply.data == 0x5A + address, "%x at %x", reply.data, (unsigned)address);
    }
    /* It is written and not yet read back: the EEPROM takes its time. */
    IS(endat_write_eeprom(card, T_FORMAT, 1, 0xA5, 0, &reply), ENDAT_ERROR_BUSY);
    CHECK(reply.cause == ENDAT_CAUSE_EEPROM_BUSY, "%s", endat_cause_text(reply.cause));
    GOOD(endat_read_eeprom(card, T_FORMAT, 1, LIMIT_MS, &reply));
    CHECK(reply.data == 0xA5, "%x", reply.data);
    IS(endat_read_eeprom(card, T_FORMAT, 128, LIMIT_MS, &reply), ENDAT_ERROR_ARGUMENT);
    IS(endat_read_eeprom(card, ENDAT, 1, LIMIT_MS, &reply), ENDAT_ERROR_PROTOCOL);
}

/* A request that is lost on the way is not told as done: the answer of before is none of it. */
static void lost(const endat_card *card)
{
    endat_reply reply;

    for (uint32_t first = 1; first < 4; first++) {
        for (uint32_t write = 1; write < 4; write++) {
            GOOD(endat_write_eeprom(card, T_FORMAT, 9, 0x11, LIMIT_MS, &reply));
            GOOD(endat_write_eeprom(card, T_FORMAT, 10, 0x22, LIMIT_MS, &reply));
            ask("lose %x", (unsigned)first);
            GOOD(endat_read_eeprom(card, T_FORMAT, 9, LIMIT_MS, &reply));
            CHECK(reply.data == 0x11 && reply.id == ENDAT_MAP_T_FORMAT_SEND_ID_READ_EEPROM, "%x", reply.data);
            ask("lose %x", (unsigned)write);
            GOOD(endat_write_eeprom(card, T_FORMAT, 9, 0x33, LIMIT_MS, &reply));
            ask("lose 0");
            GOOD(endat_read_eeprom(card, T_FORMAT, 9, LIMIT_MS, &reply));
            CHECK(reply.data == 0x33, "%x", reply.data);
        }
    }
}

static void settings(const endat_card *card)
{
    endat_t_format_settings before;
    endat_t_format_settings after;
    endat_settings other;

    GOOD(endat_read_t_format_settings(card, T_FORMAT, &before));
    CHECK(before.bit_cycles == endat_period(card, 2500000) && before.request_id == 3, "%u cycles", (unsigned)before.bit_cycles);
    CHECK(before.reply_gap_us == 20 && before.field_gap_us == 2, "%u us", (unsigned)before.reply_gap_us);
    after = before;
    after.bit_cycles = 7;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after = before;
    after.request_id = ENDAT_MAP_T_FORMAT_SEND_ID_WRITE_EEPROM;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after.request_id = 5;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after.request_id = ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_ERRORS;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after = before;
    after.filter_cycles = before.bit_cycles / 2;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after = before;
    after.request_id = ENDAT_MAP_T_FORMAT_SEND_ID_MULTI_TURN;
    after.reply_gap_us = 64;
    IS(endat_write_t_format_settings(card, T_FORMAT, &after), ENDAT_ERROR_ARGUMENT);
    after.reply_gap_us = 63;
    after.field_gap_us = 7;
    after.filter_cycles = 2;
    GOOD(endat_write_t_format_settings(card, T_FORMAT, &after));
    GOOD(endat_read_t_format_settings(card, T_FORMAT, &before));
    CHECK(memcmp(&before, &after, sizeof after) == 0, "%u us", (unsigned)before.reply_gap_us);
    after.request_id = ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING;
    GOOD(endat_write_t_format_settings(card, T_FORMAT, &after));
    IS(endat_read_settings(card, T_FORMAT, &other), ENDAT_ERROR_PROTOCOL);
    IS(endat_read_t_format_settings(card, ENDAT, &after), ENDAT_ERROR_PROTOCOL);
}

void t_format(const endat_card *card)
{
    endat_reply reply;

    ask("delay 7d0");
    CHECK(turns(card) == 200, "%u turns", (unsigned)turns(card));
    requests(card);
    eeprom(card);
    settings(card);
    lost(card);
    IS(endat_reset_encoder(card, T_FORMAT, ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING, LIMIT_MS, &reply), ENDAT_ERROR_ARGUMENT);
    GOOD(endat_reset_encoder(card, T_FORMAT, ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_MULTI_TURN, LIMIT_MS, &reply));
    ask("delay 3e8");
    CHECK(turns(card) == 0, "%u turns", (unsigned)turns(card));
}
