"""Candidate models: sets of effects, each with its fit and its predictive score."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid import estimation
from rr_opt.sysid.constancy import constancy
from rr_opt.sysid.estimation import Fit, FitProblem
from rr_opt.sysid.intervals import released, wrong
from rr_opt.sysid.model import Choice, Model, Quantity, Request, Segment
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True, eq=False)
class Candidate:
    """The nominal model with some added effects, fitted.

    given_up  its fit was stopped early, as it would not have caught up with another one
    """

    choices: tuple[Choice, ...]
    fit: Fit
    given_up: bool = False

    @property
    def effects(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(choice.name for choice in self.choices)

    @property
    def form_errors(self) -> Mapping[str, float]:
        """The form error of each of its effects."""
        catalogue = self.fit.problem.model.catalogue
        return {name: catalogue[name].form_error for name in self.effects}

    @property
    def predictive(self) -> Mapping[int, float]:
        """Log predictive density of each run given the others; -inf if any cannot be simulated."""
        return self.fit.predictive

    @property
    def elpd(self) -> float:
        """Sum of the log predictive densities of left-out runs (Vehtari, Gelman, Gabry 2017)."""
        return sum(self.predictive.values())

    @cached_property
    def simulated(self) -> Fit:
        """The same quantities fitted by least squares over whole runs."""
        return estimation.whole_runs(self.fit)

    @property
    def excess(self) -> float:
        """Misfit of whole-run simulations beyond the noise, RMS in sigma."""
        return self.simulated.excess

    def plausible(self, base: Candidate) -> bool:
        """Whether recordings agree on its values, but for the form errors of its effects; and if it
        has none, no more values are wrong than may be. `base` has no effects."""
        if self.choices:
            explained = {
                run: max(e.excess, 0.0) / e.samples for run, e in base.simulated.evidences.items()
            }
            agreed = constancy(self.fit, 0.0, explained, self.form_errors)
            return agreed.probability > SETTINGS.named
        # Wrong values are released first: what is believed of one bends others.
        fit = released(self.fit)
        agreed = constancy(fit, self.excess)
        return agreed.probability > SETTINGS.named and len(wrong(fit)) <= SETTINGS.most_effects

    def advantage(self, other: Candidate) -> tuple[float, float]:
        """Gain in log predictive density over another candidate, nats, and its standard error."""
        gains = np.array([p - other.predictive[run] for run, p in self.predictive.items()])
        spread = float(np.std(gains, ddof=1)) if gains.size > 1 else math.inf
        return float(gains.sum()), math.sqrt(gains.size) * spread

    def predicts_better(self, other: Candidate) -> bool:
        """Whether the predictive evidence is enough to prefer it."""
        if self.given_up or not math.isfinite(other.elpd):
            return not self.given_up
        gain, error = self.advantage(other)
        return gain > max(SETTINGS.evidence, SETTINGS.standard_errors * error)


def quantities_of(model: Model, choices: Sequence[Choice]) -> tuple[Quantity, ...]:
    """The parameters and the effects' quantities."""
    own = [q for one in choices for q in model.catalogue[one.name].forms[one.form].quantities]
    return (*model.parameters, *own)


def first(model: Model, runs: Iterable[int]) -> Candidate:
    """The nominal model, its parameters fitted."""
    values = {q.name: q.value for q in model.parameters}
    problem, states = estimation.initial(model, (), model.parameters, values, runs)
    return Candidate((), estimation.fitted(problem, values, states))


