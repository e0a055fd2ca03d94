"""The markers on the robot, as a motion capture system sees them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_lab.run import Motion
from rr_opt.array import Array
from rr_opt.model.robot import Robot

HEIGHTS = (0.06, 0.07, 0.065, 0.08)
"""m above the floor; all differ, so that no two sets of markers look alike."""

Places = Mapping[str, tuple[float, float, float]]
"""By marker: forward, left and up of P's point on the floor, m, in its platform's axes."""


@dataclass(frozen=True)
class Seen:
    """Marker positions: labels (k) and positions (n, k, 3), m, NaN where one was not seen."""

    labels: tuple[str, ...]
    positions: Array
    rate: float


def places(robot: Robot) -> tuple[Places, Places]:
    """Four markers on each platform, on corners of no symmetry.

    Platform 1's forward axis goes from P to its axle, platform 2's from its axle to P.
    """
    first = _corners("RR", robot.platform1.c, robot.platform1.b, 1.0)
    second = _corners("RF", robot.platform2.c, robot.platform2.b, -1.0)
    return first, second


def _corners(name: str, c: float, b: float, ahead: float) -> Places:
    spots = ((0.15 * c, 0.5 * b), (0.45 * c, -0.8 * b), (0.9 * c, 0.9 * b), (1.15 * c, -0.6 * b))
    return {
        f"{name}{n + 1}": (round(ahead * x, 4), round(y, 4), HEIGHTS[n])
        for n, (x, y) in enumerate(spots)
    }


def seen(
    motion: Motion,
    robot: Robot,
    sigma: float,
    rng: np.random.Generator,
    *,
    tracked: tuple[float, float] = (0.0, 0.0),
    missing: float = 0.0,
) -> Seen:
    """The markers of a motion with white noise of `sigma` (m) on each coordinate.

    tracked  how far platform 1's markers sit from where the layout says, m
    missing  fraction of time for which each marker is hidden, in gaps of a tenth of a second
    """
    first, second = places(robot)
    parts = [_placed(motion.one, first, tracked), _placed(motion.two, second, (0.0, 0.0))]
    positions = np.concatenate(parts, axis=1)
    positions = positions + sigma * rng.standard_normal(positions.shape)
    rate = 1 / (motion.t[1] - motion.t[0])
    positions[_hidden(rng, positions.shape[:2], missing, rate)] = np.nan
    return Seen((*first, *second), positions, rate)


def _placed(pose: Array, spots: Places, moved: tuple[float, float]) -> Array:
    """(n, k, 3) of the markers of a body whose joint end is at pose (n, 3)."""
    forward, left, up = (np.array(one) for one in zip(*spots.values(), strict=True))
    forward, left = forward + moved[0], left + moved[1]
    x, y, heading = (part[:, None] for part in pose.T)
    cos, sin = np.cos(heading), np.sin(heading)
    planar = (x + cos * forward - sin * left, y + sin * forward + cos * left)
    return np.stack([*planar, np.broadcast_to(up, planar[0].shape)], axis=2)


def _hidden(
    rng: np.random.Generator, shape: tuple[int, int], missing: float, rate: float
) -> NDArray[np.bool_]:
    long = max(1, round(0.1 * rate))
    blocks = rng.random((shape[0] // long + 1, shape[1])) < missing
    return np.repeat(blocks, long, axis=0)[: shape[0]]
