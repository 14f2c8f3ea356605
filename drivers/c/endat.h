/**
 * @file endat.h
 * Driver for cards with EnDat receivers, in C99: no heap, no globals, no operating system.
 *
 * A card is reached through two functions of yours, one that reads a word and one that writes a word; everything else follows from the
 * register map (endat_map.h) and from what the card says of itself, so that one driver serves every card. For SPI, a parallel bus and
 * a UART endat_transports.h has both functions, made of the transfers of that bus.
 *
 * One master talks to a card: where several tasks share it, a lock of yours is held around each call. No call keeps a pointer but that of
 * the context in the link. Every call that waits has a limit.
 */
#ifndef ENDAT_H
#define ENDAT_H

#include <stdbool.h>
#include <stdint.h>

#include "endat_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Encoder ports of the largest card. */
#define ENDAT_CHANNELS_MAX ENDAT_MAP_CHANNELS_MAX
/** Longest burst that the driver asks for, in words. */
#define ENDAT_BURST_WORDS (ENDAT_MAP_RESULT_STRIDE_WORDS * ENDAT_CHANNELS_MAX)

/** What became of a call. */
typedef enum {
    ENDAT_OK = 0,               /**< It is done. */
    ENDAT_NOTHING,              /**< There is nothing: no set in the stream, no word in the name plate. */
    ENDAT_ERROR_ARGUMENT,       /**< An argument is outside of what the card takes. */
    ENDAT_ERROR_LINK,           /**< The bus refused the access, or did not answer. */
    ENDAT_ERROR_CHECKSUM,       /**< The check sum was wrong, also when it was tried again. */
    ENDAT_ERROR_NO_CARD,        /**< What answers is no card. */
    ENDAT_ERROR_VERSION,        /**< The card has another major version of the register map. */
    ENDAT_ERROR_CONFIGURATION,  /**< The card was made from another configuration than the one expected. */
    ENDAT_ERROR_PART,           /**< The card does not have the part that this takes. */
    ENDAT_ERROR_PROTOCOL,       /**< The channel speaks another protocol, which does not have this. */
    ENDAT_ERROR_TIMEOUT,        /**< It did not end in time. */
    ENDAT_ERROR_BUSY,           /**< It is still under way. */
    ENDAT_ERROR_READ_BACK,      /**< A setting reads back as another one than was written. */
    ENDAT_ERROR_UNPLUGGED,      /**< DATA is HIGH: no encoder, no supply, or an open line. */
    ENDAT_ERROR_INITIALISATION, /**< The encoder could not be initialised; endat_failed_step() tells where. */
    ENDAT_ERROR_REFUSED,        /**< The encoder did not fulfil the request; the answer's refusal tells why. */
    ENDAT_ERROR_TRIGGER_OFF,    /**< The source "register" is not enabled: a trigger from here does nothing. */
    ENDAT_ERROR_SET,            /**< A set of the stream was damaged; the next one is a good one again. */
    ENDAT_ERROR_EXCHANGE,       /**< The exchange with a T-format encoder failed; the reply's cause tells why. */
    ENDAT_ERROR_RESTARTED,      /**< The card or its service has begun anew, or another master has asked: ask again. */
    ENDAT_ERRORS                /**< How many there are. */
} endat_error;

/** What an error is, and what helps. */
const char *endat_error_text(endat_error error);

/** How words are reached. Addresses count words; a bus that counts bytes takes four times that. */
typedef struct {
    /** Comes back in every call of a hook. */
    void *context;
    /** Reads a word. */
    endat_error (*read)(void *context, uint32_t word_address, uint32_t *value);
    /** Writes a word. */
    endat_error (*write)(void *context, uint32_t word_address, uint32_t value);
    /** Reads words that follow each other as one command of the bus, which is one moment; NULL: the bus has no such command. */
    endat_error (*read_burst)(void *context, uint32_t word_address, uint32_t count, uint32_t *values);
    /** Microseconds since some moment, wrapping; NULL: the waits are added up, or, without wait_us, the looks counted. */
    uint32_t (*now_us)(void *context);
    /** Waits for so long, or lets others run; NULL: the driver asks again at once. */
    void (*wait_us)(void *context, uint32_t us);
} endat_link;

