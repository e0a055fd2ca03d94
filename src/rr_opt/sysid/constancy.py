r"""Whether the recordings agree on a fit's values (parameter constancy, Chow 1960).

A real effect has the same values in every recording. An imitation of something else may fit each
recording down to the noise, but with different values. So each run r is tested against the others.
With B, g the curvature and gradient of its loss, and A, G those of the rest and the prior, its
score at the optimum of the others is

    s = g - B A^-1 G,    Var s = phi B + B (A^-1 C A^-1 + F) B.

No machine matches its model exactly, though. F is the variance of an effect's values due to its
form error e. The motion deviates, over about a correlation time, by the share e of what the effect
explains of the run, m (RMS in sigma), or, without an effect, by f, the misfit as far as machines
of this kind differ from any model: phi = 1 + ((e m)^2 + f^2) n/K with the samples n and
correlation times K of the run. C is A with each of the other runs weighted by its own phi. Values
at a bound are taken as known.

T, the sum of s' Var^-1 s over all runs, has expectation k, the number of values that each run
determines, summed over runs. If the values are not constant, T is larger by an unknown factor with
a log-uniform prior from 1 to `inconstant`. By Laplace's approximation the odds of constancy are

    (T/k)^(k/2) exp(-(T - k)/2) sqrt(k/(4 pi)) ln(inconstant)    where T > k.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from scipy.linalg import solve_triangular

from rr_opt.sysid.estimation import Fit, overdispersion, root, summed
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True)
class Constancy:
    """T and k over all runs."""

    statistic: float
    degrees: int

    @property
    def odds(self) -> float:
        """Odds that the values are constant; 1 if the runs say nothing about it."""
        k = self.degrees
        if not k:
            return 1.0
        ratio = max(self.statistic / k, 1.0)
        occam = math.sqrt(k / (4 * math.pi)) * math.log(SETTINGS.inconstant)
        return math.exp(-k / 2 * (ratio - 1 - math.log(ratio))) * occam

    @property
    def probability(self) -> float:
        """Probability that the values are constant."""
        return self.odds / (1 + self.odds)


_NONE: Mapping = MappingProxyType({})


def constancy(
    fit: Fit,
    left: float,
    explained: Mapping[int, float] = _NONE,
    form_errors: Mapping[str, float] = _NONE,
) -> Constancy:
    """Test a fit to all runs.

    left         misfit of whole-run simulations beyond the noise, RMS in sigma
    explained    by run, the mean square in sigma that the effects explain; 0 if not given
    form_errors  by effect name, the relative deviation of machines from its model
    """
    problem = fit.problem
    if not problem.names:
        return Constancy(0.0, 0)
    low, high = problem.box
    free = (fit.u > low) & (fit.u < high)
    values = fit.u + problem.centre / problem.scale
    form = np.array([form_errors.get(name.split(".")[0], 0.0) for name in problem.names])
    H, g, _ = summed(problem, fit.evidences, fit.u)
    H, g = H[free][:, free], g[free]
    # In units in which the information matrix is the identity.
    units = np.sqrt(np.diag(H))
    L = root(H / units / units[:, None])

    def within(x: np.ndarray) -> np.ndarray:
        return solve_triangular(L, (x.T / units).T, lower=True)

    spread = L.T * units @ np.diag((form * values)[free])
    F = spread @ spread.T
    share = max(form_errors.values(), default=0.0)
    B, phi = {}, {}
    for run, one in fit.evidences.items():
        B[run] = within(within(one.H[free][:, free]).T)
        off = share**2 * explained.get(run, 0.0) + min(left, problem.model.form_error) ** 2
        phi[run] = overdispersion(problem, run, off * problem.samples[run])
    unit = np.eye(len(H))
    every = unit + sum(((phi[run] - 1) * B[run] for run in B), np.zeros_like(H))
    statistic, degrees = 0.0, 0
    for run, one in fit.evidences.items():
        A = np.linalg.pinv(unit - B[run], hermitian=True)
        C = every - phi[run] * B[run]
        score = within(one.g[free]) - B[run] @ A @ within(g - one.g[free])
        known, ways = np.linalg.eigh(B[run] + B[run] @ (A + F) @ B[run])
        ways = ways[:, known > SETTINGS.shown]
        variance = phi[run] * B[run] + B[run] @ (A @ C @ A + F) @ B[run]
        seen = ways.T @ score
        statistic += float(seen @ np.linalg.solve(ways.T @ variance @ ways, seen))
        degrees += ways.shape[1]
    return Constancy(statistic, degrees)
