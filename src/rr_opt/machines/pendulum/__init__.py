"""A pendulum driven by a measured torque.

J q'' = u - b q' - ml g sin q
"""

from collections.abc import Mapping

import casadi as ca

from rr_opt.machines import laws
from rr_opt.model.machine import Add, Channel, Machine, MachineParameter, Names
from rr_opt.model.parameters import Spread


def _rates(v: Names, add: Add) -> Mapping[str, ca.SX]:
    def gravity(q: ca.SX) -> ca.SX:
        return v.ml * laws.G * ca.sin(q)

    known = v.u - v.b * v.w - gravity(v.q)
    torque = known + add("torque", drive=v.u, load=gravity(v.q), gravity=gravity)
    return {"q": v.w, "w": torque / v.J}


PENDULUM = Machine(
    name="pendulum",
    words="a pendulum driven by a torque",
    equation="J q'' = u - b q' - ml g sin q",
    **laws.JOINT,
    parameters=(
        MachineParameter("J", "kg m^2", "moment of inertia about the axis", "0.06",
                         Spread(factor=5.0), 1e-12),
        MachineParameter("ml", "kg m", "mass times distance of its centre from the axis", "0.1",
                         Spread(factor=5.0), 1e-12),
        MachineParameter("b", "N m s", "viscous friction", "0.05", Spread(factor=5.0)),
    ),
    inputs=(Channel("u", "N m", "the torque"),),
    effects=(
        laws.COULOMB,
        laws.STRIBECK_FRICTION,
        laws.QUADRATIC_DRAG,
        laws.LOAD_FRICTION,
        laws.DIRECTION_FRICTION,
        laws.TORQUE_OFFSET,
        laws.ANGLE_OFFSET,
        laws.late("clock_offset", "the torque", "u"),
    ),
    rates=_rates,
    scales=lambda s: {"torque": s["u"], "speed": max(s["q_rate"], 1e-3)},
    variables={"w": ("speed", "rad/s"), "q": ("angle", "rad"), "u": ("torque", "N m")},
)  # fmt: skip