/** A card, and what it says of itself. Only endat_open() writes it. */
typedef struct {
    endat_link link;             /**< How it is reached. */
    uint32_t version;            /**< Of its register map: major in 31..24, minor in 23..16, patch in 15..0. */
    uint32_t configuration_hash; /**< First 8 digits of the hash in the generated files. */
    uint32_t system_hz;          /**< The unit of every number of cycles. */
    uint32_t features;           /**< ENDAT_MAP_CARD_CAPABILITIES_FEATURES_...; the later ones are in more_features. */
    uint32_t more_features;      /**< ENDAT_MAP_CARD_PROTOCOLS_FEATURES_... */
    uint32_t channels;           /**< Encoder ports. */
    uint32_t max_position_bits;  /**< Widest position. */
    uint32_t protocols;          /**< The word card.protocols: endat_protocol() tells it for a channel. */
} endat_card;

/**
 * Finds out who answers. Refuses what is no card, and another major version of the register map.
 * @param card what becomes known of it; the other calls take it.
 * @param link how its words are reached; it is copied.
 * @param hash first 8 digits of the configuration's hash, as the generated files have it; 0 takes any.
 */
endat_error endat_open(endat_card *card, const endat_link *link, uint32_t hash);

/** Whether the card has all of these parts: ENDAT_MAP_CARD_CAPABILITIES_FEATURES_... */
bool endat_has(const endat_card *card, uint32_t features);

/**
 * Tries the link: writes patterns into the scratch bits, and reads them back. Catches exchanged bytes, writes that do not arrive, and
 * addresses that are off. Results that are held are let go.
 */
endat_error endat_try_link(const endat_card *card);

/** A word of the card, ENDAT_MAP_..._WORD; for all that has no call of its own. */
endat_error endat_read_word(const endat_card *card, uint32_t word_address, uint32_t *value);
/** Writes a word of the card. */
endat_error endat_write_word(const endat_card *card, uint32_t word_address, uint32_t value);
/** Writes a word that keeps what is written, and reads it back; once more if it is another one. */
endat_error endat_write_checked(const endat_card *card, uint32_t word_address, uint32_t value);

/* ---- Positions ------------------------------------------------------------------------------------------------------------------ */

/** A block of additional data that came with the frame of a result. */
typedef struct {
    bool came;           /**< The frame brought it. */
    bool good;           /**< Its CRC is right; all that follows is 0 otherwise. */
    bool busy;           /**< The encoder is busy with a request. */
    bool reference_mark; /**< RM. */
    bool warning;        /**< WRN. */
    uint8_t number;      /**< I4..I0: which one it is; bits 3..0 of its MRS code. */
    uint16_t content;    /**< What it says. */
} endat_info;

/** What became of a channel's last trigger. */
typedef struct {
    uint64_t position;        /**< Last good position; bit 0 is the LSB. */
    uint32_t timestamp;       /**< First falling clock edge of the frame that brought it; T-format: start bit of the request. System clock cycles, wrapping. */
    uint16_t sequence;        /**< Number of results, wrapping. */
    uint16_t age_us;          /**< Of the position; stops at 65535. */
    uint16_t delay_cycles;    /**< Tracked line delay. */
    uint16_t recovery_cycles; /**< Recovery time of the last frame. */
    uint8_t width_bits;       /**< Of the position; 0: none yet, or another protocol than EnDat. */
    uint8_t special_bits;     /**< SSI: bits of the last frame that are not position and that are shown, the last one in bit 0; otherwise 0. */
    uint8_t cause;            /**< Primary cause, ENDAT_CAUSE_...: endat_cause_text(). */
    bool valid;               /**< There is a good position. */
    bool fresh;               /**< The last result brought it: test this, not the cause. */
    bool stale;               /**< A trigger has come since this result. */
    bool fits;                /**< The position fits the CRC that the encoder sent with it, or there is nothing to check, as of T-format; if not, it is neither valid nor fresh. */
    endat_info info[2];       /**< Additional data 1 and 2 of this frame; none on cards without requests. */
} endat_result;

