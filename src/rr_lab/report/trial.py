"""The outcome of a blind trial: README.md and page, proof.json, cases.csv, and the figure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.trial import statistics
from rr_lab.trial.case import Case
from rr_lab.trial.confusion import DEFINITION as CONFUSION
from rr_lab.trial.confusion import confusion
from rr_lab.trial.measures import BREAKDOWN, breakdown, by_engine, measures, side_by_side
from rr_lab.trial.statistics import Rate, rate
from rr_lab.trial.trial import Opened, tidy
from rr_opt.documents.document import (
    Block,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Link,
    Section,
    Table,
    csv_text,
    table,
)
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.documents.text import columns
from rr_opt.formatting import number
from rr_opt.results.result import Result

ISOLATION = (
    "The laboratory drew and sealed every case before the first was diagnosed. Each was diagnosed "
    "by a separate process, `rr-opt diagnose`, in a temporary folder with a copy of the recordings "
    "and their experiment.yaml; its arguments and environment reveal nothing else. It runs as the "
    "same user, so nothing but its own code keeps it from other files."
)
ENGINES = (
    "The same counts for each of the laboratory's two engines: a three-dimensional robot in "
    "MuJoCo, and two bodies in the plane with another contact model."
)
CHANGED = (
    "The code of rr-opt changed during the trial, so the counts belong to no single version. Start "
    "again with --restart."
)
AGAIN = (
    "`rr-opt prove --case ID --out FOLDER`, where FOLDER holds this page, makes and diagnoses a "
    "case again and writes its report. The code has to be that of the trial."
)
SHARE = "share, 95 % interval"
_KEY = ("false_claims", "single", "pair_both", "parameters", "outside", "no_answer")


def hidden_text(case: Case) -> str:
    """What was hidden, with its values in SI."""
    truth = case.truth
    if truth.kind == "null" or (truth.kind == "disturbed" and not truth.hidden):
        return "nothing"
    if truth.kind == "parameters":
        return ", ".join(
            f"{name} = {number(values[name])}" for name, values in truth.values.items()
        )
    # Of an effect outside the catalogue the answer has the values under `unknown`.
    values = truth.values if truth.names else {truth.hidden[0]: truth.values.get("unknown", {})}
    return " + ".join(
        _with_values(
            f"{name}/{truth.realised[name]}" if truth.names and name in truth.realised else name,
            values.get(name, {}),
        )
        for name in truth.hidden
    )


def _with_values(name: str, values: Mapping[str, float]) -> str:
    text = ", ".join(f"{key} {number(value, 3)}" for key, value in values.items())
    return f"{name} ({text})" if text else name


def visible_text(case: Case) -> str:
    """How visible: `12.3 σ, 0.8 σ re-fitted`; empty where nothing is hidden."""
    return "; ".join(
        f"{number(case.truth.seen[name], 3)} σ, {number(case.truth.remains[name], 3)} σ re-fitted"
        for name in case.truth.hidden
    )


def said_text(case: Case) -> str:
    """Verdict and names with their confidence, or why there is none."""
    claim = case.claim
    if claim is None:
        return case.why_none
    names = ", ".join(f"{one.name} ({one.confidence:.2f})" for one in claim.named)
    return f"{claim.verdict}: {names}" if names else claim.verdict


def rate_text(one: Rate) -> str:
    """`17 of 20`."""
    return f"{one.count} of {one.total}" if one.total else "no case"


def share_text(one: Rate) -> str:
    """`85 % (62 to 97)`."""
    if one.fraction is None:
        return "–"
    low, high = one.interval
    return f"{100 * one.fraction:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def _cells(one: Rate) -> tuple[str, str]:
    return rate_text(one), share_text(one)


def page_of(case: Case) -> str:
    """The report of a case, from the trial's folder."""
    return f"said/{case.id}/report.html" if case.claim else f"said/{case.id}/output.txt"


def case_record(case: Case) -> dict[str, Any]:
    """What was hidden in a case, and the diagnosis."""
    return {
        "case": case.id,
        "kind": case.truth.kind,
        "engine": case.truth.engine,
        "outcome": case.outcome,
        "counted": case.scored,
        "hidden": hidden_text(case),
        "said": said_text(case),
    }


def case_text(case: Case, folder: Path) -> str:
    """The same for a terminal, with its files."""
    rows = [
        ("case", case.id),
        ("kind", case.truth.kind),
        ("engine", case.truth.engine),
        ("disturbance", case.truth.disturbance),
        ("hidden", hidden_text(case)),
        ("visible", visible_text(case)),
        ("said", said_text(case)),
        ("outcome", case.outcome if case.scored else f"{case.outcome} (invisible, not counted)"),
        ("time", f"{case.wall:.0f} s, {case.cpu:.0f} s of CPU"),
        ("files", str(folder)),
    ]
    return "\n".join(columns([row for row in rows if row[1]])) + "\n"


