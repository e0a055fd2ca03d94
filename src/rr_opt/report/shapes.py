"""What shapes of gait are worth: one answer for each family, beside one another."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable
from html import escape
from pathlib import Path
from typing import Any

from rr_opt.answers.quantities import direction_text, number, speed_text, with_unit
from rr_opt.answers.shapes import ShapesAnswer, family
from rr_opt.answers.speed import SpeedAnswer
from rr_opt.outcome import Status
from rr_opt.report.archive import remove, strict_json, write_json, write_text
from rr_opt.report.html import Badge, Cell, card, document, figure
from rr_opt.report.html import table as html_table
from rr_opt.report.result import result
from rr_opt.report.text import columns
from rr_opt.version import __version__

COLUMNS = ("shape", "status", "speed", "gain", "amplitude", "period", "offset", "inertia_ratio",
           "peak_angle", "peak_rate", "peak_torque", "held_by", "message")  # fmt: skip


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
            {**row, "file": file_of(answer), "result": result(answer)}
            for row, answer in zip(_rows(compared), compared.answers, strict=True)
        ],
        "version": __version__,
        "input_sha256": compared.sha256,
    }


def table(compared: ShapesAnswer) -> str:
    """shapes.csv: a row for each family, SI."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([row[name] for name in COLUMNS] for row in _rows(compared))
    return text.getvalue()


def _rows(compared: ShapesAnswer) -> list[dict[str, Any]]:
    rows = []
    for answer in compared.answers:
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
                "held_by": held_by(answer),
            }
        rows.append(row)
    return rows


def held_by(answer: SpeedAnswer) -> str:
    """The limits that the optimum stands on."""
    if answer.replay is None:
        return ""
    return " ".join(row.name for row in answer.limits.values() if row.active)


def summary(compared: ShapesAnswer, files: Iterable[Path]) -> str:
    """The comparison as text for a terminal."""
    rows: list[tuple[str, ...]] = [
        ("shape", "speed", "", "over the sine", "amplitude", "period", "held by")
    ]
    for answer in compared.answers:
        best = answer.optimum.best
        if best is None or answer.status is not Status.OPTIMAL:
            rows.append((f"  {family(answer)}", answer.status.value.replace("_", " "), *[""] * 5))
            continue
        gain = compared.gain(answer)
        rows.append(
            (
                f"  {family(answer)}",
                speed_text(best.speed),
                direction_text(best.speed),
                "" if answer is compared.answers[0] or gain is None else _percent(1 + gain),
                f"{number(best.gait.amplitude)} rad",
                f"{number(best.gait.period)} s",
                held_by(answer),
            )
        )
    checks = sum(len(answer.checks) for answer in compared.answers)
    passed = sum(check.passed for answer in compared.answers for check in answer.checks)
    blocks = [
        [f"{compared.name}: {compared.message}"],
        columns(rows),
        [f"checks  {passed} of {checks} passed: replay, limits, and a sweep of all sines"],
        columns([("files" if not i else "", str(file)) for i, file in enumerate(files)]),
    ]
    return "\n\n".join("\n".join(block) for block in blocks) + "\n"


def _percent(ratio: float) -> str:
    gain = 100 * (ratio - 1)
    return f"{gain:+.1f} %" if math.isfinite(gain) else "-"


_CAPTION = (
    "One period of the best gait of each family, under the same limits. Dashed grey: the sine. "
    "Dashed red: the limit on the rate."
)


def page(compared: ShapesAnswer, drawn: str) -> str:
    """The whole page; drawn: the figure as SVG text."""
    good = compared.status is Status.OPTIMAL
    title = _verdict(compared)
    body = [
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(compared.name)} · shapes of gait</p><h1>{escape(title)}</h1>"
        f'<p class="lead">{escape(compared.message)}</p></header>',
        figure(drawn, "The best gait of each family", _CAPTION) if drawn else "",
        card("Families", _families(compared)),
        card("Checks", _checks(compared)),
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(compared.sha256)}</code></footer>",
    ]
    return document(f"{compared.name}: {title}", body)


def _verdict(compared: ShapesAnswer) -> str:
    solved = compared.solved
    if len(solved) < 2:
        return "Shapes of gait"
    gain = compared.gain(solved[-1]) or 0.0
    return f"A free gait is {100 * gain:.0f} % faster than the best sine"


def _families(compared: ShapesAnswer) -> str:
    head = ["Shape", "Speed", "Over the sine", "Amplitude", "Period", "J20/J10", "Held by"]
    rows: list[list[Cell]] = []
    for answer in compared.answers:
        best = answer.optimum.best
        if best is None:
            status = Badge(answer.status.value.replace("_", " "), "no")
            rows.append([family(answer), status, *["–"] * 5])
            continue
        speed, gain = answer.speed or 0.0, compared.gain(answer)
        rows.append(
            [
                family(answer),
                f"{1e3 * abs(speed):.1f} mm/s {direction_text(speed)}",
                f"{100 * gain:+.1f} %" if gain else "–",
                with_unit(best.gait.amplitude, "rad"),
                with_unit(best.gait.period, "s"),
                number(answer.optimum.ratio or 0.0),
                held_by(answer).replace(" ", ", ") or "nothing",
            ]
        )
    return html_table(head, rows)


def _checks(compared: ShapesAnswer) -> str:
    items = "".join(
        f'<li class="{"" if check.passed else "bad"}">'
        f"{escape(family(answer))}: {escape(check.sentence)}</li>"
        for answer in compared.answers
        for check in answer.checks
    )
    return f'<ul class="checks">{items}</ul>' if items else ""


RECORD, TABLE, FIGURE, PAGE = "shapes.json", "shapes.csv", "shapes.svg", "report.html"


def write_shapes(
    compared: ShapesAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    names = [file_of(answer) for answer in compared.answers]
    remove(folder, (RECORD, TABLE, FIGURE, PAGE, *names))
    written = [
        write_json(folder / RECORD, record(compared)),
        write_text(folder / TABLE, table(compared)),
    ]
    for answer, name in zip(compared.answers, names, strict=True):
        written.append(write_text(folder / name, strict_json(result(answer))))
    if not figures:
        return written
    progress("figures")
    drawn = draw(compared)
    if drawn:
        written.insert(0, write_text(folder / FIGURE, drawn))

    return [write_text(folder / PAGE, page(compared, drawn)), *written]


def draw(compared: ShapesAnswer) -> str:
    """The figure as SVG text; empty if no family has an optimum."""
    from rr_opt.report.figures.shapes import Line, shapes
    from rr_opt.report.figures.style import figure, styled, svg

    lines = [
        Line(family(one), one.optimum.best.gait, one.speed or 0.0, compared.gain(one) or 0.0)
        for one in compared.solved
        if one.optimum.best
    ]
    if not lines:
        return ""
    with styled():
        drawn = figure(8.6, 4.2)
        axes = drawn.subplot_mosaic([["angle", "speed"], ["rate", "speed"]], width_ratios=[1.1, 1])
        in_order = [axes[name] for name in ("angle", "rate", "speed")]
        shapes(in_order, lines, compared.answers[0].optimum.problem.limits.rate)
        return svg(drawn)
