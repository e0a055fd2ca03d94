"""The two speed columns of Tables 2 and 3."""

from __future__ import annotations

from rr_opt.paper.nine_rows import ROWS
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section


def columns_section(found: Reproduction) -> Section:
    """Both readings of the columns, row by row."""
    rows = [*found.tables.table2, *found.tables.table3]
    agree = [one.columns_agree for one in rows]
    off = [str(i) for i, one in enumerate(found.tables.table3, 1) if not one.columns_agree]
    near_mean = sum(one.near_mean for one in found.tables.table3)
    near_other = sum(one.near_other for one in found.tables.table3)
    return Section(
        "columns",
        "The two speed columns have unclear heads",
        "One column has intervals, so it is measured; the other is headed v_exp. Either that head "
        "is wrong, or the heads are swapped.",
        (
            "One column is headed mean +- t sigma/sqrt(n). A deterministic simulation has no such "
            "interval, so this column is measured, from n = 3 runs. The other is headed v_exp, "
            "which says measured too. Reading 1: v_exp is the simulation, its head wrong. "
            "Reading 2: the heads are swapped, v_exp is measured and its intervals are printed "
            "beside the simulation.",
            "The paper concludes that the simulation is within the intervals. Either way it says "
            f"that the columns differ by less than a half width: so they do in {sum(agree)} of "
            f"{len(ROWS)} rows."
            + (f" Not in row {', '.join(off)} of Table 3." if off else ""),
            f"The shipped prototype is within the interval of {near_mean} of Table 3's six rows "
            f"under reading 1, and of {near_other} under reading 2. Its friction was chosen with "
            "reading 1 in mind. It drives backward, platform 2 ahead; the paper does not say "
            "which platform leads.",
        ),
        ("table", "J20/J10", "period, s", "amplitude, rad", "mean, m/s", "half width, m/s",
         "v_exp, m/s", "model, m/s", "model within mean", "model within v_exp",
         "v_exp within mean"),
        tuple(
            (
                "2" if one.row.amplitude is None else "3",
                one.row.ratio, one.row.period, one.amplitude, one.row.mean, one.row.half_width,
                one.row.other, one.speed, _yes(one.near_mean), _yes(one.near_other),
                _yes(one.columns_agree),
            )
            for one in rows
        ),
    )  # fmt: skip


def _yes(true: bool) -> str:
    return "yes" if true else "no"
