"""EnDat acquisition cards, real and virtual: positions as numpy arrays.

    import endat

    with endat.connect("virtual:s6_two_channel_service") as card:
        print(card.encoders()[0])
        print(card.read()[0].position, "deg")
        samples = card.samples(1000)
        print(samples.time_s, samples.channels[0].unwrapped())
"""

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


def connect(port: str, *, baud: int = 3_000_000, wait: bool = True) -> Card:
    """Opens a card.

    ``port``: a serial port (``/dev/ttyUSB1``, ``COM5``), ``tcp:HOST:PORT``, or ``virtual``, ``virtual:PRESET``, ``virtual:FILE.toml``
    for one that is simulated in this process. ``wait``: until its encoders are initialised and the first results are there.
    """
    return Card(port, baud, wait)


def explain(cause: str | int) -> str:
    """What a cause means, and what helps: by its name, or its code in a column."""
    name = cause if isinstance(cause, str) else CAUSES.get(int(cause), "")
    text = explain_cause(name)
    if text is None:
        raise BadInput(f"cause = {cause!r}: there is none of that name; endat.CAUSES has them all")
    return text
