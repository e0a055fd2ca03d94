"""The folder of a turn: as that of any answer, with the turn in result.json and on the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rr_opt.motion.rollout import one_period
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.files import FIGURES, PAGE, RESULT, TRAJECTORY
from rr_opt.report.html import card, table
from rr_opt.report.trajectory_file import write_csv
from rr_opt.report.turn.answer import TurnAnswer
from rr_opt.report.turn.summary import arc_rows, turn_result


def write_turn(
    answer: TurnAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RESULT, TRAJECTORY, PAGE, *(f"{name}.svg" for name in FIGURES)))
    written = [write_json(folder / RESULT, turn_result(answer))]
    if answer.replay:
        written.append(write_csv(folder / TRAJECTORY, one_period(answer.replay.steady)))
    if not figures:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.of_answer import draw  # noqa: PLC0415
    from rr_opt.report.page import page  # noqa: PLC0415

    drawn = draw(answer)
    for name, svg in drawn.items():
        written.append(write_text(folder / f"{name}.svg", svg))
    rows = [[name.strip(), text] for name, text in arc_rows(answer)]
    first = card("Turn", table(["Quantity", "Value"], rows)) if rows else ""
    return [write_text(folder / PAGE, page(answer, drawn, first)), *written]
