"""The report of a turn: that of a fastest gait, with its arc."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from rr_opt.design.turn import Arc
from rr_opt.documents import document as doc
from rr_opt.documents.texts import captions
from rr_opt.files.record import plain
from rr_opt.formatting import number, side_text, with_unit
from rr_opt.report import fastest
from rr_opt.results.turn import FastestTurn

UNITS = {
    "heading": "rad, positive to the left",
    "curvature": "1/m, heading per metre of the mean circle",
    "yaw_rate": "rad/s",
    "length": "m, along the mean circle",
    "time": "s",
    "price of curvature, yaw_rate, heading": "m/s of |speed| per SI unit by which it is raised",
}


def turn_document(turn: FastestTurn, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The report of a fastest gait, with its arc."""
    facts = tuple(_facts(turn, turn.arc)) if turn.arc else ()
    report = fastest.fastest_document(turn, figures, doc.Section("Turn", (doc.Facts(facts),)))
    return replace(report, kind="fastest turn")


def turn_record(turn: FastestTurn) -> dict[str, Any]:
    """The content of result.json: that of any fastest gait, and `turn`."""
    record, target, circle = fastest.fastest_record(turn), turn.target, turn.circle
    own = {
        "asked": {
            "heading": target.heading,
            "radius": target.radius,
            "within": target.within,
            "length": target.length,
            "cycles": "whole" if target.whole else "any",
        },
        "offset_opened": turn.opened,
        "arc": turn.arc and {**plain(turn.arc), "radius": turn.radius},
        "prices": turn.turn_prices,
        "circle_check": circle
        and {
            "ends": circle.ends,
            "mean": circle.mean,
            "rest": circle.rest,
            "rest_periods": circle.periods,
            "time_constant": circle.transient.constant,
            "distance_lost": circle.transient.lost,
            "delay": circle.transient.delay,
        },
    }
    return record | {"turn": plain(own), "units": {**record["units"], **UNITS}}


def _facts(turn: FastestTurn, arc: Arc) -> Iterator[doc.Fact]:
    """The arc, or the full circle, and what a slightly easier turn would gain."""
    name = "circle" if turn.target.heading is None else "arc"
    degrees = abs(math.degrees(arc.heading))
    yield doc.Fact(name, f"{number(degrees)} deg to the {side_text(arc.heading)}")
    yield doc.Fact("radius", with_unit(turn.radius or math.inf, "m"))
    periods = f"{number(arc.periods, 6)} periods, steady motion"
    yield doc.Fact("time", with_unit(arc.time, "s"), periods)
    yield doc.Fact("length", f"{with_unit(arc.length, 'm')} along the mean circle")
    yield doc.Fact("yaw rate", f"{number(math.degrees(arc.yaw_rate))} deg/s")
    asked = {
        "curvature": (arc.curvature, "a radius 1 % wider"),
        "yaw_rate": (arc.yaw_rate, "a yaw rate 1 % lower"),
        "heading": (arc.heading / arc.periods, "a heading per period 1 % less"),
    }
    for name, price in turn.turn_prices.items():
        value, words = asked[name]
        gain = -0.01 * value * price
        if abs(gain) > 1e-9:
            yield doc.Fact("price", f"{1e3 * gain:+.3g} mm/s for {words}")


REPORT = replace(
    fastest.REPORT,
    record=turn_record,
    document=turn_document,
    figures="rr_opt.report.figures.turn",
    captions={**fastest.REPORT.captions, **captions("turn")},
)
