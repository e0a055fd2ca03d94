"""What brakes the wheels or keeps them turning, and how they meet the floor."""

from __future__ import annotations

import math

from rr_lab.effects.hidden_effect import HiddenEffect, Parameter, Values, adds
from rr_lab.laws import RollingResistance
from rr_lab.rig import Rig, wheel_loads
from rr_opt.model.robot import Robot


def _coulomb(rig: Rig, values: Values) -> None:
    """A force F at the rim is a torque F h."""
    one, two = (values.get(name, 0.0) * rig.robot.h for name in ("force1", "force2"))
    rig.dry = [dry + more for dry, more in zip(rig.dry, (one, one, two, two), strict=True)]
    rig.onset = values.get("onset", rig.onset)


def _equal(rig: Rig, values: Values) -> None:
    _coulomb(rig, {"force1": values["force"], "force2": values["force"]})


def _equal_forces(_: Robot, values: Values) -> dict[str, float]:
    return {"force1": values["force"], "force2": values["force"]}


def _by_load(rig: Rig, values: Values) -> None:
    rig.laws.append(RollingResistance(values["mu"], rig.robot.h))


def _forces_of_loads(robot: Robot, values: Values) -> dict[str, float]:
    """With the loads of a robot that stands."""
    one, _, two, _ = values["mu"] * wheel_loads(Rig(robot))
    return {"force1": float(one), "force2": float(two)}


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


def _slip(rig: Rig, values: Values) -> None:
    """`mu`: the grip that lets go; `creep_compliance`: side speed per side force."""
    rig.mu = values.get("mu", rig.mu)
    rig.creep += values.get("creep_compliance", 0.0)


def _signed(name: str, unit: str, typical: float, most: float) -> Parameter:
    return Parameter(name, unit, typical, most=most, signed=True)


_DRY = tuple(Parameter(f"force{n}", "N", 2e-3, most=0.1) for n in (1, 2))
_ONSET = Parameter("onset", "m/s", 2e-3, neutral=None, plant=True)
_EQUAL = Parameter("force", "N", 2e-3, most=0.1, plant=True)
_RESISTANCE = Parameter("mu", "1", 1e-3, most=0.05, plant=True)
_DRAG = Parameter("coefficient_total", "N s2/m2", 0.1, most=20.0)
_DENSITY = Parameter("density", "kg/m^3", 15.0, most=400.0, plant=True)
_LEAN = tuple(_signed(f"asymmetry{n}", "1", 0.3, 0.9) for n in (1, 2))
_CREEP = Parameter("creep_compliance", "m/(N s)", 0.03, most=2.0)
_MU = Parameter("mu", "1", 0.05, neutral=math.inf, most=2e-3)
_TOE = tuple(_signed(f"toe{n}", "rad", 0.01, 0.1) for n in (1, 2))

ROLLING = (
    HiddenEffect("coulomb_friction", "dry friction of the wheels, different on each axle",
                 _DRY, _coulomb, "per_axle", also=(_ONSET,)),
    HiddenEffect("coulomb_friction", "dry friction, the same on all four wheels",
                 (_EQUAL,), _equal, "equal", derived=_equal_forces),
    HiddenEffect("coulomb_friction",
                 "dry friction of the wheels in proportion to the load on each",
                 (_RESISTANCE,), _by_load, "load_proportional", derived=_forces_of_loads),
    HiddenEffect("quadratic_drag", "drag of the wheels that grows with the square of the speed",
                 (_DRAG,), _quadratic, "wheels"),
    HiddenEffect("quadratic_drag",
                 "drag of a medium on the platforms' bodies, along and across, at their centres of "
                 "mass",
                 (_DENSITY,), adds("density", "density"), "medium_density"),
    HiddenEffect("left_right_drag", "one side's wheels turn harder than the other's",
                 _LEAN, _left_right),
    HiddenEffect("wheel_inertia", "the wheels' own spin inertia",
                 (Parameter("J", "kg m2", 1e-5, most=2e-4),), _wheel_inertia),
)  # fmt: skip

CONTACT = (
    HiddenEffect("lateral_slip", "the wheels creep sideways in proportion to their side force",
                 (_CREEP,), _slip, "creep", also=(_MU,)),
    HiddenEffect("lateral_slip", "the wheels slide sideways", (_MU,), _slip, "sliding"),
    HiddenEffect("lateral_slip", "the wheels slide sideways at the peaks of a cycle alone",
                 (_MU,), _slip, "grazing", sizes=(1.0, 4.0)),
    HiddenEffect("lateral_slip", "the wheels slide sideways through most of a cycle",
                 (_MU,), _slip, "sliding_strongly", sizes=(30.0, 120.0)),
    HiddenEffect("lateral_slip",
                 "the wheels creep sideways, up to a limit above which they slide",
                 (_CREEP, _MU), _slip, "saturating_creep"),
    HiddenEffect("axle_misalignment", "an axle is not square to its platform",
                 _TOE, adds("toe", "toe1", "toe2")),
)  # fmt: skip
