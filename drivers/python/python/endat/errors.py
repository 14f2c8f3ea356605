"""What can go wrong between a program and a card."""


class EndatError(Exception):
    """Something could not be had from a card: the link is gone, or what answers is no card."""


class BadInput(EndatError, ValueError):
    """A name or number that was given is wrong; the text says what is right."""


class Refused(EndatError):
    """The encoder, the line to it or the card refused."""


class Silent(EndatError, TimeoutError):
    """Nothing answers, or no sample comes."""
