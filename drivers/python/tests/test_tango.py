"""The example for Tango, as a device with a client."""

import importlib.util
from pathlib import Path
from typing import Any

import pytest

EXAMPLE = Path(__file__).parent.parent / "examples" / "tango_server.py"

tango = pytest.importorskip("tango")
context = pytest.importorskip("tango.test_context")


def device(port: str) -> Any:
    """The example with a card at this port, in a separate process."""
    spec = importlib.util.spec_from_file_location("tango_server", EXAMPLE)
    assert spec and spec.loader
    server = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(server)
    return context.DeviceTestContext(server.EndatCard, properties={"port": port}, process=True, timeout=120)


def test_a_client_of_tango_reads_positions_and_the_memory_of_encoders(service: str) -> None:
    """Catches an attribute without unit, a missing position reported as good, and a call that the package no longer has."""
    with device(service) as card:
        card.set_timeout_millis(60_000)
        assert card.state() == tango.DevState.ON
        for channel in range(2):
            position = card.read_attribute(f"position_{channel}")
            assert position.quality == tango.AttrQuality.ATTR_VALID and 0 <= position.value < 360
            assert card.get_attribute_config(f"position_{channel}").unit == "deg"
            assert card.read_attribute(f"cause_{channel}").value == "none"
        plates = card.read_attribute("encoders").value
        assert len(plates) == 2 and all(plates)
        # The low byte of word 0x0D of MRS code 0xA1: number of clocks, and so of bits, of a position.
        assert card.read_parameter([0, 0xA1, 0x0D]) & 0xFF == 29
        with pytest.raises(tango.DevFailed, match="channel = 7"):
            card.read_parameter([7, 0xA1, 0x0D])


def test_a_card_that_is_not_there_is_a_fault_with_its_reason() -> None:
    with device("tcp:127.0.0.1:1") as card:
        assert card.state() == tango.DevState.FAULT
        assert "tcp:127.0.0.1:1" in card.status()
