"""Fixtures of the tests."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def service_file() -> Path:
    """A card with a service, with a clock that simulates faster than the preset's; the suite generates it."""
    return Path(os.environ["ENDAT_SERVICE"])


@pytest.fixture(scope="session")
def service(service_file: Path) -> str:
    """Port of that card."""
    return f"virtual:{service_file}"
