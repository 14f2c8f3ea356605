/**
 * @file endat_service.c
 * The service of a channel: state of the encoder, requests, additional data.
 */
#include "endat.h"
#include "endat_internal.h"

/** Pause between two polls of an initialisation. */
#define STATE_PAUSE_US 500u
/** A channel ignores triggers for this time after an aborted frame. */
#define ABORT_PAUSE_US 30000u
/** From this number of milliseconds on the microseconds of a duration may have wrapped. */
#define WRAPS_MS 60u
/** Largest count of requests before it wraps to 0. */
#define FINISHED_MAX (ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED_MASK >> ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED_SHIFT)

/** Largest MRS code, address or port, and largest data of a command. */
#define ADDRESS_MAX (ENDAT_MAP_SERVICE_REQUEST_ADDRESS_MASK >> ENDAT_MAP_SERVICE_REQUEST_ADDRESS_SHIFT)
#define DATA_MAX (ENDAT_MAP_SERVICE_REQUEST_DATA_MASK >> ENDAT_MAP_SERVICE_REQUEST_DATA_SHIFT)

/* Compilation fails unless the words of a list are consecutive. */
typedef char endat_list_follows[((ENDAT_MAP_SERVICE_LIST_7_WORD(0u) - ENDAT_MAP_SERVICE_LIST_0_WORD(0u)) == 7u) ? 1 : -1];
typedef char endat_slots_follow[((ENDAT_MAP_SERVICE_SLOT_7_WORD(0u) - ENDAT_MAP_SERVICE_SLOT_0_WORD(0u)) == 7u) ? 1 : -1];

endat_error endat_read_state(const endat_card *card, uint32_t channel, endat_state *state)
{
    uint32_t word = 0u;
    endat_error error = endat_needs_endat(card, channel);

    if ((error == ENDAT_OK) && endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS)) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_STATE_WORD(channel), &word);
    }
    state->initialised = (word & ENDAT_MAP_SERVICE_STATE_INITIALISED_MASK) != 0u;
    state->alarm = (word & ENDAT_MAP_SERVICE_STATE_ALARM_MASK) != 0u;
    state->position_2 = (word & ENDAT_MAP_SERVICE_STATE_POSITION_2_MASK) != 0u;
    state->endat22 = (word & ENDAT_MAP_SERVICE_STATE_ENDAT22_MASK) != 0u;
    state->other_width = (word & ENDAT_MAP_SERVICE_STATE_OTHER_WIDTH_MASK) != 0u;
    state->slower = (word & ENDAT_MAP_SERVICE_STATE_SLOWER_MASK) != 0u;
    state->unplugged = (word & ENDAT_MAP_SERVICE_STATE_UNPLUGGED_MASK) != 0u;
    state->initialising = (word & ENDAT_MAP_SERVICE_STATE_INITIALISING_MASK) != 0u;
    state->starts = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_STATE_STARTS, word);
    return error;
}

endat_error endat_failed_step(const endat_card *card, uint32_t channel, uint32_t *step)
{
    uint32_t word = 0u;
    endat_error error = endat_needs_service(card, channel);

    if ((error == ENDAT_OK) && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE)) {
        error = ENDAT_ERROR_PART;
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_PROGRESS_WORD(channel), &word);
    }
    *step = ENDAT_MAP_GET(ENDAT_MAP_SERVICE_PROGRESS_FAILED, word);
    return error;
}

/** Plug state from the last result, on cards without service. */
static endat_error status_of_result(const endat_card *card, uint32_t channel)
{
    uint32_t status = 0u;
    endat_error error = endat_read_word(card, ENDAT_MAP_RESULT_STATUS_WORD(channel), &status);
    const uint32_t cause = ENDAT_MAP_GET(ENDAT_MAP_RESULT_STATUS_CAUSE, status);

    if ((error == ENDAT_OK) &&
        ((cause == ENDAT_MAP_RESULT_STATUS_CAUSE_DATA_NOT_LOW) || (cause == ENDAT_MAP_RESULT_STATUS_CAUSE_NO_ENCODER))) {
        error = ENDAT_ERROR_UNPLUGGED;
    }
    return error;
}

