"""What brakes the wheels, or keeps them turning: all of it turns with them."""

from __future__ import annotations

from rr_lab.effects.hidden import HiddenEffect, Parameter, Values
from rr_lab.rig import Rig


def _coulomb(rig: Rig, values: Values) -> None:
    """A force F at the rim is a torque F h."""
    one, two = (values.get(name, 0.0) * rig.robot.h for name in ("force1", "force2"))
    rig.dry = [dry + more for dry, more in zip(rig.dry, (one, one, two, two), strict=True)]
    rig.onset = values.get("onset", rig.onset)


def _quadratic(rig: Rig, values: Values) -> None:
    """(c/4) v^2 at the rim is (c/4) h^3 omega^2."""
    each = values["coefficient_total"] / 4 * rig.robot.h**3
    rig.quadratic = [coefficient + each for coefficient in rig.quadratic]


def _left_right(rig: Rig, values: Values) -> None:
    for platform, name in enumerate(("asymmetry1", "asymmetry2")):
        lean = values.get(name, 0.0)
        rig.kappa[2 * platform] *= 1 + lean
        rig.kappa[2 * platform + 1] *= 1 - lean


def _wheel_inertia(rig: Rig, values: Values) -> None:
    rig.J = [J + values["J"] for J in rig.J]


ROLLING = (
    HiddenEffect(
        "coulomb_friction",
        "dry friction of the wheels",
        (Parameter("force1", "N", 2e-3, most=0.1), Parameter("force2", "N", 2e-3, most=0.1)),
        _coulomb,
        further=frozenset({"onset"}),
    ),
    HiddenEffect(
        "quadratic_drag",
        "drag that grows with the square of the speed",
        (Parameter("coefficient_total", "N s2/m2", 0.1, most=20.0),),
        _quadratic,
    ),
    HiddenEffect(
        "left_right_drag",
        "one side's wheels turn harder than the other's",
        (
            Parameter("asymmetry1", "1", 0.3, most=0.9, signed=True),
            Parameter("asymmetry2", "1", 0.3, most=0.9, signed=True),
        ),
        _left_right,
    ),
    HiddenEffect(
        "wheel_inertia",
        "the wheels' own spin inertia",
        (Parameter("J", "kg m2", 1e-5, most=2e-4),),
        _wheel_inertia,
    ),
)
