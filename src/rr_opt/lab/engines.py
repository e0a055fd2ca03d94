"""The engines that drive a rig, by name.

They share what is hidden, the command as the servo's faults shape it, and the capture system; no
equation of motion and no contact.
"""

from __future__ import annotations

from typing import Literal, get_args

from rr_opt.lab.drive import STEP, drive
from rr_opt.lab.outing import Motion, Outing
from rr_opt.lab.rig import Rig
from rr_opt.robot.gait import Gait

Engine = Literal["mujoco", "planar"]
"""A robot in three dimensions in MuJoCo, or two bodies in the plane, stepped here."""

ENGINES: tuple[Engine, ...] = get_args(Engine)


def driven(
    engine: Engine, rig: Rig, gait: Gait, outing: Outing, step: float | None = None
) -> Motion:
    """Drive a gait with steps of `step` s, or of the engine's own.

    Raises InputError if MuJoCo is asked for and not installed, NotConvergedError if the motion is
    lost.
    """
    if engine == "mujoco":
        return drive(rig, gait, outing, STEP if step is None else step)
    from rr_opt.lab.planar import drive as planar  # noqa: PLC0415  CasADi takes a moment

    return planar.drive(rig, gait, outing, planar.STEP if step is None else step)


def fine_enough(engine: Engine, rig: Rig, step: float) -> float:
    """The step that an engine drives a rig with where `step` is asked for, s."""
    if engine == "mujoco":
        return step
    from rr_opt.lab.planar import drive as planar  # noqa: PLC0415  CasADi takes a moment

    return planar.fine_enough(rig, step)
