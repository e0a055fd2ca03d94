"""The results of a study: solved cases, or driven routes."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.design.study.plan import branches, plan
from rr_opt.design.study.row import Row
from rr_opt.documents import document as doc
from rr_opt.documents.archive import netcdf_writer, strict_json
from rr_opt.files.route_file import RouteStudy
from rr_opt.files.study_file import Study
from rr_opt.formatting import direction_text, number, speed_text, with_unit
from rr_opt.messages import listed
from rr_opt.outcome import Status
from rr_opt.results.gait import ignored_effects
from rr_opt.results.limits import slippery
from rr_opt.results.motion import beyond_servo
from rr_opt.results.result import Progress, Result, quiet
from rr_opt.results.study_table import (
    StudyColumn,
    axis_words,
    held_words,
    setting_text,
    study_columns,
    value_text,
    write_netcdf,
)

_SAME_SPEED = 1e-8
"""Cases whose speeds differ by less, relative, count as equally fast."""


class _Study(Result):
    """The result of each case of a study: a row, and its status."""

    FILE = "study.json"

    study: Any

    @property
    def name(self) -> str:
        """Name of the study."""
        return self.study.name

    @property
    def sha256(self) -> str:
        """The fingerprint of its files."""
        return self.study.sha256

    @property
    def _statuses(self) -> list[Status]:
        """Of each row."""
        raise NotImplementedError

    @property
    def counts(self) -> dict[Status, int]:
        """Number of rows by status."""
        counted = Counter(self._statuses)
        return {status: counted[status] for status in Status}

    @property
    def status(self) -> Status:
        """OPTIMAL if any case has an optimum; else INFEASIBLE if no case has a feasible gait."""
        return Status.of_cases(self.counts)

    def _record(self) -> dict[str, Any]:
        return {
            "status": "studied",
            "message": self.message,
            "study": self.name,
            "counts": {status.value: count for status, count in self.counts.items()},
        }


@dataclass(frozen=True, repr=False)
class SolvedStudy(_Study):
    """A study with all its rows.

    rows  one for each case, in the order of `study.problems`; `row.optimum` is None if there is
          none, and `row.message` says why
    """

    OTHERS = ("study.csv", "study.nc")
    DRAW = "rr_opt.results.figures.study.draw"
    CAPTIONS = doc.captions("study")

    study: Study
    rows: tuple[Row, ...]

    @property
    def _statuses(self) -> list[Status]:
        return [row.status for row in self.rows]

    @cached_property
    def branches(self) -> tuple[int | None, ...]:
        """The number of each case's branch of optima, or None."""
        adjacent = plan([axis.numbers for axis in self.study.axes], self.study.shape).adjacent
        return tuple(branches(self.rows, adjacent))

    def values(self, name: str) -> Array:
        """A quantity of every optimum by its name in `row.optimum`, nan if there is none."""
        return np.array(
            [np.nan if row.optimum is None else getattr(row.optimum, name) for row in self.rows],
            float,
        )

    @property
    def speed(self) -> Array:
        """|speed| of every case, m/s; nan where there is no optimum."""
        return np.abs(self.values("speed"))

    @property
    def fastest(self) -> int | None:
        """The index of the case with the fastest optimum; of equally fast ones the first."""
        speed = self.speed
        if np.isnan(speed).all():
            return None
        return int(np.flatnonzero(speed >= np.nanmax(speed) * (1 - _SAME_SPEED))[0])

    def front(self, cost: str) -> list[int]:
        """The Pareto-optimal cases in cost and speed, cheapest first.

        cost: name of the quantity in `row.optimum`
        """
        costs, speed = self.values(cost), self.speed
        best, kept = -np.inf, []
        for case in np.lexsort((-speed, costs)):
            if np.isfinite(costs[case]) and speed[case] > best:
                kept.append(int(case))
                best = speed[case]
        return kept

    def value_texts(self, case: int) -> list[str]:
        """The values of a case, one text for each axis."""
        inputs = self.study.inputs(case)
        texts = [
            [value_text(line.key, inputs[line.key.name]) for line in axis.lines]
            for axis in self.study.axes
        ]
        return [" and ".join(dict.fromkeys(several)) for several in texts]

    def inputs_text(self, case: int) -> str:
        """`rate limit 30 rpm, direction forward`."""
        words = map(axis_words, self.study.axes)
        return ", ".join(map(setting_text, words, self.value_texts(case)))

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        best = self.fastest
        if best is None:
            return f"None of the {len(self.rows)} cases has an optimum."
        speed = float(self.values("speed")[best])
        return (
            f"The fastest of {len(self.rows)} cases drives {direction_text(speed)} at "
            f"{1e3 * abs(speed):.1f} mm/s ({self.inputs_text(best)})."
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the study ignores, the demands of the fastest case on servo
        and floor, and how many cases have no optimum."""
        words = {
            Status.INFEASIBLE: "no gait that respects all limits",
            Status.NOT_CONVERGED: "no optimum that the solver could confirm",
        }
        counts = self.counts
        without = (
            f"{counts[status]} of {len(self.rows)} cases: {text}. Their rows give the reasons."
            for status, text in words.items()
            if counts[status]
        )
        robot = self.study.problems[0].robot
        return (*ignored_effects(robot), *self._asks_much(), *without)

    def _asks_much(self) -> Iterator[str]:
        """The servo's limits that the fastest case exceeds, and grip that floors rarely have."""
        if self.fastest is None:
            return
        best = self.rows[self.fastest].optimum
        assert best is not None
        servo = self.study.problems[self.fastest].robot.servo
        if beyond := beyond_servo(servo, best.peak_angle, best.peak_rate, best.peak_torque):
            yield (
                "The problem allows more than the robot's servo does: the fastest case exceeds its "
                f"{listed(name for name, *_ in beyond)} limit."
            )
        yield from slippery(best.peak_grip)

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: bool = False,
    ) -> list[Path]:
        """Write study.csv, study.json and, if asked for, study.nc, with figures and page."""
        if netcdf:
            netcdf_writer()  # fails early if not installed
        written = super().save(path, figures=figures, progress=progress)
        if netcdf:
            written.append(write_netcdf(Path(path) / "study.nc", self.study, self._columns))
        return written

    @cached_property
    def _columns(self) -> list[StudyColumn]:
        fronts = {name: self.front(name) for name in COSTS}
        return study_columns(self.study, self.rows, self.branches, fronts)

    def _tables(self) -> dict[str, str]:
        rows = zip(*(column.in_table for column in self._columns), strict=True)
        names = [column.heading for column in self._columns]
        return {"study.csv": doc.csv_text(names, rows, digits=12)}

    def _record(self) -> dict[str, Any]:
        """The content of study.json, SI: the table's columns row by row, and the gaits."""
        columns = self._columns
        cases = ({c.name: c.cells[k] for c in columns} for k in range(len(self.rows)))
        return super()._record() | {
            "varied": [[line.key.name for line in axis.lines] for axis in self.study.axes],
            "shape": self.study.shape,
            "pareto": {name: self.front(name) for name in COSTS},
            "cases": [
                {
                    **record,
                    "gait": dict(row.optimum.gait) if row.optimum else None,
                    "continued_from": row.continued,
                }
                for record, row in zip(cases, self.rows, strict=True)
            ],
            "units": {column.name: column.unit for column in columns if column.unit},
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The results, in figures and tables."""
        speed, cases = 1e3 * self.speed, len(self.rows)
        good = self.fastest is not None
        title = f"None of {cases} cases has an optimum"
        if good:
            span = f"{np.nanmin(speed):.1f} to {np.nanmax(speed):.1f} mm/s"
            title = f"The best speed of {cases} cases ranges from {span}"
        shown = min(cases, _MOST_ROWS)
        shown_cases = "All cases" if shown == cases else f"The first {shown} cases"
        return doc.Document(
            name=self.study.name,
            kind="study",
            title=title,
            lead=" ".join([self.message, *self.warnings]),
            good=good,
            sections=(
                doc.section("", doc.Facts(_key_facts(self), key=True), brief=False),
                doc.section("", doc.facts(_facts(self))),
                doc.gallery(figures),
                doc.section("Fastest for their cost", _front_table(self), brief=False),
                doc.section("Cases without an optimum", _failures(self), brief=False),
                doc.section(shown_cases, _cases_table(self, range(shown)), brief=False),
            ),
            footer=(
                "Each optimum was checked against its limits and a fine simulation; `rr-opt "
                "maximize-speed` also checks a case against a sweep.",
                *doc.versions(self.study.sha256),
            ),
        )


COSTS = ("peak_torque", "energy_per_metre", "cost_of_transport")

_MOST_ROWS = 300
_STARTED = {
    "cold": "starts across the bounds",
    "warm": "a neighbour's optimum",
    "warm and cold": "both",
}


def _facts(result: SolvedStudy) -> Iterator[doc.Fact]:
    rows, shape = result.rows, result.study.shape
    product = f"{' x '.join(map(str, shape))} = " if len(shape) > 1 else ""
    ended = ", ".join(f"{count} {status.words}" for status, count in result.counts.items() if count)
    started = Counter(row.started for row in rows)
    yield doc.Fact("cases", f"{product}{len(rows)}", ended)
    yield doc.Fact("branches of optima", str(len({one for one in result.branches if one})))
    yield doc.Fact("solved from", ", ".join(f"{n} {_STARTED[how]}" for how, n in started.items()))
    best = result.fastest
    optimum = rows[best].optimum if best is not None else None
    if best is None or optimum is None:
        return
    gait = f"{with_unit(optimum.amplitude, 'rad')}, {with_unit(optimum.period, 's')}"
    yield doc.Fact("fastest", speed_text(optimum.speed), result.inputs_text(best))
    yield doc.Fact("", gait, f"limited by {', '.join(held_words(optimum.held))}")
    least = int(np.nanargmin(result.values("energy_per_metre")))
    cheap = rows[least].optimum
    if cheap:
        text = f"{number(cheap.energy_per_metre)} J/m, {1e3 * abs(cheap.speed):.1f} mm/s"
        yield doc.Fact("least energy", text, result.inputs_text(least))


def _key_facts(result: SolvedStudy) -> tuple[doc.Fact, ...]:
    counts, least = result.counts, result.values("cost_of_transport")
    cold = sum(row.started != "warm" for row in result.rows)
    cost = "–" if np.isnan(least).all() else number(float(np.nanmin(least)), 3)
    return (
        doc.Fact(f"of {len(result.rows)} cases have an optimum", str(counts[Status.OPTIMAL])),
        doc.Fact("have no feasible gait", str(counts[Status.INFEASIBLE])),
        doc.Fact("did not converge", str(counts[Status.NOT_CONVERGED])),
        doc.Fact("branches of optima", str(len({one for one in result.branches if one}))),
        doc.Fact("cases solved from starts across the bounds", str(cold)),
        doc.Fact("least cost of transport", cost),
    )


def _front_table(result: SolvedStudy) -> doc.Table:
    """The Pareto-optimal cases, the fastest first."""
    fronts = [result.front(name) for name in COSTS]
    cases = sorted({case for found in fronts for case in found}, key=lambda k: -result.speed[k])
    return _cases_table(result, cases[:20])


def _failures(result: SolvedStudy) -> doc.Table:
    rows = [
        [result.inputs_text(case), doc.Badge(row.status.words), row.message]
        for case, row in enumerate(result.rows)
        if row.optimum is None
    ]
    return doc.table(["Case", "Status", "Why"], rows[:_MOST_ROWS])


def _cases_table(result: SolvedStudy, cases: Iterable[int]) -> doc.Table:
    axes = list(map(axis_words, result.study.axes))
    head = [*axes, "Speed", "Amplitude", "Period", "Torque", "Energy", "Limited by", "Branch"]
    rows = []
    for case in cases:
        row, values = result.rows[case], result.value_texts(case)
        one = row.optimum
        if one is None:
            rows.append([*values, *[None] * 5, row.status.words, None])
            continue
        rows.append(
            [
                *values,
                f"{1e3 * abs(one.speed):.1f} mm/s {direction_text(one.speed)}",
                with_unit(one.amplitude, "rad", 3),
                with_unit(one.period, "s", 3),
                with_unit(one.peak_torque, "N m", 3),
                with_unit(one.energy_per_metre, "J/m", 3),
                ", ".join(held_words(one.held)),
                str(result.branches[case]),
            ]
        )
    return doc.table(head, rows)


@dataclass(frozen=True, repr=False)
class DrivenRoutes(_Study):
    """The routes of a study, driven.

    rows  one for each route, in their order: `DrivenRoute.record` and `cpu_seconds`. A route that
          ended in an error has only `status` and `message`
    """

    OTHERS = ("study.csv",)

    study: RouteStudy
    rows: tuple[Mapping[str, Any], ...]

    @property
    def _statuses(self) -> list[Status]:
        return [Status(row["status"]) for row in self.rows]

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        return f"{self.counts[Status.OPTIMAL]} of {len(self.rows)} routes can be driven."

    @property
    def warnings(self) -> tuple[str, ...]:
        """For each route that could not be driven, why."""
        return tuple(
            f"{name}: {row['message']}"
            for name, row in self._named
            if row["status"] != Status.OPTIMAL.value
        )

    @property
    def _named(self) -> list[tuple[str, Mapping[str, Any]]]:
        return [(one.name, row) for one, row in zip(self.study.routes, self.rows, strict=True)]

    def _record(self) -> dict[str, Any]:
        return super()._record() | {"routes": [{"name": name, **row} for name, row in self._named]}

    def _tables(self) -> Mapping[str, str]:
        """study.csv, and NAME.json for each driven route, in the format of route.json."""
        cells = ((name, *_cells(row)) for name, row in self._named)
        records = {f"{n}.json": strict_json(row) for n, row in self._named if row.get("command")}
        return {"study.csv": doc.csv_text(("route", *_HEADINGS), cells), **records}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """A table of the routes."""
        rows = (
            (name, doc.Badge(Status(row["status"]).words), *_cells(row)[1:])
            for name, row in self._named
        )
        table = doc.table(("route", *_HEADINGS), rows)
        return doc.Document(
            name=self.study.name,
            kind="study",
            title=self.message.removesuffix("."),
            lead=" ".join(self.warnings),
            good=self.status is Status.OPTIMAL,
            sections=(doc.section("Routes", table), doc.gallery(figures)),
            footer=doc.versions(self.sha256),
        )


_HEADINGS = "status", "length [m]", "time [s]", "end off by [m]", "way off by [m]", "CPU [s]"


def _cells(row: Mapping[str, Any]) -> tuple[Any, ...]:
    check = row.get("check") or {}
    names = row.get("length"), row.get("seconds"), check.get("position"), check.get("path")
    return (row["status"], *names, row.get("cpu_seconds"))
