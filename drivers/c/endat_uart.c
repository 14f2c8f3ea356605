/**
 * @file endat_uart.c
 * Words over a UART, in the byte format of UARTBone.
 */
#include "endat_transports.h"
#include <stddef.h>

#define COMMAND_WRITE 1u
#define COMMAND_READ 2u
/** Bytes of command, number and address. */
#define HEAD_BYTES 6u

static void put_word(uint8_t *bytes, uint32_t word)
{
    bytes[0] = (uint8_t)(word >> 24u);
    bytes[1] = (uint8_t)((word >> 16u) & 0xFFu);
    bytes[2] = (uint8_t)((word >> 8u) & 0xFFu);
    bytes[3] = (uint8_t)(word & 0xFFu);
}

static endat_error read_burst(void *context, uint32_t word_address, uint32_t count, uint32_t *values)
{
    endat_uart *const uart = (endat_uart *)context;
    uint8_t bytes[HEAD_BYTES] = {(uint8_t)COMMAND_READ, (uint8_t)count, 0u, 0u, 0u, 0u};
    endat_error error;
    uint32_t n;

    if ((count == 0u) || (count > ENDAT_BURST_WORDS)) {
        return ENDAT_ERROR_ARGUMENT;
    }
    put_word(&bytes[2], word_address);
    error = uart->send(uart->context, bytes, HEAD_BYTES);
    for (n = 0u; (n < count) && (error == ENDAT_OK); n++) {
        error = uart->receive(uart->context, bytes, 4u);
        values[n] = ((uint32_t)bytes[0] << 24u) | ((uint32_t)bytes[1] << 16u) | ((uint32_t)bytes[2] << 8u) | bytes[3];
    }
    return error;
}

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    return read_burst(context, word_address, 1u, value);
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    endat_uart *const uart = (endat_uart *)context;
    uint8_t bytes[HEAD_BYTES + 4u] = {(uint8_t)COMMAND_WRITE, 1u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u};

    put_word(&bytes[2], word_address);
    put_word(&bytes[HEAD_BYTES], value);
    return uart->send(uart->context, bytes, HEAD_BYTES + 4u);
}

void endat_uart_link(endat_uart *uart, endat_link *link)
{
    link->context = uart;
    link->read = read_word;
    link->write = write_word;
    link->read_burst = read_burst;
    link->now_us = NULL;
    link->wait_us = NULL;
}
