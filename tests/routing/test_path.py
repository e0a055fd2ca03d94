"""The path of a route: legs join, waypoints are reached on the shortest of the Dubins paths."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rr_opt.model.problem import Problem
from rr_opt.model.route import Arc, Pose, Route, Straight, Waypoint
from rr_opt.routing.path import Leg, legs_of, signed_distance

numbers = st.floats(-3, 3)
headings = st.floats(-math.pi, math.pi)


def path_to(start: Pose, end: Waypoint, radius: float, prototype) -> list[Leg]:
    route = Route(Problem(prototype), (end,), start)
    return legs_of(route, lambda _: 1.0, np.array([radius]))


@settings(deadline=None)
@given(numbers, numbers, headings, headings)
def test_a_waypoint_is_reached(x, y, begin, end):
    import rr_opt as rr

    legs = path_to(Pose(0.4, -0.2, begin), Waypoint(x, y, end), 0.5, rr.prototype())
    for before, after in itertools.pairwise(legs):
        assert before.end == after.start
    if legs:
        last = legs[-1].end
        assert math.hypot(last.x - x, last.y - y) < 1e-8
        assert abs(math.remainder(last.heading - end, 2 * math.pi)) < 1e-8


@pytest.mark.parametrize(
    ("end", "length"),
    [
        # Straight ahead; a half turn to the left; a shift to the side by less than two radii needs
        # three arcs when it is to be reversed: pi/3, 5 pi/3 and pi/3 radii long (Dubins, 1957).
        (Waypoint(2.0, 0.0, 0.0), 2.0),
        (Waypoint(0.0, 1.0, math.pi), 0.5 * math.pi),
        (Waypoint(0.0, 0.0, math.pi), 0.5 * 7 * math.pi / 3),
    ],
)
def test_known_shortest_paths(end, length):
    import rr_opt as rr

    legs = path_to(Pose(), end, 0.5, rr.prototype())
    assert sum(leg.length for leg in legs) == pytest.approx(length, rel=1e-9)


def test_pieces_follow_one_another():
    import rr_opt as rr

    pieces = (Straight(1.0), Arc(0.5, math.pi / 2), Arc(0.5, -math.pi / 2), Straight("20 cm"))
    legs = legs_of(Route(Problem(rr.prototype()), pieces), lambda _: 1.0, np.array([1.0]))
    end = legs[-1].end
    assert (end.x, end.y, end.heading) == pytest.approx((2.2, 1.0, 0.0))


@given(st.floats(-2, 2), st.floats(0, 0.5), st.floats(-0.2, 0.2), headings)
def test_the_distance_from_a_leg_is_that_from_its_circle(curvature, along, off, heading):
    leg = Leg(0, Pose(1.0, -2.0, heading), 1.0, curvature)
    at = leg.at(along)
    x, y = at.x - off * math.sin(at.heading), at.y + off * math.cos(at.heading)
    found, by_x, by_y = signed_distance(leg, np.array([x]), np.array([y]))
    assert found[0] == pytest.approx(off, abs=1e-9)
    # The gradient is the normal.
    assert by_x[0] == pytest.approx(-math.sin(at.heading), abs=1e-9)
    assert by_y[0] == pytest.approx(math.cos(at.heading), abs=1e-9)
