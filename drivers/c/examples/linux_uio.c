/**
 * @file linux_uio.c
 * A card on the bus of a system on chip, from user space over UIO: identification, a parameter, and positions as long as they are good.
 * On a PC the same program uses the card that endat-gen simulates.
 *
 *   cc -std=c99 -O2 -I.. -o endat_uio linux_uio.c ../endat*.c && ./endat_uio /dev/uio0
 *   endat card --preset artinchip_endat_if --tcp 127.0.0.1:7700 & ./endat_uio tcp 127.0.0.1 7700
 */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <inttypes.h>
#include <netdb.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "endat.h"
#include "endat_transports.h"

/** Ratio of real time to the time of a simulated card, at most, on a busy machine; its `card` command prints the ratio at the start. */
#define SIMULATED_SLOWER 1000u

/** 1 with real hardware. */
static uint32_t slower = 1u;

static endat_error read_word(void *context, uint32_t word_address, uint32_t *value)
{
    *value = ((volatile uint32_t *)context)[word_address];
    return ENDAT_OK;
}

static endat_error write_word(void *context, uint32_t word_address, uint32_t value)
{
    ((volatile uint32_t *)context)[word_address] = value;
    return ENDAT_OK;
}

static uint32_t now_us(void *context)
{
    struct timespec now;

    (void)context;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    /* All limits use this time: with a slow card they last longer. */
    return (uint32_t)(((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u) / slower);
}

static void wait_us(void *context, uint32_t us)
{
    const struct timespec span = {(time_t)(us / 1000000u), (long)(us % 1000000u) * 1000L};

    (void)context;
    (void)nanosleep(&span, NULL);
}

/** Until the socket delivers a byte, or the other end has closed it. */
static endat_error receive_bytes(void *context, uint8_t *bytes, uint32_t count)
{
    const int file = *(const int *)context;
    ssize_t more = 1;

    while ((count > 0u) && (more > 0)) {
        more = recv(file, bytes, count, 0);
        if (more > 0) {
            bytes += more;
            count -= (uint32_t)more;
        }
    }
    return (count == 0u) ? ENDAT_OK : ENDAT_ERROR_LINK;
}

static endat_error send_bytes(void *context, const uint8_t *bytes, uint32_t count)
{
    return (send(*(const int *)context, bytes, count, MSG_NOSIGNAL) == (ssize_t)count) ? ENDAT_OK : ENDAT_ERROR_LINK;
}

/** A socket to a simulated card, -1 if there is none. */
static int connect_to(const char *host, const char *port)
{
    const struct addrinfo wanted = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    const struct timeval patience = {10, 0};
    struct addrinfo *found = NULL;
    int file = -1;

    if (getaddrinfo(host, port, &wanted, &found) == 0) {
        file = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
        if ((file >= 0) && (connect(file, found->ai_addr, found->ai_addrlen) != 0)) {
            (void)close(file);
            file = -1;
        }
        freeaddrinfo(found);
    }
    if (file >= 0) {
        (void)setsockopt(file, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    }
    return file;
}

static void show(const endat_moment *moment)
{
    uint32_t n;

    for (n = 0u; n < moment->channels; n++) {
        const endat_result *const result = &moment->channel[n];
        printf("channel %" PRIu32 ": %" PRId64 ", %s, %s\n", n, endat_signed(result->position, result->width_bits),
               (result->fresh && !result->stale) ? "fresh" : "old", endat_cause_text(result->cause));
        if (result->cause != 0u) {
            printf("  %s %s\n", endat_cause_meaning(result->cause), endat_cause_remedy(result->cause));
        }
    }
}

static endat_error run(endat_card *card)
{
    endat_moment moment;
    endat_error error = endat_try_link(card);
    uint32_t n;

    printf("%" PRIu32 " channels, register map %" PRIu32 ".%" PRIu32 ", configuration %08" PRIx32 ", %" PRIu32 " Hz\n", card->channels,
           card->version >> 24u, (card->version >> 16u) & 0xFFu, card->configuration_hash, card->system_hz);
    for (n = 0u; (n < card->channels) && (error == ENDAT_OK); n++) {
        const endat_error is_ready = endat_wait_ready(card, n, 5000u);
        endat_answer answer;
        endat_name_plate plate;
        printf("channel %" PRIu32 ": %s\n", n, endat_error_text(is_ready));
        if ((is_ready == ENDAT_OK) && (endat_read_parameter(card, n, 0xA1u, 0x0Du, 500u, &answer) == ENDAT_OK)) {
            printf("  word 13 of its memory: 0x%04x\n", answer.data);
        }
        if ((is_ready == ENDAT_OK) && (endat_read_name_plate(card, n, &plate) == ENDAT_OK)) {
            printf("  ID number %s, serial number %s, %" PRIu32 "%s\n", plate.id, plate.serial, plate.steps,
                   plate.rotary ? " measuring steps per revolution" : " nm");
        }
    }
    if (error == ENDAT_OK) {
        error = endat_set_triggers(card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK, 0u);
    }
    for (n = 0u; (n < 10u) && (error == ENDAT_OK); n++) {
        error = endat_measure(card, &moment, 5000u);
        if ((error == ENDAT_OK) || (error == ENDAT_ERROR_TIMEOUT)) {
            show(&moment);
            error = ENDAT_OK;
        }
        wait_us(NULL, 100000u);
    }
    return error;
}

/** Opens the card of a link, and prints it; returns the exit code. */
static int show_card(const char *name, const endat_link *link)
{
    endat_card card;
    endat_error error = endat_open(&card, link, 0u);

    if (error == ENDAT_OK) {
        error = run(&card);
    }
    if (error != ENDAT_OK) {
        fprintf(stderr, "%s: %s\n", name, endat_error_text(error));
    }
    return (error == ENDAT_OK) ? 0 : 1;
}

/** The simulated card at a TCP port, with any bus. */
static int over_tcp(const char *host, const char *port)
{
    int file = connect_to(host, port);
    endat_uart uart = {&file, send_bytes, receive_bytes};
    endat_link link;
    int code;

    if (file < 0) {
        fprintf(stderr, "tcp %s %s: no card at this port\n", host, port);
        return 2;
    }
    slower = SIMULATED_SLOWER;
    endat_uart_link(&uart, &link);
    link.now_us = now_us;
    link.wait_us = wait_us;
    code = show_card("tcp", &link);
    (void)close(file);
    return code;
}

static int over_uio(const char *path)
{
    const int file = open(path, O_RDWR | O_SYNC);
    void *const map = (file >= 0) ? mmap(NULL, ENDAT_MAP_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
    endat_link link;
    int code;

    if (map == MAP_FAILED) {
        perror(path);
        return 2;
    }
    (void)memset(&link, 0, sizeof link);
    link.context = map;
    link.read = read_word;
    link.write = write_word;
    link.now_us = now_us;
    link.wait_us = wait_us;
    code = show_card(path, &link);
    (void)munmap(map, ENDAT_MAP_BYTES);
    (void)close(file);
    return code;
}

int main(int count, char **arguments)
{
    if ((count == 4) && (strcmp(arguments[1], "tcp") == 0)) {
        return over_tcp(arguments[2], arguments[3]);
    }
    return over_uio((count > 1) ? arguments[1] : "/dev/uio0");
}