/** Results of all channels, of one moment. */
typedef struct {
    uint32_t channels;                        /**< How many. */
    endat_result channel[ENDAT_CHANNELS_MAX]; /**< One for each. */
} endat_moment;

/**
 * Reads the results of all channels, of one moment: with one burst where the link has it, else word by word and once more if a result
 * came between, and at last with the card's hold. Each position is checked against its CRC; what does not fit is read again.
 */
endat_error endat_read_moment(const endat_card *card, endat_moment *moment);

/** Triggers all channels that take it. Two triggers are a cycle apart at least: `explain` shows it. */
endat_error endat_trigger(const endat_card *card);

/**
 * Triggers, and waits until every channel has its result. Timer and pin may go on: each result is of this trigger or of a later one, and
 * its `stale` is false.
 * ENDAT_ERROR_TIMEOUT: at least one has none, as while its encoder is unplugged; the moment is filled all the same, and that channel
 * is stale.
 */
endat_error endat_measure(const endat_card *card, endat_moment *moment, uint32_t limit_us);

/** Lets channels measure their line delay again with their next frame; bit n for channel n. */
endat_error endat_calibrate(const endat_card *card, uint32_t channels);

/** A position as a number around zero, in two's complement of its width; 0 if the width is 0, as of T-format: take the position itself. */
int64_t endat_signed(uint64_t position, uint32_t width_bits);

/** How far it is from one position to another, the shorter way round. */
int64_t endat_difference(uint64_t from, uint64_t to, uint32_t width_bits);

/** What a position is, as the card's configuration says: turns and an angle, or a place on a scale. */
typedef struct {
    uint32_t kind;             /**< ENDAT_MAP_CONFIG_LIMITS_RANGE_UNKNOWN, _ROTARY or _LINEAR; the other members are of ROTARY. */
    uint32_t single_turn_bits; /**< Bits of the angle. */
    uint32_t multi_turn_bits;  /**< Bits that count turns; 0: the encoder counts none. */
    uint32_t turns_at;         /**< Lowest bit that counts turns. */
} endat_range;

/**
 * Reads what the position of a channel is. With ENDAT_OK and the kind UNKNOWN the configuration does not say: give the members yourself,
 * or ask the name plate of an EnDat encoder.
 */
endat_error endat_read_range(const endat_card *card, uint32_t channel, endat_range *range);
/**
 * Takes a position apart.
 * @param range what it is.
 * @param position of a result or a sample.
 * @param turn which turn, 0 if the encoder counts none.
 * @param step place within the turn: 1 << single_turn_bits steps are a turn.
 * @return ENDAT_NOTHING if it is no rotary one, and both are 0.
 */
endat_error endat_turns(const endat_range *range, uint64_t position, uint32_t *turn, uint64_t *step);
/**
 * Steps from one position to another: the shorter way round, past turns and the end of their count, or along a scale.
 * @param range what they are.
 * @param from a position.
 * @param to another one.
 * @param steps how far it is.
 * @return ENDAT_NOTHING if nobody says what they are, and it is 0.
 */
endat_error endat_moved(const endat_range *range, uint64_t from, uint64_t to, int64_t *steps);

/** What a channel speaks, ENDAT_PROTOCOL_...; of a channel that the card does not have EnDat. */
uint32_t endat_protocol(const endat_card *card, uint32_t channel);

/** Name of a cause. */
const char *endat_cause_text(uint32_t cause);
/** What it means. */
const char *endat_cause_meaning(uint32_t cause);
/** What to do about it. */
const char *endat_cause_remedy(uint32_t cause);

/* ---- Encoder: plug, initialisation, state ------------------------------------------------------------------------------------- */

