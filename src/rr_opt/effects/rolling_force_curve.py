"""Rolling resistance as an empirical curve of speed, where no physical law is known.

Each wheel resists with force0 at rest, and with force1 to force4 at 1/8, 1/4, 1/2 and all of
`speed`; straight in between, constant beyond. The corners are rounded over a 64th of `speed`, and
the jump at u = 0 is smoothed like that of dry friction.
"""

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, with_wheel_forces

KNOTS = (0.0, 0.125, 0.25, 0.5, 1.0)
"""Where the forces are given, as fractions of `speed`."""

_ROUNDING = 1 / 64


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    forces = [values[f"force{k}"] for k in range(len(KNOTS))]

    def law(_: object, u: ca.SX) -> ca.SX:
        part = ca.sqrt((u / values["speed"]) ** 2 + _ROUNDING**4)
        curve = forces[0]
        for k in range(len(KNOTS) - 1):
            slope = (forces[k + 1] - forces[k]) / (KNOTS[k + 1] - KNOTS[k])
            curve += slope * (_beyond(part - KNOTS[k]) - _beyond(part - KNOTS[k + 1]))
        return -curve * ca.tanh(u / SMOOTHING_SPEED)

    return with_wheel_forces(mechanism, law)


def _beyond(x: ca.SX) -> ca.SX:
    """x where it is positive, else 0, with a round corner."""
    return (x + ca.sqrt(x**2 + _ROUNDING**2)) / 2


EFFECT = Effect(
    name="rolling_force_curve",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("speed", "m/s", (1e-3, 100.0), 0.2, neutral=0.2),
        *(Parameter(f"force{k}", "N", (-10.0, 10.0), 0.02) for k in range(len(KNOTS))),
    ),
    sentence="Each wheel resists rolling with a force tabulated at five speeds.",
    enter=_enter,
    candidate=False,
)
