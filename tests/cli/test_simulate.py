"""simulate drives a gait and leaves trajectory, figure and film."""

import csv
import json

import numpy as np
import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import gait_record, robot_record
from rr_opt.formatting import number, speed_text
from rr_opt.model.problem import Limits
from rr_opt.verify.replay import replay
from tests.motion.gaits import EVERY, FREE

COLUMNS = ["t [s]", "x [m]", "y [m]", "psi [rad]", "phi [rad]", "v [m/s]", "torque [N m]"]


def rows(path):
    with path.open() as file:
        return list(csv.reader(file))


def test_trajectory_has_its_columns_and_rate(run, tmp_path):
    done = run("simulate", "--seconds", "0.5", "--rate", "200", "--out", "res")
    assert done.exit_code == 0, done.stderr
    table = rows(tmp_path / "res" / "trajectory.csv")
    assert table[0] == COLUMNS
    assert len(table) == 102
    assert float(table[2][0]) == pytest.approx(0.005)
    assert {path.name for path in (tmp_path / "res").iterdir()} == {"trajectory.csv", "motion.svg"}


def test_options_take_units(run, tmp_path):
    run("simulate", "--offset", "10 deg", "--period", "800 ms", "--seconds", "0.1", "--out", "res")
    table = rows(tmp_path / "res" / "trajectory.csv")
    assert float(table[1][4]) == pytest.approx(0.17453, abs=1e-4)


def test_rest_and_steady_start_as_named(run, tmp_path):
    first = {}
    for start in ("rest", "steady"):
        run("simulate", "--seconds", "0.1", "--start", start, "--out", start)
        first[start] = float(rows(tmp_path / start / "trajectory.csv")[1][5])
    assert first["rest"] == 0
    assert first["steady"] < -0.01


def test_a_gait_beyond_the_servo_is_reported(run):
    done = run("simulate", "--period", "0.5", "--seconds", "0.1")
    assert "rate limit" in done.stderr
    assert done.exit_code == 0


def test_a_result_brings_its_robot_and_gait(run, quick, tmp_path):
    run("maximize-speed", str(quick), "--out", "res", "--no-figures")
    gait = json.loads((tmp_path / "res" / "result.json").read_text())["gait"]
    done = run("simulate", "res/result.json", "--seconds", "1", "--start", "steady")
    assert done.exit_code == 0, done.stderr
    table = rows(tmp_path / "out" / "res-motion" / "trajectory.csv")
    quarter = float(table[26][4])
    assert quarter == pytest.approx(gait["amplitude"], rel=1e-3)


@pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)
def test_a_result_of_any_shape(run, tmp_path, gait):
    robot = robot_record(read_problem(None).robot)
    record = {"status": "optimal", "input_sha256": "0", "gait": gait_record(gait), "robot": robot}
    (tmp_path / "result.json").write_text(json.dumps(record))
    done = run("simulate", "result.json", "--seconds", "1", "--out", "res", "--json")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["gait"] == gait_record(gait)
    t, _, _, _, phi, *_ = np.array(rows(tmp_path / "res" / "trajectory.csv")[1:], float).T
    assert phi == pytest.approx(gait.angle(t), abs=1e-8)


def test_speeds_are_named_and_the_torque_is_the_true_peak(run, tmp_path):
    # One sample a period sees one torque alone.
    robot = robot_record(read_problem(None).robot)
    record = {"status": "optimal", "input_sha256": "0", "gait": gait_record(FREE), "robot": robot}
    (tmp_path / "result.json").write_text(json.dumps(record))
    arguments = ("simulate", "result.json", "--seconds", "28", "--rate", str(1 / FREE.period))
    reported = json.loads(run(*arguments, "--start", "steady", "--json").stdout)
    seen = replay(read_problem(None).robot, FREE, Limits(3.0, 9.0, 9.0), 1.0)
    assert reported["peak_torque"] == pytest.approx(seen.reached["torque"], rel=1e-4)
    assert reported["last_circle_speed"] == pytest.approx(seen.speed, rel=1e-6)
    assert reported["last_speed"] == pytest.approx(np.mean(seen.steady.v[:-1]), rel=1e-4)
    printed = run(*arguments, "--start", "steady").stdout
    assert f"{number(seen.reached['torque'])} N m at most" in printed
    assert f"{speed_text(seen.speed)}, along the mean circle of the last period" in printed
    assert "mean v of axle 1 over the last period" in printed


def test_less_than_a_period_has_no_circle(run):
    arguments = ("simulate", "--period", "2", "--seconds", "1.9")
    reported = json.loads(run(*arguments, "--json").stdout)
    assert reported["last_circle_speed"] is None
    assert "mean v of axle 1, less than a period" in run(*arguments).stdout


def test_torque_between_the_samples_is_compared_the_servo(run):
    done = run("simulate", "--amplitude", "1", "--period", "0.2", "--seconds", "1", "--rate", "5")
    assert "the servo's torque limit" in done.stderr


def test_a_wrong_gait_of_a_result_is_reported(run, tmp_path):
    robot = robot_record(read_problem(None).robot)
    record = {"status": "optimal", "input_sha256": "0", "gait": {"shape": "fre"}, "robot": robot}
    (tmp_path / "result.json").write_text(json.dumps(record))
    done = run("simulate", "result.json")
    assert done.exit_code == 2
    assert done.stderr == (
        "result.json: gait.shape: Read the word 'fre'. Expected one of: sine, fourier, free. "
        "Did you mean `free`?\n"
    )


def test_film_shows_every_moment(run, tmp_path):
    image = pytest.importorskip("PIL.Image")
    done = run("simulate", "--seconds", "0.3", "--animate", "gif", "--out", "res")
    assert done.exit_code == 0, done.stderr
    with image.open(tmp_path / "res" / "motion.gif") as film:
        assert film.n_frames == 7


def test_mp4_without_ffmpeg_says_what_to_do(run, monkeypatch):
    monkeypatch.setenv("PATH", "")
    done = run("simulate", "--animate", "mp4")
    assert done.exit_code == 2
    assert "ffmpeg" in done.stderr
    assert "gif" in done.stderr


def test_netcdf_without_its_libraries_says_what_to_do(run, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "h5netcdf", None)
    done = run("simulate", "--format", "netcdf")
    assert done.exit_code == 2
    assert "rr-opt[netcdf]" in done.stderr


def test_netcdf_carries_units(run, tmp_path):
    pytest.importorskip("h5py")
    xarray = pytest.importorskip("xarray")
    done = run("simulate", "--seconds", "0.2", "--format", "netcdf", "--out", "res")
    assert done.exit_code == 0, done.stderr
    with xarray.open_dataset(tmp_path / "res" / "trajectory.nc", engine="h5netcdf") as data:
        assert data["torque"].attrs["units"] == "N m"
        assert data.sizes["t"] == 21
