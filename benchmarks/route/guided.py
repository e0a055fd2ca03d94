"""A rig in the plane driven by a command that depends on what is seen of it."""

from typing import Any, Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_lab.planar.drive import STEP, fine_enough, require_tame, step_of, still
from rr_lab.planar.layout import layout
from rr_lab.rig import Rig
from rr_lab.run import Conditions, Motion
from rr_opt.array import Array


class Guide(Protocol):
    """A command that depends on what is seen of the robot."""

    @property
    def over(self) -> float:
        """When it has ended, s; inf until that is known."""
        ...

    def see(self, t: float, pose: Array) -> None:
        """Called at every sample: t (s), and x (m), y (m) and heading (rad) of platform 1."""
        ...

    def angle(self, t: NDArray[Any]) -> Array:
        """The angle, rad, at times up to the next sample, s."""
        ...


def guided(rig: Rig, guide: Guide, conditions: Conditions, step: float = STEP) -> Motion:
    """Drive from rest by a guide until it is over, at most as long as the conditions say, and write
    down the motion, without torque. The servo's faults are left out. Raises NotConvergedError if
    the motion is lost."""
    built = layout(rig)
    n = len(built.names)
    every = max(1, round(1 / (conditions.rate * fine_enough(rig, step))))
    dt = 1 / (conditions.rate * every)
    sample = step_of(rig, dt).fold(every)
    ends = ca.Function("ends", [built.q], list(built.ends))
    asked = np.repeat(guide.angle(np.zeros(1)), 2)
    state: ca.DM = ca.DM(still(rig, conditions, asked[0]))
    half = state.numel() // 2
    q = [state[half : half + n]]
    for at in range(round(conditions.seconds * conditions.rate)):
        if at > guide.over * conditions.rate:
            break
        guide.see(at / conditions.rate, np.asarray(ends(q[-1])[0]).ravel())
        t = at / conditions.rate + dt * np.arange(1, every + 1)
        asked = np.append(asked[-2:], guide.angle(t))
        rate = (3 * asked[2:] - 4 * asked[1:-1] + asked[:-2]) / (2 * dt)
        signals = np.stack([asked[2:], rate, t, np.ones(every), np.zeros(every)])
        state = sample(state, signals)
        q.append(state[half : half + n])
    require_tame(np.asarray(state)[half + n : half + 2 * n])
    one, two = (np.asarray(each).T for each in ends(ca.hcat(q)))
    return Motion(np.arange(len(q)) / conditions.rate, one, two)
