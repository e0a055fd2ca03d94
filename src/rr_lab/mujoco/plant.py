"""A rig as a MuJoCo model: the values for the template `rig.xml`."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from rr_lab.rig import CABLE_ONSET, GRIPS, WHEELS, Motor, Rig, Wheels, swing_inertia, wheel_loads
from rr_opt.array import Array
from rr_opt.model.robot import Platform
from rr_opt.outcome import InputError, NotConvergedError

if TYPE_CHECKING:
    from jinja2 import Template


MOTOR_INERTIA = 1e9
"""kg m2. A flywheel too heavy for the robot to disturb, turned to the commanded angle, drives
platform 2 by a stiff constraint: the angle is prescribed, as in the nominal model."""

GEAR_INERTIA = 1e-3
"""kg m2, of the gear that carries the backlash. Its motion is prescribed, so it moves nothing else;
with less inertia, MuJoCo would make the stops as light as the gear, and soft."""

BEAM_INERTIA = 1e-3
"""kg m2, about that swinging on a bending beam; sets its damping to a tenth of critical."""

LOAD_INERTIA = 1e-6
"""kg m2, of a loose load."""

WHEEL_MASS = 5e-5
"""kg, of one wheel; subtracted from its platform's."""

HARD = 0.99
"""MuJoCo's impedance of a non-sliding contact. Closer to 1, the four wheels, one more than a rigid
body needs, chatter under large side forces."""

SLIDING = 0.5
"""The impedance of a contact that may slide. In MuJoCo a sliding contact pushes itself off the
floor, in proportion to its speed. Differences of this between the wheels lift some and load others
by as much as their own weight, the more the harder the contacts: at 0.99 the side force of an axle
was between 0.3 and 2.3 times the friction of its load, at 0.5 it is within 1 % of it."""

GRIP_RATE = 1.9
"""Rate of side slip correction, in units of 1/step. 2 would keep the mean slip of two steps at zero
and thus be of second order, but never decay; 1 lags by half a step."""

CREEP_RATE = 1.65
"""The rate where wheels creep. The residual slip of a step resembles creep of (1/CREEP_RATE - 1/2)
step/mass: 2e-5 to 1e-4 m/(N s) for light robots. From 1.7 on, wheels that creep by less than that
chatter."""

TURNING_LOAD = 5e-5
"""kg, the least spin inertia of a wheel over h^2 that can be integrated."""


def model_text(rig: Rig, step: float) -> str:
    """The MJCF of a rig for a step of `step` s."""
    one, two = rig.robot.platform1, rig.robot.platform2
    J = spin_inertia(rig, step)
    return _template().render(
        rig=rig,
        step=step,
        h=rig.robot.h,
        platforms=[_platform(rig, 0, one, 1.0, J), _platform(rig, 1, two, -1.0, J)],
        drive=loop(rig),
        hard=HARD if rig.mu >= GRIPS else SLIDING,
        grip_rate=GRIP_RATE,
        motor_inertia=MOTOR_INERTIA,
        gear_inertia=GEAR_INERTIA,
        load_inertia=LOAD_INERTIA,
        load_place=one.joint_to_centre,
        load_damping=0.1 * (rig.load[0] * rig.load[1]) ** 0.5 if rig.load else 0.0,
        bend_damping=0.1 * ((rig.spring or 0.0) * BEAM_INERTIA) ** 0.5,
    )


@cache
def _template() -> Template:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader("rr_lab.mujoco", ""),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        autoescape=False,
    ).get_template("rig.xml")


def spin_inertia(rig: Rig, step: float) -> float:
    """Spin inertia given to each wheel, kg m2, so that its friction stops it over many steps.

    It is subtracted from the platform, so that the nominal robot is unchanged.
    """
    k = max(rig.kappa) / rig.robot.h**2
    return rig.robot.h**2 * max(TURNING_LOAD, 8 * k * step)


