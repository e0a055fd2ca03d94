"""`physics` names effects of the catalogue, whose missing parameters are neutral."""

from __future__ import annotations

import pytest

from rr_opt.effects import OF_ROBOTS
from rr_opt.files.lint import lint_file
from rr_opt.files.robot_file import read_robot
from rr_opt.model.robot import EffectUse


def with_physics(robot_text: str, physics: str) -> str:
    return f"{robot_text}servo: {{angle_limit: 1.5}}\nphysics: {physics}\n"


def test_names_and_aliases(write, robot_text):
    text = with_physics(
        robot_text,
        "[{name: coulomb_friction, F1: 20 mN, force2: 0.03}, {name: wheel_inertia, J: 1e-6}]",
    )
    assert read_robot(write(text)).physics == (
        EffectUse(
            "coulomb_friction", {"force1": pytest.approx(0.02), "force2": 0.03, "onset": 0.002}
        ),
        EffectUse("wheel_inertia", {"J": 1e-6}),
    )


@pytest.mark.parametrize("name", OF_ROBOTS)
def test_every_effect_of_the_catalogue(write, robot_text, name: str):
    effect = OF_ROBOTS[name]
    given = ", ".join(f"{q.name}: {q.typical!r} {q.unit}" for q in effect.parameters)
    typical = read_robot(write(with_physics(robot_text, f"[{{name: {name}, {given}}}]"))).physics
    expected = {q.name: pytest.approx(q.typical) for q in effect.parameters}
    assert typical == (EffectUse(name, expected),)


@pytest.mark.parametrize("name", OF_ROBOTS)
def test_parameters_not_given_are_neutral_and_warned_about(write, robot_text, name: str):
    path = write(with_physics(robot_text, f"[{{name: {name}}}]"))
    neutral = {q.name: q.neutral for q in OF_ROBOTS[name].parameters}
    assert read_robot(path).physics == (EffectUse(name, neutral),)
    (issue,) = lint_file(path)
    assert (issue.level, issue.path) == ("warning", "physics[0]")
    assert "No parameter is given, so it does nothing." in issue.message


WRONG = {
    "coulomb_friction": ("physics", "Read 'coulomb_friction'. Expected a list of effects"),
    "[coulomb_friction]": ("physics[0]", "Read 'coulomb_friction'. Expected {name: ...,"),
    "[{F1: 1}]": ("physics[0].name", "Read nothing. Expected the name of an effect:"),
    "[{name: coulomb}]": ("physics[0].name", "Did you mean `coulomb_friction`?"),
    "[{name: coulomb_friction, F9: 1}]": ("physics[0].F9", "Expected one of: name, force1, F1,"),
    "[{name: coulomb_friction, F1: -1}]": ("physics[0].F1", "Expected a number in N at least 0"),
    "[{name: coulomb_friction, F1: 1 m}]": ("physics[0].F1", "Read '1 m', a length."),
    "[{name: coulomb_friction, F1: 1, force1: 1}]": (
        "physics[0].force1",
        "`force1` and `F1` are the same parameter. Keep one.",
    ),
    "[{name: wheel_inertia, J: 0}, {name: wheel_inertia, J: 0}]": (
        "physics[1].name",
        "Read `wheel_inertia` a second time. Keep one, with all parameters.",
    ),
}


@pytest.mark.parametrize(("physics", "told"), WRONG.items(), ids=WRONG)
def test_wrong(write, robot_text, physics: str, told: tuple[str, str]):
    (issue,) = lint_file(write(with_physics(robot_text, physics)))
    assert (issue.level, issue.path) == ("error", told[0])
    assert told[1] in issue.message


def test_the_zeros_of_a_capture_system_are_no_robots(write, robot_text):
    path = write(with_physics(robot_text, "[{name: zero_offset, psi: 0.02}]"))
    (issue,) = lint_file(path)
    assert "zero_offset" in issue.message
