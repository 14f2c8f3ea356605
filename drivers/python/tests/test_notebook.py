"""Every notebook runs from its first cell to its last, as its text describes."""

import json
from pathlib import Path

import matplotlib
import pytest

#: The card of the notebooks.
PORT = "virtual:s6_two_channel_service"
NOTEBOOKS = sorted((Path(__file__).parent.parent / "examples").glob("*.ipynb"))


def run(path: Path, port: str, shown: int, recorded: int) -> None:
    """Runs a notebook at a port; with these numbers of shown and recorded rows, instead of 600 and 500."""
    matplotlib.use("Agg")
    names: dict[str, object] = {}
    text = path.read_text()
    for printed, taken in ((PORT, port), ("card.samples(600)", f"card.samples({shown})"), ("count=500", f"count={recorded}")):
        assert text.count(printed) == 1, printed
        text = text.replace(printed, taken)
    for cell in json.loads(text)["cells"]:
        assert not cell.get("outputs"), "outputs are not committed"
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    figure = names["figure"]
    figure.savefig("figure.png")  # type: ignore[attr-defined]
    assert len(figure.axes[0].lines) == 2  # type: ignore[attr-defined]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_runs_with_a_quick_card(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, service: str) -> None:
    monkeypatch.chdir(tmp_path)
    run(path, service, 80, 20)


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_runs_as_printed(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run(path, PORT, 600, 500)
