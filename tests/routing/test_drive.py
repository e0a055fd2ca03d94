"""A route is driven from rest to rest within its tolerance; the laboratory agrees; what cannot be
driven is named."""

import cmath
import json
import math
from dataclasses import replace

import numpy as np
import pytest

import rr_opt as rr
from benchmarks.route.problems import ROBOTS
from rr_opt.design.maximize_speed import Optimum
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.route import Pose
from rr_opt.routing.path import Leg
from rr_opt.routing.plan import swing_out
from rr_opt.routing.program import DriveProgram
from tests.mechanics.multipliers import rates, solve

PROBLEM = replace(rr.shipped(), inertia_ratio=None).with_robot(
    with_inertia_ratio(rr.prototype(), 0.3)
)
REFERENCE = ROBOTS["reference"]


@pytest.fixture(scope="module")
def turned():
    pieces = (rr.Straight("50 cm"), rr.Arc("60 cm", "90 deg"))
    return rr.route(rr.Route(PROBLEM, pieces))


def test_every_check_passes(turned):
    assert turned.status is rr.Status.OPTIMAL, turned.message
    assert len(turned.checks) == 4
    assert turned.replay.position <= 0.02
    assert turned.replay.speed <= 0.002
    assert turned.replay.heading <= math.radians(5)
    assert turned.plan.way == "backward"


def test_it_is_faster_than_gaits_and_coasting(turned):
    """Steady gaits all the way would take as long, without start and stop."""
    plan = turned.plan
    steady = sum(leg.length / v for leg, v in zip(plan.legs, plan.speeds, strict=True))
    assert steady < turned.seconds < steady + plan.coasting.seconds + 3


def test_the_laboratory_ends_at_the_same_place(turned):
    from rr_lab.case import driven
    from rr_lab.effects import rig_with
    from rr_lab.run import Conditions

    conditions = Conditions(turned.seconds, "rest", (0.0, 0.0, math.pi))
    motion = driven("planar", rig_with(turned.robot, ()), turned.command, conditions)
    replayed = turned.replay.trajectory
    k = -1
    at = (
        float(np.interp(motion.t[k], replayed.t, replayed.x)),
        float(np.interp(motion.t[k], replayed.t, replayed.y)),
    )
    length = sum(leg.length for leg in turned.plan.legs)
    assert math.dist(motion.one[k, :2], at) < 0.01 * length


def test_what_cannot_be_driven_is_named():
    found = rr.route(rr.Route(PROBLEM, (rr.Straight(1), rr.Arc(0.1, 1.0))))
    assert found.status is rr.Status.INFEASIBLE
    assert "piece 2" in found.message
    assert "radius of" in found.message
    assert found.command is None


def test_without_an_inertia_ratio_there_is_no_drive(monkeypatch):
    """The robot as built is not the one that was asked for."""

    def none(problem):
        return Optimum(rr.Status.NOT_CONVERGED, "No start led to an optimum.", problem)

    monkeypatch.setattr("rr_opt.routing.plan.maximize_speed", none)
    found = rr.route(rr.Route(rr.shipped(), (rr.Straight(1),)))
    assert found.status is rr.Status.NOT_CONVERGED
    assert found.message == "No start led to an optimum."
    assert found.command is None


def test_a_u_turn_led_by_the_front_axle():
    """The axle that leads has to turn in before P comes to the arc."""
    pieces = (rr.Straight(0.5), rr.Arc(0.5, math.pi), rr.Straight(0.5))
    found = rr.route(rr.Route(REFERENCE, pieces))
    assert found.plan.way == "forward"
    assert found.status is rr.Status.OPTIMAL, found.message
    assert found.seconds
    assert found.seconds < 31.5


def test_an_arc_from_rest_swings_out():
    """Forward, by sqrt(R^2 + 2 c1^2) - R on a long arc: the drive that is found goes so far."""
    c1 = REFERENCE.robot.platform1.c
    arc = Leg(0, Pose(), 0.6 * math.pi, 1 / 0.6)
    found = rr.route(rr.Route(REFERENCE, (rr.Arc(0.6, math.pi),)))
    assert found.status is rr.Status.INFEASIBLE
    least = swing_out(arc, c1)
    assert least == pytest.approx(math.sqrt(0.36 + 2 * c1**2) - 0.6, abs=1e-3)
    assert found.replay
    assert found.replay.path >= least
    assert f"by {1e3 * least:.0f} mm or more" in found.message
    assert "times the tolerances" in found.message


@pytest.mark.parametrize(("radius", "angle"), [(1.0, 1.4), (0.8, 1.5), (0.6, 3.0)])
def test_the_least_that_it_swings_out(radius, angle):
    """Axle 1 is led in small steps, turned inwards as far as P may be out. It comes round the arc
    with a little more room than the least, and not with the least, which is a bound."""
    c1 = REFERENCE.robot.platform1.c
    least = swing_out(Leg(0, Pose(), radius * angle, 1 / radius), c1)

    def around(w: float) -> float:
        """The angle, rad, that P comes to before it is too far out, or at the end of the arc."""
        axle, before = complex(c1, -radius), 0.0
        while before < angle:
            rho = abs(axle)
            out = (rho**2 + c1**2 - (radius + w) ** 2) / (2 * c1 * rho)
            if out > 1:
                break
            heading = cmath.phase(axle) + math.pi / 2 - math.asin(max(out, 0.0))
            before = cmath.phase((axle - cmath.rect(c1, heading)) * 1j)
            axle += cmath.rect(1e-3, heading)
        return before

    assert around(least) < angle - math.asin(least / radius)
    assert around(1.05 * least) >= angle - math.asin(1.05 * least / radius)


