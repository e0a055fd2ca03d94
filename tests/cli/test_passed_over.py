"""A robot with effects that have no place in a steady cycle is accepted; one line reports them."""

import json

import pytest

from rr_opt.effects import OF_ROBOTS
from rr_opt.effects.effect import Port
from rr_opt.motion.dynamics import steady_effects

ROBOT = """
platform1: {m: 0.469, I: 0.00386, c: 206 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
platform2: {m: 0.250, I: 0.00175, c: 64.1 mm, a: 20 mm, b: 50 mm, kappa: 2.0e-5}
h: 20 mm
servo: {angle_limit: 1.6, rate_limit: 30 rpm, torque_limit: 1.37}
"""
GAIT = ("--amplitude", "0.3", "--period", "1")
VERBS = {
    "simulate": ("--seconds", "0.5", "--out", "res"),
    "circle": (),
    "export": ("--out", "points.csv"),
}


def written(tmp_path, names):
    lines = (
        f"  - {{name: {name}, "
        + ", ".join(f"{q.name}: {q.typical!r} {q.unit}" for q in OF_ROBOTS[name].parameters)
        + "}"
        for name in names
    )
    path = tmp_path / "robot.yaml"
    path.write_text(ROBOT + "physics:\n" + "\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("verb", VERBS)
def test_one_line_names_them_all(run, tmp_path, verb):
    done = run(verb, str(written(tmp_path, OF_ROBOTS)), *GAIT, *VERBS[verb], "--json")
    assert done.exit_code == 0, done.stderr
    (line,) = (line for line in done.stderr.splitlines() if " ignored: " in line)
    for name in OF_ROBOTS:
        of_servo = OF_ROBOTS[name].port is Port.ACTUATION
        assert (name in line) == (name not in steady_effects() and not of_servo)
    assert json.loads(done.stdout)


def test_nothing_is_said_of_the_others(run, tmp_path):
    path = written(tmp_path, sorted(steady_effects()))
    done = run("simulate", str(path), *GAIT, *VERBS["simulate"])
    assert done.exit_code == 0, done.stderr
    assert " ignored: " not in done.stderr
