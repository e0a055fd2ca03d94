"""Markers on the robot as seen by a motion capture system, and the file formats."""

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_lab.run import Motion
from rr_opt.array import Array
from rr_opt.model.experiment import CountScale
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError

HEIGHTS = (0.06, 0.07, 0.065, 0.08)
"""m above the floor; all different, so that no two sets of markers can be confused."""

Places = Mapping[str, tuple[float, float, float]]
"""By marker: forward, left and up of P's point on the floor, m, in its platform's axes."""


@dataclass(frozen=True)
class MarkerData:
    """Marker positions: labels (k) and positions (n, k, 3), m, NaN where one was not seen."""

    labels: tuple[str, ...]
    positions: Array
    rate: float


def places(robot: Robot) -> tuple[Places, Places]:
    """Four markers on each platform, in an asymmetric arrangement.

    Platform 1's forward axis goes from P to its axle, platform 2's from its axle to P.
    """
    first = _corners("RR", robot.platform1.c, robot.platform1.b, 1.0)
    second = _corners("RF", robot.platform2.c, robot.platform2.b, -1.0)
    return first, second


def _corners(name: str, c: float, b: float, ahead: float) -> Places:
    spots = ((0.15 * c, 0.5 * b), (0.45 * c, -0.8 * b), (0.9 * c, 0.9 * b), (1.15 * c, -0.6 * b))
    return {
        f"{name}{n + 1}": (round(ahead * x, 4), round(y, 4), HEIGHTS[n])
        for n, (x, y) in enumerate(spots)
    }


def marker_data(
    motion: Motion,
    robot: Robot,
    sigma: float,
    rng: np.random.Generator,
    *,
    tracked: Sequence[float] = (0.0, 0.0),
    missing: float = 0.0,
) -> MarkerData:
    """The markers of a motion with white noise of `sigma` (m) on each coordinate.

    tracked  displacement of platform 1's markers from the layout, m
    missing  fraction of time that each marker is hidden, in gaps of a tenth of a second
    """
    first, second = places(robot)
    parts = [_placed(motion.one, first, tracked), _placed(motion.two, second, (0.0, 0.0))]
    positions = np.concatenate(parts, axis=1)
    positions = positions + sigma * rng.standard_normal(positions.shape)
    rate = 1 / (motion.t[1] - motion.t[0])
    positions[_hidden(rng, positions.shape[:2], missing, rate)] = np.nan
    return MarkerData((*first, *second), positions, rate)


def _placed(pose: Array, spots: Places, moved: Sequence[float]) -> Array:
    """(n, k, 3) of the markers of a body whose joint end is at pose (n, 3)."""
    forward, left, up = (np.array(one) for one in zip(*spots.values(), strict=True))
    forward, left = forward + moved[0], left + moved[1]
    x, y, heading = (part[:, None] for part in pose.T)
    cos, sin = np.cos(heading), np.sin(heading)
    planar = (x + cos * forward - sin * left, y + sin * forward + cos * left)
    return np.stack([*planar, np.broadcast_to(up, planar[0].shape)], axis=2)


def _hidden(
    rng: np.random.Generator, shape: tuple[int, int], missing: float, rate: float
) -> NDArray[np.bool_]:
    long = max(1, round(0.1 * rate))
    blocks = rng.random((shape[0] // long + 1, shape[1])) < missing
    return np.repeat(blocks, long, axis=0)[: shape[0]]


SUBJECT = "Racer"


def vicon_text(markers: MarkerData) -> str:
    """The section `Trajectories`: rate, names, columns and units, then a row for each frame, in mm.

    Frames count from 1; a hidden marker has empty cells.
    """
    names = "".join(f",{SUBJECT}:{label},," for label in markers.labels)
    roles, units = ",X,Y,Z" * len(markers.labels), ",mm,mm,mm" * len(markers.labels)
    lines = [
        "Trajectories",
        f"{markers.rate:.0f}",
        f",{names}",
        f"Frame,Sub Frame{roles}",
        f",{units}",
    ]
    rows = 1000 * markers.positions.reshape(len(markers.positions), -1)
    for frame, row in enumerate(rows, 1):
        cells = ("" if np.isnan(value) else f"{value:.4f}" for value in row)
        lines.append(f"{frame},0,{','.join(cells)}")
    return "\n".join(lines) + "\n"


def c3d_bytes(markers: MarkerData) -> bytes:
    """The bytes of the file, in mm. Raises InputError if ezc3d is not installed."""
    try:
        import ezc3d  # an extra
    except ImportError:
        raise InputError(
            "Cannot write C3D: the package ezc3d is not installed. Install it with: pip install "
            "'rr-opt[lab]', or choose another format."
        ) from None
    file: Any = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [markers.rate]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(markers.labels)
    points = np.ones((4, len(markers.labels), len(markers.positions)))
    points[:3] = 1000 * np.moveaxis(markers.positions, (0, 1, 2), (2, 1, 0))
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
    """Offset up to half a second, drift up to 0.1 per mille."""
    return ServoClock(float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-1e-4, 1e-4)))


def log_text(
    angles: Callable[[Array], tuple[Array, Array]], seconds: float, clock: ServoClock
) -> str:
    """CSV `t,goal,present` of one run, from the log's t = 0.

    angles  command times, s -> the command and the angle of the servo's own shaft, rad: backlash
            behind it is not visible
    """
    own = np.arange(round(seconds * RATE) + 1) / RATE
    goal, present = angles(own / (1 + clock.drift) + clock.offset)
    scale = CountScale()
    counts = (np.rint(scale.zero + angle / scale.each).astype(int) for angle in (goal, present))
    rows = (f"{t:.3f},{one},{two}" for t, one, two in zip(own, *counts, strict=True))
    return "t,goal,present\n" + "\n".join(rows) + "\n"
