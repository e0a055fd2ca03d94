"""The evidence on nuisances: the channels, and their deviation from rolling wheels.

Over a stride the joint P moves by (dx, dy), the heading psi by dpsi and phi by dphi. Without side
slip, with the mean headings h and h2 = h + phi,

    axle 1:  -sin(h) dx + cos(h) dy + c1 dpsi = 0
    axle 2:  -sin(h2) dx + cos(h2) dy - c2 (dpsi + dphi) = 0

hold whatever forces act. Both are linear in the noise, so their residuals have a known size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from scipy.special import ndtri

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS, Recording, Start
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.recordings.clock_fit import ClockFit, against_command
from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import Notice

Motion = tuple[Array, Array, Array, Array]
"""x, y, psi and phi (n,), NaN where there are no data."""

_SHARE, _STRIDE = 0.1, 0.1
"""A stride in periods of the gait, and in s where no gait is known."""
_SHORTEST, _LONGEST = 1e-3, 1.0
"""Range of c1 and c2 where no robot is known, m."""
_BULK = 0.8
_WITHIN = float(ndtri((1 + _BULK) / 2))
"""Standard deviations that hold this share of a normal distribution."""
_MOST = 20_000
"""Most strides that are used, spread over the recording."""


@dataclass(frozen=True)
class Slip:
    """Residuals of both axles' constraints (n - stride,), m, and their noise, m.

    along  how far axle 1 rolls, m
    """

    first: Array
    second: Array
    noise: tuple[float, float]
    along: Array

    @cached_property
    def size(self) -> float:
        """Root mean square, in noise; momentary outliers are clipped to three times the usual.

        0 without any usable stride.
        """
        squares = []
        for row, noise in zip((self.first, self.second), self.noise, strict=True):
            sizes = np.sort(np.abs(row[np.isfinite(row)]))
            n = len(sizes)
            if not n:
                return 0.0
            usual = np.interp(_BULK * (n - 1), np.arange(n), sizes) / _WITHIN
            squares.append(float(np.mean(np.minimum(sizes, 3 * usual) ** 2)) / noise**2)
        return float(np.sqrt(np.mean(squares)))


@dataclass(frozen=True)
class ExaminedRecording:
    """A cleaned recording, and what is known about how it was made; None: not known.

    clock_known  the offset of the recording's clock is known from a servo's log
    framed       the zeros of psi and phi, and the platforms' order, are those of the robot
    """

    recording: Recording
    robot: Robot | None = None
    gait: Gait | None = None
    start: Start = "running"
    clock_known: bool = False
    framed: bool = True

    @cached_property
    def t(self) -> Array:
        """Times (n,), s."""
        return self.recording.t

    @cached_property
    def step(self) -> float:
        """The usual time step, s."""
        return time_step(self.t)

    @cached_property
    def motion(self) -> Motion:
        """The values that are taken as data."""
        x, y, psi, phi = (self.recording.data(name) for name in CHANNELS)
        return x, y, psi, phi

    @cached_property
    def sigma(self) -> Array:
        """Noise of the four channels: the larger of the stated and the estimated one."""
        stated = [float(np.nanmedian(self.recording.sigma[name])) for name in CHANNELS]
        seen = [noise_of(values).sigma for values in self.motion]
        return np.fmax(np.fmax(stated, seen), 1e-9)

    @cached_property
    def command(self) -> ClockFit | None:
        """phi against its command; None without a gait, or if they cannot be matched."""
        if self.gait is None:
            return None
        rest = self.start == "rest"
        return against_command(self.t, self.motion[3], self.gait, from_rest=rest)

    @cached_property
    def stride(self) -> int:
        """Samples of a stride."""
        seconds = self.gait.period * _SHARE if self.gait else _STRIDE
        return int(np.clip(round(seconds / self.step), 1, max(1, len(self.t) // 20)))

    @cached_property
    def slip(self) -> Slip:
        """The slip of the recording as it is."""
        return self.slip_of(self.motion)

    def _strides(self, motion: Iterable[Array], every: int = 1) -> list[Array]:
        """dx, dy, dpsi and dphi over every `every`-th stride, and the means of psi and phi."""
        ends = [(one[: -self.stride : every], one[self.stride :: every]) for one in motion]
        moved = [last - first for first, last in ends]
        return [*moved, *((first + last) / 2 for first, last in ends[2:])]

    def slip_of(self, motion: Iterable[Array], every: int = 1, scale: float = 1.0) -> Slip:
        """The slip of a hypothetical motion, at every `every`-th stride.

        scale: of x and y, and so of their noise, relative to the recording.
        """
        dx, dy, dpsi, dphi, h, turn = self._strides(motion, every)
        side1, along = np.cos(h) * dy - np.sin(h) * dx, np.cos(h) * dx + np.sin(h) * dy
        side2 = np.cos(h + turn) * dy - np.sin(h + turn) * dx
        dpsi2 = -(dpsi + dphi)
        c1, c2 = self._length(0, side1, dpsi), self._length(1, side2, dpsi2)
        sx, _, spsi, sphi = self.sigma * (scale, scale, 1.0, 1.0)
        noise = np.hypot(sx, c1 * spsi), np.hypot(sx, c2 * np.hypot(spsi, sphi))
        first, second = (float(np.sqrt(2) * one) for one in noise)
        return Slip(side1 + c1 * dpsi, side2 + c2 * dpsi2, (first, second), along)

    @cached_property
    def forgiven(self) -> Slip:
        """The slip of the recording once small faults that any laboratory has are removed: a point
        tracked beside the joint, zeros of psi and phi, and lengths."""
        dx, dy, dpsi, dphi, h, turn = self._strides(self.motion)
        along2 = np.cos(h + turn) * dx + np.sin(h + turn) * dy
        beside = dpsi * np.cos(turn), dpsi * np.sin(turn)
        slip = self.slip
        return replace(
            slip,
            first=_rest(slip.first, dpsi, slip.along),
            second=_rest(slip.second, dpsi + dphi, along2, *beside),
        )

    @cached_property
    def sideways(self) -> float:
        """Sideways motion of the joint per turn of platform 1, m per rad: c1, if all is right."""
        dx, dy, dpsi, _, h, _ = self._strides(self.motion)
        return _lever(np.cos(h) * dy - np.sin(h) * dx, dpsi)

    def _length(self, axle: int, side: Array, turned: Array) -> float:
        """c1 or c2, m: the robot's, else the one that fits best."""
        if self.robot is not None:
            return (self.robot.platform1, self.robot.platform2)[axle].c
        return float(np.clip(_lever(side, turned), _SHORTEST, _LONGEST))

    def explains(self, motion: Iterable[Array], scale: float = 1.0) -> float:
        """The slip of another motion, in noise, if it explains the recording; else infinity.

        Its wheels have to roll, or to slip by a fraction of what they do as recorded.
        """
        if not self.framed or self.slip.size < ROLLING:
            return np.inf
        every = max(1, len(self.t) // _MOST)
        now, then = self.slip.size, self.slip_of(motion, every, scale).size
        rolls = then < CLEAN and now > ROLLING * then
        sure = self._likelier(now, then) > _SURE
        return then if sure and (rolls or now > FAR * then) else np.inf

    def is_wrong(self, best: float) -> bool:
        """Whether rolling wheels contradict the recording, compared with a motion of this slip: by
        far, or even if small faults are forgiven."""
        left = self.forgiven.size
        rolls = best < ROLLING < left and self._likelier(left, best) > _SURE
        return rolls or self.slip.size > FAR * best

    def likely(self, left: Mapping[Name, float]) -> list[Name]:
        """Names whose slip is about as small as the best one's."""
        best = min(left.values(), default=np.inf)
        if not np.isfinite(best):
            return []
        return [name for name, one in left.items() if self._likelier(one, best) < _UNSURE]

    def _likelier(self, now: float, then: float) -> float:
        """Gain in log likelihood from a smaller slip; strides are independent."""
        return len(self.t) / self.stride * float(np.log(max(now, 1e-9) / max(then, 1e-9)))


def _lever(side: Array, turned: Array) -> float:
    """The c of side + c turned = 0, by least squares."""
    known = np.isfinite(side) & np.isfinite(turned)
    swings = float(turned[known] @ turned[known])
    return -float(side[known] @ turned[known]) / swings if swings > 0 else 0.0


def _rest(row: Array, *causes: Array) -> Array:
    """The residual of a row (n,) after a least-squares fit of its causes."""
    A = np.column_stack(causes)
    known = np.isfinite(row) & np.isfinite(A).all(axis=1)
    return row - A @ np.linalg.lstsq(A[known], row[known], rcond=None)[0]


ROLLING, CLEAN, FAR = 1.1, 1.3, 3.0
"""Slip of rolling wheels, in noise; the same with c uncertain; and ratio to the slip of the right
motion where wheels slide."""
_SURE, _UNSURE = 15.0, 5.0
"""Log likelihood by which another motion must be likelier, and by which it must not be."""

Name = TypeVar("Name")

Look = Callable[[ExaminedRecording], Iterable[Notice]]
