"""What the tests share."""

import os
import subprocess
from pathlib import Path

import pytest

# A clock that takes a fifth of the time to simulate.
QUICK = [
    ("system_hz = 100_000_000", "system_hz = 20_000_000"),
    ("clock_hz = 3_125_000", "clock_hz = 2_000_000"),
    ("filter_ns = 20", "filter_ns = 50"),
    ("start_window_ns = 80", "start_window_ns = 100"),
    ("baud = 3_000_000", "baud = 2_000_000"),
    ("sample_hz = 10_000", "sample_hz = 5_000"),
]


@pytest.fixture(scope="session")
def service_text() -> str:
    """The preset with a service, at that clock."""
    show = [os.environ["ENDAT_GEN"], "presets", "--show", "s6_two_channel_service"]
    text = subprocess.run(show, capture_output=True, text=True, check=True).stdout
    for before, after in QUICK:
        assert before in text, before
        text = text.replace(before, after, 1)
    return text


@pytest.fixture(scope="session")
def service_file(service_text: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with it."""
    path = tmp_path_factory.mktemp("service") / "service.toml"
    path.write_text(service_text)
    return path


@pytest.fixture(scope="session")
def service(service_file: Path) -> str:
    """Its port."""
    return f"virtual:{service_file}"
