"""A recording with a clock of its own: its time t is the command's time t + offset."""

from rr_opt.effects.effect import Effect, Parameter, Port

EFFECT = Effect(
    name="clock_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("offset", "s", (-0.5, 0.5), 0.01),),
    sentence="The recording's clock and the command's clock differ, by the same in all runs.",
    delay="offset",
)
