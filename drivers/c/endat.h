/**
 * @file endat.h
 * Driver for cards with EnDat receivers, in C99: no heap, no globals, no operating system.
 *
 * Two functions of the user access a card: one reads a word, one writes a word. Everything else follows from the
 * register map (endat_map.h) and from the card's identification, so one driver serves every card. For SPI, a parallel bus and
 * a UART, endat_transports.h has both functions, based on the transfers of that bus.
 *
 * Only one master may access a card. If several tasks share it, hold a lock around each call. No call keeps a pointer except
 * that of the context in the link. Every call that waits has a limit.
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
/** Longest burst of the driver, in words. */
#define ENDAT_BURST_WORDS (ENDAT_MAP_RESULT_STRIDE_WORDS * ENDAT_CHANNELS_MAX)

/** Result of a call. */
typedef enum {
    ENDAT_OK = 0,               /**< Done. */
    ENDAT_NOTHING,              /**< Nothing available: no set in the stream, no word in the name plate. */
    ENDAT_ERROR_ARGUMENT,       /**< An argument is outside the supported range. */
    ENDAT_ERROR_LINK,           /**< The bus rejected the access, or did not answer. */
    ENDAT_ERROR_CHECKSUM,       /**< The check sum was wrong in all tries. */
    ENDAT_ERROR_NO_CARD,        /**< The answer does not come from a card. */
    ENDAT_ERROR_VERSION,        /**< The card has another major version of the register map. */
    ENDAT_ERROR_CONFIGURATION,  /**< The card has another configuration than expected. */
    ENDAT_ERROR_PART,           /**< The card does not have the required part. */
    ENDAT_ERROR_PROTOCOL,       /**< The channel has another protocol, which does not support this. */
    ENDAT_ERROR_TIMEOUT,        /**< The limit has passed. */
    ENDAT_ERROR_BUSY,           /**< The operation is still under way. */
    ENDAT_ERROR_READ_BACK,      /**< A setting reads back with another value than written. */
    ENDAT_ERROR_UNPLUGGED,      /**< DATA is HIGH: no encoder, no supply, or an open line. */
    ENDAT_ERROR_INITIALISATION, /**< The encoder could not be initialised; endat_failed_step() returns the step. */
    ENDAT_ERROR_REFUSED,        /**< The encoder rejected the request; the answer's refusal has the reason. */
    ENDAT_ERROR_TRIGGER_OFF,    /**< The source "register" is not enabled, so this trigger has no effect. */
    ENDAT_ERROR_SET,            /**< A set of the stream was damaged; the next one is good again. */
    ENDAT_ERROR_EXCHANGE,       /**< The exchange with a T-format encoder failed; the reply's cause has the reason. */
    ENDAT_ERROR_RESTARTED,      /**< The card or its service has restarted, or another master has sent a request: send it again. */
    ENDAT_ERRORS                /**< Number of errors. */
} endat_error;

/** Description of an error, with the remedy. */
const char *endat_error_text(endat_error error);

/** Access to words. Addresses count words; a byte-addressed bus needs four times that. */
typedef struct {
    /** Passed to every call of a hook. */
    void *context;
    /** Reads a word. */
    endat_error (*read)(void *context, uint32_t word_address, uint32_t *value);
    /** Writes a word. */
    endat_error (*write)(void *context, uint32_t word_address, uint32_t value);
    /** Reads consecutive words with one command of the bus, from one instant; NULL: the bus has no such command. */
    endat_error (*read_burst)(void *context, uint32_t word_address, uint32_t count, uint32_t *values);
    /** Free-running microseconds, wrapping; NULL: the driver adds up the waits or, without wait_us, counts the polls. */
    uint32_t (*now_us)(void *context);
    /** Waits, or lets other tasks run; NULL: the driver polls without pause. */
    void (*wait_us)(void *context, uint32_t us);
} endat_link;

