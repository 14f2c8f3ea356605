"""A card: its identity, positions, registers, and the memory of its encoders."""

from __future__ import annotations

import time
import warnings
from collections.abc import Generator, Mapping
from contextlib import closing
from dataclasses import dataclass
from types import TracebackType

from . import endat_native
from .errors import BadInput
from .samples import Samples, _samples


@dataclass(frozen=True)
class Identity:
    """Identity of a card."""

    #: Version of its register map.
    register_map: str
    channels: int
    #: ``EnDat`` or ``T-format``, of each channel.
    protocols: tuple[str, ...]
    max_position_bits: int
    #: System clock, the unit of every number of cycles.
    system_hz: int
    #: Hash of the configuration from which it was generated.
    configuration_hash: int
    #: Its optional parts.
    parts: tuple[str, ...]


@dataclass(frozen=True)
class NamePlate:
    """Name plate of an encoder, as the card read it; None for words that it has not read."""

    #: The card has initialised the encoder successfully.
    initialised: bool
    #: The encoder supports EnDat 2.2.
    endat22: bool
    position_bits: int | None
    rotary: bool | None
    #: Distinguishable revolutions, 0 or 1 = singleturn.
    revolutions: int | None
    #: Measuring steps per revolution, or the measuring step in nm.
    steps: int | None
    #: ID number as printed on the encoder.
    id: str | None
    #: Serial number.
    serial: str | None
    clock_max_khz: int | None
    short_recovery: bool | None
    #: Alarms and warnings before they were cleared.
    alarms: int | None
    warnings: int | None


@dataclass(frozen=True)
class Reading:
    """Result of a channel's last trigger."""

    #: Position in ``unit``, within the turn of a rotary encoder.
    position: float | None
    #: ``deg``, ``mm`` or ``counts``.
    unit: str
    #: Whole turns, None for a linear encoder.
    turns: int | None
    #: Position as the encoder sent it.
    raw: int | None
    #: The last trigger brought the position; False: it is from an earlier one, or there is none.
    fresh: bool
    #: Cause of a missing position, or another remark; ``none`` if everything was good.
    cause: str
    #: Number of results, modulo 65536.
    sequence: int
    #: First falling clock edge of the frame, in system clock cycles modulo 2^32.
    cycles: int
    #: Age of the position in microseconds; stops at 65535.
    age_us: int
    #: Tracked line delay and recovery time, in system clock cycles.
    delay_cycles: int
    recovery_cycles: int


@dataclass(frozen=True)
class Answer:
    """Answer to a mode command."""

    #: Echo of MRS code or address.
    address: int
    data: int
    #: All bits: a position or test values, for commands with such an answer.
    bits: int


def _in_range(name: str, value: int, most: int, least: int = 0) -> int:
    if not least <= value <= most:
        raise BadInput(f"{name} = {value}: outside {least}..{most:#x}")
    return value


#: Default of the largest number of rows in a block of :meth:`Card.stream`.
BLOCK = 1000
#: Longest time between two blocks, if there are rows.
LATENCY_S = 0.5