def headline(opened: Opened) -> str:
    """The two numbers that matter most."""
    found = {one.name: one.rate for one in measures(opened.cases)}
    single, null = found["single"], found["false_claims"]
    parts = []
    if single.total:
        parts.append(f"{rate_text(single)} single effects named")
    if null.total:
        parts.append(f"{rate_text(null)} nulls with a false claim")
    return "Blind trial: " + (", ".join(parts) or f"{len(opened.misses)} misses")


@dataclass(frozen=True, repr=False)
class Proof(Result):
    """The outcome of a trial, in its folder."""

    REPORT = "rr_lab.report.trial"

    opened: Opened

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the outcome to the trial's folder, and remove what the seed makes again."""
        written = super().save(path, figures=figures, progress=progress)
        tidy(Path(path), [case.id for case in self.opened.cases if not case.missed])
        return written


@dataclass(frozen=True, repr=False)
class ProvedCase(Result):
    """One case, with what was hidden in it and what the diagnosis said; its files are in folder."""

    case: Case
    folder: Path

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:  # noqa: ARG002
        """Both as plain data."""
        return case_record(self.case)

    def summary(self, files: Sequence[Path] = ()) -> str:  # noqa: ARG002
        """Both for a terminal."""
        return case_text(self.case, self.folder)

    def save(self, *_: Any, **__: Any) -> list[Path]:
        """The files are there already."""
        return []


def proof_document(
    opened: Opened, figures: Sequence[Figure] = (), *, linked: bool = False
) -> Document:
    """The whole report; linked: the misses lead to their reports, which are beside the page."""
    cases = opened.cases
    every = [one for one in measures(cases) if one.rate.total]
    key = tuple(Fact(one.title, rate_text(one.rate)) for one in every if one.name in _KEY)
    counts = table(
        ("what", "count", SHARE, "what is counted"),
        [(one.title, *_cells(one.rate), one.definition) for one in every],
    )
    engines = table(
        ("what", *(word for name in by_engine(cases) for word in (name, "share"))),
        [
            (title, *(cell for one in own for cell in _cells(one.rate)))
            for title, own in side_by_side(cases)
        ],
    )
    rows = [
        (what, key, *_cells(one))
        for what, by_key in breakdown(cases).items()
        for key, one in by_key.items()
    ]
    sections = (
        Section("", (Facts(key, key=True),)),
        Section("", (Gallery(tuple(figures), wide=True),)),
        Section("Counts", (counts,), brief=False),
        _section("By engine", ENGINES, engines),
        _section(
            "By effect, realisation and disturbance",
            BREAKDOWN,
            table(("by", "what", "right", SHARE), rows),
        ),
        _section("Coverage of the 95 % intervals", statistics.COVERAGE, _coverage_table(opened)),
        _section("Held-out error, medians", statistics.HELD_OUT, _held_out(opened)),
        _section("p-values where nothing is hidden", statistics.P_VALUES, _p_values(opened)),
        _section("Time", statistics.TIME, _times(opened)),
        Section("Misses", (AGAIN, _misses(opened, linked)) if opened.misses else ("None.",)),
        Section(
            "Cases that the laboratory could not make",
            (Facts(tuple(Fact(case, why) for case, why in opened.failed.items())),),
        ),
    )
    lead = f"{len(cases)} cases. {ISOLATION} {CHANGED if opened.changed else ''}".strip()
    footer = (f"rr-opt {opened.version}", f"seed `{opened.seed}`", f"code SHA-256 `{opened.code}`")
    return Document("", "blind trial of the diagnosis", headline(opened), lead, sections,
                    footer=footer)  # fmt: skip


def _section(title: str, definition: str, numbers: Table) -> Section:
    blocks: tuple[Block, ...] = (definition, numbers) if numbers else ()
    return Section(title, blocks, brief=False)


def _coverage_table(opened: Opened) -> Table:
    every = statistics.intervals(opened.cases)
    rows = [("all", *_cells(rate(one.held for one in every)))]
    rows += [(name, *_cells(one)) for name, one in statistics.by_quantity(every).items()]
    return table(("quantity", "count", SHARE), rows if every else ())


def _held_out(opened: Opened) -> Table:
    rows = []
    for kind, row in statistics.held_out(opened.cases).items():
        after = row["after"]
        cells = (row["before"].median, row["refitted"].median, after.median, after.most)
        rows.append((kind, str(after.count), *_numbers(cells)))
    head = ("kind", "cases", "nominal", "re-fitted", "corrected", "corrected, 90 % below")
    return table(head, rows)


