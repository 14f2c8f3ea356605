"""The program on the tutorial's page, as it stands."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "docs" / "tutorial.md"


def test_the_tutorial_records_what_others_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Catches a call on the page that has another name now, and a file without units."""
    found = re.search(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert found
    monkeypatch.chdir(tmp_path)
    exec(compile(found[1], str(PAGE), "exec"), {"__name__": "tutorial"})
    shown = capsys.readouterr().out
    assert "(500,)" in shown and "unit" in shown and "deg" in shown, shown
