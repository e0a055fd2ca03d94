"""A robot that is simulated, and the markers that a capture system would see on it.

The motion is the reduced model's; the markers are laid out here, by complex numbers, and share no
code with what is tested.
"""

from functools import cache

import numpy as np

from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import Layout
from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.recordings.readers.marker_rows import MarkerData

LAYOUT = Layout(
    {"L1": (0.05, 0.03), "R1": (0.05, -0.035), "L2": (0.20, 0.06), "R2": (0.21, -0.05)},
    {"T1": (-0.02, 0.03), "T2": (-0.03, -0.04), "T3": (-0.08, 0.045), "T4": (-0.07, -0.03)},
)
GAIT = SineGait(0.7, 1.0, 0.1)


@cache
def motion(seconds: float = 30.0, gait: SineGait = GAIT, start: str = "rest") -> Trajectory:
    return rollout(read_problem(None).robot, gait, seconds, start, 100.0)


def markers(moved: Trajectory, sigma: float, seed: int, layout: Layout = LAYOUT) -> MarkerData:
    """What is seen at every instant, with noise of sigma, m, on each coordinate."""
    joint = moved.x + 1j * moved.y
    labels, columns = [], []
    headings = (moved.psi, moved.psi + moved.phi)
    for places, heading in zip((layout.platform1, layout.platform2), headings, strict=True):
        for name, (forward, left, *_) in places.items():
            labels.append(name)
            columns.append(joint + (forward + 1j * left) * np.exp(1j * heading))
    seen = np.stack(columns, 1)
    positions = np.stack([seen.real, seen.imag, np.full(seen.shape, 0.08)], -1)
    positions += np.random.default_rng(seed).normal(0, 1, positions.shape) * sigma
    frame = np.arange(len(moved.t))
    return MarkerData("run.csv", moved.t.copy(), frame, tuple(labels), positions, 100.0)


def kinds(doubts) -> set[str]:
    return {doubt.kind for doubt in doubts}
