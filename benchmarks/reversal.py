"""Direction over the centre of mass: `python -m benchmarks.reversal`.

Writes results/bench/reversal.md and reversal.svg: the steady speed of the prototype over the
place of platform 2's centre of mass, by the program and by the expansion of docs/model.md.
"""

from __future__ import annotations

import math
from dataclasses import replace

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import root_scalar

from benchmarks.results import FOLDER
from rr_opt.documents.archive import write_text
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import steady_cycle

PERIOD = 1.0
AMPLITUDES = (0.1, 0.3, 0.6)
PLACES = np.linspace(-0.06, 0.26, 33)


def expanded_speed(robot: Robot, gait: SineGait) -> float:
    """The steady speed of a straight gait to the second order of its amplitude, m/s, signed."""
    one, two = robot.platform1, robot.platform2
    drive = two.c * (one.I + one.m * one.a * (one.a - two.c))
    drive -= one.c * (two.I + two.m * two.a * (two.a - one.c))
    rate = gait.amplitude * gait.angular_frequency
    return rate**2 * drive / (4 * (robot.k1 + robot.k2) * (one.c + two.c) ** 2)


def with_centre(robot: Robot, a2: float) -> Robot:
    """The robot with platform 2's centre of mass at a2, m from its axle towards the joint."""
    return replace(robot, platform2=replace(robot.platform2, a=a2))


def reversals(robot: Robot, amplitude: float) -> list[float]:
    """The places a2 at which the speed changes its sign, m."""

    def speed(a2: float) -> float:
        return steady_cycle(with_centre(robot, a2), SineGait(amplitude, PERIOD)).speed

    values = [speed(a2) for a2 in PLACES]
    pairs = zip(PLACES[:-1], PLACES[1:], values[:-1], values[1:], strict=True)
    return [
        float(root_scalar(speed, bracket=(low, high)).root)
        for low, high, a, b in pairs
        if a * b < 0
    ]


def roots(robot: Robot) -> list[float]:
    """The same by the expansion: I2 + m2 a2 (a2 - c1) = c2/c1 (I1 + m1 a1 (a1 - c2))."""
    one, two = robot.platform1, robot.platform2
    given = two.c / one.c * (one.I + one.m * one.a * (one.a - two.c))
    inside = (one.c / 2) ** 2 - (two.I - given) / two.m
    if inside < 0:
        return []
    return [one.c / 2 - math.sqrt(inside), one.c / 2 + math.sqrt(inside)]


def main() -> None:
    robot = read_problem().robot
    figure = Figure((7, 4.2), layout="constrained")
    axes = figure.subplots()
    mm = 1e3 * PLACES
    expansion = [expanded_speed(with_centre(robot, a2), SineGait(1.0, PERIOD)) for a2 in PLACES]
    axes.plot(mm, 1e3 * np.array(expansion), "k--", label="expansion, amplitude to 0")
    lines = [
        "# The direction reverses with the centre of mass",
        "",
        "Written by `python -m benchmarks.reversal`: the paper's prototype, straight sines of",
        f"{PERIOD:g} s. `a2` is where platform 2's centre of mass lies, from its axle towards the",
        "joint. Between two places the robot drives forward, outside backward. Those of the",
        "expansion follow from the formula of [model.md](../../docs/model.md).",
        "",
        "| | direction reverses at a2, mm |",
        "|---|---|",
        f"| expansion | {', '.join(f'{1e3 * a:.2f}' for a in roots(robot))} |",
    ]
    for amplitude in AMPLITUDES:
        gait = SineGait(amplitude, PERIOD)
        speeds = [steady_cycle(with_centre(robot, a2), gait).speed for a2 in PLACES]
        axes.plot(mm, 1e3 * np.array(speeds) / amplitude**2, label=f"amplitude {amplitude:g} rad")
        found = ", ".join(f"{1e3 * a:.2f}" for a in reversals(robot, amplitude))
        lines.append(f"| amplitude {amplitude:g} rad | {found} |")
        print(lines[-1])
    axes.axhline(0.0, color="0.6", lw=0.8)
    axes.axvline(1e3 * robot.platform2.a, color="0.6", lw=0.8, ls=":")
    axes.set_xlabel("a2, mm (dotted: as built)")
    axes.set_ylabel("speed over amplitude squared, mm/s per rad$^2$")
    axes.legend(frameon=False)
    lines += ["", "![Speed over amplitude squared against a2](reversal.svg)"]
    write_text(FOLDER / "reversal.md", "\n".join(lines) + "\n")
    with mpl.rc_context({"svg.hashsalt": "reversal"}):
        figure.savefig(FOLDER / "reversal.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
