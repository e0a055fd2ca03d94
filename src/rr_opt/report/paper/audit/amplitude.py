"""(g) "About 1 rad, for our prototype"."""

from __future__ import annotations

from rr_opt.paper.best_amplitude import Peak
from rr_opt.paper.fastest import Fastest
from rr_opt.paper.printed import BEST_AMPLITUDE
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section, Value
from rr_opt.report.quantities import number


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