endat_error endat_status(const endat_card *card, uint32_t channel)
{
    endat_state state;
    uint32_t step = 0u;
    endat_error error = endat_needs_endat(card, channel);

    if ((error == ENDAT_OK) && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS)) {
        return status_of_result(card, channel);
    }
    if (error == ENDAT_OK) {
        error = endat_read_state(card, channel, &state);
    }
    if (error != ENDAT_OK) {
        return error;
    }
    /* In this order: without an encoder "initialising" may be set, too. */
    if (state.unplugged) {
        error = ENDAT_ERROR_UNPLUGGED;
    } else if (state.initialising || (state.starts == 0u)) {
        error = ENDAT_ERROR_BUSY;
    } else if (!state.initialised && endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE)) {
        error = endat_failed_step(card, channel, &step);
        if (error == ENDAT_OK) {
            /* No step has failed yet: the initialisation is about to begin. */
            error = (step != 0u) ? ENDAT_ERROR_INITIALISATION : ENDAT_ERROR_BUSY;
        }
    } else {
        error = ENDAT_OK;
    }
    return error;
}

endat_error endat_wait_ready(const endat_card *card, uint32_t channel, uint32_t limit_ms)
{
    bool was_away;
    endat_wait wait;
    endat_error error = endat_status(card, channel);

    endat_wait_begin(&wait, card, endat_ms(limit_ms));
    was_away = (error == ENDAT_ERROR_UNPLUGGED);
    while (((error == ENDAT_ERROR_BUSY) || (error == ENDAT_ERROR_UNPLUGGED)) && endat_wait_more(&wait, STATE_PAUSE_US)) {
        error = endat_status(card, channel);
        was_away = was_away || (error == ENDAT_ERROR_UNPLUGGED);
    }
    if ((error == ENDAT_OK) && was_away && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE)) {
        /* An initialisation takes longer than the pause; without one there is no flag for lost triggers. */
        endat_wait_begin(&wait, card, ABORT_PAUSE_US);
        while (endat_wait_more(&wait, STATE_PAUSE_US)) {
        }
    }
    return (error == ENDAT_ERROR_BUSY) ? ENDAT_ERROR_TIMEOUT : error;
}

/** Writes the whole word control, so that earlier actions are not repeated. */
static endat_error control(const endat_card *card, uint32_t channel, uint32_t word)
{
    endat_error error = endat_needs_service(card, channel);

    if (error == ENDAT_OK) {
        error = endat_write_word(card, ENDAT_MAP_SERVICE_CONTROL_WORD(channel), word);
    }
    return error;
}

endat_error endat_initialise(const endat_card *card, uint32_t channel)
{
    endat_error error = endat_needs_endat(card, channel);

    if ((error == ENDAT_OK) && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE)) {
        error = ENDAT_ERROR_PART;
    }
    return (error == ENDAT_OK) ? control(card, channel, ENDAT_MAP_SERVICE_CONTROL_INITIALISE_MASK) : error;
}

endat_error endat_clear(const endat_card *card, uint32_t channel)
{
    return control(card, channel, ENDAT_MAP_SERVICE_CONTROL_CLEAR_MASK);
}

endat_error endat_request_cancel(const endat_card *card, uint32_t channel)
{
    return control(card, channel, ENDAT_MAP_SERVICE_CONTROL_CANCEL_MASK);
}

endat_error endat_read_plate(const endat_card *card, uint32_t word_address, uint16_t *value)
{
    uint32_t word = 0u;
    const bool is_plate =
        (word_address >= ENDAT_MAP_SERVICE_ALARMS_WORD(0u)) &&
        (word_address < (ENDAT_MAP_SERVICE_BASE_WORD + (ENDAT_MAP_SERVICE_STRIDE_WORDS * card->channels)));
    endat_error error = is_plate ? ENDAT_OK : ENDAT_ERROR_ARGUMENT;

    if ((error == ENDAT_OK) && !endat_has(card, ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE)) {
        error = ENDAT_ERROR_PART;
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, word_address, &word);
    }
    if ((error == ENDAT_OK) && ((word & ENDAT_MAP_SERVICE_ALARMS_IS_READ_MASK) == 0u)) {
        error = ENDAT_NOTHING;
    }
    *value = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_ALARMS_VALUE, word);
    return error;
}

