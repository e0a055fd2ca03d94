r"""Estimation by multiple shooting, with process noise.

A run is cut into segments, each with an initial state of its own. Between the end of one segment
and the start of the next, states may differ by process noise of strength q (times `state_scale`):

    E_r = sum of squared residuals of run r
          + sum over gaps |end_k - start_k+1|^2/((q scale)^2 + least^2)
          + |start_1|^2/prior^2 of the states that are known to be about 0

`least` is how far machines of this kind deviate from any model (`Model.least_process_noise`). With
q = 0 and least = 0 this is single shooting; with q large the segments are independent. A correct
model needs next to no process noise, an incomplete one as much as it lacks. q is estimated by
marginal likelihood (Laplace's approximation), so that a wrong model is not asked to predict for
longer than it can, and does not bias the parameters.

The initial states are eliminated by a Schur complement, run by run. Model error is correlated from
sample to sample, so a run's misfit beyond the noise counts as

    loss = n + K log(1 + (E - n)/K),

K the number of correlation times in the run's channels, n its degrees of freedom: the marginal
likelihood with a model-error variance estimated from the run itself. For a good fit this is E.

References: Bock (1983) for multiple shooting; Kristensen, Madsen, Jorgensen (2004) for process
noise in grey-box models; Kennedy and O'Hagan (2001) for model error.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError, cho_solve, cholesky, solve_triangular
from scipy.optimize import lsq_linear

from rr_opt.array import Array
from rr_opt.sysid.model import (
    Linearisation,
    Model,
    Quantity,
    Request,
    Segment,
    Simulation,
    segments,
)
from rr_opt.sysid.settings import SETTINGS

States = Mapping[Segment, Array]

_ATTEMPTS = 8
"""Tries per step, each less than a third as long as the one before."""


@dataclass(frozen=True)
class Evidence:
    """-2 log of a run's marginal likelihood, about the linearisation point.

    loss(d) = value + 2 g'd + d'Hd in the scaled quantities, the states eliminated

    samples   effective number of independent samples, less the number of states
    excess    E - samples
    log       log determinants of the states and of the process noise
    shift     of the stacked initial states to their optimum;  follow  its derivative by d
    """

    samples: float
    excess: float
    value: float
    log: float
    g: Array
    H: Array
    shift: Array
    follow: Array

    @classmethod
    def diverged(cls, samples: float, states: int, quantities: int) -> Evidence:
        """Of a run that cannot be simulated at or near this point."""
        g, H = np.zeros(quantities), np.zeros((quantities, quantities))
        shift, follow = np.zeros(states), np.zeros((states, quantities))
        return cls(samples, math.inf, math.inf, 0.0, g, H, shift, follow)

    def at(self, d: Array) -> float:
        """The loss after a change d."""
        return float(self.value + 2 * self.g @ d + d @ self.H @ d)

    def spread(self, sigma: Array) -> Evidence:
        """The evidence if the run's scaled quantities deviate from the common ones by one sigma."""
        if not sigma.any() or math.isinf(self.value):
            return self
        across = self.H * sigma
        try:
            factor = cholesky(np.eye(sigma.size) + sigma[:, None] * across, lower=True)
        except LinAlgError:
            # Directions that elimination left with negative curvature say nothing.
            w, V = np.linalg.eigh(self.H)
            return replace(self, H=(V * np.maximum(w, 0)) @ V.T).spread(sigma)
        half = solve_triangular(factor, across.T, lower=True)
        pull = solve_triangular(factor, sigma * self.g, lower=True)
        return replace(
            self,
            value=self.value - float(pull @ pull),
            log=self.log + 2 * float(np.sum(np.log(np.diag(factor)))),
            g=self.g - half.T @ pull,
            H=self.H - half.T @ half,
        )


def robust(excess: float, correlation_times: float) -> float:
    """A run's loss beyond its degrees of freedom."""
    if excess <= 0:
        return excess
    return correlation_times * math.log1p(excess / correlation_times)


