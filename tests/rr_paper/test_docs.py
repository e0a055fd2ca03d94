"""The numbers of docs/paper.md are the computed ones."""

import re
from pathlib import Path

import pytest

from rr_opt.formatting import number
from rr_paper.prototype import ABOUT_P
from rr_paper.signs import CORRECTED, PRINTED

TEXT = " ".join(
    (Path(__file__).parents[2] / "docs" / "paper.md").read_text(encoding="utf-8").split()
)


def statements(found):
    """What the page says, written with computed numbers."""
    rows = found.tables.rows
    yield f"{sum(one.within_mean for one in rows)} of the {len(rows)} averages"
    yield f"in all {sum(one.columns_agree for one in rows)} rows"

    printed = next(one for one in found.signs.deviations if one.signs is PRINTED)
    energy = {one.signs: one for one in found.signs.energy}
    yield f"is {number(100 * printed.median, 3)} %"
    yield f"at {found.signs.states} states"
    yield f"force of up to {number(energy[PRINTED].force, 3)} N"
    speeds = (number(1e3 * abs(energy[signs].speed), 3) for signs in (CORRECTED, PRINTED))
    yield f"between {' and '.join(speeds)} mm/s"

    a2 = next(one for one in found.sensitivities if one.name == "a2")
    yield f"from {number(1e3 * a2.least, 3)} to {number(1e3 * a2.largest, 3)} mm/s"
    bare = {one.definition.name: one.low for one in found.consistency.unloaded}
    yield f"the ratio is {number(bare['about the centres of mass'], 3)} about the centres"
    yield f"it is {number(bare[ABOUT_P.name], 3)}, which leaves out 0.08"

    asked = {one.where: one for one in found.demands}
    yield f"one to {number(asked['Table 3, row 3'].rpm, 3)} rpm"
    yield f"Fig. 6 with {number(asked['Fig. 6'].rpm, 3)} rpm"
    yield f"{100 * found.ratio_surface.too_fast:.0f} % of Fig. 4"
    yield f"{100 * found.period_surface.too_fast:.0f} % of Fig. 5"
    yield f"posture, {number(found.posture.angle, 3)} rad"

    for column in ("mean", "other"):
        one, two, three = (number(getattr(r, column), 3) for r in found.period.ratios)
        yield f"{one}, {two} and {three}"

    for one in (found.best.limited, found.best.unlimited):
        best = one.optimum.best
        yield f"{number(best.gait.amplitude, 3)} rad and {number(best.gait.period, 3)} s"
        yield f"{number(1e3 * abs(best.speed), 3)} mm/s"
    low, middle, high = (number(peak.amplitude, 3) for _, peak in found.best.own)
    yield f"{low} rad for J20/J10 = 0.08, {middle} rad for 0.2 and {high} rad for 0.3"

    one, two, three = (number(c.circle.radius, 3) for c in found.turning.circles)
    yield f"radii of {one}, {two} and {three} m"
    sign, radius = found.turning.sign, found.turning.radius
    yield f"Of the {sign.gaits} gaits"
    yield f"{sign.rarer} turn to the other side"
    yield f"{radius.growing} of {radius.curves} curves"


def test_the_page_has_them(found):
    assert [words for words in statements(found) if words not in TEXT] == []


@pytest.mark.parametrize("link", re.findall(r"\]\((\S+?)\)", TEXT))
def test_its_links_lead_somewhere(link):
    assert (Path(__file__).parents[2] / "docs" / link).exists()
