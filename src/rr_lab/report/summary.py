"""The outcome of a blind trial as text: on the terminal, and as README.md of its folder."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rr_lab.trial import statistics as coverage
from rr_lab.trial import statistics as p_values
from rr_lab.trial import statistics as spread
from rr_lab.trial.case import Case
from rr_lab.trial.confusion import DEFINITION, confusion
from rr_lab.trial.measures import BREAKDOWN, breakdown, by_engine, measures, side_by_side
from rr_lab.trial.statistics import P_VALUES_DEFINITION, Rate, evenness, rate
from rr_lab.trial.trial import Opened
from rr_opt.answers.quantities import number


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


def visible_text(case: Case) -> str:
    """How visible: `12.3 sigma, 0.8 after the re-fit`; empty where nothing is hidden."""
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


def rate_text(rate: Rate) -> str:
    """`17 of 20`."""
    return f"{rate.count} of {rate.total}" if rate.total else "no case"


def share_text(rate: Rate) -> str:
    """`85 % (62 to 97)`."""
    if rate.fraction is None:
        return "–"
    low, high = rate.interval
    return f"{100 * rate.fraction:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def _with_values(name: str, values: Mapping[str, float]) -> str:
    told = ", ".join(f"{key} {number(value, 3)}" for key, value in values.items())
    return f"{name} ({told})" if told else name


def record(opened: Opened) -> dict[str, Any]:
    """The content of `proof.json`."""
    cases = opened.cases
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
        "confusion": _confusion(opened),
        "coverage": _coverage(opened),
        "held_out": {
            "definition": spread.HELD_OUT,
            "kinds": {
                kind: {when: sizes.record for when, sizes in row.items()}
                for kind, row in spread.held_out(cases).items()
            },
        },
        "time": {
            "definition": spread.TIME,
            **{name: sizes.record for name, sizes in spread.times(cases).items()},
            "making_cpu": spread.sizes(opened.made_seconds).record,
        },
        "p_values": {"definition": p_values.DEFINITION, "tests": p_values.evenness(cases)},
        "misses": [{**case_record(case), "page": page_of(case)} for case in opened.misses],
        "not_made": dict(opened.failed),
    }


def _confusion(opened: Opened) -> dict[str, Any]:
    table = confusion(opened.cases)
    return {
        "definition": DEFINITION,
        "rows": list(table.rows),
        "columns": list(table.columns),
        "counts": [
            [table.counts.get((row, col), 0) for col in table.columns] for row in table.rows
        ],
    }


def _coverage(opened: Opened) -> dict[str, Any]:
    every = coverage.intervals(opened.cases)
    return {
        "definition": coverage.DEFINITION,
        "all": rate(one.held for one in every).record,
        "quantities": {name: one.record for name, one in coverage.by_quantity(every).items()},
    }


def case_record(case: Case) -> dict[str, Any]:
    """What was hidden in a case, and what was said of it."""
    return {
        "case": case.id,
        "kind": case.truth.kind,
        "engine": case.truth.engine,
        "outcome": case.outcome,
        "counted": case.scored,
        "hidden": hidden_text(case),
        "said": said_text(case),
    }


def page_of(case: Case) -> str:
    """The diagnosis of a case that is kept, from the trial's folder."""
    return f"said/{case.id}/report.html" if case.claim else f"said/{case.id}/output.txt"


ISOLATION = (
    "The laboratory drew and sealed every case before the first was diagnosed. Each was diagnosed "
    "by a program of its own, `rr-opt diagnose`, in a temporary folder that holds a copy of the "
    "recordings and their experiment.yaml, with arguments and environment that tell nothing else. "
    "It runs as the same user, so nothing but its own code keeps it from other files."
)

ENGINES_TOLD = (
    "The same counts of the cases that each of the laboratory's engines drove: a robot in three "
    "dimensions in MuJoCo, and two bodies in the plane with contacts of another kind."
)

CHANGED = (
    "The code of rr-opt changed while this ran, so the counts are of no one code. Begin anew with "
    "--restart."
)


