/**
 * @file endat_spi.c
 * Words over SPI, with the check sums of the frame.
 */
#include "endat_internal.h"
#include "endat_transports.h"
#include <stddef.h>

#define COMMAND_WRITE 2u
#define COMMAND_READ 3u
/** First byte of an answer: the last write was good, or was not. */
#define STATUS_GOOD 0xA0u
#define STATUS_BAD_WRITE 0xA2u
/** Bytes of command, address and number. */
#define HEAD_BYTES 4u
/** Offset of the first word in an answer. */
#define ANSWER_AT 5u
/** Inverts a check sum, so that it differs from the right one in more bits than a disturbance. */
#define ALL_WRONG 0xFFFFu

static void put_head(endat_spi *spi, uint8_t command, uint32_t word_address, uint32_t count)
{
    spi->sent[0] = command;
    spi->sent[1] = (uint8_t)((word_address >> 8u) & 0xFFu);
    spi->sent[2] = (uint8_t)(word_address & 0xFFu);
    spi->sent[3] = (uint8_t)count;
}

/** One read; ENDAT_ERROR_CHECKSUM if it was disturbed. */
static endat_error read_once(endat_spi *spi, uint32_t word_address, uint32_t count, uint32_t *values)
{
    const uint32_t crc_at = ANSWER_AT + (4u * count);
    uint32_t crc;
    uint32_t n;
    endat_error error;

    put_head(spi, (uint8_t)COMMAND_READ, word_address, count);
    for (n = HEAD_BYTES; n < (crc_at + 2u); n++) {
        spi->sent[n] = 0u;
    }
    error = spi->transfer(spi->context, spi->sent, spi->received, crc_at + 2u);
    if (error != ENDAT_OK) {
        return error;
    }
    crc = endat_crc16(ENDAT_CRC16_START, spi->sent, HEAD_BYTES);
    crc = endat_crc16(crc, &spi->received[ANSWER_AT], 4u * count);
    if (crc != (((uint32_t)spi->received[crc_at] << 8u) | spi->received[crc_at + 1u])) {
        return ENDAT_ERROR_CHECKSUM;
    }
    for (n = 0u; n < count; n++) {
        const uint8_t *const word = &spi->received[ANSWER_AT + (4u * n)];
        values[n] = ((uint32_t)word[0] << 24u) | ((uint32_t)word[1] << 16u) | ((uint32_t)word[2] << 8u) | word[3];
    }
    return ENDAT_OK;
}

static endat_error read_burst(void *context, uint32_t word_address, uint32_t count, uint32_t *values)
{
    endat_spi *const spi = (endat_spi *)context;
    endat_error error = ENDAT_ERROR_CHECKSUM;
    uint32_t tries = 0u;

    if ((count == 0u) || (count > ENDAT_BURST_WORDS)) {
        return ENDAT_ERROR_ARGUMENT;
    }
    do {
        error = read_once(spi, word_address, count, values);
        if (error == ENDAT_ERROR_CHECKSUM) {
            spi->disturbed++;
        }
        tries++;
    } while ((error == ENDAT_ERROR_CHECKSUM) && (tries < spi->tries));
    return error;
}

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    return read_burst(context, word_address, 1u, value);
}

/** Result of the last write, from the head of a good read; read twice, because the head has no check sum. */
static endat_error last_write(endat_spi *spi)
{
    uint32_t status[2] = {0u, 1u};
    uint32_t tries = 0u;
    endat_error error = ENDAT_OK;

    while ((error == ENDAT_OK) && (status[0] != status[1]) && (tries <= spi->tries)) {
        uint32_t n;
        for (n = 0u; (n < 2u) && (error == ENDAT_OK); n++) {
            uint32_t id = 0u;
            error = read_word(spi, ENDAT_MAP_CARD_ID_WORD, &id);
            status[n] = spi->received[0];
        }
        tries++;
    }
    if ((error == ENDAT_OK) && (status[0] == STATUS_BAD_WRITE) && (status[1] == STATUS_BAD_WRITE)) {
        error = ENDAT_ERROR_CHECKSUM;
    } else if ((error == ENDAT_OK) && ((status[0] != STATUS_GOOD) || (status[1] != STATUS_GOOD))) {
        error = ENDAT_ERROR_LINK;
    } else {
        /* It was good, or is unknown. */
    }
    return error;
}

/** One write of a word, with its check sum or with a wrong one. spi->received[0] has the result of the previous write. */
static endat_error write_once(endat_spi *spi, uint32_t word_address, uint32_t value, uint32_t wrong)
{
    uint32_t crc;
    uint32_t n;

    put_head(spi, (uint8_t)COMMAND_WRITE, word_address, 1u);
    for (n = 0u; n < 4u; n++) {
        spi->sent[HEAD_BYTES + n] = (uint8_t)((value >> (24u - (8u * n))) & 0xFFu);
    }
    crc = endat_crc16(ENDAT_CRC16_START, spi->sent, HEAD_BYTES + 4u) ^ wrong;
    spi->sent[HEAD_BYTES + 4u] = (uint8_t)(crc >> 8u);
    spi->sent[HEAD_BYTES + 5u] = (uint8_t)(crc & 0xFFu);
    return spi->transfer(spi->context, spi->sent, spi->received, HEAD_BYTES + 6u);
}

/*
 * The card does not detect a write whose command byte was disturbed. So a frame with a wrong check sum goes first,
 * which writes nothing: the card reports "bad" until the good write has arrived.
 */
static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    endat_spi *const spi = (endat_spi *)context;
    endat_error error = ENDAT_ERROR_CHECKSUM;
    uint32_t tries = 0u;

    if (spi->unconfirmed) {
        return write_once(spi, word_address, value, 0u);
    }
    do {
        error = write_once(spi, word_address, value, ALL_WRONG);
        if (error == ENDAT_OK) {
            error = write_once(spi, word_address, value, 0u);
        }
        if (error == ENDAT_OK) {
            const bool was_bad = (spi->received[0] == STATUS_BAD_WRITE);
            error = last_write(spi);
            error = ((error == ENDAT_OK) && !was_bad) ? ENDAT_ERROR_CHECKSUM : error;
        }
        if (error == ENDAT_ERROR_CHECKSUM) {
            spi->disturbed++;
        }
        tries++;
    } while ((error == ENDAT_ERROR_CHECKSUM) && (tries < spi->tries));
    return error;
}

void endat_spi_link(endat_spi *spi, endat_link *link)
{
    link->context = spi;
    link->read = read_word;
    link->write = write_word;
    link->read_burst = read_burst;
    link->now_us = NULL;
    link->wait_us = NULL;
}