/** Appends a character to a text, if it is printable. */
static uint32_t add_letter(char *text, uint32_t length, uint32_t letter)
{
    uint32_t longer = length;

    if ((letter > 0x20u) && (letter < 0x7Fu)) {
        text[length] = (char)letter;
        longer++;
    }
    return longer;
}

/** Appends a number to a text. */
static uint32_t add_number(char *text, uint32_t length, uint32_t number)
{
    uint32_t unit = 1000000000u;
    uint32_t longer = length;

    while ((unit > 1u) && ((number / unit) == 0u)) {
        unit /= 10u;
    }
    while (unit > 0u) {
        text[longer] = (char)(0x30u + ((number / unit) % 10u));
        longer++;
        unit /= 10u;
    }
    return longer;
}

/** A word of the name plate of a channel, unless an error has occurred. */
static uint32_t plate_word(const endat_card *card, uint32_t channel, uint32_t word_address, endat_error *error)
{
    uint16_t value = 0u;

    if (*error == ENDAT_OK) {
        *error = endat_needs_endat(card, channel);
    }
    if (*error == ENDAT_OK) {
        *error = endat_read_plate(card, word_address, &value);
    }
    return value;
}

endat_error endat_id(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES])
{
    endat_error error = ENDAT_OK;
    const uint32_t letters = plate_word(card, channel, ENDAT_MAP_SERVICE_ID_0_WORD(channel), &error);
    const uint32_t low = plate_word(card, channel, ENDAT_MAP_SERVICE_ID_1_WORD(channel), &error);
    const uint32_t high = plate_word(card, channel, ENDAT_MAP_SERVICE_ID_2_WORD(channel), &error);
    uint32_t length = 0u;

    if (error == ENDAT_OK) {
        length = add_letter(text, length, letters >> 8u);
        length = add_letter(text, length, letters & 0xFFu);
        length = add_number(text, length, (high << 16u) | low);
    }
    text[length] = '\0';
    return error;
}

endat_error endat_serial(const endat_card *card, uint32_t channel, char text[ENDAT_NUMBER_BYTES])
{
    endat_error error = ENDAT_OK;
    /* High byte and a letter, the middle, a letter and the low byte. */
    const uint32_t first = plate_word(card, channel, ENDAT_MAP_SERVICE_SERIAL_0_WORD(channel), &error);
    const uint32_t middle = plate_word(card, channel, ENDAT_MAP_SERVICE_SERIAL_1_WORD(channel), &error);
    const uint32_t last = plate_word(card, channel, ENDAT_MAP_SERVICE_SERIAL_2_WORD(channel), &error);
    uint32_t length = 0u;

    if (error == ENDAT_OK) {
        length = add_letter(text, length, first & 0xFFu);
        length = add_number(text, length, ((first >> 8u) << 24u) | (middle << 8u) | (last & 0xFFu));
        length = add_letter(text, length, last >> 8u);
    }
    text[length] = '\0';
    return error;
}

endat_error endat_read_name_plate(const endat_card *card, uint32_t channel, endat_name_plate *plate)
{
    endat_error error = ENDAT_OK;
    const uint32_t bits = plate_word(card, channel, ENDAT_MAP_SERVICE_POSITION_BITS_WORD(channel), &error);
    const uint32_t type = plate_word(card, channel, ENDAT_MAP_SERVICE_ENCODER_TYPE_WORD(channel), &error);
    const uint32_t periods_low = plate_word(card, channel, ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_WORD(channel), &error);
    const uint32_t periods_high = plate_word(card, channel, ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_WORD(channel), &error);
    const uint32_t steps_low = plate_word(card, channel, ENDAT_MAP_SERVICE_STEPS_LOW_WORD(channel), &error);
    const uint32_t steps_high = plate_word(card, channel, ENDAT_MAP_SERVICE_STEPS_HIGH_WORD(channel), &error);

    plate->position_bits = bits & 0x3Fu;
    plate->rotary = (type >> 15u) != 0u;
    plate->signal_periods = (periods_high << 16u) | periods_low;
    plate->steps = (steps_high << 16u) | steps_low;
    plate->revolutions = plate_word(card, channel, ENDAT_MAP_SERVICE_REVOLUTIONS_WORD(channel), &error);
    plate->id[0] = '\0';
    plate->serial[0] = '\0';
    if (error == ENDAT_OK) {
        error = endat_id(card, channel, plate->id);
    }
    if (error == ENDAT_OK) {
        error = endat_serial(card, channel, plate->serial);
    }
    return error;
}

