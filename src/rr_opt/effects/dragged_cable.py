"""A cable, or anything else, that a platform drags along the floor.

Dry friction of a given size acts against the velocity of the point that drags, at a distance from
the axle on the platform's axis. Away from the axle that point also moves sideways as the platform
turns, so the friction brakes its turning, which that of the wheels hardly does. Before or behind
the axle makes no difference as long as the wheels hold: the axle takes up the side force, and the
moment goes with the square of the distance.

The jump of the direction at V = 0 is smoothed as V/sqrt(|V|^2 + u0^2), with u0 as for the wheels'
dry friction.
"""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED, steady_in_a_step, viscous
from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Force, Mechanism


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    u0 = ca.SX(SMOOTHING_SPEED)
    if mechanism.for_prediction:
        u0 += steady_in_a_step(mechanism, values["force1"] + values["force2"])
    forces = []
    for platform, frame in mechanism.frames.items():
        point = ca.vertcat(values[f"distance{platform}"], 0)
        v = frame.velocity(point)
        drag = -values[f"force{platform}"] * v / ca.sqrt(ca.sumsqr(v) + u0**2)
        forces.append(Force(platform, point, drag))
    return replace(mechanism, forces=(*mechanism.forces, *forces))


def _of_all_wheels(operated: OperatingRange) -> float:
    return 4 * viscous(operated)


EFFECT = Effect(
    name="dragged_cable",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("force1", "N", (0.0, 10.0), 0.02, typical_for=_of_all_wheels),
        Parameter("force2", "N", (0.0, 10.0), 0.02, typical_for=_of_all_wheels),
        Parameter("distance1", "m", (0.0, 1.0), 0.1, initial_guesses=(0.05, 1.0)),
        Parameter("distance2", "m", (0.0, 1.0), 0.1, initial_guesses=(0.05, 1.0)),
    ),
    sentence="A platform drags a cable along the floor.",
    enter=_enter,
    near_discontinuous=True,
    candidate=False,
    forms=(("force1", "distance1"), ("force2", "distance2")),
)
