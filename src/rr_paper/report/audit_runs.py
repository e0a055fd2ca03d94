"""The audit of the paper's runs: limits, posture, period, amplitude, turning."""

from __future__ import annotations

import math

from rr_opt.answers.quantities import number
from rr_paper.best_amplitude import Fastest, Peak
from rr_paper.printed import BEST_AMPLITUDE, FIGURE_4, FIGURE_5, FIGURE_6
from rr_paper.report.audit import (
    Section,
    Value,
    columns_section,
    left_out_section,
    readings_section,
    signs_section,
)
from rr_paper.reproduction import Reproduction
from rr_paper.surfaces import RATE_LIMIT, RPM


def limits_section(found: Reproduction) -> Section:
    """What the paper's gaits ask of the servo."""
    over = [one for one in found.asked if one.too_fast]
    driven = [one for one in over if one.where.startswith("Table 3")]
    told = ", ".join(f"{one.where} {number(one.rpm, 3)} rpm" for one in over)
    fourth, fifth = found.ratio_surface.too_fast, found.period_surface.too_fast
    return Section(
        "limits",
        "Runs and ranges beyond Table 1's 30 rpm",
        f"{len(driven)} of Table 3's six runs, Table 2, Fig. 6 and much of Figs. 4 and 5 are "
        "beyond the limit that the paper states.",
        (
            f"30 rpm is {number(RATE_LIMIT)} rad/s, and the sine's peak rate is 2 pi alpha/T: the "
            "limit is alpha <= T/2 in rad and s.",
            f"Beyond it: {told}.",
            f"Of Fig. 4's plane {number(100 * fourth, 3)} % lies beyond, all amplitudes above "
            f"{number(FIGURE_4.period[0] / 2)} rad; of Fig. 5's {number(100 * fifth, 3)} %.",
            "Either 30 rpm is no hard limit, or the servo did not follow these commands and the "
            "robot moved less than the amplitudes say. The paper does not tell which.",
        ),
        ("gait", "amplitude, rad", "period, s", "peak rate, rpm", "over 30 rpm by, rpm"),
        tuple(
            (one.where, one.amplitude, one.period, one.rpm,
             one.rpm - RATE_LIMIT * RPM if one.too_fast else None)
            for one in found.asked
        ),
    )  # fmt: skip


def posture_section(found: Reproduction) -> Section:
    """Where the model says nothing."""
    posture = found.posture
    most = max(FIGURE_4.amplitude[1], FIGURE_5.amplitude[1])
    return Section(
        "posture",
        "The singular posture is within the servo's range",
        f"At |phi| = {number(posture.angle, 3)} rad the equations divide by 0; the servo may go to "
        f"{number(posture.servo)} rad.",
        (
            "Equations (3) and (4) are divided by S1 = c1 cos phi + c2, which vanishes at phi = "
            f"arccos(-c2/c1): {number(posture.angle)} rad for the shipped prototype, and "
            f"{number(posture.least, 3)} to {number(posture.largest, 3)} rad for all a1 and a2 "
            "in the box. There axle 2's line runs through the middle of axle 1, and speeds without "
            "side slip grow without bound next to it.",
            f"Table 1 allows {number(posture.servo)} rad "
            f"({number(math.degrees(posture.servo), 3)} deg). The paper's plots stop at "
            f"{number(most)} rad and do not meet it; it does not name it. Its offsets phi0 of "
            "-pi to pi (section 3.2) go beyond both.",
        ),
        ("robot", "singular angle, rad", "servo's limit, rad"),
        (
            ("shipped prototype", posture.angle, posture.servo),
            ("least over a1, a2", posture.least, posture.servo),
            ("largest over a1, a2", posture.largest, posture.servo),
        ),
    )


