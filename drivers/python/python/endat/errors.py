"""Errors between a program and a card."""


class EndatError(Exception):
    """Access to a card failed: the link is lost, or the answer does not come from a card."""


class BadInput(EndatError, ValueError):
    """A given name or number is wrong; the text has the valid values."""


class Refused(EndatError):
    """The encoder, the line to it or the card rejected the request."""


class Silent(EndatError, TimeoutError):
    """No answer, or no sample."""
