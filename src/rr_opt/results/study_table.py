"""What a study varies, in words: its keys, and their values in customary units."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.design.study.row import CaseOptimum, Row
from rr_opt.documents.archive import netcdf_writer, write_dataset
from rr_opt.documents.document import heading
from rr_opt.files.study_axes import Axis, ProblemKey
from rr_opt.files.study_file import Study
from rr_opt.formatting import QUANTITIES, direction_text, with_unit
from rr_opt.model.parameters import PARAMETERS, SYMBOLS
from rr_opt.results.limits import BOUND_NAMES, LIMIT_NAMES, TOTAL_NAMES
from rr_opt.units import to_si
from rr_opt.version import __version__

_SMALL = {"m": ("mm", 1e3), "N m s": ("µN m s", 1e6)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""


def unit_of(key: ProblemKey) -> tuple[str, float]:
    """The unit, empty for none, and how many of it are one SI unit."""
    name = str(key.path[-1] if isinstance(key.path[-1], str) else key.path[-2])
    kind = QUANTITIES.get(name.removesuffix("_limit"))
    unit, factor = kind.common if kind else (key.unit or "", 1.0)
    return _SMALL.get(unit, (unit, factor))


def value_text(key: ProblemKey, value: Any, digits: int = 4) -> str:
    """A value of a key for people: a float, SI, in customary units; infinity is `no limit`."""
    if not isinstance(value, float):
        return str(value)
    unit, factor = unit_of(key)
    return with_unit(factor * value, unit, digits) if np.isfinite(value) else "no limit"


def key_words(key: ProblemKey) -> str:
    """`rate limit` for limits.rate, `mass of platform 1` for robot.platform1.m; else the key."""
    *above, name = map(str, key.path)
    for parameter in PARAMETERS.values():
        if key.path == ("robot", *parameter.key):
            return parameter.full_words
    if above == ["limits"]:
        return "singularity margin" if name == "singularity" else f"{name} limit"
    if above == ["robot", "servo"]:
        return f"servo's {name.replace('_', ' ')}"
    if above in ([], ["gait"]) and name in QUANTITIES:
        return QUANTITIES[name].words
    return key.name


def axis_words(axis: Axis) -> str:
    """What varies along an axis: `masses of both platforms`, or the first key and how many more."""
    keys = [line.key for line in axis.lines]
    symbol = str(keys[0].path[-1])
    both = {("robot", f"platform{number}", symbol) for number in (1, 2)}
    if len(keys) == 2 and {key.path for key in keys} == both and symbol in SYMBOLS:
        return f"{SYMBOLS[symbol].plural} of both platforms"
    more = f" and {len(keys) - 1} more" if len(keys) > 1 else ""
    return key_words(keys[0]) + more


def setting_text(words: str, value: str) -> str:
    """`rate limit 30 rpm`, `no rate limit`."""
    if value == "no limit" and words.endswith(" limit"):
        return f"no {words}"
    return f"{words} {value}"


def held_words(held: tuple[str, ...]) -> list[str]:
    """The active limits and bounds of an optimum in words; `nothing` if there are none."""
    return [name.replace("inertia_ratio", "J20/J10") for name in held] or ["nothing"]


_OF_OPTIMUM = (
    ("speed", "m/s", "mean speed along the path, positive along platform 1"),
    ("amplitude", "rad", "largest |phi - offset|"),
    ("period", "s", "period of the gait"),
    ("offset", "rad", "mean of phi"),
    ("ratio", "1", "J20/J10"),
    ("cycle_length", "m", "path per period"),
    ("turn", "rad", "heading gained per period"),
    ("radius", "m", "of the circle; empty if straight"),
    ("peak_angle", "rad", "largest |phi|"),
    ("peak_rate", "rad/s", "largest |dphi/dt|"),
    ("peak_torque", "N m", "largest |torque| of the servo"),
    ("least_s1", "m", "smallest S1 = c1 cos phi + c2"),
    ("peak_grip", "1", "largest side force of an axle over the load on it"),
    ("energy_per_metre", "J/m", "positive work of the servo per metre of path, without recovery"),
    ("net_energy_per_metre", "J/m", "net work of the servo per metre: what friction takes"),
    ("cost_of_transport", "1", "energy_per_metre over the weight"),
)


@dataclass(frozen=True)
class StudyColumn:
    """A quantity of every case: its SI unit ("1" for plain numbers, empty for text), a phrase
    describing it, and a cell for each case, None if not applicable.

    asked  the requested unit of a varied key; empty: the SI unit
    """

    name: str
    unit: str
    meaning: str
    cells: Sequence[Any]
    asked: str = ""

    @property
    def heading(self) -> str:
        """The column's heading in a table: name and unit."""
        return heading(self.name, self.asked or self.unit)

    @property
    def in_table(self) -> Sequence[Any]:
        """The cells in the requested unit."""
        if not self.asked or self.asked == self.unit:
            return self.cells
        worth = to_si(f"1 {self.asked}", self.unit)
        return [cell / worth for cell in self.cells]


