"""Marker positions as C3D, written by the library ezc3d."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.lab.markers import Seen
from rr_opt.outcome import InputError


def c3d_bytes(seen: Seen) -> bytes:
    """The bytes of the file, in mm. Raises InputError if ezc3d is not installed."""
    try:
        import ezc3d  # noqa: PLC0415 - an extra
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
