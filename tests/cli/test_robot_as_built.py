"""A robot file alone is the robot as it is; where the ratio is free, the change is reported."""

import json

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import robot_record

GAIT = "gait: {amplitude: [0.1, 1.0], period: 1 s}\n"


@pytest.fixture
def robot(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    record = robot_record(read_problem(None).robot)
    (tmp_path / "bot.yaml").write_text(json.dumps({**record, "physics": []}))
    return record


def test_a_bare_robot_keeps_its_inertia(run, robot, tmp_path):
    done = run("maximize-speed", "bot.yaml", "--no-figures", "--json")
    reported = json.loads(done.stdout)
    assert reported["robot"]["platform2"] == robot["platform2"]
    assert reported["speed_as_built"] is None
    text = run("maximize-speed", "bot.yaml", "--no-figures").stdout
    assert "the robot as it is" in text
    assert "as built" not in text


def test_a_free_ratio_is_reported_with_the_speed_as_built(run, robot, tmp_path):
    (tmp_path / "free.yaml").write_text(f"robot: bot.yaml\n{GAIT}inertia_ratio: [0.05, 0.4]\n")
    (tmp_path / "fixed.yaml").write_text(f"robot: bot.yaml\n{GAIT}")
    free, fixed = (
        json.loads(run("maximize-speed", f"{name}.yaml", "--no-figures", "--json").stdout)
        for name in ("free", "fixed")
    )
    assert free["speed_as_built"] == pytest.approx(fixed["speed"])
    assert abs(free["speed"]) > abs(fixed["speed"])
    done = run("maximize-speed", "free.yaml")
    old, new = (one["robot"]["platform2"]["I"] for one in (fixed, free))
    reported = " ".join(done.stdout.split())
    assert f"I2 {old:.4g} -> {new:.4g} kg m2 (ratio {fixed['inertia_ratio']:.4g} -> " in reported
    assert f"{1e3 * fixed['speed']:+.1f} mm/s" in done.stdout.replace("(", "(+").replace("+-", "-")
    page = (tmp_path / "out" / "free" / "report.html").read_text()
    assert "at best, with I2 unchanged" in page


@pytest.mark.parametrize("verb", [("circle",), ("simulate", "--seconds", "3"), ("export",)])
def test_a_gait_is_driven_with_the_ratio_of_its_problem(run, robot, tmp_path, verb):
    def speed(choice):
        text = f"robot: bot.yaml\ngait: {{amplitude: 0.5, period: 1 s}}\n{choice}"
        (tmp_path / "one.yaml").write_text(text)
        name, *options = verb
        done = run(name, "one.yaml", *options, "--json")
        assert done.exit_code == 0, done.stderr
        reported = json.loads(done.stdout)
        warned = "leaves the inertia ratio" in done.stderr
        return reported.get("speed", reported.get("last_circle_speed")), warned

    own, silent = speed("")
    assert speed("inertia_ratio: 0.3\n") == (pytest.approx(speed("inertia_ratio: 0.3\n")[0]), False)
    assert speed("inertia_ratio: 0.3\n")[0] != pytest.approx(own, rel=0.05)
    assert speed("inertia_ratio: [0.3, 0.4]\n") == (speed("inertia_ratio: 0.3\n")[0], True)
    # The robot's own ratio is allowed: it is driven as it is.
    assert speed("inertia_ratio: [0.05, 0.4]\n") == (own, silent)
    loads = "inertia_ratio: {bounds: [0.2, 0.4], by: loads, loads: {whole: true}}\n"
    assert speed(loads)[1]