def test_a_route_that_runs_out_is_faster(turned):
    asked = replace(turned.plan.route, end="running")
    assert rr.route(asked).seconds < turned.seconds - 1


def test_files(turned, tmp_path):
    names = {file.name for file in turned.save(tmp_path)}
    assert names >= {"route.json", "trajectory.csv", "setpoints.csv", "report.html", "way.svg"}
    record = json.loads((tmp_path / "route.json").read_text())
    assert record["status"] == "optimal"
    assert record["seconds"] == pytest.approx(turned.seconds)
    failed = replace(turned, plan=replace(turned.plan, status=rr.Status.NOT_CONVERGED))
    assert "setpoints.csv" not in {file.name for file in failed.save(tmp_path / "failed")}
    assert not any(one.shadow_price for one in failed.limits.values())
    points = np.genfromtxt(tmp_path / "setpoints.csv", delimiter=",", names=True)
    assert points["phi_rad"] == pytest.approx(turned.command.angle(points["t_s"]), abs=1e-6)
    assert np.abs(np.diff(points["phi_rad"])).max() <= PROBLEM.limits.rate / 125 * 1.001


def test_the_grip_needed_is_told(turned):
    """It is that of the constraints' forces in full coordinates, at every sample of the drive."""
    robot, told = turned.robot, turned.limits["grip"]
    one, two, driven = robot.platform1, robot.platform2, turned.replay.trajectory
    on_two = (one.m * one.a + two.m * (one.c + two.c - two.a)) / (one.c + two.c)
    loads = 9.80665 * np.array([one.m + two.m - on_two, on_two])
    phi, dphi, ddphi = turned.command.at(driven.t)
    states = np.stack([driven.x, driven.y, driven.psi, phi], axis=1)
    needed = [
        np.abs(solve(robot, q, rates(robot, q, *of), bend)[1][:2] / loads).max()
        for q, *of, bend in zip(states, driven.v, dphi, ddphi, strict=True)
    ]
    # Peaks lie between samples.
    assert max(needed) <= told.value == pytest.approx(max(needed), rel=3e-3)
    assert told.time == pytest.approx(driven.t[np.argmax(needed)], abs=5e-3)
    assert not told.active


@pytest.mark.parametrize(("name", "limit"), [("grip", 0.4), ("torque", 0.2)])
def test_a_limit_that_binds(name, limit, monkeypatch):
    """The drive comes to its limit, keeps it by CVODES, and its price is the time that a drive
    takes less for a limit that is a little higher, planned anew from this one: another start may
    lead to another optimum."""

    def driven(by: float):
        limits = replace(PROBLEM.limits, **{name: limit * (1 + by)})
        return rr.route(rr.Route(replace(PROBLEM, limits=limits), (rr.Straight(1),)))

    def guess(program):
        assert found.plan.drive
        command = found.plan.drive.command
        knots = command.knots[:, 2::2]
        cycles = command.durations[1::2] * knots[2] / (2 * math.pi)
        if len(cycles) != len(program.stages):
            return begun(program)
        x = np.vstack([cycles, knots]).T.ravel() / program.scale
        program.discretise(x)
        return x, program.look(x).samples.path[:, program.joints].T

    found = driven(0.0)
    row = found.limits[name]
    assert found.status is rr.Status.OPTIMAL, found.message
    assert row.active
    assert 0.998 * limit <= row.value <= limit
    assert row.piece == 1
    assert found.record()["solver"]["stationarity"] < 1e-3
    begun = DriveProgram.guess
    monkeypatch.setattr(DriveProgram, "guess", guess)
    slopes = []
    for by in (-0.004, -0.001, 0.001, 0.004):
        seconds = driven(by).seconds
        assert seconds
        assert found.seconds
        slopes.append((found.seconds - seconds) / (by * limit))
    # Optima lie close together: one of these drives may come to another.
    assert row.shadow_price == pytest.approx(np.median(slopes), rel=0.01)
    assert not found.warnings
    assert found.plan.drive
    stopped = replace(found.plan, drive=replace(found.plan.drive, stationarity=0.1))
    assert "shadow prices" in replace(found, plan=stopped).warnings[0]
    written = {one["name"]: one for one in found.record()["limits"]}
    assert written[name]["shadow_price"] == row.shadow_price


def test_a_film(turned, tmp_path):
    still = replace(turned.replay.trajectory, t=turned.replay.trajectory.t / 40)
    short = replace(turned, replay=replace(turned.replay, trajectory=still))
    short.save(tmp_path, figures=False, film="gif")
    assert (tmp_path / "motion.gif").read_bytes()[:6] == b"GIF89a"
    with pytest.raises(rr.InputError, match=r"setpoints\.csv"):
        rr.export(tmp_path / "route.json")


def test_without_pieces():
    with pytest.raises(rr.InputError, match="at least one"):
        rr.route(rr.Route(PROBLEM, ()))
