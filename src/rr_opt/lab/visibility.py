"""How visible what is hidden in a case is, told by the laboratory itself.

A run of the case is held against the same run of the nominal robot, both without noise, after the
initial state has been fitted: place, heading, and the speed with which the run begins. What is left
is measured in standard deviations of the noise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.experiment import Noise
from rr_opt.lab.capture import captured
from rr_opt.lab.case import Case, Plan, motion_of
from rr_opt.lab.effects import rig_with
from rr_opt.lab.engines import driven
from rr_opt.lab.outing import Motion
from rr_opt.lab.streams import stream

Array = NDArray[np.float64]

COARSE = 1e-3
"""s, the step: strength is not needed to better than a per cent."""

NUDGE = 0.02
"""m/s, the change of speed by which the run's sensitivity to it is measured."""

EXACT = Noise(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Reference:
    """A nominal run, (4, n) each: x, y, psi, phi, and their change for 1 m/s more at the start."""

    path: Array
    change: Array
    sigma: Array

    @classmethod
    def of(cls, case: Case, plan: Plan, step: float = COARSE) -> Reference:
        """Drive the nominal robot twice."""
        sigma = np.array([case.noise.of(channel) for channel in ("x", "y", "psi", "phi")])
        base, nudged = (
            _channels(
                driven(
                    case.engine,
                    rig_with(case.nominal),
                    plan.gait,
                    replace(plan.outing, nudge=nudge),
                    step,
                )
            )
            for nudge in (0.0, NUDGE)
        )
        return cls(base, (nudged - base) / NUDGE, sigma[:, None])

    def left(self, seen: Array) -> float:
        """RMS deviation of a run from this one, in sigma, once its initial state is fitted."""
        from scipy.optimize import least_squares  # noqa: PLC0415 - seldom needed

        def residual(p: Array) -> Array:
            x, y, psi, phi = self.path + p[3] * self.change
            cos, sin = np.cos(p[2]), np.sin(p[2])
            moved = np.array([cos * x - sin * y + p[0], sin * x + cos * y + p[1], psi + p[2], phi])
            return ((seen - moved) / self.sigma).ravel()

        found = least_squares(residual, np.zeros(4), x_scale=(0.1, 0.1, 0.1, 0.01))
        return float(np.sqrt(np.mean(found.fun**2)))


@dataclass(frozen=True)
class Gauge:
    """Nominal runs by their plans; called with a case of the same nominal robot and the same plans,
    it tells the RMS deviation of the case from them, in sigma."""

    references: tuple[tuple[Plan, Reference], ...]

    @classmethod
    def of(cls, case: Case, count: int | None = None) -> Gauge:
        """The gauge of a case, on all its runs or on the first `count`."""
        return cls(tuple((plan, Reference.of(case, plan)) for plan in case.plans[:count]))

    def __call__(self, case: Case) -> float:
        """RMS over the runs."""
        tracked = rig_with(case.robot, case.effects).tracked
        left = [
            reference.left(_channels(motion_of(case, plan, COARSE), tracked))
            for plan, reference in self.references
        ]
        return float(np.sqrt(np.mean(np.square(left))))


def _channels(motion: Motion, tracked: tuple[float, float] = (0.0, 0.0)) -> Array:
    recording = captured(motion, "", EXACT, stream(0), tracked=tracked)
    return np.array(list(recording.values.values()))
