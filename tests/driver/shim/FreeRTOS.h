/* As much of FreeRTOS as the example names: to compile it, not to run it. */
#ifndef FREERTOS_SHIM_H
#define FREERTOS_SHIM_H
#include <stdint.h>
typedef uint32_t TickType_t;
typedef long BaseType_t;
#define portTICK_PERIOD_MS ((TickType_t)1)
#define portMAX_DELAY ((TickType_t)0xFFFFFFFFu)
#endif
