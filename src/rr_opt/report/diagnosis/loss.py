"""What the wrong model would have cost, in sentences."""

from __future__ import annotations

from rr_opt.formatting import number, with_unit
from rr_opt.model.gait import Gait
from rr_opt.results.loss import Loss, LossUnknown

_NONE = 5e-4
"""A smaller share of the speed is not reported as a loss."""


def share_lost(one: Loss) -> str:
    """`12 %`; `less than 0.05 %`; `more than all` where the robot goes the other way."""
    if one.share > 1:
        return "more than all"
    if one.share < _NONE:
        return f"less than {100 * _NONE:g} %"
    return f"{number(100 * one.share, 2)} %"


def pace(speed: float) -> str:
    """`298.3 mm/s forward`."""
    return f"{1e3 * abs(speed):.1f} mm/s {'forward' if speed > 0 else 'backward'}"


def loss_sentences(one: Loss | LossUnknown | None) -> str:
    """A few sentences; nothing where the robot as believed is right."""
    if one is None:
        return ""
    if isinstance(one, LossUnknown):
        return one.sentence
    text = (
        f"The best gait of the robot as believed ({gait_words(one.believed)}) promises "
        f"{pace(one.promised)}; the robot as found reaches {pace(one.reached)} with it. Its own "
        f"best gait ({gait_words(one.best)}) reaches {pace(one.speed)}. "
        f"Speed lost through the wrong model: {share_lost(one)}"
        f"{', as it drives the robot the other way' if one.share > 1 else ''}."
    )
    if one.unseen:
        text += " These gaits demand more than any recorded one: this is a prediction."
    return text


def loss_line(one: Loss | LossUnknown) -> str:
    """The same in a line."""
    if isinstance(one, LossUnknown):
        return one.sentence
    return (
        f"{share_lost(one)}: the best gait as believed promises {pace(one.promised)} and reaches "
        f"{pace(one.reached)}; the best as found reaches {pace(one.speed)}"
    )


def gait_words(gait: Gait) -> str:
    """`1.51 rad, 1.73 s`, and an offset if there is one."""
    text = f"{with_unit(gait.amplitude, 'rad', 3)}, {with_unit(gait.period, 's', 3)}"
    return f"{text}, offset {with_unit(gait.offset, 'rad', 3)}" if gait.offset else text