def _platform(rig: Rig, i: int, part: Platform, ahead: float, J: float) -> dict[str, Any]:
    """Body and wheels of a platform, P at the origin, its axle `ahead` (+1) or behind (-1).

    A rolling wheel carries the inertia of a load J/h^2 at its place. As the axle does not slip, the
    pair acts as a load 2J/h^2 at its centre with the moment of inertia 2 b^2 J/h^2. These and the
    wheels' own mass are subtracted from the platform to give its body.
    """
    h, left = rig.robot.h, rig.left[i]
    axle, centre = ahead * part.c, ahead * part.joint_to_centre
    each, thin = WHEEL_MASS + J / h**2, WHEEL_MASS * h**2 / 4
    m = part.m - 2 * each
    x, y = (part.m * centre - 2 * each * axle) / m, part.m * left / m
    about_p = part.I + part.m * (centre**2 + left**2)
    I = about_p - 2 * (each * (axle**2 + part.b**2) + thin) - m * (x**2 + y**2)
    wheels = [
        {
            "name": WHEELS[n],
            "y": side * part.b,
            "mass": WHEEL_MASS,
            "thin": thin,
            "armature": J - thin + rig.J[n],
            "kappa": rig.kappa[n],
            "quadratic": rig.quadratic[n],
            "dry": rig.dry[n],
        }
        for n, side in ((2 * i, 1), (2 * i + 1, -1))
    ]
    return {
        "number": i + 1,
        "mass": m,
        "place": (x, y, -h / 2),
        "moments": (0.6 * I, 0.6 * I, I),
        "axle": axle,
        "pivot": 0.0 if rig.spring is None else axle / 2,
        "toe": rig.toe[i],
        "wheels": wheels,
    }


def loop(rig: Rig) -> Motor | None:
    """The compliance that holds phi at the command: servo loop and gear in series; None if both are
    stiff."""
    gear = None
    if rig.gear is not None:
        gear = Motor(rig.gear, 2 * (rig.gear * GEAR_INERTIA) ** 0.5)
    if rig.motor is None or gear is None:
        return rig.motor or gear
    stiffness = 1 / (1 / rig.motor.stiffness + 1 / gear.stiffness)
    return Motor(stiffness, rig.motor.damping, rig.motor.feedforward)


def longest_step(rig: Rig) -> float:
    """s, in which a compliant servo advances by a third of a radian of its own oscillation:
    MuJoCo's explicit steps become unstable at six times that."""
    drive = loop(rig)
    if drive is None:
        return math.inf
    inertia = GEAR_INERTIA if rig.play else swing_inertia(rig.robot)
    return 0.3 * min((inertia / drive.stiffness) ** 0.5, inertia / drive.damping)


def engine() -> Any:
    """The module mujoco. Raises InputError if it is not installed."""
    try:
        mujoco: Any = import_module("mujoco")
        import_module("mujoco.rollout")
    except ImportError:
        raise InputError(
            "The virtual laboratory has no engine: MuJoCo is not installed. Expected the package "
            "mujoco. Install it with: pip install 'rr-opt[lab]', or use the planar engine."
        ) from None
    # Its warnings would go to a file in the working folder; `Plant.require_sound` checks for them.
    mujoco.set_mju_user_warning(_silent)
    _stop_clock(mujoco)
    return mujoco


@cache
def _stop_clock(mujoco: Any) -> None:
    """Keep MuJoCo from timing the parts of each step: for a model as small as this, reading the
    clock takes a sixth of the time."""
    try:
        # MuJoCo has no clock unless given one. Its Python package sets one and can only replace it,
        # so its address is looked up in the library.
        library = ctypes.CDLL(mujoco._callbacks.__file__)
        ctypes.c_void_p.in_dll(library, "mjcb_time").value = None
    except (AttributeError, OSError, ValueError):
        return  # slower, but otherwise the same


def _silent(_: str) -> None:
    pass


