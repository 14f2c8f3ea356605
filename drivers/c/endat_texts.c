/**
 * @file endat_texts.c
 * What the numbers of a card say, and what to do about them.
 *
 * Written by endat-gen from its register table. Do not edit: UPDATE_EXPECT=1 cargo test --test cards driver writes it again.
 */
#include "endat.h"
#include "endat_internal.h"
#include <stddef.h>

/* Causes of T-format, each at its code */
static const uint8_t t_format_causes[] = {
    ENDAT_CAUSE_NONE,
    ENDAT_CAUSE_UNKNOWN_COMMAND,
    ENDAT_CAUSE_LINE_NOT_IDLE,
    ENDAT_CAUSE_NO_ANSWER,
    ENDAT_CAUSE_NO_HEADER,
    ENDAT_CAUSE_CONTROL_PARITY,
    ENDAT_CAUSE_REPLY_ECHO,
    ENDAT_CAUSE_DELIMITER,
    ENDAT_CAUSE_FIELD_MISSING,
    ENDAT_CAUSE_REPLY_CRC,
    ENDAT_CAUSE_REQUEST_PARITY,
    ENDAT_CAUSE_REQUEST_DELIMITER,
    ENDAT_CAUSE_EEPROM_BUSY,
    ENDAT_CAUSE_COUNTING_ERROR,
    ENDAT_CAUSE_MULTI_TURN_ALARM,
    ENDAT_CAUSE_UPSET,
    ENDAT_CAUSE_TRIGGER_OVERRUN,
};

/* Causes of SSI, each at its code */
static const uint8_t ssi_causes[] = {
    ENDAT_CAUSE_NONE,
    ENDAT_CAUSE_UNKNOWN_FRAME,
    ENDAT_CAUSE_DATA_NOT_HIGH,
    ENDAT_CAUSE_DATA_NOT_LOW_AFTER,
    ENDAT_CAUSE_POSITION_PARITY,
    ENDAT_CAUSE_COPIES_DIFFER,
    ENDAT_CAUSE_UPSET,
    ENDAT_CAUSE_TRIGGER_OVERRUN,
    ENDAT_CAUSE_RECOVERY_TOO_LONG,
    ENDAT_CAUSE_ENCODER_ALARM,
    ENDAT_CAUSE_POWER_FAIL,
    ENDAT_CAUSE_POSITION_NOT_VALID,
    ENDAT_CAUSE_POSITION_CRC,
};

uint8_t endat_cause_of(uint32_t code, uint32_t protocol)
{
    uint32_t cause = code;

    if (protocol == ENDAT_PROTOCOL_T_FORMAT) {
        cause = (code < (uint32_t)sizeof t_format_causes) ? t_format_causes[code] : (32u + code);
    }
    if (protocol == ENDAT_PROTOCOL_SSI) {
        cause = (code < (uint32_t)sizeof ssi_causes) ? ssi_causes[code] : (64u + code);
    }
    return (uint8_t)cause;
}

uint32_t endat_protocol_of(uint32_t word, uint32_t channel)
{
    uint32_t protocol = ENDAT_PROTOCOL_ENDAT;

    if (((ENDAT_MAP_GET(ENDAT_MAP_CARD_PROTOCOLS_T_FORMAT, word) >> channel) & 1u) != 0u) {
        protocol = ENDAT_PROTOCOL_T_FORMAT;
    }
    if (((ENDAT_MAP_GET(ENDAT_MAP_CARD_PROTOCOLS_SSI, word) >> channel) & 1u) != 0u) {
        protocol = ENDAT_PROTOCOL_SSI;
    }
    return protocol;
}

