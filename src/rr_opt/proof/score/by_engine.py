"""The same counts for each of the laboratory's engines by itself."""

from __future__ import annotations

from collections.abc import Sequence

from rr_opt.lab.engines import ENGINES
from rr_opt.proof.score import coverage
from rr_opt.proof.score.case import Case
from rr_opt.proof.score.measure import Measure
from rr_opt.proof.score.measures import measures
from rr_opt.proof.score.rate import rate


def by_engine(cases: Sequence[Case]) -> dict[str, list[Measure]]:
    """By engine that drove any case: all counts of `measures`, and that of the intervals."""
    found = {}
    for engine in ENGINES:
        own = [case for case in cases if case.truth.engine == engine]
        if own:
            held = rate(one.held for one in coverage.intervals(own))
            title = "intervals that hold the true value"
            covered = Measure("coverage", title, coverage.DEFINITION, held)
            found[engine] = [*measures(own), covered]
    return found


def side_by_side(cases: Sequence[Case]) -> list[tuple[str, list[Measure]]]:
    """Each count's title with the engines' own, in the order of `by_engine`; those of no case of
    any engine are left out."""
    together = zip(*by_engine(cases).values(), strict=True)
    return [(row[0].title, list(row)) for row in together if any(one.rate.total for one in row)]