def root(H: Array) -> Array:
    """The Cholesky factor (lower) of an information matrix, which rounding in the elimination may
    leave slightly indefinite where the motion is unstable."""
    for ridge in (0.0, 1e-12, 1e-9, 1e-6):
        try:
            return cholesky(H + ridge * np.diag(np.abs(np.diag(H))), lower=True)
        except LinAlgError:
            continue
    return cholesky(H + 2 * np.diag(np.abs(H).sum(axis=1)), lower=True)


def bounded_minimum(H: Array, g: Array, low: Array, high: Array) -> Array:
    """The d within bounds that minimises 2 g'd + d'Hd."""
    d = -cho_solve((root(H), True), g)
    if (d >= low).all() and (d <= high).all():
        return d
    low, high = np.minimum(low, 0.0), np.maximum(high, 0.0)
    wide = high > low
    out = np.zeros_like(g)
    if wide.any():
        L = root(H[np.ix_(wide, wide)])
        right = -solve_triangular(L, g[wide], lower=True)
        out[wide] = lsq_linear(L.T, right, (low[wide], high[wide]), method="bvls").x
    return out


@dataclass(frozen=True)
class FitProblem:
    """What is fitted, to which segments.

    values  of everything that is not fitted
    q       strength of the process noise
    loss    robust, or least squares
    """

    model: Model
    effects: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    segments: tuple[Segment, ...]
    values: Mapping[str, float] = field(default_factory=dict)
    q: float = SETTINGS.most_process_noise
    robust: bool = True

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the quantities."""
        return tuple(q.name for q in self.quantities)

    @cached_property
    def scale(self) -> Array:
        """Scales of the quantities."""
        return np.array([q.scale for q in self.quantities])

    @cached_property
    def centre(self) -> Array:
        """Prior means of the quantities."""
        return np.array([q.centre for q in self.quantities])

    @cached_property
    def prior(self) -> Array:
        """Prior precisions of the scaled quantities."""
        wide = SETTINGS.effect_prior**-2
        return np.array([1.0 if q.known else wide for q in self.quantities])

    @cached_property
    def form(self) -> Array:
        """Relative deviation of each added effect's quantities between recordings, one sigma: its
        form error."""
        catalogue = self.model.catalogue
        effects = [name.partition(".")[0] for name in self.names]
        return np.array([catalogue[one].form_error if one in catalogue else 0.0 for one in effects])

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Bounds of the scaled quantities."""
        low, high = (
            np.array([getattr(q, end) for q in self.quantities]) for end in ("low", "high")
        )
        return (low - self.centre) / self.scale, (high - self.centre) / self.scale

    @cached_property
    def by_run(self) -> Mapping[int, tuple[Segment, ...]]:
        """The segments of each run, in order."""
        out: dict[int, tuple[Segment, ...]] = {}
        for one in self.segments:
            out[one.run] = (*out.get(one.run, ()), one)
        return out

    def scaled(self, values: Mapping[str, float]) -> Array:
        """The quantities relative to the prior's centre, in units of their scales."""
        own = np.array([values[name] for name in self.names])
        return (own - self.centre) / self.scale if own.size else np.zeros(0)

    def valued(self, u: Array) -> dict[str, float]:
        """All values, the scaled quantities converted back."""
        own = self.centre + self.scale * u
        return {**self.values, **dict(zip(self.names, own.tolist(), strict=True))}

    def requests(self, values: Mapping[str, float], states: States) -> list[Request]:
        """A request for every segment."""
        return [Request(one, values, states[one]) for one in self.segments]

    def correlation_times(self, run: int) -> float:
        """Number of correlation times in all channels of a run."""
        data = self.model.runs[run]
        return len(self.model.channels) * max(data.duration / self.model.correlation_time, 1.0)

    @cached_property
    def samples(self) -> Mapping[int, float]:
        """Effective number of independent samples in each run's segments."""
        worth = {run: self.model.runs[run].worth for run in self.by_run}
        return {
            run: sum(worth[run](slice(s.first, s.until)) for s in parts)
            for run, parts in self.by_run.items()
        }

    @cached_property
    def degrees(self) -> Mapping[int, float]:
        """Degrees of freedom: each run's samples less its initial states."""
        states = self.model.state_scale(self.effects).size
        return {
            run: max(self.samples[run] - states * len(parts), 1.0)
            for run, parts in self.by_run.items()
        }

    def loss(self, run: int, misfit: float) -> float:
        """Loss of a run with misfit E."""
        if not self.robust or not np.isfinite(misfit):
            return misfit
        n = self.degrees[run]
        return n + robust(misfit - n, self.correlation_times(run))

    def process_noise(self, run: int, q: float) -> Array:
        """Process noise of each state over a segment of a run, with strength q: one sigma."""
        least = self.model.least_process_noise(run, self.effects)
        return np.hypot(q * self.model.state_scale(self.effects), least)

    def misfits(self, made: Mapping[Segment, Simulation], states: States) -> dict[int, float]:
        """E of each run."""
        weak = 1 / self.model.state_prior(self.effects)
        out = {}
        for run, parts in self.by_run.items():
            tight = 1 / self.process_noise(run, self.q)
            total = sum(made[one].cost for one in parts)
            total += float(np.sum((weak * states[parts[0]]) ** 2))
            if np.isfinite(total):
                for one, after in itertools.pairwise(parts):
                    total += float(np.sum((tight * (made[one].end - states[after])) ** 2))
            out[run] = total
        return out


