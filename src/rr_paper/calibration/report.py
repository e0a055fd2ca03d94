"""The results of a calibration: intervals of the unknowns, models compared, and their report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.documents import document as doc
from rr_opt.documents.document import prose
from rr_opt.files.problem_file import read_problem
from rr_opt.formatting import number
from rr_opt.results.result import Result
from rr_opt.version import __version__
from rr_paper.calibration.comparison import Assessment, Coverage
from rr_paper.calibration.fit import Fit, measured
from rr_paper.calibration.intervals import JOINT_LEVEL, Posterior, Profile
from rr_paper.calibration.models import (
    DRY,
    MODELS,
    READINGS,
    UNKNOWNS,
    VISCOUS,
    Model,
    Reading,
    Unknown,
    values,
)
from rr_paper.publication import CITATION, COLUMNS, ROWS, T_POINT, Column, Row, captions

_DRAWS = 1000
"""Draws of each posterior that are written."""

_Rows = list[dict[str, Any]]

_PINNED = 0.25
"""Width relative to the box's 95 % width below which an unknown is well determined."""

ASSUMED = ("a1", "a2", "b", "k")
"""The unknowns for which the shipped robot file assumes a value."""


def shipped_values() -> dict[str, float]:
    """a1, a2, b (m) and k (N s/m) of the shipped robot file."""
    robot = read_problem(None).robot
    one, two = robot.platform1, robot.platform2
    if (one.b, robot.k1) != (two.b, robot.k2):
        raise ValueError("the shipped robot's platforms differ in b or k; the calibration's do not")
    return {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}


@dataclass(frozen=True)
class Shipped:
    """The shipped robot's values by name, SI; rise of the deviance above the least, at the best
    amplitude (rad) of Table 2."""

    values: dict[str, float]
    rise: float
    amplitude: float


@dataclass(frozen=True)
class Alternative:
    """A model's best fit for another reading of J20/J10; of the viscous model also where the
    shipped robot's values stand."""

    reading: Reading
    model: Model
    column: Column
    student: Fit
    shipped: Shipped | None


@dataclass(frozen=True)
class Interval:
    """95 % intervals of an unknown, SI: the posterior's with its median, and the profiles' by
    Student's t and by the normal distribution.

    share  width of the posterior's, as a share of the box's own
    """

    unknown: Unknown
    column: Column
    posterior: tuple[float, float]
    median: float
    profile: Profile
    normal: Profile
    share: float

    @property
    def verdict(self) -> str:
        """How far the rows have narrowed the box: not at all if the profile leaves it whole."""
        if self.profile.low <= 0 and self.profile.high >= 1:
            return "not identifiable"
        return "pinned down" if self.share < _PINNED else "narrowed"

    def profile_text(self, profile: Profile) -> str:
        """A profile's interval; `open` where the box ends it."""
        below, above = profile.low <= 0, profile.high >= 1
        if below and above:
            return "whole box"
        open_side = " (open below)" if below else " (open above)" if above else ""
        return self.unknown.span(profile.ends(self.unknown)) + open_side

    def contains(self, value: float) -> bool:
        """Whether a value is in the posterior's interval and in the profile's by Student's t."""
        both = (self.posterior, self.profile.ends(self.unknown))
        return all(low - 1e-12 <= value <= high + 1e-12 for low, high in both)


