"""cocotbext-wishbone's master."""

import cocotb
from cocotb.triggers import ClockCycles
from cocotbext.wishbone.driver import WBOp, WishboneMaster

import card

SIGNALS = {
    "cyc": "wb_cyc_i",
    "stb": "wb_stb_i",
    "we": "wb_we_i",
    "adr": "wb_adr_i",
    "datwr": "wb_dat_i",
    "datrd": "wb_dat_o",
    "ack": "wb_ack_o",
    "err": "wb_err_o",
    "sel": "wb_sel_i",
}


async def master(dut):
    card.start(dut)
    # The model deposits its first values at once, and what is deposited on a floating input does not get inside in iverilog.
    for name in SIGNALS.values():
        if name.endswith("_i"):
            getattr(dut, name).value = 0
    await ClockCycles(dut.clk_i, 2)
    bus = WishboneMaster(dut, None, dut.clk_i, width=32, timeout=500, signals_dict=SIGNALS)
    await card.release(dut)

    async def read(address):
        [result] = await bus.send_cycle([WBOp(address)])
        assert result.ack == 1
        return int(result.datrd)

    async def write(address, value):
        [result] = await bus.send_cycle([WBOp(address, value)])
        assert result.ack == 1

    return bus, read, write


@cocotb.test()
async def registers(dut):
    _, read, write = await master(dut)
    await card.check(dut, read, write)


@cocotb.test()
async def one_cycle_of_many_transfers(dut):
    bus, _, _ = await master(dut)
    results = await bus.send_cycle([WBOp(n % 5) for n in range(40)])
    words = [int(result.datrd) for result in results]
    assert words == words[:5] * 8 and words[0] == int.from_bytes(b"EnDt", "big")


@cocotb.test()
async def trigger(dut):
    _, read, write = await master(dut)
    await card.check_trigger(dut, read, write)