/** A card and its identification. Only endat_open() writes it. */
typedef struct {
    endat_link link;             /**< Access to the card. */
    uint32_t version;            /**< Version of the register map: major in 31..24, minor in 23..16, patch in 15..0. */
    uint32_t configuration_hash; /**< First 8 digits of the hash in the generated files. */
    uint32_t system_hz;          /**< System clock in hertz: the unit of every number of cycles. */
    uint32_t features;           /**< ENDAT_MAP_CARD_CAPABILITIES_FEATURES_...; more_features has the others. */
    uint32_t more_features;      /**< ENDAT_MAP_CARD_PROTOCOLS_FEATURES_... */
    uint32_t channels;           /**< Encoder ports. */
    uint32_t max_position_bits;  /**< Widest position. */
    uint32_t protocols;          /**< The word card.protocols; endat_protocol() decodes it for a channel. */
} endat_card;

/**
 * Identifies the card. Rejects anything else, and another major version of the register map.
 * @param card filled with the identification; input of the other calls.
 * @param link access to the words; it is copied.
 * @param hash first 8 digits of the configuration hash in the generated files; 0 accepts any.
 */
endat_error endat_open(endat_card *card, const endat_link *link, uint32_t hash);

/** True if the card has all of these parts: ENDAT_MAP_CARD_CAPABILITIES_FEATURES_... */
bool endat_has(const endat_card *card, uint32_t features);

/**
 * Tests the link: writes patterns into the scratch bits, and reads them back. Detects swapped bytes, lost writes and
 * wrong addresses. Held results are released.
 */
endat_error endat_try_link(const endat_card *card);

/** Reads a word of the card, ENDAT_MAP_..._WORD; for words without a separate call. */
endat_error endat_read_word(const endat_card *card, uint32_t word_address, uint32_t *value);
/** Writes a word of the card. */
endat_error endat_write_word(const endat_card *card, uint32_t word_address, uint32_t value);
/** Writes a word that keeps the written value, and reads it back; tries once more if it differs. */
endat_error endat_write_checked(const endat_card *card, uint32_t word_address, uint32_t value);

/* ---- Positions ------------------------------------------------------------------------------------------------------------------ */

/** A block of additional data from the frame of a result. */
typedef struct {
    bool came;           /**< The frame included this block. */
    bool good;           /**< The CRC is right; otherwise the fields below are 0. */
    bool busy;           /**< The encoder is busy with a request. */
    bool reference_mark; /**< RM. */
    bool warning;        /**< WRN. */
    uint8_t number;      /**< I4..I0: number of the content; bits 3..0 of its MRS code. */
    uint16_t content;    /**< Content. */
} endat_info;

/** Result of a channel's last trigger. */
typedef struct {
    uint64_t position;        /**< Last good position; bit 0 is the LSB. */
    uint32_t timestamp;       /**< First falling clock edge of the frame that brought the position; T-format: start bit of the request. System clock cycles, wrapping. */
    uint16_t sequence;        /**< Number of results, wrapping. */
    uint16_t age_us;          /**< Age of the position in microseconds; stops at 65535. */
    uint16_t delay_cycles;    /**< Tracked line delay. */
    uint16_t recovery_cycles; /**< Recovery time of the last frame. */
    uint8_t width_bits;       /**< Width of the position; 0: no position yet, or another protocol than EnDat. */
    uint8_t special_bits;     /**< SSI: shown special bits of the last frame, the last one in bit 0; otherwise 0. */
    uint8_t cause;            /**< Primary cause, ENDAT_CAUSE_...: endat_cause_text(). */
    bool valid;               /**< A good position is available. */
    bool fresh;               /**< The last result brought the position: test this, not the cause. */
    bool stale;               /**< A trigger has come since this result. */
    bool fits;                /**< The position matches the CRC sent by the encoder, or has none, as in T-format; if not, it is neither valid nor fresh. */
    endat_info info[2];       /**< Additional data 1 and 2 of this frame; empty on cards without requests. */
} endat_result;

