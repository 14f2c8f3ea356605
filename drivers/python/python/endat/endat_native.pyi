"""The part in Rust; use `endat.Card`."""

from typing import TypedDict

class _Identity(TypedDict):
    register_map: str
    channels: int
    protocols: list[str]
    max_position_bits: int
    system_hz: int
    configuration_hash: int
    parts: list[str]

class _NamePlate(TypedDict):
    initialised: bool
    endat22: bool
    position_bits: int | None
    rotary: bool | None
    revolutions: int | None
    steps: int | None
    id: str | None
    serial: str | None
    clock_max_khz: int | None
    short_recovery: bool | None
    alarms: int | None
    warnings: int | None

class _Reading(TypedDict):
    position: float | None
    unit: str
    turns: int | None
    raw: int | None
    fresh: bool
    cause: str
    sequence: int
    cycles: int
    age_us: int
    delay_cycles: int
    recovery_cycles: int

class _Columns(TypedDict):
    trigger: bytes
    cycles: bytes
    missing: bytes
    run: bytes
    channels: list[dict[str, bytes]]

class _Scale(TypedDict):
    unit: str
    digits: int
    wraps_at: float | None
    turns: int | None
    steps_per_turn: int | None
    linear: bool
    unknown: str | None

class NativeCard:
    def identity(self) -> _Identity: ...
    def settle(self) -> None: ...
    def name_plates(self) -> list[_NamePlate | None]: ...
    def scales(self) -> list[_Scale]: ...
    def scale_notes(self) -> list[str]: ...
    def read(self) -> list[_Reading]: ...
    def begin(self, polls: bool) -> None: ...
    def take(self, count: int) -> _Columns: ...
    def losses(self) -> tuple[int, int]: ...
    def end(self) -> None: ...
    def read_register(self, name: str) -> int: ...
    def write_register(self, name: str, value: int, force: bool) -> None: ...
    def read_parameter(self, channel: int, area: int, address: int) -> int: ...
    def write_parameter(self, channel: int, area: int, address: int, value: int) -> None: ...
    def request(self, channel: int, command: int, address: int, data: int) -> tuple[int, int, int]: ...
    def close(self) -> None: ...

def connect(port: str, baud: int, ranges: list[str]) -> NativeCard: ...
def cause_names() -> list[tuple[int, str]]: ...
def explain_cause(name: str) -> str | None: ...
