"""What may be fitted for a Roller Racer: its own values, and those of the effects."""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.model.experiment import Experiment
from rr_opt.model.parameters import PARAMETERS, Uncertainty, parameters_of
from rr_opt.model.robot import EffectUse
from rr_opt.sysid.model import EffectInfo, Form, Quantity
from rr_opt.sysid.settings import SETTINGS

_CHANNELS = {
    "actuation": "actuation",
    "rolling": "rolling",
    "contact": "constraint_axle1",
    "floor": "floor",
    "mass": "mass",
    "measurement": "measurement",
}
"""The channel in which a family of effects shows."""

ZERO_OFFSET = "zero_offset"
ZEROS = {f"{ZERO_OFFSET}.{name}": f"{name}_zero" for name in ("psi", "phi")}
"""The parameters of the capture system's zeros, and what an experiment calls them."""


def nominal(experiment: Experiment) -> dict[str, float]:
    """Every value of the robot and of all effects, SI; absent effects are neutral."""
    robot = experiment.robot
    zeros = dict.fromkeys(ZEROS.values(), 0.0)
    return parameters_of(robot) | effect_values(robot.physics) | zeros


def effect_values(physics: Iterable[EffectUse]) -> dict[str, float]:
    """Every value of all effects, SI; absent effects are neutral."""
    neutral = {
        f"{effect.name}.{q.name}": q.neutral
        for effect in CATALOGUE.values()
        for q in effect.parameters
    }
    return neutral | {f"{use.name}.{name}": v for use in physics for name, v in use.values.items()}


def uncertain(experiment: Experiment, setting: OperatingRange) -> tuple[Quantity, ...]:
    """The robot's own values that are not known exactly, those of the effects that it has, and the
    capture system's zeros."""
    values = nominal(experiment)
    known = {name: one for name, one in experiment.uncertainty.items() if not one.exact}
    own = [_parameter(name, values[name], known[name]) for name in PARAMETERS if name in known]
    own += [_zero(name, known[name].sigma) for name in ZEROS.values() if name in known]
    return (*own, *(q for use in experiment.robot.physics for q in _present(use, setting)))


def effect_info(effect: Effect, setting: OperatingRange) -> EffectInfo:
    """An effect that may be missing."""
    forms = effect.forms or (tuple(q.name for q in effect.parameters),)
    own = {q.name: q for q in effect.parameters}
    return EffectInfo(
        effect.name,
        _CHANNELS[effect.family],
        tuple(_form(effect.name, [own[name] for name in form], setting) for form in forms),
        smooth=effect.differentiable,
        tangent=effect.tangent,
        upstream=effect.port == Port.ACTUATION or effect.delay is not None,
        form_error=effect.form_error,
        named=effect.candidate,
        lookalikes=effect.lookalikes,
        unmodelled=effect.unmodelled,
    )


def values_of(given: Mapping[str, float], parameters: tuple[str, ...]) -> Array:
    """The parameters p of a motion, with k = kappa/h^2."""
    friction = {f"k{i}": given[f"kappa{i}"] / given["h"] ** 2 for i in (1, 2)}
    names = [ZEROS.get(name, name) for name in parameters]
    return np.array([friction.get(name, given.get(name, math.nan)) for name in names])


def values_by(
    given: dict[str, float], parameters: tuple[str, ...], wanted: tuple[str, ...]
) -> Array:
    """Derivatives of p by each wanted quantity, (np, nw)."""
    own_names = [ZEROS.get(own, own) for own in parameters]
    out = np.array([[float(own == name) for name in wanted] for own in own_names])
    out = out.reshape(len(parameters), len(wanted))
    for i in (1, 2):
        own = parameters.index(f"k{i}")
        for column, name in enumerate(wanted):
            if name == f"kappa{i}":
                out[own, column] = 1 / given["h"] ** 2
            if name == "h":
                out[own, column] = -2 * given[f"kappa{i}"] / given["h"] ** 3
    return out


def _present(use: EffectUse, setting: OperatingRange) -> Iterator[Quantity]:
    """The values of an effect that the nominal robot has: its strength is not known."""
    for q in CATALOGUE[use.name].parameters:
        value = use.values.get(q.name, q.neutral)
        if value != q.neutral:
            size = SETTINGS.effect_prior * max(abs(value), 0.1 * q.magnitude(setting))
            yield Quantity(
                f"{use.name}.{q.name}", q.unit, value, size, True, *q.bounds, value, free=True
            )


def _parameter(name: str, value: float, known: Uncertainty) -> Quantity:
    own = PARAMETERS[name]
    if known.factor:
        # Not on a log scale: the motion is nearly linear in kappa, and best determines the sum of
        # both. 0 has no factor: such a value may be anything usual.
        size = abs(value) or own.quantity.read(own.example)
        positive, high = value / known.factor, size * known.factor
        low = -high
    else:
        size = known.sigma
        reach = max(2 * abs(value), SETTINGS.effect_prior * size)
        positive, low, high = value / 3, value - reach, value + reach
    low = low if own.symbol == "a" else positive
    return Quantity(name, own.unit, value, size, True, low, high, value, free=bool(known.factor))


def _zero(name: str, sigma: float) -> Quantity:
    return Quantity(name, "rad", 0.0, sigma, True, -1.0, 1.0, 0.0)


def _highest(q: Parameter, setting: OperatingRange) -> float:
    return min(q.bounds[1], q.fit_upper(setting)) if q.fit_upper else q.bounds[1]


def _form(effect: str, parameters: Sequence[Parameter], setting: OperatingRange) -> Form:
    sizes = [q.magnitude(setting) for q in parameters]
    quantities = tuple(
        Quantity(
            *(f"{effect}.{q.name}", q.unit, q.neutral, size, False),
            *(max(q.bounds[0], q.fit_lower), _highest(q, setting), q.neutral),
            form_error=q.model_form_sigma,
        )
        for q, size in zip(parameters, sizes, strict=True)
    )
    choices = [
        [size * trial for trial in q.initial_guesses] if q.neutral or q.bounds[0] == 0 else [0.0]
        for q, size in zip(parameters, sizes, strict=True)
    ]
    if any(q.guess_from_data for q in parameters):
        return Form(quantities, ())
    return Form(
        quantities,
        tuple(
            {q.name: value for q, value in zip(quantities, chosen, strict=True)}
            for chosen in itertools.product(*choices)
        ),
    )