/** Results of all channels, from one instant. */
typedef struct {
    uint32_t channels;                        /**< Number of channels. */
    endat_result channel[ENDAT_CHANNELS_MAX]; /**< Results, by channel. */
} endat_moment;

/**
 * Reads the results of all channels from one instant: with one burst if the link supports it, else word by word, again if a result
 * came in between, and finally with the card's hold. Each position is checked against its CRC; a mismatch is read again.
 */
endat_error endat_read_moment(const endat_card *card, endat_moment *moment);

/** Triggers all channels that accept it. Two triggers must be at least a frame apart: `explain` prints the time. */
endat_error endat_trigger(const endat_card *card);

/**
 * Triggers, and waits until every channel has its result. Timer and pin may continue: each result belongs to this trigger or to a later one, and
 * its `stale` is false.
 * ENDAT_ERROR_TIMEOUT: at least one channel has no result, for example because its encoder is unplugged; the moment is filled, and that channel
 * is stale.
 */
endat_error endat_measure(const endat_card *card, endat_moment *moment, uint32_t limit_us);

/** Channels measure their line delay again with their next frame; bit n for channel n. */
endat_error endat_calibrate(const endat_card *card, uint32_t channels);

/** A position as a signed number, in two's complement of its width; 0 if the width is 0, as in T-format: use the position itself. */
int64_t endat_signed(uint64_t position, uint32_t width_bits);

/** Distance from one position to another, the shorter way round. */
int64_t endat_difference(uint64_t from, uint64_t to, uint32_t width_bits);

/** Kind of position in the card's configuration: turns and an angle, or a place on a scale. */
typedef struct {
    uint32_t kind;             /**< ENDAT_MAP_CONFIG_LIMITS_RANGE_UNKNOWN, _ROTARY or _LINEAR; the other members apply to ROTARY. */
    uint32_t single_turn_bits; /**< Bits of the angle. */
    uint32_t multi_turn_bits;  /**< Bits that count turns; 0: the encoder counts none. */
    uint32_t turns_at;         /**< Lowest bit that counts turns. */
} endat_range;

/**
 * Reads the kind of position of a channel. With ENDAT_OK and the kind UNKNOWN the configuration does not define it: set the members yourself,
 * or read the name plate of an EnDat encoder.
 */
endat_error endat_read_range(const endat_card *card, uint32_t channel, endat_range *range);
/**
 * Splits a position into turn and step.
 * @param range kind of position.
 * @param position of a result or a sample.
 * @param turn number of the turn, 0 if the encoder counts none.
 * @param step place within the turn: 1 << single_turn_bits steps are a turn.
 * @return ENDAT_NOTHING if the range is not rotary; turn and step are 0.
 */
endat_error endat_turns(const endat_range *range, uint64_t position, uint32_t *turn, uint64_t *step);
/**
 * Steps from one position to another: the shorter way round, past turns and the end of their count, or along a scale.
 * @param range kind of position.
 * @param from a position.
 * @param to another one.
 * @param steps distance.
 * @return ENDAT_NOTHING if the range is unknown; the distance is 0.
 */
endat_error endat_moved(const endat_range *range, uint64_t from, uint64_t to, int64_t *steps);

/** Protocol of a channel, ENDAT_PROTOCOL_...; EnDat for an absent channel. */
uint32_t endat_protocol(const endat_card *card, uint32_t channel);

/** Name of a cause. */
const char *endat_cause_text(uint32_t cause);
/** Explanation of a cause. */
const char *endat_cause_meaning(uint32_t cause);
/** Remedy for a cause. */
const char *endat_cause_remedy(uint32_t cause);

/* ---- Encoder: plug, initialisation, state ------------------------------------------------------------------------------------- */

