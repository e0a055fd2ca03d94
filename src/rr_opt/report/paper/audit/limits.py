"""(d) Runs beyond 30 rpm, and (e) the singular posture."""

from __future__ import annotations

import math

from rr_opt.paper.printed import FIGURE_4, FIGURE_5
from rr_opt.paper.reproduction import Reproduction
from rr_opt.paper.surfaces import RATE_LIMIT, RPM
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number


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
