"""Folders with recordings of a robot that is as believed, to be spoilt."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import rollout
from tests.robots import BENCHMARK

Array = NDArray[np.float64]

GAITS = ((0.5, 1.0, 0.0), (0.7, 1.4, 0.1), (0.4, 1.2, -0.1))
SIGMA = (1e-3, 1e-3, 3e-3, 3e-3)
COLUMNS = ("x", "y", "psi", "phi")
HEAD = """
robot:
  platform1: {m: 0.469, I: 0.00386, c: 0.236, a: 0.05, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.25, I: 0.001158, c: 0.0941, a: 0.05, b: 0.05, kappa: 2.0e-5}
  h: 0.02
noise: {position: 0.001, angle: 0.003}
recordings:
"""


@lru_cache
def recorded(number: int, seconds: float = 8.0) -> Array:
    """t, x, y, psi, phi (n, 5) of a run, 100 samples a second, by CVODES and with noise."""
    driven = rollout(BENCHMARK, SineGait(*GAITS[number]), seconds, "steady", 100)
    rng = np.random.default_rng(number)
    clean = np.column_stack([driven.x, driven.y, driven.psi, driven.phi])
    return np.column_stack([driven.t, clean + SIGMA * rng.normal(size=clean.shape)])


def written(
    folder: Path,
    spoil: Callable[[Array], Array] = lambda table: table,
    *,
    uses: Sequence[str] = ("fit", "fit", "holdout"),
    gaits: Sequence[tuple[float, float, float]] = GAITS,
    start: str = "running",
) -> Path:
    """A folder with a run for each of `uses`, every recording spoilt."""
    folder.mkdir(exist_ok=True)
    text = HEAD
    for k, (use, (amplitude, period, offset)) in enumerate(zip(uses, gaits, strict=False)):
        gait = f"{{amplitude: {amplitude}, period: {period}, offset: {offset}}}"
        text += f"  - {{file: run{k}.csv, gait: {gait}, use: {use}, start: {start}}}\n"
        lines = [
            ",".join("" if np.isnan(cell) else f"{cell:.6f}" for cell in row)
            for row in spoil(recorded(k).copy())
        ]
        (folder / f"run{k}.csv").write_text("\n".join(["t,x,y,psi,phi", *lines, ""]))
    (folder / "experiment.yaml").write_text(text)
    return folder
