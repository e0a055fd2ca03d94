"""Each price in a study's table is the speed gained per unit, as re-solved problems show."""

import pytest

STEP = 1e-3

FAST = "gait: {amplitude: [0.05, 1.0], period: [0.4, 2.0]}"
SLOW = "gait: {period: [1.0, 3.0]}, inertia_ratio: 0.04"
CASES = {
    "limits.rate": (3.0, f"{{{FAST}}}"),
    "limits.torque": (0.1, f"{{{FAST}, limits: {{rate: 80 rpm}}}}"),
    "limits.angle": (0.5, f"{{{SLOW}, limits: {{rate: 60 rpm}}}}"),
    "limits.singularity": (0.11, f"{{{SLOW}}}"),
}


@pytest.mark.parametrize(("key", "about"), CASES.items(), ids=CASES)
def test_price_of_a_limit(study_of, solved, key, about):
    value, problem = about
    values = [value * (1 - STEP), value, value * (1 + STEP)]
    rows = solved(study_of(f"problem: {problem}\nvary: {{{key}: {values}}}\n"), cold=True)
    low, here, high = (rows[case].optimum for case in range(3))
    slope = (abs(high.speed) - abs(low.speed)) / (values[2] - values[0])
    name = key.removeprefix("limits.")
    assert name in here.held
    assert abs(slope) > 1e-3
    assert here.prices[name] == pytest.approx(slope, rel=1e-2)


@pytest.mark.parametrize(
    ("key", "name", "value"),
    [("gait.period[0]", "period", 0.4), ("inertia_ratio[1]", "inertia_ratio", 0.3)],
)
def test_price_of_a_bound(study_of, solved, key, name, value):
    values = [value * (1 - STEP), value, value * (1 + STEP)]
    problem = "{gait: {period: [0.4, 3.0]}, inertia_ratio: [0.12, 0.3]}"
    rows = solved(study_of(f"problem: {problem}\nvary: {{'{key}': {values}}}\n"), cold=True)
    low, here, high = (rows[case].optimum for case in range(3))
    slope = (abs(high.speed) - abs(low.speed)) / (values[2] - values[0])
    assert here.bound_prices[name] == pytest.approx(slope, rel=1e-2)
