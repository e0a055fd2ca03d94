"""A folder becomes an experiment, whatever its recordings are, or all its mistakes are told."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_opt.files.issue import InvalidFileError
from rr_opt.model.gait import SineGait
from rr_opt.recordings.experiment import experiment_of, read_experiment
from rr_opt.recordings.inspection import read_layout
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.netcdf import to_dataset, write_netcdf

HEAD = """\
robot:
  platform1: {m: 0.469, I: 0.00386, c: 0.206, a: 0.02, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.250, I: 0.00175, c: 0.0641, a: 0.02, b: 0.05, kappa: 2.0e-5}
  h: 0.02
noise: {position: 0.001, angle: 0.003}
"""
MARKERS = """\
markers:
  platform1: {A: [0, 20 mm], B: [206 mm, 0], C: [100 mm, -30 mm]}
  platform2: {D: [-64.1 mm, 0], E: [-20 mm, 25 mm], F: [-90 mm, -10 mm]}
"""
PLACES = {
    "A": (1, 0.0, 0.02), "B": (1, 0.206, 0.0), "C": (1, 0.1, -0.03),
    "D": (2, -0.0641, 0.0), "E": (2, -0.02, 0.025), "F": (2, -0.09, -0.01),
}  # fmt: skip
GAIT = "gait: {amplitude: 0.5, period: 1.0, offset: 0.1}"


def motion(n=300):
    """t, x, y, psi, phi at 100 Hz, noise-free, of wheels that roll at 0.1 m/s."""
    t = np.arange(n) / 100
    fine = np.linspace(0, t[-1], 20 * n + 1)

    def angle(t):
        return 0.5 * np.sin(2 * np.pi * t) + 0.1

    c1, c2, v = 0.206, 0.0641, 0.1
    phi, rate = angle(fine), np.pi * np.cos(2 * np.pi * fine)
    turn = -(v * np.sin(phi) + c2 * rate) / (c1 * np.cos(phi) + c2)
    psi = 0.7 + cumulative_trapezoid(turn, fine, initial=0)
    speed = (v - 1j * c1 * turn) * np.exp(1j * psi)
    place = 0.3 - 0.2j + cumulative_trapezoid(speed, fine, initial=0)
    place, psi = np.interp(t, fine, place), np.interp(t, fine, psi)
    return t, place.real, place.imag, psi, angle(t)


def plain(moved, noise=1.0):
    rng = np.random.default_rng(3)
    sigma = noise * np.array([0, 1e-3, 1e-3, 3e-3, 3e-3])
    rows = np.column_stack(moved) + sigma * rng.normal(size=(len(moved[0]), 5))
    return "t,x,y,psi,phi\n" + "".join(",".join(f"{v:.6f}" for v in row) + "\n" for row in rows)


def vicon(moved, subject="", places=PLACES):
    """Markers where the definition of the frames puts them: from P along and left of each axis."""
    _, x, y, psi, phi = moved
    names = ",,,".join(f"{subject}{one}" for one in places)
    lines = ["Trajectories", "100", f",,{names},,", "Frame,Sub Frame" + ",X,Y,Z" * len(places)]
    lines.append("," + ",mm,mm,mm" * len(places))
    for k in range(len(x)):
        cells = [str(k + 1), "0"]
        for platform, forward, left in places.values():
            turn = psi[k] + (phi[k] if platform == 2 else 0)
            seen = complex(x[k], y[k]) + complex(forward, left) * np.exp(1j * turn)
            cells += [f"{1000 * seen.real:.4f}", f"{1000 * seen.imag:.4f}", "50"]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def test_plain_recordings(write, tmp_path):
    moved = motion()
    write(plain(moved), "one.csv")
    write(plain(moved).replace("\n0.050000,0.3", "\n0.050000,9.3"), "two.csv")
    write(
        f"{HEAD}recordings:\n- {{file: one.csv, {GAIT}, start: rest}}\n"
        f"- {{file: two.csv, {GAIT}, use: holdout}}\n",
        "experiment.yaml",
    )
    experiment = read_experiment(tmp_path)
    assert experiment.name == tmp_path.name
    assert experiment.robot.platform1.c == 0.206
    assert experiment.uncertainty["m1"].sigma == pytest.approx(0.00469)
    one, two = experiment.runs
    assert (one.name, one.use, one.start) == ("one.csv", "fit", "rest")
    assert (two.name, two.use, two.start) == ("two.csv", "holdout", "running")
    assert one.gait == SineGait(0.5, 1.0, 0.1)
    np.testing.assert_allclose(one.recording.values["psi"], moved[3], atol=0.02)
    assert set(one.recording.sigma["x"]) == {0.001}
    assert np.flatnonzero(two.recording.flags["x"]).tolist() == [5]


@pytest.mark.parametrize(("subject", "named"), [("", ""), ("RR:", ""), ("RR:", "RR:")])
def test_markers_give_the_motion_that_put_them_there(write, tmp_path, subject, named):
    moved = motion()
    write(vicon(moved, subject), "one.csv")
    layout = re.sub(r"\b([A-F]): \[", rf"{named}\1: [", MARKERS)
    write(f"{HEAD}{layout}recordings:\n- {{file: one.csv, {GAIT}}}\n", "experiment.yaml")
    (run,) = read_experiment(tmp_path).runs
    for name, true in zip(["t", "x", "y", "psi", "phi"], moved, strict=True):
        read = run.recording.t if name == "t" else run.recording.values[name]
        np.testing.assert_allclose(read, true, atol=2e-4)


def test_netcdf_and_a_servo_log(write, tmp_path):
    run = read_file(write(plain(motion()), "one.csv"))
    write_netcdf(tmp_path / "one.nc", run)
    write("t,goal,present\n0,512,512\n0.004,513,512\n", "log.csv")
    write(f"{HEAD}recordings:\n- {{file: one.nc, {GAIT}, servo_log: log.csv}}\n", "experiment.yaml")
    (made,) = read_experiment(tmp_path).runs
    np.testing.assert_array_equal(made.recording.values["x"], run.values["x"])
    assert "have no motion in common" in " ".join(made.recording.doubts)


@pytest.mark.parametrize(("amplitude", "warned"), [(0.5, False), (0.6, True)])
def test_a_file_that_says_another_command_is_told(write, tmp_path, amplitude, warned):
    run = read_file(write(plain(motion(20)), "one.csv"))
    write_netcdf(tmp_path / "one.nc", run, SineGait(amplitude, 1.0, 0.1))
    write(f"{HEAD}recordings:\n- {{file: one.nc, {GAIT}}}\n", "experiment.yaml")
    _, issues = experiment_of(tmp_path)
    assert ("recordings[0].gait" in [issue.path for issue in issues]) is warned


def test_a_command_that_cannot_be_read_is_a_mistake(write, tmp_path):
    run = read_file(write(plain(motion(20)), "one.csv"))
    data = to_dataset(run, SineGait(0.5, 1.0, 0.1)).assign_attrs(gait='{"shape": "square"}')
    data.to_netcdf(tmp_path / "one.nc", engine="h5netcdf")
    write(f"{HEAD}recordings:\n- {{file: one.nc, {GAIT}}}\n", "experiment.yaml")
    with pytest.raises(InvalidFileError, match="Read the word 'square'"):
        read_experiment(tmp_path)


def test_every_mistake_of_every_file_at_once(write, tmp_path):
    good = plain(motion(20))
    files = {
        "good.csv": good,
        "bad.csv": good.replace("\n0.050000,", "\n0.050000,?"),
        "markers.csv": vicon(motion(20)),
        "log.csv": "t,goal\n0,1\n0.004,1\n",
    }
    for name, text in files.items():
        write(text, name)
    runs = ("bad.csv", "markers.csv", "log.csv", "good.csv, servo_log: bad2.csv")
    write(good.replace("phi", "fi"), "bad2.csv")
    entries = "".join(f"- {{file: {name}, {GAIT}}}\n" for name in runs)
    write(f"{HEAD}recordings:\n{entries}", "experiment.yaml")
    with pytest.raises(InvalidFileError) as caught:
        read_experiment(tmp_path)
    told = [
        (issue.file.removeprefix(f"{tmp_path}/"), issue.line, issue.path)
        for issue in caught.value.issues
        if issue.level == "error"
    ]
    assert told == [
        ("bad.csv", 7, ""),
        ("experiment.yaml", 9, "recordings[2].file"),
        ("bad2.csv", 1, ""),
        ("experiment.yaml", 8, "recordings[1].file"),
    ]


def test_recordings_are_read_even_if_their_experiment_is_wrong(write, tmp_path):
    write(plain(motion(20)).replace("\n0.050000,", "\n0.050000,?"), "bad.csv")
    write(f"{HEAD}speed: 1\nrecordings:\n- {{file: bad.csv, {GAIT}}}\n", "experiment.yaml")
    _, issues = experiment_of(tmp_path)
    assert [issue.line for issue in issues if issue.level == "error"] == [6, 7]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda text: text.replace("D:", "G:").replace("E:", "H:").replace("F:", "I:"),
            "platform2",
        ),
        (lambda text: text.replace(MARKERS, ""), "Expected `markers`"),
    ],
)
def test_markers_that_are_not_known(write, tmp_path, change, message):
    write(vicon(motion(20)), "one.csv")
    text = f"{HEAD}{MARKERS}recordings:\n- {{file: one.csv, {GAIT}}}\n"
    write(change(text), "experiment.yaml")
    with pytest.raises(InvalidFileError, match=message):
        read_experiment(tmp_path)


@pytest.mark.parametrize("given", ["", "none", "[A, B]"])
def test_a_layout_without_places_is_refused(write, given):
    with pytest.raises(InvalidFileError, match="Expected `platform1` and `platform2`"):
        read_layout(write(f"markers: {given}\n", "layout.yaml"))


def test_doubts_are_warnings(write, tmp_path):
    text = plain(motion(20))
    line = text.splitlines()[7]
    write(text.replace(f"{line}\n", ""), "one.csv")
    write(f"{HEAD}recordings:\n- {{file: one.csv, {GAIT}}}\n", "experiment.yaml")
    experiment, issues = experiment_of(tmp_path)
    assert experiment is not None
    told = [str(issue) for issue in issues]
    assert any("one.csv: warning: The time jumps once" in one for one in told)


def lint(*arguments):
    return CliRunner().invoke(app, ["lint", *map(str, arguments)])


def test_lint_reads_the_recordings_too(write, tmp_path):
    write(plain(motion(20)), "one.csv")
    write(plain(motion(20)), "two.csv")
    write(
        f"{HEAD}recordings:\n- {{file: one.csv, {GAIT}}}\n"
        f"- {{file: two.csv, {GAIT}, use: holdout}}\n",
        "experiment.yaml",
    )
    done = lint(tmp_path)
    assert done.exit_code == 2
    assert "No recording is left to fit" in done.stdout
    short = [line.split(": ")[2] for line in done.stdout.splitlines() if "too short" in line]
    assert short == ["one.csv", "two.csv"]
    write("t,x,y,psi,phi\n0,1,2,3,4\n1,a,2,3,4\n", "two.csv")
    done = lint(tmp_path)
    assert done.exit_code == 2
    assert f"{tmp_path}/two.csv:3: Read 'a' in column 2 (x)." in done.stdout
    done = lint("--json", tmp_path / "experiment.yaml")
    (issue,) = json.loads(done.stdout)["issues"]
    assert (issue["line"], issue["file"]) == (3, f"{tmp_path}/two.csv")


def test_a_heading_that_is_kept_within_a_turn_is_right_for_all_verbs(write, tmp_path):
    t, x, y, psi, phi = motion(600)
    more = np.pi - 0.7
    wrapped = (psi + more + np.pi) % (2 * np.pi) - np.pi
    turned = (x + 1j * y) * np.exp(1j * more)
    write(plain((t, turned.real, turned.imag, wrapped, phi)), "one.csv")
    write(f"{HEAD}recordings:\n- {{file: one.csv, {GAIT}}}\n", "experiment.yaml")
    experiment, issues = experiment_of(tmp_path)
    assert experiment is not None
    assert np.abs(np.diff(experiment.runs[0].recording.values["psi"])).max() < 0.1
    assert any("jumps by a whole turn" in issue.message for issue in issues)
    assert "degrees" not in lint(tmp_path).stdout