/** What a channel's service knows; all 0 on a card without requests. */
typedef struct {
    bool initialised;  /**< The name plate is valid. */
    bool alarm;        /**< Too many bad frames; latched. */
    bool position_2;   /**< Position 2 was too far from position 1; latched. */
    bool endat22;      /**< The encoder knows EnDat 2.2. */
    bool other_width;  /**< The encoder has another width than configured; its own is used. */
    bool slower;       /**< The encoder takes only a slower clock than configured; that is used. */
    bool unplugged;    /**< DATA has been HIGH for long. */
    bool initialising; /**< Triggers are lost. */
    uint16_t starts;   /**< How often the service has begun: if it has changed, write its settings again. */
} endat_state;

/** Reads the state of a channel. */
endat_error endat_read_state(const endat_card *card, uint32_t channel, endat_state *state);

/**
 * How a channel is: ENDAT_OK, ENDAT_ERROR_UNPLUGGED, ENDAT_ERROR_BUSY (it is being initialised) or ENDAT_ERROR_INITIALISATION. On a card
 * without requests the last result tells.
 */
endat_error endat_status(const endat_card *card, uint32_t channel);

/**
 * Waits until a channel is initialised: after power-up, and after its encoder has been plugged in again, which the card notices itself.
 * Behind a frame without an answer a channel takes no trigger for 30 ms; a measurement of that time ends with ENDAT_ERROR_TIMEOUT.
 * An initialisation takes some two seconds, twice that if a step fails. At the limit: ENDAT_ERROR_UNPLUGGED or ENDAT_ERROR_TIMEOUT.
 */
endat_error endat_wait_ready(const endat_card *card, uint32_t channel, uint32_t limit_ms);

/** Step at which the initialisation failed, 0 = none: endat_step_text(). */
endat_error endat_failed_step(const endat_card *card, uint32_t channel, uint32_t *step);
/** Name of a step of the initialisation. */
const char *endat_step_text(uint32_t step);

/** Initialises the encoder again. */
endat_error endat_initialise(const endat_card *card, uint32_t channel);

/** Counters, alarm and the rest of what is latched go to zero. */
endat_error endat_clear(const endat_card *card, uint32_t channel);

/**
 * A word of the name plate, as the initialisation read it.
 * @param card the card.
 * @param word_address ENDAT_MAP_SERVICE_..._WORD(channel), from ..._ALARMS_WORD to ..._DELAY_WORD.
 * @param value the word.
 * @return ENDAT_NOTHING if it was not read.
 */
endat_error endat_read_plate(const endat_card *card, uint32_t word_address, uint16_t *value);

/** Bytes of the longest number of an encoder as text: two letters, ten digits or one letter around them, and the end. */
#define ENDAT_NUMBER_BYTES 13u

/** What an encoder says of itself, as `endat-gen id` prints it. */
typedef struct {
    char id[ENDAT_NUMBER_BYTES];     /**< ID number. */
    char serial[ENDAT_NUMBER_BYTES]; /**< Serial number. */
    uint32_t position_bits;          /**< Width of the position. */
    bool rotary;                     /**< Rotary, not linear. */
    uint32_t steps;                  /**< Measuring steps per revolution, or the measuring step in nm. */
    uint32_t revolutions;            /**< Distinguishable revolutions, 0 or 1 = singleturn. */
    uint32_t signal_periods;         /**< Signal periods per revolution, or the signal period in nm. */
} endat_name_plate;

/**
 * The ID number of a channel's encoder, as it is printed on it; what cannot be printed is left out.
 * @return ENDAT_NOTHING if it was not read, ENDAT_ERROR_PART on a card without initialisation; the text is empty then.
 */
endat_error endat_id(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES]);
/** The serial number; otherwise as endat_id(). */
endat_error endat_serial(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES]);
/** The name plate; ENDAT_NOTHING if a word of it was not read. */
endat_error endat_read_name_plate(const endat_card *card, uint32_t channel, endat_name_plate *plate);
/** What the n-th word of the name plate is. */
const char *endat_plate_text(uint32_t number);

/* ---- Requests: parameters of the encoder's memory ------------------------------------------------------------------------------ */

