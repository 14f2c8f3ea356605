/* What the scenarios of the driver's test share. */
#ifndef SCENARIOS_H
#define SCENARIOS_H

#include "endat.h"

/* Ends the program with the line and what was expected. */
#define CHECK(is_true, ...) check((is_true), __LINE__, #is_true, __VA_ARGS__)
void check(int is_true, int line, const char *expected, const char *format, ...);
/* What the bench answers to a line. */
uint64_t ask(const char *format, ...);
/* The link of this program, over the bus that it was started for. */
void make_link(const char *kind, endat_link *link);
/* Frames on SPI that went out again. */
uint32_t disturbed(void);

/* A card with an EnDat and a T-format channel, whose timer triggers. */
void t_format(const endat_card *card);

/* Without a card. */
void alone(void);

#endif
