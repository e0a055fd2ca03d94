"""A word is taken for a known one only where little else can have been meant."""

from __future__ import annotations

import pytest

from rr_opt.messages import nearest

GAIT = ["shape", "harmonics", "intervals", "amplitude", "period", "offset"]
PROBLEM = ["robot", "gait", "inertia_ratio", "limits", "direction"]
SERVO = ["angle_limit", "rate_limit", "torque_limit"]
UNITS = ["m", "cm", "kg", "s", "ms", "deg", "rpm", "N"]


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("amplitud", GAIT, "amplitude"),
        ("Amplitude", GAIT, "amplitude"),
        ("offst", GAIT, "offset"),
        ("amp", GAIT, "amplitude"),
        ("ratio", PROBLEM, "inertia_ratio"),
        ("limit", PROBLEM, "limits"),
        ("torque", SERVO, "torque_limit"),
        ("kgs", UNITS, "kg"),
    ],
)
def test_a_slip_is_seen(word: str, known: list[str], meant: str):
    assert nearest(word, known) == meant


@pytest.mark.parametrize(
    ("word", "known"),
    [
        ("phase", GAIT),
        ("speed", GAIT),
        ("friction", PROBLEM),
        ("goal", PROBLEM),
        ("limit", SERVO),
        ("meters", UNITS),
        ("mu", UNITS),
        ("", GAIT),
        ("x" * 1000, GAIT),
    ],
)
def test_another_word_is_not_taken_for_one(word: str, known: list[str]):
    assert nearest(word, known) is None