endat_error endat_request_begin(const endat_card *card, endat_request *request, uint32_t channel, uint32_t command, uint32_t address,
                                uint32_t data)
{
    endat_state state;
    uint32_t word = 0u;
    endat_error error = endat_needs_service(card, channel);

    if ((error == ENDAT_OK) && ((command > 0x3Fu) || (address > ADDRESS_MAX) || (data > DATA_MAX))) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_read_state(card, channel, &state);
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_REQUEST_STATE_WORD(channel), &word);
    }
    if (error != ENDAT_OK) {
        return error;
    }
    if (state.unplugged) {
        error = ENDAT_ERROR_UNPLUGGED;
    } else if (state.initialising || (state.starts == 0u) || ((word & ENDAT_MAP_SERVICE_REQUEST_STATE_BUSY_MASK) != 0u)) {
        error = ENDAT_ERROR_BUSY;
    } else {
        request->channel = channel;
        request->finished = ENDAT_MAP_GET(ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED, word);
        error = endat_write_word(card, ENDAT_MAP_SERVICE_REQUEST_WORD(channel),
                                 ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_COMMAND, command) |
                                     ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_ADDRESS, address) |
                                     ENDAT_MAP_PUT(ENDAT_MAP_SERVICE_REQUEST_DATA, data));
    }
    return error;
}

endat_error endat_request_poll(const endat_card *card, const endat_request *request, endat_answer *answer)
{
    const uint32_t channel = request->channel;
    uint32_t state = 0u;
    uint32_t low = 0u;
    uint32_t more = 0u;
    uint32_t duration = 0u;
    uint32_t ended;
    uint32_t ms;
    endat_error error = endat_read_word(card, ENDAT_MAP_SERVICE_REQUEST_STATE_WORD(channel), &state);

    if (error != ENDAT_OK) {
        return error;
    }
    /* "busy" may still be 0 in the first reads; only the number is reliable. */
    ended = (ENDAT_MAP_GET(ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED, state) - request->finished) & FINISHED_MAX;
    if ((ended == 0u) || ((ended == 1u) && ((state & ENDAT_MAP_SERVICE_REQUEST_STATE_BUSY_MASK) != 0u))) {
        return ENDAT_ERROR_BUSY;
    }
    if (ended != 1u) {
        return ENDAT_ERROR_RESTARTED;
    }
    error = endat_read_word(card, ENDAT_MAP_SERVICE_ANSWER_WORD(channel), &low);
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_ANSWER_MORE_WORD(channel), &more);
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_DURATION_WORD(channel), &duration);
    }
    if (error != ENDAT_OK) {
        return error;
    }
    ms = ENDAT_MAP_GET(ENDAT_MAP_SERVICE_DURATION_MS, duration);
    answer->refusal = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR, state);
    answer->address = (uint8_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_ANSWER_ADDRESS, low);
    answer->data = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_ANSWER_DATA, low);
    more = ENDAT_MAP_GET(ENDAT_MAP_SERVICE_ANSWER_MORE_VALUE, more);
    answer->bits = ((uint64_t)more << 32u) | low;
    answer->time_us = (ms < WRAPS_MS) ? ENDAT_MAP_GET(ENDAT_MAP_SERVICE_DURATION_US, duration) : (ms * 1000u);
    return (answer->refusal == 0u) ? ENDAT_OK : ENDAT_ERROR_REFUSED;
}

