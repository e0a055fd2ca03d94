"""A pendulum's dry friction is named from files, with an interval that covers it; none is not."""

import json

import numpy as np
import pytest

import rr_opt as rr
from tests.machines.swings import NOISE, write


def test_dry_friction_is_named(tmp_path):
    found = rr.diagnose(write(tmp_path, dry=0.03))
    assert found.verdict == "missing_physics"
    assert [one.name for one in found.effects] == ["coulomb_friction"]
    torque = found.effects[0].parameters["torque"]
    assert torque.low <= 0.03 <= torque.high
    assert torque.high - torque.low < 0.01
    assert found.found.after < 1.2 < found.found.before
    written = found.save(tmp_path / "out")
    assert {"diagnosis.json", "report.html", "machine-corrected.yaml"} <= {f.name for f in written}
    assert "Pendulum · " in (tmp_path / "out/report.html").read_text()
    record = json.loads((tmp_path / "out/diagnosis.json").read_text())
    assert record["machine"] == "pendulum"
    errors = record["fit"]["heldout_error"]["q"]
    assert errors["after"] < 1.2 * 3e-3 < errors["parameters"]


def test_none_is_consistent(tmp_path):
    assert rr.diagnose(write(tmp_path, dry=0.0)).verdict == "consistent"


@pytest.mark.parametrize("last", [550, 1100])
def test_an_angle_may_be_missing_for_seconds(tmp_path, last):
    folder = write(tmp_path, dry=0.03)
    head, *rows = (folder / "run0.csv").read_text().splitlines()
    for k in range(200, last):
        t, _, torque = rows[k].split(",")
        rows[k] = f"{t},,{torque}"
    (folder / "run0.csv").write_text("\n".join([head, *rows]))
    found = rr.diagnose(folder)
    assert [one.name for one in found.effects] == ["coulomb_friction"]
    torque = found.effects[0].parameters["torque"]
    assert torque.low <= 0.03 <= torque.high
    assert found.found.after < 1.2


def test_what_is_wrong_is_listed_at_once(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    text = (folder / "experiment.yaml").read_text()
    text = text.replace("u: motor", "u: engine").replace("J: 5 %", "K: 5 %")
    (folder / "experiment.yaml").write_text(text)
    issues = [str(one) for one in rr.lint(folder) if one.level == "error"]
    assert any("uncertainty.K" in one for one in issues)
    text = text.replace("K: 5 %", "J: 5 %")
    (folder / "experiment.yaml").write_text(text)
    issues = [str(one) for one in rr.lint(folder) if one.level == "error"]
    assert len(issues) == 2
    assert all("engine" in one for one in issues)


def test_a_copy_is_no_evidence(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    head, *rows = (folder / "run0.csv").read_text().splitlines()
    (folder / "run1.csv").write_text("\n".join([head, *rows[100:300]]))
    issues = [str(one) for one in rr.lint(folder) if one.level == "error"]
    assert len(issues) == 1
    assert "Read the same motion as run0.csv. Expected a different run" in issues[0]


def test_a_machine_that_there_is_not(tmp_path):
    file = write(tmp_path, dry=0.0, runs=2, seconds=2.0) / "experiment.yaml"
    file.write_text(file.read_text().replace("machine: pendulum", "machine: pendulu"))
    said = f"{file}:1: machine: Read the machine 'pendulu'. Expected one of: racer, pendulum"
    for verb in (rr.diagnose, rr.inspect):
        with pytest.raises(rr.InputError) as error:
            verb(file)
        assert str(error.value).startswith(said)
    assert str(rr.lint(file)[0]).startswith(said)


def test_inspect_says_what_was_read(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    found = rr.inspect(folder)
    first, last = found.record()["recordings"]
    assert (first["use"], last["use"]) == ("fit", "holdout")
    assert first["samples"] == 400
    assert first["rate"] == pytest.approx(200.0)
    assert first["channels"]["q"]["sigma"] == pytest.approx(NOISE, rel=0.2)
    assert first["channels"]["u"]["missing"] == 0
    assert "2 recordings of a pendulum driven by a torque without warnings" in found.summary()
    pages = found.save(tmp_path / "out")
    assert {one.name for one in pages} == {"inspection.json", "report.html"}
    page = (tmp_path / "out" / "report.html").read_text()
    assert "run0.csv: Channels" in page
    assert "Pendulum · " in page
    assert "Roller Racer" not in page


def test_the_roller_racer_may_be_named(tmp_path):
    rr.init("experiment", tmp_path / "one")
    file = tmp_path / "one" / "experiment.yaml"
    file.write_text("machine: racer\n" + file.read_text())
    assert rr.lint(file) == []


@pytest.mark.parametrize("wrong", ["", "nan", "1e308"])
def test_a_sample_that_is_none_spoils_no_other(tmp_path, wrong):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    rows = (folder / "run0.csv").read_text().splitlines()
    for k, column in ((101, 1), (150, 2)):
        cells = rows[k].split(",")
        cells[column] = wrong
        rows[k] = ",".join(cells)
    (folder / "run0.csv").write_text("\n".join(rows) + "\n")
    run = rr.load_experiment(folder).runs[0]
    assert np.isnan(run.outputs["q"]).sum() == 1
    assert np.isfinite(run.inputs["u"]).all()


def test_a_channel_without_numbers_is_refused(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    rows = (folder / "run0.csv").read_text().splitlines()
    empty = [rows[0], *(f"{row.split(',')[0]},,{row.split(',')[2]}" for row in rows[1:])]
    (folder / "run0.csv").write_text("\n".join(empty) + "\n")
    assert "Read 0 numbers for q" in str(rr.lint(folder)[0])


def test_times_that_are_no_numbers_are_refused(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    rows = (folder / "run0.csv").read_text().splitlines()
    empty = [rows[0], *(f",{row.partition(',')[2]}" for row in rows[1:])]
    (folder / "run0.csv").write_text("\n".join(empty) + "\n")
    assert "Read 0 rows" in str(rr.lint(folder)[0])


def test_times_that_repeat_are_told(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=2.0)
    table = np.loadtxt(folder / "run0.csv", delimiter=",", skiprows=1)
    table[50, 0] = table[49, 0]
    np.savetxt(folder / "run0.csv", table, "%.9g", ",", header="time,angle,motor", comments="")
    assert any("times repeat" in one.message for one in rr.lint(folder))


@pytest.mark.parametrize("machine", ["pendulum", "servo", "car"])
def test_schema(machine):
    schema = rr.schema("experiment", machine)
    assert "parameters" in schema["properties"]
    with pytest.raises(rr.InputError, match="servo"):
        rr.schema("experiment", "servoo")


def test_what_cannot_be_as_it_says_is_reported(tmp_path):
    folder = write(tmp_path, dry=0.0, runs=2, seconds=4.0)
    table = np.loadtxt(folder / "run0.csv", delimiter=",", skiprows=1)

    def said(spoiled):
        np.savetxt(folder / "run0.csv", spoiled, "%.9g", ",", header="time,angle,motor",
                   comments="")  # fmt: skip
        return " ".join(one.message for one in rr.lint(folder))

    assert "function of" not in said(table)
    assert "to the last digit" not in said(table)
    spoiled = table.copy()
    spoiled[:, 2] = -0.3 * np.sin(np.radians(table[:, 1]))
    assert "u is a function of q" in said(spoiled)
    spoiled = table.copy()
    fast = int(np.argmax(np.abs(table[40:, 1] - table[:-40, 1])))
    spoiled[fast : fast + 40, 1] = spoiled[fast, 1]
    assert "to the last digit" in said(spoiled)
