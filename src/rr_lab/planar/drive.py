"""A gait driven on a rig in the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from rr_lab.planar.forces import motor, turned_by
from rr_lab.planar.layout import layout
from rr_lab.planar.step import SIGNALS, step_of
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion, asked_angle
from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.outcome import NotConvergedError

STEP = 5e-4
"""s. results/lab/README.md shows what it is worth."""

STRIKING = 2.5e-4
"""s, the longest step of a rig in which parts strike each other: a blow takes some milliseconds."""

WILD = 1e3
"""m/s or rad/s: faster than any robot."""

_AT_ONCE = 100
"""Samples that are computed in one call."""


@dataclass(frozen=True)
class Clock:
    """The steps of an conditions, `every` to a sample; `before` samples come before the recording.

    t  command time at the ends of the steps, s, and of two steps before the first
    """

    dt: float
    every: int
    before: int
    t: Array

    @classmethod
    def of(cls, rig: Rig, gait: Gait, conditions: Conditions, step: float) -> Clock:
        """Steps of about `step` s that begin before the command does."""
        every = max(1, round(1 / (conditions.rate * fine_enough(rig, step))))
        dt = 1 / (conditions.rate * every)
        early = (rig.clock - conditions.begin(gait)) * conditions.rate
        before = max(1, math.ceil(early - 1e-6))
        samples = before + round(conditions.seconds * conditions.rate)
        ends = np.arange(-1, samples * every + 1, dtype=float) - before * every
        return cls(dt, every, before, rig.clock + dt * ends)

    @property
    def samples(self) -> slice:
        """Of steps: those at whose ends samples are taken."""
        return slice(self.before * self.every - 1, None, self.every)


def fine_enough(rig: Rig, step: float) -> float:
    """The step actually used if `step` is requested, s: no longer than its blows
    let it be."""
    return min(step, STRIKING) if rig.play or rig.pin else step


def drive(rig: Rig, gait: Gait, conditions: Conditions, step: float = STEP) -> Motion:
    """Drive a gait and write down the motion. Raises NotConvergedError if it is lost."""
    clock, begin = Clock.of(rig, gait, conditions, step), conditions.begin(gait)
    asked = asked_angle(rig, gait, begin, clock.t)
    # The difference by which steps are made, so that what is asked and what is done compare.
    rate = (3 * asked[2:] - 4 * asked[1:-1] + asked[:-2]) / (2 * clock.dt)
    t = clock.t[2:]
    nudge = np.zeros(len(t))
    nudge[clock.samples.start + 1 : clock.samples.start + 2] = conditions.nudge / clock.dt
    free = np.where(t > begin + 1e-12, 1.0, 0.0)
    signals = np.stack([asked[2:], rate, t - begin, free, nudge])
    assert len(signals) == len(SIGNALS)
    return _motion(rig, conditions, clock, _run(rig, clock, conditions, asked[1], signals), signals)


def still(rig: Rig, conditions: Conditions, angle: float) -> Array:
    """Two states one after the other, at rest with the joint at an angle, rad."""
    built = layout(rig)
    state = np.zeros(2 * len(built.names) + 8)
    state[:3], state[built.names.index("phi")] = conditions.pose, angle
    if "shaft" in built.names:
        state[built.names.index("shaft")] = angle
    return np.concatenate([state, state])


def require_tame(rates: Array) -> None:
    """Raise NotConvergedError for huge rates."""
    if not np.abs(rates).max() < WILD:
        raise NotConvergedError(
            "The laboratory's simulation broke down: the planar engine met huge speeds. Expected a "
            "motion. Take a gentler gait, a weaker effect or a smaller step."
        )


def _run(rig: Rig, clock: Clock, conditions: Conditions, angle: float, signals: Array) -> Array:
    """The states (k, samples), those before the recording among them, from rest at `angle` rad."""
    built = layout(rig)
    sample = step_of(rig, clock.dt).fold(clock.every)
    samples, part = sample.mapaccum(_AT_ONCE), _AT_ONCE * clock.every
    state, found = ca.DM(still(rig, conditions, angle)), []
    half = state.numel() // 2
    for at in range(0, signals.shape[1], part):
        piece = signals[:, at : at + part]
        given = np.pad(piece, ((0, 0), (0, part - piece.shape[1])), mode="edge")
        made: ca.DM = samples(state, given)
        state = made[:, -1]
        found.append(np.asarray(made)[half:, : piece.shape[1] // clock.every])
    states = np.concatenate(found, axis=1)
    require_tame(states[len(built.names) : 2 * len(built.names)])
    return states


def _motion(
    rig: Rig, conditions: Conditions, clock: Clock, states: Array, signals: Array
) -> Motion:
    built = layout(rig)
    n = len(built.names)
    states, signals = states[:, clock.before - 1 :], signals[:, clock.samples]
    ends = ca.Function("ends", [built.q], list(built.ends))
    one, two = (np.asarray(end).T for end in ends(states[:n]))
    made, drive = built.names.index(turned_by(built)), motor(rig)
    t = np.arange(states.shape[1]) / conditions.rate
    if not conditions.torque:
        return Motion(t, one, two)
    torque = drive.stiffness * (signals[0] - states[made])
    torque += drive.damping * (drive.feedforward * signals[1] - states[n + made])
    return Motion(t, one, two, torque)
