"""A recording with a clock of its own: its time t is the command's time t + offset."""

from rr_opt.effects.effect import Effect, Parameter, Port

EFFECT = Effect(
    name="clock_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("offset", "s", (-0.5, 0.5), 0.01),),
    sentence="The recording's clock is offset from the command's by the same amount in all runs.",
    delay="offset",
)
