"""(c) Which readings of J20/J10, kappa and the columns the averages allow."""

from __future__ import annotations

from rr_opt.paper.consistency import KAPPA, RATIOS, WIDEST_WHEEL, Tried, stops_in
from rr_opt.paper.fit import STUDENT
from rr_opt.paper.nine_rows import BOX, ROWS
from rr_opt.paper.printed import TABLE_2, TABLE_3
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number
from rr_opt.robot.ballast import Loads, load_count

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