/* Causes of a result */
static const char *const causes[] = {
    "none",
    "data not low before start",
    "no start bit",
    "start bit outside its window",
    "CRC",
    "F1",
    "F2",
    "data not falling after the frame",
    "trigger overrun",
    "unknown mode command",
    "additional data missing",
    "no encoder",
    "data stuck high",
    "data stuck low",
    "late start bit",
    "watchdog",
    "echo of the own command",
    "recovery time too short",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "stored data upset",
    NULL,
    NULL,
    "line not idle",
    "no answer",
    "no header",
    "parity of the control field",
    "another ID or address in the reply",
    "delimiter",
    "field missing",
    "CRC",
    "encoder saw a parity error",
    "encoder saw a delimiter error",
    "EEPROM busy",
    "counting error",
    "multi-turn or battery alarm",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "unknown kind of frame",
    "data not high before the frame",
    "data not low after the last bit",
    "parity of the position",
    "the two copies differ",
    NULL,
    NULL,
    "recovery time too long",
    "alarm of the encoder",
    "power failure of the encoder",
    "the encoder marks the position not valid",
    "CRC of the position",
};

const char *endat_cause_text(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof causes / sizeof causes[0])) {
        text = causes[number];
    }
    return (text != NULL) ? text : "unknown";
}

/* What they mean */
static const char *const meanings[] = {
    "The frame was good.",
    "DATA was HIGH before the frame began: the line is open, the encoder has no supply, or it is lost within a frame.",
    "The encoder did not answer: no encoder is connected and the open line reads LOW; or it rejects the mode command; or it needs a longer calculation time than configured.",
    "The start bit came at another phase than expected: a glitch, another cable, or another tcal than configured.",
    "The CRC of the answer is wrong: a bit was disturbed, the width is not the encoder's, or DATA is sampled near an edge.",
    "The encoder reports an alarm in F1: a malfunction that can lead to wrong positions.",
    "The encoder reports an alarm in F2, found independently of F1.",
    "DATA stayed HIGH after the frame for longer than recovery_max_ns: the encoder sends more bits than configured or has a longer recovery time. With the flag tail_low DATA was LOW one clock after the CRC: the encoder has another width, or does not hold DATA HIGH for its recovery time. The flags also show a wrong CRC and alarms of the same frame.",
    "A trigger arrived while a frame or a T-format exchange was under way; its position is good.",
    "Nothing was sent: the configured command is not a mode command, the T-format request is not one that a trigger may send, or the period is too short for additional data.",
    "The expected additional data did not arrive: the frame has another length than it should have, so its position is rejected.",
    "No encoder is connected: DATA is HIGH, and LOW when the card drives it.",
    "DATA stays HIGH while the card drives it LOW.",
    "DATA stays LOW: the card does not even receive its own mode command.",
    "The start bit came after the limit.",
    "The frame exceeded limits.watchdog_us.",
    "The card received its own mode command.",
    "DATA fell before limits.recovery_min_cycles: the encoder has another recovery time than configured; the position is good.",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "A register of the card, or a word on its way to the host, was disturbed: the stored value does not match its CRC or parity.",
    NULL,
    NULL,
    "Nothing was sent: the T-format line was LOW, or had not been idle for long enough after a bad reply.",
    "The T-format encoder did not answer within the reply gap.",
    "The T-format encoder sent something, but no control field with start bit and sync code.",
    "The parity of the ID in the reply is wrong: a bit was disturbed.",
    "The reply has another request ID or EEPROM address than the request.",
    "A field of the reply ends with a LOW bit: it was disturbed, or the bit rate differs.",
    "A field of the reply did not begin in time.",
    "The CRC of the T-format reply is wrong: a bit was disturbed.",
    "The encoder reports a parity error in the request: the line to the encoder is disturbed.",
    "The encoder reports a delimiter error in the request: the line to the encoder is disturbed.",
    "The encoder's EEPROM is still writing the last byte; the data in the reply are invalid.",
    "The encoder reports a counting error; the position is valid.",
    "The encoder reports a multi-turn, overflow or battery alarm; the position is valid, but its turns may be wrong.",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "Nothing was clocked: config<n>.frame.command of an SSI channel has no bit 2, or the stored configuration was disturbed.",
    "DATA of an SSI encoder was LOW when a frame was to begin (nothing was clocked), or at the first rising edge of CLOCK. The encoder still holds its last position or has no supply, or the pair is swapped or shorted.",
    "DATA was HIGH after the last bit, or between two copies: no encoder is connected, it has another width than configured or keeps its last bit on the line, or its bits arrive too late for this clock.",
    "A parity bit does not match the bits before it: a bit was disturbed, or the encoder has no parity or the other polarity.",
    "The encoder sent the position twice, and the copies differ: a bit was disturbed, or the encoder samples a new position for each copy.",
    NULL,
    NULL,
    "After a frame DATA was still LOW when recovery_max_ns had passed: the line is broken or shorted, or the encoder needs longer than configured. The position of that frame is withdrawn. The next result has this cause, too, with a good position.",
    "The bit that bits_before or bits_after names alarm is active: the encoder cannot guarantee its position. The card rejects it.",
    "The bit that bits_before or bits_after names power_fail is active: the encoder's supply is too low. The card rejects the position.",
    "The bit that bits_before or bits_after names valid is not set: the encoder is starting, moves too fast, or has lost its magnet or scale. The card rejects the position.",
    "The CRC in bits_after does not match the bits before it: a bit was disturbed, or the frame has other bits than configured.",
};