@dataclass(frozen=True, repr=False)
class Calibration(Result):
    """The results from the nine rows.

    assessments      by model and column
    posterior        of the viscous model, by column
    normal_profiles  its profiles by the normal distribution, by column
    shipped          the shipped robot's values, by column
    coverage         on simulated data of known robots
    alternatives     other readings of J20/J10
    """

    FILE = "calibration.json"
    OTHERS = (
        *("intervals.csv", "models.csv", "predictions.csv", "profiles.csv", "posterior.csv"),
        *("readings.csv", "coverage.csv"),
    )
    DRAW = "rr_paper.calibration.figures.draw"
    CAPTIONS = captions("calibration")

    assessments: Mapping[tuple[str, Column], Assessment]
    posterior: Mapping[Column, Posterior]
    normal_profiles: Mapping[Column, tuple[Profile, ...]]
    shipped: Mapping[Column, Shipped]
    coverage: Coverage
    alternatives: tuple[Alternative, ...]

    def intervals(self) -> list[Interval]:
        """Of every unknown of the viscous model, for each column."""
        found = []
        for column in COLUMNS:
            low, median, high = self.posterior[column].quantiles()
            student = self.assessments[VISCOUS, column].profiles
            for i, name in enumerate(MODELS[VISCOUS].unknowns):
                unknown = UNKNOWNS[name]
                ends = unknown.value([low[i], median[i], high[i]]).tolist()
                share = float(high[i] - low[i]) / 0.95
                normal = self.normal_profiles[column][i]
                found.append(
                    Interval(
                        unknown, column, (ends[0], ends[2]), ends[1], student[i], normal, share
                    )
                )
        return found

    def shipped_outside(self, column: Column) -> list[str]:
        """Symbols of the unknowns for which the shipped robot's value is outside its interval."""
        values = shipped_values()
        return [
            one.unknown.symbol
            for one in self.intervals()
            if one.column == column
            and one.unknown.name in values
            and not one.contains(values[one.unknown.name])
        ]

    def draws(self, column: Column, name: str) -> Array:
        """Of one unknown of the viscous model, as shares of its box."""
        return self.posterior[column].points[:, MODELS[VISCOUS].unknowns.index(name)]

    def conditional(
        self, column: Column, known: str, value: float, within: float, wanted: str
    ) -> tuple[float, float]:
        """95 % interval of one unknown (SI), if another were known to be value +- within (SI)."""
        near = np.abs(UNKNOWNS[known].value(self.draws(column, known)) - value) <= within
        if not near.any():
            return float("nan"), float("nan")
        ends = np.quantile(self.draws(column, wanted)[near], [0.025, 0.975])
        low, high = UNKNOWNS[wanted].value(ends).tolist()
        return low, high

    def correlation(self, column: Column, one: str, other: str) -> float:
        """Of two unknowns in the posterior, as shares of their boxes."""
        return float(np.corrcoef(self.draws(column, one), self.draws(column, other))[0, 1])

    def _record(self) -> dict[str, Any]:
        names, covered = MODELS[VISCOUS].unknowns, self.coverage
        return {
            "verdict": verdict(self),
            "conclusions": conclusions(self)["conclusions"],
            "t_of_the_intervals": T_POINT,
            "reading": READINGS[0].words,
            "unknowns": [
                {"name": one.name, "unit": one.unit, "box": one.box,
                 "flat_in": "logarithm" if one.log else "value", "why": one.why}
                for one in UNKNOWNS.values()
            ],
            "intervals": [
                {"unknown": one.unknown.name, "column": one.column, "posterior": one.posterior,
                 "median": one.median, "profile_student": one.profile.ends(one.unknown),
                 "profile_normal": one.normal.ends(one.unknown), "share_of_box": one.share,
                 "verdict": one.verdict}
                for one in self.intervals()
            ],
            "models": [
                {"model": name, "column": column, "words": one.model.words, "best": _best(one),
                 **_scores(one),
                 "profiles": {
                     unknown: profile.ends(UNKNOWNS[unknown])
                     for unknown, profile in zip(one.model.profiled, one.profiles, strict=True)
                 },
                 "made": one.bootstrap}
                for (name, column), one in self.assessments.items()
            ],
            "posterior": {
                column: {"draws": len(one.points), "split_rhat": one.rhat,
                         "library_effective_points": one.library_weight}
                for column, one in self.posterior.items()
            },
            "shipped": self.shipped,
            "coverage": {"sets": covered.sets, "unknowns": names, **vars(covered)},
            "readings": [
                {"reading": one.reading.words, "model": one.model.name, "column": one.column,
                 "deviance": one.student.deviance,
                 "shipped_rise": one.shipped.rise if one.shipped else None}
                for one in self.alternatives
            ],
            "version": __version__,
        }  # fmt: skip

    def _tables(self) -> dict[str, str]:
        names, covered = MODELS[VISCOUS].unknowns, vars(self.coverage)
        rows: dict[str, _Rows] = {
            "intervals.csv": _interval_rows(self),
            "models.csv": _model_rows(self),
            "predictions.csv": _prediction_rows(self),
            "profiles.csv": _profile_rows(self),
            "posterior.csv": _posterior_rows(self),
            "readings.csv": [
                {"about": one.reading.about, "by": one.reading.by,
                 "spread": one.reading.spread if one.reading.by == "loads" else None,
                 "model": one.model.name, "column": one.column, "deviance": one.student.deviance}
                for one in self.alternatives
            ],
            "coverage.csv": [
                {"unknown": name,
                 **{key: np.broadcast_to(of, len(names))[i] for key, of in covered.items()}}
                for i, name in enumerate(names)
            ],
        }  # fmt: skip
        return {
            name: doc.csv_text(list(here[0]), (list(row.values()) for row in here), digits=6)
            for name, here in rows.items()
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The page and the text for a terminal."""
        drawn = {figure.name: figure for figure in figures}
        said = conclusions(self)

        def gallery(name: str) -> doc.Section:
            return doc.Section("", (doc.Gallery((drawn[name],) if drawn else (), wide=True),))

        return doc.Document(
            "",
            "calibration of the paper's prototype",
            verdict(self),
            f"Estimated from the nine measured averages of {CITATION}. Each of their intervals "
            f"comes from three runs: its half width is {T_POINT:.2f} standard errors, and the row "
            "follows Student's t with 2 degrees of freedom rather than a normal distribution.",
            (
                gallery("unknowns"),
                doc.Section(
                    "95 % intervals, viscous friction", (_interval_table(self), *said["valleys"])
                ),
                gallery("predictions"),
                doc.Section("Models", (_model_table(self),)),
                doc.Section("Conclusions", (*said["conclusions"], *said["shipped"])),
                gallery("coverage"),
                doc.Section("The boxes and the reasons for them", (_box_table(),), brief=False),
                doc.Section("Other readings of J20/J10", (_reading_table(self),), brief=False),
            ),
            footer=(*_sampling(self), f"rr-opt {__version__}"),
        )


def _best(one: Assessment) -> dict[str, float]:
    """The unknowns of the best fit, SI."""
    best = values(one.model.unknowns, one.student.point[None])
    return {name: float(value[0]) for name, value in best.items()}


def _scores(one: Assessment) -> dict[str, float | None]:
    return {
        "deviance": one.student.deviance,
        "chi_square": one.normal.deviance,
        "degrees_of_freedom": one.aicc.freedom,
        "aicc": one.aicc.value,
        "aicc_normal": one.aicc_normal.value,
        "table3_deviance": one.table3.deviance,
        "table3_aicc": one.aicc_table3.value,
        "left_out_deviance": one.left_out_deviance,
    }


def _interval_rows(found: Calibration) -> _Rows:
    return [
        {"unknown": one.unknown.name, "unit": one.unknown.unit, "column": one.column,
         **_ends("box", one.unknown.box),
         "posterior_low": one.posterior[0], "posterior_median": one.median,
         "posterior_high": one.posterior[1],
         **_ends("profile", one.profile.ends(one.unknown)),
         **_ends("profile_normal", one.normal.ends(one.unknown)),
         "share_of_box": one.share, "verdict": one.verdict}
        for one in found.intervals()
    ]  # fmt: skip


def _ends(name: str, interval: tuple[float, float]) -> dict[str, float]:
    return {f"{name}_low": interval[0], f"{name}_high": interval[1]}


def _model_rows(found: Calibration) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        boot, best = one.bootstrap, _best(one)
        rows.append(
            {"model": name, "column": column, "unknowns": len(one.model.unknowns), **_scores(one),
             "sets_made": boot.sets if boot else None,
             "sets_as_bad": boot.as_bad if boot else None,
             "sets_gaining_as_much": boot.gaining_as_much if boot else None,
             **{f"best_{unknown}": best.get(unknown) for unknown in UNKNOWNS}}
        )  # fmt: skip
    return rows


def _prediction_rows(found: Calibration) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        data = measured(column)
        z = one.student.z(data)
        for i, row in enumerate(ROWS):
            rows.append(
                {"model": name, "column": column, "row": _label(row), "ratio": row.ratio,
                 "period": row.period, "amplitude": row.amplitude, "measured": data.speed[i],
                 "half_width": row.half_width, "standard_error": data.error[i],
                 "predicted": one.student.speeds[i], "z": z[i], "z_left_out": one.left_out[i]}
            )  # fmt: skip
    return rows


def _label(row: Row) -> str:
    if row.amplitude is None:
        return f"Table 2, ratio {row.ratio:g}"
    return f"Table 3, T = {row.period:g} s, α = {row.amplitude:g}"


def _profile_rows(found: Calibration) -> _Rows:
    rows = []
    for (name, column), one in found.assessments.items():
        profiles = {"student": one.profiles}
        if name == VISCOUS:
            profiles["normal"] = found.normal_profiles[column]
        for law, of in profiles.items():
            for unknown, profile in zip(one.model.profiled, of, strict=True):
                at = UNKNOWNS[unknown].value(profile.grid)
                rows += [
                    {"model": name, "column": column, "law": law, "unknown": unknown, "value": x,
                     "rise": rise}
                    for x, rise in zip(at, profile.rise, strict=True)
                ]  # fmt: skip
    return rows


def _posterior_rows(found: Calibration) -> _Rows:
    rows = []
    for column, sample in found.posterior.items():
        chosen = np.linspace(0, len(sample.points) - 1, _DRAWS).astype(int)
        at = values(MODELS[VISCOUS].unknowns, sample.points[chosen])
        at["deviance"] = sample.deviance[chosen]
        rows += [
            {"column": column, **{name: of[i] for name, of in at.items()}} for i in range(_DRAWS)
        ]
    return rows


_SHORT: dict[Column, str] = {"mean": "first column", "other": "v_exp"}
_TONES: dict[str, doc.Tone] = {
    "pinned down": "good",
    "narrowed": "note",
    "not identifiable": "warn",
}


def verdict(found: Calibration) -> str:
    """The comparison of the models in a headline."""
    left_out = {key: one.left_out_deviance for key, one in found.assessments.items()}
    if all(left_out[DRY, column] < left_out[VISCOUS, column] for column in COLUMNS):
        return (
            "Viscous friction alone fits badly and dry friction helps, but nine averages prove "
            "neither"
        )
    return "The nine averages cannot distinguish the models"


def conclusions(found: Calibration) -> dict[str, tuple[str, ...]]:
    """Conclusions (`conclusions`), the combinations that the rows determine instead of single
    values (`valleys`), and whether the shipped robot's values are inside (`shipped`)."""
    texts = prose(
        "rr_paper",
        "calibration.md",
        found=found,
        unknowns=UNKNOWNS,
        readings=READINGS,
        joint_level=JOINT_LEVEL,
    )
    return {key: one.paragraphs for key, one in texts.items()}


def _interval_table(found: Calibration) -> doc.Table:
    head = ("Unknown", "Measured", "Box", "Posterior", "Profile, Student", "Profile, normal",
            "Verdict")  # fmt: skip
    return doc.table(
        head,
        [
            (one.unknown.symbol, _SHORT[one.column], one.unknown.box_text,
             one.unknown.span(one.posterior), one.profile_text(one.profile),
             one.profile_text(one.normal), doc.Badge(one.verdict, _TONES[one.verdict]))
            for one in found.intervals()
        ],
    )  # fmt: skip


def _model_table(found: Calibration) -> doc.Table:
    head = ("Model", "Measured", "Unknowns", "Deviance", "χ², normal", "Degrees of freedom", "AICc",
            "Left-out rows", "AICc, Table 3 alone")  # fmt: skip
    return doc.table(
        head,
        [
            (one.model.words, _SHORT[column], len(one.model.unknowns),
             f"{one.student.deviance:.1f}", f"{one.normal.deviance:.1f}", one.aicc.freedom,
             str(one.aicc), f"{one.left_out_deviance:.0f}", str(one.aicc_table3))
            for (_, column), one in found.assessments.items()
        ],
    )  # fmt: skip


def _box_table() -> doc.Table:
    return doc.table(
        ("Unknown", "Box", "Why"),
        [
            (
                f"{one.symbol}: {one.words}",
                one.box_text + (", flat in the logarithm" * one.log),
                one.why,
            )
            for one in UNKNOWNS.values()
        ],
    )


def _reading_table(found: Calibration) -> doc.Table:
    deviance = {
        (READINGS[0], name, column): one.student.deviance
        for (name, column), one in found.assessments.items()
    }
    deviance |= {
        (one.reading, one.model.name, one.column): one.student.deviance
        for one in found.alternatives
    }
    return doc.table(
        ("J20/J10", "Model", "Deviance, first column", "Deviance, v_exp"),
        [
            (reading.words, MODELS[name].words,
             *(f"{deviance[reading, name, column]:.1f}" for column in COLUMNS))
            for name in (VISCOUS, DRY)
            for reading in READINGS
        ],
    )  # fmt: skip


def _sampling(found: Calibration) -> tuple[str, str]:
    samples = ", ".join(
        f"{len(one.points)} draws with split R-hat {one.rhat:.2f} ({_SHORT[column]})"
        for column, one in found.posterior.items()
    )
    needed = ", ".join(number(float(rise), 2) for rise in found.coverage.rise_needed)
    return (
        f"Posteriors: {samples}",
        f"Rise in deviance not exceeded by 95 % of the true values in {found.coverage.sets} "
        f"simulated data sets, for each unknown in turn: {needed}",
    )
