"""`provenance` mirrors the robot, and each leaf says measured, fitted or assumed."""

from __future__ import annotations

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.robot_file import read_robot


def with_provenance(robot_text: str, provenance: str) -> str:
    return f"{robot_text}servo: {{angle_limit: 1.5}}\nprovenance: {provenance}\n"


def test_key_paths(write, robot_text):
    text = with_provenance(
        robot_text,
        '{platform1: {m: "measured: scale", k: "fitted: run 3"}, h: assumed, '
        'servo: {rate_limit: "measured: Table 1"}, '
        'physics: {coulomb_friction: {force1: "fitted: run 4"}}}',
    )
    assert read_robot(write(text)).provenance == {
        "platform1.m": "measured: scale",
        "platform1.kappa": "fitted: run 3",
        "h": "assumed",
        "servo.rate_limit": "measured: Table 1",
        "physics.coulomb_friction.force1": "fitted: run 4",
    }


WRONG = {
    "{h: guessed}": ("provenance.h", "Read 'guessed'. Expected a text that begins with measured,"),
    "{platform1: {m: 3}}": ("provenance.platform1.m", "Read 3. Expected a text"),
    "{platform1: {mass: measured}}": ("provenance.platform1.mass", "Read the key 'mass'."),
    "{platform3: measured}": ("provenance.platform3", "Did you mean `platform"),
    "measured": ("provenance", "Read 'measured'."),
}


@pytest.mark.parametrize(("provenance", "told"), WRONG.items(), ids=WRONG)
def test_wrong(write, robot_text, provenance: str, told: tuple[str, str]):
    (issue,) = lint_file(write(with_provenance(robot_text, provenance)))
    assert (issue.level, issue.path) == ("error", told[0])
    assert told[1] in issue.message