/** State of a channel's service; all 0 on a card without requests. */
typedef struct {
    bool initialised;  /**< The name plate is valid. */
    bool alarm;        /**< Too many bad frames; latched. */
    bool position_2;   /**< Position 2 was too far from position 1; latched. */
    bool endat22;      /**< The encoder supports EnDat 2.2. */
    bool other_width;  /**< The encoder has another width than configured, which the card uses. */
    bool slower;       /**< The encoder supports only a slower clock than configured, which the card uses. */
    bool unplugged;    /**< DATA has been HIGH for long. */
    bool initialising; /**< An initialisation is under way; triggers are lost. */
    uint16_t starts;   /**< Number of starts of the service: if it has changed, write its settings again. */
} endat_state;

/** Reads the state of a channel. */
endat_error endat_read_state(const endat_card *card, uint32_t channel, endat_state *state);

/**
 * State of a channel: ENDAT_OK, ENDAT_ERROR_UNPLUGGED, ENDAT_ERROR_BUSY (initialisation under way) or ENDAT_ERROR_INITIALISATION. On a card
 * without requests it is derived from the last result.
 */
endat_error endat_status(const endat_card *card, uint32_t channel);

/**
 * Waits until a channel is initialised: after power-up, and after its encoder was plugged in again, which the card detects.
 * After a frame without an answer a channel ignores triggers for 30 ms; a measurement during that time ends with ENDAT_ERROR_TIMEOUT.
 * An initialisation takes some two seconds, twice that if a step fails. At the limit: ENDAT_ERROR_UNPLUGGED or ENDAT_ERROR_TIMEOUT.
 */
endat_error endat_wait_ready(const endat_card *card, uint32_t channel, uint32_t limit_ms);

/** Step at which the initialisation failed, 0 = none: endat_step_text(). */
endat_error endat_failed_step(const endat_card *card, uint32_t channel, uint32_t *step);
/** Name of a step of the initialisation. */
const char *endat_step_text(uint32_t step);

/** Initialises the encoder again. */
endat_error endat_initialise(const endat_card *card, uint32_t channel);

/** Clears counters, alarm and other latched state. */
endat_error endat_clear(const endat_card *card, uint32_t channel);

/**
 * A word of the name plate, as the initialisation read it.
 * @param card the card.
 * @param word_address ENDAT_MAP_SERVICE_..._WORD(channel), from ..._ALARMS_WORD to ..._DELAY_WORD.
 * @param value the word.
 * @return ENDAT_NOTHING if it has not been read.
 */
endat_error endat_read_plate(const endat_card *card, uint32_t word_address, uint16_t *value);

/** Bytes of the longest number of an encoder as text: two letters, ten digits or one letter around them, and the end. */
#define ENDAT_NUMBER_BYTES 13u

/** Name plate of an encoder, as `endat id` prints it. */
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
 * The ID number of a channel's encoder, as printed on it, without characters that cannot be printed.
 * @return ENDAT_NOTHING if it has not been read, ENDAT_ERROR_PART on a card without initialisation; the text is empty then.
 */
endat_error endat_id(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES]);
/** The serial number; otherwise as endat_id(). */
endat_error endat_serial(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES]);
/** The name plate; ENDAT_NOTHING if a word of it has not been read. */
endat_error endat_read_name_plate(const endat_card *card, uint32_t channel, endat_name_plate *plate);
/** Meaning of the n-th word of the name plate. */
const char *endat_plate_text(uint32_t number);

/* ---- Requests: parameters of the encoder's memory ------------------------------------------------------------------------------ */

/** Answer to a request. */
typedef struct {
    uint8_t refusal;  /**< With ENDAT_ERROR_REFUSED: the reason, see endat_refusal_text(). Otherwise 0. */
    uint8_t address;  /**< Echo of MRS code or address, or WRN, RM, Busy, I4..I0 of additional data 1. */
    uint16_t data;    /**< Data. */
    uint64_t bits;    /**< Complete answer. */
    uint32_t time_us; /**< Duration of the request; whole milliseconds from 60 ms on. */
} endat_answer;