/** What came back. */
typedef struct {
    uint8_t refusal;  /**< With ENDAT_ERROR_REFUSED: why it was not fulfilled: endat_refusal_text(). 0 with all else. */
    uint8_t address;  /**< Echo of MRS code or address, or WRN, RM, Busy, I4..I0 of additional data 1. */
    uint16_t data;    /**< Data. */
    uint64_t bits;    /**< The whole answer. */
    uint32_t time_us; /**< How long it took; whole milliseconds from 60 ms on. */
} endat_answer;

/** A request that is under way. */
typedef struct {
    uint32_t channel;  /**< Of which channel. */
    uint32_t finished; /**< Requests that had ended when it was sent. */
} endat_request;

/**
 * Sends a mode command with its parameter, and does not wait. EnDat 2.2 commands ride on the next trigger.
 * @param card the card.
 * @param request what endat_request_poll() asks for.
 * @param channel encoder port.
 * @param command ENDAT_MAP_SERVICE_REQUEST_COMMAND_...
 * @param address MRS code, address or port.
 * @param data 16 bits.
 * @return ENDAT_ERROR_BUSY while an initialisation or another request is under way: nothing was sent.
 */
endat_error endat_request_begin(const endat_card *card, endat_request *request, uint32_t channel, uint32_t command, uint32_t address,
                                uint32_t data);
/** What became of it: ENDAT_ERROR_BUSY until it has ended; ENDAT_ERROR_RESTARTED: the answer that is there is not of this request. */
endat_error endat_request_poll(const endat_card *card, const endat_request *request, endat_answer *answer);
/** Gives up the request that waits for a trigger; one on the wire is finished. */
endat_error endat_request_cancel(const endat_card *card, uint32_t channel);

/** Sends a mode command, and waits for the answer; at the limit it is cancelled. */
endat_error endat_send(const endat_card *card, uint32_t channel, uint32_t command, uint32_t address, uint32_t data, uint32_t limit_ms,
                       endat_answer *answer);
/** Selects a memory area; the block is for areas that have several (0xBF), else 0. */
endat_error endat_select_memory(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t block, uint32_t limit_ms,
                                endat_answer *answer);
/** Reads a word of the encoder's memory. Triggers that meet the frames of it are lost, and told. */
endat_error endat_read_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t limit_ms,
                                 endat_answer *answer);
/** Writes a word of the encoder's memory. */
endat_error endat_write_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t data,
                                  uint32_t limit_ms, endat_answer *answer);
/** Why a request was not fulfilled. */
const char *endat_refusal_text(uint32_t refusal);

/**
 * Additional data that are selected in turn, one code in each triggered frame.
 * @param card the card.
 * @param channel encoder port.
 * @param mrs their codes, 0x40..0x4E and 0x50..0x5E.
 * @param count 0 to 8; with 0 nothing more is selected, and what is selected goes on until a request with 0x4F or 0x5F.
 */
endat_error endat_select_infos(const endat_card *card, uint32_t channel, const uint8_t *mrs, uint32_t count);
/**
 * What the n-th code of the list said last.
 * @param card the card.
 * @param channel encoder port.
 * @param index place in the list, from 0.
 * @param content what it said.
 * @param sequence number of the result that brought it: the difference to the result's sequence is its age in frames.
 */
endat_error endat_read_info(const endat_card *card, uint32_t channel, uint32_t index, uint16_t *content, uint16_t *sequence);

/* ---- T-format: requests, EEPROM, settings --------------------------------------------------------------------------------------- */

/** What came back of a request to a T-format encoder; all 0 unless the call gives ENDAT_OK, _EXCHANGE, _BUSY or _READ_BACK. */
typedef struct {
    uint8_t cause; /**< Why the exchange failed, or the alarm that a good reply told; 0 = neither: endat_cause_text(). */
    uint8_t id;    /**< ID that the reply repeats. */
    uint8_t data;  /**< EEPROM data as they came last. */
} endat_reply;

