"""Positions of many triggers, as arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .endat_native import cause_names
from .errors import BadInput

if TYPE_CHECKING:
    from .endat_native import _Columns, _Scale

#: Name of each code in a column of causes; `endat.explain` explains it.
CAUSES: Mapping[int, str] = dict(cause_names())
_CODES = {name: code for code, name in CAUSES.items()}


# Comparison of arrays is elementwise, so a record of arrays equals only itself.
@dataclass(frozen=True, eq=False)
class AdditionalData:
    """Additional data 1 or 2 of the same frames."""

    #: Received with a right CRC; the other entries are 0.
    good: NDArray[np.bool_]
    #: WRN, RM, Busy, I4..I0.
    status: NDArray[np.uint16]
    content: NDArray[np.uint16]


@dataclass(frozen=True, eq=False, repr=False)
class ChannelSamples:
    """One channel's positions; index n is of the same trigger in all arrays."""

    #: ``deg``, ``mm`` or ``counts``.
    unit: str
    #: Position in the unit, within the turn of a rotary encoder; NaN if there is none.
    position: NDArray[np.float64]
    #: Whole turns, 0 for a linear encoder.
    turns: NDArray[np.uint64]
    #: Position as the encoder sent it, bit 0 = LSB.
    raw: NDArray[np.uint64]
    #: A position is available, from this trigger or an earlier one.
    valid: NDArray[np.bool_]
    #: This trigger brought the position. Use only these: the others are from earlier triggers.
    fresh: NDArray[np.bool_]
    #: Codes of :data:`CAUSES`; 0 = none.
    cause: NDArray[np.uint8]
    #: Value at which the position wraps to 0, in the unit; None for a linear encoder, and if unknown.
    wraps_at: float | None
    #: Number of turns that the encoder distinguishes, 1 = it counts none; then the count wraps. None for a linear encoder, and if unknown.
    turns_counted: int | None
    #: Reason why positions cannot be unwrapped or compared, with the remedy; None if they can.
    unknown: str | None
    #: Additional data 1 and 2; empty on a card that does not record them.
    additional: tuple[AdditionalData, ...]

    def __repr__(self) -> str:
        return f"<endat.ChannelSamples: {len(self.raw)} rows, {int(self.fresh.sum())} fresh, in {self.unit}>"

    def cause_names(self) -> NDArray[np.str_]:
        """The causes as names."""
        names = np.full(256, "unknown", dtype=object)
        for code, name in CAUSES.items():
            names[code] = name
        return names[self.cause].astype(np.str_)

    def unwrapped(self) -> NDArray[np.float64]:
        """The position without jumps, including whole turns; NaN if this trigger brought none.

        From one fresh position to the next an encoder must move less than half its range: of a turn, or of all turns that
        it counts. Raises :class:`endat.BadInput` if the range is unknown.
        """
        if self.unknown is not None:
            raise BadInput(f"unwrapped(): {self.unknown}")
        out = np.full(len(self.position), np.nan)
        seen = self.position[self.fresh]
        if self.wraps_at is not None:
            turns = self.turns[self.fresh].astype(np.float64)
            seen = np.unwrap(seen + turns * self.wraps_at, period=self.wraps_at * (self.turns_counted or 1))
        out[self.fresh] = seen
        return out


@dataclass(frozen=True, eq=False, repr=False)
class Samples:
    """A row for each trigger."""

    #: Seconds of the card's clock since the first row of the recording.
    time_s: NDArray[np.float64]
    #: Number of the trigger, not wrapping.
    trigger: NDArray[np.uint64]
    #: Triggers without a row just before this one.
    missing: NDArray[np.uint64]
    #: Channel whose running clock brought the row; -1: a trigger did.
    run: NDArray[np.int8]
    channels: tuple[ChannelSamples, ...]

    def __len__(self) -> int:
        return len(self.trigger)

    def __repr__(self) -> str:
        span = f"{self.time_s[0]:.6g} s to {self.time_s[-1]:.6g} s" if len(self) else "no time"
        return f"<endat.Samples: {len(self)} rows, {span}, {int(self.missing.sum())} triggers missing, {len(self.channels)} channels>"

    def columns(self) -> dict[str, NDArray[Any]]:
        """All arrays by name, as ``pandas.DataFrame`` takes them."""
        all_: dict[str, NDArray[Any]] = {
            "time_s": self.time_s,
            "trigger": self.trigger,
            "missing": self.missing,
        }
        for n, one in enumerate(self.channels):
            all_[f"channel{n}_{one.unit}"] = one.position
            for name in ("turns", "raw", "fresh"):
                all_[f"channel{n}_{name}"] = getattr(one, name)
            all_[f"channel{n}_cause"] = one.cause_names()
            for i, more in enumerate(one.additional, start=1):
                for field in fields(more):
                    all_[f"channel{n}_additional_{i}_{field.name}"] = getattr(more, field.name)
        return all_

    def head(self, count: int) -> Samples:
        """The first rows."""
        if count < 0:
            raise BadInput(f"count = {count}: give 0 or more")
        made: Samples = _each([self], lambda arrays: arrays[0][:count])
        return made

    @staticmethod
    def concatenate(blocks: Iterable[Samples]) -> Samples:
        """Concatenates blocks of one recording."""
        all_ = list(blocks)
        if not all_:
            raise ValueError("blocks = []: nothing to concatenate; give at least one block")
        made: Samples = _each(all_, np.concatenate)
        return made


def _each(parts: Any, change: Callable[[list[NDArray[Any]]], NDArray[Any]]) -> Any:
    """Applies a change to every array of these parts, which have the same form; other values are those of the first part."""
    first = parts[0]
    if isinstance(first, np.ndarray):
        return change(parts)
    if isinstance(first, tuple):
        return tuple(_each(each, change) for each in zip(*parts, strict=True))
    if is_dataclass(first) and not isinstance(first, type):
        of = {f.name: _each([getattr(p, f.name) for p in parts], change) for f in fields(first)}
        return replace(first, **of)
    return first


_KINDS: dict[str, Any] = {
    "raw": np.uint64,
    "valid": np.bool_,
    "position": np.float64,
    "turns": np.uint64,
    "fresh": np.bool_,
    "cause": np.uint8,
    "good": np.bool_,
    "status": np.uint16,
    "content": np.uint16,
}


def _samples(columns: _Columns, system_hz: int, scales: list[_Scale]) -> Samples:
    channels = []
    for of, scale in zip(columns["channels"], scales, strict=True):
        arrays = {name: np.frombuffer(data, dtype=_KINDS[name.rsplit("_", 1)[-1]]) for name, data in of.items()}
        additional = tuple(
            AdditionalData(**{f.name: arrays.pop(f"additional_{n}_{f.name}") for f in fields(AdditionalData)})
            for n in (1, 2)
            if f"additional_{n}_good" in arrays
        )
        channels.append(
            ChannelSamples(
                unit=scale["unit"],
                wraps_at=scale["wraps_at"],
                turns_counted=scale["turns"],
                unknown=scale["unknown"],
                additional=additional,
                **arrays,
            )
        )
    return Samples(
        time_s=np.frombuffer(columns["cycles"], dtype=np.uint64) / system_hz,
        trigger=np.frombuffer(columns["trigger"], dtype=np.uint64),
        missing=np.frombuffer(columns["missing"], dtype=np.uint64),
        run=np.frombuffer(columns["run"], dtype=np.int8),
        channels=tuple(channels),
    )
