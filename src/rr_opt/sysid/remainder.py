"""The residual of a fit: where a missing input enters, and what it depends on.

An unknown input, a force or motion that the model lacks, is expanded in a few functions of one
variable at a time. A score test gives the gain in likelihood of each without fitting it. An input
enters through a channel of the machine. The channel whose input explains most is at fault; the
others follow the motion.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, chdtri

from rr_opt.sysid.diagnosis import Curve, Residue, Stage
from rr_opt.sysid.estimation import Fit, Linear, overdispersion
from rr_opt.sysid.machine import CONSTANT, Term
from rr_opt.sysid.model import Linearisation, Segment
from rr_opt.sysid.score_test import ScoreTest
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True)
class Dependence:
    """What a term explains.

    gain   likelihood ratio statistic (twice the log); if nothing is missing, chi-square with one
           degree of freedom per function of the term
    share  of the loss beyond the noise, 0 to 1, that it removes
    curve  the input as a function of the variable
    """

    term: Term
    gain: float
    share: float
    curve: Curve

    @property
    def channel(self) -> str:
        """Where it enters."""
        return self.term.channel

    @property
    def variable(self) -> str:
        """The variable that it is a function of."""
        return self.term.variable

    @property
    def degrees(self) -> int:
        """Degrees of freedom."""
        return len(self.term.columns)

    @property
    def certain(self) -> bool:
        """Whether noise would hardly ever gain as much."""
        return self.gain > float(chdtri(self.degrees, SETTINGS.certain))

    @property
    def p_value(self) -> float:
        """Chance of so large a gain where nothing is missing."""
        return float(chdtrc(self.degrees, max(self.gain, 0.0)))


def dependences(
    fit: Fit, terms: Sequence[Term], parts: Mapping[Segment, Linearisation]
) -> list[Dependence]:
    """What each term explains of the fit's residual, beyond what machines of this kind may deviate
    from any model; most first."""
    if not terms:
        return []
    nq = len(fit.problem.names)
    # Bounded: a gain that takes a quantity beyond its bounds does not count as explained.
    test = ScoreTest.of(Linear(fit.problem, fit.linear.made, parts, fit.states), fit.values, nq)
    beyond = max(sum(e.value - e.samples for e in fit.evidences.values()), 1.0)
    # Beyond the misfit that there is, which the robust loss allows for.
    problem, off = fit.problem, fit.problem.model.form_error**2
    ratios = [
        overdispersion(problem, k, off * problem.samples[k]) / overdispersion(problem, k, e.excess)
        for k, e in fit.evidences.items()
    ]
    phi = float(np.mean(np.maximum(ratios, 1.0)))
    out = []
    for term in terms:
        own = [nq + k for k in term.columns]
        gain, _, d = test.gain(own)
        inverse = np.linalg.inv(test.H[np.ix_(test.keep(own), test.keep(own))])
        spread = np.einsum("ki,ij,kj->k", term.shapes, inverse[nq:, nq:], term.shapes)
        error = np.sqrt(phi * np.maximum(spread, 0.0))
        curve = Curve(term.variable, term.unit, term.at, term.shapes @ d[own], error)
        out.append(Dependence(term, gain / phi, float(np.clip(gain / beyond, 0, 1)), curve))
    return sorted(out, key=_lead, reverse=True)


def _lead(one: Dependence) -> float:
    """Its gain beyond what its degrees of freedom gain by chance."""
    return one.gain - one.degrees


def stages(
    found: Sequence[Dependence], inputs: Mapping[str, str], excess: float, *, faulty: bool
) -> tuple[Stage, ...]:
    """The best input of each channel.

    inputs  the channels, and each input in words
    excess  misfit to explain, RMS in sigma
    faulty  whether anything is missing, so that the leading channel is at fault
    """
    best = {
        channel: max((one for one in found if one.channel == channel), key=_lead)
        for channel in inputs
        if any(one.channel == channel for one in found)
    }
    leading = max(best.values(), key=_lead, default=None)
    return tuple(
        Stage(
            channel.replace("_", " "),
            channel,
            one.gain,
            one.p_value,
            excess * float(np.sqrt(one.share)),
            faulty and one is leading and one.certain,
            where(one, inputs),
            (one.curve,) if one.curve.at.size else (),
        )
        for channel, one in best.items()
    )


def where(one: Dependence, inputs: Mapping[str, str]) -> str:
    """An input and what it depends on, in words; empty if it is not significant."""
    if not one.certain:
        return ""
    if one.variable == CONSTANT:
        return f"{inputs[one.channel]} that is constant"
    plain = one.variable in ("time", "place")
    return f"{inputs[one.channel]} that depends on {'' if plain else 'the '}{one.variable}"


def residues(found: Sequence[Dependence], inputs: Mapping[str, str]) -> Iterator[Residue]:
    """The residual as a function of what it depends on: the two strongest dependences."""
    shown = [one for one in found if one.certain and one.curve.at.size]
    for one in shown[:2]:
        sentence = (
            f"The residual looks like {where(one, inputs)}, which would explain "
            f"{100 * one.share:.0f} % of it."
        )
        c = one.curve
        yield Residue(one.channel, c.variable, c.unit, c.at, c.mean, c.error, one.share, sentence)
