"""Routes of a study that were driven."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.archive import strict_json
from rr_opt.files.route_file import RouteStudy
from rr_opt.outcome import Status
from rr_opt.results.result import Result


@dataclass(frozen=True, repr=False)
class DrivenRoutes(Result):
    """The routes of a study, driven.

    rows  one for each route, in their order: what `DrivenRoute.record` has, and `cpu_seconds`. Of a
          route that ended in an error there are `status` and `message` only
    """

    FILE = "study.json"
    OTHERS = ("study.csv",)

    study: RouteStudy
    rows: tuple[Mapping[str, Any], ...]

    @property
    def sha256(self) -> str:
        """The fingerprint of its files."""
        return self.study.sha256

    @property
    def counts(self) -> dict[Status, int]:
        """How many routes ended in each way."""
        counted = Counter(row["status"] for row in self.rows)
        return {status: counted[status.value] for status in Status}

    @property
    def status(self) -> Status:
        """OPTIMAL if any route is driven; else INFEASIBLE if none can be."""
        return Status.of_cases(self.counts)

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        return f"{self.counts[Status.OPTIMAL]} of {len(self.rows)} routes are driven."

    @property
    def warnings(self) -> tuple[str, ...]:
        """Of each route that is not driven, why."""
        return tuple(
            f"{route.name}: {row['message']}"
            for route, row in zip(self.study.routes, self.rows, strict=True)
            if row["status"] != Status.OPTIMAL.value
        )

    def _record(self) -> dict[str, Any]:
        return {
            "status": "studied",
            "message": self.message,
            "study": self.study.name,
            "counts": {status.value: count for status, count in self.counts.items()},
            "routes": [
                {"name": route.name, **row}
                for route, row in zip(self.study.routes, self.rows, strict=True)
            ],
        }

    def _tables(self) -> Mapping[str, str]:
        """study.csv, and of each route that is driven NAME.json, as route.json."""
        named = list(zip(self.study.routes, self.rows, strict=True))
        cells = ((route.name, *_cells(row)) for route, row in named)
        tables = {"study.csv": doc.csv_text(("route", *_HEADINGS), cells)}
        for route, row in named:
            if row.get("command"):
                tables[f"{route.name}.json"] = strict_json(row)
        return tables

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """A table of the routes."""
        rows = (
            (route.name, doc.Badge(Status(row["status"]).words), *_cells(row)[1:])
            for route, row in zip(self.study.routes, self.rows, strict=True)
        )
        table = doc.table(("route", *_HEADINGS), rows)
        return doc.Document(
            name=self.study.name,
            kind="study",
            title=self.message.removesuffix("."),
            lead=" ".join(self.warnings),
            good=self.status is Status.OPTIMAL,
            sections=(doc.Section("Routes", (table,)), doc.gallery(figures)),
            footer=doc.versions(self.sha256),
        )


_HEADINGS = "status", "length [m]", "time [s]", "end off by [m]", "way off by [m]", "CPU [s]"


def _cells(row: Mapping[str, Any]) -> tuple[Any, ...]:
    check = row.get("check") or {}
    names = row.get("length"), row.get("seconds"), check.get("position"), check.get("path")
    return (row["status"], *names, row.get("cpu_seconds"))
