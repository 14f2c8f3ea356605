"""What the tests share."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def service_file() -> Path:
    """A card with a service, at a clock that is simulated sooner than the preset's: the suite makes it."""
    return Path(os.environ["ENDAT_SERVICE"])


@pytest.fixture(scope="session")
def service(service_file: Path) -> str:
    """Its port."""
    return f"virtual:{service_file}"
