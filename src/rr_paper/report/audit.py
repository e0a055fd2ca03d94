"""The audit in plain words: each section tells what was computed, and what follows."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.answers.quantities import number
from rr_opt.model.ballast import Loads, load_count
from rr_paper.consistency import (
    BOX,
    KAPPA,
    RATIOS,
    ROWS,
    STUDENT,
    WIDEST_WHEEL,
    Tried,
    stops_in,
    wheel_for,
)
from rr_paper.equation3 import CORRECTED, PRINTED
from rr_paper.printed import TABLE_2, TABLE_3
from rr_paper.reproduction import Reproduction

Value = str | float | None


@dataclass(frozen=True)
class Section:
    """key names it in files; finding is one sentence; head and rows are the table.

    Rows hold plain values in SI, or in the unit that the head gives; None is left empty.
    """

    key: str
    title: str
    finding: str
    sentences: tuple[str, ...]
    head: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]


def signs_section(found: Reproduction, mujoco: float | None) -> Section:
    """Which signs mechanics gives; mujoco: a speed as in `sections`."""
    audit = found.signs
    off = {one.signs.name: one for one in audit.off}
    energy = {one.signs.name: one for one in audit.energy}
    wrong, right = off[PRINTED.name], off[CORRECTED.name]
    printed, corrected = energy[PRINTED.name], energy[CORRECTED.name]
    driven = audit.driven
    gait = f"amplitude {number(driven.gait.amplitude)} rad, period {number(driven.gait.period)} s"
    seconds = number(float(driven.t[-1]))
    way = "makes" if printed.nowhere > 0 else "destroys"
    return Section(
        "signs",
        "Equation (3) is printed with wrong signs",
        "B1, B2 and D have the other sign, and epsilon inside B2 too. No way of counting v or phi "
        "mends it.",
        (
            f"Equation (3) was held against two derivations at {audit.states} states of random "
            "robots: Kane's method, done by CasADi from positions and velocities, and two "
            "separate bodies held together by Lagrange multipliers. They share no code, and agree "
            f"with each other on the servo's torque to {audit.torque:.0e}.",
            f"With corrected signs (3) agrees with both to {right.multipliers:.0e}. As printed its "
            f"median error is {number(100 * wrong.median, 3)} %. Counting v the other way turns "
            "B1, B2 and D together, but not epsilon; the median error is then "
            f"{number(100 * audit.off[1].median, 3)} %. Every term is even in phi, so counting phi "
            "the other way changes nothing.",
            f"From rest ({gait}, {seconds} s) Kane and the multipliers take P along the same path "
            f"to {driven.apart[0]:.0e} m, and the corrected (3) with (4) to {driven.apart[1]:.0e} "
            f"m. As printed, (3) with (4) ends {number(driven.apart[2], 3)} m off at most.",
            "Energy is a third witness. A robot that moves in a steady cycle as printed must be "
            f"pushed by a force, up to {number(printed.force, 3)} N, that nothing exerts. It "
            f"{way} {number(1e3 * abs(printed.nowhere), 3)} mW on average, while friction takes "
            f"{number(1e3 * printed.friction, 3)} mW. With corrected signs what the servo gives "
            f"is what friction takes, to {_rounded(corrected.gap / corrected.friction)} of it.",
            "The printed signs change the mean speed of this gait from "
            f"{number(1e3 * corrected.speed, 3)} to {number(1e3 * printed.speed, 3)} mm/s.",
            *_third(mujoco, corrected.speed),
        ),
        ("signs of (3)", "largest error against Kane", "against multipliers", "median error",
         "servo, mW", "friction, mW", "from nowhere, mW", "mean speed, m/s"),
        tuple(
            (
                name, one.kane, one.multipliers, one.median,
                *(
                    (1e3 * e.servo, 1e3 * e.friction, 1e3 * e.nowhere, e.speed)
                    if (e := energy.get(name))
                    else (None, None, None, None)
                ),
            )
            for name, one in off.items()
        ),
    )  # fmt: skip


def _third(mujoco: float | None, speed: float) -> tuple[str, ...]:
    if mujoco is None:
        return ()
    apart = 100 * abs(mujoco / speed - 1)
    return (
        "A three-dimensional model in MuJoCo, four wheels rolling on a floor, knows none of these "
        f"equations. It drives this gait at {number(1e3 * mujoco, 4)} mm/s, {number(apart, 1)} % "
        "from the corrected equation.",
    )


def _rounded(error: float) -> str:
    """An error that may be nothing at all."""
    return f"{max(abs(error), 1e-16):.0e}"


def left_out_section(found: Reproduction) -> Section:
    """The unknowns, and how much a speed hangs on each."""
    row, tables = found.start.row, found.tables
    spans = " or ".join(
        f"{number(low, 3)} to {number(high, 3)} rad" for low, high in tables.allowed
    )
    spread = sorted(found.left_out, key=lambda one: one.least / one.largest)
    told = ", ".join(
        f"{one.name} from {number(1e3 * one.least, 3)} to {number(1e3 * one.largest, 3)} mm/s"
        for one in spread
    )
    return Section(
        "left-out",
        "What Table 1 leaves out",
        "The speeds cannot be computed from what is printed.",
        (
            "Not given: c1, a1, c2 and a2 apart (only c1 - a1 and c2 - a2), the half tracks b1 and "
            "b2, the wheel radius h, the unit of kappa = 0.25, the amplitude of Table 2, and at "
            "which J20/J10 Fig. 3 was driven. h matters only through k = kappa/h^2.",
            f"At amplitude {number(row.amplitude or 0.0)} rad, period {number(row.period)} s and "
            f"J20/J10 = {number(row.ratio)}, moving one unknown of the shipped prototype over its "
            f"box and leaving the others moves the speed: {told}.",
            f"Friction is therefore a fit and no measurement, here k = {number(found.robot.k1, 3)} "
            "N s/m per wheel. Read as 0.25 mN m s, the printed kappa gives this k with wheels of "
            f"{number(1e3 * wheel_for(found.robot.k1), 3)} mm radius, which the paper does not "
            "say.",
            "With the shipped prototype all three rows of Table 2 are within their intervals for "
            f"amplitudes of {spans or 'no value'}; the best is {number(tables.amplitude, 3)} rad.",
        ),
        ("unknown", "unit", "assumed", "box from", "box to", "least speed, m/s",
         "largest speed, m/s"),
        tuple(
            (one.name, one.unit, one.assumed, one.low, one.high, one.least, one.largest)
            for one in found.left_out
        ),
    )  # fmt: skip


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


_LOADED = (*(row.ratio for row in TABLE_2), TABLE_3[0].ratio)
_QUESTIONS = {"ratio": "J20/J10", "kappa": "kappa", "equation": "equation (3)"}


def readings_section(found: Reproduction) -> Section:
    """What is consistent with the nine averages, and with Table 1."""
    audit = found.consistency
    mean, other = audit.of("ratio", "mean"), audit.of("ratio", "other")
    braked = audit.of("kappa", "mean")[-1]
    kappas = "; ".join(
        f"{one.name}: {number(one.fit.chi2, 3)} (p = {number(one.p, 2)})"
        for one in audit.of("kappa", "mean")
    )
    printed = audit.of("equation", "mean")[0]
    bare = "; ".join(
        f"{one.reading.name} {number(one.low, 3)}"
        + (f" to {number(one.high, 3)}" if one.high - one.low > 1e-6 else "")
        for one in audit.bare
    )
    missing = "; ".join(
        f"{one.reading.name} leaves out {_listed(one.reached)}" for one in audit.bare
    )
    k = KAPPA / WIDEST_WHEEL**2
    loads = ", ".join(
        number(load_count(found.robot, ratio, "joint", Loads()), 2) for ratio in _LOADED
    )
    return Section(
        "readings",
        "Which readings the data allow",
        "The nine averages exclude kappa in N m s, and no reading of J20/J10. Table 1 excludes "
        "those about the centres of mass and the axles.",
        (
            f"Each reading was fitted with all that is open: {_box()}. Chi-square is in standard "
            f"errors, half width/{number(STUDENT)}. These come from three runs each, so p is "
            "told from Student's t and not from the normal law, for which all would be rejected.",
            f"J20/J10: five readings leave chi-squares of {_span(mean)} on the mean column and "
            f"{_span(other)} on v_exp, p about {number(mean[0].p, 2)} and {number(other[0].p, 2)}. "
            "The averages do not tell them apart, nor the unknowns: "
            f"{sum(_at_edge(one) for one in mean)} of {len(mean)} fits to the mean column end on "
            "an edge of the box.",
            f"Table 1 does. Without loads J20/J10 is: {bare}. Loads only add to it. Of the printed "
            f"ratios, {missing}.",
            f"About P the 66 g loads come to {loads} for Table 2's ratios and 0.3, if all hang "
            "where the shipped robot assumes: no whole numbers. They hung elsewhere, or the ratio "
            "is another.",
            f"kappa on the mean column: {kappas}. In N m s it means at least {number(k, 3)} N s/m "
            f"a wheel, which brakes it to 1/e in {number(1e3 * stops_in(k), 2)} ms; that leaves "
            f"{number(braked.fit.chi2, 3)}, as if the robot did not move at all "
            f"({number(audit.still['mean'], 3)}).",
            f"The printed equation (3) leaves {number(printed.fit.chi2, 3)}, as little as the "
            "corrected one, with other values of the unknowns "
            f"(a2 = {number(1e3 * printed.fit.values['a2'], 2)} mm against "
            f"{number(1e3 * mean[0].fit.values['a2'], 2)} mm). Agreement with the tables is thus "
            "no evidence for its signs.",
            f"v_exp fits worse than mean under every reading. With {len(ROWS)} numbers and up to "
            "five unknowns that is a hint, and no proof, that the mean column is the measured one.",
        ),
        ("question", "reading", "column", "chi-square", "unknowns fitted", "p", "a1, m", "a2, m",
         "b, m", "k, N s/m", "Table 2's amplitude, rad"),
        tuple(_row(one) for one in audit.tried),
    )  # fmt: skip


def _box() -> str:
    units = {"a1": "m", "a2": "m", "b": "m", "k": "N s/m", "amplitude": "rad"}
    return ", ".join(
        f"{name} {number(low)} to {number(high)} {units[name]}" for name, (low, high) in BOX.items()
    ).replace("amplitude", "Table 2's amplitude")


def _row(one: Tried) -> tuple[str | float, ...]:
    return (
        _QUESTIONS[one.question],
        one.name,
        "mean" if one.column == "mean" else "v_exp",
        one.fit.chi2,
        float(one.fit.free),
        one.p,
        *(one.fit.values[name] for name in ("a1", "a2", "b", "k", "amplitude")),
    )


def _at_edge(one: Tried) -> bool:
    """Some unknown was fitted to an end of its range."""
    return any(
        min(abs(one.fit.values[name] - end) for end in ends) < 1e-3 * (ends[1] - ends[0])
        for name, ends in BOX.items()
    )


def _span(tried: list[Tried]) -> str:
    chi2 = [one.fit.chi2 for one in tried]
    return f"{number(min(chi2), 3)} to {number(max(chi2), 3)}"


def _listed(reached: tuple[float, ...]) -> str:
    left = [number(one) for one in RATIOS if one not in reached]
    if not left:
        return "none"
    return "all of them" if len(left) == len(RATIOS) else ", ".join(left)