@dataclass(frozen=True)
class Linear:
    """Linearised segments, so that trying other strengths of process noise, or priors, is cheap.

    made, parts  each segment simulated, and linearised in the quantities and perhaps in further
                 columns after these
    """

    problem: FitProblem
    made: Mapping[Segment, Simulation]
    parts: Mapping[Segment, Linearisation]
    states: States

    @classmethod
    def of(cls, problem: FitProblem, values: Mapping[str, float], states: States, made) -> Linear:
        """Linearise at a point that was simulated."""
        requests = problem.requests(values, states)
        every = problem.model.linearise(requests, problem.effects, problem.names)
        return cls(problem, made, dict(zip(problem.segments, every, strict=True)), states)

    def evidences(self, q: float) -> dict[int, Evidence]:
        """Evidences of all runs with process noise of strength q."""
        runs = self.problem.by_run
        return dict(zip(runs, self.each([(run, q) for run in runs]), strict=True))

    def each(self, asked: Sequence[tuple[int, float]]) -> list[Evidence]:
        """Evidence of each run with its strength of process noise; those of runs with as many
        segments are worked out side by side."""
        counts = [len(self.problem.by_run[run]) for run, _ in asked]
        out: dict[int, Evidence] = {}
        for count in set(counts):
            alike = [k for k, own in enumerate(counts) if own == count]
            out |= zip(alike, self._side_by_side([asked[k] for k in alike]), strict=True)
        return [out[k] for k in range(len(asked))]

    def _side_by_side(self, asked: Sequence[tuple[int, float]]) -> Iterator[Evidence]:
        problem, model = self.problem, self.problem.model
        scale, known = model.state_scale(problem.effects), model.state_prior(problem.effects)
        noise = np.array([problem.process_noise(run, q) for run, q in asked])
        grams, by, states, gaps = map(
            np.stack, zip(*(self._stacked[run] for run, _ in asked), strict=True)
        )
        runs, count, size = states.shape
        own, each = size * count, np.arange(count)
        # Blocks of the states (S), of the quantities or other columns (H), and between (across).
        S = np.zeros((runs, count, size, count, size))
        S[:, each, :, each, :] = grams[:, :, :size, :size].swapaxes(0, 1)
        g = grams[:, :, :size, -1].copy()
        across, H = grams[:, :, :size, size:-1].copy(), grams[:, :, size:-1, size:-1].sum(axis=1)
        g_shared = grams[:, :, size:-1, -1].sum(axis=1)
        value = grams[:, :, -1, -1].sum(axis=1)
        # Gaps between segments.
        tight = noise[:, None] ** -2
        pull = by.swapaxes(2, 3) * tight[:, None]
        both, towards = pull @ by, (pull @ gaps[..., None])[..., 0]
        before, after = each[:-1], each[1:]
        S[:, before, :, before, :] += both[:, :, :size, :size].swapaxes(0, 1)
        S[:, after, :, after, :] += tight[:, 0, None, :] * np.eye(size)
        S[:, before, :, after, :] -= pull[:, :, :size].swapaxes(0, 1)
        S[:, after, :, before, :] -= pull[:, :, :size].transpose(1, 0, 3, 2)
        across[:, :-1] += both[:, :, :size, size:]
        across[:, 1:] -= pull[:, :, size:].swapaxes(2, 3)
        H += both[:, :, size:, size:].sum(axis=1)
        g[:, :-1] += towards[:, :, :size]
        g[:, 1:] -= tight * gaps
        g_shared += towards[:, :, size:].sum(axis=1)
        value += np.sum(tight * gaps**2, axis=(1, 2))
        # Scaled, as the states' units differ.
        units = np.tile(scale, count)
        S = S.reshape(runs, own, own) * units * units[:, None]
        sound = np.isfinite(value) & np.isfinite(S).all((1, 2)) & np.isfinite(H).all((1, 2))
        S[~sound] = np.eye(own)
        S += 1e-12 / own * np.trace(S, axis1=1, axis2=2)[:, None, None] * np.eye(own)
        right = np.concatenate([across.reshape(runs, own, -1), g.reshape(runs, own, 1)], axis=2)
        solved = -np.linalg.solve(S, units[:, None] * right)
        diagonal = np.diagonal(np.linalg.cholesky(S), axis1=1, axis2=2)
        log = 2 * np.sum(np.log(diagonal), axis=1)
        log += 2 * (count - 1) * np.sum(np.log(noise / scale), axis=1)
        log += 2 * float(np.sum(np.log((known / scale)[np.isfinite(known)])))
        for k, (run, _) in enumerate(asked):
            n = problem.degrees[run]
            if not sound[k]:
                yield Evidence.diverged(n, own, H.shape[1])
                continue
            follow, shift = solved[k, :, :-1], solved[k, :, -1]
            left, g_own = (units[:, None] * right[k, :, :-1]).T, units * right[k, :, -1]
            misfit = float(value[k] + g_own @ shift)
            excess, weight = misfit - n, 1.0
            if problem.robust:
                weight = 1 / overdispersion(problem, run, excess)
            yield Evidence(
                *(n, excess, problem.loss(run, misfit), float(log[k])),
                weight * (g_shared[k] + follow.T @ g_own),
                weight * (H[k] + left @ follow),
                units * shift,
                units[:, None] * follow,
            )

    @cached_property
    def _stacked(self) -> Mapping[int, tuple[Array, Array, Array, Array]]:
        """By run, stacked over its segments: grams, that of the first with the state's prior;
        derivatives of all ends but the last; initial states; gaps between each end and the next
        initial state."""
        out, prior = {}, self.problem.model.state_prior(self.problem.effects) ** -2
        size, scale = prior.size, np.ones(len(next(iter(self.parts.values())).gram))
        scale[size : size + len(self.problem.names)] = self.problem.scale
        for run, parts in self.problem.by_run.items():
            states = np.array([self.states[one] for one in parts])
            grams = np.array([self.parts[one].gram for one in parts]) * scale * scale[:, None]
            pull = prior * states[0]
            grams[0, :size, :size] += np.diag(prior)
            grams[0, :size, -1] += pull
            grams[0, -1, :size] += pull
            grams[0, -1, -1] += pull @ states[0]
            ends = np.array([self.made[one].end for one in parts[:-1]]).reshape(-1, states.shape[1])
            out[run] = (
                grams,
                np.array([self.parts[one].end for one in parts])[:-1] * scale[:-1],
                states,
                ends - states[1:],
            )
        return out

    def moved(
        self, evidences: Mapping[int, Evidence], d: Array, shares: Mapping[int, float] | None = None
    ) -> dict[Segment, Array]:
        """The states after a change d of the quantities, shifted to their optimum, or in each run
        by a share of that shift."""
        out = {}
        for run, parts in self.problem.by_run.items():
            e = evidences[run]
            change = ((shares or {}).get(run, 1.0) * e.shift + e.follow @ d).reshape(len(parts), -1)
            out |= {one: self.states[one] + c for one, c in zip(parts, change, strict=True)}
        return out


