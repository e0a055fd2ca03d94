"""The joint's angle in a run, its steps, and its derivatives by the servo's effects."""

import math
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.parameters import values_of
from rr_opt.mechanics.drive import Drive, FreeJoint, commanded
from rr_opt.model.experiment import Run
from rr_opt.motion.floor_motion import free_joint_of
from rr_opt.sysid.paths import DrivePath, DriveSlopes

_LONGEST, _SHARP, _STIFF, _SHARPEST = 0.012, 0.003, 0.0008, 0.0004
"""Longest step, s: in general, with dry friction or a gear that gives, with wheels that creep (also
if they slide beside a servo whose rate jumps), and with wheels that slide. With steps four times as
long as the last, a fast robot whose wheels hold is off by 0.5 mm within 5 s, and one that slides by
1 to 20 mm."""
_COARSER = 2
"""Steps of wheels that slip which derivatives take as one: across the onset of sliding these are
off by a tenth or two; with twice as many, by a factor."""
_APART = 1e-6
"""A jump of dphi this near to the end of a step, s, counts as at it."""
_MOST = 3
"""Most jumps between two samples; more occur only in gaps of the recording."""
_KEPT, _SEEN, _WORTH = 1024, 12, 200
"""Drives and paths that are cached, and the fewest samples of a path that is."""


@dataclass(frozen=True)
class Steps:
    """The steps of a prediction, `each` of them between two samples, with their `edges`, s, on the
    recording's clock; `stiff` if some states are stiff, `accelerated` if the drive has ddphi."""

    edges: Array
    each: int
    stiff: bool
    accelerated: bool


class Grain(TypedDict):
    """How a prediction is stepped."""

    stiff: bool
    accelerated: bool
    longest: float


def steps_of(
    drive: Drive,
    t: Array,
    late: float,
    *,
    stiff: bool = False,
    accelerated: bool = False,
    longest: float = _LONGEST,
) -> Steps:
    """Steps between the samples t; where dphi jumps, one ends and the next begins.

    Not with stiff states: there the effect of a jump is spread over its step.
    """
    jumps = drive.jumps_within(t[0] + late, t[-1] + late) - late if not stiff else np.zeros(0)
    k = np.searchsorted(t, jumps, side="right") - 1
    inside = (jumps - t[k] > _APART) & (t[k + 1] - jumps > _APART)
    inside[1:] &= np.diff(jumps) > _APART
    jumps, k = jumps[inside], k[inside]
    few = np.arange(k.size) - np.searchsorted(k, k) < _MOST
    jumps, k = jumps[few], k[few]
    # The jumps of a sample's interval in order, and how many of them are still to come.
    order = np.arange(k.size) - np.searchsorted(k, k)
    to_come = np.searchsorted(k, k, side="right") - 1 - np.arange(k.size)
    most = int((order + to_come).max(initial=-1)) + 1
    fewest = max(float(np.median(np.diff(t))) / longest, most + 1.0)
    each = 2 ** max(math.ceil(math.log2(fewest)), 0)
    edges = t[:-1, None] + np.diff(t)[:, None] * np.arange(each) / each
    at = np.rint(each * (jumps - t[k]) / (t[k + 1] - t[k])).astype(int)
    for n in range(most):
        # Each jump takes the nearest edge that leaves the others theirs.
        this = order == n
        if n:
            before = np.flatnonzero(this) - 1
            at[this] = np.maximum(at[this], at[before] + 1)
        at[this] = np.clip(at[this], n + 1, each - 1 - to_come[this])
    edges[k, at] = jumps
    return Steps(np.append(edges.ravel(), t[-1]), each, stiff, accelerated)


