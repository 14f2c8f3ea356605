"""The package with simulated cards: in this process, and as a separate program over TCP."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import endat

BITS = 29


@pytest.fixture(scope="module")
def card(service: str) -> Iterator[endat.Card]:
    with endat.connect(service) as card:
        yield card


def test_a_card_says_who_it_is(card: endat.Card) -> None:
    assert card.identity.channels == 2
    assert card.identity.protocols == ("EnDat", "EnDat")
    assert "requests" in card.identity.parts and "outputs" not in card.identity.parts
    plate = card.encoders()[1]
    assert plate is not None and plate.initialised and plate.rotary
    assert plate.steps == 1 << BITS and plate.position_bits == BITS
    assert "EnDat, EnDat" in repr(card)


def test_positions_are_in_units(card: endat.Card) -> None:
    for reading in card.read():
        assert reading.fresh and reading.cause == "none" and reading.unit == "deg"
        assert reading.raw is not None and reading.turns == 0
        assert reading.position == pytest.approx(reading.raw * 360 / 2**BITS)


def test_every_trigger_has_a_row(card: endat.Card) -> None:
    samples = card.samples(345)
    assert len(samples) == 345
    assert (np.diff(samples.trigger.astype(np.int64)) == 1).all() and not samples.missing.any()
    assert samples.time_s[0] == 0 and np.allclose(np.diff(samples.time_s), 4e-4)
    assert (samples.run == -1).all()
    for one in samples.channels:
        assert one.fresh.all() and (one.cause_names() == "none").all()
        assert np.allclose(one.position, one.raw * (360 / 2**BITS))
        # It turns evenly, except for a slow swing.
        steps = np.diff(one.unwrapped())
        assert (steps > 0).all() and steps.max() < 2 * steps.min()
    assert not np.array_equal(samples.channels[0].raw, samples.channels[1].raw)


def test_seconds_are_those_of_the_card(card: endat.Card) -> None:
    samples = card.samples(seconds=0.01)
    assert len(samples) == 26 and samples.time_s[-1] == pytest.approx(0.01)
    assert len(card.samples(7, seconds=1)) == 7


def test_a_stream_comes_in_blocks_and_leaves_the_card_usable(card: endat.Card) -> None:
    with closing(card.stream(block=40)) as blocks:
        # Fewer on a slow machine: a block comes at least twice a second.
        one = next(blocks)
        assert 0 < len(one) <= 40
        # Reading registers meanwhile loses no rows.
        assert card.read_register("config0.frame.position_bits") == BITS
        with pytest.raises(endat.Refused, match="under way"):
            next(card.stream())
        two = next(blocks)
        assert two.trigger[0] == one.trigger[-1] + 1
        assert two.time_s[0] > one.time_s[-1]
        assert card.losses() == (0, 0)
    both = endat.Samples.concatenate([one, two])
    assert len(both) == len(one) + len(two) and both.channels[1].raw[len(one)] == two.channels[1].raw[0]
    assert len(both.head(3)) == 3
    assert both == both and both != both.head(3) and hash(both)
    assert repr(both.head(3)).startswith("<endat.Samples: 3 rows, 0 s to 0.0008 s, 0 triggers missing, 2 channels")
    assert repr(both.channels[0]) == f"<endat.ChannelSamples: {len(both)} rows, {len(both)} fresh, in deg>"
    assert len(card.samples(3)) == 3


def test_results_are_read_one_by_one_on_request(card: endat.Card) -> None:
    samples = card.samples(20, poll=True)
    assert len(samples) == 20 and samples.channels[0].fresh.any()
    assert (np.diff(samples.trigger.astype(np.int64)) >= 1).all()


def test_columns_make_a_table(card: endat.Card) -> None:
    pandas = pytest.importorskip("pandas") if "CI" not in os.environ else __import__("pandas")
    table = pandas.DataFrame(card.samples(5).columns())
    assert list(table["channel1_cause"]) == ["none"] * 5
    assert table["channel0_deg"].between(0, 360).all() and table["channel0_fresh"].all()


def test_parameters_and_mode_commands_reach_the_encoder(card: endat.Card) -> None:
    # Area 0xA7 is the user's.
    before = card.read_parameter(0, 0xA7, 3)
    card.write_parameter(0, 0xA7, 3, before ^ 0x1234)
    assert card.read_parameter(0, 0xA7, 3) == before ^ 0x1234
    assert card.read_parameter(1, 0xA7, 3) != before ^ 0x1234
    assert card.request(0, 0b101010).data == 0
    assert card.samples(3).channels[0].fresh.all()


def test_registers_are_written_by_name_and_within_their_limits(card: endat.Card) -> None:
    name = "card_config.trigger_period.value"
    period = card.read_register(name)
    # While the timer is stopped, as the map requires: a shorter period would start only after its counter has wrapped.
    timer = "card_config.trigger_sources.timer"
    for cycles, seconds in ((period * 2, 8e-4), (period, 4e-4)):
        card.write_register(timer, 0)
        card.write_register(name, cycles)
        card.write_register(timer, 1)
        assert np.allclose(np.diff(card.samples(5).time_s), seconds)
    with pytest.raises(endat.BadInput, match=r"takes 4\.\.16777215"):
        card.write_register(name, 3)
    assert card.read_register(name) == period


BAD: list[tuple[str, str]] = [
    ("card.read_register('result0.statu')", "no register of that name"),
    ("card.write_register('card.id', 1)", "read only"),
    ("card.write_register('card.trigger_now', -1)", "value = -1: outside"),
    ("card.read_parameter(2, 0xA1, 0)", "channel = 2: the card has 2"),
    ("card.read_parameter(0, 256, 0)", "area = 256: outside"),
    ("card.request(0, 64)", "command = 64: outside"),
    ("card.samples()", "neither count nor seconds"),
    ("card.samples(0)", "count = 0"),
    ("card.samples(seconds=float('nan'))", "seconds = nan"),
    ("next(card.stream(0))", "block = 0"),
    ("endat.explain('nothing')", "cause = 'nothing'"),
    ("endat.explain(77)", "cause = 77"),
    ("card.samples(1).head(-1)", "count = -1"),
    ("endat.connect('')", "is empty"),
    ("endat.connect('virtual:nope')", "unknown preset"),
    ("endat.connect('virtual:' + __file__ + '.toml')", "cannot"),
    ("endat.connect('virtual', baud=0)", "baud = 0: outside 300"),
]


@pytest.mark.parametrize(("call", "text"), BAD)
def test_bad_input_is_told_as_such(card: endat.Card, call: str, text: str) -> None:
    with pytest.raises(ValueError, match=re.escape(text)) as error:
        eval(call)
    assert isinstance(error.value, endat.EndatError)
    assert card.read()[0].fresh


def test_what_is_no_card_is_no_card() -> None:
    for port in ("/dev/null/card", "tcp:127.0.0.1:1"):
        with pytest.raises(endat.EndatError, match="cannot be opened"):
            endat.connect(port)


def test_a_closed_card_says_so() -> None:
    with endat.connect("virtual") as card:
        with pytest.raises(endat.Refused, match="no part `requests`"):
            card.request(0, 0b101010)
        blocks = card.stream()
        next(blocks)
    with pytest.raises(endat.Refused, match="closed"):
        card.read()
    with pytest.raises(endat.Refused, match="closed"):
        next(blocks)
    card.close()


def test_a_card_that_nothing_triggers_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    with endat.connect("virtual") as card:
        card.write_register("card_config.trigger_sources", 0)
        with pytest.raises(endat.Refused, match="no trigger is enabled"):
            endat.record(card, tmp_path / "none.h5", 10)
        card.write_register("card_config.trigger_sources.timer", 1)
        assert endat.record(card, tmp_path / "none.h5", 10) == 10


def test_t_format_has_counts() -> None:
    with endat.connect("virtual:mixed_protocols") as card:
        at = card.identity.protocols.index("T-format")
        one = card.samples(5).channels[at]
        assert one.unit == "counts" and one.wraps_at is None
        with pytest.raises(endat.BadInput, match=r'give connect\(\) ranges=\{1: "SINGLE\+MULTI"\}'):
            one.unwrapped()
        assert np.array_equal(one.turns, one.raw >> np.uint64(24)) and one.fresh.all()
        assert card.encoders()[at] is None


def test_t_format_turns_are_counted_on_with_the_bits_of_a_turn() -> None:
    """17 of the 24 bits of angle are used: the raw position jumps at each turn, the unwrapped one does not."""
    with endat.connect("virtual:mixed_protocols", ranges={1: "17+16"}) as card:
        one = card.samples(50).channels[1]
        assert (one.unit, one.wraps_at, one.turns_counted, one.unknown) == ("deg", 360, 65536, None)
    raw = np.array([100 << 24 | 130_285, 101 << 24, 100 << 24 | 130_285], dtype=np.uint64)
    turns, steps = raw >> np.uint64(24), raw & np.uint64(0x1FFFF)
    crossing = replace(one, raw=raw, turns=turns, position=steps * 360 / (1 << 17), fresh=np.ones(3, dtype=np.bool_))
    np.testing.assert_allclose(np.diff(crossing.unwrapped()) * (1 << 17) / 360, [787, -787], atol=1e-6)
    with pytest.raises(endat.BadInput, match="range = 5: the card has no such channel"):
        endat.connect("virtual:mixed_protocols", ranges={5: "17+16"})


def test_additional_data_come_with_their_positions(tmp_path: Path, service_file: Path) -> None:
    text = service_file.read_text().replace("[stream]", "[stream]\nadditional_data = true")
    text = text.replace("sample_hz = 2_500", "sample_hz = 1_500")
    assert "additional_data = true" in text
    config = tmp_path / "card.toml"
    config.write_text(text)
    with endat.connect(f"virtual:{config}") as card:
        card.write_register("service0.list_0.mrs", 0x4C)
        card.write_register("service0.list_length.length", 1)
        one = card.samples(200).channels[0].additional[0]
        assert one.good.any() and (one.status[~one.good] == 0).all()
        assert set(one.status[one.good] & 0x1F) == {0x0C}


def channel(
    position: list[float], fresh: list[bool], turns: list[int], wraps_at: float | None, turns_counted: int | None = 1
) -> endat.ChannelSamples:
    count = len(position)
    return endat.ChannelSamples(
        unit="deg",
        position=np.array(position),
        turns=np.array(turns, dtype=np.uint64),
        raw=np.zeros(count, dtype=np.uint64),
        valid=np.ones(count, dtype=np.bool_),
        fresh=np.array(fresh),
        cause=np.zeros(count, dtype=np.uint8),
        wraps_at=wraps_at,
        turns_counted=turns_counted,
        unknown=None,
        additional=(),
    )


def test_unwrapping_counts_turns_and_skips_what_is_held() -> None:
    single = channel([350, 355, 355, 2, 358], [True, True, False, True, True], [0] * 5, 360)
    np.testing.assert_array_equal(single.unwrapped(), [350, 355, np.nan, 362, 358])
    multi = channel([350, 10, 10], [True] * 3, [4, 5, 9], 360, 4096)
    np.testing.assert_array_equal(multi.unwrapped(), [1790, 1810, 3250])
    # Over the last of all counted turns, and back.
    ends = channel([350, 10, 350], [True] * 3, [4095, 0, 4095], 360, 4096)
    np.testing.assert_array_equal(np.diff(ends.unwrapped()), [20, -20])
    linear = channel([1.5, 900, 3], [True] * 3, [0] * 3, None)
    np.testing.assert_array_equal(linear.unwrapped(), [1.5, 900, 3])
    nothing = replace(single, fresh=np.zeros(5, dtype=np.bool_))
    assert np.isnan(nothing.unwrapped()).all()


def test_causes_have_names_and_advice() -> None:
    assert endat.CAUSES[0] == "none" and "crc" in endat.CAUSES.values()
    code = next(code for code, name in endat.CAUSES.items() if name == "crc")
    assert endat.explain(code) == endat.explain("crc")
    assert "CRC" in endat.explain("crc") and "pauses for 30 ms" in endat.explain("not_taken")
    for name in set(endat.CAUSES.values()) - {"none", "unknown"}:
        assert endat.explain(name)
    one = replace(channel([1], [True], [0], None), cause=np.array([77], dtype=np.uint8))
    assert one.cause_names()[0] == "unknown"


def test_a_recording_says_what_was_measured(card: endat.Card, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    path = tmp_path / "run.h5"
    assert endat.record(card, path, 300) == 300
    with pytest.raises(endat.BadInput, match="is there already"):
        endat.record(card, path, 10)
    with h5py.File(path) as file:
        assert file["time"].attrs["units"] == "s" and len(file["time"]) == 300
        assert np.allclose(np.diff(file["time"]), 4e-4)
        assert file.attrs["system_hz"] == card.identity.system_hz
        assert file.attrs["configuration_hash"] == f"{card.identity.configuration_hash:08x}"
        one = file["channel0"]
        plate = card.encoders()[0]
        assert plate is not None
        assert one["position"].attrs["units"] == "deg" and one.attrs["serial"] == plate.serial
        assert (one.attrs["steps_per_turn"], one.attrs["turns"], one.attrs["linear"]) == (1 << 29, 1, False)
        assert np.allclose(one["position"], one["raw"][:] * (360 / 2**BITS))
        names = h5py.check_enum_dtype(one["cause"].dtype)
        assert names["none"] == 0 and names["crc"] == next(c for c, n in endat.CAUSES.items() if n == "crc")
    assert endat.record(card, path, seconds=0.02, replace=True, compression="gzip") == 51
    with h5py.File(path) as file:
        assert file["time"][-1] == pytest.approx(0.02)


@pytest.mark.parametrize(("chunk", "latest_s"), [(300, 1e9), (300, 0), (700, 0)])
def test_rows_are_written_once_however_blocks_and_chunks_meet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chunk: int, latest_s: float
) -> None:
    """Catches rows that are lost or written twice if a block crosses the end of a chunk, or is written because of its age."""
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    monkeypatch.setattr("endat.recording.CHUNK", chunk)
    monkeypatch.setattr("endat.recording.LATEST_S", latest_s)
    path = tmp_path / "run.h5"
    with endat.connect("load") as card:
        assert endat.record(card, path, 2150) == 2150
    with h5py.File(path) as file:
        assert np.array_equal(file["trigger"], np.arange(2150) + file["trigger"][0])
        assert np.array_equal(file["channel1/position"], file["channel1/raw"][:] * 360 / 2**BITS) and np.all(file["channel1/fresh"])


#: Rows of an hour at 10 kHz.
HOUR = 36_000_000
HOUR_OF_ROWS = """
import resource, sys, threading, time, endat
seen = []
def look():
    while True:
        seen.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
        time.sleep(0.2)
