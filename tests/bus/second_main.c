#include <stdio.h>
#include <stdlib.h>

/* Reads answers: hash, count of the first one, whether each has the next count and the sequence goes on. */
int main(int argc, char **argv)
{
    static const unsigned width[2] = {29, 25};
    uint8_t answer[BYTES];
    uint16_t sequence[2] = {0, 0};

    if (argc != 4)
        return 2;
    for (unsigned n = 0; fread(answer, 1, sizeof answer, stdin) == sizeof answer; n++) {
        const int goes_on = argv[3][0] == '1';
        const unsigned count = (unsigned)strtoul(argv[2], 0, 0) + (goes_on ? n : 0);
        printf("%d", second_head(answer, 2, (uint32_t)strtoul(argv[1], 0, 0), (uint16_t)count));
        for (unsigned channel = 0; channel < 2; channel++) {
            uint64_t position;
            if (!goes_on)
                sequence[channel] = 0;
            if (second_position(answer, channel, width[channel], &sequence[channel], &position))
                printf(" %llu", (unsigned long long)position);
            else
                printf(" -");
        }
        printf("\n");
    }
    return 0;
}
