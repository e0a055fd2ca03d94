"""Where the model goes wrong: which unknown input would explain most of the misfit.

An input enters by a channel of the machine, a force or a motion, as a function of a variable such
as the speed. The channel whose input explains most is at fault; the others follow the motion.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from rr_opt.sysid.diagnosis import Residue, Stage
from rr_opt.sysid.machine import CONSTANT
from rr_opt.sysid.remainder import Dependence


def stages(
    found: Sequence[Dependence], inputs: Mapping[str, str], excess: float, *, faulty: bool
) -> tuple[Stage, ...]:
    """The best input of each channel.

    inputs  the channels, and each input in words
    excess  RMS in sigma that there is to explain
    faulty  whether anything is left out, so that the leading channel is at fault
    """
    best = {
        channel: max((one for one in found if one.channel == channel), key=lambda one: one.gain)
        for channel in inputs
        if any(one.channel == channel for one in found)
    }
    leading = max(best.values(), key=lambda one: one.gain, default=None)
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
    """An input and what it depends on, in words; empty if it may be none."""
    if not one.certain:
        return ""
    if one.variable == CONSTANT:
        return f"{inputs[one.channel]} that is constant"
    plain = one.variable in ("time", "place")
    return f"{inputs[one.channel]} that depends on {'' if plain else 'the '}{one.variable}"


def residues(found: Sequence[Dependence], inputs: Mapping[str, str]) -> Iterator[Residue]:
    """What is left as functions of what it depends on, the two strongest."""
    shown = [one for one in found if one.certain and one.curve.at.size]
    for one in shown[:2]:
        sentence = (
            f"What is left looks like {where(one, inputs)}; that would explain "
            f"{100 * one.share:.0f} % of it."
        )
        c = one.curve
        yield Residue(one.channel, c.variable, c.unit, c.at, c.mean, c.error, one.share, sentence)
