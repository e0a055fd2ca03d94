"""The audit of the paper's model: equation (3), missing values, columns, what the data allow."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.answers.quantities import number
from rr_opt.model.ballast import Loads, load_count
from rr_opt.report.document import Cell, Table, table
from rr_paper.consistency import KAPPA, LARGEST_WHEEL, Hypothesis
from rr_paper.equation3 import CORRECTED, PRINTED, REVERSED
from rr_paper.prototype import BOX, UNITS
from rr_paper.publication import RATIOS, ROWS, T_POINT, TABLE_1, TABLE_2, TABLE_3
from rr_paper.reproduction import Reproduction


@dataclass(frozen=True)
class Finding:
    """A question about the paper: `key` names it in files; `finding` answers it in a sentence.

    head, rows  its table: SI values, or in the unit of the head
    """

    key: str
    title: str
    finding: str
    sentences: tuple[str, ...]
    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]

    @property
    def table(self) -> Table:
        """Its numbers."""
        return table(self.head, self.rows)


def signs_finding(found: Reproduction) -> Finding:
    """Which signs mechanics gives."""
    audit, path = found.signs, found.signs.comparison
    deviation = {one.signs: one for one in audit.deviations}
    energy = {one.signs: one for one in audit.energy}
    wrong, right = deviation[PRINTED], deviation[CORRECTED]
    printed, corrected = energy[PRINTED], energy[CORRECTED]
    gait = f"amplitude {number(path.gait.amplitude)} rad, period {number(path.gait.period)} s"
    verb = "adds" if printed.fictitious > 0 else "removes"
    sentences = [
        f"Equation (3) was compared with two derivations at {audit.states} states of random "
        "robots: Kane's method, applied by CasADi to positions and velocities, and two separate "
        "bodies coupled by Lagrange multipliers. They share no code, and agree with each other on "
        f"the servo's torque to {audit.torque:.0e}.",
        f"With corrected signs (3) agrees with both to {right.multipliers:.0e}. As printed its "
        f"median error is {number(100 * wrong.median, 3)} %. Counting v the other way reverses "
        "B1, B2 and D together, but not epsilon; the median error is then "
        f"{number(100 * deviation[REVERSED].median, 3)} %. Every term is even in phi, so counting "
        "phi the other way changes nothing.",
        f"From rest ({gait}, {number(float(path.t[-1]))} s) Kane's method and the multipliers "
        f"move P along the same path to {path.distance[0]:.0e} m, and the corrected (3) with (4) "
        f"to {path.distance[1]:.0e} m. As printed, (3) with (4) is up to "
        f"{number(path.distance[2], 3)} m off.",
        "Energy is a third witness. To move in a steady cycle as printed, the robot would need an "
        f"external force of up to {number(printed.force, 3)} N, which does not exist. It {verb} "
        f"{number(1e3 * abs(printed.fictitious), 3)} mW on average, while friction dissipates "
        f"{number(1e3 * printed.friction, 3)} mW. With corrected signs the servo supplies what "
        "friction dissipates, to a relative error of "
        f"{max(abs(corrected.gap / corrected.friction), 1e-16):.0e}.",
        "The printed signs change the mean speed of this gait from "
        f"{number(1e3 * corrected.speed, 3)} to {number(1e3 * printed.speed, 3)} mm/s.",
    ]
    if found.mujoco is not None:
        apart = 100 * abs(found.mujoco / corrected.speed - 1)
        sentences.append(
            "A three-dimensional MuJoCo model, four wheels rolling on a floor, contains none of "
            f"these equations. It drives this gait at {number(1e3 * found.mujoco, 4)} mm/s, "
            f"{number(apart, 1)} % from the corrected equation."
        )
    rows: list[tuple[Cell, ...]] = []
    for signs, one in deviation.items():
        powers: tuple[Cell, ...] = (None,) * 4
        if e := energy.get(signs):
            powers = (1e3 * e.servo, 1e3 * e.friction, 1e3 * e.fictitious, e.speed)
        rows.append((signs.name, one.kane, one.multipliers, one.median, *powers))
    return Finding(
        "signs",
        "Equation (3) is printed with wrong signs",
        "B1, B2 and D have the wrong sign, and so has epsilon inside B2. No sign convention for v "
        "or phi repairs it.",
        tuple(sentences),
        ("signs of (3)", "largest error against Kane", "against multipliers", "median error",
         "servo, mW", "friction, mW", "from nowhere, mW", "mean speed, m/s"),
        tuple(rows),
    )  # fmt: skip


def missing_finding(found: Reproduction) -> Finding:
    """The unknowns, and how strongly a speed depends on each."""
    row, tables, k = found.start.row, found.tables, found.robot.k1
    ranges = " or ".join(f"{number(a, 3)} to {number(b, 3)} rad" for a, b in tables.allowed)
    spread = sorted(found.sensitivities, key=lambda one: one.least / one.largest)
    moves = ", ".join(
        f"{one.name} from {number(1e3 * one.least, 3)} to {number(1e3 * one.largest, 3)} mm/s"
        for one in spread
    )
    return Finding(
        "left-out",
        "What Table 1 leaves out",
        "The speeds cannot be computed from the printed values.",
        (
            "Not given: c1, a1, c2 and a2 (only c1 - a1 and c2 - a2), the half tracks b1 and b2, "
            "the wheel radius h, the unit of kappa = 0.25, the amplitude of Table 2, and the "
            "J20/J10 of Fig. 3. h matters only through k = kappa/h^2.",
            f"At amplitude {number(row.amplitude or 0.0)} rad, period {number(row.period)} s and "
            f"J20/J10 = {number(row.ratio)}, varying one unknown of the shipped prototype over its "
            f"box with the others fixed moves the speed: {moves}.",
            f"The friction is therefore fitted, not measured: k = {number(k, 3)} N s/m per wheel. "
            "If kappa were 0.25 mN m s, that k would need wheels of "
            f"{number(1e3 * math.sqrt(1e-3 * KAPPA / k), 3)} mm radius, which the paper does not "
            "say.",
            "With the shipped prototype all three rows of Table 2 are within their intervals for "
            f"amplitudes of {ranges or 'no value'}; the best is {number(tables.amplitude, 3)} rad.",
        ),
        ("unknown", "unit", "assumed", "box from", "box to", "least speed, m/s",
         "largest speed, m/s"),
        tuple(
            (one.name, UNITS[one.name], one.assumed, one.low, one.high, one.least, one.largest)
            for one in found.sensitivities
        ),
    )  # fmt: skip


def columns_finding(found: Reproduction) -> Finding:
    """Both interpretations of the columns, row by row."""
    rows, third = found.tables.rows, found.tables.table3
    off = [str(i) for i, one in enumerate(third, 1) if not one.columns_agree]
    exception = f" Not in row {', '.join(off)} of Table 3." if off else ""
    return Finding(
        "columns",
        "The two speed columns have unclear heads",
        "One column has intervals, so it is measured; the other is headed v_exp. Either that head "
        "is wrong, or the heads are swapped.",
        (
            "One column is headed mean +- t sigma/sqrt(n). A deterministic simulation has no such "
            "interval, so this column is measured, from n = 3 runs. The other is headed v_exp, "
            "which suggests a measurement too. Reading 1: v_exp is the simulation, its head wrong. "
            "Reading 2: the heads are swapped, v_exp is measured and its intervals are printed "
            "beside the simulation.",
            "The paper concludes that the simulation is within the intervals. Under either reading "
            "the columns then differ by less than a half width. They do in "
            f"{sum(one.columns_agree for one in rows)} of {len(ROWS)} rows.{exception}",
            f"The shipped prototype is within the interval of {_count(third, 'within_mean')} of "
            f"Table 3's six rows under reading 1, and of {_count(third, 'within_other')} under "
            "reading 2. Its friction was chosen with reading 1 in mind. It drives backward, "
            "platform 2 leading; the paper does not say which platform leads.",
        ),
        ("table", "J20/J10", "period, s", "amplitude, rad", "mean, m/s", "half width, m/s",
         "v_exp, m/s", "model, m/s", "model within mean", "model within v_exp",
         "v_exp within mean"),
        tuple(
            (
                "2" if one.row.amplitude is None else "3", one.row.ratio, one.row.period,
                one.amplitude, one.row.mean, one.row.half_width, one.row.other, one.speed,
                *("yes" if good else "no"
                  for good in (one.within_mean, one.within_other, one.columns_agree)),
            )
            for one in rows
        ),
    )  # fmt: skip


def _count(rows: tuple[object, ...], name: str) -> int:
    return sum(getattr(one, name) for one in rows)


_QUESTIONS = {"ratio": "J20/J10", "kappa": "kappa", "equation": "equation (3)"}


def readings_finding(found: Reproduction) -> Finding:
    """What is consistent with the nine averages, and with Table 1."""
    audit = found.consistency
    mean, other = audit.of("ratio", "mean"), audit.of("ratio", "other")
    kappa, printed = audit.of("kappa", "mean"), audit.of("equation", "mean")[0].fit
    kappas = "; ".join(
        f"{one.name}: {number(one.fit.chi2, 3)} (p = {number(one.p, 2)})" for one in kappa
    )
    unloaded = "; ".join(
        f"{one.definition.name} {number(one.low, 3)}"
        + (f" to {number(one.high, 3)}" if one.high - one.low > 1e-6 else "")
        for one in audit.unloaded
    )
    missing = "; ".join(
        f"{one.definition.name} excludes {_excluded(one.reached)}" for one in audit.unloaded
    )
    k = KAPPA / LARGEST_WHEEL**2
    mass = TABLE_1["m1"].value + TABLE_1["m2"].value
    ratios = (*(row.ratio for row in TABLE_2), TABLE_3[0].ratio)
    loads = ", ".join(
        number(load_count(found.robot, ratio, "joint", Loads()), 2) for ratio in ratios
    )
    box = ", ".join(
        f"{'Table 2' + chr(39) + 's amplitude' if name == 'amplitude' else name} "
        f"{number(low)} to {number(high)} {UNITS[name]}"
        for name, (low, high) in BOX.items()
    )
    return Finding(
        "readings",
        "Which readings the data allow",
        "The nine averages exclude kappa in N m s, but no definition of J20/J10. Table 1 excludes "
        "those about the centres of mass and the axles.",
        (
            f"Each reading was fitted with all unknowns free: {box}. Chi-square is in standard "
            f"errors, half width/{number(T_POINT)}. These come from three runs each, so p is based "
            "on Student's t; by the normal distribution all would be rejected.",
            f"J20/J10: five definitions leave chi-squares of {_range(mean)} on the mean column and "
            f"{_range(other)} on v_exp, with p about {number(mean[0].p, 2)} and "
            f"{number(other[0].p, 2)}. "
            "The averages cannot distinguish them, nor identify the unknowns: "
            f"{sum(_at_edge(one) for one in mean)} of {len(mean)} fits to the mean column end on "
            "an edge of the box.",
            f"Table 1 can. Without loads J20/J10 is: {unloaded}. Loads only add to it. Of the "
            f"printed ratios, {missing}.",
            f"About P, Table 2's ratios and 0.3 take {loads} loads of 66 g, if all hang where the "
            "shipped robot assumes: these are not whole numbers. The loads hung elsewhere, or the "
            "ratio is defined differently.",
            f"kappa on the mean column: {kappas}. In N m s it means at least {number(k, 3)} N s/m "
            f"per wheel, which brakes the robot to 1/e in {number(1e3 * mass / (4 * k), 2)} ms. "
            f"That leaves {number(kappa[-1].fit.chi2, 3)}, as if the robot did not move at all "
            f"({number(audit.still['mean'], 3)}).",
            f"The printed equation (3) leaves {number(printed.chi2, 3)}, as little as the "
            "corrected one, with other values of the unknowns "
            f"(a2 = {number(1e3 * printed.values['a2'], 2)} mm instead of "
            f"{number(1e3 * mean[0].fit.values['a2'], 2)} mm). Agreement with the tables is thus "
            "no evidence for its signs.",
            f"v_exp fits worse than mean under every reading. With {len(ROWS)} numbers and up to "
            "five unknowns that suggests, but does not prove, that the mean column was measured.",
        ),
        ("question", "reading", "column", "chi-square", "unknowns fitted", "p", "a1, m", "a2, m",
         "b, m", "k, N s/m", "Table 2's amplitude, rad"),
        tuple(
            (
                _QUESTIONS[one.question], one.name, "mean" if one.column == "mean" else "v_exp",
                one.fit.chi2, float(one.fit.free), one.p, *(one.fit.values[name] for name in BOX),
            )
            for one in audit.hypotheses
        ),
    )  # fmt: skip


def _at_edge(one: Hypothesis) -> bool:
    """Some unknown ended on a side of the box."""
    return any(
        min(abs(one.fit.values[name] - end) for end in ends) < 1e-3 * (ends[1] - ends[0])
        for name, ends in BOX.items()
    )


def _range(hypotheses: list[Hypothesis]) -> str:
    chi2 = [one.fit.chi2 for one in hypotheses]
    return f"{number(min(chi2), 3)} to {number(max(chi2), 3)}"


def _excluded(reached: tuple[float, ...]) -> str:
    excluded = [number(one) for one in RATIOS if one not in reached]
    return "all of them" if len(excluded) == len(RATIOS) else ", ".join(excluded) or "none"