@dataclass(frozen=True)
class Fit:
    """A problem's solution.

    values     of everything
    states     initial, of each segment
    evidences  of each run, at the solution
    """

    problem: FitProblem
    values: Mapping[str, float]
    states: States
    linear: Linear
    evidences: Mapping[int, Evidence]
    converged: bool = True

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the fitted effects."""
        return self.problem.effects

    @cached_property
    def u(self) -> Array:
        """The scaled quantities."""
        return self.problem.scaled(self.values)

    @cached_property
    def deviance(self) -> float:
        """-2 log of the marginal likelihood of all runs."""
        return _deviance(self.problem, self.evidences, self.u)

    def deviance_of(self, runs: Iterable[int]) -> float:
        """The deviance of some runs alone, at these values."""
        return _deviance(self.problem, {run: self.evidences[run] for run in runs}, self.u)

    @cached_property
    def marginal(self) -> Mapping[int, Evidence]:
        """Evidences if each run's values may deviate from the common ones by the form error."""
        sigma = np.abs(self.problem.form * (self.u + self.problem.centre / self.problem.scale))
        return {run: e.spread(sigma) for run, e in self.evidences.items()}

    def least(self, evidences: Mapping[int, Evidence]) -> float:
        """Deviance of runs at their own optimum, by the linearisation."""
        problem = self.problem
        H, g, value = summed(problem, evidences, self.u)
        if not self.u.size:
            return value
        low, high = problem.box
        d = bounded_minimum(H, g, low - self.u, high - self.u)
        return value + float(2 * g @ d + d @ H @ d) + _volume(problem, H)

    def information(self) -> tuple[Array, Array, float]:
        """H, g and value of the runs with the prior: of value + 2 g'd + d'Hd."""
        return summed(self.problem, self.marginal, self.u)

    @cached_property
    def predictive(self) -> Mapping[int, float]:
        """Log predictive density of each run given the others; -inf if any cannot be simulated."""
        if not math.isfinite(self.deviance):
            return dict.fromkeys(self.evidences, -math.inf)
        every = self.least(self.marginal)
        others = {
            run: {other: e for other, e in self.marginal.items() if other != run}
            for run in self.marginal
        }
        return {run: (self.least(rest) - every) / 2 for run, rest in others.items()}

    @property
    def samples(self) -> float:
        """Effective number of independent samples, less the number of states."""
        return sum(e.samples for e in self.evidences.values())

    @property
    def excess(self) -> float:
        """Misfit beyond the noise, RMS in sigma."""
        beyond = sum(e.excess for e in self.evidences.values())
        return math.sqrt(max(beyond + len(self.problem.names), 0.0) / max(self.samples, 1))


