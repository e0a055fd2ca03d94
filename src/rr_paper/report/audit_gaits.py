"""The audit of the paper's gaits: limits, posture, period, amplitude, turning."""

from __future__ import annotations

import math

from rr_opt.answers.quantities import number
from rr_opt.answers.speed import SpeedAnswer
from rr_opt.outcome import Status
from rr_opt.report.document import Cell
from rr_paper.gaits import Peak
from rr_paper.publication import (
    ANGLE_LIMIT,
    BEST_AMPLITUDE,
    FIGURE_4,
    FIGURE_5,
    FIGURE_6,
    RATE_LIMIT,
    RPM,
)
from rr_paper.report.audit import (
    Finding,
    columns_finding,
    missing_finding,
    readings_finding,
    signs_finding,
)
from rr_paper.reproduction import Reproduction


def limits_finding(found: Reproduction) -> Finding:
    """What the paper's gaits demand of the servo."""
    over = [one for one in found.demands if one.excess is not None]
    driven = sum(one.where.startswith("Table 3") for one in over)
    rates = ", ".join(f"{one.where} {number(one.rpm, 3)} rpm" for one in over)
    fourth, fifth = found.ratio_surface.too_fast, found.period_surface.too_fast
    return Finding(
        "limits",
        "Runs and ranges beyond Table 1's 30 rpm",
        f"{driven} of Table 3's six runs, Table 2, Fig. 6 and much of Figs. 4 and 5 are beyond the "
        "limit that the paper states.",
        (
            f"30 rpm is {number(RATE_LIMIT)} rad/s, and the sine's peak rate is 2 pi alpha/T, so "
            "the limit is alpha <= T/2 in rad and s.",
            f"Beyond it: {rates}.",
            f"Of Fig. 4's plane {number(100 * fourth, 3)} % is beyond it, all amplitudes above "
            f"{number(FIGURE_4.period[0] / 2)} rad; of Fig. 5's {number(100 * fifth, 3)} %.",
            "Either 30 rpm is no hard limit, or the servo did not follow these commands and the "
            "robot moved less than the amplitudes suggest. The paper does not say.",
        ),
        ("gait", "amplitude, rad", "period, s", "peak rate, rpm", "over 30 rpm by, rpm"),
        tuple((one.where, one.amplitude, one.period, one.rpm, one.excess) for one in found.demands),
    )


def posture_finding(found: Reproduction) -> Finding:
    """Where the model breaks down."""
    posture = found.posture
    largest = max(FIGURE_4.amplitude[1], FIGURE_5.amplitude[1])
    return Finding(
        "posture",
        "The singular posture is within the servo's range",
        f"At |phi| = {number(posture.angle, 3)} rad the equations divide by 0; the servo may go to "
        f"{number(ANGLE_LIMIT)} rad.",
        (
            "Equations (3) and (4) are divided by S1 = c1 cos phi + c2, which vanishes at phi = "
            f"arccos(-c2/c1): {number(posture.angle)} rad for the shipped prototype, and "
            f"{number(posture.least, 3)} to {number(posture.largest, 3)} rad for all a1 and a2 in "
            "the box. There the line of axle 2 passes through the centre of axle 1, and next to it "
            "speeds without side slip grow without bound.",
            f"Table 1 allows {number(ANGLE_LIMIT)} rad ({number(math.degrees(ANGLE_LIMIT), 3)} "
            f"deg). The paper's plots stop at {number(largest)} rad and do not reach the posture; "
            "the paper does not mention it. Its offsets phi0 of -pi to pi (section 3.2) exceed "
            "both.",
        ),
        ("robot", "singular angle, rad", "servo's limit, rad"),
        (
            ("shipped prototype", posture.angle, ANGLE_LIMIT),
            ("least over a1, a2", posture.least, ANGLE_LIMIT),
            ("largest over a1, a2", posture.largest, ANGLE_LIMIT),
        ),
    )


