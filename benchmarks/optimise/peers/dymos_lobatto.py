"""Dymos: Hermite-Simpson collocation on 40 segments, partials by complex step, SLSQP.

The driver is the one that comes with OpenMDAO; pyOptSparse with IPOPT is no Python package. (Radau
of order 5 has too many nodes for SLSQP, whose algebra is dense; with `solve_segments` its Newton
solver takes some ten times longer.)
"""

from __future__ import annotations

import contextlib
import io
import tempfile
import warnings
from collections.abc import Callable

import numpy as np

from benchmarks.optimise.peers.posed import NAMES, Array, Claim, Posed, motion, sine
from benchmarks.optimise.peers.simulated import steady

NAME = "Dymos, SLSQP"
_SEGMENTS, _ORDER = 40, 3
_STATES = ("v", "chi", "x", "y")


def _ode(posed: Posed):
    import openmdao.api as om  # type: ignore

    class Racer(om.ExplicitComponent):
        """The motion at every node; time is the phase of the cycle."""

        def initialize(self):
            self.options.declare("num_nodes", types=int)

        def setup(self):
            n = self.options["num_nodes"]
            for name in (*NAMES, "turn"):
                self.add_input(name, 1.0)
            for name in ("theta", "v", "chi"):
                self.add_input(name, np.zeros(n))
            outputs = (*(f"{name}_rate" for name in _STATES), "load")
            for name in outputs:
                self.add_output(name, np.zeros(n))
            self.declare_coloring(wrt="*", method="cs", show_summary=False, show_sparsity=False)
            rows = np.arange(n)
            for name in outputs:
                for state in ("theta", "v", "chi"):
                    self.declare_partials(name, state, rows=rows, cols=rows, method="cs")
                for one in (*NAMES, "turn"):
                    self.declare_partials(name, one, rows=rows, cols=np.zeros(n, int), method="cs")

        def compute(self, inputs, outputs):
            amplitude, period, offset, inertia = (inputs[name] for name in NAMES)
            v, chi = inputs["v"], inputs["chi"]
            angle = sine(amplitude, period, offset, inputs["theta"], np.sin, np.cos)
            vdot, w, side, torque = motion(posed.robot, inertia, v, angle, np.sin, np.cos)
            outputs["v_rate"] = period * vdot
            outputs["chi_rate"] = period * w - inputs["turn"]
            outputs["x_rate"] = np.cos(chi) * v - np.sin(chi) * side
            outputs["y_rate"] = np.sin(chi) * v + np.cos(chi) * side
            outputs["load"] = torque / posed.torque

    return Racer


def _model(posed: Posed):
    """The OpenMDAO problem, set up."""
    import dymos as dm  # type: ignore
    import openmdao.api as om  # type: ignore

    problem = om.Problem(model=om.Group(), reports=None)
    trajectory = dm.Trajectory()
    problem.model.add_subsystem("traj", trajectory)
    phase = dm.Phase(
        ode_class=_ode(posed), transcription=dm.GaussLobatto(num_segments=_SEGMENTS, order=_ORDER)
    )
    trajectory.add_phase("gait", phase)
    phase.set_time_options(
        fix_initial=True, fix_duration=True, initial_val=0.0, duration_val=1.0, targets=["theta"]
    )
    for name in _STATES:
        phase.add_state(name, rate_source=f"{name}_rate", fix_initial=name != "v")
    for name, low, high in zip(NAMES, posed.least, posed.most, strict=True):
        free = low < high
        bounds = {"lower": low, "upper": high, "ref0": low, "ref": high} if free else {}
        phase.add_parameter(name, val=low, opt=bool(free), static_target=True, **bounds)
    phase.add_parameter("turn", val=0.0, opt=True, static_target=True)
    trajectory.add_linkage_constraint("gait", "gait", "v", "v")
    phase.add_boundary_constraint("chi", loc="final", equals=0.0)
    phase.add_path_constraint("load", lower=-1.0, upper=1.0)
    limits = om.ExecComp(
        [
            "speed = (x**2 + y**2)**0.5",
            "left = amplitude + offset",
            "right = amplitude - offset",
            "beat = amplitude / period",
        ]
    )
    problem.model.add_subsystem("limits", limits)
    for name in ("x", "y"):
        problem.model.connect(f"traj.gait.timeseries.{name}", f"limits.{name}", src_indices=[-1])
    for name in NAMES[:3]:
        problem.model.connect(f"traj.gait.parameter_vals:{name}", f"limits.{name}")
    problem.model.add_constraint("limits.left", upper=posed.reach)
    problem.model.add_constraint("limits.right", upper=posed.reach)
    if np.isfinite(posed.rate):
        problem.model.add_constraint("limits.beat", upper=posed.rate / (2 * np.pi))
    problem.model.add_objective("limits.speed", scaler=-1.0)
    problem.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-8, maxiter=200, disp=False)
    problem.driver.declare_coloring(show_summary=False, show_sparsity=False)
    problem.setup()
    return problem, phase


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem, built once and then started anew."""

    def quietly(call: Callable):
        # Colourings and reports go to the folder in which it runs.
        with (
            tempfile.TemporaryDirectory() as place,
            contextlib.chdir(place),
            contextlib.redirect_stdout(io.StringIO()),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            return call()

    problem, phase = quietly(lambda: _model(posed))

    def solve(start: Array) -> Claim:
        cycle = steady(posed, start, 100, 1e-6)
        theta = np.arange(101) / 100
        path = {
            "v": np.append(cycle.v, cycle.v[0]),
            "chi": np.append(cycle.chi, cycle.chi[0]),
            "x": cycle.velocity.real * theta,
            "y": cycle.velocity.imag * theta,
        }
        for name, values in path.items():
            phase.set_state_val(name, values, time_vals=theta)
        for name, value in zip((*NAMES, "turn"), (*start, cycle.turn), strict=True):
            phase.set_parameter_val(name, value)
        ended = quietly(problem.run_driver)
        gait = (problem.get_val(f"traj.gait.parameter_vals:{n}").item() for n in NAMES)
        return Claim.of(gait, problem.get_val("limits.speed").item(), bool(ended.success))

    return solve
