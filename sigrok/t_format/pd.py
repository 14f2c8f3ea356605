# SPDX-License-Identifier: MIT OR Apache-2.0
import sigrokdecode as srd

FIELD_BITS = 10
SYNC = 0b010

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
REQUEST, REPLY, STATUS, POSITIONS, MEMORY, CRC, WARNING = range(7)
NUMBERS = {"ABS": "Single-turn", "ABM": "Multi-turn"}


class Cut(Exception):
    """The line has stayed HIGH where a field should follow."""


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
    )
    annotation_rows = (
        ("fields", "Fields", (REQUEST, REPLY, STATUS, POSITIONS, MEMORY, CRC)),
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
        while True:
            self.wait({0: "f"})
            try:
                self.exchange()
            except Cut:
                self.put_text(self.samplenum - 1, self.samplenum, WARNING, ["Field missing"])

    def samples(self, option):
        return int(self.options[option] * self.samplerate / 1e6)

    def at(self, begin, cells):
        """The line so many cells behind a field's beginning."""
        skip = int(begin + cells * self.cell) - self.samplenum
        return self.wait({"skip": skip})[0] if skip > 0 else self.wait({"skip": 0})[0]

    def field(self):
        """The field whose start bit has just begun; each is timed by its own."""
        begin, value = self.samplenum, 0
        for bit in range(8):
            value |= self.at(begin, bit + 1.5) << bit
        delimiter = self.at(begin, FIELD_BITS - 0.5)
        end = int(begin + FIELD_BITS * self.cell)
        if not delimiter:
            self.put_text(begin, end, WARNING, ["Delimiter is LOW"])
            # The line has to be HIGH before another field can begin.
            self.wait({0: "h"})
        return value, begin, end

    def fields(self, count, pause):
        """So many fields; the first one may begin after this pause, the others after that between fields."""
        found = []
        for _ in range(count):
            pins = self.wait([{0: "f"}, {"skip": max(1, pause + int(self.cell))}])
            if not self.matched[0]:
                raise Cut
            found.append(self.field())
            pause = self.samples("field_gap_us")
        return found

    def exchange(self):
        """From the start bit of a request to the end of its reply."""
        first = self.field()
        control, begin, end = first
        request = REQUESTS.get(control >> 3 & 15)
        if control & 7 != SYNC or bin(control >> 3).count("1") & 1 or request is None:
            self.put_text(begin, end, WARNING, ["No request: CF {:02X}".format(control), "CF"])
            return
        name, sent, expected = request
        self.put_text(begin, end, REQUEST, ["ID {:X} {}".format(control >> 3 & 15, name), name])
        asked = [first] + self.fields(len(sent) - 1, self.samples("field_gap_us"))
        self.show(sent, asked)
        try:
            head = self.fields(1, self.samples("gap_us"))
        except Cut:
            self.put_text(begin, end, WARNING, ["No reply"])
            return
        reply = head + self.fields(len(expected) - 1, self.samples("field_gap_us"))
        (echo, begin, end) = reply[0]
        self.put_text(begin, end, REPLY, ["Reply {:02X}".format(echo), "CF"])
        if echo != control:
            self.put_text(begin, end, WARNING, ["Reply to another request"])
        self.show(expected, reply)

    def show(self, names, fields):
        """The fields behind the control field; neighbours of one name are one number, least significant byte first."""
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
            text = "{} {} (0x{:06X})".format(NUMBERS[name], value, value)
            return self.put_text(begin, end, POSITIONS, [text, "{}".format(value)])
        if name != "CRC":
            row = MEMORY if name in ("ADF", "EDF") else STATUS
            return self.put_text(begin, end, row, ["{} {:02X}".format(name, value)])
        computed = 0
        for field in fields[:-1]:
            computed ^= field[0]
        good = computed == value
        text = "CRC {:02X}".format(value) + ("" if good else ", should be {:02X}".format(computed))
        self.put_text(begin, end, CRC, [text])
        if not good:
            self.put_text(begin, end, WARNING, ["CRC wrong"])