const char *endat_cause_meaning(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof meanings / sizeof meanings[0])) {
        text = meanings[number];
    }
    return (text != NULL) ? text : "unknown";
}

/* What to do about them */
static const char *const remedies[] = {
    "Nothing.",
    "Look at plug and supply. The card waits 30 ms and tries again.",
    "Without an encoder: fit the fail-safe bias, so that an open line reads HIGH. Otherwise try the command 000111, raise tcal_max_ns or lower the clock. If even the slow frames that measure the delay fail: tcal_max_ns applies to them, too (a start bit at clock 15 needs 28000 at 200 kHz). An encoder that ends a frame after 2 us of HIGH needs a faster calibration_hz.",
    "Increase start_window_ns, or filter_ns against glitches. The card measures the line delay again.",
    "Compare position_bits with the data sheet; look at `margin`; lower the clock; check termination and shield.",
    "Read the alarms (`param read 0xB9 0`), then clear them with the command 101101. An alarm after power-up is normal.",
    "See f1.",
    "Compare position_bits and recovery_max_ns with the data sheet. An EnDat encoder does not end its frame LOW.",
    "Trigger more slowly; `explain` prints the highest rate.",
    "Write 7 (000111) or 56 (111000) to config<n>.frame.command, 4 or more to .period_cycles; on a T-format channel 3 to config<n>.timing.request_id.",
    "The card detects from the next frames what the encoder sends.",
    "Connect the encoder; the card continues without intervention.",
    "Check for a short circuit to the supply, and check the driver enable.",
    "Check for a short circuit or a swapped pair, and that the receiver stays enabled while sending.",
    "Raise tcal_max_ns to the value of the encoder.",
    "Compare limits.watchdog_us with the encoder's times.",
    "Check for a converter that echoes what it receives, or for a swapped pair.",
    "Set recovery_min_ns to the encoder's setting.",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "If it is rare, nothing: the next trigger brings a new position. Otherwise check supply, clock and timing of the device. With a second receiver the cause also means that the receivers disagreed, or that `force` made them disagree.",
    NULL,
    NULL,
    "Trigger more slowly after faults; check for a short circuit, and for an encoder that is still sending.",
    "Check plug, supply and pair; compare bit_hz with the data sheet; raise reply_gap_us.",
    "Compare bit_hz with the data sheet; check termination and shield; raise filter_ns against short pulses.",
    "Check termination and shield.",
    "Check for a second encoder on the pair, or for a disturbed line.",
    "Compare bit_hz with the data sheet; check termination and shield.",
    "Raise field_gap_us; check whether the encoder supports this request.",
    "Check termination and shield; t_format<n>.fields shows the received fields.",
    "Check termination and shield, and that the driver stays enabled while sending.",
    "See request_parity; compare bit_hz with the data sheet.",
    "Send the request again after some milliseconds.",
    "Turn the power off and on, or send request 7 ten times in a row.",
    "Check t_format<n>.fields.alarm and the battery; then send request 7 or 12 ten times in a row.",
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    NULL,
    "Write the configuration again: 4 to config<n>.frame.command, 5 for Gray code, 6 and 7 for the same sent twice.",
    "Check plug, supply and pair; trigger more slowly; compare recovery_max_ns with the encoder's monoflop time.",
    "Check plug and supply; compare position_bits and end_low with the data sheet; lower clock_hz.",
    "Check termination and shield; lower clock_hz; compare parity and bits_after with the data sheet.",
    "Check termination and shield; lower clock_hz; remove twice if the encoder does not repeat the position.",
    NULL,
    NULL,
    "Check plug and pair; raise recovery_max_ns to the encoder's monoflop time.",
    "Look up the bit in the encoder's data sheet; compare bits_before, bits_after and position_bits with it.",
    "Check supply, cable and plug, and the voltage at the encoder; compare bits_before, bits_after and position_bits with the data sheet.",
    "Look up the bit in the encoder's data sheet; compare bits_before, bits_after and position_bits with it.",
    "Check termination and shield; lower clock_hz; compare bits_before, bits_after and position_bits with the data sheet.",
};