/** Fields of the last reply of a T-format encoder, of a trigger or of a request, and which parts of the position there are. */
typedef struct {
    uint8_t status;     /**< Status field (SF); 0 if none came. */
    uint8_t encoder_id; /**< Kind of encoder (ENID) as it came last. */
    uint8_t alarm;      /**< Alarm field (ALMC) as it came last. */
    uint8_t crc;        /**< CRC as received. */
    bool has_single_turn; /**< A single-turn position has come since reset: bits 23..0 of a position. */
    bool has_multi_turn;  /**< A multi-turn position has come since reset: bits 47..24. */
} endat_fields;

/**
 * Sends a request to a T-format encoder, at once or behind the exchange under way, and waits for the reply. A trigger that falls into it
 * is not taken, and the next result says so.
 * @param card the card.
 * @param channel encoder port.
 * @param id ENDAT_MAP_T_FORMAT_SEND_ID_...
 * @param address of the EEPROM, for its requests; else 0.
 * @param data for the EEPROM, for the request that writes it; else 0.
 * @param limit_ms longest wait for what is under way before it; the exchange itself takes less than 2 ms, and is waited for.
 * @param reply what came back.
 * @return ENDAT_ERROR_EXCHANGE if it failed; a request that did not reach the card goes out again, and is ENDAT_ERROR_TIMEOUT at the limit.
 */
endat_error endat_exchange(const endat_card *card, uint32_t channel, uint32_t id, uint32_t address, uint32_t data, uint32_t limit_ms,
                           endat_reply *reply);
/**
 * Reads a byte of the EEPROM of a T-format encoder, reply->data; address 127 is the page register. ENDAT_ERROR_BUSY if the EEPROM is
 * still writing at the limit.
 */
endat_error endat_read_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint32_t limit_ms, endat_reply *reply);
/**
 * Writes a byte of the EEPROM, and reads it back when it is there; address 127 is the page register. ENDAT_ERROR_BUSY: it was still
 * writing at the limit, and what it reads as then is not known; ENDAT_ERROR_READ_BACK: it has another byte, reply->data.
 */
endat_error endat_write_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint8_t data, uint32_t limit_ms,
                               endat_reply *reply);
/**
 * Clears errors, angle or turns of a T-format encoder: requests that count only several times in a row, so no source triggers meanwhile.
 * What it has done is seen in the next position: a link without a check may have lost one of them.
 * @param card the card.
 * @param channel encoder port.
 * @param id ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_...
 * @param limit_ms as of endat_exchange(), of each of them.
 * @param reply what came back last.
 * @return ENDAT_ERROR_EXCHANGE if one of them failed, or an alarm is still there behind them: reply->cause.
 */
endat_error endat_reset_encoder(const endat_card *card, uint32_t channel, uint32_t id, uint32_t limit_ms, endat_reply *reply);
/** Fields of the last reply, and which parts of the position there are. */
endat_error endat_read_fields(const endat_card *card, uint32_t channel, endat_fields *fields);

/** Settings of a T-format channel, as the register map explains them. */
typedef struct {
    uint32_t bit_cycles;    /**< A bit: endat_period(). */
    uint32_t request_id;    /**< Request ID of a trigger, 0 to 3: ENDAT_MAP_T_FORMAT_SEND_ID_... */
    uint32_t filter_cycles; /**< Pulses up to this length are ignored. */
    uint32_t reply_gap_us;  /**< Longest pause before the reply. */
    uint32_t field_gap_us;  /**< Longest pause between two fields. */
} endat_t_format_settings;

/** Reads the settings of a T-format channel. */
endat_error endat_read_t_format_settings(const endat_card *card, uint32_t channel, endat_t_format_settings *settings);
/**
 * Writes them, while no source triggers, and reads them back. What the map does not allow is refused, and nothing written; so are
 * requests of a trigger that bring no position or kind, and a filter of half a bit or more.
 */
endat_error endat_write_t_format_settings(const endat_card *card, uint32_t channel, const endat_t_format_settings *settings);

/* ---- Settings ------------------------------------------------------------------------------------------------------------------ */

