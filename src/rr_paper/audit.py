"""The audit of the paper: its findings, each a question answered in sentences, with a table."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.documents.document import Cell, Table, table
from rr_opt.documents.texts import prose
from rr_opt.formatting import number
from rr_opt.model.ballast import Loads, load_count
from rr_opt.results.fastest import FastestGait
from rr_paper import publication
from rr_paper.best_amplitude import Peak
from rr_paper.consistency import KAPPA, LARGEST_WHEEL, Hypothesis
from rr_paper.prototype import BOX, UNITS
from rr_paper.reproduction import Reproduction


@dataclass(frozen=True)
class Finding:
    """A question about the paper: `key` names it in files; `finding` answers it in a sentence.

    table  its numbers: SI values, or in the unit of the head
    """

    key: str
    title: str
    finding: str
    sentences: tuple[str, ...]
    table: Table


def findings(found: Reproduction) -> tuple[Finding, ...]:
    """All of them, in reading order."""
    masses = (publication.TABLE_1[name].value for name in ("m1", "m2"))
    ratios = (*(row.ratio for row in publication.TABLE_2), publication.TABLE_3[0].ratio)
    texts = prose(
        "rr_paper",
        "audit.md",
        found=found,
        deviation={one.signs.name: one for one in found.signs.deviations},
        energy={one.signs.name: one for one in found.signs.energy},
        box=BOX,
        units=UNITS,
        kappa=KAPPA,
        stiffest=KAPPA / LARGEST_WHEEL**2,
        mass=sum(masses),
        loads=[load_count(found.robot, ratio, "joint", Loads()) for ratio in ratios],
        chi2=_chi2,
        gait=_gait,
        paper=publication,
        pi=math.pi,
    )
    tables = _tables(found)
    return tuple(
        Finding(key, one.title, one.paragraphs[0], one.paragraphs[1:], tables[key])
        for key, one in texts.items()
    )


def _chi2(hypotheses: list[Hypothesis]) -> str:
    chi2 = [one.fit.chi2 for one in hypotheses]
    return f"{number(min(chi2), 3)} to {number(max(chi2), 3)}"


def _gait(answer: FastestGait) -> str:
    if answer.gait is None or answer.speed is None:
        return "not found"
    amplitude, period = (number(size, 3) for size in (answer.gait.amplitude, answer.gait.period))
    return f"{amplitude} rad at {period} s with {number(1e3 * abs(answer.speed), 3)} mm/s"


_QUESTIONS = {"ratio": "J20/J10", "kappa": "kappa", "equation": "equation (3)"}


def _tables(found: Reproduction) -> dict[str, Table]:
    """By the finding's key."""
    energy = {one.signs: one for one in found.signs.energy}
    posture, limit = found.posture, publication.ANGLE_LIMIT
    return {
        "signs": table(
            ("signs of (3)", "largest error against Kane", "against multipliers", "median error",
             "servo, mW", "friction, mW", "from nowhere, mW", "mean speed, m/s"),
            [
                (
                    one.signs.name, one.kane, one.multipliers, one.median,
                    *((1e3 * e.servo, 1e3 * e.friction, 1e3 * e.fictitious, e.speed)
                      if (e := energy.get(one.signs)) else [None] * 4),
                )
                for one in found.signs.deviations
            ],
        ),
        "left-out": table(
            ("unknown", "unit", "assumed", "box from", "box to", "least speed, m/s",
             "largest speed, m/s"),
            [
                (one.name, UNITS[one.name], one.assumed, one.low, one.high, one.least, one.largest)
                for one in found.sensitivities
            ],
        ),
        "columns": table(
            ("table", "J20/J10", "period, s", "amplitude, rad", "mean, m/s", "half width, m/s",
             "v_exp, m/s", "model, m/s", "model within mean", "model within v_exp",
             "v_exp within mean"),
            [
                (
                    "2" if one.row.amplitude is None else "3", one.row.ratio, one.row.period,
                    one.amplitude, one.row.mean, one.row.half_width, one.row.other, one.speed,
                    *("yes" if good else "no"
                      for good in (one.within_mean, one.within_other, one.columns_agree)),
                )
                for one in found.tables.rows
            ],
        ),
        "readings": table(
            ("question", "reading", "column", "chi-square", "unknowns fitted", "p", "a1, m",
             "a2, m", "b, m", "k, N s/m", "Table 2's amplitude, rad"),
            [
                (
                    _QUESTIONS[one.question], one.name, "mean" if one.column == "mean" else "v_exp",
                    one.fit.chi2, float(one.fit.free), one.p, *(one.fit.values[n] for n in BOX),
                )
                for one in found.consistency.hypotheses
            ],
        ),
        "limits": table(
            ("gait", "amplitude, rad", "period, s", "peak rate, rpm", "over 30 rpm by, rpm"),
            [(one.where, one.amplitude, one.period, one.rpm, one.excess) for one in found.demands],
        ),
        "posture": table(
            ("robot", "singular angle, rad", "servo's limit, rad"),
            [
                ("shipped prototype", posture.angle, limit),
                ("least over a1, a2", posture.least, limit),
                ("largest over a1, a2", posture.largest, limit),
            ],
        ),
        "period": table(
            ("amplitude, rad", "model", "mean", "mean from", "mean to", "v_exp", "v_exp from",
             "v_exp to"),
            [
                (one.amplitude, one.model, one.mean, one.low, one.high, one.other, one.other_low,
                 one.other_high)
                for one in found.period.ratios
            ],
        ),
        "amplitude": table(
            ("robot", "J20/J10", "best amplitude at T = 1 s, rad", "a maximum", "reverses at, rad"),
            [
                *(("shipped prototype", J, *_peak(peak)) for J, peak in found.best.own),
                *((f"fitted: {name}", 0.3, *_peak(peak)) for name, peak in found.best.fitted),
            ],
        ),
        "turning": table(
            ("phi0, rad", "radius, m", "heading per period, rad", "speed, m/s", "once round, s",
             "heading at -phi0, rad"),
            [
                (one.gait.offset, one.circle.radius, one.circle.heading, one.circle.speed,
                 one.circle.time_round, one.mirrored.heading)
                for one in found.turning.circles
            ],
        ),
    }  # fmt: skip


def _peak(peak: Peak) -> tuple[Cell, ...]:
    return peak.amplitude, "yes" if peak.inside else "end of range", peak.reverses