def _deviance(problem: FitProblem, evidences: Mapping[int, Evidence], u: Array) -> float:
    """-2 log of the marginal likelihood of runs."""
    H, _, value = summed(problem, evidences, u)
    return value + _volume(problem, H)


def _volume(problem: FitProblem, H: Array) -> float:
    """-2 log of the posterior's volume over the prior's (Occam factor)."""
    if not problem.quantities:
        return 0.0
    return 2 * float(np.sum(np.log(np.diag(root(H))))) - float(np.sum(np.log(problem.prior)))


def solve(
    problem: FitProblem,
    values: Mapping[str, float],
    states: States,
    steps: int = SETTINGS.steps,
    tolerance: float = SETTINGS.tolerance,
    enough: float = math.inf,
    known: Linear | None = None,
    relative: float = 0.0,
) -> Fit:
    """The best values and states, by Gauss-Newton steps within the quantities' bounds and a
    trust region.

    tolerance  expected gain, in nats, below which a fit has converged
    relative   the same, as a share of the misfit beyond the noise
    enough     deviance to reach; a fit that is too slow to get there is given up
    known      linearisation at the start, of this problem or of one with other process noise or
               priors
    """
    low, high = problem.box
    u = np.clip(problem.scaled(values), low, high)
    here = _Point.of(problem, u, states, known and known.made)
    if known is None:
        # States that went astray with other values may not recover: try fresh ones too.
        own = {one: problem.model.initial_state(one, problem.effects, problem.valued(u))
               for one in problem.segments}  # fmt: skip
        if any(not np.array_equal(own[one], states[one]) for one in own):
            here = here.joined(_Point.of(problem, u, own))
    radius, converged = SETTINGS.stride, False
    linear = replace(known, problem=problem) if known else here.linear()
    evidences = linear.evidences(problem.q)
    for _ in range(steps):
        least = max(tolerance, relative * (here.cost - sum(problem.degrees.values())))
        better, expected, radius = _stepped(linear, evidences, here, radius, least)
        if better is None:
            converged = True
            break
        gain, there = here.cost - better.cost, better.linear()
        found = there.evidences(problem.q)
        if math.isinf(_deviance(problem, found, better.u)) and math.isfinite(here.cost):
            # At the edge of where the model can be simulated.
            break
        here, linear, evidences = better, there, found
        if gain < least:
            converged = True
            break
        lacking = _deviance(problem, evidences, here.u) - enough
        if lacking > SETTINGS.patience * max(gain, expected):
            break
    return Fit(problem, problem.valued(here.u), here.states, linear, evidences, converged)