/** Settings of an EnDat channel, as the register map explains them. */
typedef struct {
    uint32_t period_cycles;          /**< EnDat clock period: endat_period(). */
    uint32_t position_bits;          /**< Width of the position. */
    uint32_t command;                /**< Mode command of a trigger, ENDAT_MAP_CONFIG_FRAME_COMMAND_... */
    uint32_t first_low_extra_cycles; /**< First low phase minus half a period. */
    uint32_t start_window_cycles;    /**< Tolerance of the start edge. */
    uint32_t filter_cycles;          /**< Pulses up to this length are ignored. */
    uint32_t start_timeout_us;       /**< Longest wait for the start bit. */
    uint32_t recovery_limit_cycles;  /**< DATA must fall within this after the frame. */
} endat_settings;

/** Clock period that is not faster than so many hertz. */
uint32_t endat_period(const endat_card *card, uint32_t clock_hz);
/** Reads the settings of a channel. */
endat_error endat_read_settings(const endat_card *card, uint32_t channel, endat_settings *settings);
/** Writes them, while no source triggers, and reads them back. What the map does not allow is refused, and nothing written. */
endat_error endat_write_settings(const endat_card *card, uint32_t channel, const endat_settings *settings);
/** Enables sources of triggers (bits of trigger_sources), and sets the period of the timer unless it is 0. */
endat_error endat_set_triggers(const endat_card *card, uint32_t sources, uint32_t period_cycles);
/** Raises the alarm when n of the last m frames were bad; n = 0: never. */
endat_error endat_set_alarm(const endat_card *card, uint32_t channel, uint32_t n, uint32_t m);

/** Which events make irq_o high: the word interrupt.mask. */
endat_error endat_enable_interrupts(const endat_card *card, uint32_t events);
/** What has happened (the word interrupt.status), and clears just that: for an interrupt routine. */
endat_error endat_take_interrupts(const endat_card *card, uint32_t *events);

/* ---- Stream: every sample, on cards that have it ------------------------------------------------------------------------------ */

/** Longest set, with its CRC. */
#define ENDAT_SET_BYTES (10u + 16u * ENDAT_CHANNELS_MAX)

/** What has been read of a set. */
typedef struct {
    uint8_t bytes[ENDAT_SET_BYTES + 1u]; /**< Encoded. */
    uint32_t count;                      /**< How many; beyond the longest set it only counts. */
    uint32_t word;                       /**< Read, and not looked at. */
    uint32_t left;                       /**< Bytes of it. */
} endat_stream;

/** A channel's share of a set. */
typedef struct {
    uint64_t position; /**< Of this trigger if fresh. */
    uint8_t cause;     /**< Primary cause. */
    bool taken;        /**< The channel took this trigger. */
    bool valid;        /**< There is a good position. */
    bool fresh;        /**< This trigger brought it. */
    bool missing;      /**< The set was closed before its result was there. */
} endat_sample;

/** What a trigger brought. */
typedef struct {
    uint8_t type;        /**< 1; 2 = with additional data; 3 = a position of a running clock, of one channel. */
    uint8_t first;       /**< Channel of the first sample. */
    uint8_t count;       /**< Samples. */
    uint8_t lost;        /**< Sets lost before this one; 255 = 255 or more. */
    uint16_t sequence;   /**< Low half of trigger_count; of type 3 number of the channel's result. */
    uint32_t timestamp;  /**< System clock cycles at the trigger, wrapping. */
    endat_sample sample[ENDAT_CHANNELS_MAX]; /**< Of the channels first .. first + count - 1. */
} endat_set;

/** Empties the buffer, and lets triggers make sets, or not. ENDAT_ERROR_PART: this card has no stream; read moments instead. */
endat_error endat_stream_start(const endat_card *card, endat_stream *stream, bool collects);
/** The next set; ENDAT_NOTHING if there is none, ENDAT_ERROR_SET for one that was damaged. */
endat_error endat_stream_next(const endat_card *card, endat_stream *stream, endat_set *set);

#ifdef __cplusplus
}
#endif

#endif
