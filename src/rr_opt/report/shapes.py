"""What shapes of gait are worth: one answer for each family, side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from rr_opt.answers.quantities import direction_text, number, with_unit
from rr_opt.answers.shapes import ShapesAnswer, family
from rr_opt.answers.speed import SpeedAnswer
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, strict_json, write_json, write_text
from rr_opt.report.document import (
    Badge,
    Cell,
    Document,
    Figure,
    Gallery,
    Section,
    Table,
    checks,
    csv_text,
    table,
)
from rr_opt.report.result import result
from rr_opt.report.text import terminal
from rr_opt.report.webpage import PAGE, write_page
from rr_opt.version import __version__

COLUMNS = ("shape", "status", "speed", "gain", "amplitude", "period", "offset", "inertia_ratio",
           "peak_angle", "peak_rate", "peak_torque", "held_by", "message")  # fmt: skip
RECORD, TABLE, FIGURE = "shapes.json", "shapes.csv", "shapes"


def file_of(answer: SpeedAnswer) -> str:
    """The name of its result file."""
    return "-".join(reversed(family(answer).replace("harmonics", "fourier").split())) + ".json"


def record(compared: ShapesAnswer) -> dict[str, Any]:
    """The content of shapes.json."""
    return {
        "status": compared.status.value,
        "message": compared.message,
        "problem": compared.name,
        "shapes": [
            {**_row(compared, answer), "file": file_of(answer), "result": result(answer)}
            for answer in compared.answers
        ],
        "version": __version__,
        "input_sha256": compared.sha256,
    }


def _row(compared: ShapesAnswer, answer: SpeedAnswer) -> dict[str, Any]:
    """A family in shapes.csv and shapes.json, SI."""
    row: dict[str, Any] = dict.fromkeys(COLUMNS)
    row |= {"shape": family(answer), "status": answer.status.value, "message": answer.message}
    best, replay = answer.optimum.best, answer.replay
    if best and replay:
        row |= {
            "speed": best.speed,
            "gain": compared.gain(answer),
            "amplitude": best.gait.amplitude,
            "period": best.gait.period,
            "offset": best.gait.offset,
            "inertia_ratio": answer.optimum.ratio,
            "peak_angle": replay.reached["angle"],
            "peak_rate": replay.reached["rate"],
            "peak_torque": replay.reached["torque"],
            "held_by": " ".join(_active(answer)),
        }
    return row


def _active(answer: SpeedAnswer) -> list[str]:
    return [row.name for row in answer.limits.values() if row.active] if answer.replay else []


def shapes_document(compared: ShapesAnswer, figures: tuple[Figure, ...] = ()) -> Document:
    """The report of a comparison."""
    results = [(family(one), check) for one in compared.answers for check in one.checks]
    passed = sum(check.passed for _, check in results)
    solved = compared.solved
    title = "Shapes of gait"
    if len(solved) > 1:
        gain = compared.gain(solved[-1]) or 0.0
        title = f"A free gait is {100 * gain:.0f} % faster than the best sine"
    return Document(
        name=compared.name,
        kind="shapes of gait",
        title=title,
        lead=compared.message,
        good=compared.status is Status.OPTIMAL,
        sections=(
            Section("", (Gallery(figures),), brief=False),
            Section("Families", (_families(compared),)),
            Section(
                "Checks",
                (f"{passed} of {len(results)} passed: replay, limits, and a sweep of all sines.",),
            ),
            Section(
                "",
                (checks((check.passed, f"{name}: {check.sentence}") for name, check in results),),
                brief=False,
            ),
        ),
        footer=(f"rr-opt {__version__}", f"input SHA-256 `{compared.sha256}`"),
    )


def _families(compared: ShapesAnswer) -> Table:
    head = ["Shape", "Speed", "Over the sine", "Amplitude", "Period", "J20/J10", "Limited by"]
    rows: list[list[Cell]] = []
    for answer in compared.answers:
        best = answer.optimum.best
        if best is None or answer.status is not Status.OPTIMAL:
            status = Badge(answer.status.value.replace("_", " "))
            rows.append([family(answer), status, *[None] * 5])
            continue
        gain = compared.gain(answer)
        rows.append(
            [
                family(answer),
                f"{1e3 * abs(best.speed):.1f} mm/s {direction_text(best.speed)}",
                f"{100 * gain:+.1f} %" if gain else None,
                with_unit(best.gait.amplitude, "rad"),
                with_unit(best.gait.period, "s"),
                number(answer.optimum.ratio or 0.0),
                ", ".join(_active(answer)) or "no limit",
            ]
        )
    return table(head, rows)


def summary(compared: ShapesAnswer, files: Iterable[Path]) -> str:
    """The comparison as text for a terminal."""
    return terminal(shapes_document(compared), files)


def write_shapes(
    compared: ShapesAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    names = [file_of(answer) for answer in compared.answers]
    remove(folder, (RECORD, TABLE, f"{FIGURE}.svg", PAGE, *names))
    rows = [_row(compared, answer).values() for answer in compared.answers]
    written = [
        write_json(folder / RECORD, record(compared)),
        write_text(folder / TABLE, csv_text(COLUMNS, map(list, rows), digits=12)),
        *(
            write_text(folder / name, strict_json(result(answer)))
            for answer, name in zip(compared.answers, names, strict=True)
        ),
    ]
    if not figures:
        return written
    progress("figures")
    from rr_opt.report.figures.shapes import draw

    drawn = draw(compared)
    caption = (
        "One period of the best gait of each family, under the same limits. Dashed grey: the "
        "sine. Dashed red: the limit on the rate."
    )
    alt = "Angle and rate over a period for each family, and the speed of each"
    title = "The best gait of each family"
    shown = (Figure(FIGURE, title, drawn, alt, caption),) if drawn else ()
    return write_page(folder, shapes_document(compared, shown), written)
