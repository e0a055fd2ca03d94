"""The folder of a solved problem: result.json, the steady cycle, the figures and the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rr_opt.answers.speed import SpeedAnswer
from rr_opt.motion.rollout import one_period
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.result import result
from rr_opt.report.trajectory_file import write_csv

RESULT, TRAJECTORY, PAGE = "result.json", "trajectory.csv", "report.html"
FIGURES = ("speed-map", "path", "cycle", "prices")


def write_results(
    answer: SpeedAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything, result.json first; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RESULT, TRAJECTORY, PAGE, *(f"{name}.svg" for name in FIGURES)))
    written = [write_json(folder / RESULT, result(answer))]
    if answer.replay:
        steady = one_period(answer.replay.steady)
        written.append(write_csv(folder / TRAJECTORY, steady))
    if not figures:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.answer import draw
    from rr_opt.report.page import page

    drawn = draw(answer)
    for name, svg in drawn.items():
        written.append(write_text(folder / f"{name}.svg", svg))
    return [write_text(folder / PAGE, page(answer, drawn)), *written]
