# SPDX-License-Identifier: MIT OR Apache-2.0
import sigrokdecode as srd

FIELD_BITS = 10
# A header is a start bit and a sync bit LOW, one HIGH and one LOW; LOW for less or for longer is none.
HEADER_LOW = (1.5, 2.5)
# Bits of SF: the encoder has seen a parity or a delimiter error in the request.
REQUEST_ERRORS = 0xC0

POSITION = ("CF", "SF", "ABS", "ABS", "ABS", "CRC")
# What each ID sends and what it is answered, and what it is for.
REQUESTS = {
    0x0: ("single-turn position", ("CF",), POSITION),
    0x1: ("multi-turn position", ("CF",), ("CF", "SF", "ABM", "ABM", "ABM", "CRC")),
    0x2: ("kind of encoder", ("CF",), ("CF", "SF", "ENID", "CRC")),
    0x3: ("everything", ("CF",), ("CF", "SF", "ABS", "ABS", "ABS", "ENID", "ABM", "ABM", "ABM", "ALMC", "CRC")),
    0x6: ("write EEPROM", ("CF", "ADF", "EDF", "CRC"), ("CF", "ADF", "EDF", "CRC")),
    0x7: ("reset errors", ("CF",), POSITION),
    0x8: ("reset single-turn", ("CF",), POSITION),
    0xC: ("reset multi-turn", ("CF",), POSITION),
    0xD: ("read EEPROM", ("CF", "ADF", "CRC"), ("CF", "ADF", "EDF", "CRC")),
}
REQUEST, REPLY, STATUS, POSITIONS, MEMORY, CRC, WARNING, REFUSED = range(8)
NUMBERS = {"ABS": "Single-turn", "ABM": "Multi-turn"}


def checksum(values):
    """x^8 + 1: all bytes exclusively ored."""
    total = 0
    for value in values:
        total ^= value
    return total


class Cut(Exception):
    """The exchange does not go on; says why."""


