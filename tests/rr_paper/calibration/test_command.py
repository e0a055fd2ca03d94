"""`rr-opt calibrate` writes every file, and prints JSON alone if asked."""

from __future__ import annotations

import csv
import json

import pytest

from rr_paper import calibration
from rr_paper.calibration import cycles, models
from rr_paper.calibration.fit import Effort

FILES = {
    "report.html", "calibration.json", "intervals.csv", "models.csv", "predictions.csv",
    "profiles.csv", "posterior.csv", "readings.csv", "coverage.csv", "unknowns.svg",
    "predictions.svg", "coverage.svg",
}  # fmt: skip


@pytest.fixture
def hasty(monkeypatch):
    """So little work that the numbers are meaningless."""
    little = Effort(log2_size=6, slices=1, values=3, starts=1, steps=2, sets=2)
    monkeypatch.setattr(calibration, "effort", lambda model: little)
    monkeypatch.setattr(calibration, "REDUCED", {"viscous": {}, "viscous+dry": {}})
    for name, count in (("CHAINS", 12), ("SWEEPS", 40), ("COVERAGE_SETS", 3)):
        monkeypatch.setattr(calibration, name, count)
    monkeypatch.setattr(models, "_DRY", 8)
    monkeypatch.setattr(models, "_CORNERS", 16)
    monkeypatch.setattr(cycles, "_ITERATIONS", 8)


def test_the_files(run, hasty, tmp_path):
    ended = run("calibrate", "--out", "here", "--json")
    assert ended.exit_code == 0, ended.output
    folder = tmp_path / "here"
    assert {path.name for path in folder.iterdir()} == FILES
    assert json.loads(ended.stdout) == json.loads((folder / "calibration.json").read_text())
    with (folder / "predictions.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5 * 2 * 9
    assert {row["model"] for row in rows} >= {"viscous", "viscous+dry", "printed"}
    page = (folder / "report.html").read_text()
    assert "nan" not in page.split("</style>")[1].split("data:image")[0]


def test_a_folder_that_cannot_be_made(run, hasty, tmp_path):
    (tmp_path / "file").write_text("")
    ended = run("calibrate", "--out", "file/inside")
    assert ended.exit_code == 2
    assert "not a folder" in ended.stderr
