"""The folder of a plain sweep: every gait tried, the best of them, and the figure."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt import __version__
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.quantities import direction_text, number, speed_text
from rr_opt.report.result import gait_record
from rr_opt.report.text import columns, gait_lines
from rr_opt.verify.sweep import Gaits

_NAMES = ("sweep.json", "sweep.csv", "sweep.svg")
_COLUMNS = ("amplitude", "period", "offset", "ratio", "speed", "peak_torque", "allowed")


@dataclass(frozen=True)
class Swept:
    """A sweep of a problem: its gaits, and what it is told by. `name` and `sha256` of the input."""

    name: str
    sha256: str
    gaits: Gaits

    @property
    def best(self) -> int | None:
        """Index of the fastest gait that keeps every limit."""
        return self.gaits.best()

    @property
    def status(self) -> Status:
        """INFEASIBLE if no gait of the sweep is allowed; a sweep never proves an optimum."""
        return Status.INFEASIBLE if self.best is None else Status.OPTIMAL

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.best is None:
            return f"None of the {len(self.gaits)} gaits tried keeps every limit."
        speed = float(self.gaits.speed[self.best])
        return (
            f"The fastest of {len(self.gaits)} gaits drives {direction_text(speed)} at "
            f"{abs(speed):.4f} m/s."
        )


def record(swept: Swept) -> dict[str, Any]:
    """The content of sweep.json, SI."""
    gaits, best = swept.gaits, swept.best
    return {
        "status": "swept" if best is not None else swept.status.value,
        "message": swept.message,
        "problem": swept.name,
        "points": len(gaits),
        "allowed": int(gaits.allowed.sum()),
        "gait": gait_record(gaits.gait(best)) if best is not None else None,
        "inertia_ratio": float(gaits.ratio[best]) if best is not None else None,
        "speed": float(gaits.speed[best]) if best is not None else None,
        "peak_torque": float(gaits.peak_torque[best]) if best is not None else None,
        "version": __version__,
        "input_sha256": swept.sha256,
    }


def summary(swept: Swept, files: list[Path]) -> str:
    """The sweep as text for a terminal."""
    gaits, best = swept.gaits, swept.best
    rows: list[tuple[str, ...]] = []
    if best is not None:
        rows = [
            ("gait", "phi(t) = amplitude sin(2 pi t/period) + offset"),
            *gait_lines(gaits.gait(best)),
            ("  J20/J10", number(float(gaits.ratio[best]))),
            ("speed", speed_text(float(gaits.speed[best]))),
            ("torque", f"{number(float(gaits.peak_torque[best]))} N m at most"),
        ]
    rows += [("files" if not i else "", str(file)) for i, file in enumerate(files)]
    head = f"{swept.name}: {swept.message}" if best is not None else f"{swept.name}: infeasible"
    return "\n".join([head, "", *columns(rows)]) + "\n"


def write_sweep(swept: Swept, folder: Path) -> list[Path]:
    """Write everything; what an earlier sweep left is removed before."""
    from rr_opt.report.figures.of_sweep import draw  # noqa: PLC0415

    remove(folder, _NAMES)
    gaits = swept.gaits
    table = np.column_stack([np.asarray(getattr(gaits, name), float) for name in _COLUMNS])
    text = io.StringIO()
    form = ["%.9g"] * (len(_COLUMNS) - 1) + ["%d"]
    np.savetxt(text, table, fmt=form, delimiter=",", header=",".join(_COLUMNS), comments="")
    return [
        write_json(folder / "sweep.json", record(swept)),
        # A gait without a steady cycle has no speed: an empty cell.
        write_text(folder / "sweep.csv", text.getvalue().replace("nan", "")),
        write_text(folder / "sweep.svg", draw(gaits)),
    ]
