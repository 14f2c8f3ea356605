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

/** Bytes of the longest frame on SPI: head, a byte of anything, words, check sum. */
#define ENDAT_SPI_BYTES (5u + (4u * ENDAT_BURST_WORDS) + 2u)

/**
 * A card on SPI: mode 0, most significant bit first, at most an eighth of the system clock. Each frame has its check sum; a frame that
 * was disturbed is sent again. Lives as long as the link.
 */
typedef struct {
    void *context; /**< Comes back in transfer. */
    /** Sends count bytes while it receives as many, chip select low from the first to the last. */
    endat_error (*transfer)(void *context, const uint8_t *sent, uint8_t *received, uint32_t count);
    uint32_t tries;                    /**< How often a frame goes out at most; 0 counts as 1. */
    /**
     * False: a write takes four frames, and has arrived when it is told as done; a disturbed one goes out again, so that a trigger may
     * come twice. True: it is one frame, and nobody knows.
     */
    bool unconfirmed;
    uint32_t disturbed;                /**< Frames that had to go out again, for you to look at. */
    uint8_t sent[ENDAT_SPI_BYTES];     /**< The driver's. */
    uint8_t received[ENDAT_SPI_BYTES]; /**< The driver's. */
} endat_spi;

/** Makes a link of it; its hooks for the time are yours to set. */
void endat_spi_link(endat_spi *spi, endat_link *link);

/** A card on the parallel bus: eight registers of 16 bits. Lives as long as the link. */
typedef struct {
    void *context;                                                               /**< Comes back in both. */
    uint16_t (*get)(void *context, uint32_t bus_register);                       /**< Reads a register of the bus, 0 to 7. */
    void (*put)(void *context, uint32_t bus_register, uint16_t value);           /**< Writes one. */
} endat_parallel;

/** Makes a link of it. */
void endat_parallel_link(endat_parallel *parallel, endat_link *link);

/** A card on a UART: 8N1. The format has no check sum; the stream is read, not pushed. Lives as long as the link. */
typedef struct {
    void *context;                                                                 /**< Comes back in both. */
    endat_error (*send)(void *context, const uint8_t *bytes, uint32_t count);      /**< Sends all of them. */
    endat_error (*receive)(void *context, uint8_t *bytes, uint32_t count);         /**< Receives all of them, or ends in time. */
} endat_uart;

/** Makes a link of it. After an error of the link wait 100 ms: the card has forgotten the command then. */
void endat_uart_link(endat_uart *uart, endat_link *link);

#ifdef __cplusplus
}
#endif

#endif
