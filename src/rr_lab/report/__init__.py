"""The outcome of a blind trial: README.md and page, proof.json, cases.csv, and the figure.

For each case: what was hidden, the diagnosis, and the outcome.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import starmap
from pathlib import Path
from typing import Any

from rr_lab.trial import OpenedTrial, statistics, tidy
from rr_lab.trial.outcome import Case
from rr_lab.trial.statistics import (
    COUNTS,
    SIZES,
    TEXTS,
    TITLES,
    Rate,
    breakdown,
    by_engine,
    confusion,
)
from rr_opt.documents import document as doc
from rr_opt.documents.rendering import columns
from rr_opt.formatting import number
from rr_opt.results.result import Progress, Result, quiet

_SAYS = TEXTS["tables"]
SHARE = "share, 95 % interval"
_KEY = ("false_claims", "single", "pair_both", "parameters", "outside", "no_answer")


def hidden_text(case: Case) -> str:
    """The hidden effects, with their values in SI."""
    truth = case.truth
    if truth.nothing:
        return "nothing"
    if truth.kind == "parameters":
        return ", ".join(f"{name} = {number(of[name])}" for name, of in truth.values.items())
    # The answer lists effects outside the catalogue under `unknown`.
    values = truth.values if truth.names else {truth.hidden[0]: truth.values.get("unknown", {})}
    realised = truth.realised if truth.names else {}
    return " + ".join(
        _with_values(f"{name}/{realised[name]}" if name in realised else name, values.get(name, {}))
        for name in truth.hidden
    )


def _with_values(name: str, values: Mapping[str, float]) -> str:
    text = ", ".join(f"{key} {number(value, 3)}" for key, value in values.items())
    return f"{name} ({text})" if text else name


def size_text(case: Case) -> str:
    """Their size: `12.3 σ, 0.8 σ after a re-fit`; empty if nothing is hidden."""
    truth = case.truth
    return "; ".join(
        f"{number(truth.size[name], 3)} σ, {number(truth.remains[name], 3)} σ after a re-fit"
        for name in truth.hidden
    )


def said_text(case: Case) -> str:
    """Verdict, names with their confidence and what is suspected, or why there is none."""
    claim = case.claim
    if claim is None:
        return case.why_none
    names = ", ".join(f"{one.name} ({one.confidence:.2f})" for one in claim.named)
    if claim.suspects:
        names += f"{'; ' * bool(names)}suspected {', '.join(claim.suspects)}"
    return f"{claim.verdict}: {names}" if names else claim.verdict


def remainder_text(case: Case) -> str:
    """The diagnosed remainder: `small, 3 %`; empty if not stated."""
    claim = case.claim
    if claim is None or claim.share is None:
        return claim.remainder if claim else ""
    return f"{claim.remainder}, {100 * claim.share:.0f} % of the mismatch"


def page_of(case: Case) -> str:
    """The report of a case, from the trial's folder."""
    return f"said/{case.id}/report.html" if case.claim else f"said/{case.id}/output.txt"


def case_record(case: Case) -> dict[str, Any]:
    """The hidden effects of a case, and the diagnosis."""
    return {
        "case": case.id,
        "kind": case.truth.kind,
        "engine": case.truth.engine,
        "outcome": case.outcome,
        "counted": case.scored,
        "hidden": hidden_text(case),
        "said": said_text(case),
        "remainder": remainder_text(case),
    }


@dataclass(frozen=True, repr=False)
class ProvedCase(Result):
    """One case, with its hidden effects and the diagnosis; its files are in folder."""

    case: Case
    folder: Path

    def _record(self) -> dict[str, Any]:
        return case_record(self.case)

    def summary(self) -> str:
        """Both for a terminal, with the folder of its files."""
        case = self.case
        rows = [
            ("case", case.id),
            ("kind", case.truth.kind),
            ("engine", case.truth.engine),
            ("disturbance", case.truth.disturbance),
            ("hidden", hidden_text(case)),
            ("size", size_text(case)),
            ("diagnosis", said_text(case)),
            ("remainder", remainder_text(case)),
            ("outcome", case.outcome + ("" if case.scored else " (undetectable, not counted)")),
            ("time", f"{case.wall:.0f} s, {case.cpu:.0f} s CPU"),
            ("files", str(self.folder)),
        ]
        return "\n".join(columns([row for row in rows if row[1]])) + "\n"

    def save(self, *_: Any, **__: Any) -> list[Path]:
        """The files are there already."""
        return []


def _records(rates: Mapping[str, Rate]) -> dict[str, Any]:
    return {name: rate.record for name, rate in rates.items()}


