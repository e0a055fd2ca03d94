"""The gait problem as a nonlinear program: multiple shooting over one period.

The phase theta runs over [0, 1) in a period. At every node theta_k the speed v_k of axle 1 and the
heading chi_k are unknowns, and a Runge-Kutta step must carry each node to the next and the last
to the first. chi = psi - theta * turn is the heading in a frame that turns steadily with the
gait, `turn` being the heading gained per period; so chi is periodic, straight gaits need no
special case, and the average velocity

    V = integral over theta of Rot(chi) (v, side)

is the mean of P's velocity in that frame. Its magnitude is the speed along the mean circle,
R |turn|/T: with p the position of P from the centre in the turning frame, V is the mean of
dp/dt + Omega x p, and the first term vanishes as p is periodic. It does not depend on the phase
at which the period starts, nor, unlike R, involve a division by turn.

Derivatives. V and the mean heading vector E are unknowns of their own, tied to the sums over
the intervals by linear rows. The Lagrangian is then a sum of terms that each depend on one interval
and the few decisions, so Jacobian and Hessian are assembled from one small function mapped over
the intervals. (CasADi by default colours the whole graph and takes a hundred times longer.)

Shapes whose angle is not a single formula add states and controls at every node, which an
interval propagates in the same way.

Robot, limits and node phases are parameters: one compiled program serves every problem of its
kind.

An interval's functions are compiled where a C compiler is available and it pays. CasADi's virtual
machine takes some 4 ns per operation, and an interval with its derivatives has some 30 000.
Compiled without optimisation, as here, they take a fifth of that; optimising takes the compiler
ten seconds instead of one, for code that is less than twice as fast.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import casadi as ca

from rr_opt.design.landscape import ballasted
from rr_opt.design.shapes import Shape
from rr_opt.design.transcription import COMMON, DYNAMIC, GRIPS, MEANS, ROWS, ProgramLayout
from rr_opt.mechanics.compile_cache import WhenItPays, externals
from rr_opt.mechanics.runge_kutta import BUTCHER6
from rr_opt.model.ballast import By
from rr_opt.motion.dynamics import Dynamics, derive

_IPOPT = {
    "print_time": False,
    "error_on_fail": False,
    # Multipliers of the program's parameters are not needed, and cost more than a solve.
    "calc_lam_p": False,
    "no_nlp_grad": True,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-9,
    "ipopt.max_iter": 200,
    "ipopt.max_cpu_time": 10.0,
    # Starts are steady cycles, near an optimum and often on a limit: keep IPOPT from pushing them
    # far inside, and from starting with a large barrier.
    "ipopt.mu_init": 1e-5,
    "ipopt.bound_push": 1e-6,
    "ipopt.bound_frac": 1e-6,
    "ipopt.slack_bound_push": 1e-6,
    "ipopt.slack_bound_frac": 1e-6,
    "ipopt.bound_relax_factor": 0.0,
}


_FLAGS = ("-O0", "-fPIC", "-shared")
_FEW, _PAYS = 500, 13_000
"""Interval evaluations after which the cache of compiled functions is consulted, and after which
compiling them pays off."""


class Functions(NamedTuple):
    """Functions of an interval: values, their Jacobian and their weighted Hessian."""

    step: ca.Function
    jacobian: ca.Function
    hessian: ca.Function


class IntervalTerms:
    """What one interval contributes: values, first and second derivatives.

    functions  step (local, theta, width, looks, z, fixed) -> states at the end, integrals, path
               rows; its Jacobian and, weighted, Hessian in (local, z)
    compiled   machine code, once the number of evaluations makes it pay
    slopes, curves   their sparsity; the functions return them dense
    period     the rows of a whole period
    shared     length of `fixed`: robot, loads and ballast range
    """

    def __init__(
        self,
        effects: tuple[str, ...],
        by: By,
        shape: Shape,
        looks: int,
        substeps: int,
        loads: tuple[str, ...],
    ):
        parameters = derive(effects).parameters
        z = ca.SX.sym("z", len(COMMON + shape.decisions))
        local_names = DYNAMIC + shape.states + shape.controls
        local, places = ca.SX.sym("local", len(local_names)), ca.SX.sym("looks", looks + 1)
        fixed = ca.SX.sym("fixed", len(parameters) + 5)
        theta, width = ca.SX.sym("theta"), ca.SX.sym("width")
        decided = _named(COMMON + shape.decisions, z)
        *robot, mass, distance, spread, low, high = ca.vertsplit(fixed)
        amount, each = low + decided["ballast"] * (high - low), (mass, distance, spread)
        values = ballasted(dict(zip(parameters, robot, strict=True)), by, each, amount)
        own, p = _named(local_names, local), ca.vertcat(*values.values())
        interval = _Interval(derive(effects), shape, p, decided, own, theta, width)
        end = interval.end(substeps)
        out = ca.cse(
            ca.vertcat(
                end[:2],
                *shape.angle(decided, interval.here, theta + width, width)[: len(shape.states)],
                end[2:],
                *shape.path_rows(decided, interval.here, theta, width, places[looks]),
                *interval.along(loads, end, ca.vertsplit(places)[:looks]),
            )
        )
        inner = ca.vertcat(local, z)
        inputs = [local, theta, width, places, z, fixed]
        weights = ca.SX.sym("weights", out.numel())
        slopes = ca.jacobian(out, inner)
        curves = ca.hessian(ca.dot(weights, out), inner)[0]
        self.shared = fixed.numel()
        self.slopes, self.curves = slopes.sparsity(), curves.sparsity()
        self.functions = Functions(
            ca.Function("step", inputs, [out]),
            ca.Function("jacobian", inputs, [ca.cse(ca.densify(slopes))]),
            ca.Function("hessian", [*inputs, weights], [ca.cse(ca.densify(curves))]),
        )
        self.compiled = WhenItPays(self._compile, look=_FEW, pays=_PAYS)
        self.period = _PeriodTerms(shape, z)

    def _compile(self, make: bool) -> Functions | None:
        compiled = externals("interval", self.functions, _FLAGS, make=make)
        return Functions(*compiled) if compiled else None


@dataclass(frozen=True)
class _Interval:
    """The motion within one interval, as expressions."""

    dynamics: Dynamics
    shape: Shape
    values: ca.SX
    decided: dict[str, ca.SX]
    here: dict[str, ca.SX]
    theta: ca.SX
    width: ca.SX

    def angle(self, fraction: float | ca.SX) -> tuple[Any, tuple[Any, Any, Any]]:
        """The phase, and phi, dphi, ddphi, at a fraction of the interval."""
        T, since = self.decided["period"], fraction * self.width
        at = self.theta + since
        phi, slope, bend = self.shape.angle(self.decided, self.here, at, since)
        return at, (phi, slope / T, bend / T**2)

    def motion(self, fraction: float, v: ca.SX) -> Any:
        """vdot, w, side, torque and the integrands, at a fraction of the interval."""
        at, angle = self.angle(fraction)
        moved = self.dynamics.motion(v, *angle, self.values)
        return *moved, self.shape.integrands(angle[0], at)

    def rhs(self, fraction: float, y: ca.SX) -> ca.SX:
        """Derivative in theta of v, chi, V, E and the shape's integrals."""
        T = self.decided["period"]
        vdot, w, side, _, integrands = self.motion(fraction, y[0])
        cos, sin = ca.cos(y[1]), ca.sin(y[1])
        V = cos * y[0] - sin * side, sin * y[0] + cos * side
        return ca.vertcat(T * vdot, T * w - self.decided["turn"], *V, cos, sin, *integrands)

    def end(self, substeps: int) -> ca.SX:
        """v, chi and the integrals at the end."""
        sums = len(MEANS) + len(self.shape.integrals)
        y = ca.vertcat(self.here["v"], self.here["chi"], ca.SX.zeros(sums))
        for part in range(substeps):
            y = BUTCHER6.step(
                lambda fraction, y, part=part: self.rhs((part + fraction) / substeps, y),
                y,
                self.width / substeps,
            )
        return y

    def along(self, loads: tuple[str, ...], end: ca.SX, places: list[ca.SX]) -> list[ca.SX]:
        """Each load at the node, at the given places within the interval and, where it jumps at
        nodes, at the end."""
        start = ca.vertcat(self.here["v"], self.here["chi"])
        v0, v1 = start[0], end[0]
        d0, d1 = (self.width * self.rhs(at, y)[0] for at, y in ((0.0, start), (1.0, end)))
        seen = [(0.0, v0), *((at, _cubic(at, v0, v1, d0, d1)) for at in places)]
        seen += [(1.0, v1)] if self.shape.controls else []
        known = [self._loads(at, v) for at, v in seen]
        return [each[load] for load in loads for each in known]

    def _loads(self, fraction: float | ca.SX, v: ca.SX) -> dict[str, ca.SX]:
        inputs = (v, *self.angle(fraction)[1], self.values)
        grips = zip(GRIPS, self.dynamics.grip(*inputs), strict=True)
        return {"torque": self.dynamics.motion(*inputs)[3], **dict(grips)}


