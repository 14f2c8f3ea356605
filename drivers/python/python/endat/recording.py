"""Recordings as HDF5 files, with units and the identity of card and encoders."""

from __future__ import annotations

import os
import shutil
import time
from contextlib import closing
from datetime import datetime, timezone
from typing import Any

import numpy as np

from .card import Card
from .errors import BadInput, EndatError
from .samples import CAUSES, Samples, _each

#: A recording ends while this much space is left on the disk: HDF5 does not survive a full disk, and the file would be lost.
RESERVE_BYTES = 16_000_000
#: Rows that are compressed together: larger chunks compress better, but wait longer in memory (3 s at 10 kHz).
CHUNK = 32_768
#: Rows of a slower card are written after this time, even if their chunk is not full.
LATEST_S = 5.0
#: Names of a channel's arrays in a file, and their unit; None: that of the position.
_OF_CHANNEL: dict[str, str | None] = {"position": None, "turns": "turns", "raw": "", "fresh": "", "cause": ""}


class _File:
    def __init__(self, file: Any, card: Card, compression: str | None, raw: bool) -> None:
        self.file, self.card, self.compression = file, card, compression
        self.of_channel = {name: unit for name, unit in _OF_CHANNEL.items() if raw or name != "raw"}
        #: Rows in the file, rows that wait for a whole chunk, and the time of the last write.
        self.rows = 0
        self.waiting: list[Samples] = []
        self.written = time.monotonic()
        #: Created data sets, by name: looking them up in the file for each block takes as long as writing.
        self.made: dict[str, Any] = {}

    def begin(self, first: Samples) -> None:
        """Names, units and the identity of card and encoders."""
        identity = self.card.identity
        about = self.file.attrs
        about["format"] = "endat recording 1"
        about["start_time"] = datetime.now(timezone.utc).isoformat()
        about["port"] = self.card.port
        about["system_hz"] = identity.system_hz
        about["configuration_hash"] = f"{identity.configuration_hash:08x}"
        about["register_map"] = identity.register_map
        self.new(self.file, "time", first.time_s.dtype, "s", "since the first row, by the card's clock")
        self.new(self.file, "trigger", first.trigger.dtype, "", "number of the trigger, not wrapping")
        self.new(self.file, "missing", first.missing.dtype, "", "triggers without a row just before this one")
        plates = self.card.encoders()
        scales = self.card._native.scales()
        for n, one in enumerate(first.channels):
            group = self.file.create_group(f"channel{n}")
            group.attrs["protocol"] = identity.protocols[n]
            for key in ("steps_per_turn", "turns", "linear"):
                # Positions with an unknown range have neither.
                if scales[n]["unknown"] is None and scales[n][key] is not None:
                    group.attrs[key] = scales[n][key]
            plate = plates[n]
            for name in ("id", "serial", "rotary", "position_bits", "revolutions", "steps"):
                if plate is not None and getattr(plate, name) is not None:
                    group.attrs[name] = getattr(plate, name)
            for name, unit in self.of_channel.items():
                kind = getattr(one, name).dtype
                if name == "cause":
                    kind = _enum(kind)
                self.new(group, name, kind, one.unit if unit is None else unit, "")

    def new(self, group: Any, name: str, kind: Any, unit: str, text: str) -> None:
        made = group.create_dataset(
            name, (0,), kind, maxshape=(None,), chunks=(CHUNK,), compression=self.compression, shuffle=True
        )
        if unit:
            made.attrs["units"] = unit
        if text:
            made.attrs["description"] = text
        self.made[made.name] = made

    def add(self, block: Samples) -> None:
        self.waiting.append(block)
        left = shutil.disk_usage(os.path.dirname(os.path.abspath(self.file.filename))).free
        if left < RESERVE_BYTES:
            self.write()
            raise EndatError(
                f"{self.file.filename}: {left} bytes are left on the disk, fewer than {RESERVE_BYTES}: the recording has ended after "
                f"{self.rows} rows, the file is whole; make room, or record elsewhere"
            )
        there = self.rows + sum(map(len, self.waiting))
        if there // CHUNK > self.rows // CHUNK:
            # A chunk written in parts is compressed again for each part, and moved within the file.
            self.write(there // CHUNK * CHUNK)
        elif time.monotonic() - self.written > LATEST_S:
            self.write()

    def write(self, until: int | None = None) -> None:
        """Writes the waiting rows, up to a row. If Ctrl-C interrupts it, the next call writes them again."""
        if not self.waiting:
            return
        block = Samples.concatenate(self.waiting)
        begin = self.rows
        end = begin + len(block) if until is None else until
        count = end - begin

        def put(name: str, values: Any) -> None:
            data = self.made["/" + name]
            data.resize((end,))
            data[begin:end] = values[:count]

        put("time", block.time_s)
        put("trigger", block.trigger)
        put("missing", block.missing)
        for n, one in enumerate(block.channels):
            for name in self.of_channel:
                put(f"channel{n}/{name}", getattr(one, name))
        # Written rows survive whatever happens next.
        self.file.flush()
        rest = [] if count == len(block) else [_each([block], lambda arrays: arrays[0][count:])]
        self.rows, self.waiting, self.written = end, rest, time.monotonic()


def _enum(kind: Any) -> Any:
    import h5py  # type: ignore[import-untyped]

    return h5py.enum_dtype({name: code for code, name in CAUSES.items()}, basetype=np.dtype(kind))


def record(
    card: Card,
    path: str | os.PathLike[str],
    count: int | None = None,
    *,
    seconds: float | None = None,
    poll: bool = False,
    replace: bool = False,
    compression: str | None = "gzip",
    raw: bool = True,
) -> int:
    """Records into an HDF5 file (needs ``h5py``) until ``count`` rows, or ``seconds`` of the card's time, are in it; returns the rows.

    A nearly full disk ends it with an :class:`EndatError`, with a complete file. Without either limit it continues until
    Ctrl-C, which also leaves a complete file. Rows are written in chunks of some seconds, which a killed program loses; memory use does not
    grow. An hour of two channels at 10 kHz has 255 MB, and takes 8 % of a core in real time.
    ``compression``: ``gzip`` (read by all tools), ``lzf`` (larger, faster) or ``None``. ``raw=False`` omits the raw positions
    of the encoder, two fifths of a file: position in units and turns contain them.
    """
    import h5py

    if not replace and os.path.exists(path):
        raise BadInput(f"path = {os.fspath(path)}: is there already; give another one, or replace=True")
    with closing(card._limited(count, seconds, poll)) as blocks:
        # Only a card with rows creates a file.
        block: Samples | None = next(blocks)
        assert block is not None
        # HDF5 keeps chunks for readers, from version 2.0 on 8 MB of each data set; here they are not read again.
        with h5py.File(path, "w", rdcc_nbytes=CHUNK * 8) as file:
            to = _File(file, card, compression, raw)
            to.begin(block)
            try:
                while block is not None:
                    to.add(block)
                    block = next(blocks, None)
            except KeyboardInterrupt:
                if count is not None or seconds is not None:
                    raise
            finally:
                to.write()
            return to.rows
