"""The gait problem as a nonlinear program: multiple shooting over one period.

Phase theta in [0, 1) counts the period. At every node theta_k the speed v_k of axle 1 and the
heading chi_k are unknowns, and a Runge-Kutta step must carry each node to the next and the last
to the first. chi = psi - theta * turn is the heading seen from a frame that turns steadily with
the gait, `turn` being the heading gained per period; so chi is periodic, straight gaits are no
special case, and the average velocity

    V = integral over theta of Rot(chi) (v, side)

is the mean of P's velocity in that frame. Its length is the speed along the mean circle,
R |turn|/T: with p the position of P from the centre, seen from the turning frame, V is the mean
of dp/dt + Omega x p, and the first term vanishes as p is periodic. It depends neither on the
phase at which the period is cut nor, unlike R, on a division by turn.

Derivatives. V and the mean heading vector E are unknowns of their own, tied to the sums over
the intervals by linear rows. The Lagrangian is then a sum of terms that each know one interval
and the few decisions, so Jacobian and Hessian are assembled from one small function mapped over
the intervals. (Left to itself, CasADi colours the whole graph and takes a hundred times longer.)

Robot, limits and node phases are parameters: one compiled program serves every problem of its
kind.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca

from rr_opt.design.interval import DECISIONS, LIMITS, interval_of
from rr_opt.motion.tableau import BUTCHER6, Tableau
from rr_opt.robot.ballast import By

_IPOPT = {
    "print_time": False,
    "error_on_fail": False,
    # Prices of the program's parameters are not asked for, and cost more than a solve.
    "calc_lam_p": False,
    "no_nlp_grad": True,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-9,
    "ipopt.max_iter": 200,
    "ipopt.max_cpu_time": 10.0,
    # Starts are steady cycles, near an optimum and often on a limit: IPOPT shall not push them
    # far inside, nor begin with a barrier that does.
    "ipopt.mu_init": 1e-5,
    "ipopt.bound_push": 1e-6,
    "ipopt.bound_frac": 1e-6,
    "ipopt.slack_bound_push": 1e-6,
    "ipopt.slack_bound_frac": 1e-6,
    "ipopt.bound_relax_factor": 0.0,
}


@dataclass(frozen=True)
class Shooting:
    """The program with `intervals` steps a period.

    solver  nlpsol: x = (DECISIONS, V, E, v_0 .. , chi_0 ..), g = (continuity of v, of chi, of
            V and E, LIMITS, torque at the nodes), p = (robot, loads, ballast range, direction,
            node phases)
    """

    intervals: int
    solver: ca.Function


@lru_cache
def shooting(
    effects: tuple[str, ...], by: By, intervals: int, method: Tableau = BUTCHER6
) -> Shooting:
    """Build the program for robots with these effects and this way of changing the inertia."""
    n, nz, nm = intervals, len(DECISIONS), 4
    interval = interval_of(effects, by, method)
    x = ca.MX.sym("x", nz + nm + 2 * n)
    p = ca.MX.sym("p", interval.shared + 1 + n)
    z, mean, vs, chis = ca.vertsplit(x, [0, nz, nz + nm, nz + nm + n, nz + nm + 2 * n])
    fixed, sign, thetas = ca.vertsplit(p, [0, interval.shared, interval.shared + 1, p.numel()])
    widths = ca.vertcat(thetas[1:], thetas[0] + 1) - thetas
    per_node = (vs.T, chis.T, thetas.T, widths.T)

    limits = interval.limits(z, mean, fixed, sign)
    ends = interval.step.map(n)(*per_node, z, fixed)
    following = ca.vertcat(vs[1:], vs[0]), ca.vertcat(chis[1:], chis[0])
    f = -ca.sqrt(ca.sumsqr(mean[:2]))
    g = ca.vertcat(
        ends[0, :].T - following[0],
        ends[1, :].T - following[1],
        ca.sum2(ends[2:6, :]) - mean,
        limits,
        ends[6, :].T,
    )

    # Rows of `slopes` are the outputs of a step (v, chi, 4 sums, torque), column by column of
    # (v, chi, decisions) for each interval in turn.
    wrt = 2 + nz
    slopes = interval.jacobian.map(n)(*per_node, z, fixed)

    def block(row, column):
        return slopes[row, column::wrt]

    shift = ca.DM.eye(n)[[*range(1, n), 0], :]
    empty = ca.MX(n, nm)
    to_z = [ca.horzcat(*(block(row, 2 + j).T for j in range(nz))) for row in (0, 1, 6)]
    sums_to_z = ca.horzcat(*(ca.sum2(slopes[2:6, 2 + j :: wrt]) for j in range(nz)))
    limits_to_z, limits_to_mean = interval.limit_slopes(z, mean, fixed, sign)
    jac_g = ca.vertcat(
        ca.horzcat(to_z[0], empty, ca.diag(block(0, 0)) - shift, ca.MX(n, n)),
        ca.horzcat(to_z[1], empty, ca.diag(block(1, 0)), ca.diag(block(1, 1)) - shift),
        ca.horzcat(sums_to_z, -ca.DM.eye(nm), slopes[2:6, 0::wrt], slopes[2:6, 1::wrt]),
        ca.horzcat(limits_to_z, limits_to_mean, ca.MX(len(LIMITS), 2 * n)),
        ca.horzcat(to_z[2], empty, ca.diag(block(6, 0)), ca.MX(n, n)),
    )

    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
    on_v, on_chi, on_sums, on_limits, on_torque = ca.vertsplit(
        lam_g, [0, n, 2 * n, 2 * n + nm, 2 * n + nm + len(LIMITS), g.numel()]
    )
    weights = ca.vertcat(on_v.T, on_chi.T, ca.repmat(on_sums, 1, n), on_torque.T)
    curves = interval.hessian.map(n)(*per_node, z, fixed, weights)
    z_z = sum(curves[2:, 2 + j :: wrt] @ ca.DM.ones(n) @ ca.DM.eye(nz)[j, :] for j in range(nz))
    limit_z, limit_cross, limit_mean = interval.limit_curves(z, mean, fixed, sign, on_limits)
    mean_mean = limit_mean + lam_f * ca.hessian(f, x)[0][nz : nz + nm, nz : nz + nm]
    upper = ca.vertcat(
        ca.horzcat(z_z + limit_z, limit_cross, curves[2:, 0::wrt], curves[2:, 1::wrt]),
        ca.horzcat(ca.MX(nm, nz), mean_mean, ca.MX(nm, 2 * n)),
        ca.horzcat(ca.MX(n, nz + nm), ca.diag(curves[0, 0::wrt]), ca.diag(curves[0, 1::wrt])),
        ca.horzcat(ca.MX(n, nz + nm + n), ca.diag(curves[1, 1::wrt])),
    )
    given = {
        "grad_f": ca.Function(
            "grad_f", [x, p], [f, ca.gradient(f, x)], ["x", "p"], ["f", "grad_f_x"]
        ),
        "jac_g": ca.Function("jac_g", [x, p], [g, jac_g], ["x", "p"], ["g", "jac_g_x"]),
        "hess_lag": ca.Function(
            "hess_lag",
            [x, p, lam_f, lam_g],
            [ca.triu(upper)],
            ["x", "p", "lam_f", "lam_g"],
            ["triu_hess_gamma_x_x"],
        ),
    }
    solver = ca.nlpsol("gait", "ipopt", {"x": x, "p": p, "f": f, "g": g}, {**_IPOPT, **given})
    return Shooting(n, solver)