_COLUMNS = (
    "case", "kind", "engine", "strength", "nominal_off", "hidden", "visible_sigma",
    "refitted_sigma", "counted", "said", "outcome", "missed", "groups", "heldout_before",
    "heldout_refitted", "heldout_after", "wall_s", "cpu_s", "disturbance", "remainder",
    "remainder_share",
)  # fmt: skip


def _row(case: Case) -> tuple[Any, ...]:
    """A row of cases.csv; with two effects, sigma is that of the smaller one."""
    truth, claim = case.truth, case.claim
    groups = ["|".join(sorted(group)) for group in claim.groups] if claim else []
    fit = (claim.before, claim.refitted, claim.after) if claim else (None,) * 3
    left = (claim.remainder, claim.share) if claim else (None,) * 2
    return (
        case.id, truth.kind, truth.engine, truth.strength, truth.spread > 0, hidden_text(case),
        min(truth.size.values(), default=None), min(truth.remains.values(), default=None),
        case.scored, said_text(case), case.outcome, case.missed, "; ".join(groups), *fit,
        case.wall, case.cpu, truth.disturbance, *left,
    )  # fmt: skip


@dataclass(frozen=True, repr=False)
class Proof(Result):
    """The outcome of a trial, in its folder."""

    FILE = "proof.json"
    MARKDOWN = "README.md"
    OTHERS = ("cases.csv",)
    DRAW = "rr_lab.report.confusion_figure.draw"
    CAPTIONS = {  # noqa: RUF012
        "confusion": (
            "Diagnosis against truth",
            "A matrix of counts: what was hidden in rows, what the diagnosis named in columns",
            _SAYS["confusion"],
        )
    }

    opened: OpenedTrial

    def _record(self) -> dict[str, Any]:
        opened, cases = self.opened, self.opened.cases
        counted = confusion(cases)
        covered = _records(statistics.coverage(statistics.intervals(cases)))
        return {
            "status": "scored",
            "seed": opened.seed,
            "version": opened.version,
            "code_sha256": opened.code,
            "code_changed": opened.changed,
            "cases": len(cases),
            "measures": {
                one.name: {"definition": one.definition, **one.rate(cases).record} for one in COUNTS
            },
            "engines": {engine: _records(rates) for engine, rates in by_engine(cases).items()},
            "breakdown": {
                "definition": _SAYS["breakdown"],
                **{what: _records(rates) for what, rates in breakdown(cases).items()},
            },
            "confusion": {
                "definition": _SAYS["confusion"],
                "rows": counted.rows,
                "columns": counted.columns,
                "counts": [
                    [counted.counts.get((row, column), 0) for column in counted.columns]
                    for row in counted.rows
                ],
            },
            "coverage": {
                "definition": _SAYS["coverage"],
                "all": covered.pop("all", Rate(0, 0).record),
                "quantities": covered,
            },
            "reliability": {
                "definition": _SAYS["reliability"],
                "bands": {
                    band: {"stated": stated, **rate.record}
                    for band, (stated, rate) in statistics.reliability(cases).items()
                },
            },
            "held_out": {"definition": _SAYS["held_out"], "kinds": statistics.held_out(cases)},
            "remainder": {"definition": _SAYS["remainder"], "kinds": statistics.remainders(cases)},
            "time": {
                "definition": _SAYS["time"],
                **statistics.times(cases),
                "making_cpu": statistics.quantiles(opened.made_seconds),
            },
            "p_values": {"definition": _SAYS["p_values"], "tests": statistics.uniformity(cases)},
            "misses": [{**case_record(case), "page": page_of(case)} for case in opened.misses],
            "not_made": opened.failed,
        }

    def _tables(self) -> dict[str, str]:
        return {"cases.csv": doc.csv_text(_COLUMNS, map(_row, self.opened.cases), digits=6)}

    def document(self, figures: Sequence[doc.Figure] = (), *, linked: bool = False) -> doc.Document:
        """Counts, breakdowns and misses; linked: with links to the reports of the misses, next to
        the page."""
        opened, cases = self.opened, self.opened.cases
        rates = {one: rate for one in COUNTS if (rate := one.rate(cases)).total}
        key = [doc.Fact(one.title, _of(rate)) for one, rate in rates.items() if one.name in _KEY]
        counts = [(one.title, *_cells(rate), one.definition) for one, rate in rates.items()]
        covered = statistics.coverage(statistics.intervals(cases))
        sections = (
            doc.Section("", (doc.Facts(tuple(key), key=True),)),
            doc.Section("", (doc.Gallery(tuple(figures), wide=True),)),
            doc.Section("Counts",
                (doc.table(("what", "count", SHARE, "definition"), counts),), brief=False),
            _by_engine(cases),
            _section("By effect, realisation and disturbance", "breakdown",
                ("by", "what", "right", SHARE),
                [(what, name, *_cells(rate)) for what, by_name in breakdown(cases).items()
                 for name, rate in by_name.items()]),
            _section("Coverage of the 95 % intervals", "coverage", ("quantity", "count", SHARE),
                [(name, *_cells(rate)) for name, rate in covered.items()]),
            _section("Reliability of the confidences", "reliability",
                ("confidence", "mean", "right", SHARE),
                [(band, number(stated, 2), *_cells(rate))
                 for band, (stated, rate) in statistics.reliability(cases).items()]),
            _section("Held-out error (medians)", "held_out",
                ("kind", "cases", "nominal", "re-fitted", "corrected",
                 "corrected, 90th percentile"),
                [(kind, str(row["after"]["count"]),
                  *_numbers([*(of["median"] for of in row.values()), row["after"]["quantile90"]]))
                 for kind, row in statistics.held_out(cases).items()]),
            _section("Remainder", "remainder", ("kind", *SIZES, "median share"),
                [(kind, *(str(row[size]) for size in SIZES), *_numbers([row["share"]]))
                 for kind, row in statistics.remainders(cases).items()]),
            _section("p-values with nothing hidden", "p_values",
                ("test", "nulls", "distance", "p-value", "below 0.05"),
                [(test, str(one["count"]), number(one["distance"], 2), number(one["chance"], 2),
                  str(one["below_005"])) for test, one in statistics.uniformity(cases).items()]),
            _section("Time", "time", ("", "median", "90th percentile", "maximum"),
                [(f"{name}, s", *_numbers(one[at] for at in ("median", "quantile90", "largest")))
                 for name, one in statistics.times(cases).items()]),
            doc.Section("Misses",
                (TEXTS["again"], _misses(opened, linked)) if opened.misses else ("None.",)),
            doc.Section("Cases the laboratory could not make",
                (doc.Facts(tuple(starmap(doc.Fact, opened.failed.items()))),)),
        )  # fmt: skip
        lead = f"{len(cases)} cases. {TEXTS['isolation']}"
        lead += f" {TEXTS['changed']}" if opened.changed else ""
        footer = (
            f"rr-opt {opened.version}", f"seed `{opened.seed}`", f"code SHA-256 `{opened.code}`",
        )  # fmt: skip
        return doc.Document(
            "", "blind trial of the diagnosis", self._headline, lead, sections, footer=footer
        )

    @property
    def _headline(self) -> str:
        """The two numbers that matter most."""
        rates = {one.name: one.rate(self.opened.cases) for one in COUNTS}
        words = {"single": "single effects named", "false_claims": "nulls with a false claim"}
        parts = [f"{_of(rates[name])} {text}" for name, text in words.items() if rates[name].total]
        return "Blind trial: " + (", ".join(parts) or f"{len(self.opened.misses)} misses")

    def _page(self, document: doc.Document) -> doc.Document:
        """Links to the reports of the misses are on the page only: these are not published."""
        return self.document(document.figures, linked=True)

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the outcome to the trial's folder, and remove what the seed can regenerate."""
        written = super().save(path, figures=figures, progress=progress)
        tidy(Path(path), [case.id for case in self.opened.cases if not case.missed])
        return written


