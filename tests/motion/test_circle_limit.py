"""The circle at phi0 and -phi0 is one but for its side, and down to 1e-9 rad the curvature is
proportional to the offset."""

import cmath

import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.circle import circle_of
from rr_opt.motion.integrators import cvodes
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import InputError
from tests.robots import BENCHMARK


def circle(offset, amplitude=0.8):
    return circle_of(steady_cycle(BENCHMARK, SineGait(amplitude, 1.5, offset)).cycle)


@pytest.mark.parametrize("offset", [1e-9, 1e-6, 1e-3, 0.1, 0.6])
def test_mirror(offset):
    left, right = circle(-offset), circle(offset)
    assert left.speed == pytest.approx(right.speed, rel=1e-11)
    assert left.curvature == pytest.approx(-right.curvature, rel=1e-11, abs=1e-13)
    assert left.radius == pytest.approx(right.radius, rel=1e-5)


@pytest.mark.parametrize("offset", [1e-9, 1e-8, 1e-6])
def test_proportional_to_the_offset(offset):
    assert circle(offset).curvature / offset == pytest.approx(
        circle(1e-4).curvature / 1e-4, rel=1e-5
    )


def test_straight_has_no_centre():
    assert circle(0.0).centre is None
    assert circle(0.0).radius == float("inf")


def test_the_centre_stays_where_it_is():
    gait = SineGait(0.8, 1.5, 0.4)
    steady = steady_cycle(BENCHMARK, gait)
    made = circle_of(steady.cycle)
    times = [0.0, gait.period, 7 * gait.period]
    _, psi, x, y, _ = cvodes(BENCHMARK, gait, float(steady.v[0]), times)
    centres = [
        complex(x[i], y[i]) + complex(*made.centre) * cmath.exp(1j * psi[i]) for i in (0, 1, 2)
    ]
    assert centres[1] == pytest.approx(centres[0], abs=1e-8)
    assert centres[2] == pytest.approx(centres[0], abs=1e-8)


def test_a_gait_that_stands_still_is_refused():
    with pytest.raises(InputError, match="without motion there is no circle"):
        circle(0.3, amplitude=0.0)
