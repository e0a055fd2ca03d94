"""The report of the waveforms: a row for each family, in a table, as CSV, and in full as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.archive import strict_json
from rr_opt.documents.report import Report
from rr_opt.documents.texts import captions
from rr_opt.files.record import plain
from rr_opt.formatting import direction_text, number, with_unit
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.shapes import FastestShapes, family


def record(result: FastestShapes) -> dict[str, Any]:
    """The content of shapes.json: each row of shapes.csv with the whole result."""
    return {
        "status": result.status.value,
        "message": result.message,
        "problem": result.name,
        "shapes": [
            {**plain(_row(result, one)), "file": _file(one), "result": one.record()}
            for one in result.answers
        ],
    }


def tables(result: FastestShapes) -> dict[str, str]:
    """shapes.csv, and the record of each family."""
    rows = [_row(result, one) for one in result.answers]
    text = doc.csv_text(list(rows[0]), [list(row.values()) for row in rows], digits=12)
    return {"shapes.csv": text} | {_file(o): strict_json(o.record()) for o in result.answers}


def _row(result: FastestShapes, answer: FastestGait) -> dict[str, Any]:
    gait, replay = answer.gait, answer.replay
    solved = gait is not None and replay is not None
    reached = replay.reached if replay else {}
    return {
        "shape": family(answer),
        "status": answer.status.value,
        "speed": answer.speed if solved else None,
        "gain": result.gain(answer) if solved else None,
        **{name: getattr(gait, name, None) for name in ("amplitude", "period", "offset")},
        "inertia_ratio": answer.inertia_ratio if solved else None,
        **{f"peak_{name}": reached.get(name) for name in ("angle", "rate", "torque")},
        "held_by": " ".join(answer.active) if solved else None,
        "message": answer.message,
    }


def _file(answer: FastestGait) -> str:
    """The name of its result file: `fourier-3.json`."""
    return "-".join(reversed(family(answer).replace("harmonics", "fourier").split())) + ".json"


def document(result: FastestShapes, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The families side by side, and every check."""
    results = [(family(one), check) for one in result.answers for check in one.checks]
    passed = sum(check.passed for _, check in results)
    every = doc.checks((check.passed, f"{name}: {check.sentence}") for name, check in results)
    count = f"{passed} of {len(results)} passed: replay, limits, and a sweep of all sines."
    title = "Waveforms"
    if len(result.solved) > 1:
        gain = result.gain(result.solved[-1]) or 0.0
        title = f"A free gait is {100 * gain:.0f} % faster than the best sine"
    return doc.Document(
        name=result.name,
        kind="waveforms",
        title=title,
        lead=result.message,
        good=result.status is Status.OPTIMAL,
        sections=(
            doc.gallery(figures),
            doc.Section("Families", (_families(result),)),
            doc.Section("Checks", (count,)),
            doc.Section("", (every,), brief=False),
        ),
        footer=doc.versions(result.sha256),
    )


def _families(result: FastestShapes) -> doc.Table:
    head = ["Shape", "Speed", "Gain over the sine", "Amplitude", "Period", "J20/J10", "Limited by"]
    rows = []
    for one in result.answers:
        gait, speed, gain = one.gait, one.speed, result.gain(one)
        if gait is None or speed is None or one.status is not Status.OPTIMAL:
            rows.append([family(one), doc.Badge(one.status.words), *[None] * 5])
            continue
        rows.append(
            [
                family(one),
                f"{1e3 * abs(speed):.1f} mm/s {direction_text(speed)}",
                f"{100 * gain:+.1f} %" if gain else None,
                with_unit(gait.amplitude, "rad"),
                with_unit(gait.period, "s"),
                number(one.inertia_ratio or 0.0),
                ", ".join(one.active) or "no limit",
            ]
        )
    return doc.table(head, rows)


REPORT = Report(
    record,
    document,
    "shapes.json",
    tables=tables,
    others=("shapes.csv", "sine.json", "fourier-3.json", "fourier-5.json", "free.json"),
    figures="rr_opt.report.figures.shapes",
    captions=captions("shapes"),
)
