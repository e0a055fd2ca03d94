"""(h) "The sign of phi0 defines the direction"."""

from __future__ import annotations

from rr_opt.paper.printed import FIGURE_6
from rr_opt.paper.reproduction import Reproduction
from rr_opt.paper.surfaces import RATE_LIMIT, RPM
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number


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
