"""Numbers are written as people read them: no exponent for a slow robot, no sign of rounding."""

import pytest

from rr_opt.formatting import QUANTITIES, number, pace_text, speed_text


@pytest.mark.parametrize(
    ("speed", "text", "pace"),
    [
        (-0.12896, "-0.12896 m/s (-129.0 mm/s)", "0.1290 m/s"),
        (0.001, "+0.00100 m/s (+1.0 mm/s)", "0.0010 m/s"),
        (7.38e-5, "+0.0738 mm/s", "0.0738 mm/s"),
        (-7.38e-5, "-0.0738 mm/s", "0.0738 mm/s"),
        (4.2e-16, "0 mm/s", "0 mm/s"),
        (0.0, "0 mm/s", "0 mm/s"),
    ],
)
def test_speeds(speed, text, pace):
    assert speed_text(speed) == text
    assert pace_text(speed) == pace


@pytest.mark.parametrize("value", [0.0, -0.0, -4.5e-15, 1e-13])
def test_what_rounding_leaves_is_zero(value):
    assert number(value) == "0"
    assert QUANTITIES["offset"].both(value) == "0 rad (0 deg)"


@pytest.mark.parametrize(
    ("value", "text"), [(0.15, "0.15"), (-3.14159, "-3.142"), (2e-5, "2e-05"), (123456, "123456")]
)
def test_numbers(value, text):
    assert number(value) == text
