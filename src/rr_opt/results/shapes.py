"""What waveforms are worth: the fastest gait of each family, side by side."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from rr_opt.model.problem import GaitBounds
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Check, Result

MISSED = 1e-4
"""A family that contains another and comes out slower by more than this, relative, missed an
optimum; less is what solvers leave."""


@dataclass(frozen=True, repr=False)
class FastestShapes(Result):
    """The fastest gait of each family of waveforms under the same limits.

    answers   a FastestGait for the sine, 3 and 5 harmonics, and a free gait: each family contains
              the one before
    """

    REPORT = "rr_opt.report.shapes"

    name: str
    sha256: str
    answers: tuple[FastestGait, ...]

    @property
    def solved(self) -> list[FastestGait]:
        """Those with a confirmed optimum."""
        return [one for one in self.answers if one.status is Status.OPTIMAL]

    @property
    def status(self) -> Status:
        """The worst of them all."""
        order = [Status.NOT_CONVERGED, Status.INFEASIBLE, Status.OPTIMAL]
        return min((one.status for one in self.answers), key=order.index)

    @property
    def checks(self) -> list[Check]:
        """Those of all families."""
        return [check for one in self.answers for check in one.checks]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Those of any family: all have one robot."""
        return self.answers[0].warnings

    def gain(self, answer: FastestGait) -> float | None:
        """Speed over the sine's, less 1; None if either has no gait."""
        speed, sine = answer.speed, self.answers[0].speed
        return None if speed is None or sine is None else abs(speed) / abs(sine) - 1

    @property
    def message(self) -> str:
        """How much faster than a sine the other waveforms are, in a sentence."""
        failed = [
            f"{family(one)}: {one.message}"
            for one in self.answers
            if one.status is not Status.OPTIMAL
        ]
        solved = [(one, abs(one.speed)) for one in self.solved if one.speed is not None]
        if failed or len(solved) < 2:
            return " ".join(failed)
        speeds = ", ".join(f"{1e3 * speed:.1f} mm/s with {_with(one)}" for one, speed in solved)
        gain = 100 * (solved[-1][1] / solved[0][1] - 1)
        text = f"Under the same limits {speeds}: {gain:.1f} % more than the best sine."
        for (smaller, slow), (larger, fast) in pairwise(solved):
            if fast < slow * (1 - MISSED):
                text += (
                    f" But {family(larger)} came out slower than {family(smaller)}, which it "
                    "contains: a better gait was missed."
                )
        return text


def family(answer: FastestGait) -> str:
    """`sine`, `3 harmonics` or `free`."""
    return family_name(answer.problem.gait)


def family_name(gait: GaitBounds) -> str:
    """`sine`, `3 harmonics` or `free`."""
    return f"{gait.harmonics} harmonics" if gait.shape == "fourier" else gait.shape


def _with(answer: FastestGait) -> str:
    shape = answer.problem.gait.shape
    return {"free": "a free gait", "sine": "a sine"}.get(shape, family(answer))