/** A request under way. */
typedef struct {
    uint32_t channel;  /**< Channel of the request. */
    uint32_t finished; /**< Number of ended requests when it was sent. */
} endat_request;

/**
 * Sends a mode command with its parameter, and does not wait. The next trigger sends EnDat 2.2 commands.
 * @param card the card.
 * @param request input of endat_request_poll().
 * @param channel encoder port.
 * @param command ENDAT_MAP_SERVICE_REQUEST_COMMAND_...
 * @param address MRS code, address or port.
 * @param data 16 bits.
 * @return ENDAT_ERROR_BUSY while an initialisation or another request is under way: nothing was sent.
 */
endat_error endat_request_begin(const endat_card *card, endat_request *request, uint32_t channel, uint32_t command, uint32_t address,
                                uint32_t data);
/** State of a request: ENDAT_ERROR_BUSY until it has ended; ENDAT_ERROR_RESTARTED: the available answer belongs to another request. */
endat_error endat_request_poll(const endat_card *card, const endat_request *request, endat_answer *answer);
/** Cancels the request that waits for a trigger; one on the wire is finished. */
endat_error endat_request_cancel(const endat_card *card, uint32_t channel);

/** Sends a mode command, and waits for the answer; cancels it at the limit. */
endat_error endat_send(const endat_card *card, uint32_t channel, uint32_t command, uint32_t address, uint32_t data, uint32_t limit_ms,
                       endat_answer *answer);
/** Selects a memory area; the block applies to areas with several blocks (0xBF), else 0. */
endat_error endat_select_memory(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t block, uint32_t limit_ms,
                                endat_answer *answer);
/** Reads a word of the encoder's memory. Triggers during its frames are lost, and reported as lost. */
endat_error endat_read_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t limit_ms,
                                 endat_answer *answer);
/** Writes a word of the encoder's memory. */
endat_error endat_write_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t data,
                                  uint32_t limit_ms, endat_answer *answer);
/** Reason of a refused request. */
const char *endat_refusal_text(uint32_t refusal);

/**
 * Additional data that are selected in turn, one code in each triggered frame.
 * @param card the card.
 * @param channel encoder port.
 * @param mrs their codes, 0x40..0x4E and 0x50..0x5E.
 * @param count 0 to 8; with 0 nothing more is selected, and the present selection remains until a request with 0x4F or 0x5F.
 */
endat_error endat_select_infos(const endat_card *card, uint32_t channel, const uint8_t *mrs, uint32_t count);
/**
 * Last content of the n-th code of the list.
 * @param card the card.
 * @param channel encoder port.
 * @param index place in the list, from 0.
 * @param content last content.
 * @param sequence number of the result that brought it: the difference to the result's sequence is its age in frames.
 */
endat_error endat_read_info(const endat_card *card, uint32_t channel, uint32_t index, uint16_t *content, uint16_t *sequence);

/* ---- T-format: requests, EEPROM, settings --------------------------------------------------------------------------------------- */

/** Reply of a T-format encoder to a request; all 0 unless the call returns ENDAT_OK, _EXCHANGE, _BUSY or _READ_BACK. */
typedef struct {
    uint8_t cause; /**< Cause of a failed exchange, or the alarm in a good reply; 0 = none: endat_cause_text(). */
    uint8_t id;    /**< ID echoed in the reply. */
    uint8_t data;  /**< EEPROM data, last received. */
} endat_reply;

/** Fields of the last reply of a T-format encoder, to a trigger or a request, and the received parts of the position. */
typedef struct {
    uint8_t status;     /**< Status field (SF); 0 if none was received. */
    uint8_t encoder_id; /**< Kind of encoder (ENID), last received. */
    uint8_t alarm;      /**< Alarm field (ALMC), last received. */
    uint8_t crc;        /**< CRC as received. */
    bool has_single_turn; /**< A single-turn position was received since reset: bits 23..0 of a position. */
    bool has_multi_turn;  /**< A multi-turn position was received since reset: bits 47..24. */
} endat_fields;