def _cubic(at: ca.SX, v0: ca.SX, v1: ca.SX, d0: ca.SX, d1: ca.SX) -> ca.SX:
    """The cubic through v0 at 0 and v1 at 1 with slopes d0 and d1 there."""
    rest, rise = 1 - at, v1 - v0
    return v0 + at * rise + at * rest * (rest * (d0 - rise) - at * (d1 - rise))


class _PeriodTerms:
    """The limits of a shape and the rows of ROWS.

    values  (z, mean, checks, sign) -> rows
    slopes  -> their Jacobians in z and mean
    curves  (.., multipliers) -> blocks z-z, z-mean and mean-mean of the Hessian
    """

    def __init__(self, shape: Shape, z: ca.SX):
        mean_names = MEANS + shape.integrals
        mean, sign = ca.SX.sym("mean", len(mean_names)), ca.SX.sym("sign")
        checks = ca.SX.sym("checks", shape.checks)
        decided = _named(COMMON + shape.decisions, z)
        own = shape.limit_rows(decided, _named(mean_names, mean), tuple(ca.vertsplit(checks)))
        V, E = mean[:2], mean[2:4]
        rate = decided["turn"] / decided["period"]
        rows = ca.vertcat(*own, sign * ca.dot(V, E), rate / ca.norm_2(V), rate, decided["turn"])
        lam = ca.SX.sym("lam", len(shape.limits) + len(ROWS))
        weighted = ca.dot(lam, rows)
        inputs = [z, mean, checks, sign]
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