def drive_path(drive: Drive, steps: Steps, late: float, *, mean: bool = False) -> DrivePath:
    """The drive over the steps. With `mean`, dphi is constant over each step, unless some states
    are stiff."""
    if steps.stiff:
        return _averaged(drive, steps, late)
    edges = steps.edges + late
    h = np.diff(edges)
    at_edges, middle = drive.at(edges)[:2], drive.at(edges[:-1] + h / 2)[:2]
    nodes = np.stack([at_edges[:, :-1], middle, at_edges[:, 1:]], axis=1)
    if mean:
        nodes[1] = np.diff(at_edges[0]) / h
    elif not drive.smooth:
        # Evaluated inside the step, as dphi may jump at its ends.
        jumps = drive.jumps_within(edges[0] - _APART, edges[-1] + _APART)
        after = np.searchsorted(jumps, edges)
        near = np.append(jumps, np.inf)[after] - edges < 2 * _APART
        near |= edges - np.append(-np.inf, jumps)[after] < 2 * _APART
        begins, ends = np.flatnonzero(near[:-1]), np.flatnonzero(near[1:])
        nodes[1, 0, begins] = drive.at(edges[begins] + _APART / 10)[1]
        nodes[1, 2, ends] = drive.at(edges[ends + 1] - _APART / 10)[1]
    k = int(np.searchsorted(edges, 0.0)) - 1
    if drive.rest and not mean and 0 <= k < h.size:
        # The command starts in this step, where dphi may jump: phi is a straight line, so that dphi
        # amounts to the change of phi.
        begin, end = at_edges[0, k : k + 2]
        nodes[0, 1, k], nodes[1, :, k] = (begin + end) / 2, (end - begin) / h[k]
    if steps.accelerated:
        # Its mean over each step: of a jump of dphi, the steps to either side have half.
        begins, ends = nodes[1, 0], nodes[1, 2]
        rate = np.concatenate([begins[:1], (ends[:-1] + begins[1:]) / 2, ends[-1:]])
        mean_bend = np.diff(rate) / h
        nodes = np.concatenate([nodes, np.broadcast_to(mean_bend, (1, 3, h.size))])
        at_edges = np.vstack([at_edges, np.append(mean_bend, mean_bend[-1])])
    return DrivePath(h, nodes, at_edges[:, :: steps.each], steps.each)


def _averaged(drive: Drive, steps: Steps, late: float) -> DrivePath:
    """With ddphi: dphi at an edge is its mean over half a step to either side, and changes linearly
    in between. So a jump of dphi counts wherever it falls, and moves steadily with what moves it.
    """
    edges = steps.edges + late
    h = np.diff(edges)
    middles = edges[:-1] + h / 2
    (angle, rate, _), middle = drive.at(edges), drive.at(middles)[0]
    mean = np.concatenate([rate[:1], np.diff(middle) / np.diff(middles), rate[-1:]])
    acceleration = np.diff(mean) / h
    nodes = np.array(
        [
            [angle[:-1], middle, angle[1:]],
            [mean[:-1], (mean[:-1] + mean[1:]) / 2, mean[1:]],
            [acceleration] * 3,
        ]
    )
    at = np.array([angle, rate, np.append(acceleration, acceleration[-1])])[:, :: steps.each]
    return DrivePath(h, nodes, at, steps.each, min(_COARSER, steps.each))


Made = tuple[int, tuple[tuple[str, tuple[tuple[str, float], ...]], ...], FreeJoint | None]
"""A run, the effects of its servo with their values, and the joint where they leave it free."""


