"""What brakes the wheels or keeps them turning, and how they meet the floor."""

from __future__ import annotations

from rr_lab.effects.hidden_effect import Values
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


FUNCTIONS = (
    _coulomb,
    _equal,
    _equal_forces,
    _by_load,
    _forces_of_loads,
    _quadratic,
    _left_right,
    _wheel_inertia,
    _slip,
)
