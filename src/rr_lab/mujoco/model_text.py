"""A rig as MuJoCo's own model text.

Two boxes of mass on four balls, P at the first body's origin. A wheel is a ball, so that it touches
the floor at one point below its centre whatever way it heads. Each turns on its own hinge.
"""

from __future__ import annotations

import math

from rr_lab.rig import GRIPS, WHEELS, Motor, Rig, swing_inertia
from rr_opt.model.robot import Platform

MOTOR_INERTIA = 1e9
"""kg m2. A flywheel too heavy for the robot to disturb, turned to the commanded angle, carries
platform 2 with it by a stiff constraint: the angle is given, as the nominal model has it."""

GEAR_INERTIA = 1e-3
"""kg m2, of the gear that play hangs on. Its turning is given, so it moves nothing else; with less,
MuJoCo would take the stops for as light as the gear, and make them soft."""

BEAM_INERTIA = 1e-3
"""kg m2, what swings on a bending beam, about; it sets its damping to a tenth of the critical."""

LOAD_INERTIA = 1e-6
"""kg m2, of a loose load."""


def jointed(rig: Rig, platform2: str, step: float) -> str:
    """Platform 2 on the joint P: a hinge, with play in series and a loose pin if there are any."""
    geared = GEAR_INERTIA if rig.play else 0.0
    drive = loop(rig)
    damping = (1 - drive.feedforward) * drive.damping if drive is not None else 0.0
    joint = (
        f'<joint name="phi" type="hinge" axis="0 0 1" armature="{geared!r}" damping="{damping!r}"/>'
    )
    if rig.pin:
        slides = (("pinx", "1 0 0"), ("piny", "0 1 0"))
        joint = (
            "".join(_stopped(name, "slide", axis, rig.pin, step) for name, axis in slides) + joint
        )
    if not rig.play:
        return f'<body name="platform2">{joint}{platform2}</body>'
    horn = '<inertial pos="0 0 0" mass="1e-4" diaginertia="1e-7 1e-7 1e-7"/>'
    play = _stopped("play", "hinge", "0 0 1", rig.play / 2, step)
    return f'<body name="horn">{joint}{horn}<body name="platform2">{play}{platform2}</body></body>'


def _stopped(name: str, kind: str, axis: str, reach: float, step: float) -> str:
    """A joint that runs freely between two hard stops."""
    return (
        f'<joint name="{name}" type="{kind}" axis="{axis}" limited="true" '
        f'range="{-reach!r} {reach!r}" solreflimit="{2 * step!r} 1" '
        f'solimplimit="0.99 0.99 0.001"/>'
    )


def motor_body() -> str:
    """The flywheel."""
    return (
        '<body name="motor"><inertial pos="0 0 0" mass="1e-3" diaginertia="1e-6 1e-6 1e-6"/>'
        f'<joint name="command" type="hinge" axis="0 0 1" armature="{MOTOR_INERTIA!r}"/></body>'
    )


def motor(rig: Rig, step: float) -> str:
    """Its drive, whose control is an angular acceleration; phi is held at the command by a
    constraint, or by the spring of a servo that gives way."""
    drive = f'<actuator><motor joint="command" gear="{MOTOR_INERTIA!r}"/></actuator>'
    if loop(rig) is None:
        return (
            '<equality><joint joint1="phi" joint2="command" '
            f'solref="{-0.25 / step**2!r} {-1 / step!r}" solimp="0.9999 0.9999 0.001"/></equality>'
            f"{drive}"
        )
    return drive


def tendons(rig: Rig, step: float) -> str:
    """A cord, a servo that gives way, and dry friction of the joint; empty without any."""
    inner = cord(rig) + _servo_spring(rig) + _hinge_friction(rig, step)
    return f"<tendon>{inner}</tendon>" if inner else ""


def loop(rig: Rig) -> Motor | None:
    """What holds phi at the command: the servo's loop and the gear, one behind the other; None if
    neither gives way."""
    gear = None
    if rig.gear is not None:
        gear = Motor(rig.gear, 2 * (rig.gear * GEAR_INERTIA) ** 0.5)
    if rig.motor is None or gear is None:
        return rig.motor or gear
    stiffness = 1 / (1 / rig.motor.stiffness + 1 / gear.stiffness)
    return Motor(stiffness, rig.motor.damping, rig.motor.feedforward)


def longest_step(rig: Rig) -> float:
    """s, in which a servo that gives way turns by a third of a radian of its own swing: explicit
    steps, as MuJoCo takes them, lose it at six times that."""
    drive = loop(rig)
    if drive is None:
        return math.inf
    inertia = GEAR_INERTIA if rig.play else swing_inertia(rig.robot)
    return 0.3 * min((inertia / drive.stiffness) ** 0.5, inertia / drive.damping)


