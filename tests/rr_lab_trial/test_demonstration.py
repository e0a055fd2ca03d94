"""The demonstration measures the mean speed of whole periods, and hides again what was hidden."""

import math

import pytest

from docs.demonstration import effect_text, mean_speed
from rr_lab.effects import EVERY
from rr_lab.files import answer
from rr_lab.random_case import random_case
from rr_lab.record import read_effects

NAMED = [effect for effect in EVERY if effect.named]


def written(path, speed, heading):
    """40 s along a heading at a mean speed, m/s, with a wiggle of 2 s in it and some rows lost."""
    lines = ["t,x,y,psi,phi"]
    for k in range(4001):
        t = k / 100
        s = speed * t + 0.02 * math.sin(math.pi * t)
        psi = heading + 0.3 * math.sin(math.pi * t)
        place = f"{s * math.cos(heading)},{s * math.sin(heading)}" if k % 7 else ","
        lines.append(f"{t},{place},{psi},0")
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("speed", [0.05, -0.08])
@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_mean_speed(tmp_path, speed, heading):
    assert mean_speed(written(tmp_path / "run.csv", speed, heading), 2.0) == pytest.approx(
        speed, rel=0.02
    )


@pytest.mark.parametrize("effect", NAMED, ids=lambda effect: effect.key)
def test_an_opened_answer_can_be_hidden_again(effect):
    case = random_case(4, f"single:{effect.key}", seconds=1.0, size=lambda _: 10.0, target=10.0)
    (use,) = read_effects([effect_text(answer(case)["effects"][0])])
    assert use.name == effect.key
    assert use.values == pytest.approx(case.effects[0].values, rel=1e-8)
