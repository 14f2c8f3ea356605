"""cocotbext-ahb's AHB-Lite master, with transfers one by one and pipelined."""

import cocotb
from cocotbext.ahb import AHBBus, AHBLiteMaster, AHBResp

import card

SIGNALS = {name: name for name in ["haddr", "hsize", "htrans", "hwdata", "hrdata", "hwrite", "hresp"]}


def host_of(dut):
    # Alone on its bus: always selected, and nobody else makes it wait.
    dut.s_ahb_hsel.value = 1
    dut.s_ahb_hready.value = 1
    # Its "hready" is the subordinate's output.
    bus = AHBBus.from_prefix(dut, "s_ahb", signals=SIGNALS | {"hready": "hreadyout"}, optional_signals={})
    return AHBLiteMaster(bus, dut.clk_i, dut.rst_i, timeout=500)


async def master(dut):
    card.start(dut)
    for name in ["hsel", "hready", "htrans", "hwrite", "hsize", "haddr", "hwdata"]:
        getattr(dut, f"s_ahb_{name}").value = 0
    await card.release(dut)
    # The master comes behind the first edge: what it sets "at once" before that, iverilog 11 does not notice.
    host = host_of(dut)

    def good(answer):
        assert answer["resp"] == AHBResp.OKAY, answer
        return int(answer["data"], 16)

    async def read(address):
        return good((await host.read([4 * address], [4]))[0])

    async def write(address, value):
        good((await host.write([4 * address], [value], [4]))[0])

    return host, read, write


@cocotb.test()
async def registers(dut):
    _, read, write = await master(dut)
    await card.check(dut, read, write)


@cocotb.test()
async def trigger(dut):
    _, read, write = await master(dut)
    await card.check_trigger(dut, read, write)


@cocotb.test()
async def pipelined(dut):
    """Each address stands beside the data of the transfer before."""
    host, read, write = await master(dut)
    words = [0x12345678, 0x9ABCDEF0 & ~1, 0x0F1E2D3C]
    places = [4 * card.CONFIG[n] for n in (0, 2, 4)]
    answers = await host.write(places, words, [4] * 3, pip=True)
    assert all(answer["resp"] == AHBResp.OKAY for answer in answers), answers
    answers = await host.read(places, [4] * 3, pip=True)
    assert [int(answer["data"], 16) for answer in answers] == words, answers


@cocotb.test()
async def parts_of_a_word(dut):
    """A part of a word is refused, and changes nothing."""
    host, read, write = await master(dut)
    before = await read(card.CONFIG[0])
    answer = (await host.write([4 * card.CONFIG[0]], [0xFF], [1]))[0]
    assert answer["resp"] == AHBResp.ERROR, answer
    assert await read(card.CONFIG[0]) == before
