/**
 * @file endat_transports.h
 * The two functions of a link for cards that are not mapped into memory: SPI, parallel bus, UART.
 */
#ifndef ENDAT_TRANSPORTS_H
#define ENDAT_TRANSPORTS_H

#include "endat.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Bytes of the longest frame on SPI: head, an idle byte, words, check sum. */
#define ENDAT_SPI_BYTES (5u + (4u * ENDAT_BURST_WORDS) + 2u)

/**
 * A card on SPI: mode 0, most significant bit first, at most an eighth of the system clock. Each frame has a check sum; a disturbed
 * frame is sent again. Must live as long as the link.
 */
typedef struct {
    void *context; /**< Passed to transfer. */
    /** Sends count bytes while it receives as many, chip select low from the first to the last. */
    endat_error (*transfer)(void *context, const uint8_t *sent, uint8_t *received, uint32_t count);
    uint32_t tries;                    /**< Largest number of transmissions of a frame; 0 counts as 1. */
    /**
     * False: a write takes four frames and is confirmed; a disturbed one is sent again, so that a trigger may
     * occur twice. True: a write is one frame without confirmation.
     */
    bool unconfirmed;
    uint32_t disturbed;                /**< Number of repeated frames, for diagnosis. */
    uint8_t sent[ENDAT_SPI_BYTES];     /**< Used by the driver. */
    uint8_t received[ENDAT_SPI_BYTES]; /**< Used by the driver. */
} endat_spi;

/** Makes a link of it; set its time hooks yourself. */
void endat_spi_link(endat_spi *spi, endat_link *link);

/** A card on the parallel bus: eight registers of 16 bits. Must live as long as the link. */
typedef struct {
    void *context;                                                               /**< Passed to both. */
    uint16_t (*get)(void *context, uint32_t bus_register);                       /**< Reads a register of the bus, 0 to 7. */
    void (*put)(void *context, uint32_t bus_register, uint16_t value);           /**< Writes a register. */
} endat_parallel;

/** Makes a link of it. */
void endat_parallel_link(endat_parallel *parallel, endat_link *link);

/** A card on a UART: 8N1. The format has no check sum; the stream is read, not pushed. Must live as long as the link. */
typedef struct {
    void *context;                                                                 /**< Passed to both. */
    endat_error (*send)(void *context, const uint8_t *bytes, uint32_t count);      /**< Sends all bytes. */
    endat_error (*receive)(void *context, uint8_t *bytes, uint32_t count);         /**< Receives all bytes, or times out. */
} endat_uart;

/** Makes a link of it. After an error of the link wait 100 ms, until the card has dropped the command. */
void endat_uart_link(endat_uart *uart, endat_link *link);

#ifdef __cplusplus
}
#endif

#endif
