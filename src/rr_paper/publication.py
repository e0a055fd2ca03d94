"""The numbers that the paper prints, as printed; they are in `data/paper.toml`.

Experimental Investigations of the Controlled Motion of the Roller Racer Robot, in: D. Chugo
et al. (Eds.), CLAWAR 2021, LNNS 324, pp. 428-437 (2022). Tables 1-3 and Figs. 3-6 are in its
section 3.

Known errata and omissions:
- Table 1 gives no unit for kappa, no b and no h, and c - a instead of c and a.
- Tables 2 and 3 head one column `v_exp`, but only the other column has a confidence interval, so
  that one must have been measured. Here the first is `mean` and the second `other`.
- Table 2 does not state its amplitude.
- J20/J10 of Tables 2 and 3 is not I20/I10 of Table 1 (0.453); see `rr_opt.model.ballast`.
- Section 3.1 sets J20/J10 to 0.08, 0.14, 0.17, 0.19 and 0.2; Table 2 has 0.16, 0.18 and 0.2.
- The signs of equation (3) contradict equations (1), (2) and (4); see `rr_paper.signs`.

The points of the paper's figures are not printed as numbers, so they are not included.
"""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

from scipy.special import stdtrit

from rr_opt.documents.document import Captions

CITATION = (
    "Kilin, Karavaev, Yefremov: Experimental Investigations of the Controlled Motion of the "
    "Roller Racer Robot. CLAWAR 2021, LNNS 324, pp. 428-437 (2022)"
)


def read_data(name: str) -> dict[str, Any]:
    """A table of `rr_paper/data`."""
    return tomllib.loads((Path(__file__).parent / "data" / name).read_text(encoding="utf-8"))


_PAPER = read_data("paper.toml")


class Value(NamedTuple):
    """A number of Table 1 with its unit; None where the table prints none."""

    value: float
    unit: str | None = None


TABLE_1 = {name: Value(**one) for name, one in _PAPER["table_1"].items()}
"""Table 1, the parameters of the prototype."""

ANGLE_LIMIT = TABLE_1["greatest angle phi"].value
"""Table 1's largest servo angle, rad."""
RPM = 30 / math.pi
"""1 rad/s in rpm."""
RATE_LIMIT = TABLE_1["greatest rate dphi/dt"].value * 2 * math.pi / 60
"""Table 1's largest servo rate, 30 rpm in rad/s."""

RUNS = 3
"""Runs behind each row of Tables 2 and 3 (section 3.1: "sample size - 3")."""
T_POINT = float(stdtrit(RUNS - 1, 0.975))
"""The 97.5 % point of Student's t, 4.303: the printed half widths are t s/sqrt(n)."""

Column = Literal["mean", "other"]
COLUMNS: tuple[Column, ...] = ("mean", "other")
"""The two speed columns. Which of them was measured is unclear."""


@dataclass(frozen=True)
class Row:
    """A row of Table 2 or 3.

    ratio       J20/J10
    period      T, s
    mean        the column with the interval, m/s; by its head the mean of n = 3 runs
    half_width  of the 95 % interval, t s/sqrt(n), m/s
    other       the column headed v_exp, m/s
    amplitude   alpha, rad; None where the paper does not state it
    """

    ratio: float
    period: float
    mean: float
    half_width: float
    other: float
    amplitude: float | None = None

    @property
    def standard_error(self) -> float:
        """Standard error of the mean, m/s, itself estimated from three runs."""
        return self.half_width / T_POINT

    def speed(self, column: Column) -> float:
        """The speed in a column, m/s."""
        return self.mean if column == "mean" else self.other


TABLE_2, TABLE_3 = (
    tuple(Row(**row) for row in _PAPER["rows"][name]) for name in ("table_2", "table_3")
)
ROWS = (*TABLE_2, *TABLE_3)
"""All nine rows, Table 2 first."""


@dataclass(frozen=True)
class Surface:
    """The ranges of a surface plot, ends included: amplitude (rad), J20/J10 and period (s)."""

    amplitude: tuple[float, float]
    ratio: tuple[float, float]
    period: tuple[float, float]


FIGURE_4, FIGURE_5 = (
    Surface(**{name: tuple(ends) for name, ends in _PAPER[figure].items()})
    for figure in ("figure_4", "figure_5")
)

LOADED_RATIOS = tuple(_PAPER["text"]["loaded_ratios"])
RATIOS = tuple(sorted({*LOADED_RATIOS, *(row.ratio for row in ROWS)}))
"""Every J20/J10 that the paper prints."""


@dataclass(frozen=True)
class Circles:
    """The gaits of Fig. 6: amplitude in rad, period in s, ratio J20/J10, offsets phi0 in rad."""

    amplitude: float
    period: float
    ratio: float
    offsets: tuple[float, ...]


FIGURE_6 = Circles(**_PAPER["figure_6"] | {"offsets": tuple(_PAPER["figure_6"]["offsets"])})
BEST_AMPLITUDE = _PAPER["text"]["best_amplitude"]
"""rad, up to which speed increases according to the paper's conclusion."""


def captions(of: str) -> Captions:
    """Captions of the calibration or of the reproduction, by the figure's name."""
    return {
        name: (one["title"], one["alt"], one["caption"])
        for name, one in read_data(f"{of}_figures.toml").items()
    }
