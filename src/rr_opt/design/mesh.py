"""The nodes of the winner's mesh: as many as its accuracy needs, and some where torque peaks.

A limit that holds at every node can be broken between two. The sine's angle and rate have their
extremes at known phases and are limited there; the torque's peaks depend on the solution, so
nodes are moved onto them and the program is solved again. The peak's phase then errs only by
what the second solve moves it, and the torque there only by the square of that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.landscape import Landscape
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

LADDER = (16, 20, 24, 30, 36, 48, 72, 96, 144, 192, 288, 384, 768)
"""Meshes to choose from, so that few programs are ever built."""

_SAMPLES = 1024
_NEAR_LIMIT = 0.98


@dataclass(frozen=True)
class Dense:
    """A gait's steady cycle on a mesh far finer than the program's.

    speed   m/s, signed
    peak    largest |torque|, N m
    peaks   phases in [0, 1) at which |torque| peaks near `peak`
    """

    speed: float
    peak: float
    peaks: Array


def dense(landscape: Landscape, robot: Robot, gait: SineGait, share: float) -> Dense:
    """Look at a gait finely; robot is the one with that ballast share."""
    if landscape.linear:
        point = np.array([[gait.amplitude], [gait.period], [gait.offset], [share]])
        cycle = landscape.cycles(point, _SAMPLES)
        speed, torque = float(cycle.speed[0]), cycle.torque[:, 0]
    else:
        steady = steady_cycle(robot, gait, steps=4 * _SAMPLES)
        speed, torque = steady.speed, steady.torque[:-1:4]
    size = np.abs(torque)
    left, right = np.roll(size, 1), np.roll(size, -1)
    at = np.flatnonzero((size >= left) & (size > right) & (size > _NEAR_LIMIT * size.max()))
    # Vertex of the parabola through a peak and its neighbours.
    bend = left[at] - 2 * size[at] + right[at]
    shift = np.where(bend < 0, 0.5 * (left[at] - right[at]) / np.where(bend < 0, bend, -1.0), 0.0)
    height = size[at] - 0.25 * (left[at] - right[at]) * shift
    return Dense(speed, float(height.max()), (at + shift) / _SAMPLES % 1.0)


def mesh_for(intervals: int, error: float, wanted: float, order: int = 6) -> int:
    """The mesh of the ladder on which the error made with so many intervals, which falls with
    this order, becomes the wanted one."""
    needed = intervals * (error / wanted) ** (1 / order)
    return next((n for n in LADDER if n >= needed), LADDER[-1])


def with_nodes_at(intervals: int, peaks: Array) -> Array:
    """Equal phases with the nearest node moved onto each peak; the first stays at 0."""
    phases = np.arange(intervals) / intervals
    for peak in peaks:
        nearest = round(peak * intervals) % intervals
        if nearest:
            phases[nearest] = peak
    return phases