endat_error endat_send(const endat_card *card, uint32_t channel, uint32_t command, uint32_t address, uint32_t data, uint32_t limit_ms,
                       endat_answer *answer)
{
    endat_request request = {0u, 0u};
    bool is_sent = false;
    endat_wait wait;
    endat_error error;

    answer->refusal = 0u;
    answer->address = 0u;
    answer->data = 0u;
    answer->bits = 0u;
    answer->time_us = 0u;
    endat_wait_begin(&wait, card, endat_ms(limit_ms));
    do {
        if (is_sent) {
            error = endat_request_poll(card, &request, answer);
        } else {
            error = endat_request_begin(card, &request, channel, command, address, data);
            if (error == ENDAT_OK) {
                is_sent = true;
                error = ENDAT_ERROR_BUSY;
            }
        }
    } while ((error == ENDAT_ERROR_BUSY) && endat_wait_more(&wait, ENDAT_REQUEST_PAUSE_US));
    if (error == ENDAT_ERROR_BUSY) {
        error = ENDAT_ERROR_TIMEOUT;
        if (is_sent) {
            /* Ignore its result: the call returns the time-out in any case. */
            (void)endat_request_cancel(card, channel);
        }
    }
    return error;
}

endat_error endat_select_memory(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t block, uint32_t limit_ms,
                                endat_answer *answer)
{
    return endat_send(card, channel, ENDAT_MAP_SERVICE_REQUEST_COMMAND_SELECT_MEMORY, mrs, block, limit_ms, answer);
}

/** Selects an area of the memory, and sends a command for a word in it. */
static endat_error in_memory(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t command, uint32_t address, uint32_t data,
                             uint32_t limit_ms, endat_answer *answer)
{
    endat_error error = ENDAT_OK;

    /* A wrong argument is rejected before anything is selected. */
    if ((address <= ADDRESS_MAX) && (data <= DATA_MAX)) {
        error = endat_select_memory(card, channel, mrs, 0u, limit_ms, answer);
    }
    return (error == ENDAT_OK) ? endat_send(card, channel, command, address, data, limit_ms, answer) : error;
}

endat_error endat_read_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t limit_ms,
                                 endat_answer *answer)
{
    return in_memory(card, channel, mrs, ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_PARAMETER, address, 0u, limit_ms, answer);
}

endat_error endat_write_parameter(const endat_card *card, uint32_t channel, uint32_t mrs, uint32_t address, uint32_t data,
                                  uint32_t limit_ms, endat_answer *answer)
{
    return in_memory(card, channel, mrs, ENDAT_MAP_SERVICE_REQUEST_COMMAND_RECEIVE_PARAMETER, address, data, limit_ms, answer);
}

endat_error endat_select_infos(const endat_card *card, uint32_t channel, const uint8_t *mrs, uint32_t count)
{
    endat_error error = endat_needs_service(card, channel);
    uint32_t n;

    for (n = 0u; (n < count) && (count <= ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MAX); n++) {
        /* Bits 7..5 select additional data; bits 3..0 = 15 deselect them. */
        if ((error == ENDAT_OK) && (((mrs[n] & 0xE0u) != 0x40u) || ((mrs[n] & 0x0Fu) == 0x0Fu))) {
            error = ENDAT_ERROR_ARGUMENT;
        }
    }
    if ((error == ENDAT_OK) && (count > ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MAX)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    /* The list is inactive while it is being written. */
    if (error == ENDAT_OK) {
        error = endat_write_checked(card, ENDAT_MAP_SERVICE_LIST_LENGTH_WORD(channel), 0u);
    }
    for (n = 0u; (n < count) && (error == ENDAT_OK); n++) {
        error = endat_write_checked(card, ENDAT_MAP_SERVICE_LIST_0_WORD(channel) + n, mrs[n]);
    }
    if ((error == ENDAT_OK) && (count > 0u)) {
        error = endat_write_checked(card, ENDAT_MAP_SERVICE_LIST_LENGTH_WORD(channel), count);
    }
    return error;
}

endat_error endat_read_info(const endat_card *card, uint32_t channel, uint32_t index, uint16_t *content, uint16_t *sequence)
{
    uint32_t word = 0u;
    endat_error error = endat_needs_service(card, channel);

    if ((error == ENDAT_OK) && (index >= ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MAX)) {
        error = ENDAT_ERROR_ARGUMENT;
    }
    if (error == ENDAT_OK) {
        error = endat_read_word(card, ENDAT_MAP_SERVICE_SLOT_0_WORD(channel) + index, &word);
    }
    *content = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_SLOT_0_VALUE, word);
    *sequence = (uint16_t)ENDAT_MAP_GET(ENDAT_MAP_SERVICE_SLOT_0_SEQUENCE, word);
    return error;
}