def period_finding(found: Reproduction) -> Finding:
    """How the speed depends on the period."""
    ratios, (viscous, printed) = found.period.ratios, found.period.spreads
    inside = sum(one.low <= one.model <= one.high for one in ratios)
    means = ", ".join(f"{number(one.mean, 3)} ({_span(one.low, one.high)})" for one in ratios)
    largest = max(viscous.largest, printed.largest)
    above = sum(one.other > largest for one in ratios)
    swapped = ", ".join(_span(one.other_low, one.other_high) for one in ratios)
    outside = sum(one.other_low > largest for one in ratios)
    return Finding(
        "period",
        "Speed falls as 1/T^2 with viscous friction; do the tables?",
        "The column with intervals neither confirms nor excludes the law. The column v_exp "
        "violates it: it is not a simulation with one viscous friction.",
        (
            "With viscous friction the speed at a fixed amplitude goes nearly as 1/T^2, so "
            "v(1 s)/v(2 s) is near 4 whatever the unknowns: over "
            f"{viscous.robots} random robots of the box and amplitudes of Table 3's range its "
            f"median is {number(viscous.q50, 3)}, 90 % lie between {number(viscous.q05, 3)} and "
            f"{number(viscous.q95, 3)}, and the largest is {number(viscous.largest, 3)}. With the "
            f"signs as printed: {number(printed.q50, 3)}, {number(printed.q05, 3)} to "
            f"{number(printed.q95, 3)}, at most {number(printed.largest, 3)}.",
            f"Measured (the mean column, with Fieller's 95 % interval): {means}. The model's own "
            f"ratio is within {inside} of {len(ratios)} intervals. The ratios grow with the "
            "amplitude, as dry friction would have it, but the intervals do not require that.",
            f"v_exp: {', '.join(number(one.other, 3) for one in ratios)}. {above} of them exceed "
            "anything that viscous friction gave with either set of signs. If this column is the "
            "simulation, its friction was not the viscous one of section 2, or k was fitted to "
            "each run anew. If it is the measured one and the intervals are its own, its ratios "
            f"are {swapped}: {outside} of {len(ratios)} exclude {number(largest, 3)}, the largest "
            "of all.",
        ),
        ("amplitude, rad", "model", "mean", "mean from", "mean to", "v_exp", "v_exp from",
         "v_exp to"),
        tuple(
            (one.amplitude, one.model, one.mean, one.low, one.high, one.other, one.other_low,
             one.other_high)
            for one in ratios
        ),
    )  # fmt: skip


def _span(low: float, high: float) -> str:
    if math.isinf(high):
        return f"above {number(low, 3)}"
    return f"{number(low, 3)} to {number(high, 3)}"


def amplitude_finding(found: Reproduction) -> Finding:
    """What remains of the best amplitude."""
    best = found.best
    own = "; ".join(f"{_peak_text(peak)} for J20/J10 = {number(J)}" for J, peak in best.own)
    fitted = [peak for _, peak in best.fitted]
    amplitudes = [peak.amplitude for peak in fitted]
    reversing = sum(peak.reverses is not None for peak in fitted)
    robots = "; ".join(
        f"at J20/J10 = {number(one.ratio)} {one.inside} of {one.robots} have a maximum below 1.4 "
        f"rad, 90 % of these between {number(one.quantiles[0], 3)} and "
        f"{number(one.quantiles[2], 3)} rad, and {one.reversing} reverse beyond it"
        for one in best.robots
    )
    confirmed = all(one.status is Status.OPTIMAL for one in (best.limited, best.unlimited))
    return Finding(
        "amplitude",
        "Is about 1 rad the best amplitude?",
        f"Not under the paper's own limit, which leaves {number(best.allowed)} rad at T = 1 s. "
        "Without limits it depends on the unknowns.",
        (
            "The paper: speed grows with the amplitude up to about "
            f"{number(BEST_AMPLITUDE)} rad, then falls, and finally reverses. With the shipped "
            f"prototype at T = 1 s the best amplitude is {own}.",
            f"Of the robots fitted to the tables it is {number(min(amplitudes), 3)} to "
            f"{number(max(amplitudes), 3)} rad for J20/J10 = 0.3; {reversing} of {len(fitted)} "
            f"reverse beyond it. Of random robots of the box, {robots}.",
            f"The fastest gait within Fig. 5's range and 30 rpm is {_gait_text(best.limited)}; "
            f"without limits it is {_gait_text(best.unlimited)}, at the corner of the range. "
            f"Optimiser, simulation and sweep {'agree' if confirmed else 'do not agree'} on both.",
            "So with a servo that keeps to 30 rpm the best gait is a small one at the shortest "
            "period, and 1 rad cannot be driven below T = 2 s.",
        ),
        ("robot", "J20/J10", "best amplitude at T = 1 s, rad", "a maximum", "reverses at, rad"),
        (
            *(("shipped prototype", J, *_peak_cells(peak)) for J, peak in best.own),
            *((f"fitted: {name}", 0.3, *_peak_cells(peak)) for name, peak in best.fitted),
        ),
    )


