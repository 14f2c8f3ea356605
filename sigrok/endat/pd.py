# SPDX-License-Identifier: MIT OR Apache-2.0
import sigrokdecode as srd

from .frame import Burst, Cells, crc5, number

# Rising clock edges, counted from 1, that take the mode command and a parameter.
COMMAND_EDGES = range(3, 9)
PARAMETER_EDGES = range(9, 33)
# The first start bit follows so many edges after the last one of these.
TURNAROUND = 3
CRC_BITS = 5
INFO_BITS = 24
BLOCK_BITS = INFO_BITS + CRC_BITS
TEST_VALUE_BITS = 40

TEST_VALUES = 0b010101
MODES = {
    0b000111: ("send position", False),
    0b001110: ("selection of memory area", True),
    0b011100: ("receive parameter", True),
    0b100011: ("send parameter", True),
    0b101010: ("receive reset", True),
    TEST_VALUES: ("send test values", False),
    0b110001: ("receive test command", True),
    0b111000: ("send position with additional data", False),
    0b001001: ("send position, select memory area", False),
    0b011011: ("send position, receive parameter", False),
    0b100100: ("send position, send parameter", False),
    0b101101: ("send position, receive error reset", False),
    0b110110: ("send position, receive test command", False),
    0b010010: ("receive communication command", True),
}
ENDAT22 = (0b111000, 0b001001, 0b011011, 0b100100, 0b101101, 0b110110)
SUPPLEMENTS = ENDAT22[1:]
# The supplement's rising edges, counted from the parked CLOCK, that take address and data; and all of them.
SUPPLEMENT_EDGES = range(10, 34)
SUPPLEMENT_PULSES = 35
POSITIONS = ENDAT22 + (0b000111, TEST_VALUES)

# An encoder is ready 1.75 us after a frame at the earliest; up to 1 MHz it takes 10.5 us, at least 2.1 HIGH times. HIGH times may
# differ by a fifth; the first ones are compared with few others.
REST_US = 1.4
REST_HIGHS = 1.4
FIRST_REST_HIGHS = 1.6
# The same if the pulses after it are known.
SPLIT_HIGHS = 2
# Before anything is known of CLOCK. After a frame DATA is watched for so long, and an encoder has given up what was cut.
LONGEST_US = 10
# At the beginning of a capture a shorter rest than REST_US shows a frame's beginning if CLOCK is even.
FIRST_HIGHS = 3
# Pulses that are decoded at most: an encoder may take 12 ms for a parameter.
MOST_PULSES = 100000

MODE, PARAMETER, START, ERROR, POSITION, INFO, CRC, WARNING, REFUSED = range(9)


