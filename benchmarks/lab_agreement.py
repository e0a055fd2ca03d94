"""How well the laboratory agrees with the reduced model: `python -m benchmarks.lab_agreement`.

Random robots and gaits, nothing hidden. Each run of ten periods is recorded by each engine with
smaller and smaller steps; CVODES drives the reduced model from the initial state that fits best.
Writes results/lab/null.csv and results/lab/README.md.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from rr_lab.case import ENGINES, Engine, record, stream
from rr_lab.random_case import draw_gait, draw_robot
from rr_opt.documents.archive import write_text
from rr_opt.model.experiment import Recording
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.motion.integrators import cvodes

STEPS = (1e-3, 5e-4, 2.5e-4, 1.25e-4)
RUNS = 12
PERIODS = 10
SIGMA = np.array([[1e-3], [1e-3], [3e-3]])
OUT = Path("results/lab")


def path_of(recording: Recording) -> np.ndarray:
    return np.array([recording.values[channel] for channel in ("x", "y", "psi")])


def nearest(robot: Robot, gait: SineGait, t: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The reduced model's path (3, n) with the place, heading and speed at t = 0 that fit best."""

    def path(p: np.ndarray) -> np.ndarray:
        _, psi, x, y, _ = cvodes(robot, gait, p[0], t)
        cos, sin = np.cos(p[1]), np.sin(p[1])
        return np.array([cos * x - sin * y + p[2], sin * x + cos * y + p[3], psi + p[1]])

    found = least_squares(
        lambda p: ((path(p) - seen) / SIGMA).ravel(), [0.0, seen[2, 0], *seen[:2, 0]], method="lm"
    )
    return path(found.x)


def measured(
    robot: Robot, gait: SineGait, step: float, engine: Engine
) -> tuple[float, float, float, float]:
    """Error of the displacement (%), of the path (sigma, mm) and of phi (rad)."""
    seen = record(robot, gait, PERIODS * gait.period, "running", step=step, engine=engine)
    path = path_of(seen)
    model = nearest(robot, gait, seen.t, path)
    moved, expected = (np.linalg.norm(one[:2, -1] - one[:2, 0]) for one in (path, model))
    rms = float(np.sqrt(np.mean(((path - model) / SIGMA) ** 2)))
    worst = 1e3 * float(np.abs(path - model)[:2].max())
    phi = float(np.abs(seen.values["phi"] - gait.angle(seen.t)).max())
    return 100 * abs(float(moved / expected) - 1), rms, worst, phi


def seconds_per_run(step: float, engine: Engine) -> float:
    rng = stream(0, "speed")
    robot = draw_robot(rng)
    gait = draw_gait(rng, robot, True)
    began = time.process_time()
    record(robot, gait, 30.0, step=step, engine=engine)
    return time.process_time() - began


def main() -> None:
    rows = []
    for n in range(RUNS):
        rng = stream(n, "null study")
        robot = draw_robot(rng)
        gait = draw_gait(rng, robot, n % 2 == 1)
        for engine in ENGINES:
            for step in STEPS:
                rows.append((engine, n, step, *measured(robot, gait, step, engine)))
        print(f"run {n + 1} of {RUNS}", file=sys.stderr)
    head = "engine,run,step,displacement_percent,path_sigma,path_mm,phi_rad"
    lines = [
        f"{engine},{n},{step},{','.join(f'{value:.6g}' for value in rest)}"
        for engine, n, step, *rest in rows
    ]
    write_text(OUT / "null.csv", "\n".join([head, *lines]) + "\n")
    parts = [
        section(engine, np.array([rest for name, *rest in rows if name == engine]))
        for engine in ENGINES
    ]
    write_text(OUT / "README.md", "\n".join([HEAD, *parts]))


HEAD = f"""# The laboratory with nothing hidden

Written by `python -m benchmarks.lab_agreement`. {RUNS} random robots and gaits, {PERIODS} periods
each, in each engine and in the reduced model, which starts where it fits best (place, heading,
speed). The displacement is that over all periods. Sigma is 1 mm and 3 mrad. Seconds are CPU time
for 30 s. Columns without `worst` are medians. `null.csv` has every run.
"""

NAMES = {"mujoco": "MuJoCo", "planar": "The planar engine"}
TOLD = {
    "mujoco": "The path's error falls with the step to the power {order:.2f} (median), to\n"
    "nothing. Recordings are made with 0.25 ms.",
    "planar": "What is left at small steps is no error: its servo is a motor, which gives way a\n"
    "little. Recordings are made with 0.5 ms, and with 0.25 ms where parts strike each other.",
}


def section(engine: Engine, rows: np.ndarray) -> str:
    table = []
    for step in STEPS:
        part = rows[rows[:, 1] == step]
        moved, sigma, worst = (part[:, k] for k in (2, 3, 4))
        table.append(
            f"| {1e3 * step:g} ms | {np.median(moved):.1g} | {moved.max():.1g} "
            f"| {np.median(sigma):.4f} | {sigma.max():.4f} | {worst.max():.3f} "
            f"| {seconds_per_run(step, engine):.2f} |"
        )
    coarse, fine = (rows[rows[:, 1] == step][:, 3] for step in (STEPS[0], STEPS[-1]))
    order = np.log(coarse / fine) / np.log(STEPS[0] / STEPS[-1])
    return f"""## {NAMES[engine]}

| step | displacement, % | worst | path, sigma rms | worst | path, mm, worst | s a run |
|---|---|---|---|---|---|---|
{chr(10).join(table)}

{TOLD[engine].format(order=np.median(order))}
phi is its command to {rows[:, 5].max():.0e} rad in all runs.
"""


if __name__ == "__main__":
    main()
