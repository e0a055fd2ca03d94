"""inspect reads a recording, tells every doubt, and writes the record and one page of figures."""

import json
import re

import numpy as np
import pytest

from tests.recordings.clean.world import GAIT, LAYOUT, markers, motion

PLACES = {"platform1": dict(LAYOUT.platform1), "platform2": dict(LAYOUT.platform2)}
EXPERIMENT = """
robot:
  platform1: {m: 0.469, I: 0.00386, c: 0.206, a: 0.020, b: 0.050, kappa: 2.0e-5}
  platform2: {m: 0.250, I: 0.00175, c: 0.0641, a: 0.020, b: 0.050, kappa: 2.0e-5}
  h: 0.020
noise: {position: 0.001, angle: 0.003}
recordings:
  - {file: run01.csv, gait: {amplitude: 0.7, period: 1.0, offset: 0.1}, start: rest}
  - {file: run02.csv, gait: {amplitude: 0.7, period: 1.0, offset: 0.1}, use: holdout, start: rest}
"""


def write_plain(path, seed=0, lag=0.0):
    """The motion, all of it late against the command."""
    moved, rng = motion(), np.random.default_rng(seed)
    t = moved.t[moved.t < moved.t[-1] + lag]
    columns = [t, *(np.interp(t - lag, moved.t, one) for one in (moved.x, moved.y, moved.psi))]
    columns.append(GAIT.angle(np.maximum(t - lag, 0)))
    noise = (0, 1e-3, 1e-3, 3e-3, 3e-3)
    columns = [one + rng.normal(0, 1, len(one)) * size for one, size in zip(columns, noise,
               strict=True)]  # fmt: skip
    lines = [",".join(f"{value:.6f}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("t,x,y,psi,phi\n" + "\n".join(lines) + "\n")


def write_vicon(path):
    """Nexus's layout by hand, mm, with a swap, a gap and a ghost."""
    data = markers(motion(), 5e-4, 0)
    p = 1e3 * data.positions
    p[500:900, [0, 1]] = p[500:900, [1, 0]]
    p[321, 6, 0] += 40
    p[1600:1630] = np.nan
    head = [
        "Trajectories",
        "100",
        ",," + ",,,".join(f"RR:{name}" for name in data.labels) + ",,",
        "Frame,Sub Frame," + ",".join("X,Y,Z" for _ in data.labels),
        ",," + ",".join("mm,mm,mm" for _ in data.labels),
    ]
    rows = [
        f"{i + 1},0," + ",".join("" if np.isnan(v) else f"{v:.4f}" for v in row.ravel())
        for i, row in enumerate(p)
    ]
    path.write_text("\n".join([*head, *rows]) + "\n")


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "trial"
    made.mkdir()
    (made / "experiment.yaml").write_text(EXPERIMENT)
    write_plain(made / "run01.csv", 1)
    write_plain(made / "run02.csv", 2, lag=0.038)
    return made


def test_an_experiment_is_inspected_run_by_run(run, folder, tmp_path):
    done = run("inspect", str(folder), "--out", "res")
    assert done.exit_code == 0, done.stderr
    first, second = done.stdout.split("\nrun02.csv\n")
    assert "\nrun01.csv\n" in first
    assert "No warnings." in first
    assert re.search(r"phi lags its command by 3[78]", " ".join(second.split()))
    reported = json.loads((tmp_path / "res" / "inspection.json").read_text())
    command = reported["recordings"][1]["command"]["offset"]
    low, high = command["ci95"]
    assert low < -0.038 < high or abs(command["value"] + 0.038) < 5e-4
    page = (tmp_path / "res" / "report.html").read_text()
    assert page.count("data:image/svg+xml,") == 8
    assert "http://" not in page.replace("http://www.w3.org", "")


def test_a_marker_file_with_a_layout(run, tmp_path):
    write_vicon(tmp_path / "run.csv")
    (tmp_path / "layout.yaml").write_text(json.dumps({k: {n: list(p) for n, p in v.items()}
                                                      for k, v in PLACES.items()}))  # fmt: skip
    options = ("--layout", "layout.yaml", "--amplitude", "0.7", "--period", "1", "--offset", "0.1")
    done = run("inspect", "run.csv", *options, "--start", "rest", "--json", "--out", "res")
    assert done.exit_code == 0, done.stderr
    reported = json.loads(done.stdout)
    assert reported == json.loads((tmp_path / "res" / "inspection.json").read_text())
    (one,) = reported["recordings"]
    text = " ".join(one["doubts"])
    assert "L1 and R1 have swapped labels" in text
    assert "Marker T3 does not fit its platform" in text
    assert "t = 3.21 s" in text
    assert "no data for 0.31 s" in text
    assert abs(one["markers"]["noise"] / 5e-4 - 1) < 0.05
    assert abs(one["command"]["scale"]["value"] - 1) < 5e-3
    page = (tmp_path / "res" / "report.html").read_text()
    assert "Markers on rigid platforms" in page


def test_without_a_layout_it_is_estimated_and_reported(run, tmp_path):
    write_vicon(tmp_path / "run.csv")
    done = run("inspect", "run.csv", "--no-figures", "--out", "res")
    assert done.exit_code == 0, done.stderr
    assert "The layout was estimated from the recording" in " ".join(done.stdout.split())
    assert {path.name for path in (tmp_path / "res").iterdir()} == {"inspection.json"}


def test_netcdf_holds_the_recording_with_its_flags(run, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    write_vicon(tmp_path / "run.csv")
    done = run("inspect", "run.csv", "--no-figures", "--netcdf", "run.nc")
    assert done.exit_code == 0, done.stderr
    from rr_opt.recordings.readers import read_file

    read = read_file(tmp_path / "run.nc")
    assert len(read) == 3001
    assert (read.flags["phi"][1600:1630] == 1).all()


def test_a_servo_s_log_is_matched(run, tmp_path):
    write_plain(tmp_path / "run.csv")
    count = np.radians(300) / 1024
    when = np.arange(0, 30, 0.004)
    counts = np.round(GAIT.angle(when) / count) + 512
    rows = [f"{t + 7:.4f},{c:.0f},{c:.0f}" for t, c in zip(when, counts, strict=True)]
    (tmp_path / "log.csv").write_text("t,goal,present\n" + "\n".join(rows) + "\n")
    options = ("--servo-log", "log.csv", "--no-figures", "--json")
    done = run("inspect", "run.csv", *options)
    assert done.exit_code == 0, done.stderr
    (one,) = json.loads(done.stdout)["recordings"]
    low, high = one["servo_log"]["phi"]["offset"]["ci95"]
    assert low - 1e-3 < 7 < high + 1e-3
    assert one["servo_log"]["shift"] is None
    assert "requires `goal` and `present` in the log, and the gait" in " ".join(one["doubts"])


def test_with_log_and_gait_a_recording_goes_to_the_command_s_clock(run, tmp_path):
    # The recording's t is 0.2 s behind the command's clock, and the servo is 30 ms late.
    write_plain(tmp_path / "run.csv", lag=-0.17)
    count = np.radians(300) / 1024
    when = np.arange(0, 30, 0.004)
    goal, present = (np.round(GAIT.angle(when - late) / count) + 512 for late in (0, 0.03))
    rows = [f"{t + 7:.4f},{g:.0f},{p:.0f}" for t, g, p in zip(when, goal, present, strict=True)]
    (tmp_path / "log.csv").write_text("t,goal,present\n" + "\n".join(rows) + "\n")
    gait = ("--amplitude", "0.7", "--period", "1", "--offset", "0.1")
    done = run("inspect", "run.csv", "--servo-log", "log.csv", "--json", *gait)
    assert done.exit_code == 0, done.stderr
    (one,) = json.loads(done.stdout)["recordings"]
    shift = one["servo_log"]["shift"]
    assert shift["applied"]
    assert abs(shift["offset"]["value"] - 0.2) < 5e-4
    assert abs(one["start"] - 0.2) < 1e-3
    assert "the command's, by the servo's log" in one["source"]["clock"]
    text = " ".join(one["doubts"])
    assert "put on the command's clock" in text
    assert re.search("phi lags its command by (30|29.9) ms.*: servo delay, as", text)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--layout", "run.csv"), "run.csv"),
        (("--amplitude", "0.7"), "--period"),
        (("--amplitude", "7 kg", "--period", "1"), "--amplitude"),
        (("--servo-log", "run.csv"), "servo's log"),
        (("--servo-log", "none.csv"), "none.csv"),
    ],
)
def test_wrong_options_end_with_a_message(run, tmp_path, options, said):
    write_plain(tmp_path / "run.csv")
    done = run("inspect", "run.csv", *options)
    assert done.exit_code == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_wrong_files_end_with_a_message(run, tmp_path, folder):
    (tmp_path / "bad.csv").write_text("t,x,y\n1,2,3\n")
    (folder / "run02.csv").unlink()
    for source in ("bad.csv", "none.csv", str(folder), str(tmp_path)):
        done = run("inspect", source)
        assert done.exit_code == 2, source
        assert done.stderr.strip()
        assert "Traceback" not in done.stderr
    done = run("inspect", str(folder), "--netcdf", "x.nc")
    assert done.exit_code == 2
    assert "--netcdf" in done.stderr
