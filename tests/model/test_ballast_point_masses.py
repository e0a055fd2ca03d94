"""A platform made of point masses has the inertia of their sums, with and without loads."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rr_opt.model.ballast import Loads, with_load_count
from rr_opt.model.robot import Platform
from tests.mechanics.cases import REPEATABLE, numbers

# Mass, distance from P along the axis and distance to either side of it.
points = st.lists(
    st.tuples(numbers(0.01, 0.2), numbers(-0.2, 0.2), numbers(0.0, 0.1)), min_size=1, max_size=6
)
loads = st.builds(
    Loads, mass=numbers(0.01, 0.2), distance=numbers(-0.1, 0.15), spread=numbers(0.0, 0.1)
)


def sums(body: np.ndarray) -> tuple[float, float, float, float]:
    """(mass, distance of the centre from P, inertia about the centre, about P) of rows m, x, y."""
    m, x, y = body.T
    centre = (m @ x) / m.sum()
    assert m @ y == pytest.approx(0.0, abs=1e-15)
    return m.sum(), centre, m @ ((x - centre) ** 2 + y**2), m @ (x**2 + y**2)


def pairs(points: list[tuple[float, float, float]]) -> np.ndarray:
    return np.array([(m / 2, x, side * y) for m, x, y in points for side in (1, -1)])


def properties(platform: Platform) -> tuple[float, float, float, float]:
    return platform.m, platform.joint_to_centre, platform.I, platform.joint_inertia


def platform_of(body: np.ndarray, c: float) -> Platform:
    m, centre, inertia, _ = sums(body)
    return Platform(m, inertia, c, c - centre, 0.05, 2e-5)


@REPEATABLE
@given(points, numbers(0.03, 0.3))
def test_parallel_axes(points, c):
    body = pairs(points)
    assert properties(platform_of(body, c)) == pytest.approx(sums(body), rel=1e-9, abs=1e-14)


@REPEATABLE
@given(points, numbers(0.03, 0.3), loads, numbers(0.0, 10.0))
def test_loads_are_points_too(points, c, loads, count):
    body = pairs(points)
    hung = pairs([(count * loads.mass, loads.distance, loads.spread)])
    laden = with_load_count(platform_of(body, c), loads, count)
    assert properties(laden) == pytest.approx(sums(np.vstack([body, hung])), rel=1e-9, abs=1e-14)
    assert laden.c == c
