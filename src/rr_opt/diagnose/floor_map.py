"""Where on the floor the wheels roll harder, or more easily: places to look for a patch.

The floor is cut into cells, each with a share of drag of its own, all zero; one linearised pass
says what each would change. Every circle and every half of the floor is a sum of cells, so what it
would gain, parameters and starts re-fitted, is a matter of adding up.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.physics.assembly import Assembly, assembled
from rr_opt.physics.floor_motion import FloorMotion, solved
from rr_opt.physics.kinematics import Wheel, with_wheel_forces

_ACROSS = 6
"""Cells across the longer side of the visited floor."""

_SMALLEST = 0.12
"""Side of a cell, m, at least: the wheels of a robot are some 10 cm apart."""

_DIRECTIONS = 16
_BEST = 2


@dataclass(frozen=True)
class Cells:
    """Cells of the floor: their centres (n, 2) and their side, m."""

    centres: Array
    side: float

    @property
    def names(self) -> tuple[str, ...]:
        """One for each."""
        return tuple(f"cell{k}" for k in range(len(self.centres)))


def cells_of(paths: Sequence[Array]) -> Cells:
    """Cells where the robot was, from the paths (n, 2) of its joint."""
    every = np.vstack(paths)
    every = every[np.isfinite(every).all(axis=1)]
    side = max(float(np.ptp(every, axis=0).max()) / _ACROSS, _SMALLEST)
    visited = np.unique(np.round(every / side).astype(int), axis=0)
    return Cells(visited * side, side)


def with_cells(effects: tuple[str, ...], cells: Cells) -> FloorMotion:
    """The motion with a share of drag in each cell as a parameter, 0 for none."""
    plain = assembled(effects)
    shares = ca.SX.sym("share", len(cells.centres))
    robot = plain.mechanism

    def law(wheel: Wheel, u: ca.SX) -> ca.SX:
        place = robot.on_floor(wheel.platform, wheel.point)
        near = [
            ca.fmax(0, 1 - ca.fabs(place[k] - cells.centres[:, k]) / cells.side) for k in (0, 1)
        ]
        return -robot.parameters[f"k{wheel.platform}"] * ca.dot(shares, near[0] * near[1]) * u

    return solved(
        Assembly(
            plain.effects,
            with_wheel_forces(robot, law),
            plain.seen,
            (*plain.parameters, *cells.names),
            ca.vertcat(plain.p, shares),
        )
    )


Found = tuple[float, Mapping[str, float]]
"""What a patch would gain, and its values."""


def likely(cells: Cells, g: Array, H: Array) -> tuple[list[Found], list[Found]]:
    """The circles and the edges that gain most.

    g (n,), H (n, n): of the cost by the shares, everything else re-fitted.
    """
    x, y = cells.centres.T
    circles, edges = [], []
    for (cx, cy), size in itertools.product(cells.centres, (0.8, 1.3, 2.0)):
        radius = size * cells.side
        inside = (np.hypot(x - cx, y - cy) <= radius).astype(float)
        gain, share = _gain(inside, g, H)
        circles.append((gain, {"multiplier": share, "x": cx, "y": cy, "radius": radius}))
    for k in range(_DIRECTIONS):
        normal = 2 * math.pi * k / _DIRECTIONS - math.pi
        along = x * math.cos(normal) + y * math.sin(normal)
        for border in np.unique(np.round(along / cells.side))[1:] - 0.5:
            depth = border * cells.side
            gain, share = _gain((along > depth).astype(float), g, H)
            edge = {"edge_x": depth * math.cos(normal), "edge_y": depth * math.sin(normal)}
            edges.append((gain, {"multiplier": share, "normal": normal, **edge}))
    return _top(circles), _top(edges)


def _gain(inside: Array, g: Array, H: Array) -> tuple[float, float]:
    slope, bend = float(inside @ g), float(inside @ H @ inside)
    if bend <= 0:
        return 0.0, 1.0
    return slope**2 / bend, min(max(1.0 - slope / bend, 0.1), 8.0)


def _top(found: list[Found]) -> list[Found]:
    return sorted(found, key=lambda one: -one[0])[:_BEST]