def _peak_cells(peak: Peak) -> tuple[Cell, ...]:
    return peak.amplitude, "yes" if peak.inside else "end of range", peak.reverses


def _peak_text(peak: Peak) -> str:
    after = f" (reversing at {number(peak.reverses, 3)} rad)" if peak.reverses else ""
    return f"{number(peak.amplitude, 3)} rad{after}"


def _gait_text(answer: SpeedAnswer) -> str:
    best = answer.optimum.best
    if best is None:
        return "not found"
    return (
        f"{number(best.gait.amplitude, 3)} rad at {number(best.gait.period, 3)} s with "
        f"{number(1e3 * abs(best.speed), 3)} mm/s"
    )


def turning_finding(found: Reproduction) -> Finding:
    """The claim at the paper's gaits, and elsewhere."""
    turning = found.turning
    sign, radius, first = turning.sign, turning.radius, turning.circles[0]
    radii = ", ".join(number(one.circle.radius, 3) for one in turning.circles)
    both = turning.sides_hold and turning.radii_hold
    end = float(turning.offset[-1])
    if turning.changes_side_at is not None:
        beyond = f"The turn changes sides at phi0 = {number(turning.changes_side_at, 3)} rad."
    else:
        radius_text = (
            " and the radius falls"
            if turning.tightest_at >= end
            else f", but the radius grows again from {number(turning.tightest_at, 3)} rad"
        )
        beyond = (
            f"The turn stays on its side{radius_text} up to {number(end, 3)} rad, next to the "
            "singular posture."
        )
    return Finding(
        "turning",
        "Does the sign of phi0 define the direction, and a larger phi0 a smaller radius?",
        f"At the paper's three gaits {'both hold' if both else 'it does not hold'}. In general "
        "neither does.",
        (
            f"At alpha = {number(FIGURE_6.amplitude)} rad and T = {number(FIGURE_6.period)} s the "
            f"radii are {radii} m for the three offsets, all to the "
            f"{'left' if first.circle.heading > 0 else 'right'}, and the mirrored gaits turn to "
            f"the other side. {beyond}",
            f"Of the {sign.gaits} gaits of the shipped problem with an offset above 0 that keep "
            f"every limit, {sign.rarer} turn to the other side than the rest: "
            f"{sign.forward_left + sign.backward_left} left, "
            f"{sign.forward_right + sign.backward_right} right. The side depends on the direction "
            f"of travel: forward {sign.forward_left} left and {sign.forward_right} right, "
            f"backward {sign.backward_left} left and {sign.backward_right} right.",
            f"The radius grows somewhere with the offset on {radius.growing} of {radius.curves} "
            "curves of one amplitude and period. Offsets up to pi (section 3.2) cannot be driven, "
            "because the singular posture is in between.",
            f"All three gaits demand {number(first.gait.peak_rate * RPM, 3)} rpm of the servo; "
            f"Table 1 allows {number(RATE_LIMIT * RPM, 3)}.",
        ),
        ("phi0, rad", "radius, m", "heading per period, rad", "speed, m/s", "once round, s",
         "heading at -phi0, rad"),
        tuple(
            (one.gait.offset, one.circle.radius, one.circle.heading, one.circle.speed,
             one.circle.time_round, one.mirrored.heading)
            for one in turning.circles
        ),
    )  # fmt: skip


def findings(found: Reproduction) -> tuple[Finding, ...]:
    """All of them, in reading order."""
    return (
        signs_finding(found),
        missing_finding(found),
        columns_finding(found),
        readings_finding(found),
        limits_finding(found),
        posture_finding(found),
        period_finding(found),
        amplitude_finding(found),
        turning_finding(found),
    )
