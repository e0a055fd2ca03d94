"""sweep tries gaits all over the bounds, writes each of them and tells the best."""

import csv
import json

import pytest


@pytest.fixture
def swept(run, quick):
    return run("sweep", str(quick), "--points", "60", "--out", "res", "--json")


def test_json_stands_alone_and_is_the_file(swept, tmp_path):
    assert swept.exit_code == 0, swept.stderr
    reported = json.loads(swept.stdout)
    assert reported == json.loads((tmp_path / "res" / "sweep.json").read_text())
    assert reported["status"] == "swept"
    assert reported["best"]["speed"] < 0


def test_every_gait_is_a_row_and_the_best_of_the_grid_is_among_them(swept, tmp_path):
    with (tmp_path / "res" / "sweep.csv").open() as file:
        rows = list(csv.DictReader(file))
    best = json.loads(swept.stdout)["best_of_grid"]
    kept = [row for row in rows if all(row[key] == "1" for key in row if key.startswith("keeps"))]
    fastest = max(kept, key=lambda row: abs(float(row["speed [m/s]"])))
    assert float(fastest["speed [m/s]"]) == pytest.approx(best["speed"], rel=1e-8)
    assert float(fastest["amplitude [rad]"]) == pytest.approx(best["gait"]["amplitude"], rel=1e-8)


def test_only_whole_files_are_left(swept, tmp_path):
    names = {path.name for path in (tmp_path / "res").iterdir()}
    assert names == {"report.html", "sweep.json", "sweep.csv", "sweep.svg"}


def test_no_allowed_gait_exits_3(run, impossible):
    done = run("sweep", str(impossible), "--points", "60")
    assert done.exit_code == 3
    assert "limit" in done.stderr
