"""The report of a simulated motion: its trajectory, its figure, and on request a film."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rr_opt.documents.archive import folder_for_results, remove, write_text
from rr_opt.documents.document import Fact, facts_alone
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.documents.texts import captions
from rr_opt.formatting import number, speed_text
from rr_opt.report.gait import gait_facts
from rr_opt.report.trajectory_file import netcdf_writer, trajectory_csv, write_netcdf
from rr_opt.results.motion import Film, Format, SimulatedMotion


def record(motion: SimulatedMotion) -> dict[str, Any]:
    """Distance, turn, speed and torque, SI."""
    driven, measured = motion.trajectory, motion.measured
    return {
        "gait": motion.gait,
        "status": motion.source_status,
        "start": motion.start,
        "seconds": driven.t[-1],
        "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
        "turned": driven.psi[-1] - driven.psi[0],
        "last_speed": measured.mean_v,
        "last_circle_speed": measured.speed,
        "peak_torque": measured.peak_torque,
    }


def _facts(motion: SimulatedMotion) -> Iterator[Fact]:
    data, measured = record(motion), motion.measured
    begun = "rest" if motion.start == "rest" else "the steady state"
    degrees = number(math.degrees(data["turned"]))
    mean = f"{speed_text(measured.mean_v)}, mean v of axle 1"
    yield from gait_facts(motion.gait)
    yield Fact("time", f"{number(data['seconds'])} s from {begun}")
    yield Fact("moved", f"{number(data['distance'])} m, turned by {degrees} deg")
    if measured.speed is None:
        yield Fact("speed", f"{mean}, less than a period")
    else:
        circle = f"{speed_text(measured.speed)}, along the mean circle of the last period"
        yield Fact("speed", circle)
        yield Fact("", f"{mean} over the last period")
    yield Fact("torque", f"{number(measured.peak_torque)} N m at most")


class _Report(Report):
    def save(
        self,
        result: SimulatedMotion,
        path: str | Path,
        *,
        progress: Progress = quiet,
        format: Format = "csv",
        film: Film | None = None,
        **options: Any,
    ) -> list[Path]:
        """Write the trajectory, the figure and the film; there is no page."""
        check_files(format, film)
        folder = folder_for_results(Path(path))
        films = [f"motion.{kind}" for kind in ("gif", "mp4")]
        remove(folder, ("trajectory.csv", "trajectory.nc", "motion.svg", *films))
        if format == "csv":
            written = [write_text(folder / "trajectory.csv", trajectory_csv(result.trajectory))]
        else:
            written = [write_netcdf(folder / "trajectory.nc", result.trajectory)]
        for one in self.drawn(result, progress):
            written.append(write_text(folder / f"{one.name}.svg", one.svg))
        if film:
            from rr_opt.report.film import write_film

            place = folder / f"motion.{film}"
            written.append(write_film(place, result.robot, result.trajectory, film, progress))
        return written


def check_files(format: Format, film: Film | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if format == "netcdf":
        netcdf_writer()
    if film:
        from rr_opt.report.film import check_film

        check_film(film)


REPORT = _Report(
    record,
    lambda motion, _: facts_alone(_facts(motion)),
    figures="rr_opt.report.figures.motion",
    captions=captions("motion"),
)