with endat.connect("load") as card:
    endat.record(card, sys.argv[1], 20_000)
    threading.Thread(target=look, daemon=True).start()
    begin = time.process_time()
    endat.record(card, sys.argv[1], int(sys.argv[2]), replace=True)
print(seen[0], resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time() - begin)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is reported in kB there")
@pytest.mark.parametrize("rows", [300_000, pytest.param(HOUR, marks=pytest.mark.slow)])
def test_an_hour_is_below_300_megabytes_and_whole(tmp_path: Path, rows: int) -> None:
    """Catches a file larger than documented, a lost row, and rows kept in memory."""
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    path = tmp_path / "hour.h5"
    told = subprocess.run([sys.executable, "-c", HOUR_OF_ROWS, str(path), str(rows)], capture_output=True, text=True, check=True)
    before, peak, seconds = told.stdout.split()
    megabytes = path.stat().st_size * HOUR / rows / 1e6
    print(f"{rows} rows: {before} kB before, {peak} kB at most, {seconds} s of CPU, {megabytes:.0f} MB an hour")
    # For any number of rows.
    assert int(peak) - int(before) < 25_000, f"{before} kB, then {peak} kB"
    assert megabytes < 300, f"{megabytes:.0f} MB"
    with h5py.File(path) as file:
        assert len(file["time"]) == rows and not np.any(file["missing"])
        assert np.all(np.diff(file["trigger"]) == 1)
        one = file["channel1"]
        assert np.all(one["fresh"]) and np.array_equal(one["position"], one["raw"][:] * 360 / 2**BITS)
    without = tmp_path / "without.h5"
    with endat.connect("load") as card:
        endat.record(card, without, 1000, raw=False)
    with h5py.File(without) as file:
        one = file["channel1"]
        # The positions contain each step of the encoder.
        steps = one["position"][:] * (2**BITS / 360)
        assert "raw" not in one and np.all(steps == np.round(steps)) and np.any(steps)


