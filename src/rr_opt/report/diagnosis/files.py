"""The folder of a diagnosis: the record, the corrected robot, the figures and the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rr_opt import __version__
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.diagnosis.corrected import robot_yaml
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.diagnosis.record import record
from rr_opt.report.diagnosis.words import headline

RECORD, ROBOT, PAGE = "diagnosis.json", "robot-corrected.yaml", "report.html"
FIGURES = ("evidence", "paths", "bands", "misfit", "residue", "loss")


def write_diagnosis(
    one: Diagnosed, folder: Path, *, page: bool, progress: Callable[[str], object]
) -> list[Path]:
    """Write everything; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RECORD, ROBOT, PAGE, *(f"{name}.svg" for name in FIGURES)))
    progress("the best gait, as believed and as found")
    title = f"{headline(one.found)}.\nFrom {one.name} by rr-opt {__version__} diagnose."
    written = [
        write_json(folder / RECORD, record(one)),
        write_text(folder / ROBOT, robot_yaml(one.corrected, title)),
    ]
    if not page:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.diagnosis.page import page as page_of  # noqa: PLC0415
    from rr_opt.report.figures.diagnosis.of_diagnosis import draw  # noqa: PLC0415

    drawn, told = draw(one)
    written += [write_text(folder / f"{name}.svg", text) for name, text in drawn.items()]
    return [write_text(folder / PAGE, page_of(one, drawn, told)), *written]