def _named(names: tuple[str, ...], stacked: ca.SX) -> dict[str, ca.SX]:
    """The entries of a vector by name."""
    return dict(zip(names, ca.vertsplit(stacked), strict=True))


@dataclass(frozen=True)
class Shooting:
    """The program for one shape and number of intervals.

    A solver is an nlpsol over the unknowns and rows of `layout`, p = (robot, loads, ballast range,
    checked phases, direction, node phases, looks and turn interval by interval).
    """

    layout: ProgramLayout
    terms: IntervalTerms

    @property
    def solver(self) -> ca.Function:
        """The solver as machine code, where available; else on CasADi's virtual machine."""
        functions = self.terms.compiled.code(0) or self.terms.functions
        return _solver(self.layout, self.terms, functions)


@lru_cache
def _solver(layout: ProgramLayout, terms: IntervalTerms, functions: Functions) -> ca.Function:
    return _Program(layout, terms, functions).solver()


@lru_cache
def shooting(
    effects: tuple[str, ...],
    by: By,
    shape: Shape,
    intervals: int,
    looks: int = 0,
    substeps: int = 1,
    loads: tuple[str, ...] = ("torque",),
) -> Shooting:
    """The program for robots with these effects and this means of changing the inertia."""
    terms = _terms(effects, by, shape, looks, substeps, loads)
    return Shooting(ProgramLayout(shape, intervals, looks, loads), terms)


_terms = lru_cache(IntervalTerms)


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
        self.per_period = (self.z, self.mean, *others)
        self.local = ca.reshape(rest, n, -1)
        widths = ca.vertcat(thetas[1:], thetas[0] + 1) - thetas
        self.per_node = (self.local.T, thetas.T, widths.T, ca.reshape(looks, -1, n))
        self.f = -ca.norm_2(self.mean[:2])
        self.shift = ca.DM.eye(n)[[*range(1, n), 0], :]
        self.g = self._rows()

    def solver(self) -> ca.Function:
        """The solver, supplied with the derivatives."""
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
        """The rows of `slopes` are the outputs of a step, its columns (local, decisions) for each
        interval in turn."""
        n, nm, wrt = self.layout.intervals, self.mean.numel(), self.wrt
        nl, outputs = len(self.layout.local), self.terms.slopes.size1()
        slopes = self.functions.jacobian.map(n)(*self.per_node, self.z, self.fixed)

        def along(row: int, blocks: list[ca.MX]) -> ca.MX:
            to_z = ca.horzcat(*(slopes[row, j::wrt].T for j in range(nl, wrt)))
            return ca.horzcat(to_z, ca.MX(n, nm), *blocks)

        rows = []
        for i in range(self.states):
            blocks = self._diagonal(slopes, self.terms.slopes, i)
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
        rows += [
            along(row, self._diagonal(slopes, self.terms.slopes, row))
            for row in range(sums.stop, outputs)
        ]
        return ca.vertcat(*rows)

    def _hessian(self, lam_f: ca.MX, lam_g: ca.MX) -> ca.MX:
        """Hessian of the Lagrangian; only its upper triangle is complete."""
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
            blocks = self._diagonal(curves, self.terms.curves, i, first=i)
            rows.append(ca.horzcat(ca.MX(n, nz + nm), *blocks))
        return ca.vertcat(*rows)

    def _diagonal(self, values: ca.MX, known: ca.Sparsity, row: int, first: int = 0) -> list[ca.MX]:
        """Blocks of a row by local unknowns, from the first of them on: each node's by its own."""
        n, wrt = self.layout.intervals, self.wrt
        return [
            ca.diag(values[row, j::wrt]) if j >= first and known.has_nz(row, j) else ca.MX(n, n)
            for j in range(len(self.layout.local))
        ]
