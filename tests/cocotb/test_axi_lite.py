"""cocotbext-axi's AXI4-Lite master, with pauses on every channel."""

import itertools
import logging

import cocotb
from cocotb.triggers import ClockCycles
from cocotbext.axi import AxiLiteBus, AxiLiteMaster, AxiResp

import card


async def master(dut, pauses):
    card.start(dut)
    logging.getLogger("cocotb").setLevel(logging.WARNING)
    axi = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axi"), dut.clk_i, dut.rst_i)
    if pauses:
        for n, channel in enumerate(
            [
                axi.write_if.aw_channel,
                axi.write_if.w_channel,
                axi.write_if.b_channel,
                axi.read_if.ar_channel,
                axi.read_if.r_channel,
            ]
        ):
            pattern = [1] * (n + 1) + [0] * 2 + [1, 0, 0, 0, 1]
            channel.set_pause_generator(itertools.cycle(pattern))
    await card.release(dut)

    async def read(address):
        result = await axi.read(4 * address, 4)
        assert result.resp == AxiResp.OKAY
        return int.from_bytes(result.data, "little")

    async def write(address, value):
        result = await axi.write(4 * address, value.to_bytes(4, "little"))
        assert result.resp == AxiResp.OKAY

    return axi, read, write


@cocotb.test()
async def registers(dut):
    _, read, write = await master(dut, False)
    await card.check(dut, read, write)


@cocotb.test()
async def registers_with_pauses(dut):
    _, read, write = await master(dut, True)
    await card.check(dut, read, write)


@cocotb.test()
async def many_at_a_time(dut):
    axi, read, _ = await master(dut, True)
    words = [await read(n) for n in range(5)]
    reads = [axi.init_read(4 * (n % 5), 4) for n in range(30)]
    writes = [axi.init_write(4 * 0x108, n.to_bytes(4, "little")) for n in range(30)]
    for n, event in enumerate(reads):
        await event.wait()
        assert int.from_bytes(event.data.data, "little") == words[n % 5]
    for event in writes:
        await event.wait()
        assert event.data.resp == AxiResp.OKAY
    assert await read(0x108) == 29


@cocotb.test()
async def part_of_a_word(dut):
    axi, read, _ = await master(dut, False)
    before = await read(0x108)
    result = await axi.write(4 * 0x108 + 1, b"\x55\x55")
    assert result.resp == AxiResp.SLVERR
    assert await read(0x108) == before
    await ClockCycles(dut.clk_i, 10)


@cocotb.test()
async def trigger(dut):
    _, read, write = await master(dut, False)
    await card.check_trigger(dut, read, write)
