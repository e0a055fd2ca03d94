"""`rr-opt calibrate` writes every file, tells what they hold, and prints JSON alone if asked."""

from __future__ import annotations

import csv
import json

import pytest

from rr_paper.calibration import calibrate as work
from rr_paper.calibration import models, steady
from rr_paper.calibration.fit import Effort

FILES = {
    "report.html", "calibration.json", "intervals.csv", "models.csv", "predictions.csv",
    "profiles.csv", "posterior.csv", "readings.csv", "coverage.csv", "unknowns.svg",
    "predictions.svg", "coverage.svg",
}  # fmt: skip


@pytest.fixture
def hasty(monkeypatch):
    """The same work, so little of it that its numbers mean nothing."""
    little = Effort(log2_size=6, slices=1, values=3, starts=1, steps=2, sets=2)
    monkeypatch.setattr(work, "effort", lambda model: little)
    monkeypatch.setattr(work, "OTHERS", {"viscous": {}, "viscous+dry": {}})
    for name, count in (("CHAINS", 12), ("SWEEPS", 40), ("COVERAGE_SETS", 3)):
        monkeypatch.setattr(work, name, count)
    monkeypatch.setattr(models, "_DRY", 8)
    monkeypatch.setattr(models, "_CORNERED", 16)
    monkeypatch.setattr(steady, "_STEPS", 8)


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


def test_a_folder_that_cannot_be(run, hasty, tmp_path):
    (tmp_path / "file").write_text("")
    ended = run("calibrate", "--out", "file/inside")
    assert ended.exit_code == 2
    assert "not a folder" in ended.stderr
