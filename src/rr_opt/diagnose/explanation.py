"""A set of effects fitted to the recordings, and how much of them it leaves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rr_opt.diagnose.explain import Chosen
from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.problem import scaled

_UNSEEN = 1e-3
"""Chi-square that says nothing of a quantity: of where along an edge a point of it is."""

FLOOR = 0.1
"""A misfit of a tenth of a sigma, RMS, is none: no machine is ever exactly its model."""


@dataclass(frozen=True)
class Explanation:
    """A set of effects, fitted in windows and over whole runs.

    misfit  mean square of the residuals over whole runs less 1, in sigma squared; 0 is the noise
    """

    chosen: tuple[Chosen, ...]
    windows: Fit
    whole: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """The effects, in order of choice."""
        return tuple(one.name for one in self.chosen)

    @property
    def misfit(self) -> float:
        """Mean square over whole runs, less that of noise with as many quantities fitted."""
        return misfit(self.whole)

    @property
    def strain(self) -> float:
        """Chi-square of the parameters against what was known of them."""
        known = [q for q in self.whole.quantities if q.known and not q.free]
        return float(np.sum(scaled(known, self.whole.values) ** 2))

    @property
    def score(self) -> float:
        """Chi-square of data and knowledge, and what each quantity that they tell costs (BIC)."""
        added = [k for k, q in enumerate(self.whole.quantities) if not q.known]
        seen = self.whole.total().H[np.ix_(added, added)]
        told = int(np.linalg.matrix_rank(seen, tol=_UNSEEN, hermitian=True)) if added else 0
        return self.whole.cost + self.strain + told * math.log(self.whole.count)

    def apart(self) -> float:
        """Of what the effect that came last does, squared, the share that no values imitate."""
        fit, own = self.whole, f"{self.names[-1]}."
        total, u = fit.total(), fit.scaled
        its = np.array([q.name.startswith(own) for q in fit.quantities])
        neutral = scaled(fit.quantities, {q.name: q.neutral for q in fit.quantities})
        gone = (neutral - u)[its]
        push = total.H[np.ix_(~its, its)] @ gone
        does = float(gone @ total.H[np.ix_(its, its)] @ gone)
        imitated = float(push @ np.linalg.pinv(total.H[np.ix_(~its, ~its)], hermitian=True) @ push)
        return 1.0 - imitated / does if does > 0 else 0.0


def misfit(fit: Fit) -> float:
    """Mean square of the residuals in sigma, less 1."""
    return fit.cost / _freedom(fit) - 1.0


def chance(fit: Fit) -> float:
    """Of noise alone to leave as much."""
    return float(chi2.sf(fit.cost, _freedom(fit)))


def _freedom(fit: Fit) -> int:
    """The values there are beyond those that were fitted."""
    fitted = sum(start.size for start in fit.starts.values()) + len(fit.quantities)
    return max(fit.count - fitted, 1)


def rms(excess: float) -> float:
    """The misfit as RMS in sigma, 0 at or below the noise."""
    return math.sqrt(max(excess, 0.0))


def certain(excess: float, count: int, z: float = 3.1) -> float:
    """The misfit of so many values, RMS in sigma, less what noise reaches once in a thousand."""
    return rms(excess - z * math.sqrt(2 / max(count, 1)))