def overdispersion(problem: FitProblem, run: int, beyond: float) -> float:
    """phi of a run that misfits by a sum of squares beyond the noise, which counts as constant over
    a correlation time."""
    return 1 + max(beyond, 0.0) / problem.correlation_times(run)


def summed(
    problem: FitProblem, evidences: Mapping[int, Evidence], u: Array
) -> tuple[Array, Array, float]:
    """H, g and value of the runs with the prior: of value + 2 g'd + d'Hd."""
    H, g = np.diag(problem.prior), problem.prior * u
    value = float(problem.prior @ u**2)
    for e in evidences.values():
        H, g, value = H + e.H, g + e.g, value + e.value + e.log
    return H, g, value


def _step(H: Array, g: Array, radius: float, u: Array, box: tuple[Array, Array]) -> Array:
    if not u.size:
        return u
    low, high = box
    return bounded_minimum(H, g, np.maximum(low - u, -radius), np.minimum(high - u, radius))


@dataclass(frozen=True)
class _Point:
    problem: FitProblem
    u: Array
    states: States
    made: Mapping[Segment, Simulation]
    losses: Mapping[int, float]

    @property
    def cost(self) -> float:
        """The sum of all losses, and of the prior's."""
        return _cost(self.problem, self.u, self.losses)

    @classmethod
    def of(
        cls,
        problem: FitProblem,
        u: Array,
        states: States,
        made: Mapping[Segment, Simulation] | None = None,
    ) -> _Point:
        if made is None:
            requests = problem.requests(problem.valued(u), states)
            every = problem.model.simulate(requests, problem.effects)
            made = dict(zip(problem.segments, every, strict=True))
        losses = {run: problem.loss(run, e) for run, e in problem.misfits(made, states).items()}
        return cls(problem, u, states, made, losses)

    def joined(self, other: _Point) -> _Point:
        """The better of both, run by run; the other may lack some runs."""
        runs = [
            run
            for run, loss in other.losses.items()
            if loss < self.losses[run] or math.isnan(self.losses[run])
        ]
        parts = [one for run in runs for one in self.problem.by_run[run]]
        return replace(
            self,
            states={**self.states, **{one: other.states[one] for one in parts}},
            made={**self.made, **{one: other.made[one] for one in parts}},
            losses={**self.losses, **{run: other.losses[run] for run in runs}},
        )

    def linear(self) -> Linear:
        return Linear.of(self.problem, self.problem.valued(self.u), self.states, self.made)


