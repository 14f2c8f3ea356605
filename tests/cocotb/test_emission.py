"""An emission at rest, and its identification over its own bus. Settings come from the environment."""

import os
import re

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles

BUS = os.environ["BUS"]
IDENTIFICATION = int.from_bytes(b"EnDt", "big")
INPUTS, OUTPUTS = (os.environ[name].split(",") for name in ("INPUTS", "OUTPUTS"))
# Inputs that rest HIGH; all others rest LOW.
RESTS_HIGH = re.compile("((endat_|encoder_)?data.*|(bus|spi)_(cs|rd|wr)_n|uart_rx)_i$")
CLOCK = "clk_i" if "clk_i" in INPUTS else "clock"


async def start(dut):
    # Before the clock: what is deposited on a floating input later does not get inside in iverilog.
    for name in INPUTS:
        getattr(dut, name).value = 1 if RESTS_HIGH.match(name) else 0
    Clock(getattr(dut, CLOCK), 10, "ns").start()
    await ClockCycles(getattr(dut, CLOCK), 300)


@cocotb.test()
async def rests(dut):
    """Every output is 0 or 1; clocks rest HIGH; nobody drives the encoder's line."""
    await start(dut)
    for _ in range(50):
        for name in OUTPUTS:
            value = getattr(dut, name).value
            assert value.is_resolvable, f"{name} = {value}"
            if name.startswith("endat_clk"):
                assert value == 1, name
            if re.match("(endat_|encoder_)?data.*_oe", name):
                assert value == 0, name
        await ClockCycles(getattr(dut, CLOCK), 3)


async def uart(dut):
    """UARTBone, one bit in a whole number of cycles."""
    bit = int(os.environ["UART_BIT_CYCLES"])

    async def send(byte):
        for level in [0, *(byte >> n & 1 for n in range(8)), 1]:
            dut.uart_rx_i.value = level
            await ClockCycles(dut.clk_i, bit)

    async def receive():
        for _ in range(100 * bit):
            await ClockCycles(dut.clk_i, 1)
            if dut.uart_tx_o.value == 0:
                break
        await ClockCycles(dut.clk_i, bit // 2)
        byte = 0
        for n in range(8):
            await ClockCycles(dut.clk_i, bit)
            byte |= int(dut.uart_tx_o.value) << n
        await ClockCycles(dut.clk_i, bit)
        assert dut.uart_tx_o.value == 1, "stop bit"
        return byte

    async def read(address):
        for byte in [2, 1, *address.to_bytes(4, "big")]:
            await send(byte)
        first = await receive()
        if os.environ["PUSHES"] == "1":
            # Frames of the stream end with 0; 0xFF in place of one means that the answer follows.
            while first != 0xFF:
                while await receive():
                    pass
                first = await receive()
            first = await receive()
        return int.from_bytes(bytes([first] + [await receive() for _ in range(3)]), "big")

    return read


async def spi(dut):
    async def exchange(byte):
        answer = 0
        for n in reversed(range(8)):
            dut.spi_mosi_i.value = byte >> n & 1
            await ClockCycles(dut.clk_i, 8)
            dut.spi_sck_i.value = 1
            answer = answer << 1 | int(dut.spi_miso_o.value)
            await ClockCycles(dut.clk_i, 8)
            dut.spi_sck_i.value = 0
        return answer

    async def read(address):
        dut.spi_cs_n_i.value = 0
        await ClockCycles(dut.clk_i, 8)
        for byte in [3, *address.to_bytes(2, "big"), 1, 0]:
            await exchange(byte)
        word = [await exchange(0) for _ in range(4)]
        await exchange(0), await exchange(0)
        dut.spi_cs_n_i.value = 1
        await ClockCycles(dut.clk_i, 20)
        return int.from_bytes(bytes(word), "big")

    return read


async def parallel(dut):
    async def write(register, value):
        dut.bus_address_i.value, dut.bus_data_i.value = register, value
        await ClockCycles(dut.clk_i, 2)
        dut.bus_cs_n_i.value, dut.bus_wr_n_i.value = 0, 0
        await ClockCycles(dut.clk_i, 5)
        dut.bus_cs_n_i.value, dut.bus_wr_n_i.value = 1, 1
        await ClockCycles(dut.clk_i, 5)

    async def window(register):
        dut.bus_address_i.value = register
        dut.bus_cs_n_i.value, dut.bus_rd_n_i.value = 0, 0
        await ClockCycles(dut.clk_i, 6)
        value = int(dut.bus_data_o.value)
        dut.bus_cs_n_i.value, dut.bus_rd_n_i.value = 1, 1
        await ClockCycles(dut.clk_i, 5)
        return value

    async def read(address):
        await write(5, address)
        for _ in range(100):
            if not await window(5) >> 15:
                break
        return await window(6) | await window(7) << 16

    return read


async def word_bus(dut):
    """A master of cocotbext: those of the other tests."""
    if BUS == "apb":
        from cocotbext.apb import Apb4Bus, ApbMaster

        host = ApbMaster(Apb4Bus.from_prefix(dut, "s_apb"), dut.clk_i)
    elif BUS == "axi_lite":
        from cocotbext.axi import AxiLiteBus, AxiLiteMaster

        host = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axi"), dut.clk_i, dut.rst_i)
    elif BUS == "ahb_lite":
        from test_ahb_lite import host_of

        host = host_of(dut)

        async def read(address):
            return int((await host.read([4 * address], [4]))[0]["data"], 16)

        return read
    else:
        from cocotbext.wishbone.driver import WBOp, WishboneMaster
        from test_wishbone import SIGNALS

        bus = WishboneMaster(dut, None, dut.clk_i, width=32, timeout=500, signals_dict=SIGNALS)

        async def read(address):
            [result] = await bus.send_cycle([WBOp(address)])
            return int(result.datrd)

        return read

    async def read(address):
        answer = await host.read(4 * address, 4) if BUS == "axi_lite" else await host.read(4 * address)
        return int.from_bytes(getattr(answer, "data", answer), "little")

    return read


MASTERS = {
    "uart": uart,
    "spi": spi,
    "parallel": parallel,
    "apb": word_bus,
    "axi_lite": word_bus,
    "ahb_lite": word_bus,
    "wishbone": word_bus,
}


@cocotb.test(skip=BUS in ("none", "dsp"))
async def identifies(dut):
    """The card says what it is, with its clock and its configuration."""
    await start(dut)
    read = await MASTERS[BUS](dut)
    await ClockCycles(dut.clk_i, 5)
    assert await read(0) == IDENTIFICATION
    assert await read(3) == int(os.environ["SYSTEM_HZ"])
    assert await read(2) & 0xFF == int(os.environ["CHANNELS"])
    assert f"{await read(4):08x}" == os.environ["CONFIGURATION_HASH"][:8]