def _p_values(opened: Opened) -> Table:
    rows = [
        (test, str(one["count"]), number(one["distance"], 2), number(one["chance"], 2),
         str(one["below_005"]))
        for test, one in statistics.evenness(opened.cases).items()
    ]  # fmt: skip
    return table(("test", "nulls", "distance", "p-value", "below 0.05"), rows)


def _times(opened: Opened) -> Table:
    rows = [
        (f"{name}, s", *_numbers((sizes.median, sizes.most, sizes.largest)))
        for name, sizes in statistics.times(opened.cases).items()
    ]
    return table(("", "median", "90 % below", "most"), rows)


def _numbers(values: Iterable[float | None]) -> list[str]:
    return ["–" if value is None else number(value, 3) for value in values]


def _misses(opened: Opened, linked: bool) -> Table:
    head = ("case", "outcome", "engine", "hidden", "visible", "said")
    return table(
        head,
        [
            (Link(case.id, page_of(case)) if linked else case.id, case.outcome, case.truth.engine,
             hidden_text(case), visible_text(case), said_text(case))
            for case in opened.misses
        ],
    )  # fmt: skip


def proof_record(opened: Opened) -> dict[str, Any]:
    """The content of `proof.json`."""
    cases = opened.cases
    counted, every = confusion(cases), statistics.intervals(cases)
    return {
        "status": "scored",
        "seed": opened.seed,
        "version": opened.version,
        "code_sha256": opened.code,
        "code_changed": opened.changed,
        "cases": len(cases),
        "measures": {
            one.name: {"definition": one.definition, **one.rate.record} for one in measures(cases)
        },
        "engines": {
            engine: {one.name: one.rate.record for one in own}
            for engine, own in by_engine(cases).items()
        },
        "breakdown": {
            "definition": BREAKDOWN,
            **{
                what: {key: one.record for key, one in by_key.items()}
                for what, by_key in breakdown(cases).items()
            },
        },
        "confusion": {
            "definition": CONFUSION,
            "rows": list(counted.rows),
            "columns": list(counted.columns),
            "counts": [
                [counted.counts.get((row, column), 0) for column in counted.columns]
                for row in counted.rows
            ],
        },
        "coverage": {
            "definition": statistics.COVERAGE,
            "all": rate(one.held for one in every).record,
            "quantities": {name: one.record for name, one in statistics.by_quantity(every).items()},
        },
        "held_out": {
            "definition": statistics.HELD_OUT,
            "kinds": {
                kind: {when: sizes.record for when, sizes in row.items()}
                for kind, row in statistics.held_out(cases).items()
            },
        },
        "time": {
            "definition": statistics.TIME,
            **{name: sizes.record for name, sizes in statistics.times(cases).items()},
            "making_cpu": statistics.sizes(opened.made_seconds).record,
        },
        "p_values": {"definition": statistics.P_VALUES, "tests": statistics.evenness(cases)},
        "misses": [{**case_record(case), "page": page_of(case)} for case in opened.misses],
        "not_made": dict(opened.failed),
    }


def cases_csv(opened: Opened) -> str:
    """A row for each case; where there are two effects, sigma is that of the less visible one."""
    rows = [_row(case) for case in opened.cases]
    head = (
        "case", "kind", "engine", "strength", "nominal_off", "hidden", "visible_sigma",
        "refitted_sigma", "counted", "said", "outcome", "missed", "groups", "heldout_before",
        "heldout_refitted", "heldout_after", "wall_s", "cpu_s", "disturbance",
    )  # fmt: skip
    return csv_text(head, rows, digits=6)


def _row(case: Case) -> tuple[Any, ...]:
    truth, claim = case.truth, case.claim
    groups = ["|".join(sorted(group)) for group in claim.groups] if claim else []
    return (
        case.id, truth.kind, truth.engine, truth.strength, truth.spread > 0, hidden_text(case),
        min(truth.seen.values(), default=None), min(truth.remains.values(), default=None),
        case.scored, said_text(case), case.outcome, case.missed, "; ".join(groups),
        claim.before if claim else None, claim.refitted if claim else None,
        claim.after if claim else None, case.wall, case.cpu, truth.disturbance,
    )  # fmt: skip


class _Report(Report):
    def page_of(self, result: Proof, document: Document) -> Document:
        """On the page alone the misses lead to their reports: these are not published."""
        return proof_document(result.opened, document.figures, linked=True)


_MATRIX = "A matrix of counts: what was hidden in rows, what the diagnosis named in columns"

REPORT = _Report(
    lambda proof: proof_record(proof.opened),
    lambda proof, figures: proof_document(proof.opened, figures),
    "proof.json",
    "README.md",
    tables=lambda proof: {"cases.csv": cases_csv(proof.opened)},
    others=("cases.csv",),
    figures="rr_lab.report.confusion_figure",
    captions={"confusion": ("Diagnosis against truth", _MATRIX, CONFUSION)},
)
