"""The rows of multiple shooting that hold once a period: values and derivatives."""

from __future__ import annotations

import casadi as ca

from rr_opt.design.layout import COMMON, MEANS, ROWS
from rr_opt.design.shapes import Shape


class PeriodTerms:
    """The limits of a shape and the rows of ROWS.

    values  (z, mean, fixed, checks, sign) -> rows
    slopes  -> their Jacobians in z and mean
    curves  (.., multipliers) -> blocks z-z, z-mean and mean-mean of the Hessian
    """

    def __init__(self, shape: Shape, z: ca.SX, fixed: ca.SX, c1: ca.SX, c2: ca.SX):
        mean_names = MEANS + shape.integrals
        mean, sign = ca.SX.sym("mean", len(mean_names)), ca.SX.sym("sign")
        checks = ca.SX.sym("checks", shape.checks)
        decided = named(COMMON + shape.decisions, z)
        own = shape.limit_rows(
            decided, named(mean_names, mean), tuple(ca.vertsplit(checks)), c1, c2
        )
        V, E = mean[:2], mean[2:4]
        rate = decided["turn"] / decided["period"]
        rows = ca.vertcat(*own, sign * ca.dot(V, E), rate / ca.norm_2(V), rate, decided["turn"])
        lam = ca.SX.sym("lam", len(shape.limits) + len(ROWS))
        weighted = ca.dot(lam, rows)
        inputs = [z, mean, fixed, checks, sign]
        self.values = ca.Function("limits", inputs, [rows])
        self.slopes = ca.Function(
            "limit_slopes", inputs, [ca.jacobian(rows, z), ca.jacobian(rows, mean)]
        )
        self.curves = ca.Function(
            "limit_curves",
            [*inputs, lam],
            [
                ca.hessian(weighted, z)[0],
                ca.jacobian(ca.gradient(weighted, z), mean),
                ca.hessian(weighted, mean)[0],
            ],
        )


def named(names: tuple[str, ...], stacked: ca.SX) -> dict[str, ca.SX]:
    """The entries of a vector by name."""
    return dict(zip(names, ca.vertsplit(stacked), strict=True))
