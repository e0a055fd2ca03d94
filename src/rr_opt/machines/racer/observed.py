"""The recorded motion of a Roller Racer: where its wheels went, and how fast."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from rr_opt.array import Array
from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.simulation import speeds_of
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays
from rr_opt.motion.dynamics import assembled
from rr_opt.sysid.model import Request, Segment
from rr_opt.sysid.paths import DrivePath, Path

_WINDOW = 0.5
"""The prediction's error changes little over this time, s."""


@dataclass(frozen=True)
class Along:
    """What an unknown input may depend on, along a predicted run of n samples.

    t (n,) s;  x, y (n,) m of the joint and psi (n,) rad
    u       rolling speed of the wheels (4, n), in the order of PUSHES, m/s
    places  of the wheels on the floor (4, 2, n), m
    """

    t: Array
    x: Array
    y: Array
    psi: Array
    u: Array
    places: Array

    @property
    def axles(self) -> Array:
        """The rolling speed of axle 1 and 2 (2, n), m/s."""
        return (self.u[::2] + self.u[1::2]) / 2


def observed(
    racer: RacerModel, requests: Sequence[Request], effects: tuple[str, ...]
) -> list[Along]:
    """The recorded motion: the prediction plus the smooth part of its error."""
    predicted = racer.simulator.paths(requests, effects)
    return [
        _observed(racer, one.segment, effects, *path[:3])
        for one, path in zip(requests, predicted, strict=True)
    ]


def _observed(
    racer: RacerModel,
    segment: Segment,
    effects: tuple[str, ...],
    path: DrivePath,
    made: Path,
    p: Array,
) -> Along:
    mechanical = racer.simulator.every(effects)
    data = racer.runs[segment.run]
    t = data.t[segment.span]
    states = made.states[:, :: path.each]
    # Beside the joint's pose, not that of the marker or with the capture system's zeros.
    pose, rate = _smooth(t, states[:3].T, data.values[segment.span, :3] - made.seen[:, :3])
    _, s1, s2, _ = speeds_of(mechanical)(*states, *path.at, *p)
    phi, dphi = path.at[:2]
    v = rate[0] * np.cos(pose[2]) + rate[1] * np.sin(pose[2])
    u = np.array(_rolling(mechanical)(v, s1, s2, dphi, phi, *p))
    places = np.array(_places(mechanical)(*pose, phi, *p)).reshape(4, 2, t.size)
    x, y, psi = pose
    return Along(t, x, y, psi, u, places)


def _smooth(t: Array, predicted: Array, off: Array) -> tuple[Array, Array]:
    """The prediction plus its error, both (n, k), without noise, and its rate of change (k, n).
    Where nothing was recorded the prediction stands."""
    step = float(np.median(np.diff(t)))
    half = max(round(_WINDOW / step / 2), 2)
    for column in off.T:
        good = np.isfinite(column)
        column[~good] = np.interp(t[~good], t[good], column[good]) if good.any() else 0.0
    value, slope = _parabolas(off, half, step)
    return (predicted + value).T, (np.gradient(predicted, t, axis=0) + slope).T


def _parabolas(y: Array, half: int, step: float) -> tuple[Array, Array]:
    """Value and slope (n, k) of the parabola through the `half` samples before and after each, and
    at the ends of the first and the last: the filter of Savitzky and Golay (Analytical Chemistry
    36, 1964, p. 1627). SciPy has it in a package that takes half a second to load."""
    fit = np.linalg.pinv(np.vander(step * np.arange(-half, half + 1), 3))
    each = np.arange(len(y))
    middle = np.clip(each, half, len(y) - 1 - half)
    beyond = (step * (each - middle))[:, None]
    a, b, c = np.moveaxis((sliding_window_view(y, 2 * half + 1, 0) @ fit.T)[middle - half], 2, 0)
    return (a * beyond + b) * beyond + c, 2 * a * beyond + b


@lru_cache
def _rolling(effects: tuple[str, ...]) -> ArrayFunction:
    """(speeds, phi, p) -> the rolling speeds of the wheels (4,), m/s."""
    assembly = assembled(effects, for_prediction=True)
    robot = assembly.mechanism
    rolling = ca.vertcat(*(robot.rolling_speed(wheel) for wheel in robot.wheels))
    return over_arrays(ca.Function("rolling", [robot.speeds, robot.phi, assembly.p], [rolling]))


@lru_cache
def _places(effects: tuple[str, ...]) -> ArrayFunction:
    """(pose, phi, p) -> x, y of the wheels on the floor, one wheel after the other (8,), m."""
    assembly = assembled(effects, for_prediction=True)
    robot = assembly.mechanism
    places = ca.vertcat(
        *(robot.floor_position(wheel.platform, wheel.point) for wheel in robot.wheels)
    )
    return over_arrays(ca.Function("places", [robot.pose, robot.phi, assembly.p], [places]))