def _stepped(
    linear: Linear, evidences: Mapping[int, Evidence], here: _Point, radius: float, least: float
) -> tuple[_Point | None, float, float]:
    """A better point, None if less than `least` is to be gained or no step gains; the gain expected
    of the step to it; and how far the linearisation is trusted next, in scaled quantities.

    In runs that a step makes worse, the states take only a share of it.
    """
    problem, expected = linear.problem, 0.0
    shares = dict.fromkeys(problem.by_run, 1.0)
    H, g, _ = summed(problem, evidences, here.u)
    for attempt in range(_ATTEMPTS):
        d = _step(H, g, radius, here.u, problem.box)
        losses = _expected(evidences, here, d, shares)
        expected = here.cost - _cost(problem, here.u + d, losses)
        if math.isfinite(expected) and expected < least:
            break
        after = _Point.of(problem, here.u + d, linear.moved(evidences, d, shares))
        for less in (0.3, 0.0):
            if after.cost < here.cost or attempt > 0:
                break
            astray = _astray(after, here, losses)
            if not astray:
                break
            part = replace(problem, segments=tuple(s for s in problem.segments if s.run in astray))
            fewer = shares | {run: less * shares[run] for run in astray}
            states = linear.moved(evidences, d, fewer)
            after = after.joined(_Point.of(part, here.u + d, states))
        gain, longest = here.cost - after.cost, float(np.abs(d).max(initial=0.0))
        if gain > 0:
            if gain < 0.25 * expected:
                radius = 0.3 * longest
            elif attempt == 0 and not gain < 0.5 * expected:
                radius = min(max(radius, 3 * longest), SETTINGS.stride)
            return after, expected, radius
        radius = 0.3 * longest
        for run in _astray(after, here, losses):
            shares[run] = 0.3 * shares[run] if shares[run] > 0.1 else 0.0
    return None, expected, radius


def _astray(after: _Point, here: _Point, losses: Mapping[int, float]) -> list[int]:
    """The runs that a step made worse, and worse than was expected."""
    return [
        run for run, loss in after.losses.items() if not loss <= max(here.losses[run], losses[run])
    ]


def _expected(
    evidences: Mapping[int, Evidence], here: _Point, d: Array, shares: Mapping[int, float]
) -> dict[int, float]:
    """The losses that the linearisation expects after a step."""
    return {
        run: e.at(d) + (1 - shares[run]) ** 2 * (here.losses[run] - e.value)
        for run, e in evidences.items()
    }


def _cost(problem: FitProblem, u: Array, losses: Mapping[int, float]) -> float:
    """The sum of all losses, and of the prior's."""
    cost = sum(losses.values()) + float(problem.prior @ u**2)
    return cost if np.isfinite(cost) else np.inf


def grid() -> list[float]:
    """Strengths of process noise to try, in half decades."""
    first, last = SETTINGS.least_process_noise, SETTINGS.most_process_noise
    count = round(2 * math.log10(last / first))
    return [first * 10 ** (k / 2) for k in range(count + 1)]


def most_likely(fit: Fit) -> float:
    """The strength of process noise with the highest marginal likelihood, at the fit's values."""
    runs, strengths = fit.problem.by_run, grid()
    every = fit.linear.each([(run, q) for q in strengths for run in runs])
    losses = np.array([e.value + e.log for e in every]).reshape(len(strengths), len(runs))
    return strengths[int(np.argmin(losses.sum(axis=1)))]


