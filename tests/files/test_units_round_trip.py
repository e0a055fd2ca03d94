"""A value written in any unit of its dimension comes back as the same SI number."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rr_opt.units import to_si

WORTH = {
    ("mm", "m"): 1e-3,
    ("g", "kg"): 1e-3,
    ("ms", "s"): 1e-3,
    ("deg", "rad"): math.pi / 180,
    ("°", "rad"): math.pi / 180,
    ("rpm", "rad/s"): 2 * math.pi / 60,
    ("deg/s", "rad/s"): math.pi / 180,
    ("kgf*cm", "N m"): 0.0980665,
    ("kgf cm", "N m"): 0.0980665,
    ("N·mm", "N m"): 1e-3,
    ("Nm", "N m"): 1.0,
    ("g cm^2", "kg m^2"): 1e-7,
    ("kg m2", "kg m^2"): 1.0,
    ("kg*m**2", "kg m^2"): 1.0,
    ("kg m²", "kg m^2"): 1.0,
    ("N*s/m", "N s/m"): 1.0,
    ("kg/s", "N s/m"): 1.0,
    ("mN m s", "N m s"): 1e-3,
    ("N m/(rad/s)", "N m s"): 1.0,
    ("mm/(N s)", "m/(N s)"): 1e-3,
    ("N s^2/m^2", "N s^2/m^2"): 1.0,
    ("%", ""): 0.01,
}


@settings(deadline=None, max_examples=20)
@given(number=st.floats(-1e6, 1e6))
@pytest.mark.parametrize(("pair", "worth"), WORTH.items())
def test_units(pair: tuple[str, str], worth: float, number: float):
    written, unit = pair
    expected = pytest.approx(number * worth, rel=1e-12, abs=1e-300)
    assert to_si(f"{number!r} {written}", unit) == expected


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_plain_number_is_si_already(number: float):
    assert to_si(number, "kg m^2") == number
    assert to_si(repr(number), "kg m^2") == number


def test_thirty_rpm_is_pi():
    assert to_si("30 rpm", "rad/s") == math.pi
