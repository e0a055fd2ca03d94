"""What the joint's recorded angle says about the servo and the clock, without any dynamics.

The angle follows from the command and the servo alone, so every effect of the servo or the clock,
and every pair of them, is fitted to it directly. Fitted to whole motions, a rate limit or backlash
has many local minima; in the angle it is plain.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from rr_opt.array import Array
from rr_opt.machines.racer.model import RacerModel
from rr_opt.sysid.estimation import robust
from rr_opt.sysid.model import Choice, Quantity
from rr_opt.sysid.settings import SETTINGS

_SAMPLES = 6000
"""Samples over all runs: more add nothing."""
_TRIED = 14
"""Initial values of a non-smooth effect, from next to nothing to a lot."""
_SHORTFALLS = np.geomspace(0.02, 0.75, _TRIED)
"""By how much a limit is below the largest value that is asked for, as a share of that."""
_PAIRED = 2
"""How many of the best single effects are tried in pairs."""
_PARTS, _SIZES = (1.0, 0.5, 0.25), (0.25, 1.0, 4.0)
"""Shares of a simpler form's first quantity, and multiples of a new one's usual size."""
_DIFFERENCE = 1e-4
"""Relative step of a difference quotient."""
_KNOWN = 1e-4
"""To what share the misfit is known, and the values: sets are told apart by several nats."""
_SCANNED = 3
"""Runs on which initial values are compared."""
_OPEN = 4
"""Most sets that are returned."""


@dataclass(frozen=True)
class _RecordedAngle:
    """The recorded angle of runs, and its likelihood under sets of effects.

    at  samples of each run that are used
    """

    racer: RacerModel
    at: Mapping[int, NDArray[np.intp]]

    def residuals(self, values: Mapping[str, float], effects: tuple[str, ...]) -> dict[int, Array]:
        """Residuals of each run, in sigma."""
        self.prepared([values], effects)
        out = {}
        for run, k in self.at.items():
            data = self.racer.runs[run]
            phi = self.racer.simulator.angle(run, values, effects)[k]
            out[run] = (phi - data.values[k, -1]) / data.weighted_sigma[k, -1]
        return out

    def prepared(self, every: Sequence[Mapping[str, float]], effects: tuple[str, ...]) -> None:
        """Compute the servo's angles for several sets of values at once."""
        simulator = self.racer.simulator
        given = [simulator.given(values) for values in every]
        simulator.drives.every(
            [(run, one) for one in given for run in self.at], simulator.every(effects)
        )

    def samples(self, run: int) -> float:
        """Effective number of independent samples of a run."""
        return self.at[run].size / float(np.broadcast_to(self.racer.runs[run].correlation, 4)[-1])

    def excess(self, residuals: Mapping[int, Array]) -> float:
        """Misfit beyond the noise."""
        return sum(float(r @ r) - self.samples(run) for run, r in residuals.items())

    def score(self, residuals: Mapping[int, Array], quantities: int) -> float:
        """-2 log likelihood with a penalty per quantity (BIC, counting correlation times)."""
        total, every = 0.0, 0.0
        for run, r in residuals.items():
            times = max(self.racer.runs[run].duration / SETTINGS.correlation_time, 1.0)
            n = self.samples(run)
            total += n + robust(float(r @ r) - n, times)
            every += times
        return total + quantities * math.log(every)

    def explained(self, one: _Set) -> bool:
        """Whether a set leaves no significant misfit."""
        samples = sum(self.samples(run) for run in self.at)
        chance = 2 * math.sqrt(2 * samples)
        return one.excess < max(SETTINGS.negligible**2 * samples, chance)

    @cached_property
    def scanned(self) -> _RecordedAngle:
        """The same on a few of the runs, the first ones."""
        return replace(self, at=dict([*self.at.items()][:_SCANNED]))


@dataclass(frozen=True)
class _Set:
    choices: tuple[Choice, ...]
    values: Mapping[str, float]
    score: float
    excess: float


