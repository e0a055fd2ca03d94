"""Marker positions and servo logs in the formats that laboratories use."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rr_lab.markers import Seen
from rr_lab.mujoco.drive import servo_angles
from rr_lab.rig import Rig
from rr_lab.run import Outing
from rr_opt.model.experiment import CountScale
from rr_opt.model.gait import Gait
from rr_opt.outcome import InputError

SUBJECT = "Racer"


def vicon_text(seen: Seen) -> str:
    """The section `Trajectories`: its rate, names, columns and units, then a row a frame, in mm.

    Frames count from 1; a marker that was not seen leaves its cells empty.
    """
    names = "".join(f",{SUBJECT}:{label},," for label in seen.labels)
    roles, units = ",X,Y,Z" * len(seen.labels), ",mm,mm,mm" * len(seen.labels)
    lines = [
        "Trajectories",
        f"{seen.rate:.0f}",
        f",{names}",
        f"Frame,Sub Frame{roles}",
        f",{units}",
    ]
    rows = 1000 * seen.positions.reshape(len(seen.positions), -1)
    for frame, row in enumerate(rows, 1):
        cells = ("" if np.isnan(value) else f"{value:.4f}" for value in row)
        lines.append(f"{frame},0,{','.join(cells)}")
    return "\n".join(lines) + "\n"


def c3d_bytes(seen: Seen) -> bytes:
    """The bytes of the file, in mm. Raises InputError if ezc3d is not installed."""
    try:
        import ezc3d  # an extra
    except ImportError:
        raise InputError(
            "C3D cannot be written: the package ezc3d is not installed. Expected it. Install it "
            "with: pip install 'rr-opt[lab]', or take another format."
        ) from None
    file: Any = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [seen.rate]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(seen.labels)
    points = np.ones((4, len(seen.labels), len(seen.positions)))
    points[:3] = 1000 * np.moveaxis(seen.positions, (0, 1, 2), (2, 1, 0))
    file["data"]["points"] = points
    hidden = np.isnan(points[0])
    file["data"]["meta_points"]["residuals"] = np.where(hidden, -1.0, 0.1)[np.newaxis]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "markers.c3d"
        file.write(str(path))
        return path.read_bytes()


RATE = 250.0
"""1/s, of the servo's own clock."""


@dataclass(frozen=True)
class ServoClock:
    """The log's time is (command time - offset) (1 + drift); offset in s."""

    offset: float = 0.0
    drift: float = 0.0


def drawn_clock(rng: np.random.Generator) -> ServoClock:
    """Up to half a second and 0.1 per mille off."""
    return ServoClock(float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-1e-4, 1e-4)))


def log_text(rig: Rig, gait: Gait, outing: Outing, clock: ServoClock) -> str:
    """CSV `t,goal,present` of one run, from the log's t = 0.

    `present` is the angle of the servo's own shaft: play behind it does not show.
    """
    own = np.arange(round(outing.seconds * RATE) + 1) / RATE
    goal, present = servo_angles(rig, gait, outing, own / (1 + clock.drift) + clock.offset)
    scale = CountScale()
    counts = (np.rint(scale.zero + angle / scale.each).astype(int) for angle in (goal, present))
    rows = (f"{t:.3f},{one},{two}" for t, one, two in zip(own, *counts, strict=True))
    return "t,goal,present\n" + "\n".join(rows) + "\n"
