"""diagnose reads a folder, tells what was found, and writes what the other verbs read."""

import json
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import rollout
from tests.cli.test_interrupt import PROGRAM, interrupted
from tests.robots import BENCHMARK
from tests.sysid.bad_data.folder import HEAD

GAITS = ((0.5, 1.0, 0.0), (0.7, 1.2, 0.1), (0.4, 0.8, -0.1))
KEYS = {"verdict", "summary", "location", "effects", "candidates", "remainder", "indistinguishable",
        "next_experiment", "fit", "doubts", "left_out", "version", "input_sha256"}  # fmt: skip


def entry(number, use="fit"):
    a, period, offset = GAITS[number]
    gait = f"{{amplitude: {a}, period: {period}, offset: {offset}}}"
    return f"  - {{file: run{number}.csv, gait: {gait}, use: {use}}}\n"


def columns(number, seconds):
    driven = rollout(BENCHMARK, SineGait(*GAITS[number]), seconds, "steady", 50)
    rng = np.random.default_rng(number)
    seen = [driven.x, driven.y, driven.psi, driven.phi]
    sizes = (1e-3, 1e-3, 3e-3, 3e-3)
    noisy = [y + size * rng.normal(size=y.size) for y, size in zip(seen, sizes, strict=True)]
    return np.column_stack([driven.t, *noisy])


def write(folder, tables, uses):
    folder.mkdir(exist_ok=True)
    text = HEAD + "".join(entry(k, use) for k, use in enumerate(uses))
    (folder / "experiment.yaml").write_text(text)
    for k, table in enumerate(tables):
        np.savetxt(folder / f"run{k}.csv", table, fmt="%.6f", delimiter=",",
                   header="t,x,y,psi,phi", comments="")  # fmt: skip
    return str(folder)


@pytest.fixture(scope="module")
def tables():
    return [columns(k, 8) for k in range(3)]


@pytest.fixture
def folder(tables, tmp_path):
    return write(tmp_path / "trial", tables, ("fit", "holdout", "fit"))


def test_recordings_of_the_model_itself(run, folder, tmp_path):
    done = run("diagnose", folder, "--out", "res")
    assert done.exit_code == 0, done.stderr
    assert done.stdout.startswith("verdict")
    assert "consistent" in done.stdout.splitlines()[0]
    out = tmp_path / "res"
    reported = json.loads((out / "diagnosis.json").read_text())
    assert set(reported) >= KEYS
    assert reported["verdict"] == "consistent"
    assert reported["effects"] == []
    assert 0.9 < reported["fit"]["heldout_rms_after"] < 1.1
    assert reported["fit"]["heldout_recordings"] == ["run1.csv"]
    assert (out / "report.html").read_text().startswith("<!DOCTYPE html>")
    assert {"paths.svg", "bands.svg", "misfit.svg"} <= {path.name for path in out.iterdir()}
    # The other verbs read the corrected robot.
    assert run("lint", "res/robot-corrected.yaml").exit_code == 0
    driven = run("simulate", "res/robot-corrected.yaml", "--seconds", "1", "--out", "sim")
    assert driven.exit_code == 0, driven.stderr


def test_json_alone_and_no_page(run, folder, tmp_path):
    done = run("diagnose", folder, "--out", "res", "--json", "--no-page")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout) == json.loads((tmp_path / "res/diagnosis.json").read_text())
    names = {path.name for path in (tmp_path / "res").iterdir()}
    assert names == {"diagnosis.json", "robot-corrected.yaml"}


def test_fits_that_end_nowhere(run, folder, monkeypatch, tmp_path):
    from rr_opt.sysid import diagnose as module
    from tests.report.diagnosis.conftest import _experiment, _found

    found = replace(_found(_experiment()), after=float("nan"))
    monkeypatch.setattr(module, "diagnose", lambda *_: found)
    done = run("diagnose", folder, "--out", "res")
    assert done.exit_code == 4
    assert "did not converge" in done.stderr
    assert not (tmp_path / "res").exists()


def still(table):
    return np.column_stack([table[:, 0], table[:, 1:] - table[:, 1:] + 0.001])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda table: table[:60], "too short"),
        (still, "does not move"),
        (lambda table: table * [1, 1000, 1000, 1, 1], "millimetres"),
        (lambda table: table * [1, 1, 1, 57.3, 57.3], "degrees"),
        (lambda table: np.where(np.arange(5) == 3, np.nan, table), "psi"),
    ],
)
def test_recordings_that_cannot_tell_are_refused(run, tables, tmp_path, change, said):
    source = write(tmp_path / "trial", [change(table) for table in tables], ("fit",) * 3)
    done = run("diagnose", source, "--out", "res")
    assert done.exit_code == 2, done.stdout
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "res").exists()


def test_one_recording_that_cannot_tell_is_left_out(tables, tmp_path):
    from rr_opt.recordings.experiment import read_experiment, usable

    write(tmp_path / "trial", [tables[0], tables[1][:60], tables[2]], ("fit",) * 3)
    experiment, reported = usable(read_experiment(tmp_path / "trial"))
    assert [one.name for one in experiment.runs] == ["run0.csv", "run2.csv"]
    assert len(reported) == 1
    assert reported[0].startswith("run1.csv: ")


def test_wrong_folders_end_with_a_message(run, tables, tmp_path):
    (tmp_path / "empty").mkdir()
    held = write(tmp_path / "held", tables, ("holdout",) * 3)
    for source, said in (("empty", "experiment.yaml"), ("none", "none"), (held, "held out")):
        done = run("diagnose", source)
        assert done.exit_code == 2, source
        assert said in done.stderr
        assert "Traceback" not in done.stderr


def test_interrupted_it_exits_130(folder, tmp_path):
    code, stdout, stderr = interrupted(
        PROGRAM,
        ["diagnose", folder, "--out", "res"],
        tmp_path,
        after="fitting the parameters",
        delay=0.2,
    )
    assert code == 130, stderr
    assert "Traceback" not in stderr
    assert not stdout
    assert not (tmp_path / "res").exists()
