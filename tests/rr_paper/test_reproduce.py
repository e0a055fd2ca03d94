"""`rr-opt reproduce` writes the page, the audit, a figure and a CSV for each of the paper's."""

import csv
import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_paper import reproduction
from rr_paper.publication import TABLE_2, TABLE_3
from rr_paper.reproduction import Reproduction

SVGS = [f"{name}.svg" for name in Reproduction.CAPTIONS]


@pytest.fixture
def run(found, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)

    def command(*arguments, mujoco=found.mujoco):
        monkeypatch.setattr(reproduction, "reproduce", lambda *_: replace(found, mujoco=mujoco))
        return CliRunner().invoke(app, ["reproduce", *arguments])

    return command


def test_the_folder(run, tmp_path):
    done = run("--out", "res", "--json", mujoco=None)
    assert done.exit_code == 0, done.stderr
    record = json.loads(done.stdout)
    assert record == json.loads((tmp_path / "res" / "reproduce.json").read_text())
    assert record["mujoco_speed"] is None
    assert "MuJoCo is not installed" in done.stderr
    names = {path.name for path in (tmp_path / "res").iterdir()}
    assert {
        "report.html",
        "audit.md",
        "tables.csv",
        *(f"{one}.svg" for one in Reproduction.CAPTIONS),
    } <= names
    assert {f"figure{n}.csv" for n in (3, 4, 5, 6)} <= names
    assert {f"audit-{key}.csv" for key in record["sections"] if key != "columns"} <= names
    page = (tmp_path / "res" / "report.html").read_text()
    assert page.count("data:image/svg+xml") == len(SVGS)


def test_the_tables_are_the_printed_ones(run, tmp_path):
    assert run("--no-figures").exit_code == 0
    with (tmp_path / "out" / "paper" / "tables.csv").open() as file:
        rows = list(csv.DictReader(file))
    for row, printed in zip(rows, (*TABLE_2, *TABLE_3), strict=True):
        assert float(row["mean, m/s"]) == printed.mean
        assert float(row["half width, m/s"]) == printed.half_width
        assert float(row["v_exp, m/s"]) == printed.other
    assert not (tmp_path / "out" / "paper" / "report.html").exists()


def test_mujoco_drives_as_the_corrected_equation(run, found):
    pytest.importorskip("mujoco")
    record = json.loads(run("--no-figures", "--json").stdout)
    assert record["mujoco_speed"] == pytest.approx(found.start.steady, rel=1e-3)
    assert "MuJoCo" in " ".join(record["sections"]["signs"]["sentences"])


def test_without_mujoco_there_is_no_speed(found, monkeypatch):
    monkeypatch.setattr(reproduction, "find_spec", lambda _: None)
    assert reproduction.mujoco_speed(found.robot, found.start.gait) is None