class Decoder(srd.Decoder):
    api_version = 3
    id = "endat"
    name = "EnDat"
    longname = "EnDat 2.1/2.2"
    desc = "Serial protocol of absolute position encoders."
    license = "unknown"  # MIT OR Apache-2.0; the list of names knows neither
    inputs = ["logic"]
    outputs = []
    tags = ["Encoding", "Sensor"]
    channels = (
        {"id": "clk", "name": "CLOCK", "desc": "Clock, idles high"},
        {"id": "data", "name": "DATA", "desc": "Data in both directions"},
    )
    options = (
        {"id": "bits", "desc": "Position bits", "default": 29},
        {"id": "delay_ns", "desc": "DATA follows CLOCK so late, within half a period (ns); 0: less than a period", "default": 0},
        {"id": "idle_us", "desc": "CLOCK high for so long ends a frame (us); 0: found from CLOCK", "default": 0},
    )
    annotations = (
        ("mode", "Mode command"),
        ("parameter", "Parameter"),
        ("start", "Start bit"),
        ("error", "Error bits"),
        ("position", "Position"),
        ("info", "Additional data"),
        ("crc", "CRC"),
        ("warning", "Warning"),
        ("refused", "Refused"),
    )
    annotation_rows = (
        ("fields", "Fields", (MODE, PARAMETER, START, ERROR, POSITION, INFO, CRC, REFUSED)),
        ("warnings", "Warnings", (WARNING,)),
    )

    def __init__(self):
        self.reset()

    def reset(self):
        self.samplerate = None

    def metadata(self, key, value):
        if key == srd.SRD_CONF_SAMPLERATE:
            self.samplerate = value

    def start(self):
        self.out_ann = self.register(srd.OUTPUT_ANN)

    def put_text(self, begin, end, row, texts):
        self.put(begin, max(begin, end), self.out_ann, [row, texts])

    def warn(self, begin, end, text):
        self.put_text(begin, end, WARNING, [text])

    def samples(self, us):
        return max(1, round(us * self.samplerate / 1e6))

    # Capture

    def decode(self):
        if not self.samplerate:
            raise srd.DecoderError("Cannot decode without samplerate.")
        self.delay = self.options["delay_ns"] * self.samplerate / 1e9
        self.is_first, self.is_cut = True, False
        data = self.wait({0: "f"})[1]
        rested = self.samplenum
        while True:
            self.burst = Burst(self.samplenum, data, rested)
            try:
                data = self.record()
            except (EOFError, SystemError):
                # Nothing comes after the capture's last sample.
                self.finish(self.burst, is_last=True)
                raise
            rested = self.samplenum - self.burst.rises[-1]

    def finish(self, burst, is_last=False):
        """Shows a burst that ends here, unless that has been done."""
        if not burst.is_shown:
            burst.is_shown = True
            burst.end = self.samplenum
            self.show(burst, is_last)

    def rest(self, burst):
        """CLOCK HIGH for so long ends a frame."""
        high = burst.high()
        if self.options["idle_us"]:
            return self.samples(self.options["idle_us"])
        if high is None:
            return self.samples(LONGEST_US)
        factor = REST_HIGHS if burst.knows_high() else FIRST_REST_HIGHS
        return max(self.samples(REST_US), round(factor * high) + 1)

    def record(self):
        """Pulses until CLOCK rests; ends at the next falling edge and returns DATA there."""
        while True:
            pins = self.wait([{0: "r"}, {1: "e"}])
            burst = self.burst
            if self.matched[1]:
                burst.change(self.samplenum, pins[1])
            if not self.matched[0]:
                continue
            if len(burst.rises) < MOST_PULSES:
                burst.rise(self.samplenum, pins[1])
            else:
                burst.more += 1
            data = self.high(burst)
            if data is not None:
                return data

    def high(self, burst):
        """From a rising edge to the falling one; if CLOCK has rested, DATA there. DATA is recorded for a while after the frame, too."""
        begin = self.samplenum
        rest = self.rest(burst)
        watched = begin + max(self.samples(LONGEST_US), round(self.delay) + 2 * rest)
        while True:
            conditions = [{0: "f"}, {1: "e"}]
            if not burst.is_shown:
                conditions.append({"skip": max(1, watched - self.samplenum)})
            pins = self.wait(conditions)
            if self.matched[1] and not burst.is_shown:
                burst.change(self.samplenum, pins[1])
            if self.matched[0]:
                break
            if self.samplenum >= watched:
                self.finish(burst)
        if self.samplenum - begin >= rest:
            self.finish(burst)
            return pins[1]
        if burst.more == 0:
            burst.fall(self.samplenum)
            self.split(burst)
        return None

    def split(self, burst):
        """A rest that only the HIGH time of the next frame shows to be one: of a faster CLOCK, or after a single pulse."""
        if self.options["idle_us"] or len(burst.rises) < 2:
            return
        rested, high = burst.high_before(1), burst.high_before(0)
        if rested >= self.samples(REST_US) and rested >= SPLIT_HIGHS * high:
            self.burst = burst.tail()
            burst.is_shown = True
            self.show(burst)

    # What a burst says

    def show(self, burst, is_last=False):
        self.shown = burst
        was_first, self.is_first = self.is_first, False
        if was_first and not self.begins(burst):
            self.skipped(0, "Capture begins within a frame: ")
            return
        # Reasons against the position.
        self.against = []
        if self.is_cut and burst.rested < self.samples(LONGEST_US):
            self.against.append("soon after a frame that was cut")
        self.is_cut = not self.frame()
        if is_last and self.is_cut and burst.rises:
            self.warn(burst.rises[-1], burst.end, "Capture ends here")

    def begins(self, burst):
        """Whether the capture's first pulses are a frame's first."""
        highs = [fall - rise for fall, rise in zip(burst.falls[1:], burst.rises)]
        if not highs:
            return True
        return burst.rested >= self.rest(burst) or burst.rested >= FIRST_HIGHS * max(highs)

    def skipped(self, after, text=""):
        """Pulses after this rising edge are not decoded."""
        burst = self.shown
        count = burst.count() - after
        if count > 0:
            begin = burst.rises[after] if after < len(burst.rises) else burst.end
            pulses = "clock pulse" if count == 1 else "clock pulses"
            self.warn(begin, burst.rises[-1], "{}{} {} skipped".format(text, count, pulses))

    def too_short(self, hint=""):
        burst = self.shown
        last = burst.rises[-1] if burst.rises else burst.end
        rest = burst.end - last
        if rest < self.samples(LONGEST_US) and not hint:
            hint = "CLOCK HIGH for {:.1f} us, option idle_us?".format(rest * 1e6 / self.samplerate)
        self.warn(burst.falls[0], last, "Frame too short" + (": " if hint else "") + hint)
        return False

    def sent(self, edges):
        """Bits of the receiver at these rising edges, and their samples."""
        rises = self.shown.rises
        after = edges.stop - 1
        end = rises[after] if after < len(rises) else rises[after - 1]
        return number(self.shown.sent[edges.start - 1 : after]), rises[edges.start - 1], end

    def frame(self):
        """Whether the burst is a whole frame, or ends as one."""
        count = len(self.shown.rises)
        edges = COMMAND_EDGES.stop - 1
        if count < edges:
            return self.too_short()
        command, begin, end = self.sent(COMMAND_EDGES)
        code = "{:06b}".format(command)
        if command not in MODES:
            self.put_text(begin, end, WARNING, ["Unknown mode command " + code, code])
            self.skipped(edges)
            return False
        name, has_parameter = MODES[command]
        self.put_text(begin, end, MODE, ["{} {}".format(code, name), code])
        if has_parameter:
            edges = PARAMETER_EDGES.stop - 1
            if count < edges:
                return self.too_short()
            value, begin, end = self.sent(PARAMETER_EDGES)
            self.put_text(begin, end, PARAMETER, ["0x{:02X} 0x{:04X}".format(value >> 16, value & 0xFFFF)])
        first = edges + TURNAROUND
        if count < first:
            return self.too_short()
        return self.answer(command, first)

    def answer(self, command, first):
        burst = self.shown
        width = TEST_VALUE_BITS if command == TEST_VALUES else self.options["bits"]
        flags = 2 if command in ENDAT22 else 1
        length = flags + width if command in POSITIONS else INFO_BITS
        # Before a supplement CLOCK is parked LOW; otherwise another pulse takes the cell after the answer.
        self.parked = burst.parked(first) if command in SUPPLEMENTS else None
        count = self.parked or len(burst.rises)
        self.cells = Cells(burst, first, count, self.delay, 1 + length + CRC_BITS)
        start = self.cells.find_start()
        if start is None:
            if count < first + length + CRC_BITS:
                return self.too_short()
            self.warn(burst.rises[first - 1], burst.rises[-1], "No start bit")
            return False
        last = start + length + CRC_BITS
        if not self.is_whole(start + 1, length, self.hint(start, length)):
            return False
        self.put_text(*self.cells.span(start, start), START, ["Start", "S"])
        if command not in POSITIONS:
            self.block(start)
            self.skipped(last + 1)
            return True
        return self.position(command, start, flags, width, last)

    def is_whole(self, first, length, hint=""):
        """Whether the clock pulses take so many bits, which begin with this cell, and their CRC."""
        cells = self.cells
        last = first + length + CRC_BITS - 1
        needed = last + (0 if self.parked else 1)
        missing = max(0, needed - cells.count)
        late = cells.late_by()
        is_right = missing and cells.is_seen(last) and self.is_right(first, length)
        if is_right and (cells.count == last or cells.goes_on_until(last + 1)):
            late = max(late, missing)
        if late:
            text = "DATA changes {0} ns after CLOCK, later than a period: set delay_ns={0}".format(self.ns(late))
            self.warn(*cells.span(first, min(last, cells.count)), text)
            self.against.append("DATA is late")
            return not missing
        if is_right:
            return self.too_short("CRC fits with delay_ns={}".format(self.ns(missing)))
        return not missing or self.too_short(hint)

    def ns(self, periods):
        """The delay of DATA if it is so many periods later."""
        cells = self.cells
        return round((cells.delay + (cells.offset + periods) * cells.period) * 1e9 / self.samplerate)

    def bits(self, first, count):
        return [self.cells.sample(edge) for edge in range(first, first + count)]

    def is_right(self, first, length):
        """Whether the CRC after so many bits fits them."""
        return crc5(self.bits(first, length)) == number(self.bits(first + length, CRC_BITS))

    def hint(self, start, length):
        """The number of position bits that the clock pulses of a frame without additional data are for, if the CRC fits it."""
        over = start + length + CRC_BITS + (0 if self.parked else 1) - self.cells.count
        bits = self.options["bits"] - over
        if over and bits > 0 and self.is_right(start + 1, length - over):
            return "CRC fits with bits={}".format(bits)
        return ""

    def position(self, command, start, flags, width, last):
        cells, burst = self.cells, self.shown
        errors = self.bits(start + 1, flags)
        bits = self.bits(start + 1 + flags, width)
        value = sum(bit << i for i, bit in enumerate(bits))
        if not cells.is_open():
            self.warn(*cells.span(start, last), "DATA changes anywhere in the period of CLOCK")
            self.against.append("DATA is not steady")
        texts = ["F1={}".format(errors[0])] + ["F2={}".format(bit) for bit in errors[1:]]
        self.put_text(*cells.span(start + 1, start + flags), ERROR, [" ".join(texts)])
        if not self.check(start + 1, flags + width):
            self.against.append("CRC wrong")
            hint = self.hint(start, flags + width)
            if hint:
                self.warn(*cells.span(start, last), hint)
        else:
            # F2 is LOW in an alarm.
            self.against += ["F{}".format(i + 1) for i, bit in enumerate(errors) if bit != i]
        is_whole = True
        # Additional data, if a LOW cell follows: after the last block DATA is HIGH.
        while last < cells.count and not cells.sample(last + 1):
            last += 1
            if last == cells.count:
                # The receiver takes no additional data.
                break
            is_good = not self.against
            is_whole = self.is_whole(last + 1, INFO_BITS)
            if not is_whole:
                if is_good and not self.against:
                    self.against.append("frame too short")
                break
            self.put_text(*cells.span(last, last), START, ["Start", "S"])
            self.block(last)
            last += BLOCK_BITS
        if is_whole and self.parked:
            is_whole = self.supplement(self.parked)
        elif is_whole:
            self.goes_on(command, last + 1, start)
            self.skipped(last + 1)
        name = "Test values" if command == TEST_VALUES else "Position"
        span = cells.span(start + 1 + flags, start + flags + width)
        if self.against:
            text = "Refused {} (0x{:X}): {}".format(value, value, ", ".join(self.against))
            self.put_text(*span, REFUSED, [text, "Refused"])
        else:
            self.put_text(*span, POSITION, ["{} {} (0x{:X})".format(name, value, value), "{}".format(value)])
        return is_whole

    def goes_on(self, command, tail, start):
        """DATA that is HIGH, LOW and HIGH again where the encoder has nothing to say is part of a wider answer, or of the next one
        in continuous clock mode."""
        cells, count = self.cells, len(self.shown.rises)
        is_continuous = command == 0b000111 and count - tail >= tail - start
        if is_continuous:
            return
        rest = self.bits(tail, max(0, count + 1 - tail))
        if any(not a and b for a, b in zip(rest, rest[1:])):
            self.warn(*cells.span(tail, count), "DATA goes on after the answer, option bits?")
            self.against.append("DATA goes on")

    def supplement(self, last):
        """From the receiver: zeros, a start bit, address and data, each taken at a rising edge."""
        edges = range(last + SUPPLEMENT_EDGES.start, last + SUPPLEMENT_EDGES.stop)
        if len(self.shown.rises) < edges.stop - 1:
            return self.too_short()
        value, begin, end = self.sent(edges)
        self.put_text(begin, end, PARAMETER, ["0x{:02X} 0x{:04X}".format(value >> 16, value & 0xFFFF)])
        self.skipped(last + SUPPLEMENT_PULSES)
        return True

    def block(self, first):
        """24 bits after this cell, most significant first, and their CRC."""
        value = number(self.bits(first + 1, INFO_BITS))
        text = "{:02X} {:04X}".format(value >> 16, value & 0xFFFF)
        is_good = self.check(first + 1, INFO_BITS)
        span = self.cells.span(first + 1, first + INFO_BITS)
        self.put_text(*span, INFO if is_good else REFUSED, [text if is_good else "Refused " + text])

    def check(self, first, count):
        """The CRC after so many bits, annotated; whether it fits them."""
        computed = crc5(self.bits(first, count))
        received = number(self.bits(first + count, CRC_BITS))
        is_good = received == computed
        text = "CRC {:02X}".format(received) + ("" if is_good else ", should be {:02X}".format(computed))
        span = self.cells.span(first + count, first + count + CRC_BITS - 1)
        self.put_text(*span, CRC, [text])
        if not is_good:
            self.warn(*span, "CRC wrong")
        return is_good
