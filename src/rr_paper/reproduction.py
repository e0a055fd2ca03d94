"""The paper recomputed: its tables and figures, and the audit of its statements; as a report."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.documents import document as doc
from rr_opt.documents.document import prose
from rr_opt.formatting import number
from rr_opt.model.ballast import Loads, load_count
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Result
from rr_paper import publication, statements
from rr_paper.consistency import KAPPA, LARGEST_WHEEL, Consistency, Hypothesis, audit_hypotheses
from rr_paper.prototype import ABOUT_P, BOX, UNITS, Sensitivity, sensitivities
from rr_paper.publication import CITATION, RATE_LIMIT, TABLE_3, captions
from rr_paper.signs import SignAudit, audit_signs
from rr_paper.tables import (
    SpeedSurface,
    Start,
    Tables,
    figure4,
    figure5,
    recompute,
    start_from_rest,
)

_TYPICAL = TABLE_3[1]
"""The row that is driven if the paper does not say which run it shows."""

_SECONDS = 10.0
_SETTLED = 20.0
"""Time after which a run from rest is steady, s."""


@dataclass(frozen=True, repr=False)
class Reproduction(Result):
    """sha256: of the shipped problem; robot: its robot; mujoco: speed of the gait of Fig. 3 in
    MuJoCo, m/s, or None."""

    FILE = "reproduce.json"
    MARKDOWN = "audit.md"
    OTHERS = (
        *("figure3.csv", "figure4.csv", "figure5.csv", "figure6.csv", "signs.csv", "tables.csv"),
        *("audit-signs.csv", "audit-left-out.csv", "audit-readings.csv", "audit-limits.csv"),
        *("audit-posture.csv", "audit-period.csv", "audit-amplitude.csv", "audit-turning.csv"),
    )
    DRAW = "rr_paper.figures.draw"
    CAPTIONS = captions("reproduction")

    sha256: str
    robot: Robot
    tables: Tables
    start: Start
    ratio_surface: SpeedSurface
    period_surface: SpeedSurface
    turning: statements.Turning
    signs: SignAudit
    sensitivities: tuple[Sensitivity, ...]
    consistency: Consistency
    demands: tuple[statements.ServoDemand, ...]
    posture: statements.SingularPosture
    period: statements.PeriodLaw
    best: statements.BestAmplitude
    mujoco: float | None

    @property
    def warnings(self) -> tuple[str, ...]:
        """A warning if a check is missing."""
        if self.mujoco is not None:
            return ()
        return (
            "MuJoCo is not installed, so the signs of equation (3) were not checked against it. "
            "Install it with `pip install 'rr-opt[lab]'`.",
        )

    def _record(self) -> dict[str, Any]:
        """The content of reproduce.json: the tables of the audit, in the units of their heads."""
        sections = {
            one.key: {
                "title": one.title,
                "finding": one.finding,
                "sentences": one.sentences,
                "rows": one.table.records,
            }
            for one in findings(self)
        }
        return {
            "status": "reproduced",
            "message": self.document().lead,
            "paper": CITATION,
            "mujoco_speed": self.mujoco,
            "sections": sections,
        }

    def _tables(self) -> dict[str, str]:
        """The curves, and the table of each finding; that on the columns has Tables 2 and 3."""
        audit = {f"audit-{one.key}.csv": one.table.csv(digits=9) for one in findings(self)}
        audit["tables.csv"] = audit.pop("audit-columns.csv")
        return curves(self) | audit

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The page, its Markdown and the text for a terminal."""
        rows, audit = self.tables.rows, findings(self)
        drawn = {figure.name: figure for figure in figures}
        sections = {
            one.key: doc.Section(one.title, (one.finding, *one.sentences, one.table), brief=False)
            for one in audit
        }

        def gallery(*names: str, wide: bool = False) -> doc.Section:
            shown = tuple(drawn[name] for name in names if name in drawn)
            return doc.Section("", (doc.Gallery(shown, wide),), brief=False)

        return doc.Document(
            "",
            "the paper, reproduced",
            "The paper's tables and figures recomputed, and its statements checked",
            "The tables and figures were recomputed for the shipped prototype. For "
            f"{sum(one.within_mean for one in rows)} of {len(rows)} measured averages, the model's "
            "speed lies within the interval; Table 2's amplitude and the friction were fitted to "
            "these averages.",
            (
                doc.Section("Findings", tuple(map(_sentences, audit))),
                sections.pop("columns"),
                gallery("figure4", "figure5", wide=True),
                gallery("figure3", "signs", "figure6", "period"),
                gallery("readings"),
                *sections.values(),
            ),
            footer=(CITATION, *doc.versions(self.sha256)),
        )


