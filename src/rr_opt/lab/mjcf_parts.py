"""Parts of the model text: the joint with its motor, and what only some rigs have."""

from __future__ import annotations

from rr_opt.lab.rig import Rig

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
    joint = f'<joint name="phi" type="hinge" axis="0 0 1" armature="{geared!r}"/>'
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


def motor(step: float) -> str:
    """Its drive, whose control is an angular acceleration, and the constraint phi = command."""
    return (
        f'<equality><joint joint1="phi" joint2="command" solref="{-0.25 / step**2!r} {-1 / step!r}"'
        ' solimp="0.9999 0.9999 0.001"/></equality>'
        f'<actuator><motor joint="command" gear="{MOTOR_INERTIA!r}"/></actuator>'
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
        f'<tendon><spatial stiffness="{rig.tether.stiffness!r}" '
        f'springlength="0 {rig.tether.slack!r}"><site site="post"/><site site="hook"/></spatial>'
        "</tendon>"
    )