def fitted(
    problem: FitProblem,
    values: Mapping[str, float],
    states: States,
    enough: float = math.inf,
    tolerance: float = SETTINGS.tolerance,
    known: Linear | None = None,
) -> Fit:
    """The problem's solution with the most likely process noise.

    Starting from the initial strength; then with less, as long as the likelihood is expected to
    rise, and does.

    enough  deviance to reach; a fit that will not get there is stopped early
    known   linearisation at the start, as `solve` takes it
    """
    if all(len(parts) == 1 for parts in problem.by_run.values()):
        return solve(problem, values, states, tolerance=tolerance, known=known)
    steps = SETTINGS.steps
    fit = solve(problem, values, states, SETTINGS.first_steps, tolerance, known=known)
    for _ in range(3):
        q = most_likely(fit)
        if q == fit.problem.q and fit.converged:
            break
        again = replace(problem, q=q)
        fit = solve(again, fit.values, fit.states, steps, tolerance, enough, fit.linear)
        if not fit.converged and fit.deviance > enough:
            return fit
    for q in reversed([q for q in grid() if q < fit.problem.q]):
        if fit.least(fit.linear.evidences(q)) >= fit.deviance:
            break
        lower = replace(problem, q=q)
        lower = solve(lower, fit.values, fit.states, steps, tolerance, fit.deviance, fit.linear)
        if lower.deviance >= fit.deviance:
            break
        fit = lower
    return fit


def initial(
    model: Model,
    effects: tuple[str, ...],
    quantities: tuple[Quantity, ...],
    values: Mapping[str, float],
    runs: Iterable[int],
) -> tuple[FitProblem, dict[Segment, Array]]:
    """The problem for some runs, and initial guesses of its states."""
    cut = segments({r: model.runs[r] for r in runs}, model.segment_length)
    problem = FitProblem(model, effects, quantities, cut, values)
    return problem, {one: model.initial_state(one, effects, values) for one in cut}


def whole_runs(fit: Fit) -> Fit:
    """The same quantities fitted by least squares over whole runs, or over windows as long as the
    machine can be predicted: how well the model predicts unaided.

    If these are not the fit's own segments, first over those with hardly any process noise, as
    whole runs have more minima.
    """
    tight, share = SETTINGS.least_process_noise, SETTINGS.known_share
    single, states = _whole(fit, fit.problem.by_run, fit.values)
    if fit.problem.q > tight and single.segments != fit.problem.segments:
        joined = replace(fit.problem, q=tight, robust=False)
        fit = _known(joined, fit.states, fit.values, share, fit.linear)
        single, states = _whole(fit, fit.problem.by_run, fit.values)
    return _known(single, states, fit.values, share)


def predicted(fit: Fit, runs: Iterable[int], values: Mapping[str, float]) -> Fit:
    """Any runs, whole or in such windows, with these values; only initial states are fitted."""
    single, states = _whole(fit, runs, values)
    return _known(replace(single, quantities=(), values=dict(values)), states, values)


def _known(
    problem: FitProblem,
    states: States,
    values: Mapping[str, float],
    relative: float = 0.0,
    known: Linear | None = None,
) -> Fit:
    """The solution, its misfit known to a fraction of the negligible level, or to a share of
    itself."""
    enough = SETTINGS.known * SETTINGS.negligible**2 * sum(problem.samples.values())
    return solve(problem, values, states, tolerance=enough, relative=relative, known=known)


def _whole(
    fit: Fit, runs: Iterable[int], values: Mapping[str, float]
) -> tuple[FitProblem, dict[Segment, Array]]:
    """Least squares over whole runs, and initial states: the fit's own where it has them."""
    problem = fit.problem
    cut = segments({r: problem.model.runs[r] for r in runs}, problem.model.horizon)
    begun = {(s.run, s.first): state for s, state in fit.states.items()}
    states = {
        one: begun[one.run, one.first]
        if (one.run, one.first) in begun
        else problem.model.initial_state(one, problem.effects, values)
        for one in cut
    }
    q = SETTINGS.most_process_noise
    return replace(problem, segments=cut, robust=False, q=q), states
