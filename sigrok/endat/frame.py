# SPDX-License-Identifier: MIT OR Apache-2.0
"""Clock pulses with DATA, and the bits of an answer in them. Times are sample numbers; rising edges count from 1."""

from bisect import bisect_right
from statistics import median

# DATA pulses shorter than this part of a period are passed over.
SHORT = 0.25
# The sample moves at most so far before its clock edge, in periods: the rounding of two edges to samples.
EARLY = 1 / 32
# DATA has to rest for this part of each period.
EYE = 0.3
# An edge of DATA so many periods after its place belongs to an earlier clock pulse.
LATE = 0.25
# CLOCK LOW for so many times a usual LOW is parked: half a period and 2 us at least.
PARKED = 1.3
# This many HIGH times tell how long they are.
LEARNED = 15


def crc5(bits):
    """x^5 + x^3 + x + 1, preset with ones, inverted; first transmitted bit first."""
    register = 0b11111
    for bit in bits:
        feedback = (register >> 4) ^ bit
        register = (register << 1) & 0b11111
        if feedback:
            register ^= 0b01011
    return register ^ 0b11111


def number(bits):
    """First bit is the most significant one."""
    value = 0
    for bit in bits:
        value = value << 1 | bit
    return value


class Burst:
    """Clock pulses without a rest between them. CLOCK was HIGH for `rested` samples before."""

    def __init__(self, begin, data, rested):
        self.rested = rested
        self.falls, self.rises = [begin], []
        # DATA at each rising edge, as the receiver sends.
        self.sent = []
        self.times, self.levels = [begin], [data]
        self.highs = []
        # Pulses that were counted only.
        self.more = 0
        self.end = begin
        self.is_shown = False

    def count(self):
        return len(self.rises) + self.more

    def fall(self, time):
        if len(self.highs) < LEARNED:
            self.highs.append(time - self.rises[-1])
        self.falls.append(time)

    def rise(self, time, data):
        self.rises.append(time)
        self.sent.append(data)

    def change(self, time, data):
        self.times.append(time)
        self.levels.append(data)

    def high_before(self, pulses):
        """HIGH time so many pulses before the last falling edge."""
        return self.falls[-1 - pulses] - self.rises[-1 - pulses]

    def tail(self):
        """Cuts the last pulse off: a burst that begins with it."""
        begin = self.falls[-2]
        place = bisect_right(self.times, begin)
        tail = Burst(begin, self.levels[place - 1], self.high_before(1))
        tail.rise(self.rises.pop(), self.sent.pop())
        tail.fall(self.falls.pop())
        tail.times += self.times[place:]
        tail.levels += self.levels[place:]
        self.falls.pop()
        del self.times[place:], self.levels[place:]
        self.end = begin
        return tail

    def high(self):
        """The usual HIGH time, None before the second pulse."""
        return median(self.highs) if self.highs else None

    def knows_high(self):
        return len(self.highs) == LEARNED

    def low(self, edge):
        """LOW time before this rising edge."""
        return self.rises[edge - 1] - self.falls[edge - 1]

    def usual_low(self):
        return median(rise - fall for fall, rise in zip(self.falls[1:], self.rises[1:]))

    def parked(self, first):
        """The last rising edge, not before this one, after which CLOCK rests LOW; None if there is none."""
        longest = PARKED * self.usual_low()
        edges = range(len(self.rises) - 1, first - 1, -1)
        return next((edge for edge in edges if self.low(edge + 1) > longest), None)

    def period(self):
        return median(b - a for a, b in zip(self.rises, self.rises[1:]))


class Cells:
    """DATA cut into the cells that the rising edges from `first` to `count` launch, `delay` samples later.

    The edges of DATA in an answer of `length` bits say where in the period cells begin: without a delay up to a period after CLOCK,
    else half a period before or after the delay. Cells beyond the last rising edge follow each other in its period.
    """

    def __init__(self, burst, first, count, delay, length):
        self.rises, self.delay, self.end = burst.rises[:count], delay, burst.end
        self.count = count
        self.period = burst.period()
        self.clean(burst)
        self.edge = first
        self.late = 0
        self.eye = 1.0
        self.offset = 0.0
        self.find_offset(first, length)

    def clean(self, burst):
        """DATA without short pulses."""
        shortest = SHORT * self.period
        self.times, self.levels = [], []
        for time, level in zip(burst.times, burst.levels):
            if len(self.times) > 1 and time - self.times[-1] < shortest:
                self.times.pop()
                self.levels.pop()
            if not self.levels or self.levels[-1] != level:
                self.times.append(time)
                self.levels.append(level)

    def level(self, time):
        return self.levels[max(0, bisect_right(self.times, time) - 1)]

    def find_offset(self, first, length):
        """Where in the period DATA changes, over the answer that begins with the first rising edge of DATA."""
        rises = self.rises
        earliest = rises[first - 1] + self.delay - EARLY * self.period
        lowest = -0.5 if self.delay else -EARLY
        phases, start = [], None
        for time, level in zip(self.times[1:], self.levels[1:]):
            edge = bisect_right(rises, time - self.delay - lowest * self.period)
            if edge < 1 or time < earliest or start is None and not level:
                continue
            start = edge if start is None else start
            # After the last pulse, and in the last cell, an encoder may let go of DATA at any time.
            if edge >= min(start + length - 1, self.count):
                break
            phase = (time - self.delay - rises[edge - 1]) / self.period
            phases.append(phase % 1.0)
            self.late = max(self.late, phase)
        if not phases:
            return
        phases.sort()
        gaps = [b - a for a, b in zip(phases, phases[1:] + [phases[0] + 1.0])]
        self.eye = max(gaps)
        middle = phases[gaps.index(self.eye)] + self.eye / 2
        self.offset = (middle - 0.5 - lowest) % 1.0 + lowest

    def is_open(self):
        return self.eye >= EYE

    def late_by(self):
        """Periods by which DATA follows a clock pulse that others already followed."""
        over = self.late - self.offset - 1.0
        return 0 if over < -LATE else int(over + LATE) + 1

    def begin(self, edge):
        beyond = max(0, edge - self.count)
        return self.rises[min(edge, self.count) - 1] + self.delay + (self.offset + beyond) * self.period

    def sample(self, edge):
        return self.level(self.begin(edge) + self.period / 2)

    def is_seen(self, edge):
        return self.begin(edge) + self.period / 2 <= self.end

    def span(self, first, last):
        """Samples from the first of these cells to the end of the last one."""
        return round(self.begin(first)), round(self.begin(last) + self.period)

    def goes_on_until(self, edge):
        """Whether DATA changes after the last clock pulse's cell and up to the beginning of this one."""
        begin, end = self.begin(self.count + 1), self.begin(edge)
        return any(begin - LATE * self.period < time < end + LATE * self.period for time in self.times)

    def find_start(self):
        """The cell of the start bit: the first HIGH one after a LOW one."""
        edge = self.edge - 1
        while edge <= self.count:
            if not self.sample(edge):
                break
            edge += 1
        while edge <= self.count:
            if self.sample(edge):
                return edge
            edge += 1
        return None
