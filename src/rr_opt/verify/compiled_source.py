"""The C behind `compiled_cycles`: a model's functions, with the loops of data/ around them."""

from __future__ import annotations

from importlib.resources import files

import casadi as ca

from rr_opt.physics.c_stages import Stages, in_stages
from rr_opt.physics.dynamics import Dynamics


def viscous_source(powers: ca.Function) -> str:
    """Around (phi, p) -> the powers of `speed_powers`."""
    return _source(in_stages(powers, "rr", (1, 0)), powers.nnz_in(1), "viscous")


def newton_source(dynamics: Dynamics) -> str:
    """Around a model's motion and its slope over v.

    Raises NotImplementedError for a model with an operation that has no C.
    """
    outputs = ["vdot", "jac:vdot:v", "w", "side", "torque"]
    motion = dynamics.motion.factory("tried", dynamics.motion.name_in(), outputs)
    return _source(in_stages(motion, "rr", (2, 1, 1, 1, 0)), len(dynamics.parameters), "newton")


def _source(stages: Stages, parameters: int, loops: str) -> str:
    sizes = [f"#define NK{k} {kept}\n" for k, kept in enumerate(stages.kept)]
    lanes, points, around = (
        files("rr_opt").joinpath("data", f"{name}.c").read_text(encoding="utf-8")
        for name in ("lanes", "gait_points", f"sweep_{loops}")
    )
    return "".join([f"#define NP {parameters}\n", *sizes, lanes, points, stages.source, around])