def summary(opened: Opened) -> str:
    """The whole text, in Markdown that reads well as it is."""
    parts = [
        f"# {headline(opened)}",
        f"Seed `{opened.seed}`, rr-opt {opened.version}, {len(opened.cases)} cases. {ISOLATION}",
        CHANGED if opened.changed else "",
        _measures(opened),
        _engines(opened),
        _breakdown(opened),
        _summary_coverage(opened),
        _held_out(opened),
        _p_values(opened),
        _times(opened),
        _misses(opened),
        _not_made(opened),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def headline(opened: Opened) -> str:
    """The two numbers that matter most."""
    found = {one.name: one.rate for one in measures(opened.cases)}
    single, null = found["single"], found["false_claims"]
    told = []
    if single.total:
        told.append(f"{rate_text(single)} single effects named")
    if null.total:
        told.append(f"{rate_text(null)} nulls with a false claim")
    return "Blind trial: " + (", ".join(told) or f"{len(opened.misses)} misses")


def _measures(opened: Opened) -> str:
    every = [one for one in measures(opened.cases) if one.rate.total]
    rows = [(one.title, *_cells(one.rate)) for one in every]
    lines = [f"- **{one.title.removeprefix('... ')}**: {one.definition}" for one in every]
    head = ("what", "count", "share, 95 % interval")
    return markdown(head, rows) + "\n\nWhat is counted:\n\n" + "\n".join(lines)


def _engines(opened: Opened) -> str:
    if not opened.cases:
        return ""
    rows = [
        (title, *(cell for one in own for cell in _cells(one.rate)))
        for title, own in side_by_side(opened.cases)
    ]
    head = ("what", *(word for name in by_engine(opened.cases) for word in (name, "share")))
    return "## By engine\n\n" + ENGINES_TOLD + "\n\n" + markdown(head, rows)


def _breakdown(opened: Opened) -> str:
    tables = [
        markdown(
            (what, "right", "share, 95 % interval"), [(key, *_cells(one)) for key, one in rows]
        )
        for what, by_key in breakdown(opened.cases).items()
        if (rows := by_key.items())
    ]
    head = f"## By effect, realisation and disturbance\n\n{BREAKDOWN}"
    return "\n\n".join([head, *tables]) if tables else ""


def _summary_coverage(opened: Opened) -> str:
    every = coverage.intervals(opened.cases)
    if not every:
        return ""
    rows = [("all", *_cells(rate(one.held for one in every)))]
    rows += [(name, *_cells(one)) for name, one in coverage.by_quantity(every).items()]
    head = ("quantity", "count", "share, 95 % interval")
    return f"## Intervals that hold the true value\n\n{coverage.DEFINITION}\n\n" + markdown(
        head, rows
    )


def _held_out(opened: Opened) -> str:
    rows = []
    for kind, row in spread.held_out(opened.cases).items():
        after = row["after"]
        cells = (row["before"].median, row["refitted"].median, after.median, after.most)
        rows.append((kind, str(after.count), *("–" if c is None else number(c, 3) for c in cells)))
    head = ("kind", "cases", "as believed", "parameters", "as found", "as found, 90 % below")
    return f"## Held-out error\n\n{spread.HELD_OUT} Medians.\n\n" + markdown(head, rows)


def _p_values(opened: Opened) -> str:
    tests = evenness(opened.cases)
    rows = [
        (test, str(one["count"]), number(one["distance"], 2), number(one["chance"], 2),
         str(one["below_005"]))
        for test, one in tests.items()
    ]  # fmt: skip
    head = ("test", "nulls", "distance", "chance", "below 0.05")
    return (
        f"## p-values where nothing is hidden\n\n{P_VALUES_DEFINITION}\n\n" + markdown(head, rows)
        if (rows)
        else ""
    )


def _times(opened: Opened) -> str:
    rows = [
        (f"{name} s", *("–" if c is None else number(c, 3) for c in (s.median, s.most, s.largest)))
        for name, s in spread.times(opened.cases).items()
    ]
    return f"## Time\n\n{spread.TIME}\n\n" + markdown(("", "median", "90 % below", "most"), rows)


def _misses(opened: Opened) -> str:
    if not opened.misses:
        return "## Misses\n\nNone."
    rows = [
        (case.id, case.outcome, case.truth.engine, hidden_text(case),
         visible_text(case), said_text(case))
        for case in opened.misses
    ]  # fmt: skip
    head = ("case", "outcome", "engine", "hidden", "visible", "said")
    again = (
        "`rr-opt prove --case ID --out FOLDER`, where FOLDER holds this page, makes "
        "and diagnoses a case again and writes its report. The code has to be that of the trial."
    )
    return f"## Misses\n\n{again}\n\n" + markdown(head, rows)


def _not_made(opened: Opened) -> str:
    lines = [f"- {case}: {why}" for case, why in opened.failed.items()]
    return "## Cases that the laboratory could not make\n\n" + "\n".join(lines) if lines else ""


def _cells(one: Rate) -> tuple[str, str]:
    return rate_text(one), share_text(one)


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown, padded so that it reads well as plain text."""
    table = [list(head), *(list(row) for row in rows)]
    widths = [max(3, *(len(row[i]) for row in table)) for i in range(len(head))]
    lines = ["| " + " | ".join(map(str.ljust, row, widths)) + " |" for row in table]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)