def study_columns(
    study: Study,
    rows: Sequence[Row],
    branches: Sequence[int | None],
    fronts: Mapping[str, Sequence[int]],
) -> list[StudyColumn]:
    """All of them, in order; branches: the number of each case's branch of optima; fronts: by cost,
    the Pareto-optimal cases in speed and cost."""
    inputs = [study.inputs(case) for case in range(len(rows))]

    def of_rows(name: str, unit: str, meaning: str, cell: Callable[[Row], Any]) -> StudyColumn:
        return StudyColumn(name, unit, meaning, [cell(row) for row in rows])

    def of_optima(
        name: str, unit: str, meaning: str, cell: Callable[[CaseOptimum], Any]
    ) -> StudyColumn:
        return of_rows(name, unit, meaning, lambda row: row.optimum and cell(row.optimum))

    def price(name: str, what: str, prices: Callable[[CaseOptimum], Any]) -> StudyColumn:
        unit, meaning = QUANTITIES[name].unit, f"speed gained per unit of the {what}"
        per = f"m/s per {unit}" if unit else "m/s"
        # An inactive limit has zero price.
        return of_optima(f"price_{name}", per, meaning, lambda one: prices(one).get(name, 0.0))

    on_fronts = [
        "; ".join(name for name, cases in fronts.items() if case in cases)
        for case in range(len(rows))
    ]
    near, none = "|speed| expected from the neighbours", (None, None)
    branch = "family of optima that it belongs to"
    warm = "cold: from initial guesses; warm: from neighbours' optima"
    return [
        StudyColumn("case", "1", "number of the case", range(len(rows))),
        *(
            StudyColumn(
                line.key.name,
                "" if line.numbers is None else line.key.unit or "1",
                "varied",
                [one[line.key.name] for one in inputs],
                "" if line.numbers is None else line.unit,
            )
            for axis in study.axes
            for line in axis.lines
        ),
        of_rows("status", "", "how the case ended", lambda row: row.status.value),
        StudyColumn("branch", "1", branch, branches),
        of_rows("started", "", warm, lambda row: row.started),
        of_optima("drives", "", "which way", lambda one: direction_text(one.speed)),
        *(of_optima(*described, attrgetter(described[0])) for described in _OF_OPTIMUM),
        of_optima("held_by", "", "active limits and bounds", lambda one: "; ".join(one.held)),
        StudyColumn("fronts", "", "costs for which no case is both faster and cheaper", on_fronts),
        *(price(name, "limit", attrgetter("prices")) for name in (*LIMIT_NAMES, *TOTAL_NAMES)),
        *(price(name, "active bound", attrgetter("bound_prices")) for name in BOUND_NAMES),
        of_rows("expected_least", "m/s", f"least {near}", lambda row: (row.expected or none)[0]),
        of_rows("expected_most", "m/s", f"most {near}", lambda row: (row.expected or none)[1]),
        of_rows("seconds", "s", "of CPU spent on the case", attrgetter("seconds")),
        of_rows("message", "", "the outcome in words", attrgetter("message")),
    ]


def write_netcdf(path: Path, study: Study, columns: Iterable[StudyColumn]) -> Path:
    """Write every column over the axes of the study, with units and meanings."""
    names = [axis.lines[0].key.name for axis in study.axes]
    inputs = {line.key.name for axis in study.axes for line in axis.lines}
    data = netcdf_writer().Dataset(attrs={"title": study.name, "source": f"rr-opt {__version__}"})
    for name, axis in zip(names, study.axes, strict=True):
        for line in axis.lines:
            steps = line.numbers or [str(value) for value in line.values]
            data = data.assign_coords({line.key.name: (name, np.array(steps))})
            data[line.key.name].attrs.update(units=line.key.unit or "1")
    for column in columns:
        if column.name not in inputs:
            data[column.name] = (names, _array(column).reshape(study.shape))
            units = {"units": column.unit} if column.unit else {}
            data[column.name].attrs.update(long_name=column.meaning, **units)
    return write_dataset(path, data)


def _array(column: StudyColumn) -> np.ndarray:
    if not column.unit:
        return np.array([cell or "" for cell in column.cells], object)
    return np.array([math.nan if cell is None else cell for cell in column.cells], float)
