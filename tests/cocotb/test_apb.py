"""cocotbext-apb's host."""

import cocotb
from cocotbext.apb import Apb4Bus, ApbMaster

import card


async def master(dut):
    card.start(dut)
    bus = Apb4Bus.from_prefix(dut, "s_apb")
    host = ApbMaster(bus, dut.clk_i)
    await card.release(dut)

    async def read(address):
        return int.from_bytes(await host.read(4 * address), "little")

    async def write(address, value):
        await host.write(4 * address, value.to_bytes(4, "little"))

    return read, write


@cocotb.test()
async def registers(dut):
    await card.check(dut, *await master(dut))


@cocotb.test()
async def trigger(dut):
    await card.check_trigger(dut, *await master(dut))
