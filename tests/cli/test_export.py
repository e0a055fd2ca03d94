"""export writes a gait as set points and tells what they cost."""

import csv
import json
import math

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
    ("kind", "name", "change"),
    [
        ("csv", "mine-angles.csv", "+1.33 %"),
        ("servo", "mine-counts.csv", "+0.37 %"),
        ("c-header", "mine.h", "+1.33 %"),
    ],
)
def test_every_format_of_a_result(run, result, tmp_path, kind, name, change):
    done = run("export", result(SineGait(0.15, 0.3)), "--format", kind)
    assert done.exit_code == 0, done.stderr
    assert {path.name for path in (tmp_path / "out").iterdir()} == {name}
    assert f"changed from 0.3 s ({change})" in done.stdout
    assert "holding" in done.stdout
    assert ("rounding" in done.stdout) == (kind == "servo")


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_every_shape(run, result, tmp_path, gait):
    options = ("--rate", "100", "--no-within-limits", "--out", "below/a.csv", "--json")
    done = run("export", result(gait), *options)
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
    sizes = ("--amplitude", "30 deg", "--period", "800 ms")
    done = run("export", *sizes, "--no-within-limits", "--out", "a.csv")
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
    done = run("export", result(SineGait(0.5, 0.3)), "--no-within-limits")
    assert done.exit_code == 0
    assert "warning: A step between set points needs" in done.stderr


def test_a_gait_beyond_the_limits_is_lowered(run, result):
    # 0.5 rad in 0.3 s are 100 rpm of 30.
    done = run("export", result(SineGait(0.5, 0.3)), "--keep-period", "--json")
    assert json.loads(done.stdout)["amplitude"] == pytest.approx(0.15, rel=1e-2)
    assert "warning" not in done.stderr


def test_a_changed_period_lowers_the_amplitude_to_stay_within_the_limits(run, result):
    # 47.4 set points a period become 47: 1 % faster, at a servo's full rate.
    gait = SineGait(math.pi * 0.379 / (2 * math.pi), 0.379)
    asked = (run("export", result(gait), "--json", *more) for more in ((), ("--no-within-limits",)))
    kept, broken = asked
    assert json.loads(broken.stdout)["amplitude"] == gait.amplitude
    assert "warning: A step between set points needs" in broken.stderr
    lowered = json.loads(kept.stdout)
    assert "warning" not in kept.stderr
    assert lowered["amplitude"] * 2 * math.pi / lowered["period"] == pytest.approx(
        math.pi, rel=5e-4
    )
    assert abs(lowered["speed_left"]) < abs(json.loads(broken.stdout)["speed_left"])


def test_steps_between_counts_are_within_the_limits(run, result, tmp_path):
    def steps(*more):
        options = ("--format", "servo", *more, "--out", "a.csv", "--json")
        done = run("export", result(SineGait(0.15, 0.3)), *options)
        counts = [int(row[1]) for row in rows(tmp_path / "a.csv")[1:]]
        most = max(abs(b - a) for a, b in zip(counts, counts[1:] + counts[:1], strict=True))
        return most, json.loads(done.stdout)["amplitude"], done.stderr

    # 30 rpm are 4.9 counts in 8 ms, and 5 in 8.14 ms.
    most, amplitude, said = steps()
    assert (most, amplitude, "warning" in said) == (5, 0.15, False)
    most, amplitude, said = steps("--rate", "125")
    assert (most, amplitude < 0.15, "warning" in said) == (4, True, False)
    most, amplitude, said = steps("--rate", "125", "--no-within-limits")
    assert (most, amplitude, "lags by up to 1.734 mrad" in said) == (5, 0.15, True)


def test_the_limits_of_a_result_are_those_of_its_problem(run, result, tmp_path):
    # As it is at 30 rpm, of a problem that allows 15: its own, not the servo's.
    gait = SineGait(math.pi / 2 * 0.379 / (2 * math.pi), 0.379)
    path = tmp_path / result(gait)
    record = json.loads(path.read_text())
    limits = {"angle": 2.6, "rate": math.pi / 2, "torque": None, "singularity": 0.02, "grip": None}
    record["limits"] = [{"name": name, "limit": limit} for name, limit in limits.items()]
    path.write_text(json.dumps(record))
    done = run("export", "mine/result.json", "--json")
    assert json.loads(done.stdout)["amplitude"] < 0.995 * gait.amplitude


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


def test_a_place_that_cannot_be_written_is_told_by_its_own_name(run, result, tmp_path):
    (tmp_path / "a.csv").symlink_to("b.csv")
    done = run("export", result(SineGait(0.15, 1.0)), "--out", "a.csv")
    assert done.exit_code == 2
    assert done.stderr.splitlines()[-1].startswith("a.csv is a symbolic link.")