@contextmanager
def started(command: list[str]) -> Iterator[subprocess.Popen[str]]:
    """A program that obeys Ctrl-C and ends with the test, also with one that fails."""

    def obey_ctrl_c() -> None:
        # A shell starts a command in the background, such as a whole suite, with SIGINT ignored, and that is inherited.
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=obey_ctrl_c) as program:
        try:
            yield program
        finally:
            program.kill()


KILLED = """
import sys, endat
with endat.connect("load") as card:
    endat.record(card, sys.argv[1])
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL is sent as POSIX does")
def test_a_recording_that_is_killed_is_whole(tmp_path: Path) -> None:
    """Catches rows that were not written, and columns that end at different rows."""
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    path = tmp_path / "killed.h5"
    with started([sys.executable, "-c", KILLED, str(path)]) as program:
        while program.poll() is None and not (path.exists() and path.stat().st_size > 2_000_000):
            time.sleep(0.05)
    with h5py.File(path) as file:
        rows = len(file["time"])
        assert rows > 100_000 and len(file["channel1/cause"]) == rows
        assert np.all(np.diff(file["trigger"]) == 1) and np.all(file["channel1/fresh"])


def test_a_disk_that_becomes_full_ends_a_recording_with_a_whole_file(
    card: endat.Card, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    path = tmp_path / "full.h5"
    left = iter([10**9, 10**9, 10**6])
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": next(left)}))
    with pytest.raises(endat.EndatError, match="1000000 bytes are left on the disk") as error:
        endat.record(card, path)
    told = re.search(r"after (\d+) rows", str(error.value))
    assert told is not None
    with h5py.File(path) as file:
        assert len(file["time"][:]) == len(file["channel1/cause"][:]) == int(told[1]) > 0


def test_calls_of_several_threads_take_turns(card: endat.Card) -> None:
    wrong: list[BaseException] = []

    def read() -> None:
        try:
            for _ in range(20):
                assert card.read_register("config1.frame.position_bits") == BITS
                assert all(r.fresh for r in card.read())
        except BaseException as error:
            wrong.append(error)

    threads = [threading.Thread(target=read) for _ in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert not wrong


@pytest.fixture
def served(service_file: Path) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """A card in a separate process, with its own time. Slow, so that this machine keeps up."""
    program = subprocess.Popen(
        [os.environ["ENDAT"], "card", "--config", str(service_file), "--tcp", "127.0.0.1:0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert program.stdout is not None
    for line in program.stdout:
        found = re.search(r"tcp:[0-9.]+:\d+", line)
        if found:
            break
    else:
        raise AssertionError("the card has not printed its port")
    threading.Thread(target=program.stdout.read, daemon=True).start()
    yield found[0], program
    program.kill()
    program.wait()


def test_a_program_that_is_busy_loses_nothing(served: tuple[str, subprocess.Popen[str]]) -> None:
    with endat.connect(served[0]) as card, closing(card.stream(block=50)) as blocks:
        first = next(blocks)
        # Longer than the card's buffers last.
        time.sleep(3)
        rest = [next(blocks) for _ in range(10)]
        samples = endat.Samples.concatenate([first, *rest])
        assert not samples.missing.any()
        assert (np.diff(samples.trigger.astype(np.int64)) == 1).all()


@pytest.mark.slow
def test_a_card_that_dies_ends_the_stream(served: tuple[str, subprocess.Popen[str]]) -> None:
    begin = time.monotonic()
    with endat.connect(served[0]) as card:
        with pytest.raises(TimeoutError, match="no sample for 20 s"), closing(card.stream(block=20)) as blocks:
            next(blocks)
            served[1].kill()
            for _ in blocks:
                pass
    assert time.monotonic() - begin < 150


INTERRUPTED = """
import sys, endat
with endat.connect(sys.argv[2]) as card:
    print("ready", flush=True)
    print(endat.record(card, sys.argv[1]), flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGINT is sent as POSIX does")
def test_ctrl_c_ends_a_recording_with_a_whole_file(tmp_path: Path, service: str) -> None:
    h5py = pytest.importorskip("h5py") if "CI" not in os.environ else __import__("h5py")
    path = tmp_path / "night.h5"
    with started([sys.executable, "-c", INTERRUPTED, str(path), service]) as program:
        assert program.stdout is not None and program.stdout.readline() == "ready\n"
        while program.poll() is None and not path.exists():
            time.sleep(0.1)
        time.sleep(2)
        program.send_signal(signal.SIGINT)
        told, _ = program.communicate(timeout=90)
    assert program.returncode == 0
    with h5py.File(path) as file:
        assert len(file["time"]) == len(file["channel1/raw"]) == int(told) > 0
