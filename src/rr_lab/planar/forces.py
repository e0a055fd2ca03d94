"""Forces on a rig in the plane, except for its wheels: motor, stops, compliances and pushes.

The end of a step depends on its forces, and these on the end. So the end is found by iteration:
forces are linearised about the current iterate, and the resulting end is the next one.

The servo is a motor that turns platform 2 against platform 1 to follow its command. Its torque is
stiffness * (asked - made) + damping * (the same of the rates), on platform 2 and with the other
sign on platform 1; it has no limit. Nothing else determines the angle.

A stop bounds a clearance: of platform 2 on the motor's shaft, and of the joint's pin in its hole.
It is a stiff spring with a damper that fades in over a small depth, so that its force neither jumps
on contact nor ever pulls.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca

from rr_lab.planar.layout import PlanarLayout, axis, left_of
from rr_lab.rig import (
    CABLE_ONSET,
    WHEELS,
    Drift,
    Falling,
    Motor,
    Patch,
    Rig,
    RollingResistance,
    Rub,
    box_of,
    swing_inertia,
    wheel_loads,
)
from rr_opt.outcome import InputError


@dataclass(frozen=True)
class Moment:
    """The current iterate of the end of a step.

    layout   with its coordinates q; w (n), their rates; spins (4), rad/s, and angles turned (4),
             rad, of the wheels
    ahead    s, change of q per change of w
    asked    rad, the commanded angle of the motor; rate, rad/s, its own
    t        s since the robot was released; free, 1 from then on and 0 before
    """

    layout: PlanarLayout
    w: ca.SX
    spins: ca.SX
    turns: ca.SX
    ahead: float
    asked: ca.SX
    rate: ca.SX
    t: ca.SX
    free: ca.SX

    def way(self, length: ca.SX) -> ca.SX:
        """The derivative of a length or an angle by each coordinate (1, n)."""
        return ca.jacobian(length, self.layout.q)


@dataclass(frozen=True)
class Pull:
    """A force or torque along a way (1, n): push - hold * (its speed at the end of the step).

    hold is never negative, which keeps the step stable.
    """

    way: ca.SX
    hold: ca.SX | float
    push: ca.SX | float


def spring(
    moment: Moment,
    length: ca.SX,
    stiffness: ca.SX | float,
    damping: ca.SX | float,
    rest: ca.SX | float = 0.0,
) -> Pull:
    """The pull of a spring with a damper; length and rest in m or rad. Exact if the length is
    linear in the coordinates."""
    way = moment.way(length)
    before = length - moment.ahead * (way @ moment.w)
    return Pull(way, damping + stiffness * moment.ahead, -stiffness * (before - rest))


QUICK = 1000.0
"""1/s, how fast the motor settles. At a commanded acceleration of 30 rad/s2 it lags by
30/QUICK^2 = 0.03 mrad, or up to three times that where its wheels resist."""

HINGE_ONSET = 1e-3
"""rad/s, the onset of dry friction in the joint; a sticking joint creeps by some tenths of it, far
less than an angle's noise in half a period."""

SLACKENS = 2e-3
"""s, in which a bent platform straightens: its axle has no mass of its own, so a damper alone sets
the rate."""

RINGS = 0.1
"""Damping of a shifting load, c/sqrt(k m): it oscillates some ten times."""

STOPS_QUICK = 1000.0
"""1/s, how fast an impact on a stop settles: within some milliseconds."""

GEAR_SETTLES = 5e-3
"""s, in which a released compliant gear straightens."""

FIRST_ANGLE, FIRST_LENGTH = 1e-5, 1e-6
"""rad and m, the depth over which a stop's damper fades in; a hundredth of the noise."""


