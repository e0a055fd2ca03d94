"""The fastest gait of a robot with each effect of the catalogue, driven in the laboratory.

`python -m benchmarks.effects` writes results/bench/effects.md. `maximize-speed` is given a robot
that lists the effect; the planar engine of the laboratory has it hidden, is told the gait of the
answer, and drives it from rest until the speed repeats. The two share no equation.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

import rr_opt as rr
from benchmarks.results import machine, write
from rr_lab.effects import rig_with
from rr_lab.planar.drive import drive
from rr_lab.run import Conditions
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import Gait
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.motion.steady_cycle import cycle_of
from rr_opt.results.fastest import FastestGait

SECONDS = 45.0
"""Some twelve times as long as the prototype takes to forget how it began."""
PER_PERIOD = 64
ALLOWED = 0.01


@dataclass(frozen=True)
class Case:
    """An effect with its values. headings: at which the laboratory drives, their mean counts; far:
    the laboratory drives so far, m, from the origin, about which the effect has its place."""

    name: str
    values: Mapping[str, float]
    headings: int = 1
    far: float = 0.0


CASES = (
    Case("servo_lag", {"tau": 0.03}),
    Case("servo_lag", {"tau": 0.1}),
    Case("servo_lag", {"tau": 0.05, "beta": 8e-4}),
    Case("servo_rate_limit", {"rate_limit": 2.0}),
    Case("servo_backlash", {"width": 0.02}),
    Case("servo_backlash", {"width": 0.05}),
    Case("servo_backlash", {"width": 0.02, "joint_friction": 0.05}),
    Case("servo_backlash", {"width": 0.02, "joint_friction": 0.3}),
    Case("servo_offset", {"offset": 0.05}),
    Case("coulomb_friction", {"force1": 0.004, "force2": 0.004}),
    Case("quadratic_drag", {"coefficient_total": 0.5}),
    Case("left_right_drag", {"asymmetry1": 0.3, "asymmetry2": 0.3}),
    Case("wheel_inertia", {"J": 1e-5}),
    Case("axle_misalignment", {"toe1": 0.02, "toe2": -0.01}),
    Case("floor_tilt", {"tilt_x": 1e-3, "tilt_y": 0.0}, headings=8),
    Case("floor_patch", {"multiplier": 2.0, "x": 0.0, "y": 0.0, "radius": 1.0}, far=50.0),
    Case("lateral_slip", {"creep_compliance": 0.03}),
    Case("lateral_slip", {"mu": 0.4}),
    Case("com_offset", {"d1": 5e-3, "d2": 5e-3}),
    Case("marker_offset", {"dx": 5e-3, "dy": 5e-3}),
    Case("clock_offset", {"offset": 0.02}),
)


def answer(case: Case, *, ratio: bool) -> FastestGait:
    """`maximize-speed` on the prototype with the effect; ratio: its inertia ratio to be chosen."""
    problem = read_problem()
    robot = replace(problem.robot, physics=(EffectUse(case.name, case.values),))
    choice = problem.inertia_ratio if ratio else None
    return rr.maximize_speed(replace(problem, robot=robot, inertia_ratio=choice))


def driven(robot: Robot, gait: Gait, case: Case) -> float:
    """The speed in the laboratory over its last period, m/s, signed; the mean over headings."""
    periods = int(np.ceil(SECONDS / gait.period))
    speeds = []
    for heading in 2 * np.pi * np.arange(case.headings) / case.headings:
        pose = (case.far, 0.0, float(heading))
        # Headings are kept by starting at one and not driving for long: tilt turns the robot.
        conditions = Conditions(gait.period, "running", pose, PER_PERIOD / gait.period, periods)
        motion = drive(rig_with(robot), gait, conditions)
        speeds.append(cycle_of(gait.period, *motion.one[: PER_PERIOD + 1].T).speed)
    return float(np.mean(speeds))


def main() -> None:
    lines = [
        "# The fastest gait with each effect, driven in the laboratory",
        "",
        f"{machine()}; one run. Written by `python -m benchmarks.effects`.",
        "",
        "`maximize-speed` on the prototype with the effect in its `physics`, and its gait driven",
        f"by the planar engine with the effect hidden in it, for {SECONDS:g} s from rest. `by` is",
        "`optimiser` where multiple shooting has the effect, else `climb`: its optimum is climbed",
        "on from with the simulation that predicts recordings. `unknown` is the difference if the",
        "gait of a robot without the effect is driven. Tilt: the mean over 8 headings. Patch:",
        "away from it.",
        "",
        "| effect | ratio | by | gait | speed, mm/s | laboratory | difference | unknown | CPU, s |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    worst = 0.0
    for ratio in (False, True):
        plain = answer(Case("marker_offset", {"dx": 0.0, "dy": 0.0}), ratio=ratio)
        for case in CASES:
            begun = time.process_time()
            best = answer(case, ratio=ratio)
            seconds = time.process_time() - begun
            gait, speed = best.gait, best.speed
            if gait is None or not speed or plain.gait is None or not plain.speed:
                raise SystemExit(f"{case.name}: {best.message}")
            reached = driven(best.robot, gait, case)
            old = replace(best.robot, platform2=plain.robot.platform2)
            without = driven(old, plain.gait, case) / plain.speed - 1
            off = reached / speed - 1
            worst = max(worst, abs(off))
            values = ", ".join(f"{key} {value:g}" for key, value in case.values.items())
            lines.append(
                f"| {case.name}: {values} | {'free' if ratio else 'as built'} "
                f"| {'climb' if best.climbed else 'optimiser'} "
                f"| {gait.amplitude:.4f} rad, {gait.period:.4f} s | {1e3 * speed:+.2f} "
                f"| {1e3 * reached:+.2f} | {100 * off:+.2f} % | {100 * without:+.1f} % "
                f"| {seconds:.1f} |"
            )
            print(lines[-1], flush=True)
    lines += ["", f"The largest difference is {100 * worst:.2f} %."]
    write("effects", lines, {"allowed/largest difference": ALLOWED / worst})


if __name__ == "__main__":
    main()