def actuation_sets(
    racer: RacerModel, runs: Sequence[int]
) -> list[tuple[tuple[Choice, ...], Mapping[str, float]]]:
    """Sets of effects that explain the recorded angle about equally well, the best first."""
    # Periodic motion first: it is cheap to scan.
    ordered = sorted(runs, key=lambda run: racer.experiment.runs[run].start == "rest")
    seen = {run: np.flatnonzero(np.isfinite(racer.runs[run].values[:, -1])) for run in ordered}
    every = max(sum(k.size for k in seen.values()) // _SAMPLES, 1)
    angle = _RecordedAngle(racer, {run: k[::every] for run, k in seen.items() if k.size})
    free = tuple(q for q in racer.parameters if q.name == "phi_zero")
    upstream = {name: info for name, info in racer.catalogue.items() if info.upstream}
    plain = [Choice(name) for name in upstream]
    fuller = [Choice(name, k) for name, info in upstream.items() for k in range(1, len(info.forms))]
    none = _fitted(angle, racer, (), free, [{}])
    if angle.explained(none):
        return [((), {})]
    # The runs that show most come first: initial values are compared on these.
    residuals = angle.residuals(none.values, ())
    shown = sorted(residuals, key=lambda run: -float(residuals[run] @ residuals[run]))
    angle = replace(angle, at={run: angle.at[run] for run in shown})

    def tried(choices: Sequence[Choice]) -> list[_Set]:
        found: list[_Set] = []
        for one in choices:
            guesses = [*_guesses(racer, one), *_shared(racer, one, [*alone, *found])]
            found.append(_fitted(angle, racer, (one,), free, guesses))
        return found

    def best_first(sets: Sequence[_Set]) -> list[_Set]:
        return sorted(sets, key=lambda one: one.score)

    alone: list[_Set] = []
    alone = best_first(tried(plain))
    # Fuller forms and pairs begin from what single effects explain.
    if not alone or none.score <= alone[0].score:
        return [((), {})]
    # Where one effect explains the angle, only cheap alternatives are tried.
    quick = angle.explained(alone[0])
    cheap = [one for one in fuller if racer.catalogue[one.name].smooth]
    alone = best_first([*alone, *tried(cheap if quick else fuller)])
    sets = [none, *alone]
    names = list(dict.fromkeys(one.choices[0].name for one in alone))[:_PAIRED]
    leading = [next(one for one in alone if one.choices[0].name == name) for name in names]
    for one, other in itertools.product(leading, [*plain, *fuller]):
        pair = tuple(sorted((one.choices[0], other)))
        if other.name == one.choices[0].name or any(s.choices == pair for s in sets):
            continue
        if quick and not all(racer.catalogue[choice.name].smooth for choice in pair):
            continue
        guesses = [{**one.values, **guess} for guess in _guesses(racer, other)]
        sets.append(_fitted(angle, racer, pair, free, guesses))
    sets = best_first(sets)
    open_ = [one for one in sets if one.score < sets[0].score + 2 * SETTINGS.evidence]
    # A pair fits at least as well as each of its effects: it has to earn its price.
    paying = [
        one
        for one in open_
        if not any(
            {c.name for c in less.choices} < {c.name for c in one.choices}
            and less.score < one.score + 2 * SETTINGS.evidence
            for less in open_
        )
    ]
    return [(one.choices, one.values) for one in paying[:_OPEN]]


def _guesses(racer: RacerModel, choice: Choice) -> list[dict[str, float]]:
    form = racer.catalogue[choice.name].forms[choice.form]
    if racer.catalogue[choice.name].smooth:
        return [dict(form.guesses[0])]
    # The first quantity decides where the minima are; the others begin where a fit would.
    q = form.quantities[0]
    sizes = 1 - _SHORTFALLS if q.neutral else np.geomspace(0.05, 5.0, _TRIED)
    values = np.clip(q.scale * sizes, q.low, q.high).tolist()
    return [{**guess, q.name: value} for value in values for guess in form.guesses]


def _shared(racer: RacerModel, choice: Choice, found: Sequence[_Set]) -> Iterator[dict[str, float]]:
    """Guesses that split a simpler form's first quantity between it and a new one."""
    form = racer.catalogue[choice.name].forms[choice.form]
    first, names = form.quantities[0], {q.name for q in form.quantities}
    for simpler in found:
        if simpler.values.keys() < names and first.name in simpler.values:
            more = {q.name: q.scale for q in form.quantities if q.name not in simpler.values}
            for part, size in itertools.product(_PARTS, _SIZES):
                own = {first.name: part * simpler.values[first.name]}
                yield {**simpler.values, **own, **{k: size * v for k, v in more.items()}}


def _fitted(
    angle: _RecordedAngle,
    racer: RacerModel,
    choices: tuple[Choice, ...],
    free: tuple[Quantity, ...],
    guesses: Sequence[Mapping[str, float]],
) -> _Set:
    own = [q for one in choices for q in racer.catalogue[one.name].forms[one.form].quantities]
    quantities = [*free, *own]
    effects = tuple(one.name for one in choices)
    scale = np.array([q.scale for q in quantities])

    def valued(u: Array) -> dict[str, float]:
        return dict(zip((q.name for q in quantities), (u * scale).tolist(), strict=True))

    def left(u: Array, of: _RecordedAngle = angle) -> Array:
        values = valued(u)
        known = [u[k] - q.centre / q.scale for k, q in enumerate(free)]
        return np.concatenate([*of.residuals(values, effects).values(), known])

    def poor(u: Array) -> float:
        return float(np.sum(left(u, angle.scanned) ** 2))

    def slopes(u: Array, *_: object) -> Array:
        step = _DIFFERENCE * np.maximum(np.abs(u), _DIFFERENCE)
        step = np.where(u + step > high, -step, step)
        beside = [u + one for one in np.diag(step)]
        angle.prepared([valued(one) for one in (u, *beside)], effects)
        here = left(u)
        return np.column_stack(
            [(left(one) - here) / by for one, by in zip(beside, step, strict=True)]
        )

    starts = [
        np.array([guess.get(q.name, q.value) for q in quantities]) / scale for guess in guesses
    ]
    if len(starts) > 1:
        angle.scanned.prepared([valued(u) for u in starts], effects)
    u = min(starts, key=poor) if len(starts) > 1 else starts[0]
    low, high = (np.array([getattr(q, end) for q in quantities]) / scale for end in ("low", "high"))
    if quantities:
        u = least_squares(
            left,
            np.clip(u, low, high),
            slopes,  # pyright: ignore[reportArgumentType]
            bounds=(low, high + 1e-12),
            ftol=_KNOWN,
            xtol=_KNOWN,
            max_nfev=12,
        ).x
    values = valued(u)
    residuals = angle.residuals(values, effects)
    excess = angle.excess(residuals)
    own_values = {q.name: values[q.name] for q in own}
    return _Set(choices, own_values, angle.score(residuals, len(own)), excess)
