/**
 * @file freertos.c
 * A card on SPI with FreeRTOS: one task triggers and reads, another one reads a parameter. A mutex serialises them, because only one master
 * may access a card at a time.
 */
#include "FreeRTOS.h"
#include "semphr.h"
#include "task.h"

#include "endat.h"
#include "endat_transports.h"
#include <stddef.h>

/* Board function: mode 0, chip select low from the first byte to the last; 0 = done. */
int board_spi_transfer(const uint8_t *sent, uint8_t *received, uint32_t count);
void board_take_position(uint32_t channel, int64_t position, bool is_good);

typedef struct {
    endat_card card;
    endat_spi spi;
    SemaphoreHandle_t mutex;
} board_endat;

static endat_error transfer(void *context, const uint8_t *sent, uint8_t *received, uint32_t count)
{
    (void)context;
    return (board_spi_transfer(sent, received, count) == 0) ? ENDAT_OK : ENDAT_ERROR_LINK;
}

/* Whole ticks: other tasks run meanwhile. */
static void wait_us(void *context, uint32_t us)
{
    (void)context;
    vTaskDelay((TickType_t)((us / (1000u * (uint32_t)portTICK_PERIOD_MS)) + 1u));
}

static uint32_t now_us(void *context)
{
    (void)context;
    return (uint32_t)xTaskGetTickCount() * ((uint32_t)portTICK_PERIOD_MS * 1000u);
}

/** Sets the card up; before the scheduler starts, or in a task. */
endat_error board_endat_open(board_endat *board, uint32_t hash)
{
    endat_link link;
    endat_error error;

    board->mutex = xSemaphoreCreateMutex();
    board->spi.context = board;
    board->spi.transfer = transfer;
    board->spi.tries = 4u;
    board->spi.unconfirmed = false;
    board->spi.disturbed = 0u;
    endat_spi_link(&board->spi, &link);
    link.wait_us = wait_us;
    link.now_us = now_us;
    error = endat_open(&board->card, &link, hash);
    if (error == ENDAT_OK) {
        error = endat_set_triggers(&board->card, ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK, 0u);
    }
    return error;
}

/** A task: triggers in each period, and reads the result of the previous trigger. */
void board_endat_task(void *argument)
{
    board_endat *const board = (board_endat *)argument;
    TickType_t last = xTaskGetTickCount();

    for (;;) {
        endat_moment moment;
        endat_error error;
        uint32_t n;

        vTaskDelayUntil(&last, 1u);
        (void)xSemaphoreTake(board->mutex, portMAX_DELAY);
        error = endat_read_moment(&board->card, &moment);
        (void)endat_trigger(&board->card);
        (void)xSemaphoreGive(board->mutex);
        for (n = 0u; (error == ENDAT_OK) && (n < moment.channels); n++) {
            const endat_result *const result = &moment.channel[n];
            board_take_position(n, endat_signed(result->position, result->width_bits), result->fresh && !result->stale);
        }
    }
}

/** In another task: reads a word of the encoder's memory, while positions continue. */
endat_error board_endat_parameter(board_endat *board, uint32_t channel, uint32_t command, uint32_t address, endat_answer *answer)
{
    endat_request request;
    endat_error error;

    (void)xSemaphoreTake(board->mutex, portMAX_DELAY);
    error = endat_request_begin(&board->card, &request, channel, command, address, 0u);
    (void)xSemaphoreGive(board->mutex);
    if (error == ENDAT_OK) {
        uint32_t ms = 0u;
        do {
            vTaskDelay(1u);
            ms += (uint32_t)portTICK_PERIOD_MS;
            (void)xSemaphoreTake(board->mutex, portMAX_DELAY);
            error = endat_request_poll(&board->card, &request, answer);
            (void)xSemaphoreGive(board->mutex);
        } while ((error == ENDAT_ERROR_BUSY) && (ms < 500u));
    }
    return error;
}
