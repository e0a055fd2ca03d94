"""A gait and its speed as facts."""

from __future__ import annotations

from rr_opt.documents.document import Fact
from rr_opt.formatting import QUANTITIES, direction_text, speed_text, with_unit
from rr_opt.model.gait import FourierGait, FreeGait, Gait

_NEGLIGIBLE = 1e-4
"""A coefficient this small, relative to the largest, is what an optimiser leaves of 0."""


def gait_facts(gait: Gait) -> tuple[Fact, ...]:
    """Shape, amplitude, period, offset and, of a Fourier gait, the coefficients."""
    return (
        Fact("gait", *_shape(gait)),
        _both("amplitude", gait.amplitude),
        Fact("period", with_unit(gait.period, "s"), f"({with_unit(1 / gait.period, 'Hz')})"),
        _both("offset", gait.offset),
        *_harmonics(gait),
    )


def _shape(gait: Gait) -> tuple[str, str]:
    if isinstance(gait, FourierGait):
        return f"{gait.harmonics} harmonics", "phi(t) = offset + harmonics of the period"
    if isinstance(gait, FreeGait):
        return "free", f"phi(t) with a constant acceleration on each of {gait.pieces} intervals"
    return "sine", "phi(t) = amplitude sin(2 pi t/period) + offset"


def _both(name: str, value: float) -> Fact:
    first, _, second = QUANTITIES[name].both(value).partition(" (")
    return Fact(name, first, f"({second}")


def _harmonics(gait: Gait) -> tuple[Fact, ...]:
    if not isinstance(gait, FourierGait):
        return ()
    least = _NEGLIGIBLE * max(map(abs, gait.sines + gait.cosines))
    facts = []
    for n, sizes in enumerate(zip(gait.sines, gait.cosines, strict=True), 1):
        sine, cosine = (with_unit(size if abs(size) >= least else 0, "rad") for size in sizes)
        facts.append(Fact(f"harmonic {n}", f"{sine} of the sine, {cosine} of the cosine"))
    return tuple(facts)


def speed_fact(speed: float) -> Fact:
    """A signed mean speed, and which platform leads."""
    leading = 1 if speed > 0 else 2
    return signed_fact("speed", speed, f"{direction_text(speed)}: platform {leading} leads")


def signed_fact(label: str, speed: float, detail: str) -> Fact:
    """A signed speed in m/s, with mm/s and a remark as its detail."""
    value, _, other = speed_text(speed).partition(" (")
    return Fact(label, value, f"({other}, {detail}" if other else detail)