class Drives:
    """The drives of runs, the latest of which are cached."""

    def __init__(self, runs: Sequence[Run]) -> None:
        self._runs = runs
        self._kept: dict[Made, Drive] = {}
        self._seen: deque[tuple[Made, Array, Array]] = deque(maxlen=_SEEN)

    def of(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> Drive:
        """The angle that the servo makes of the gait commanded in a run."""
        return self.every([(run, given)], effects)[0]

    def every(
        self, asked: Sequence[tuple[int, Mapping[str, float]]], effects: tuple[str, ...]
    ) -> list[Drive]:
        """The same for several runs with their values; faster than one by one."""
        moving = [name for name in effects if CATALOGUE[name].actuate]
        free = any(CATALOGUE[name].frees_joint for name in moving)
        keys: list[Made] = [
            (
                run,
                tuple(
                    (name, tuple((q.name, given[f"{name}.{q.name}"]) for q in effect.parameters))
                    for name, effect in ((name, CATALOGUE[name]) for name in moving)
                ),
                joint_of(given) if free else None,
            )
            for run, given in asked
        ]
        self._make(keys)
        found = [self._kept[key] for key in keys]
        for oldest in list(self._kept)[: max(len(self._kept) - _KEPT, 0)]:
            del self._kept[oldest]
        return found

    def _make(self, keys: Sequence[Made]) -> None:
        """Compute drives that are not cached, from those without the last effect; all have the same
        effects."""
        new = [key for key in dict.fromkeys(keys) if key not in self._kept]
        if not new:
            return
        last = len(new[0][1]) - 1
        if last < 0:
            runs = [self._runs[run] for run, _, _ in new]
            drives = [commanded(run.gait, run.start == "rest") for run in runs]
        else:
            before: list[Made] = []
            for run, own, joint in new:
                free = any(CATALOGUE[name].frees_joint for name, _ in own[:last])
                before.append((run, own[:last], joint if free else None))
            self._make(before)
            effect = CATALOGUE[new[0][1][last][0]]
            values = [dict(own[last][1]) for _, own, _ in new]
            commands = [replace(self._kept[b], at=self._remembered(b)) for b in before]
            drives = effect.actuated(commands, values, [joint for _, _, joint in new])
        self._kept |= dict(zip(new, drives, strict=True))

    def _remembered(self, key: Made) -> Callable[[Array], Array]:
        """A drive cached at the times last asked for: difference quotients in an effect's values
        evaluate the drive before that effect again and again."""
        at = self._kept[key].at

        def again(t: Array) -> Array:
            if np.size(t) < _WORTH:
                return at(t)
            for other, times, path in self._seen:
                if other == key and np.array_equal(times, t):
                    return path
            path = at(t)
            path.flags.writeable = False
            self._seen.append((key, np.asarray(t), path))
            return path

        return again


def drive_slopes(
    drives: Drives,
    run: int,
    t: Array,
    given: Mapping[str, float],
    effects: tuple[str, ...],
    wanted: tuple[str, ...],
) -> DriveSlopes | None:
    """Derivatives of the drive by the wanted quantities; None if none moves it."""
    moving = [(k, name) for k, name in enumerate(wanted) if _moves(name, effects)]
    if not moving:
        return None
    here = drives.of(run, given, effects)
    steps = steps_of(here, t, lateness(given, effects), **grain(given, effects))

    def path_at(values: Mapping[str, float]) -> DrivePath:
        # On the very steps used for prediction, with one rate per step where dphi jumps, so that a
        # jump counts wherever it falls in its step.
        drive, late = drives.of(run, values, effects), lateness(values, effects)
        return drive_path(drive, steps, late, mean=not here.smooth)

    path = path_at(given)
    # The step that begins nearest to the start of the command.
    first = int(np.argmin(np.abs(steps.edges[:-1] + lateness(given, effects))))
    at = np.empty((*path.at.shape, len(moving)))
    middle = np.empty((len(path.nodes), path.h.size, len(moving)))
    for k, (_, name) in enumerate(moving):
        values = _ends(name, given)
        low, high = (path_at({**given, name: value}) for value in values)
        apart = values[1] - values[0]
        at[:, :, k] = (high.at - low.at) / apart
        nodes = (high.nodes - low.nodes) / apart
        middle[:, :, k] = nodes[:, 1]
        if here.smooth and here.rest and not steps.stiff:
            # The start may move into the step or out of it: dphi has to amount to the change of
            # phi.
            middle[1, first, k] = (nodes[0, 2, first] - nodes[0, 0, first]) / path.h[first]
    return DriveSlopes(at, middle, np.array([k for k, _ in moving]))


def lateness(given: Mapping[str, float], effects: tuple[str, ...]) -> float:
    """Lag of the recording's clock behind the command's, s."""
    return sum(given[f"{n}.{CATALOGUE[n].delay}"] for n in effects if CATALOGUE[n].delay)


def joint_of(given: Mapping[str, float]) -> FreeJoint:
    """The joint of a robot with these values, free of its servo."""
    return free_joint_of(lambda parameters: values_of(given, parameters))


def grain(given: Mapping[str, float], effects: Sequence[str]) -> Grain:
    """Whether some states are stiff, whether they need ddphi, and the longest step, s."""
    every = [CATALOGUE[name] for name in effects]
    sharp = ((one, q) for one in every for q in one.parameters if q.sharp)
    stiff, longest = any(one.stiff for one in every), _LONGEST
    if any(given[f"{one.name}.{q.name}"] != q.neutral for one, q in sharp):
        longest = (_STIFF if jumping(effects) else _SHARPEST) if stiff else _SHARP
    elif stiff:
        longest = _STIFF
    elif any(one.near_discontinuous for one in every):
        longest = _SHARP
    accelerated = any(one.accelerated for one in every)
    return {"stiff": stiff, "accelerated": accelerated, "longest": longest}


def jumping(effects: Iterable[str]) -> bool:
    """Whether the servo's rate jumps with these effects."""
    every = (CATALOGUE[name] for name in effects)
    return any(one.actuate and not one.differentiable for one in every)


def neighbours(
    given: Mapping[str, float], effects: tuple[str, ...], wanted: tuple[str, ...]
) -> list[dict[str, float]]:
    """The values between which `drive_slopes` takes differences."""
    return [
        {**given, name: value}
        for name in wanted
        if _moves(name, effects)
        for value in _ends(name, given)
    ]


def _moves(name: str, effects: Sequence[str]) -> bool:
    """Whether a quantity moves the drive of a robot with some effects."""
    effect, _, parameter = name.partition(".")
    if not parameter or effect not in effects:
        return False
    return CATALOGUE[effect].actuate is not None or CATALOGUE[effect].delay == parameter


def _ends(name: str, given: Mapping[str, float]) -> tuple[float, float]:
    """Values of an effect's quantity to either side of its own, for a difference quotient."""
    effect, parameter = name.split(".")
    q = next(q for q in CATALOGUE[effect].parameters if q.name == parameter)
    step = 1e-3 * q.typical
    return max(given[name] - step, q.bounds[0]), given[name] + step