const char *endat_cause_remedy(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof remedies / sizeof remedies[0])) {
        text = remedies[number];
    }
    return (text != NULL) ? text : "unknown";
}

/* What became of a request */
static const char *const refusals[] = {
    "fulfilled",
    "no answer: command not understood or refused",
    "echo of MRS code, address or port wrong",
    "echo of data wrong",
    "CRC of the answer wrong",
    "unknown mode command, nothing was sent",
    "frame failed or could not begin",
    "encoder stayed busy",
    "no trigger came in time for a request that waits for one",
    "cancelled by the host",
};

const char *endat_refusal_text(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof refusals / sizeof refusals[0])) {
        text = refusals[number];
    }
    return (text != NULL) ? text : "unknown";
}

/* Steps of the initialisation */
static const char *const steps[] = {
    "none",
    "reset",
    "select memory area 0xB9",
    "read alarms",
    "read warnings",
    "write 0 to word 0",
    "write 0 to word 1",
    "select memory area 0xA1",
    "read position_bits",
    "take over the position width",
    "read encoder_type",
    "read signal_periods_low",
    "select memory area 0xA3",
    "read signal_periods_high",
    "read revolutions",
    "read steps_low",
    "read steps_high",
    "read id_0",
    "read id_1",
    "read id_2",
    "read serial_0",
    "read serial_1",
    "read serial_2",
    "select memory area 0xA5",
    "read commands",
    "read tcal",
    "find out whether it knows EnDat 2.2",
    "select memory area 0xBD",
    "read infos_1",
    "read infos_2",
    "read clock_max_khz",
    "choose the clock",
    "select memory area 0xB9",
    "read recovery",
    "set the recovery time",
};

const char *endat_step_text(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof steps / sizeof steps[0])) {
        text = steps[number];
    }
    return (text != NULL) ? text : "unknown";
}

/* Words of the name plate */
static const char *const plate[] = {
    "Alarms before they were cleared",
    "Warnings before they were cleared",
    "Word 13: clock pulses for the position in bits 5..0",
    "Word 14: bit 15: 1 = rotary, 0 = linear",
    "Word 15: signal periods per revolution, or in nm",
    "Word 16: upper part of word 15",
    "Word 17: distinguishable revolutions",
    "Word 20: measuring steps per revolution, or step in nm",
    "Word 21: upper part of word 20",
    "Word 24: ID number, two ASCII characters",
    "Word 25: ID number, low",
    "Word 26: ID number, high",
    "Word 27: serial number: high byte, ASCII character",
    "Word 28: serial number, middle",
    "Word 29: ASCII character, serial number low byte",
    "Word 37: bits 1..0 = 01: EnDat 2.2; bits 3..2 = 01: functional safety",
    "Word 39: longest calculation time",
    "EnDat 2.2 word 0: supported additional data 1",
    "EnDat 2.2 word 1: supported additional data 2",
    "EnDat 2.2 word 25: fastest clock, in kHz",
    "Word 3 of the operating status as set: bits 1..0 = 10: 10 to 30 us, 01: 1.25 to 3.75 us",
};

const char *endat_plate_text(uint32_t number)
{
    const char *text = NULL;

    if (number < (uint32_t)(sizeof plate / sizeof plate[0])) {
        text = plate[number];
    }
    return (text != NULL) ? text : "unknown";
}