/**
 * Sends a request to a T-format encoder, at once or after the exchange under way, and waits for the reply. A trigger during the exchange
 * is lost, and the next result reports it.
 * @param card the card.
 * @param channel encoder port.
 * @param id ENDAT_MAP_T_FORMAT_SEND_ID_...
 * @param address EEPROM address for EEPROM requests; else 0.
 * @param data EEPROM data for the request that writes; else 0.
 * @param limit_ms limit for an exchange under way before it; the exchange itself takes less than 2 ms, which is always waited for.
 * @param reply the reply.
 * @return ENDAT_ERROR_EXCHANGE if it failed. A request that did not reach the card is sent again; at the limit ENDAT_ERROR_TIMEOUT.
 */
endat_error endat_exchange(const endat_card *card, uint32_t channel, uint32_t id, uint32_t address, uint32_t data, uint32_t limit_ms,
                           endat_reply *reply);
/**
 * Reads a byte of the EEPROM of a T-format encoder, reply->data; address 127 is the page register. ENDAT_ERROR_BUSY if the EEPROM is
 * still writing at the limit.
 */
endat_error endat_read_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint32_t limit_ms, endat_reply *reply);
/**
 * Writes a byte of the EEPROM, and reads it back after the write; address 127 is the page register. ENDAT_ERROR_BUSY: the EEPROM was still
 * writing at the limit, and its content is undefined; ENDAT_ERROR_READ_BACK: it holds another byte, reply->data.
 */
endat_error endat_write_eeprom(const endat_card *card, uint32_t channel, uint32_t address, uint8_t data, uint32_t limit_ms,
                               endat_reply *reply);
/**
 * Clears errors, angle or turns of a T-format encoder. The encoder needs several such requests in a row, so all trigger sources are disabled meanwhile.
 * Check the effect in the next position: a link without check sum may have lost a request.
 * @param card the card.
 * @param channel encoder port.
 * @param id ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_...
 * @param limit_ms limit for each request, as in endat_exchange().
 * @param reply last reply.
 * @return ENDAT_ERROR_EXCHANGE if a request failed, or an alarm remains after them: reply->cause.
 */
endat_error endat_reset_encoder(const endat_card *card, uint32_t channel, uint32_t id, uint32_t limit_ms, endat_reply *reply);
/** Reads the fields of the last reply, and the received parts of the position. */
endat_error endat_read_fields(const endat_card *card, uint32_t channel, endat_fields *fields);

/** Settings of a T-format channel; see the register map. */
typedef struct {
    uint32_t bit_cycles;    /**< Bit length: endat_period(). */
    uint32_t request_id;    /**< Request ID of a trigger, 0 to 3: ENDAT_MAP_T_FORMAT_SEND_ID_... */
    uint32_t filter_cycles; /**< Pulses up to this length are ignored. */
    uint32_t reply_gap_us;  /**< Longest pause before the reply. */
    uint32_t field_gap_us;  /**< Longest pause between two fields. */
} endat_t_format_settings;

/** Reads the settings of a T-format channel. */
endat_error endat_read_t_format_settings(const endat_card *card, uint32_t channel, endat_t_format_settings *settings);
/**
 * Writes the settings while all trigger sources are disabled, and reads them back. Values that the map does not allow are rejected before writing; so are
 * trigger requests without position or kind, and a filter of half a bit or more.
 */
endat_error endat_write_t_format_settings(const endat_card *card, uint32_t channel, const endat_t_format_settings *settings);

/* ---- Settings ------------------------------------------------------------------------------------------------------------------ */

