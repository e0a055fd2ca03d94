"""How long a machine can be predicted, from the machine and its recordings.

An unstable posture multiplies every error, and noise of the inputs perturbs a machine. A window is
short enough that neither spoils its prediction.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from rr_opt.array import Array
from rr_opt.model.machine import MachineExperiment, MachineRun, Signals
from rr_opt.sysid.model import Data, Linearisation, Request, Segment, segments
from rr_opt.sysid.paths import DrivePath, Path, Recorded
from rr_opt.sysid.settings import SETTINGS

_LENGTHS = (0.125, 0.25, 0.5, 1.0, 2.0)
"""Lengths of windows, s."""

SHORTEST = _LENGTHS[0]

_DRAWS = 3
"""Draws of the inputs' noise."""


class Predictable(Protocol):
    """What is needed of a model here."""

    experiment: MachineExperiment
    nominal: dict[str, float]
    runs: Sequence[Data]
    horizon: float

    def recording(self, run: int) -> int: ...  # noqa: D102
    def recorded(self, segment: Segment) -> Recorded: ...  # noqa: D102
    def state_scale(self, effects: tuple[str, ...]) -> Array: ...  # noqa: D102
    def initial_state(  # noqa: D102
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array: ...
    def made(  # noqa: D102
        self,
        requests: Sequence[Request],
        effects: tuple[str, ...],
        inputs: Mapping[int, Signals] | None = None,
    ) -> list[tuple[Request, DrivePath, Path]]: ...
    def linearise(  # noqa: D102
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]: ...


def prediction_window(model: Predictable) -> float:
    """The longest, s, in which errors neither grow too much nor come mainly from input noise.

    Growth is the spectral radius of the linearised motion, which does not depend on units.
    """
    cut = segments({k: one for k, one in enumerate(model.runs) if not one.held_out}, SHORTEST)
    steps: dict[int, list[Array]] = {}
    for one, linear in zip(cut, model.linearise(_guessed(model, cut), (), ()), strict=True):
        steps.setdefault(one.run, []).append(linear.end)
    trusted = SHORTEST
    unseen = max(SETTINGS.input_share * _motion(model), SETTINGS.input_noise)
    for length in _LENGTHS:
        count = round(length / SHORTEST)
        grown = max(_growth(every, count) for every in steps.values())
        if not (grown <= SETTINGS.growth and stirred(model, length) <= unseen):
            break
        trusted = length
    return trusted


def _growth(steps: Sequence[Array], count: int) -> float:
    """The largest growth over `count` successive steps."""
    worst = 0.0
    for k in range(max(len(steps) - count + 1, 1)):
        across = np.eye(len(steps[0]))
        for one in steps[k : k + count]:
            across = one[:, : len(one)] @ across
        if not np.isfinite(across).all():
            return np.inf
        worst = max(worst, float(np.abs(np.linalg.eigvals(across)).max()))
    return worst


def _motion(model: Predictable) -> float:
    """RMS in sigma of the recorded motion in the longest windows, about their means."""
    parts = []
    for k, run in enumerate(model.runs):
        for one in segments({k: run}, _LENGTHS[-1]):
            y = run.values[one.first : one.until] / run.sigma[one.first : one.until]
            y = y[:, np.isfinite(y).any(axis=0)]
            parts.append((y - np.nanmean(y, axis=0)).ravel())
    return float(np.sqrt(np.nanmean(np.concatenate(parts) ** 2)))


def stirred(model: Predictable, length: float) -> float:
    """RMS in sigma that noise of the inputs causes in windows of a length, s, their initial states
    refitted."""
    rng, left, count = np.random.default_rng(0), 0.0, 0
    for k in range(len(model.runs)):
        recording = model.recording(k)
        run = model.experiment.runs[recording]
        if not any(run.sigma.get(name, 0.0) > 0 for name in run.inputs):
            continue
        asked = _guessed(model, segments({k: model.runs[k]}, length))
        plain, starts = model.made(asked, ()), _starts(model, asked)
        for _ in range(_DRAWS):
            moved = model.made(asked, (), {recording: _drawn(run, rng)})
            for (one, _, before), (_, _, after), by in zip(plain, moved, starts, strict=True):
                weight = model.recorded(one.segment).weight
                off = _known((after.seen - before.seen) * weight)
                off -= by @ np.linalg.lstsq(by, off, rcond=None)[0]
                left, count = left + float(off @ off), count + np.count_nonzero(weight)
    return float(np.sqrt(left / count)) if count else 0.0


def _drawn(run: MachineRun, rng: np.random.Generator) -> dict[str, Array]:
    """Noisy inputs with noise added once more, constant while they are held."""
    blocks = -(-len(run) // run.held)

    def noise() -> Array:
        return np.repeat(rng.standard_normal(blocks), run.held)[: len(run)]

    return {name: y + run.sigma[name] * noise()
            for name, y in run.inputs.items() if run.sigma.get(name, 0.0) > 0}  # fmt: skip


def _starts(model: Predictable, requests: Sequence[Request]) -> list[Array]:
    """Derivatives of the residuals by the initial state (n channels, size), by differences."""
    base = [made.seen for _, _, made in model.made(requests, ())]
    columns: list[list[Array]] = [[] for _ in requests]
    for k, step in enumerate(1e-4 * model.state_scale(())):
        asked = [replace(one, state=one.state + step * np.eye(one.state.size)[k])
                 for one in requests]  # fmt: skip
        for n, (one, _, made) in enumerate(model.made(asked, ())):
            weight = model.recorded(one.segment).weight
            columns[n].append(_known((made.seen - base[n]) / step * weight))
    return [np.array(one).T for one in columns]


def _known(off: Array) -> Array:
    return np.where(np.isfinite(off), off, 0.0).ravel()


def _guessed(model: Predictable, cut: Sequence[Segment]) -> list[Request]:
    return [Request(one, model.nominal, model.initial_state(one, (), {})) for one in cut]
