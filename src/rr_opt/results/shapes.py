"""The benefit of other waveforms: the fastest gait of each family, side by side."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from rr_opt.design.maximize_speed import Optimum
from rr_opt.documents import document as doc
from rr_opt.documents.archive import strict_json
from rr_opt.files.record import plain
from rr_opt.formatting import QUANTITIES, direction_text, number, with_unit
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Check, Result

MISSED = 1e-4
"""A family that is slower than one it contains by more than this, relative, missed an optimum;
smaller differences are solver tolerance."""


@dataclass(frozen=True, repr=False)
class FastestShapes(Result):
    """The fastest gait of each family of waveforms under the same limits.

    answers   a FastestGait for the sine, 3 and 5 harmonics, and a free gait: each family contains
              the one before
    """

    FILE = "shapes.json"
    OTHERS = ("shapes.csv", "sine.json", "fourier-3.json", "fourier-5.json", "free.json")
    DRAW = "rr_opt.results.figures.fastest.draw_shapes"
    CAPTIONS = doc.captions("shapes")

    name: str
    sha256: str
    answers: tuple[FastestGait, ...]

    @property
    def solved(self) -> list[FastestGait]:
        """Those with a confirmed optimum."""
        return [one for one in self.answers if one.status is Status.OPTIMAL]

    @property
    def status(self) -> Status:
        """The worst status of all."""
        order = [Status.NOT_CONVERGED, Status.INFEASIBLE, Status.OPTIMAL]
        return min((one.status for one in self.answers), key=order.index)

    @property
    def checks(self) -> list[Check]:
        """The checks of all families."""
        return [check for one in self.answers for check in one.checks]

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings of any family, as all share one robot."""
        return self.answers[0].warnings

    def gain(self, answer: FastestGait) -> float | None:
        """Speed over the sine's, less 1; None if either has no gait."""
        speed, sine = answer.speed, self.answers[0].speed
        return None if speed is None or sine is None else abs(speed) / abs(sine) - 1

    @property
    def message(self) -> str:
        """How much faster than a sine the other waveforms are, in a sentence."""
        failed = [
            f"{family(one)}: {one.message}"
            for one in self.answers
            if one.status is not Status.OPTIMAL
        ]
        solved = [(one, abs(one.speed)) for one in self.solved if one.speed is not None]
        if failed or len(solved) < 2:
            return " ".join(failed)
        words = {"free": "a free gait", "sine": "a sine"}
        speeds = ", ".join(
            f"{1e3 * speed:.1f} mm/s with {words.get(family(one), family(one))}"
            for one, speed in solved
        )
        gain = 100 * (solved[-1][1] / solved[0][1] - 1)
        text = f"Under the same limits {speeds}: {gain:.1f} % more than the best sine."
        for (smaller, slow), (larger, fast) in pairwise(solved):
            if fast < slow * (1 - MISSED):
                text += (
                    f" But {family(larger)} came out slower than {family(smaller)}, which it "
                    "contains: a better gait was missed."
                )
        return text

    def _record(self) -> dict[str, Any]:
        return {
            "status": self.status.value,
            "message": self.message,
            "problem": self.name,
            "shapes": [
                {**plain(_row(self, one)), "file": _file(one), "result": one.record()}
                for one in self.answers
            ],
        }

    def _tables(self) -> dict[str, str]:
        """shapes.csv, and the record of each family."""
        rows = [_row(self, one) for one in self.answers]
        kinds = {name: QUANTITIES.get(name.removeprefix("peak_")) for name in rows[0]}
        head = [doc.heading(name, kind.unit if kind else "") for name, kind in kinds.items()]
        text = doc.csv_text(head, [list(row.values()) for row in rows], digits=12)
        return {"shapes.csv": text} | {_file(o): strict_json(o.record()) for o in self.answers}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The families side by side, and every check."""
        results = [(family(one), check) for one in self.answers for check in one.checks]
        passed = sum(check.passed for _, check in results)
        every = doc.checks((check.passed, f"{name}: {check.sentence}") for name, check in results)
        count = f"{passed} of {len(results)} passed: replay, limits, and a sweep of all sines."
        title, solved = "Waveforms", self.solved
        if len(solved) > 1 and solved[0] is self.answers[0]:
            gain, best = self.gain(solved[-1]) or 0.0, family(solved[-1])
            what = "A free gait" if best == "free" else f"A gait of {best}"
            title = f"{what} is {100 * gain:.0f} % faster than the best sine"
        sections = (
            doc.gallery(figures),
            doc.section("Families", _families(self)),
            doc.section("Checks", count),
            doc.section("", every, brief=False),
        )
        return self._outcome("waveforms", title, title, *sections, lead=self.message)


def family(answer: FastestGait | Optimum) -> str:
    """`sine`, `3 harmonics` or `free`."""
    gait = answer.problem.gait
    return f"{gait.harmonics} harmonics" if gait.shape == "fourier" else gait.shape


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
