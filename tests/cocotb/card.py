"""What is asked of a card behind every bus, whatever master asks."""

import os
import random

from cocotb.clock import Clock
from cocotb.triggers import ClockCycles

ID, TRIGGER_COUNT, TRIGGER_NOW = 0, 8, 9
STATUS = 0x180
CONFIG = [0x100, 0x102, 0x108, 0x109, 0x10A, 0x110]


def start(dut):
    """Clock, reset, and lines that no encoder makes LOW before a frame."""
    Clock(dut.clk_i, 10, "ns").start()
    # A reset is followed by 30 ms of quiet; registers have start values.
    dut.rst_i.value = 0
    dut.trigger_i.value = 0
    dut.endat_data0_i.value = 1
    dut.endat_data1_i.value = 1


async def release(dut):
    await ClockCycles(dut.clk_i, 5)
    dut.rst_i.value = 0
    await ClockCycles(dut.clk_i, 300)


async def check(dut, read, write):
    """`read(word_address)` and `write(word_address, value)` are the master's."""
    assert await read(ID) == int.from_bytes(b"EnDt", "big")
    version, capabilities, system_hz, found = [await read(n) for n in range(1, 5)]
    assert version >> 24 == 1 and capabilities & 0xFF == 2 and system_hz == 100_000_000
    # The word has the first 32 of 48 bits.
    assert f"{found:08x}" == os.environ["CONFIGURATION_HASH"][:8]

    rng = random.Random(1)
    model = {address: await read(address) for address in CONFIG}
    for _ in range(80):
        address = rng.choice(CONFIG)
        if rng.random() < 0.5:
            # Bit 0 of 0x102 would hold the results.
            model[address] = rng.getrandbits(32) & ~(address == 0x102)
            await write(address, model[address])
        else:
            assert await read(address) == model[address], hex(address)
    await write(ID, 0)
    assert await read(ID) == int.from_bytes(b"EnDt", "big")
    assert await read(0x7FF) == 0


async def check_trigger(dut, read, write):
    """A trigger brings a result: without an encoder one with a cause."""
    assert await read(STATUS) == 0 and await read(TRIGGER_COUNT) == 0
    await write(TRIGGER_NOW, 1)
    for _ in range(400):
        status = await read(STATUS)
        if status & 0xFFFF:
            break
        await ClockCycles(dut.clk_i, 50)
    assert status & 0xFFFF == 1, "one result"
    assert status >> 16 & 0x1F != 0 and not status >> 22 & 3, "a cause, and no position"
    assert await read(TRIGGER_COUNT) == 1
