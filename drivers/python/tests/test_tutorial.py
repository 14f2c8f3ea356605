"""The program on the tutorial's page."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "docs" / "tutorial.md"


#: The card of the page.
PORT = "virtual:s6_two_channel_service"


def follow(port: str, rows: int, capsys: pytest.CaptureFixture[str]) -> None:
    """Runs the program at a port, with this number of rows instead of 500."""
    found = re.search(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert found and found[1].count(PORT) == 1 and found[1].count('"angles.h5", 500)') == 1
    program = found[1].replace(PORT, port).replace('"angles.h5", 500)', f'"angles.h5", {rows})')
    exec(compile(program, str(PAGE), "exec"), {"__name__": "tutorial"})
    shown = capsys.readouterr().out
    assert f"({rows},)" in shown and "unit" in shown and "deg" in shown, shown


def test_the_tutorial_records_what_others_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], service: str
) -> None:
    """Catches a renamed call on the page, and a file without units: with a quick card."""
    monkeypatch.chdir(tmp_path)
    follow(service, 60, capsys)


@pytest.mark.slow
def test_the_tutorial_works_as_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    follow(PORT, 500, capsys)
