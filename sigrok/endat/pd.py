# SPDX-License-Identifier: MIT OR Apache-2.0
import sigrokdecode as srd

# Rising clock edges, counted from 1, that take the mode command; the first start bit can follow at the eleventh.
COMMAND_EDGES = range(3, 9)
PARAMETER_EDGES = range(9, 33)
EARLIEST_START = 11
PARAMETER_BITS = 24
CRC_BITS = 5
INFO_BITS = 24

MODES = {
    0b000111: ("send position", False),
    0b001110: ("selection of memory area", True),
    0b011100: ("receive parameter", True),
    0b100011: ("send parameter", True),
    0b101010: ("receive reset", True),
    0b010101: ("send test values", False),
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
# Rising edges behind the parked CLOCK that take address and data.
SUPPLEMENT_EDGES = range(10, 34)
# CLOCK LOW for so many times a usual LOW is parked.
PARKED = 3
POSITIONS = ENDAT22 + (0b000111,)


def crc5(bits):
    """x^5 + x^3 + x + 1, preset with ones, inverted; first transmitted bit first."""
    register = 0b11111
    for bit in bits:
        feedback = (register >> 4) ^ bit
        register = (register << 1) & 0b11111
        if feedback:
            register ^= 0b01011
    return register ^ 0b11111


class Cut(Exception):
    """CLOCK has stopped HIGH where the frame should go on."""


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
        {"id": "idle_us", "desc": "CLOCK high for so long ends a frame (us)", "default": 6},
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
    )
    annotation_rows = (
        ("fields", "Fields", (0, 1, 2, 3, 4, 5, 6)),
        ("warnings", "Warnings", (7,)),
    )

    def __init__(self):
        self.reset()

    def reset(self):
        self.samplerate = None
        self.low = self.usual = 0

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
        self.idle = max(1, int(self.options["idle_us"] * self.samplerate / 1e6))
        pins = self.wait({0: "f"})
        while True:
            pins = self.frame(pins)

    def falling(self):
        """The next falling edge; CLOCK may not stay HIGH for longer than a frame allows."""
        pins = self.wait([{0: "f"}, {"skip": self.idle}])
        if not self.matched[0]:
            raise Cut
        return pins

    def rising(self):
        return self.wait({0: "r"})

    def bit(self):
        """The bit of the encoder that this rising edge has launched, as DATA stands at the end of its period: at 16 MHz it changes behind
        the falling edge. Ends at the next rising edge, which is much later where CLOCK is parked."""
        begin = self.samplenum
        value = self.falling()[1]
        fell = self.samplenum
        half = max(1, fell - begin)
        while True:
            pins = self.wait([{0: "r"}, {1: "e"}])
            # What changes together with CLOCK is the next bit, and what changes later is none.
            if self.matched[0]:
                break
            if self.samplenum - fell < half:
                value = pins[1]
        self.usual, self.low = self.low, self.samplenum - fell
        return value, begin, self.samplenum

    def bits(self, count):
        return [self.bit() for _ in range(count)]

    def frame(self, _):
        """From the first falling edge on; returns at the first falling edge of the next frame."""
        begin = self.samplenum
        try:
            return self.whole_frame()
        except Cut:
            self.put_text(begin, self.samplenum, 7, ["Frame too short"])
            return self.rest(idle=True)

    def whole_frame(self):
        begin, command, parameter = self.samplenum, 0, 0
        edges, last = 0, PARAMETER_EDGES.stop
        while edges < COMMAND_EDGES.stop - 1 or edges < last:
            pins = self.rising()
            edges += 1
            if edges in COMMAND_EDGES:
                begin = self.samplenum if edges == COMMAND_EDGES.start else begin
                command = command << 1 | pins[1]
            if edges == COMMAND_EDGES.stop - 1:
                name, has_parameter = MODES.get(command, (None, False))
                last = PARAMETER_EDGES.stop - 1 if has_parameter else edges
            if edges in PARAMETER_EDGES:
                parameter = parameter << 1 | pins[1]
                mark = begin if edges > PARAMETER_EDGES.start else self.samplenum
                begin = mark
            if edges == COMMAND_EDGES.stop - 1:
                code = "{:06b}".format(command)
                if name is None:
                    self.put_text(begin, self.samplenum, 7, ["Unknown mode command " + code, code])
                    return self.rest()
                self.put_text(begin, self.samplenum, 0, ["{} {}".format(code, name), code])
            self.falling()
        if has_parameter:
            text = "0x{:02X} 0x{:04X}".format(parameter >> 16, parameter & 0xFFFF)
            self.put_text(begin, self.samplenum, 1, [text])
        return self.answer(command, edges)

    def answer(self, command, edges):
        earliest = EARLIEST_START + (PARAMETER_BITS if edges > EARLIEST_START else 0)
        self.rising()
        edges += 1
        while True:
            try:
                bit = self.bit()
            except Cut:
                self.put_text(self.samplenum - 1, self.samplenum, 7, ["No start bit"])
                return self.rest(idle=True)
            if bit[0] and edges >= earliest:
                break
            edges += 1
        self.put_text(bit[1], bit[2], 2, ["Start", "S"])
        if command not in POSITIONS:
            self.block("{:02X} {:04X}")
            return self.rest()
        flags = self.bits(2 if command in ENDAT22 else 1)
        position = self.bits(self.options["bits"])
        check = self.bits(CRC_BITS)
        texts = ["F1={}".format(flags[0][0])] + ["F2={}".format(f[0]) for f in flags[1:]]
        self.put_text(flags[0][1], flags[-1][2], 3, [" ".join(texts)])
        value = sum(b[0] << i for i, b in enumerate(position))
        self.put_text(position[0][1], position[-1][2], 4, ["Position {} (0x{:X})".format(value, value), "{}".format(value)])
        self.check([b[0] for b in flags + position], check)
        # Additional data, if a LOW cell follows: behind the last block DATA is HIGH. Before a supplement CLOCK is parked LOW.
        while True:
            if command in SUPPLEMENTS and self.low > PARKED * self.usual:
                return self.supplement()
            try:
                first = self.bit()
            except Cut:
                # The frame ends here.
                return self.rest(idle=True)
            if first[0]:
                return self.rest()
            self.put_text(first[1], first[2], 2, ["Start", "S"])
            self.block("{:02X} {:04X}")

    def supplement(self):
        """From the receiver: zeros, a start bit, address and data, each taken at a rising edge; this one is the first."""
        begin, value = self.samplenum, 0
        for edge in range(2, SUPPLEMENT_EDGES.stop):
            self.falling()
            pins = self.rising()
            if edge == SUPPLEMENT_EDGES.start:
                begin = self.samplenum
            if edge in SUPPLEMENT_EDGES:
                value = value << 1 | pins[1]
        self.put_text(begin, self.samplenum, 1, ["0x{:02X} 0x{:04X}".format(value >> 16, value & 0xFFFF)])
        return self.rest()

    def block(self, form):
        """24 bits, most significant first, and their CRC."""
        data = self.bits(INFO_BITS)
        check = self.bits(CRC_BITS)
        value = 0
        for bit in data:
            value = value << 1 | bit[0]
        self.put_text(data[0][1], data[-1][2], 5, [form.format(value >> 16, value & 0xFFFF)])
        self.check([b[0] for b in data], check)

    def check(self, covered, check):
        received = 0
        for bit in check:
            received = received << 1 | bit[0]
        computed = crc5(covered)
        good = received == computed
        text = "CRC {:02X}".format(received) + ("" if good else ", should be {:02X}".format(computed))
        self.put_text(check[0][1], check[-1][2], 6, [text])
        if not good:
            self.put_text(check[0][1], check[-1][2], 7, ["CRC wrong"])

    def rest(self, idle=False):
        """Waits until CLOCK has been HIGH for long, and then for the next frame."""
        while not idle:
            pins = self.wait([{0: "e"}, {"skip": self.idle}])
            idle = not self.matched[0] and pins[0] == 1
        return self.wait({0: "f"})