@dataclass
class Plant:
    """The rig, MuJoCo, its model and its data; and the indices of the wheels' hinges and bodies,
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
        """P at (x, y) and platform 1 heading (rad) as in the pose, the joint at `angle` rad."""
        x, y, heading = pose
        base = self.model.joint("base").qposadr[0]
        self.data.qpos[base : base + 2] = x, y
        self.data.qpos[base + 3 : base + 7] = math.cos(heading / 2), 0, 0, math.sin(heading / 2)
        for name in ("phi", "command"):
            self.data.qpos[self.model.joint(name).qposadr[0]] = angle

    def torque(self) -> float:
        """Torque of the servo on platform 2, N m, in the last step."""
        data, joint = self.data, self.model.joint("phi").dofadr[0]
        if loop(self.rig) is None:
            kind = self.mujoco.mjtConstraint.mjCNSTR_EQUALITY
            drive = data.efc_force[np.flatnonzero(data.efc_type[: data.nefc] == kind)[0]]
        else:
            drive = data.qfrc_passive[joint]
        return float(drive - self.model.dof_armature[joint] * data.qacc[joint])

    def push(self, acceleration: float) -> None:
        """Push platform 1 along its axis so as to accelerate the whole mass by this, m/s2."""
        body = self.data.body("platform1")
        robot = self.rig.robot
        force = (robot.platform1.m + robot.platform2.m) * acceleration
        body.xfrc_applied[:3] = force * body.xmat[[0, 3, 6]]

    def brake(self, t: float) -> None:
        """Set the friction of each wheel by the rig's laws, t s after the robot was released."""
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
        """Apply the friction of a dragged cable to axle 2."""
        velocity, axle = np.empty(6), self.data.body("axle2")
        kind = self.mujoco.mjtObj.mjOBJ_XBODY
        self.mujoco.mj_objectVelocity(self.model, self.data, kind, axle.id, velocity, 0)
        along = velocity[3:5]
        axle.xfrc_applied[:2] = -self.rig.cable * along / np.hypot(np.hypot(*along), CABLE_ONSET)

    def loads(self) -> Array:
        """Wheel loads on the floor in the last step, N (4,); before the first step those of a
        stationary robot."""
        contacts = self.data.contact
        if not len(contacts):
            return wheel_loads(self.rig)
        rows, pressed = contacts.efc_address, np.zeros(len(WHEELS))
        # A contact that is about to separate has no row.
        pressed[contacts.geom.max(axis=1)[rows >= 0] - self.tyre] = self.data.efc_force[
            rows[rows >= 0]
        ]
        return pressed

    def require_sound(self) -> None:
        """Raises NotConvergedError if MuJoCo's simulation failed."""
        if self.data.warning.number.any():
            raise NotConvergedError(
                "The laboratory's simulation diverged: MuJoCo reported huge accelerations. "
                "Expected a finite motion. Try a gentler gait, a weaker effect or a smaller step."
            )

    def soften(self, creep: float) -> None:
        """Make each contact compliant sideways by `creep`, m/(N s).

        MuJoCo resists a slip speed s with the force s b/R from its softness R and rate b, so R/b is
        the compliance. R of the friction rows is R of the normal row over `impratio`: the former is
        increased through the latter, so that b stays as fast as the step allows.
        """
        mujoco, model, data = self.mujoco, self.model, self.data
        # A contact that just touches has no rows yet: the wheels are pressed in slightly.
        height = model.joint("base").qposadr[0] + 2
        data.qpos[height] -= 1e-6
        mujoco.mj_forward(model, data)
        data.qpos[height] += 1e-6
        rows = [contact.efc_address for contact in data.contact]
        normal = np.array([data.efc_R[row] for row in rows])
        rate = CREEP_RATE / model.opt.timestep
        model.opt.impratio = float(normal.mean() / (creep * rate))
        for pair, R in enumerate(normal):
            b = R / model.opt.impratio / creep
            model.pair_solreffriction[pair] = -1e-9, -b * model.pair_solimp[pair, 1]


def stepped(plant: Plant, controls: Array, times: Array) -> Array:
    """Take a step with each control; sensor values at the start of each, (n, sensors).

    controls  angular accelerations of the flywheel, rad/s2 (n,)
    times     since the robot was released, s (n,), for the laws

    Raises NotConvergedError if MuJoCo's simulation failed.
    """
    # MuJoCo's own loop discards applied forces.
    alone = plant.rig.laws or plant.rig.cable or plant.data.xfrc_applied.any()
    seen = _one_by_one(plant, controls, times) if alone else _all(plant, controls)
    # Checked here, not at the end of a run, as that loop first clears earlier warnings.
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
    # The solver is warm-started from the last step.
    warm = data.qacc_warmstart.copy()
    _, seen = mujoco.rollout.rollout(model, data, state, controls[:, None], initial_warmstart=warm)
    return seen[0]