def _servo_spring(rig: Rig) -> str:
    """Twists by phi - command; a damper that knows the command's rate is in it, one that does not
    is the hinge's."""
    drive = loop(rig)
    if drive is None:
        return ""
    return (
        f'<fixed name="servo" stiffness="{drive.stiffness!r}" '
        f'damping="{drive.feedforward * drive.damping!r}" springlength="0">'
        '<joint joint="phi" coef="1"/><joint joint="command" coef="-1"/></fixed>'
    )


def _hinge_friction(rig: Rig, step: float) -> str:
    """Dry friction between the platforms: on phi and the play together."""
    if not rig.hinge_dry:
        return ""
    play = '<joint joint="play" coef="1"/>' if rig.play else ""
    return (
        f'<fixed name="hinge" frictionloss="{rig.hinge_dry!r}" solreffriction="{2 * step!r} 1" '
        f'solimpfriction="0.99 0.99 0.001"><joint joint="phi" coef="1"/>{play}</fixed>'
    )


def sensors() -> str:
    """For each platform where its joint end is, and its forward axis: three numbers each."""
    seen = "".join(
        f'<{what} objtype="xbody" objname="{platform}"/>'
        for platform in ("platform1", "platform2")
        for what in ("framepos", "framexaxis")
    )
    return f"<sensor>{seen}</sensor>"


def bent(name: str, pivot: float, stiffness: float, axle: str) -> str:
    """An axle on a beam that bends sideways at `pivot`, m from P: a hinge with a torsion spring."""
    damping = 0.1 * (stiffness * BEAM_INERTIA) ** 0.5
    return (
        f'<body name="{name}" pos="{pivot!r} 0 0"><inertial pos="0 0 0" mass="1e-3" '
        f'diaginertia="1e-5 1e-5 1e-5"/><joint name="bend-{name}" type="hinge" axis="0 0 1" '
        f'stiffness="{stiffness!r}" damping="{damping!r}"/>{axle}</body>'
    )


def loose_load(rig: Rig) -> str:
    """A load on platform 1 that a spring lets shift sideways."""
    if rig.load is None:
        return ""
    mass, stiffness = rig.load
    damping = 0.1 * (mass * stiffness) ** 0.5
    reach = rig.robot.platform1.joint_to_centre
    return (
        f'<body name="load" pos="{reach!r} 0 0"><inertial pos="0 0 0" mass="{mass!r}" '
        f'diaginertia="{LOAD_INERTIA!r} {LOAD_INERTIA!r} {LOAD_INERTIA!r}"/><joint name="shift" '
        f'type="slide" axis="0 1 0" stiffness="{stiffness!r}" damping="{damping!r}"/></body>'
    )


def post(rig: Rig) -> str:
    """Where a tether is tied to the floor."""
    if rig.tether is None:
        return ""
    return f'<site name="post" pos="{rig.tether.x!r} {rig.tether.y!r} {rig.robot.h!r}"/>\n'


def hook(rig: Rig) -> str:
    """Where a tether is tied to platform 1: over its centre of mass."""
    if rig.tether is None:
        return ""
    return f'<site name="hook" pos="{rig.robot.platform1.joint_to_centre!r} 0 0"/>'


def cord(rig: Rig) -> str:
    """The tether: it pulls when it is longer than its slack."""
    if rig.tether is None:
        return ""
    return (
        f'<spatial stiffness="{rig.tether.stiffness!r}" '
        f'springlength="0 {rig.tether.slack!r}"><site site="post"/><site site="hook"/></spatial>'
    )


WHEEL_MASS = 5e-5
"""kg, of one wheel; taken from its platform's."""

HARD = 0.99
"""MuJoCo's impedance of a contact that holds. Nearer to 1 the four wheels, one more than a stiff
body needs to stand, chatter under large side forces."""

SLIDING = 0.5
"""The same of one that may slide. In MuJoCo a sliding contact pushes itself off the floor, by more
the faster it slides. What the four wheels do not agree on of that lifts some and loads others by as
much as their own weight, the harder the contacts the more: at 0.99 the side force of an axle was
between 0.3 and 2.3 times the friction of its load, at 0.5 it is within 1 % of it."""

GRIP_RATE = 1.9
"""How fast side slip is taken back, in units of 1/step. 2 would hold the mean of two steps' slips
at zero and thus be of second order, but never die out; 1 lags by half a step."""

TURNING_LOAD = 5e-5
"""kg, the least spin inertia of a wheel over h^2: what a wheel needs to be integrated at all."""


def spin_inertia(rig: Rig, step: float) -> float:
    """Spin inertia that each wheel is given, kg m2, so that its friction stops it in many steps.

    It is taken back from the platform, see `_body`, so that the nominal robot has none.
    """
    k = max(rig.kappa) / rig.robot.h**2
    return rig.robot.h**2 * max(TURNING_LOAD, 8 * k * step)


