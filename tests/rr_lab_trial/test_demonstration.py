"""The demonstration measures the mean speed of whole periods, and hides again what was hidden."""

import math

import pytest

from docs.demonstration import effect_text, mean_speed
from rr_lab.api.arguments import read_effects


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


def test_an_opened_answer_can_be_hidden_again():
    values = {"tilt_x": {"value": 1.5e-3, "unit": "rad"}, "tilt_y": {"value": -2e-5, "unit": "rad"}}
    (use,) = read_effects([effect_text({"name": "floor_tilt", "parameters": values})])
    assert use.name == "floor_tilt"
    assert use.values == {"tilt_x": 1.5e-3, "tilt_y": -2e-5}
