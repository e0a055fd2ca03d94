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

Shapes whose angle is more than one formula add states and controls at every node, which an
interval carries on in the same way.

Robot, limits and node phases are parameters: one compiled program serves every problem of its
kind.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi as ca

from rr_opt.design.interval import Functions, IntervalTerms, interval_of
from rr_opt.design.shapes import Shape
from rr_opt.design.transcription import ProgramLayout
from rr_opt.mechanics.runge_kutta import BUTCHER6, Tableau
from rr_opt.model.ballast import By

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
    """The program for one shape and number of intervals.

    A solver is an nlpsol over the unknowns and rows of `layout`, p = (robot, loads, ballast range,
    checked phases, direction, node phases, looks and turn interval by interval).
    """

    layout: ProgramLayout
    terms: IntervalTerms

    @cached_property
    def solver(self) -> ca.Function:
        """The solver by CasADi's virtual machine."""
        return _Program(self.layout, self.terms, self.terms.code.functions).solver()

    @property
    def fastest(self) -> ca.Function:
        """The same of machine code, where there is some."""
        return self.solver if self.terms.code.compiled is None else self._compiled

    @cached_property
    def _compiled(self) -> ca.Function:
        compiled = self.terms.code.compiled or self.terms.code.functions
        return _Program(self.layout, self.terms, compiled).solver()


@lru_cache
def shooting(
    effects: tuple[str, ...],
    by: By,
    shape: Shape,
    intervals: int,
    looks: int = 0,
    substeps: int = 1,
    method: Tableau = BUTCHER6,
    loads: tuple[str, ...] = ("torque",),
) -> Shooting:
    """The program for robots with these effects and this way of changing the inertia."""
    terms = interval_of(effects, by, shape, looks, substeps, method, loads)
    return Shooting(ProgramLayout(shape, intervals, looks, loads), terms)


