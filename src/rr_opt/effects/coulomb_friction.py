"""Dry (Coulomb) friction at the wheels: a force that resists rolling, whatever the speed.

The jump of the sign at u = 0 is smoothed to tanh(u/u0). At u0 = 2 mm/s the wheels of a robot
that moves at decimetres per second spend a per cent of their time inside the smoothed part,
and the equations stay differentiable, which the optimiser needs. Against recordings it matters: of
two plants, one whose friction sets in over 2 mm/s and one over a tenth of that, each, predicted
with the other's, has an axle's force half as large or twice as large as it is. So predictions have
u0 as a parameter, `onset`, and add to it what the friction changes the robot's speed by in 5 ms.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port, Setting
from rr_opt.mechanics.kinematics import Mechanism, with_resistance

SMOOTHING_SPEED = 0.002
"""u0, m/s, for an optimiser, and where `onset` is not given."""
_STEP = 5e-3
"""A prediction's u0 is larger by what friction changes a speed by in so many seconds."""


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    u0 = _sharp(mechanism, values) if mechanism.sharp else SMOOTHING_SPEED
    return with_resistance(
        mechanism, lambda wheel, u: -values[f"force{wheel.platform}"] * ca.tanh(u / u0)
    )


def _sharp(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> ca.SX:
    p = mechanism.parameters
    forces = 2 * (values["force1"] + values["force2"])
    return values["onset"] + _STEP * forces / (p["m1"] + p["m2"])


def _viscous(setting: Setting) -> float:
    """The viscous force on a wheel at the robot's speed."""
    return (setting.robot.k1 + setting.robot.k2) / 2 * setting.speed


EFFECT = Effect(
    name="coulomb_friction",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("force1", "N", (0.0, 10.0), 0.02, aliases=("F1",), natural=_viscous),
        Parameter("force2", "N", (0.0, 10.0), 0.02, aliases=("F2",), natural=_viscous),
        Parameter(*("onset", "m/s", (2e-4, 0.01), 1e-3), neutral=SMOOTHING_SPEED, trials=(1.0,)),
    ),
    sentence="Each wheel resists rolling with a force that does not depend on its speed.",
    enter=_enter,
    sharp=True,
)