def period_section(found: Reproduction) -> Section:
    """What the period does to the speed."""
    law = found.period
    all_robots, printed = law.spreads
    inside = sum(one.low <= one.model <= one.high for one in law.ratios)
    means = ", ".join(f"{number(one.mean, 3)} ({_span(one.low, one.high)})" for one in law.ratios)
    others = [one.other for one in law.ratios]
    most = max(one.largest for one in law.spreads)
    above = sum(one > most for one in others)
    swapped = ", ".join(_span(one.other_low, one.other_high) for one in law.ratios)
    outside = sum(one.other_low > most for one in law.ratios)
    return Section(
        "period",
        "Speed falls as 1/T^2 with viscous friction; do the tables?",
        "The column with intervals neither confirms nor excludes the law. The column v_exp breaks "
        "it: it is no simulation with one viscous friction.",
        (
            "With viscous friction the speed at a fixed amplitude goes nearly as 1/T^2, so "
            "v(1 s)/v(2 s) is near 4 whatever the unknowns: over "
            f"{all_robots.robots} random robots of the box and amplitudes of Table 3's range its "
            f"median is {number(all_robots.q50, 3)}, 90 % lie within {number(all_robots.q05, 3)} "
            f"and {number(all_robots.q95, 3)}, and the largest is {number(all_robots.largest, 3)}. "
            f"With the signs as printed: {number(printed.q50, 3)}, {number(printed.q05, 3)} to "
            f"{number(printed.q95, 3)}, at most {number(printed.largest, 3)}.",
            f"Measured (the mean column, with Fieller's 95 % interval): {means}. The model's own "
            f"ratio is within {inside} of {len(law.ratios)} intervals. The ratios grow with the "
            "amplitude, as dry friction would have it, but the intervals do not force that.",
            f"v_exp: {', '.join(number(one, 3) for one in others)}. {above} of them are beyond "
            "anything that viscous friction gave, with these signs or those. If this column is the "
            "simulation, its friction was not the viscous one of section 2, or k was fitted for "
            "each run anew. If it is the measured one and the intervals are its own, its ratios "
            f"are {swapped}: {outside} of {len(law.ratios)} leave out {number(most, 3)}, the "
            "largest of all.",
        ),
        ("amplitude, rad", "model", "mean", "mean from", "mean to", "v_exp", "v_exp from",
         "v_exp to"),
        tuple(
            (one.amplitude, one.model, one.mean, one.low, one.high, one.other,
             one.other_low, one.other_high)
            for one in law.ratios
        ),
    )  # fmt: skip


def _span(low: float, high: float) -> str:
    if math.isinf(high):
        return f"above {number(low, 3)}"
    return f"{number(low, 3)} to {number(high, 3)}"


def amplitude_section(found: Reproduction) -> Section:
    """What becomes of the best amplitude."""
    best = found.best
    own = "; ".join(f"{_told(peak)} for J20/J10 = {number(J)}" for J, peak in best.own)
    fitted = [one.peak.amplitude for one in best.fitted]
    reversing = sum(one.peak.reverses is not None for one in best.fitted)
    robots = "; ".join(
        f"at J20/J10 = {number(one.ratio)} {one.inside} of {one.robots} have a maximum below 1.4 "
        f"rad, 90 % of these within {number(one.quantiles[0], 3)} and "
        f"{number(one.quantiles[2], 3)} rad, and {one.reversing} reverse beyond it"
        for one in best.robots
    )
    limited, free = best.fastest
    return Section(
        "amplitude",
        "Is about 1 rad the best amplitude?",
        f"Not under the paper's own limit, which leaves {number(best.allowed)} rad at T = 1 s. "
        "Without limits it depends on the unknowns.",
        (
            "The paper: speed grows with the amplitude up to about "
            f"{number(BEST_AMPLITUDE)} rad, then falls, and at last reverses. With the shipped "
            f"prototype at T = 1 s the best amplitude is {own}.",
            "The robots fitted to the tables have it at "
            f"{number(min(fitted), 3)} "
            f"to {number(max(fitted), 3)} rad for J20/J10 = 0.3; "
            f"{reversing} of {len(fitted)} reverse beyond it. Of random robots of the box, "
            f"{robots}.",
            f"The fastest gait within Fig. 5's range and 30 rpm is {_gait(limited)}; without "
            f"limits it is {_gait(free)}, at the corner of the range. Optimiser, simulation and "
            f"sweep {'agree' if limited.confirmed and free.confirmed else 'do not agree'} on both.",
            "So for a servo that keeps to 30 rpm the best gait is a small one at the shortest "
            "period, and 1 rad cannot be driven below T = 2 s.",
        ),
        ("robot", "J20/J10", "best amplitude at T = 1 s, rad", "a maximum", "reverses at, rad"),
        (
            *(("shipped prototype", J, *_peak(peak)) for J, peak in best.own),
            *((f"fitted: {one.name}", 0.3, *_peak(one.peak)) for one in best.fitted),
        ),
    )