def fitted(
    model: Model,
    choices: Sequence[Choice],
    parent: Fit,
    guesses: Sequence[Mapping[str, float]],
    rival: Fit | None = None,
) -> Candidate:
    """Fit a set of effects, starting from a fit without them.

    guesses  initial values of the new quantities. The parameters start from the parent's fit;
             with the best guess also, as a missing effect may have biased that, from their nominal
             values. The best after one step are continued, half of them after each further step
    rival    the fit to beat: one that will not beat it is stopped early
    """
    ordered = tuple(sorted(choices))
    problem = _problem(model, ordered, parent)
    names, quantities = problem.effects, problem.quantities
    plain = {q.name: q.centre for q in quantities}
    kept = {k: v for k, v in parent.values.items() if k in plain}
    unbent = {q.name: q.centre for q in model.parameters}
    some, tolerance = trial_problem(problem, parent), SETTINGS.search_tolerance

    def begun(values: Mapping[str, float]) -> tuple[Fit, dict[Segment, Array]]:
        states = _converted(model, parent, names, values)
        part = {one: states[one] for one in some.segments}
        return estimation.solve(some, values, part, 1, tolerance), states

    def stepped(fit: Fit, steps: int) -> Fit:
        return estimation.solve(some, fit.values, fit.states, steps, tolerance, known=fit.linear)

    def deviance(trial: tuple[Fit, object]) -> float:
        return trial[0].deviance

    distinct = [one for k, one in enumerate(guesses) if one not in guesses[:k]]
    trials = [begun({**plain, **kept, **guess}) for guess in distinct]
    k = min(range(len(trials)), key=lambda k: deviance(trials[k]))
    trials[k] = min(trials[k], begun({**plain, **kept, **distinct[k], **unbent}), key=deviance)
    trials.sort(key=deviance)
    before = trials[0][0].deviance
    trials, left = trials[: SETTINGS.trial_starts], SETTINGS.trial_steps
    while left:
        # Successive halving (Jamieson and Talwalkar 2016).
        steps = 1 if len(trials) > 1 else left
        trials = sorted(((stepped(fit, steps), s) for fit, s in trials), key=deviance)
        trials, left = trials[: (len(trials) + 1) // 2], left - steps
    best, states = trials[0]
    gain = (before - best.deviance) / SETTINGS.trial_steps
    begun_with = {**states, **best.states}
    lacking = best.deviance - rival.deviance_of(some.by_run) if rival else -math.inf
    slow = not best.converged and lacking > SETTINGS.patience * max(gain, tolerance)
    if slow or not math.isfinite(best.deviance):
        return Candidate(ordered, estimation.solve(problem, best.values, begun_with, 0), True)
    enough = rival.deviance if rival else math.inf
    fit = estimation.fitted(problem, best.values, begun_with, enough=enough, tolerance=tolerance)
    stopped = not fit.converged and fit.deviance > enough
    return Candidate(ordered, fit, stopped or not math.isfinite(fit.deviance))


def _problem(model: Model, choices: Sequence[Choice], parent: Fit) -> FitProblem:
    """To fit a set of effects to the segments of another fit."""
    own, names = parent.problem, tuple(one.name for one in choices)
    return FitProblem(model, names, quantities_of(model, choices), own.segments, own.values, own.q)


def refitted(candidate: Candidate, runs: Iterable[int]) -> Candidate:
    """The candidate refitted to other runs; initial states of new runs are fitted first."""
    fit = candidate.fit
    problem, states = estimation.initial(
        fit.problem.model, fit.effects, fit.problem.quantities, fit.values, runs
    )
    problem = replace(problem, q=fit.problem.q)
    new = tuple(one for one in problem.segments if one not in fit.states)
    held = replace(problem, segments=new, quantities=(), values=dict(fit.values))
    settled = estimation.solve(held, fit.values, {one: states[one] for one in new})
    begun = {**fit.states, **settled.states}
    return Candidate(candidate.choices, estimation.fitted(problem, fit.values, begun))


def trial_problem(problem: FitProblem, parent: Fit) -> FitProblem:
    """The problem restricted to the few runs that the parent explains worst; all, if it explains
    each of them to within chance."""
    worst = sorted(problem.by_run, key=lambda run: -parent.evidences[run].excess)
    most = parent.evidences[worst[0]]
    significant = most.excess > 2 * math.sqrt(2 * most.samples)
    runs = worst[: SETTINGS.trial_runs] if significant else worst
    return replace(problem, segments=tuple(s for s in problem.segments if s.run in runs))


def _converted(
    model: Model, parent: Fit, effects: tuple[str, ...], values: Mapping[str, float]
) -> dict[Segment, Array]:
    return {
        one: model.converted(Request(one, values, state), effects)
        for one, state in parent.states.items()
    }


def weights(candidates: Sequence[Candidate], draws: int = 2000) -> Array:
    """Pseudo-BMA+ weights (Yao, Vehtari, Simpson and Gelman 2018): the softmax of the log
    predictive densities, averaged over a Bayesian bootstrap of the recordings."""
    runs = list(candidates[0].predictive)
    densities = np.array([[one.predictive[run] for run in runs] for one in candidates])
    shares = np.random.default_rng(0).dirichlet(np.ones(len(runs)), draws) * len(runs)
    totals = shares @ densities.T
    totals -= totals.max(axis=1, keepdims=True)
    odds = np.exp(totals)
    return np.mean(odds / odds.sum(axis=1, keepdims=True), axis=0)
