"""export writes a gait as set points and tells what they cost."""

import csv
import json

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import gait_record, robot_record
from rr_opt.model.gait import SineGait
from tests.motion.gaits import EVERY


@pytest.fixture
def result(tmp_path):
    """Writes a result of a gait, as maximize-speed leaves it."""

    def write(gait):
        (tmp_path / "mine").mkdir(exist_ok=True)
        record = {
            "status": "optimal",
            "input_sha256": "0" * 64,
            "gait": gait_record(gait),
            "robot": robot_record(read_problem(None).robot),
        }
        (tmp_path / "mine" / "result.json").write_text(json.dumps(record))
        return "mine/result.json"

    return write


def rows(path):
    with path.open() as file:
        return list(csv.reader(file))


@pytest.mark.parametrize(
    ("kind", "name"),
    [("csv", "mine-angles.csv"), ("servo", "mine-counts.csv"), ("c-header", "mine.h")],
)
def test_every_format_of_a_result(run, result, tmp_path, kind, name):
    done = run("export", result(SineGait(0.15, 0.3)), "--format", kind)
    assert done.exit_code == 0, done.stderr
    assert {path.name for path in (tmp_path / "out").iterdir()} == {name}
    assert "changed from 0.3 s (+1.33 %)" in done.stdout
    assert "holding" in done.stdout
    assert ("rounding" in done.stdout) == (kind == "servo")


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_every_shape(run, result, tmp_path, gait):
    done = run("export", result(gait), "--rate", "100", "--out", "below/a.csv", "--json")
    assert done.exit_code == 0, done.stderr
    reported = json.loads(done.stdout)
    assert reported["gait"] == gait_record(gait)
    assert reported["points"] == 140
    change = reported["speed_left"] - reported["speed"]
    sign = 1 if reported["speed"] > 0 else -1
    assert reported["cost"]["period"] + reported["cost"]["holding"] == pytest.approx(sign * change)
    assert reported["cost"]["rounding"] is None
    table = rows(tmp_path / "below" / "a.csv")
    assert len(table) == 141
    assert float(table[8][1]) == pytest.approx(float(gait.angle(0.07)), abs=1e-8)


def test_options_as_those_of_simulate(run, tmp_path):
    done = run("export", "--amplitude", "30 deg", "--period", "800 ms", "--out", "a.csv")
    assert done.exit_code == 0, done.stderr
    table = rows(tmp_path / "a.csv")
    assert len(table) == 101
    assert float(table[26][2]) == pytest.approx(30.0, abs=1e-6)


def test_keeping_the_period_changes_the_rate(run, result):
    done = run("export", result(SineGait(0.15, 0.3)), "--keep-period", "--json")
    reported = json.loads(done.stdout)
    assert reported["period"] == 0.3
    assert reported["rate"] == pytest.approx(38 / 0.3)
    assert reported["cost"]["period"] == 0


def test_steps_too_fast_for_the_servo_are_reported(run, result):
    done = run("export", result(SineGait(0.5, 0.3)))
    assert done.exit_code == 0
    assert "warning: A step between set points needs" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("--amplitude", "2.7", "--format", "servo"), "154.7 degrees"),
        (("--amplitude", "2.5"), "singular"),
        (("--amplitude", "-1", "--rate", "-5"), "--rate: Read -5"),
        (("--rate", "3"), "--rate: 3 set points a second"),
        (("--out", ""), "--out: Read an empty name"),
        (("--out", "."), "is a folder"),
        (("--amplitude", "0"), "Read a gait with the amplitude 0."),
        (("--amplitude", "0 deg", "--keep-period", "--format", "servo"), "amplitude 0."),
    ],
)
def test_wrong_input_writes_nothing(run, tmp_path, arguments, word):
    done = run("export", *arguments)
    assert done.exit_code == 2, done.output
    assert word in done.stderr
    assert not done.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_a_gait_that_does_not_move_is_refused(run, result, tmp_path, gait):
    done = run("export", result(gait), "--amplitude", "0")
    assert done.exit_code == 2
    assert "Read a gait with the amplitude 0. Expected one that moves" in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_without_a_problem_is_reported_what_is_expected(run, result, tmp_path):
    (tmp_path / "empty").mkdir()
    expected = (
        "This is a folder without problem.yaml. Expected a result.json, a robot file, a problem "
        "file or its folder. Give "
    )
    done = run("export", "empty")
    assert (done.exit_code, done.stderr) == (2, f"empty: {expected}one of them.\n")
    result(EVERY["sine"])
    done = run("export", "mine")
    assert (done.exit_code, done.stderr) == (2, f"mine: {expected}mine/result.json.\n")
