"""An experiment file is read whole: values in SI, and every mistake at once, each at its place."""

from __future__ import annotations

import math

import pytest

from rr_opt.files.experiment_file import named_files, read_plan
from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import FourierGait, SineGait

HEAD = """\
robot:
  platform1: {m: 0.469, I: 0.00386, c: 206 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
  platform2: {m: 0.250, I: 0.00175, c: 64.1 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
  h: 20 mm
noise: {position: 1 mm, angle: 3 mrad}
"""
RUNS = """\
recordings:
- {file: one.csv, gait: {amplitude: 30 deg, period: 1.2 s, offset: 0}, start: rest}
- {file: two.csv, gait: {amplitude: 0.5, period: 1, offset: 0.1}, use: holdout}
"""
MARKERS = """\
markers:
  platform1: {A: [40 mm, 0], B: [0.2, -30 mm, 12 mm]}
  platform2: {C: [-50 mm, 0], D: [-60 mm, 10 mm]}
"""


@pytest.fixture
def experiment(write):
    """A folder with the recordings named above and a file with this text."""
    for name in ("one.csv", "two.csv", "log.csv"):
        write("a\n", name)
    return lambda text: write(text, "experiment.yaml")


@pytest.fixture
def plan(experiment):
    return lambda text: read_plan(experiment(text))[0]


def issues(path):
    with pytest.raises(InvalidFileError) as caught:
        read_plan(path)
    errors = [issue for issue in caught.value.issues if issue.level == "error"]
    found = {issue.path: issue for issue in errors}
    assert len(found) == len(errors)
    return found


def test_what_was_done(plan, tmp_path):
    made = plan(HEAD + RUNS)
    assert made.robot.platform1.c == pytest.approx(0.206)
    assert (made.noise.position, made.noise.angle) == pytest.approx((1e-3, 3e-3))
    assert made.noise.torque == 0.003
    one, two = made.runs
    assert (one.file, two.file) == (tmp_path / "one.csv", tmp_path / "two.csv")
    assert one.gait == SineGait(pytest.approx(math.radians(30)), 1.2, 0.0)
    assert (one.use, one.start, one.servo_log) == ("fit", "rest", None)
    assert (two.use, two.start) == ("holdout", "running")
    assert made.markers is None
    assert (made.counts.counts, made.counts.zero) == (1024, 512)
    assert math.degrees(made.counts.range) == pytest.approx(300)
    assert made.name == tmp_path.name


def test_a_folder_stands_for_its_file(plan, tmp_path):
    plan(HEAD + RUNS)
    assert [run.file.name for run in read_plan(tmp_path)[0].runs] == ["one.csv", "two.csv"]
    assert lint_file(tmp_path) == []


def test_a_folder_with_a_problem_stands_for_that(plan, write, tmp_path):
    plan(HEAD + RUNS)
    write("gait: {amplitud: 1}\n", "problem.yaml")
    assert [issue.path for issue in lint_file(tmp_path)] == ["gait.amplitud"]


def test_a_robot_and_a_gait_in_files_of_their_own(plan, write, robot_text):
    write(robot_text, "robots/mine.yaml")
    write(
        '{"status": "optimal", "gait": {"shape": "fourier", "period": 1.0, "offset": 0.0, '
        '"sines": [0.5, 0.1], "cosines": [0, 0]}, "speed": 0, "solver": {}, "cycle": {}, '
        '"limits": [], "check": {}, "message": "", "version": "", "input_sha256": ""}',
        "result.json",
    )
    made = plan(
        "robot: robots/mine.yaml\nnoise: {position: 1 mm, angle: 3 mrad}\nrecordings:\n"
        "- {file: one.csv, gait: result.json}\n"
        "- {file: two.csv, gait: {shape: fourier, period: 1, offset: 0, sines: [0.5, 0.1], "
        "cosines: [0, 0]}}\n"
    )
    assert made.robot.platform1.m == 0.469
    assert made.runs[0].gait == made.runs[1].gait == FourierGait(1.0, 0.0, (0.5, 0.1), (0, 0))
    assert [path.name for path in made.paths] == [
        "experiment.yaml", "mine.yaml", "one.csv", "two.csv",
    ]  # fmt: skip


def test_markers_and_a_servo_log(plan, tmp_path):
    made = plan(
        HEAD
        + MARKERS
        + "  up: -y\nservo_counts: {counts: 4096, range: -360 deg, zero: 2048}\n"
        + RUNS.replace("start: rest", "start: rest, servo_log: log.csv")
    )
    assert made.markers.platform1 == {
        "A": (pytest.approx(0.04), 0.0), "B": (0.2, pytest.approx(-0.03), pytest.approx(0.012)),
    }  # fmt: skip
    assert made.markers.up == "-y"
    assert made.counts.each == pytest.approx(-2 * math.pi / 4096)
    assert made.runs[0].servo_log == tmp_path / "log.csv"


@pytest.mark.parametrize("changed", ["experiment.yaml", "one.csv", "two.csv", "log.csv"])
def test_the_fingerprint_is_over_every_file(plan, tmp_path, changed):
    text = HEAD + RUNS.replace("start: rest", "start: rest, servo_log: log.csv")
    before = plan(text).sha256
    content = (tmp_path / changed).read_bytes()
    (tmp_path / changed).write_bytes(content[:-1] + b" ")  # of the same length
    assert read_plan(tmp_path)[0].sha256 != before


