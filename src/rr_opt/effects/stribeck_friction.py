"""Dry friction at the wheels that falls as they speed up, as lubricated bearings have it.

From F at rest it falls to the share `sliding` of it as (1 - sliding) exp(-(u/us)^2), with us the
`speed` (Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30, 1994, section 3). The jump at
u = 0 is that of `coulomb_friction`, which is this with `sliding` = 1.
"""

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.coulomb_friction import FORCES, dry
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    most, us = values["sliding"], values["speed"]
    return dry(mechanism, values, lambda u: most + (1 - most) * ca.exp(-((u / us) ** 2)))


EFFECT = Effect(
    name="stribeck_friction",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        *FORCES,
        Parameter("sliding", "dimensionless", (0.0, 1.0), 0.5, neutral=1.0, initial_guesses=(1.0,)),
        Parameter(
            *("speed", "m/s", (1e-3, 1.0), 0.05),
            neutral=0.05,
            typical_for=lambda operated: operated.speed,
            initial_guesses=(0.2, 0.6),
        ),
    ),
    sentence="Each wheel resists rolling with a force that falls as it speeds up.",
    enter=_enter,
    near_discontinuous=True,
    candidate=False,
)
