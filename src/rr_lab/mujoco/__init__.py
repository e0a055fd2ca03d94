"""A gait driven on a rig: MuJoCo integrates it, and its motion is recorded."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_lab.mujoco.plant import Plant, longest_step, stepped
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion, asked_angle
from rr_opt.array import Array
from rr_opt.model.gait import Gait

SETTLE = 0.05
"""s, in which the robot settles on its wheels before the run, on a level floor."""

STEP = 2.5e-4
"""s. results/lab/README.md shows its accuracy."""


@dataclass(frozen=True)
class Course:
    """Of `count` steps, the robot is released at `let_go`; the recording begins at `first` and
    samples the start of every `every`-th step."""

    let_go: int
    first: int
    every: int
    count: int

    @property
    def recorded(self) -> range:
        """Steps with a sample at their start."""
        return range(self.first, self.count, self.every)

    def parts(self, *, pushed: bool, torque: bool) -> Iterator[tuple[int, int]]:
        """Ranges of steps that can be taken in one call: first, and one past the last.

        pushed  whether step `first` differs from the others
        torque  whether the steps that begin with a sample have to be inspected individually
        """
        marks = {0, self.let_go, self.first, self.count}
        if pushed:
            marks.add(self.first + 1)
        if torque:
            marks |= {n for k in self.recorded for n in (k, k + 1)}
        return pairwise(sorted(mark for mark in marks if mark <= self.count))

    def samples(self, start: int) -> slice:
        """Which steps from `start` on, not before `first`, are recorded."""
        return slice((self.first - start) % self.every, None, self.every)


def fine_enough(rig: Rig, step: float) -> float:
    """The step actually used if `step` is requested, s."""
    return min(step, longest_step(rig))


def drive(rig: Rig, gait: Gait, conditions: Conditions, step: float = STEP) -> Motion:
    """Drive a gait and record the motion. Raises NotConvergedError if the simulation fails."""
    step = fine_enough(rig, step)
    plant = Plant.of(rig, step)
    every = max(1, round(1 / (conditions.rate * step)))
    dt = 1 / (conditions.rate * every)
    plant.model.opt.timestep = dt
    begin = conditions.begin(gait)
    before = math.ceil((SETTLE + max(0.0, rig.clock - begin)) / dt)
    count = before + round(conditions.seconds * conditions.rate) * every + 1
    t = rig.clock + (np.arange(count + 1) - before) * dt
    angle = asked_angle(rig, gait, begin, t)
    let_go = int(np.searchsorted(t, begin - 1e-12))
    return _run(plant, conditions, angle, t - begin, Course(let_go, before, every, count))


def _run(
    plant: Plant, conditions: Conditions, angle: Array, t: NDArray[Any], course: Course
) -> Motion:
    """Drive the flywheel through `angle`, rad, at the times t, s since the robot was released."""
    model, dt = plant.model, plant.model.opt.timestep
    plant.put_down(conditions.pose, angle[0])
    model.opt.gravity[:] = 0.0, 0.0, plant.rig.gravity[2]
    # The acceleration that makes the flywheel, with steps q' = q + dt w', follow `angle`.
    push = np.diff(np.concatenate([angle[:1], angle]), 2) / dt**2
    seen, torques = [], []
    for start, stop in course.parts(pushed=conditions.nudge != 0, torque=conditions.torque):
        if start == course.let_go:
            model.opt.gravity[:] = plant.rig.gravity
        if conditions.nudge:
            plant.push(conditions.nudge / dt if start == course.first else 0.0)
        rows = stepped(plant, push[start:stop], t[start:stop])
        if start >= course.first:
            seen.append(rows[course.samples(start)])
        if conditions.torque and start in course.recorded:
            torques.append(plant.torque())
    one, two = np.hsplit(np.concatenate(seen), 2)
    when = np.arange(len(one)) / conditions.rate
    return Motion(
        when, _placed(one), _placed(two), np.array(torques) if conditions.torque else None
    )


def _placed(seen: Array) -> Array:
    """x, y, heading (n, 3) from the sensors of a platform: place and forward axis."""
    heading = list(map(math.atan2, seen[:, 4].tolist(), seen[:, 3].tolist()))
    return np.column_stack([seen[:, :2], np.unwrap(heading)])
