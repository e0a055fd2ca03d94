"""The path of a route: a sequence of arcs of constant curvature.

A waypoint is reached by a Dubins path: the shortest path of bounded curvature is an arc, a
straight line and an arc, or three arcs (Dubins, 1957). The six kinds are solved in the frame of
the start, with lengths in units of the radius.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.route import Arc, Pose, Route, Straight

_SHORT = 1e-9


@dataclass(frozen=True)
class Leg:
    """A part of the path: from `start`, `length` m at a curvature of 1/m, positive to the left.

    piece  number of the route's piece that it belongs to, from 0
    """

    piece: int
    start: Pose
    length: float
    curvature: float

    def at(self, distance: float) -> Pose:
        """The pose after some distance, m."""
        turned = self.curvature * distance
        # The chord of an arc, which has the mean heading.
        chord = distance * float(np.sinc(turned / (2 * math.pi)))
        mean = self.start.heading + turned / 2
        return Pose(
            self.start.x + chord * math.cos(mean),
            self.start.y + chord * math.sin(mean),
            self.start.heading + turned,
        )

    @property
    def end(self) -> Pose:
        """The pose at its end."""
        return self.at(self.length)

    def parts(self, longest: float) -> list[Leg]:
        """The leg in equal parts of at most this length, m, and at most a quarter turn."""
        turned = abs(self.curvature) * self.length
        count = max(1, math.ceil(self.length / longest - 1e-6), math.ceil(turned / 1.6))
        length = self.length / count
        return [Leg(self.piece, self.at(k * length), length, self.curvature) for k in range(count)]


def legs_of(route: Route, cost: Callable[[float], float], radii: Array) -> list[Leg]:
    """The path of a route.

    cost   time per metre, s/m, at a curvature, 1/m
    radii  m, candidates for waypoints' arcs; the fastest are chosen
    """
    pose, legs = route.start, list[Leg]()
    for number, piece in enumerate(route.pieces):
        match piece:
            case Straight():
                added = [Leg(number, pose, piece.length, 0.0)]
            case Arc():
                curvature = math.copysign(1 / piece.radius, piece.angle)
                added = [Leg(number, pose, piece.radius * abs(piece.angle), curvature)]
            case _:
                candidates = (
                    path for radius in radii for path in _dubins(number, pose, piece.pose, radius)
                )
                added = min(
                    candidates,
                    key=lambda path: sum(leg.length * cost(leg.curvature) for leg in path),
                )
        legs += [leg for leg in added if leg.length > _SHORT]
        pose = legs[-1].end if legs else pose
    return legs


def _dubins(piece: int, start: Pose, end: Pose, radius: float) -> Iterator[list[Leg]]:
    """The Dubins paths with a radius, m, of every kind that exists."""
    dx, dy = (end.x - start.x) / radius, (end.y - start.y) / radius
    cos, sin = math.cos(start.heading), math.sin(start.heading)
    ahead, left, turn = cos * dx + sin * dy, cos * dy - sin * dx, end.heading - start.heading
    # The centres of the circles to the left (+1) and right (-1) of both poses.
    for first, last in itertools.product((1, -1), repeat=2):
        a = complex(0, first)
        b = complex(ahead, left) + last * 1j * complex(math.cos(turn), math.sin(turn))
        apart, towards, same = abs(b - a), math.atan2((b - a).imag, (b - a).real), first == last
        # A straight line between the circles: a part's side (0: straight), heading at its end, and
        # length; an arc's follows from its headings.
        if same or apart >= 2:
            heading = towards if same else towards + first * math.asin(2 / apart)
            length = math.sqrt(max(apart**2 - (0 if same else 4), 0.0))
            parts = (first, heading, 0.0), (0, heading, length), (last, turn, 0.0)
            yield _joined(piece, start, radius, parts)
        if same and 0 < apart <= 4:
            bend = math.acos(apart / 4)
            # The middle circle touches both; there are two positions for it.
            for side in (1, -1):
                heading = towards + side * bend + first * math.pi / 2
                # At the tangent points the heading is perpendicular to the line of centres.
                across = heading - first * math.pi / 2
                to = (b - (a + 2 * complex(math.cos(across), math.sin(across)))) / 2
                out = math.atan2(to.imag, to.real) - first * math.pi / 2
                parts = (first, heading, 0.0), (-first, out, 0.0), (last, turn, 0.0)
                yield _joined(piece, start, radius, parts)


def _joined(
    piece: int, start: Pose, radius: float, parts: Iterable[tuple[int, float, float]]
) -> list[Leg]:
    """The legs of parts, in units of the radius."""
    legs, pose, before, around = list[Leg](), start, 0.0, 2 * math.pi
    for side, heading, straight in parts:
        arc = (side * (heading - before)) % around
        # A full turn that rounding made of zero.
        length = (0.0 if around - arc < 1e-9 else arc) if side else straight
        legs.append(Leg(piece, pose, length * radius, side / radius))
        pose, before = legs[-1].end, heading
    return legs


def signed_distance(leg: Leg, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """Distance of points to the left of the circle or line of a leg, m, and its derivatives by x
    and y: with a ahead and b to the left of the leg's start and q = 2 b - kappa (a^2 + b^2), it is
    q/(1 + sqrt(1 - kappa q))."""
    k, cos, sin = leg.curvature, math.cos(leg.start.heading), math.sin(leg.start.heading)
    dx, dy = x - leg.start.x, y - leg.start.y
    q = 2 * (cos * dy - sin * dx) - k * (dx * dx + dy * dy)
    root = np.sqrt(np.maximum(1 - k * q, 1e-12))
    return q / (1 + root), (-sin - k * dx) / root, (cos - k * dy) / root
