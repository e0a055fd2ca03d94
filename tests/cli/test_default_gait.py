"""A gait that nobody chose is said to be a default, with how to come to the optimum."""

import json

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import robot_record

BOTH = ("--amplitude", "30 deg", "--period", "1.2 s")
COMMANDS = pytest.mark.parametrize(
    "verb", [("simulate", "--seconds", "0.1"), ("export",)], ids=["simulate", "export"]
)


def reported(run, verb, *arguments):
    done = run(*verb, *arguments, "--json")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["status"] is None
    return [line for line in done.stderr.splitlines() if "maximize-speed" in line]


@COMMANDS
def test_of_the_prototype(run, verb):
    assert reported(run, verb) == [
        "warning: No amplitude and period given. The default is driven, amplitude 0.785 rad and "
        "period 1 s as in the paper's run, not the optimum of the prototype. Run `rr-opt "
        "maximize-speed` first and give out/prototype/result.json, or --amplitude and --period."
    ]
    assert reported(run, verb, *BOTH) == []


@COMMANDS
def test_of_a_robot(run, verb, tmp_path):
    record = {**robot_record(read_problem(None).robot), "physics": []}
    (tmp_path / "my robot.yaml").write_text(json.dumps(record))
    (line,) = reported(run, verb, "my robot.yaml", *BOTH[:2])
    assert line.startswith("warning: No period given. The default is driven, period 1 s")
    assert "Run `rr-opt maximize-speed 'my robot.yaml'` first" in line
    assert "out/my robot/result.json" in line
    assert reported(run, verb, "my robot.yaml", *BOTH) == []


@COMMANDS
def test_of_a_problem_only_what_it_leaves_open(run, verb, tmp_path):
    problem = tmp_path / "mine.yaml"
    problem.write_text("gait: {amplitude: 0.3, period: [1.5 s, 2 s]}\n")
    (line,) = reported(run, verb, "mine.yaml")
    assert line.startswith("warning: No period given. The default is driven, period 1.5 s")
    problem.write_text("gait: {amplitude: 0.3, period: 1.5 s}\n")
    assert reported(run, verb, "mine.yaml") == []


@COMMANDS
@pytest.mark.parametrize("shape", ["fourier", "free"])
def test_a_sine_where_another_shape_is_asked_for(run, verb, tmp_path, shape):
    (tmp_path / "mine.yaml").write_text(f"gait: {{shape: {shape}}}\n")
    reported_of_it = f"The problem asks for a `{shape}` gait, but a sine is driven. Run `rr-opt"
    (line,) = reported(run, verb, "mine.yaml")
    assert reported_of_it in line
    assert "The default is driven" in line
    (line,) = reported(run, verb, "mine.yaml", *BOTH)
    assert reported_of_it in line
    assert line.endswith("first and give out/mine/result.json.")