def model_text(rig: Rig, step: float) -> str:
    """The MJCF of a rig for a step of `step` s.

    All hangs together, so MuJoCo is not to look for islands at every step.
    """
    h, J = rig.robot.h, spin_inertia(rig, step)
    first = _platform(rig, 0, rig.robot.platform1, 1.0, J)
    second = _platform(rig, 1, rig.robot.platform2, -1.0, J)
    return f"""<mujoco><compiler angle="radian" boundmass="0" boundinertia="0"/>
<option timestep="{step!r}" density="{rig.density!r}" cone="elliptic" impratio="10"
 solver="Newton" iterations="100" tolerance="1e-15" integrator="Euler">
 <flag eulerdamp="{_implicit(rig)}" island="disable"/></option>
<worldbody><geom name="floor" type="plane" size="0 0 1" contype="0" conaffinity="0"/>
{post(rig)}<body name="platform1" pos="0 0 {h!r}"><freejoint name="base"/>
{first}{hook(rig)}{loose_load(rig)}{jointed(rig, second, step)}</body>
{motor_body()}</worldbody>
<contact>{"".join(_pair(wheel, rig.mu, step) for wheel in WHEELS)}</contact>
{tendons(rig, step)}{motor(rig, step)}{sensors()}</mujoco>"""


def _implicit(rig: Rig) -> str:
    """Whether hinges are damped implicitly.

    MuJoCo does so once the constraints are solved, which moves the wheels off them where a damped
    part is light: nothing to the wheels' own friction, much to a beam's or a servo's.
    """
    return "enable" if rig.spring is None and loop(rig) is None else "disable"


def _platform(rig: Rig, i: int, part: Platform, ahead: float, J: float) -> str:
    """Mass and wheels of a platform, P at the origin, its axle `ahead` (+1) or behind (-1)."""
    wheels = "".join(_wheel(rig, 2 * i + n, side * part.b, J) for n, side in enumerate((1, -1)))
    pivot = 0.0 if rig.spring is None else ahead * part.c / 2
    axle = (
        f'<body name="axle{i + 1}" pos="{ahead * part.c - pivot!r} 0 0" euler="0 0 {rig.toe[i]!r}">'
        f"{wheels}</body>"
    )
    if rig.spring is not None:
        axle = bent(f"beam{i + 1}", pivot, rig.spring, axle)
    return _body(part, ahead, rig.left[i], J, rig.robot.h) + axle


def _body(part: Platform, ahead: float, left: float, J: float, h: float) -> str:
    """What is left of the platform for its own body, once the wheels have their share.

    A rolling wheel carries the inertia of a load J/h^2 at its place. Two of them are, as the axle
    does not slip, a load 2J/h^2 at its centre with the moment of inertia 2 b^2 J/h^2; these too are
    taken from the body.
    """
    axle, centre = ahead * part.c, ahead * part.joint_to_centre
    rolling = J / h**2
    each, own = WHEEL_MASS + rolling, WHEEL_MASS * h**2 / 4
    m = part.m - 2 * each
    x, y = (part.m * centre - 2 * each * axle) / m, part.m * left / m
    about_p = part.I + part.m * (centre**2 + left**2)
    I = about_p - 2 * (each * (axle**2 + part.b**2) + own) - m * (x**2 + y**2)
    flat = 0.6 * I
    return (
        f'<inertial pos="{x!r} {y!r} {-h / 2!r}" mass="{m!r}" '
        f'diaginertia="{flat!r} {flat!r} {I!r}"/>'
    )


def _wheel(rig: Rig, n: int, y: float, J: float) -> str:
    name, h = WHEELS[n], rig.robot.h
    thin = WHEEL_MASS * h**2 / 4
    return (
        f'<body name="wheel{name}" pos="0 {y!r} 0"><inertial pos="0 0 0" mass="{WHEEL_MASS!r}" '
        f'diaginertia="{thin!r} {thin!r} {thin!r}"/>'
        f'<joint name="roll{name}" type="hinge" axis="0 1 0" armature="{J - thin + rig.J[n]!r}" '
        f'damping="{rig.kappa[n]!r} {rig.quadratic[n]!r} 0" frictionloss="{rig.dry[n]!r}" '
        'solreffriction="-1e-9 -2000" solimpfriction="0.9999 0.9999 0.001"/>'
        f'<geom name="tyre{name}" type="sphere" size="{h!r}" contype="0" conaffinity="0"/></body>'
    )


def _pair(wheel: str, mu: float, step: float) -> str:
    hard = HARD if mu >= GRIPS else SLIDING
    return (
        f'<pair geom1="floor" geom2="tyre{wheel}" condim="3" friction="{mu!r} {mu!r} 0 0 0" '
        f'solref="{2 * step!r} 1" solreffriction="-1e-9 {-GRIP_RATE * hard / step!r}" '
        f'solimp="{hard!r} {hard!r} 0.001"/>'
    )