def _peak(peak: Peak) -> tuple[Value, ...]:
    return peak.amplitude, "yes" if peak.inside else "end of range", peak.reverses


def _told(peak: Peak) -> str:
    after = f" (reversing at {number(peak.reverses, 3)} rad)" if peak.reverses else ""
    return f"{number(peak.amplitude, 3)} rad{after}"


def _gait(one: Fastest) -> str:
    best = one.optimum.best
    if best is None:
        return "not found"
    return (
        f"{number(best.gait.amplitude, 3)} rad at {number(best.gait.period, 3)} s with "
        f"{number(1e3 * abs(best.speed), 3)} mm/s"
    )


def turning_section(found: Reproduction) -> Section:
    """The claim at the paper's gaits, and elsewhere."""
    turning = found.turning
    radii = ", ".join(number(one.circle.radius, 3) for one in turning.circles)
    both = turning.sides_hold and turning.radii_hold
    sign, radius = turning.sign, turning.radius
    rate = turning.circles[0].gait.peak_rate * RPM
    further = (
        f"The turn changes sides at phi0 = {number(turning.turns_at, 3)} rad."
        if turning.turns_at is not None
        else "The turn keeps its side"
        + (
            " and the radius falls"
            if turning.tightest_at >= turning.offset[-1]
            else f", but the radius grows again from {number(turning.tightest_at, 3)} rad"
        )
        + f" up to {number(float(turning.offset[-1]), 3)} rad, next to the singular posture."
    )
    return Section(
        "turning",
        "Does the sign of phi0 define the direction, and a larger phi0 a smaller radius?",
        f"At the paper's three gaits {'both hold' if both else 'it does not hold'}. In general "
        "neither does.",
        (
            f"At alpha = {number(FIGURE_6.amplitude)} rad and T = {number(FIGURE_6.period)} s the "
            f"radii are {radii} m for the three offsets, all "
            f"to the {'left' if turning.circles[0].circle.heading > 0 else 'right'}, and their "
            "mirror images to the other side. " + further,
            f"Of the {sign.gaits} gaits of the shipped problem with an offset above 0 that keep "
            f"every limit, {sign.rarer} turn to the other side than the rest: "
            f"{sign.forward_left + sign.backward_left} left, "
            f"{sign.forward_right + sign.backward_right} right. The side goes with the way the "
            f"robot drives: forward {sign.forward_left} left and {sign.forward_right} right, "
            f"backward {sign.backward_left} left and {sign.backward_right} right.",
            f"The radius grows somewhere with the offset on {radius.growing} of {radius.curves} "
            "curves of one amplitude and period. Offsets up to pi (section 3.2) cannot be driven: "
            "the singular posture is in between.",
            f"All three gaits ask {number(rate, 3)} rpm of the servo; Table 1 gives "
            f"{number(RATE_LIMIT * RPM, 3)}.",
        ),
        ("phi0, rad", "radius, m", "heading per period, rad", "speed, m/s", "once round, s",
         "heading at -phi0, rad"),
        tuple(
            (one.gait.offset, one.circle.radius, one.circle.heading, one.circle.speed,
             one.circle.time_round, one.mirrored.heading)
            for one in turning.circles
        ),
    )  # fmt: skip


def sections(found: Reproduction, mujoco: float | None) -> tuple[Section, ...]:
    """All sections, in the order in which they are read.

    mujoco: the mean speed of the gait of Fig. 3 by a MuJoCo model, m/s, if there is one.
    """
    return (
        signs_section(found, mujoco),
        left_out_section(found),
        columns_section(found),
        readings_section(found),
        limits_section(found),
        posture_section(found),
        period_section(found),
        amplitude_section(found),
        turning_section(found),
    )