def reproduce(problem: Problem, progress: Callable[[str], None]) -> Reproduction:
    """The whole reproduction for the robot of a problem, in a minute. Raises NotConvergedError."""
    robot = problem.robot
    loaded = ABOUT_P.build(robot, _TYPICAL.ratio)
    gait = SineGait(_TYPICAL.amplitude or 0.0, _TYPICAL.period)
    progress("Tables 2 and 3")
    tables = recompute(robot)
    progress("Fig. 3")
    start = start_from_rest(loaded, _TYPICAL, gait)
    progress("Figs. 4 and 5")
    surfaces = figure4(robot), figure5(robot)
    progress("Fig. 6 and its claims")
    turning = statements.audit_turning(problem)
    progress("signs of equation (3)")
    signs = audit_signs(loaded, gait, _SECONDS)
    consistency = audit_hypotheses(progress)
    progress("speed against period")
    period = statements.audit_period(robot)
    fits = [*consistency.of("ratio", "mean"), *consistency.of("equation", "mean")]
    best = statements.audit_best_amplitude(robot, fits, progress)
    progress("MuJoCo")
    return Reproduction(
        problem.sha256, robot, tables, start, *surfaces, turning, signs,
        sensitivities(robot, _TYPICAL), consistency, statements.servo_demands(tables.amplitude),
        statements.singular_posture(robot), period, best, mujoco_speed(loaded, gait),
    )  # fmt: skip


def mujoco_speed(robot: Robot, gait: SineGait) -> float | None:
    """The mean speed of a gait in the virtual laboratory, m/s; None without MuJoCo."""
    if find_spec("mujoco") is None:
        return None
    from rr_lab.case import record

    seen = record(robot, gait, _SETTLED, "rest")
    x, y, psi = (seen.values[name] for name in ("x", "y", "psi"))
    return last_period_speed(seen.t, x, y, psi, gait.period)


def last_period_speed(t: Array, x: Array, y: Array, psi: Array, period: float) -> float:
    """Mean speed over the last period of a straight run, m/s, signed along platform 1.

    t (s), x, y (m), psi (rad): (n,), at equal steps of which a period holds a whole number.
    """
    steps = round(period / float(t[1] - t[0]))
    chord = np.array([x[-1] - x[-1 - steps], y[-1] - y[-1 - steps]])
    heading = psi[-steps:]
    ahead = chord @ np.array([np.cos(heading).mean(), np.sin(heading).mean()])
    return float(np.copysign(np.hypot(*chord), ahead)) / period


@dataclass(frozen=True)
class Finding:
    """A question about the paper: `key` names it in files; `finding` answers it in a sentence.

    table  its numbers: SI values, or in the unit of the head
    """

    key: str
    title: str
    finding: str
    sentences: tuple[str, ...]
    table: doc.Table


def _sentences(one: Finding) -> str:
    """Title and finding; a title that is a question keeps its question mark."""
    return f"{one.title}{'' if one.title.endswith('?') else '.'} {one.finding}"


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
    tables = _audit_tables(found)
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