/** Settings of an EnDat channel; see the register map. */
typedef struct {
    uint32_t period_cycles;          /**< EnDat clock period: endat_period(). */
    uint32_t position_bits;          /**< Width of the position. */
    uint32_t command;                /**< Mode command of a trigger, ENDAT_MAP_CONFIG_FRAME_COMMAND_... */
    uint32_t first_low_extra_cycles; /**< First low phase minus half a period. */
    uint32_t start_window_cycles;    /**< Tolerance of the start edge. */
    uint32_t filter_cycles;          /**< Pulses up to this length are ignored. */
    uint32_t start_timeout_us;       /**< Longest wait for the start bit. */
    uint32_t recovery_limit_cycles;  /**< DATA must fall within this time after the frame. */
} endat_settings;

/** Shortest clock period with a rate of at most clock_hz. */
uint32_t endat_period(const endat_card *card, uint32_t clock_hz);
/** Reads the settings of a channel. */
endat_error endat_read_settings(const endat_card *card, uint32_t channel, endat_settings *settings);
/** Writes the settings while all trigger sources are disabled, and reads them back. Values that the map does not allow are rejected before writing. */
endat_error endat_write_settings(const endat_card *card, uint32_t channel, const endat_settings *settings);
/** Enables sources of triggers (bits of trigger_sources), and sets the period of the timer unless it is 0. */
endat_error endat_set_triggers(const endat_card *card, uint32_t sources, uint32_t period_cycles);
/** Raises the alarm when n of the last m frames were bad; n = 0: never. */
endat_error endat_set_alarm(const endat_card *card, uint32_t channel, uint32_t n, uint32_t m);

/** Selects the events that assert irq_o: the word interrupt.mask. */
endat_error endat_enable_interrupts(const endat_card *card, uint32_t events);
/** Reads the events (the word interrupt.status), and clears exactly these: for an interrupt routine. */
endat_error endat_take_interrupts(const endat_card *card, uint32_t *events);

/* ---- Stream: every sample, on cards with this part ------------------------------------------------------------------------------ */

/** Longest set, with its CRC. */
#define ENDAT_SET_BYTES (10u + 16u * ENDAT_CHANNELS_MAX)

/** Received part of a set. */
typedef struct {
    uint8_t bytes[ENDAT_SET_BYTES + 1u]; /**< Encoded. */
    uint32_t count;                      /**< Number of bytes; continues to count beyond the longest set. */
    uint32_t word;                       /**< Word read, not processed yet. */
    uint32_t left;                       /**< Bytes left in it. */
} endat_stream;

/** A channel's part of a set. */
typedef struct {
    uint64_t position; /**< Position; from this trigger if fresh. */
    uint8_t cause;     /**< Primary cause. */
    bool taken;        /**< The channel took this trigger. */
    bool valid;        /**< A good position is available. */
    bool fresh;        /**< This trigger brought the position. */
    bool missing;      /**< The set was closed before the channel's result. */
} endat_sample;

/** Results of a trigger. */
typedef struct {
    uint8_t type;        /**< 1; 2 = with additional data; 3 = a position of a running clock, of one channel. */
    uint8_t first;       /**< Channel of the first sample. */
    uint8_t count;       /**< Samples. */
    uint8_t lost;        /**< Sets lost before this one; 255 = 255 or more. */
    uint16_t sequence;   /**< Low half of trigger_count; for type 3 the number of the channel's result. */
    uint32_t timestamp;  /**< System clock cycles at the trigger, wrapping. */
    endat_sample sample[ENDAT_CHANNELS_MAX]; /**< Samples of the channels first .. first + count - 1. */
} endat_set;

/** Empties the buffer, and sets whether triggers produce sets. ENDAT_ERROR_PART: this card has no stream; read moments instead. */
endat_error endat_stream_start(const endat_card *card, endat_stream *stream, bool collects);
/** Reads the next set; ENDAT_NOTHING if none is available, ENDAT_ERROR_SET for a damaged one. */
endat_error endat_stream_next(const endat_card *card, endat_stream *stream, endat_set *set);

#ifdef __cplusplus
}
#endif

#endif
