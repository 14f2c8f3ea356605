"""A LiteX SoC with a card on its bus, as Verilog: a master in it reads and writes the card through the SoC's decoder, and its report leaves by pins.

Usage: litex_soc.py NAME CLASS CONFIGURATION_HASH, in the folder of the card
"""

import importlib
import os
import sys

from litex.build.generic_platform import Pins, Subsignal
from litex.build.io import CRG
from litex.build.sim import SimPlatform
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import wishbone
from migen import FSM, If, Module, NextState, NextValue, Signal

sys.path.insert(0, os.getcwd())
name, title, configuration_hash = sys.argv[1:]
card = getattr(importlib.import_module(name + "_litex"), title)

PINS = ["endat_clk0_o", "endat_data0_o", "endat_data0_oe", "endat_data0_i", "trigger_i"]
IO = [
    ("sys_clk", 0, Pins(1)),
    ("sys_rst", 0, Pins(1)),
    ("endat", 0, *[Subsignal(pin, Pins(1)) for pin in PINS]),
    ("report", 0, Subsignal("done", Pins(1)), Subsignal("wrong", Pins(1)), Subsignal("irq", Pins(1))),
]
ID = 0x456E4474
# Words of the card: interrupt mask, its strobe of a trigger.
MASK, TRIGGER_NOW = 0x011, 0x009


class Master(Module):
    """Reads two words that it knows, lets every event interrupt, triggers."""

    def __init__(self, base, report):
        self.bus = bus = wishbone.Interface(data_width=32, adr_width=30, addressing="word")
        steps = [
            (0, False, ID),
            (4, False, int(configuration_hash, 16)),
            (MASK, True, 0xFFFFFFFF),
            (TRIGGER_NOW, True, 1),
        ]
        self.submodules.fsm = fsm = FSM(reset_state="STEP0")
        for number, (word, is_write, value) in enumerate(steps):
            fsm.act(
                f"STEP{number}",
                bus.cyc.eq(1), bus.stb.eq(1), bus.sel.eq(0xF), bus.we.eq(is_write),
                bus.adr.eq(base // 4 + word), bus.dat_w.eq(value),
                If(bus.ack | bus.err,
                    If(bus.err | ((bus.dat_r != value) if not is_write else 0), NextValue(report.wrong, 1)),
                    NextState(f"STEP{number}_DONE")),
            )
            following = f"STEP{number + 1}" if number + 1 < len(steps) else "WAIT"
            fsm.act(f"STEP{number}_DONE", NextState(following))
        # The pause after reset takes no trigger.
        wait = Signal(14)
        again = len(steps) - 1
        fsm.act("WAIT", NextValue(report.done, 1), NextValue(wait, wait + 1), If(wait == 2**14 - 1, NextState(f"STEP{again}")))


class SoC(SoCMini):
    def __init__(self, platform):
        SoCMini.__init__(self, platform, clk_freq=card.SYSTEM_HZ, bus_standard="wishbone")
        self.submodules.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
        self.submodules.endat = card(platform, platform.request("endat"))
        self.bus.add_slave("endat", self.endat.bus, SoCRegion(origin=0x40000000, size=card.SIZE_BYTES, cached=False))
        report = platform.request("report")
        self.submodules.master = Master(0x40000000, report)
        self.bus.add_master("master", self.master.bus)
        self.comb += report.irq.eq(self.endat.ev.card.status)


platform = SimPlatform("SIM", IO)
soc = SoC(platform)
soc.finalize()
assert "endat" in soc.csr.locs, soc.csr.locs
platform.get_verilog(soc, name="soc").write("soc.v")
open("sources", "w").write("\n".join(str(source[0]) for source in platform.sources))