class Decoder(srd.Decoder):
    api_version = 3
    id = "t_format"
    name = "T-format"
    longname = "T-format (Tamagawa type)"
    desc = "Asynchronous protocol of absolute position encoders."
    license = "unknown"  # MIT OR Apache-2.0; the list of names knows neither
    inputs = ["logic"]
    outputs = []
    tags = ["Encoding", "Sensor"]
    channels = ({"id": "data", "name": "DATA", "desc": "The line, idles high"},)
    options = (
        {"id": "bitrate", "desc": "Bit rate (bit/s)", "default": 2500000, "values": (2500000, 5000000)},
        {"id": "gap_us", "desc": "Longest pause before a reply (us)", "default": 10},
        {"id": "field_gap_us", "desc": "Longest pause between fields (us)", "default": 2},
    )
    annotations = (
        ("request", "Request"),
        ("reply", "Reply"),
        ("status", "Status"),
        ("position", "Position"),
        ("memory", "EEPROM"),
        ("crc", "CRC"),
        ("warning", "Warning"),
        ("refused", "Refused"),
    )
    annotation_rows = (
        ("fields", "Fields", (REQUEST, REPLY, STATUS, POSITIONS, MEMORY, CRC, REFUSED)),
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
        self.put(begin, end, self.out_ann, [row, texts])

    def decode(self):
        if not self.samplerate:
            raise srd.DecoderError("Cannot decode without samplerate.")
        self.cell = self.samplerate / self.options["bitrate"]
        if self.cell < 4:
            raise srd.DecoderError("Needs four samples in a bit.")
        # Longer HIGH than within an exchange.
        self.quiet = int(FIELD_BITS * self.cell) + self.samples("field_gap_us")
        self.settle("Capture begins within an exchange")
        while True:
            try:
                self.exchange()
            except Cut as cut:
                self.warn(self.samplenum - 1, self.samplenum, str(cut))
                self.settle()

    def samples(self, option):
        return int(self.options[option] * self.samplerate / 1e6)

    def warn(self, begin, end, text):
        self.put_text(int(begin), int(end), WARNING, [text])

    def settle(self, text="Skipped"):
        """Until the line has been HIGH for longer than within an exchange; this text is for what was on it."""
        pins, begin, is_quiet = self.wait({"skip": 0}), self.samplenum, True
        while True:
            if not pins[0]:
                self.wait({0: "h"})
                is_quiet = False
            pins = self.wait([{0: "f"}, {"skip": self.quiet}])
            if not self.matched[0]:
                break
        if not is_quiet:
            self.warn(begin, self.samplenum - self.quiet, text)

    def until(self, time):
        """The line at this sample. Levels that change twice within half a bit are noted."""
        level, time = self.wait({"skip": 0})[0], int(time)
        while self.samplenum < time:
            level = self.wait([{0: "e"}, {"skip": time - self.samplenum}])[0]
            if self.matched[0]:
                if self.samplenum - self.edge < self.cell / 2:
                    self.is_short = True
                    self.warn(self.edge, self.samplenum, "Pulse shorter than half a bit")
                self.edge = self.samplenum
        return level

    def begin(self, limit, text):
        """The falling edge of a field, before this sample; without one it takes as long as it does."""
        conditions = [{0: "f"}]
        if limit is not None:
            conditions.append({"skip": max(1, limit - self.samplenum)})
        self.wait(conditions)
        if not self.matched[0]:
            raise Cut(text)
        self.edge = self.samplenum
        return self.edge

    def header(self, limit=None):
        """A control field. The edge between its two sync bits is its mark and times it; shorter LOW pulses are passed over."""
        while True:
            fell = self.begin(limit, "")
            self.wait({0: "r"})
            low = (self.samplenum - fell) / self.cell
            if low >= HEADER_LOW[0]:
                break
            self.warn(fell, self.samplenum, "LOW for {:.0f} ns".format(low * self.cell * 1e9 / self.samplerate))
        if low >= HEADER_LOW[1]:
            self.warn(fell, self.samplenum, "LOW for {:.1f} bits".format(low))
            raise Cut("No header")
        self.edge, self.is_short = self.samplenum, False
        begin = self.samplenum - 2 * self.cell
        if not self.until(begin + 2.5 * self.cell) or self.until(begin + 3.5 * self.cell):
            raise Cut("No header")
        return self.field(begin, 0b10, 3)

    def field(self, begin, value=0, bit=0):
        """The field that began there; each is timed by its own."""
        while bit < 8:
            value |= self.until(begin + (bit + 1.5) * self.cell) << bit
            bit += 1
        end = int(begin + FIELD_BITS * self.cell)
        if not self.until(begin + (FIELD_BITS - 0.5) * self.cell):
            raise Cut("Delimiter is LOW")
        return value, int(begin), end

    def fields(self, count):
        """So many fields after a control field."""
        found = []
        for _ in range(count):
            limit = self.samplenum + self.samples("field_gap_us") + int(self.cell)
            while True:
                begin = self.begin(limit, "Field missing")
                if not self.until(begin + 0.5 * self.cell):
                    break
            found.append(self.field(begin))
        return found

    def exchange(self):
        """From the start bit of a request to the end of its reply."""
        self.against = []
        first = self.header(None)
        control, begin, end = first
        request = REQUESTS.get(control >> 3 & 15)
        if bin(control >> 3).count("1") & 1 or request is None:
            raise Cut("No request: CF {:02X}".format(control))
        name, sent, expected = request
        self.put_text(begin, end, REQUEST, ["ID {:X} {}".format(control >> 3 & 15, name), name])
        asked = [first] + self.fields(len(sent) - 1)
        self.show(sent, asked)
        self.against = []
        try:
            head = self.header(self.samplenum + self.samples("gap_us") + int(self.cell))
        except Cut as cut:
            self.warn(begin, end, "No reply")
            if str(cut):
                raise
            # The line is quiet.
            return
        reply = [head] + self.fields(len(expected) - 1)
        (echo, begin, end) = head
        self.put_text(begin, end, REPLY, ["Reply {:02X}".format(echo), "CF"])
        if echo != control:
            self.warn(begin, end, "Reply to another request")
            self.against.append("reply to another request")
        if self.is_short:
            self.against.append("short pulse")
        self.judge(expected, [field[0] for field in reply])
        self.show(expected, reply)
        if echo != control:
            self.settle()

    def judge(self, names, values):
        """Reasons against the positions of a reply, by its bytes."""
        if checksum(values[:-1]) != values[-1]:
            self.against.append("CRC wrong")
        if names[1] == "SF" and values[1] & REQUEST_ERRORS:
            self.against.append("encoder saw a wrong request")

    def show(self, names, fields):
        """The fields after the control field; neighbours of one name are one number, least significant byte first."""
        place = 1
        while place < len(names):
            name, count = names[place], 1
            while place + count < len(names) and names[place + count] == name:
                count += 1
            part = fields[place : place + count]
            value = sum(f[0] << 8 * i for i, f in enumerate(part))
            self.one(name, value, part[0][1], part[-1][2], fields)
            place += count

    def one(self, name, value, begin, end, fields):
        if name in NUMBERS:
            text = "{} (0x{:06X})".format(value, value)
            if self.against:
                return self.put_text(begin, end, REFUSED, ["Refused {}: {}".format(text, ", ".join(self.against)), "Refused"])
            return self.put_text(begin, end, POSITIONS, ["{} {}".format(NUMBERS[name], text), "{}".format(value)])
        if name != "CRC":
            row = MEMORY if name in ("ADF", "EDF") else STATUS
            return self.put_text(begin, end, row, ["{} {:02X}".format(name, value)])
        computed = checksum(field[0] for field in fields[:-1])
        good = computed == value
        text = "CRC {:02X}".format(value) + ("" if good else ", should be {:02X}".format(computed))
        self.put_text(begin, end, CRC, [text])
        if not good:
            self.warn(begin, end, "CRC wrong")
