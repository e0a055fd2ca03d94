"""A rig as a compiled MuJoCo model with its state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.lab.engine import engine
from rr_opt.lab.mjcf import model_text
from rr_opt.lab.rig import WHEELS, Rig, Turning
from rr_opt.outcome import NotConvergedError

Array = NDArray[np.float64]


@dataclass
class Plant:
    """The rig, MuJoCo, its model and its data; and where the wheels' hinges are in them."""

    rig: Rig
    mujoco: Any
    model: Any
    data: Any
    rolls: Any
    turned: Any
    wheels: Any

    @classmethod
    def of(cls, rig: Rig, step: float) -> Plant:
        """Compile a rig. Raises InputError if MuJoCo is not installed."""
        mujoco = engine()
        model = mujoco.MjModel.from_xml_string(model_text(rig, step))
        data = mujoco.MjData(model)
        joints = [model.joint(f"roll{name}") for name in WHEELS]
        wheels = np.array([model.body(f"wheel{name}").id for name in WHEELS], np.intp)
        rolls = np.array([joint.dofadr[0] for joint in joints], np.intp)
        turned = np.array([joint.qposadr[0] for joint in joints], np.intp)
        plant = cls(rig, mujoco, model, data, rolls, turned, wheels)
        if rig.creep:
            plant.soften(rig.creep)
        return plant

    def put_down(self, pose: tuple[float, float, float], angle: float) -> None:
        """P at (x, y), platform 1 heading (rad) as the pose says, and the joint at `angle` rad."""
        x, y, heading = pose
        base = self.model.joint("base").qposadr[0]
        self.data.qpos[base : base + 2] = x, y
        self.data.qpos[base + 3 : base + 7] = math.cos(heading / 2), 0, 0, math.sin(heading / 2)
        for name in ("phi", "command"):
            self.data.qpos[self.model.joint(name).qposadr[0]] = angle

    def torque(self) -> float:
        """Of the servo on platform 2, N m, in the last step."""
        data = self.data
        kind = self.mujoco.mjtConstraint.mjCNSTR_EQUALITY
        rows = np.flatnonzero(data.efc_type[: data.nefc] == kind)
        joint = self.model.joint("phi").dofadr[0]
        gear = self.model.dof_armature[joint] * data.qacc[joint]
        return float(data.efc_force[rows[0]] - gear)

    def push(self, acceleration: float) -> None:
        """Push platform 1 along its axis with the force that would give all mass this, m/s2."""
        body = self.data.body("platform1")
        robot = self.rig.robot
        force = (robot.platform1.m + robot.platform2.m) * acceleration
        body.xfrc_applied[:3] = force * body.xmat[[0, 3, 6]]

    def brake(self, t: float) -> None:
        """Set what brakes each wheel by the rig's laws, t s after the robot was let go."""
        rig, data = self.rig, self.data
        turning = Turning(
            t,
            data.qvel[self.rolls],
            data.qpos[self.turned],
            data.xpos.take(self.wheels, axis=0)[:, :2],
            np.array(rig.kappa),
            np.array(rig.dry),
        )
        for law in rig.laws:
            law(turning)
        self.model.dof_damping[self.rolls] = turning.damping
        self.model.dof_frictionloss[self.rolls] = turning.dry

    def require_sound(self) -> None:
        """Raises NotConvergedError if MuJoCo lost the motion."""
        if self.data.warning.number.any():
            raise NotConvergedError(
                "The laboratory's simulation broke down: MuJoCo met huge accelerations. Expected a "
                "motion. Take a gentler gait, a weaker effect or a smaller step."
            )

    def soften(self, creep: float) -> None:
        """Let the contacts give way sideways by `creep`, m/(N s), each.

        MuJoCo holds a slip speed s with the force s b/R of its own softness R and rate b, so R/b is
        the compliance. R of the friction rows is R of the normal row over `impratio`: the first is
        raised through the second, so that b stays as fast as the step allows.
        """
        mujoco, model, data = self.mujoco, self.model, self.data
        # A contact that just touches makes no rows yet: the wheels are pressed in a little.
        height = model.joint("base").qposadr[0] + 2
        data.qpos[height] -= 1e-6
        mujoco.mj_forward(model, data)
        data.qpos[height] += 1e-6
        rows = [contact.efc_address for contact in data.contact]
        normal = np.array([data.efc_R[row] for row in rows])
        rate = 0.5 / model.opt.timestep
        model.opt.impratio = float(normal.mean() / (creep * rate))
        for pair, R in enumerate(normal):
            b = R / model.opt.impratio / creep
            model.pair_solreffriction[pair] = -1e-9, -b * model.pair_solimp[pair, 1]