def _section(
    title: str, key: str, head: Sequence[str], rows: Sequence[Sequence[doc.Cell]]
) -> doc.Section:
    """A table below its definition; empty without rows."""
    blocks: tuple[doc.Block, ...] = (_SAYS[key], doc.table(head, rows)) if rows else ()
    return doc.Section(title, blocks, brief=False)


def _of(one: Rate) -> str:
    """`17 of 20`."""
    return f"{one.count} of {one.total}" if one.total else "no cases"


def _cells(one: Rate) -> tuple[str, str]:
    """`17 of 20`, and `85 % (62 to 97)`."""
    if one.fraction is None:
        return _of(one), "–"
    low, high = one.interval
    return _of(one), f"{100 * one.fraction:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def _numbers(values: Iterable[float | None]) -> list[str]:
    return ["–" if value is None else number(value, 3) for value in values]


def _by_engine(cases: Sequence[Case]) -> doc.Section:
    """A row for each count with a column for each engine; counts without cases are omitted."""
    engines = by_engine(cases)
    rows = [
        (title, *(cell for rates in engines.values() for cell in _cells(rates[name])))
        for name, title in TITLES.items()
        if any(rates[name].total for rates in engines.values())
    ]
    head = ("what", *(word for name in engines for word in (name, "share")))
    return _section("By engine", "engines", head, rows)


def _misses(opened: OpenedTrial, linked: bool) -> doc.Table:
    return doc.table(
        ("case", "outcome", "engine", "hidden", "size", "diagnosis"),
        [
            (doc.Link(case.id, page_of(case)) if linked else case.id, case.outcome,
             case.truth.engine, hidden_text(case), size_text(case), said_text(case))
            for case in opened.misses
        ],
    )  # fmt: skip