def pulls(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """All pulls of the rig."""
    yield _turning(moment, rig)
    for part in (_hinge, _play, _pin, _bends, _shift, _medium, _cable):
        yield from part(moment, rig)


def motor(rig: Rig) -> Motor:
    """The rig's own, or a stiff one."""
    return rig.motor or _stiff(rig)


def _stiff(rig: Rig) -> Motor:
    """A critically damped motor that follows its command within a tenth of a milliradian."""
    inertia = swing_inertia(rig.robot)
    return Motor(inertia * QUICK**2, 2 * inertia * QUICK)


def turned_by(built: PlanarLayout) -> str:
    """The coordinate that the motor turns: with backlash a shaft without inertia of its own."""
    return "shaft" if "shaft" in built.names else "phi"


def _turning(moment: Moment, rig: Rig) -> Pull:
    """The motor's torque."""
    made, drive = moment.layout.of(turned_by(moment.layout)), motor(rig)
    pull = spring(moment, made, drive.stiffness, drive.damping, moment.asked)
    return replace(pull, push=pull.push + drive.feedforward * drive.damping * moment.rate)


def _hinge(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """Dry friction between the platforms."""
    if rig.hinge_dry:
        way = moment.way(moment.layout.of("phi"))
        rate = way @ moment.w
        yield Pull(way, rig.hinge_dry / (rate**4 + HINGE_ONSET**4) ** 0.25, 0.0)


def _play(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """The platform moves freely on the shaft, by half the backlash on either side."""
    if rig.play:
        ahead = moment.layout.of("phi") - moment.layout.of("shaft")
        # Otherwise as stiff as the motor that it presses against.
        flank = Motor(rig.gear, GEAR_SETTLES * rig.gear) if rig.gear is not None else _stiff(rig)
        yield _stop(moment, ahead, rig.play / 2, flank.stiffness, flank.damping, FIRST_ANGLE)


def _pin(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """A round pin in a round hole: free inside, pushed back to the middle at the rim."""
    if rig.pin:
        across = [moment.layout.of(name) for name in ("pin_ahead", "pin_left")]
        # The root has no slope in the middle, where there is no force anyway.
        off = ca.sqrt(across[0] ** 2 + across[1] ** 2 + FIRST_LENGTH**2)
        one, two = rig.robot.platform1.m, rig.robot.platform2.m
        mass = one * two / (one + two)
        stiffness, damping = mass * STOPS_QUICK**2, 2 * mass * STOPS_QUICK
        yield _stop(moment, off, rig.pin, stiffness, damping, FIRST_LENGTH)


def _stop(
    moment: Moment, off: ca.SX, reach: float, stiffness: float, damping: float, first: float
) -> Pull:
    """Stops at `reach` on both sides of 0."""
    side = ca.sign(off)
    deep = ca.fmax(ca.fabs(off) - reach, 0)
    deepens = side * (moment.way(off) @ moment.w)
    damper = damping * deep / (deep + first)
    touches = ca.logic_and(deep > 0, stiffness * deep + damper * deepens > 0)
    return spring(moment, off, touches * stiffness, touches * damper, side * reach)


def _bends(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """Both platforms, sideways."""
    if rig.spring is not None:
        for name in ("bend1", "bend2"):
            yield spring(moment, moment.layout.of(name), rig.spring, SLACKENS * rig.spring)


def _shift(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """A load on its spring."""
    if rig.load is not None:
        mass, stiffness = rig.load
        damping = RINGS * (mass * stiffness) ** 0.5
        yield spring(moment, moment.layout.of("shift"), stiffness, damping)


def _medium(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """The drag of a medium on the platforms: on each face of a box with a drag coefficient of 1,
    and on its rotation."""
    for body in moment.layout.bodies[:2] if rig.density else ():
        reach, height = box_of(body.m, body.I)
        ahead, moves = axis(body.heading), moment.way(body.place)
        for way in (ahead.T @ moves, left_of(ahead).T @ moves):
            hold = 2 * rig.density * reach * height * ca.fabs(way @ moment.w)
            yield Pull(way, hold, 0.0)
        turns = moment.way(body.heading)
        yield Pull(turns, rig.density * height * reach**4 * ca.fabs(turns @ moment.w), 0.0)


def _cable(moment: Moment, rig: Rig) -> Iterator[Pull]:
    """A cable that axle 2 drags on the floor."""
    if rig.cable:
        left, right = moment.layout.wheels[2:]
        ways = moment.way((left.place + right.place) / 2)
        speed = ca.norm_2(ca.vertcat(ways @ moment.w, CABLE_ONSET))
        for n in range(2):
            yield Pull(ways[n, :], rig.cable / speed, 0.0)


def pushed(moment: Moment, rig: Rig, nudge: ca.SX) -> ca.SX:
    """The generalised forces (n). nudge: m/s2, acceleration of the whole mass by a push on platform
    1 along its axis. Slope and cord act once the robot is released."""
    total = ca.SX(moment.layout.q.numel(), 1)
    down = ca.vertcat(*map(float, rig.gravity[:2]))
    for body in moment.layout.bodies:
        total += moment.free * (moment.way(body.place).T @ (body.m * down))
    first = moment.layout.bodies[0]
    mass = sum(body.m for body in moment.layout.bodies[:2])
    total += moment.way(first.place).T @ (nudge * mass * axis(first.heading))
    if rig.tether is not None:
        post = ca.vertcat(rig.tether.x, rig.tether.y)
        # The cord is attached above the mass's place on the axis.
        tied = moment.layout.ends[0][:2] + rig.robot.platform1.joint_to_centre * axis(first.heading)
        length = ca.norm_2(tied - post)
        taut = rig.tether.stiffness * ca.fmax(length - rig.tether.slack, 0)
        total -= moment.free * taut * moment.way(length).T
    return total


DRY_ONSET = 2e-3
"""m/s at the rim, default onset of dry friction, as u/(u^4 + onset^4)^(1/4): at three times that
speed it is within a third of a per cent of its full force."""

EDGE = 1e-3
"""m, half the width of a patch's edge: about the contact length of a tyre."""

_SOFT = 0.02
"""Range of the cosine of a wheel's angle over which a fault begins and ends: some degrees."""


def bearings(moment: Moment, rig: Rig) -> list[ca.SX]:
    """D of each wheel, N m s: it resists with D times its spin."""
    viscous: list[Any] = [ca.SX(kappa) for kappa in rig.kappa]
    dry: list[Any] = [ca.SX(torque) for torque in rig.dry]
    carried = wheel_loads(rig)
    for law in rig.laws:
        for n in range(len(WHEELS)):
            viscous[n], dry[n] = _changed(law, moment, n, carried[n], viscous[n], dry[n])
    onset = (rig.onset or DRY_ONSET) / rig.robot.h
    found = []
    for n, quadratic in enumerate(rig.quadratic):
        spin = moment.spins[n]
        rubs = dry[n] / (spin**4 + onset**4) ** 0.25
        found.append(viscous[n] + quadratic * ca.fabs(spin) + rubs)
    return found


def _changed(
    law: Any, moment: Moment, n: int, load: float, viscous: ca.SX, dry: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """Viscous (N m s) and dry (N m) friction of a wheel after one more law."""
    match law:
        case Patch():
            place = moment.layout.wheels[n].place
            inside = (1 + ca.tanh(law.within.depth(place[0], place[1]) / EDGE)) / 2
            factor = 1 + (law.times - 1) * inside
            return viscous * factor, dry * factor
        case Falling():
            fall = ca.exp(-((moment.spins[n] / law.rate) ** 2))
            return viscous, dry + law.torque * (1 + 2 * fall) / 3
        case Drift():
            came = 1 - ca.exp(-ca.fmax(moment.t, 0) / law.time)
            return viscous * (1 + law.change * came), dry
        case RollingResistance():
            return viscous, dry + law.mu * law.h * load
        case Rub():
            return viscous, dry + (law.torque * _first_fifth(moment.turns[0]) if n == 0 else 0.0)
    raise InputError(
        f"The planar engine has no {type(law).__name__}. Expected a law of the catalogue. Use the "
        "engine mujoco."
    )


def _first_fifth(turned: ca.SX) -> ca.SX:
    """1 over the first fifth of each turn, 0 over the rest."""
    middle = 0.2 * math.pi
    return (1 + ca.tanh((ca.cos(turned - middle) - math.cos(middle)) / _SOFT)) / 2
