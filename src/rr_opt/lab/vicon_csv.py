"""Marker positions as the CSV that Vicon Nexus exports."""

from __future__ import annotations

import numpy as np

from rr_opt.lab.markers import Seen

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