def test_every_mistake_at_once(experiment):
    found = issues(
        experiment(
            HEAD.replace("h: 20 mm", "h: 20 kg").replace("position: 1 mm", "positon: 1 mm")
            + "uncertainty: {m: 1 m, kapa: unknown, phi_zero: 5 %}\n"
            + MARKERS.replace("[40 mm, 0]", "[40 mm]").replace("D:", "B:")
            + "servo_counts: {counts: 1}\n"
            + RUNS.replace("one.csv", "three.csv").replace("holdout", "test").replace("1.2 s", "0")
            + "- {file: two.csv, gait: 3}\n- 5\n"
        )
    )
    assert {path: issue.line for path, issue in found.items()} == {
        "robot.h": 4,
        "noise.position": 5,
        "noise.positon": 5,
        "uncertainty.m": 6,
        "uncertainty.kapa": 6,
        "uncertainty.phi_zero": 6,
        "markers.platform1.A": 8,
        "markers.platform2.B": 9,
        "servo_counts.counts": 10,
        "recordings[0].file": 12,
        "recordings[0].gait.period": 12,
        "recordings[1].use": 13,
        "recordings[2].gait": 14,
        "recordings[2].file": 14,
        "recordings[3]": 15,
    }
    assert "Did you mean `position`?" in found["noise.positon"].message
    assert "Did you mean `kappa`?" in found["uncertainty.kapa"].message
    assert found["recordings[0].file"].message == (
        "Read 'three.csv'. There is no such file. Check its name and folder."
    )
    assert "which is also recordings[1]" in found["recordings[2].file"].message
    assert "on both platforms" in found["markers.platform2.B"].message


WRONG = {
    "no robot": (RUNS + "noise: {position: 1, angle: 1}\n", "robot", "This key is missing"),
    "no noise": (HEAD.split("noise", maxsplit=1)[0] + RUNS, "noise", "This key is missing"),
    "no recordings": (HEAD, "recordings", "This key is missing"),
    "none": (HEAD + "recordings: []\n", "recordings", "Expected a list of recordings"),
    "no noise at all": (HEAD.replace("3 mrad", "0") + RUNS, "noise.angle", "above 0"),
    "a robot": ("robot: 3\n" + HEAD[HEAD.index("noise") :] + RUNS, "robot", "Read 3."),
    "its file": ("robot: a\n" + HEAD[HEAD.index("noise") :] + RUNS, "robot", "no such file"),
    "no gait": (HEAD + "recordings:\n- {file: one.csv}\n", "recordings[0].gait", "missing"),
    "a gait's file": (
        HEAD + RUNS.replace("{amplitude: 30 deg, period: 1.2 s, offset: 0}", "one.csv"),
        "recordings[0].gait",
        "Read 'one.csv'.",
    ),
    "a folder": (HEAD + RUNS.replace("one.csv", "."), "recordings[0].file", "This is a folder"),
    "its log": (
        HEAD + RUNS.replace("start: rest", "servo_log: a"),
        "recordings[0].servo_log",
        "no such file",
    ),
    "no counts": (HEAD + RUNS + "servo_counts: {range: 0}\n", "servo_counts.range", "Read 0."),
    "markers": (HEAD + RUNS + "markers: 3\n", "markers", "Read 3."),
    "one marker": (
        HEAD + RUNS + MARKERS.replace("A: [40 mm, 0], ", ""),
        "markers.platform1",
        "at least 2 markers",
    ),
    "one place": (
        HEAD + RUNS + MARKERS.replace("[-60 mm, 10 mm]", "[-50 mm, 0]"),
        "markers.platform2.D",
        "the place of 'C' again",
    ),
    "no platform 2": (
        HEAD + RUNS + MARKERS.rsplit("  platform2", 1)[0],
        "markers.platform2",
        "This key is missing",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_refused(experiment, case):
    text, place, message = WRONG[case]
    found = issues(experiment(text))
    assert list(found) == [place]
    assert message in found[place].message


def test_another_kind_of_file(write, robot_text):
    with pytest.raises(InvalidFileError, match="names no recordings"):
        read_plan(write(robot_text))


def test_a_problem_is_not_read_from_it(experiment):
    with pytest.raises(InvalidFileError, match=r"Experiments are read by `rr-opt diagnose`\."):
        read_problem(experiment(HEAD + RUNS))


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        (HEAD + RUNS.replace("use: holdout", "use: fit"), "recordings", "No recording is held out"),
        (
            HEAD + RUNS.replace("start: rest", "use: holdout"),
            "recordings",
            "No recording is marked to be fitted",
        ),
        (
            HEAD + RUNS.replace("30 deg", "130 deg"),
            "recordings[0].gait",
            "past the singular posture at 1.887 rad",
        ),
        (
            HEAD.replace("c: 206 mm, a: 20 mm", "c: 206 mm, a: 0") + RUNS + "uncertainty: {a: 5 %}",
            "uncertainty.a",
            "The nominal a1 is 0",
        ),
    ],
)
def test_warnings(experiment, text, place, message):
    (issue,) = lint_file(experiment(text))
    assert (issue.level, issue.path) == ("warning", place)
    assert message in issue.message


def test_named_files_are_found_in_a_file_that_is_wrong(experiment, tmp_path):
    path = experiment(RUNS + "- {file: 7}\n- {file: gone.csv}\n- x\n")
    assert named_files(path) == ([tmp_path / "one.csv", tmp_path / "two.csv"], {})
    assert named_files(tmp_path / "nowhere") == ([], {})
