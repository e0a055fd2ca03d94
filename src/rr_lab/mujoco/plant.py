"""A rig as a compiled MuJoCo model with its state, stepped.

MuJoCo takes many steps at once, from a table of controls. Only where something acts on the robot
that is not known beforehand, a law of the wheels or a push, is each step taken from here.
"""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from rr_lab.mujoco.model_text import loop, model_text
from rr_lab.rig import CABLE_ONSET, WHEELS, Rig, Wheels, wheel_loads
from rr_opt.array import Array
from rr_opt.outcome import InputError, NotConvergedError


def engine() -> Any:
    """The module mujoco. Raises InputError if it is not installed."""
    try:
        mujoco: Any = import_module("mujoco")
        import_module("mujoco.rollout")
    except ImportError:
        raise InputError(
            "The virtual laboratory has no engine: MuJoCo is not installed. Expected the package "
            "mujoco. Install it with: pip install 'rr-opt[lab]', or take the engine planar."
        ) from None
    # Its warnings would go to a file in the working folder; `Plant.require_sound` looks for them.
    mujoco.set_mju_user_warning(_silent)
    _stop_clock(mujoco)
    return mujoco


@cache
def _stop_clock(mujoco: Any) -> None:
    """Keep MuJoCo from timing the parts of each step: with a model as small as this, reading the
    clock takes a sixth of the time."""
    try:
        # MuJoCo has no clock unless it is given one. Its Python package gives it one and only ever
        # puts another in its place, so the library is asked where it is kept.
        library = ctypes.CDLL(mujoco._callbacks.__file__)
        ctypes.c_void_p.in_dll(library, "mjcb_time").value = None
    except (AttributeError, OSError, ValueError):
        return  # Slower, and otherwise the same.


def _silent(_: str) -> None:
    pass


@dataclass
class Plant:
    """The rig, MuJoCo, its model and its data; and where in them the wheels' hinges and bodies are,
    platform 1, and the first of the tyres."""

    rig: Rig
    mujoco: Any
    model: Any
    data: Any
    rolls: Any
    turned: Any
    wheels: Any
    platform1: int
    tyre: int

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
        platform1, tyre = model.body("platform1").id, model.geom(f"tyre{WHEELS[0]}").id
        plant = cls(rig, mujoco, model, data, rolls, turned, wheels, platform1, tyre)
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
        data, joint = self.data, self.model.joint("phi").dofadr[0]
        if loop(self.rig) is None:
            kind = self.mujoco.mjtConstraint.mjCNSTR_EQUALITY
            drive = data.efc_force[np.flatnonzero(data.efc_type[: data.nefc] == kind)[0]]
        else:
            drive = data.qfrc_passive[joint]
        return float(drive - self.model.dof_armature[joint] * data.qacc[joint])

    def push(self, acceleration: float) -> None:
        """Push platform 1 along its axis with the force that would give all mass this, m/s2."""
        body = self.data.body("platform1")
        robot = self.rig.robot
        force = (robot.platform1.m + robot.platform2.m) * acceleration
        body.xfrc_applied[:3] = force * body.xmat[[0, 3, 6]]

    def brake(self, t: float) -> None:
        """Set what brakes each wheel by the rig's laws, t s after the robot was let go."""
        rig, data = self.rig, self.data
        ahead = data.xmat[self.platform1, [0, 3]]
        wheels = Wheels(
            t,
            data.qvel[self.rolls],
            data.qpos[self.turned],
            data.xpos.take(self.wheels, axis=0)[:, :2],
            math.atan2(ahead[1], ahead[0]),
            self.loads(),
            np.array(rig.kappa),
            np.array(rig.dry),
            np.zeros(len(WHEELS)),
        )
        for law in rig.laws:
            law(wheels)
        self.model.dof_damping[self.rolls] = wheels.damping
        self.model.dof_frictionloss[self.rolls] = wheels.dry
        data.qfrc_applied[self.rolls] = wheels.torque

    def drag(self) -> None:
        """Hold axle 2 back with the friction of a cable that it drags."""
        velocity, axle = np.empty(6), self.data.body("axle2")
        kind = self.mujoco.mjtObj.mjOBJ_XBODY
        self.mujoco.mj_objectVelocity(self.model, self.data, kind, axle.id, velocity, 0)
        along = velocity[3:5]
        axle.xfrc_applied[:2] = -self.rig.cable * along / np.hypot(np.hypot(*along), CABLE_ONSET)

    def loads(self) -> Array:
        """With which the wheels pressed on the floor in the last step, N (4,); before the first
        step what a robot that stands would."""
        contacts = self.data.contact
        if not len(contacts):
            return wheel_loads(self.rig)
        rows, pressed = contacts.efc_address, np.zeros(len(WHEELS))
        # A contact that is about to part has no row.
        pressed[contacts.geom.max(axis=1)[rows >= 0] - self.tyre] = self.data.efc_force[
            rows[rows >= 0]
        ]
        return pressed

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


def stepped(plant: Plant, controls: Array, times: Array) -> Array:
    """Take a step with each control; what the sensors see at the beginning of each, (n, sensors).

    controls  angular accelerations of the flywheel, rad/s2 (n,)
    times     since the robot was let go, s (n,), for the laws

    Raises NotConvergedError if MuJoCo lost the motion.
    """
    # MuJoCo's own loop forgets forces.
    alone = plant.rig.laws or plant.rig.cable or plant.data.xfrc_applied.any()
    seen = _one_by_one(plant, controls, times) if alone else _all(plant, controls)
    # Asked here and not at the end of a run: that loop begins by forgetting earlier warnings.
    plant.require_sound()
    return seen


def _one_by_one(plant: Plant, controls: Array, times: Array) -> Array:
    model, data, rig = plant.model, plant.data, plant.rig
    step, control, sensors = plant.mujoco.mj_step, data.ctrl, data.sensordata
    seen = np.empty((len(controls), model.nsensordata))
    for k, (given, t) in enumerate(zip(controls.tolist(), times.tolist(), strict=True)):
        if rig.laws:
            plant.brake(t)
        if rig.cable:
            plant.drag()
        control[0] = given
        step(model, data)
        seen[k] = sensors
    return seen


def _all(plant: Plant, controls: Array) -> Array:
    mujoco, model, data = plant.mujoco, plant.model, plant.data
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS.value
    state = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, state, kind)
    # The solver starts from the last step's answer.
    warm = data.qacc_warmstart.copy()
    _, seen = mujoco.rollout.rollout(model, data, state, controls[:, None], initial_warmstart=warm)
    return seen[0]