class _Program:
    """The parts of the program as expressions."""

    def __init__(self, layout: ProgramLayout, terms: IntervalTerms, functions: Functions):
        self.layout, self.terms, self.functions = layout, terms, functions
        n, nz, nm = layout.intervals, len(layout.decisions), len(layout.means)
        self.states, self.wrt = len(layout.states), len(layout.local) + nz
        self.x = ca.MX.sym("x", nz + nm + n * len(layout.local))
        checks = layout.shape.checks
        self.p = ca.MX.sym("p", terms.shared + checks + 1 + n + n * (layout.looks + 1))
        self.z, self.mean, rest = ca.vertsplit(self.x, [0, nz, nz + nm, self.x.numel()])
        ends = [terms.shared, terms.shared + checks, terms.shared + checks + 1]
        ends.append(ends[-1] + n)
        self.fixed, *others, thetas, looks = ca.vertsplit(self.p, [0, *ends, self.p.numel()])
        self.per_period = (self.z, self.mean, self.fixed, *others)
        self.local = ca.reshape(rest, n, -1)
        widths = ca.vertcat(thetas[1:], thetas[0] + 1) - thetas
        self.per_node = (self.local.T, thetas.T, widths.T, ca.reshape(looks, -1, n))
        self.f = -ca.norm_2(self.mean[:2])
        self.shift = ca.DM.eye(n)[[*range(1, n), 0], :]
        self.g = self._rows()

    def solver(self) -> ca.Function:
        """The solver, with the derivatives given."""
        x, p = self.x, self.p
        lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", self.g.numel())
        given = {
            "grad_f": ca.Function(
                "grad_f", [x, p], [self.f, ca.gradient(self.f, x)], ["x", "p"], ["f", "grad_f_x"]
            ),
            "jac_g": ca.Function(
                "jac_g", [x, p], [self.g, self._jacobian()], ["x", "p"], ["g", "jac_g_x"]
            ),
            "hess_lag": ca.Function(
                "hess_lag",
                [x, p, lam_f, lam_g],
                [ca.triu(self._hessian(lam_f, lam_g))],
                ["x", "p", "lam_f", "lam_g"],
                ["triu_hess_gamma_x_x"],
            ),
        }
        posed = {"x": x, "p": p, "f": self.f, "g": self.g}
        return ca.nlpsol("gait", "ipopt", posed, {**_IPOPT, **given})

    def _rows(self) -> ca.MX:
        n, states = self.layout.intervals, self.states
        ends = self.functions.step.map(n)(*self.per_node, self.z, self.fixed)
        sums = ends[states : states + self.mean.numel(), :]
        path = ends[states + self.mean.numel() :, :]
        gaps = [ends[i, :].T - self.shift @ self.local[:, i] for i in range(states)]
        return ca.vertcat(
            *gaps,
            ca.sum2(sums) - self.mean,
            self.terms.period.values(*self.per_period),
            ca.vec(path.T),
        )

    def _jacobian(self) -> ca.MX:
        """Rows of `slopes` are the outputs of a step, its columns (local, decisions) for each
        interval in turn."""
        n, nm, wrt = self.layout.intervals, self.mean.numel(), self.wrt
        nl, outputs = len(self.layout.local), self.terms.slopes.size1()
        slopes = self.functions.jacobian.map(n)(*self.per_node, self.z, self.fixed)

        def node_by_node(row: int) -> list[ca.MX]:
            known = self.terms.slopes
            return [
                ca.diag(slopes[row, j::wrt]) if known.has_nz(row, j) else ca.MX(n, n)
                for j in range(nl)
            ]

        def along(row: int, blocks: list[ca.MX]) -> ca.MX:
            to_z = ca.horzcat(*(slopes[row, j::wrt].T for j in range(nl, wrt)))
            return ca.horzcat(to_z, ca.MX(n, nm), *blocks)

        rows = []
        for i in range(self.states):
            blocks = node_by_node(i)
            blocks[i] -= self.shift
            rows.append(along(i, blocks))
        sums = slice(self.states, self.states + nm)
        rows.append(
            ca.horzcat(
                *(ca.sum2(slopes[sums, j::wrt]) for j in range(nl, wrt)),
                -ca.DM.eye(nm),
                *(slopes[sums, j::wrt] for j in range(nl)),
            )
        )
        to_z, to_mean = self.terms.period.slopes(*self.per_period)
        rows.append(ca.horzcat(to_z, to_mean, ca.MX(to_z.size1(), nl * n)))
        rows += [along(row, node_by_node(row)) for row in range(sums.stop, outputs)]
        return ca.vertcat(*rows)

    def _hessian(self, lam_f: ca.MX, lam_g: ca.MX) -> ca.MX:
        """Of the Lagrangian; only its upper triangle is complete."""
        n, nm, wrt = self.layout.intervals, self.mean.numel(), self.wrt
        nl, nz, tied = len(self.layout.local), self.z.numel(), self.states * n
        limits = tied + nm + len(self.layout.limits)
        on_states, on_sums, on_limits, on_path = ca.vertsplit(
            lam_g, [0, tied, tied + nm, limits, lam_g.numel()]
        )
        weights = ca.vertcat(
            ca.reshape(on_states, n, -1).T, ca.repmat(on_sums, 1, n), ca.reshape(on_path, n, -1).T
        )
        curves = self.functions.hessian.map(n)(*self.per_node, self.z, self.fixed, weights)
        summed = [ca.sum2(curves[nl:, j::wrt]) for j in range(nl, wrt)]
        limit_z, cross, limit_mean = self.terms.period.curves(*self.per_period, on_limits)
        of_mean = ca.hessian(self.f, self.x)[0][nz : nz + nm, nz : nz + nm]
        z_local = [curves[nl:, j::wrt] for j in range(nl)]
        rows = [
            ca.horzcat(ca.horzcat(*summed) + limit_z, cross, *z_local),
            ca.horzcat(ca.MX(nm, nz), limit_mean + lam_f * of_mean, ca.MX(nm, nl * n)),
        ]
        for i in range(nl):
            blocks = [
                ca.diag(curves[i, j::wrt])
                if j >= i and self.terms.curves.has_nz(i, j)
                else ca.MX(n, n)
                for j in range(nl)
            ]
            rows.append(ca.horzcat(ca.MX(n, nz + nm), *blocks))
        return ca.vertcat(*rows)
