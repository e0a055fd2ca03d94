"""The joint's angle in a run, and how it changes with what the servo does wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np

from rr_opt.diagnose.linear import DriveSlopes
from rr_opt.diagnose.model import Array
from rr_opt.diagnose.racer_quantities import values_of
from rr_opt.diagnose.racer_steps import drive_path, steps_of
from rr_opt.diagnose.shoot import DrivePath
from rr_opt.experiment.experiment import Run
from rr_opt.physics.drive import Drive, FreeJoint, told
from rr_opt.physics.effects import CATALOGUE
from rr_opt.physics.free_joint import free_joint_of


class Drives:
    """The drives of runs, each kept until others were asked for."""

    def __init__(self, runs: Sequence[Run]) -> None:
        self._runs = runs
        self._of = lru_cache(maxsize=64)(self._made)

    def __reduce__(self) -> tuple:
        """For another process: what is kept stays here."""
        return Drives, (self._runs,)

    def of(self, run: int, given: Mapping[str, float], effects: tuple[str, ...]) -> Drive:
        """What the servo makes of the gait that it is told in a run."""
        own = tuple(
            (name, tuple((q.name, given[f"{name}.{q.name}"]) for q in CATALOGUE[name].parameters))
            for name in effects
            if CATALOGUE[name].actuate
        )
        loose = any(CATALOGUE[name].loose for name, _ in own)
        return self._of(run, own, joint_of(given) if loose else None)

    def _made(
        self,
        run: int,
        own: tuple[tuple[str, tuple[tuple[str, float], ...]], ...],
        joint: FreeJoint | None,
    ) -> Drive:
        drive = told(self._runs[run].gait, self._runs[run].start == "rest")
        for name, values in own:
            actuate = CATALOGUE[name].actuate
            if actuate:
                drive = actuate(drive, dict(values), joint)
        return drive


def drive_slopes(
    drives: Drives,
    run: int,
    t: Array,
    given: Mapping[str, float],
    effects: tuple[str, ...],
    wanted: tuple[str, ...],
) -> DriveSlopes | None:
    """How the drive changes with what is wanted; None if it does not."""
    moving = [
        (k, name)
        for k, name in enumerate(wanted)
        if "." in name and name.split(".")[0] in effects and _of_drive(name)
    ]
    if not moving:
        return None
    here = drives.of(run, given, effects)
    steps = steps_of(here, t, lateness(given, effects), **grain(effects))

    def path_at(values: Mapping[str, float]) -> DrivePath:
        # The very steps that predict are moved, each at one rate where dphi jumps, so that a jump
        # counts wherever in it it is.
        drive, late = drives.of(run, values, effects), lateness(values, effects)
        return drive_path(drive, steps, late, mean=not here.smooth)

    path = path_at(given)
    at = np.zeros((*path.at.shape, len(wanted)))
    nodes = np.zeros((*path.nodes.shape, len(wanted)))
    for k, name in moving:
        least, size = _extent(name)
        step = 1e-3 * size
        low, high = max(given[name] - step, least), given[name] + step
        ends = [path_at({**given, name: value}) for value in (low, high)]
        at[:, :, k] = (ends[1].at - ends[0].at) / (high - low)
        nodes[:, :, :, k] = (ends[1].nodes - ends[0].nodes) / (high - low)
    if here.smooth and here.rest:
        # How dphi sets in may change at once, and more than a step shows: what the first step
        # integrates to is the change of phi.
        rise = (nodes[0, 2, 0] - nodes[0, 0, 0]) / path.h[0]
        at[1, 0] = nodes[1, :2, 0] = (6 * rise - nodes[1, 2, 0]) / 5
    return DriveSlopes(at, nodes)


def lateness(given: Mapping[str, float], effects: tuple[str, ...]) -> float:
    """By how much the recording's clock is behind the command's, s."""
    return sum(given[f"{n}.{CATALOGUE[n].delay}"] for n in effects if CATALOGUE[n].delay)


def joint_of(given: Mapping[str, float]) -> FreeJoint:
    """The joint of a robot with these values, free of its servo."""
    return free_joint_of(lambda parameters: values_of(given, parameters))


def grain(effects: Sequence[str]) -> dict[str, bool]:
    """Whether some states settle at once, and whether some forces jump with the speed."""
    every = [CATALOGUE[name] for name in effects]
    return {"stiff": any(one.stiff for one in every), "sharp": any(one.sharp for one in every)}


def _of_drive(name: str) -> bool:
    effect, parameter = name.split(".")
    return CATALOGUE[effect].actuate is not None or CATALOGUE[effect].delay == parameter


def _extent(name: str) -> tuple[float, float]:
    """The least value of a quantity of an effect, and its usual size."""
    effect, parameter = name.split(".")
    q = next(q for q in CATALOGUE[effect].parameters if q.name == parameter)
    return q.bounds[0], q.typical
