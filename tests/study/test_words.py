"""A study names its keys as an engineer would, in figures, tables and sentences."""

import pytest

from rr_opt.files.study_axes import key_of
from rr_opt.results.study_table import axis_words, key_words, value_text


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("limits.rate", "rate limit"),
        ("limits.singularity", "singularity margin"),
        ("robot.platform1.kappa", "viscous wheel friction of platform 1"),
        ("robot.servo.rate_limit", "servo's rate limit"),
        ("gait.period", "period"),
        ("inertia_ratio", "inertia ratio J20/J10"),
        ("direction", "direction"),
    ],
)
def test_keys(key, words):
    assert key_words(key_of(key)) == words


def test_values_have_the_unit_of_the_bench():
    assert value_text(key_of("robot.platform1.kappa"), 3e-5) == "30 µN m s"
    assert value_text(key_of("limits.singularity"), 0.02) == "20 mm"


def test_both_platforms_in_step_are_one(study_of):
    (axis,) = study_of(
        "together:\n  - robot.platform1.m: [0.4, 0.5]\n    robot.platform2.m: [0.2, 0.3]\n"
    ).axes
    assert axis_words(axis) == "masses of both platforms"
    (axis,) = study_of("together:\n  - limits.rate: [2, 3]\n    limits.torque: [1, 2]\n").axes
    assert axis_words(axis) == "rate limit and 1 more"