def _audit_tables(found: Reproduction) -> dict[str, doc.Table]:
    """By the finding's key."""
    energy = {one.signs: one for one in found.signs.energy}
    posture, limit = found.posture, publication.ANGLE_LIMIT
    return {
        "signs": doc.table(
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
        "left-out": doc.table(
            ("unknown", "unit", "assumed", "box from", "box to", "least speed, m/s",
             "largest speed, m/s"),
            [
                (one.name, UNITS[one.name], one.assumed, one.low, one.high, one.least, one.largest)
                for one in found.sensitivities
            ],
        ),
        "columns": doc.table(
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
        "readings": doc.table(
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
        "limits": doc.table(
            ("gait", "amplitude, rad", "period, s", "peak rate, rpm", "over 30 rpm by, rpm"),
            [(one.where, one.amplitude, one.period, one.rpm, one.excess) for one in found.demands],
        ),
        "posture": doc.table(
            ("robot", "singular angle, rad", "servo's limit, rad"),
            [
                ("shipped prototype", posture.angle, limit),
                ("least over a1, a2", posture.least, limit),
                ("largest over a1, a2", posture.largest, limit),
            ],
        ),
        "period": doc.table(
            ("amplitude, rad", "model", "mean", "mean from", "mean to", "v_exp", "v_exp from",
             "v_exp to"),
            [
                (one.amplitude, one.model, one.mean, one.low, one.high, one.other, one.other_low,
                 one.other_high)
                for one in found.period.ratios
            ],
        ),
        "amplitude": doc.table(
            ("robot", "J20/J10", "best amplitude at T = 1 s, rad", "a maximum", "reverses at, rad"),
            [
                *(("shipped prototype", J, *_peak(peak)) for J, peak in found.best.own),
                *((f"fitted: {name}", 0.3, *_peak(peak)) for name, peak in found.best.fitted),
            ],
        ),
        "turning": doc.table(
            ("phi0, rad", "radius, m", "heading per period, rad", "speed, m/s", "once round, s",
             "heading at -phi0, rad"),
            [
                (one.gait.offset, one.circle.radius, one.circle.heading, one.circle.speed,
                 one.circle.time_round, one.mirrored.heading)
                for one in found.turning.circles
            ],
        ),
    }  # fmt: skip


def _peak(peak: statements.Peak) -> tuple[doc.Cell, ...]:
    return peak.amplitude, "yes" if peak.inside else "end of range", peak.reverses


def curves(found: Reproduction) -> dict[str, str]:
    """CSV texts by file name; SI units."""
    start, driven, motion = found.start, found.start.driven, found.signs.comparison
    average = dict(zip(np.round(start.t, 9), start.speed, strict=True))
    run = np.column_stack([driven.t, driven.x, driven.y, driven.psi, driven.phi])
    circles = [
        (one.gait.offset, *row)
        for one in found.turning.circles
        for row in np.column_stack([one.driven.t, one.driven.x, one.driven.y])[::5]
    ]
    return {
        "figure3.csv": doc.csv_text(
            ("t [s]", "x [m]", "y [m]", "psi [rad]", "phi [rad]", "average_speed [m/s]"),
            [(*row, average.get(round(row[0], 9))) for row in run],
        ),
        # Thinned to the paper's steps or finer: 0.05 rad, 0.01 and 0.05 s.
        "figure4.csv": _surface(found.ratio_surface, 10),
        "figure5.csv": _surface(found.period_surface, 5),
        "figure6.csv": doc.csv_text(("offset [rad]", "t [s]", "x [m]", "y [m]"), circles),
        "signs.csv": doc.csv_text(
            ("t [s]", *(f"v {name} [m/s]" for name in motion.v)),
            np.column_stack([motion.t, *motion.v.values()]),
        ),
    }


def _surface(surface: SpeedSurface, every: int) -> str:
    """Every fifth amplitude; `every`: the step of ratios or periods."""
    head = (
        *("amplitude [rad]", "ratio", "period [s]", "speed [m/s]", "peak_rate [rad/s]"),
        "keeps_30_rpm",
    )
    rows = [
        (surface.amplitude[i], surface.ratio[j], surface.period[j], surface.speed[i, j],
         surface.rate[i, j], int(surface.rate[i, j] <= RATE_LIMIT))
        for j in range(0, len(surface.ratio), every)
        for i in range(0, len(surface.amplitude), 5)
    ]  # fmt: skip
    return doc.csv_text(head, rows)
