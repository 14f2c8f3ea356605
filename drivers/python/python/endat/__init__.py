"""EnDat acquisition cards, real and virtual: positions as numpy arrays.

    import endat

    with endat.connect("virtual:s6_two_channel_service") as card:
        print(card.encoders()[0])
        print(card.read()[0].position, "deg")
        samples = card.samples(1000)
        print(samples.time_s, samples.channels[0].unwrapped())
"""

from collections.abc import Mapping

from .card import Answer, Card, Identity, NamePlate, Reading
from .endat_native import explain_cause
from .errors import BadInput, EndatError, Refused, Silent
from .recording import record
from .samples import CAUSES, AdditionalData, ChannelSamples, Samples

__all__ = [
    "CAUSES",
    "AdditionalData",
    "Answer",
    "BadInput",
    "Card",
    "ChannelSamples",
    "EndatError",
    "Identity",
    "NamePlate",
    "Reading",
    "Refused",
    "Samples",
    "Silent",
    "connect",
    "explain",
    "record",
]


def connect(
    port: str, *, baud: int = 3_000_000, wait: bool = True, ranges: Mapping[int, str] | None = None
) -> Card:
    """Opens a card.

    ``port``: a serial port (``/dev/ttyUSB1``, ``COM5``), ``tcp:HOST:PORT``, or ``virtual``, ``virtual:PRESET``, ``virtual:FILE.toml``
    for a card simulated in this process. ``wait``: until its encoders are initialised and the first results are available.
    ``ranges``: kind of position of a channel, if encoder and configuration do not define it or are wrong: ``{0: "17+16"}`` for 17
    bits of angle and 16 turn bits, ``{1: "linear"}`` for a scale.
    """
    return Card(port, baud, wait, ranges)


def explain(cause: str | int) -> str:
    """Explanation of a cause, with the remedy: by its name, or its code in a column."""
    name = cause if isinstance(cause, str) else CAUSES.get(int(cause), "")
    text = explain_cause(name)
    if text is None:
        raise BadInput(f"cause = {cause!r}: unknown cause; endat.CAUSES lists all")
    return text