class Card:
    """A card at a link, or simulated in this process; made by :func:`endat.connect`.

    Calls may come from any thread; the card executes them in order. ``with`` closes it at the end.
    """

    def __init__(self, port: str, baud: int, wait: bool, ranges: Mapping[int, str] | None) -> None:
        self.port = port
        said = [f"{channel}={text}" for channel, text in (ranges or {}).items()]
        self._native = endat_native.connect(port, _in_range("baud", baud, 12_000_000, 300), said)
        try:
            told = self._native.identity()
            self.identity = Identity(
                **{k: tuple(v) if isinstance(v, list) else v for k, v in told.items()}  # type: ignore[arg-type]
            )
            if wait:
                self._native.settle()
            for note in self._native.scale_notes():
                warnings.warn(note, stacklevel=3)
        except BaseException:
            self._native.close()
            raise

    def __enter__(self) -> Card:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<endat.Card {self.port}: {', '.join(self.identity.protocols)}>"

    def close(self) -> None:
        """Ends a recording under way, and closes the link."""
        self._native.close()

    def encoders(self) -> list[NamePlate | None]:
        """The name plate of each channel's encoder; None if the card does not read it (part ``initialise``)."""
        return [None if one is None else NamePlate(**one) for one in self._native.name_plates()]

    def read(self) -> list[Reading]:
        """The latest result of every channel, all from one instant."""
        return [Reading(**one) for one in self._native.read()]

    def stream(self, block: int = BLOCK, *, poll: bool = False) -> Generator[Samples]:
        """Positions as they arrive, in blocks of up to ``block`` rows, until the iterator is closed.

        A card with a stream gives a row for every trigger. With ``poll``, and for cards without a stream, the results are polled.
        A lost link is reopened; ``missing`` counts the triggers lost meanwhile. Raises :class:`endat.Silent` when nothing
        has arrived for 20 s, and :class:`endat.Refused` when the card is another one afterwards, or has restarted.
        """
        if block < 1:
            raise BadInput(f"block = {block}: a block has at least one row")
        native, hz = self._native, self.identity.system_hz
        native.begin(poll)
        try:
            scales = native.scales()
            got: list[Samples] = []
            last = time.monotonic()
            while True:
                there = sum(map(len, got))
                if there and (there >= block or time.monotonic() - last > LATENCY_S):
                    yield Samples.concatenate(got)
                    got, last, there = [], time.monotonic(), 0
                got.append(_samples(native.take(block - there), hz, scales))
        finally:
            native.end()

    def samples(self, count: int | None = None, *, seconds: float | None = None, poll: bool = False) -> Samples:
        """``count`` rows, or those of ``seconds`` of the card's time, whichever comes first."""
        if count is None and seconds is None:
            raise BadInput("samples(): neither count nor seconds is given; give one, or use stream()")
        with closing(self._limited(count, seconds, poll)) as blocks:
            return Samples.concatenate(blocks)

    def _limited(self, count: int | None, seconds: float | None, poll: bool) -> Generator[Samples]:
        """The blocks of a stream up to ``count`` rows, or ``seconds`` of the card's time; without either, forever."""
        if count is not None and count < 1:
            raise BadInput(f"count = {count}: give at least 1")
        if seconds is not None and not seconds > 0:
            raise BadInput(f"seconds = {seconds}: give more than 0")
        left = count
        with closing(self.stream(BLOCK if left is None else min(BLOCK, left), poll=poll)) as blocks:
            for one in blocks:
                # The last block may be longer than needed.
                n = len(one) if left is None else min(len(one), left)
                if seconds is not None:
                    n = min(n, int((one.time_s <= seconds).sum()))
                left = None if left is None else left - n
                yield one if n == len(one) else one.head(n)
                if n < len(one) or left == 0:
                    break

    def losses(self) -> tuple[int, int]:
        """While a recording is under way: frames damaged on the link, and sets dropped by the card."""
        return self._native.losses()

    def trigger(self) -> None:
        """Triggers all channels now; the trigger source ``register`` must be enabled."""
        self.write_register("card.trigger_now", 1)

    def calibrate(self) -> None:
        """Measures the line delays again with the next frame."""
        self.write_register("card.calibrate", 1)

    def read_register(self, name: str) -> int:
        """A word or field by name, as in ``result0.status.cause``; `endat reg list` shows all."""
        return self._native.read_register(name)

    def write_register(self, name: str, value: int, *, force: bool = False) -> None:
        """Writes a word, or a field and keeps the others. Values that the register map forbids are rejected, unless ``force``."""
        self._native.write_register(name, _in_range("value", value, 0xFFFF_FFFF), force)

    def read_parameter(self, channel: int, area: int, address: int) -> int:
        """A word of the encoder's memory, by MRS code and address (part ``requests``)."""
        return self._native.read_parameter(
            _in_range("channel", channel, 7), _in_range("area", area, 0xFF), _in_range("address", address, 0xFF)
        )

    def write_parameter(self, channel: int, area: int, address: int, value: int) -> None:
        """Writes a word of the encoder's memory."""
        self._native.write_parameter(
            _in_range("channel", channel, 7),
            _in_range("area", area, 0xFF),
            _in_range("address", address, 0xFF),
            _in_range("value", value, 0xFFFF),
        )

    def request(self, channel: int, command: int, address: int = 0, data: int = 0) -> Answer:
        """Sends a mode command, as in ``request(0, 0b101010)``."""
        return Answer(
            *self._native.request(
                _in_range("channel", channel, 7),
                _in_range("command", command, 0b111111),
                _in_range("address", address, 0xFF),
                _in_range("data", data, 0xFFFF),
            )
        )
