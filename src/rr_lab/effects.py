"""The effects that the laboratory can hide, by name and realisation.

A hidden effect has a name and parameters; it defines how they are drawn, and how it changes a rig.
An effect of the catalogue may have several realisations: different physics that a user would call
by the same name. Each is a `HiddenEffect` of its own. `effects.toml` lists them all, with functions
of this module named without the underscore.
"""

import math
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rr_lab.rig import (
    Circle,
    Drift,
    Edge,
    Falling,
    Motor,
    Patch,
    Rig,
    RollingResistance,
    Rub,
    Strip,
    Tether,
    swing_inertia,
    wheel_loads,
)
from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError

Values = Mapping[str, float]


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    typical  a size that is clearly visible in a recording of half a minute
    neutral  the value without effect; inf for a limit. None: its size is no measure of strength
             (a place, a direction), and it is never scaled
    most     the largest plausible deviation from neutral, or for a limit the least value
    signed   whether it may have either sign
    plant    whether it is the laboratory's own: no parameter of the catalogue, so never scored
    """

    name: str
    unit: str
    typical: float
    neutral: float | None = 0.0
    most: float = math.inf
    signed: bool = False
    plant: bool = False

    def scaled(self, value: float, factor: float) -> float:
        """The value `factor` times as far from neutral, within the plausible range."""
        if self.neutral is None:
            return value
        if self.neutral == math.inf:
            return max(value / factor, self.most)
        away = factor * (value - self.neutral)
        return self.neutral + min(max(away, -self.most), self.most)


@dataclass(frozen=True)
class Setting:
    """The context that drawn values may depend on.

    gaits   of the runs that will be recorded
    passed  a place (m) in the middle of one of the gauged runs, drawn anew at each call
    """

    rng: np.random.Generator
    robot: Robot
    gaits: tuple[SineGait, ...]
    passed: Callable[[], tuple[float, float]]


Enter = Callable[[Rig, Values], None]


def adds(attribute: str, *names: str) -> Enter:
    """Adds parameters to an attribute of the rig: one to a number, several to a list in order.
    Missing ones add nothing."""

    def enter(rig: Rig, values: Values) -> None:
        more = [values.get(name, 0.0) for name in names]
        before = getattr(rig, attribute)
        if isinstance(before, list):
            setattr(rig, attribute, [one + by for one, by in zip(before, more, strict=True)])
        else:
            setattr(rig, attribute, before + values[names[0]])

    return enter


@dataclass(frozen=True)
class HiddenEffect:
    """An effect that the laboratory can hide.

    what         one sentence for the sealed answer
    enter        changes a rig according to the parameters; missing ones are neutral
    realisation  which physics of that name; empty if there is only one
    named        whether it is in the catalogue, so that a diagnosis can name it
    also         parameters that may be given, and are never drawn
    draw         (setting, each parameter of about its typical size, either sign where it may) ->
                 consistent values; None: unchanged
    derived      (nominal robot, values) -> parameters of the catalogue that follow from them
    sizes        the range of effect sizes, sigma, in which its name applies; None: any
    same_as      other names of the catalogue for the same motion
    """

    name: str
    what: str
    parameters: tuple[Parameter, ...]
    enter: Enter
    realisation: str = ""
    named: bool = True
    also: tuple[Parameter, ...] = ()
    draw: Callable[[Setting, Values], Values] | None = None
    derived: Callable[[Robot, Values], Mapping[str, float]] | None = None
    sizes: tuple[float, float] | None = None
    same_as: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """The realisation: `servo_backlash/frictional`, or the bare name if there is only one."""
        return f"{self.name}/{self.realisation}" if self.realisation else self.name

    @property
    def accepted(self) -> dict[str, Parameter]:
        """By name: every parameter that may be given."""
        return {each.name: each for each in (*self.parameters, *self.also)}

    def drawn(self, setting: Setting) -> Values:
        """Random values around their typical size."""
        rng, values = setting.rng, {}
        for each in self.parameters:
            size = each.typical * math.exp(rng.uniform(-0.7, 0.7))
            sign = rng.choice([-1, 1]) if each.signed else 1
            values[each.name] = float(sign * size)
        return self.draw(setting, values) if self.draw else values


def _coulomb(rig: Rig, values: Values) -> None:
    """A force F at the rim is a torque F h."""
    one, two = (values.get(name, 0.0) * rig.robot.h for name in ("force1", "force2"))
    rig.dry = [dry + more for dry, more in zip(rig.dry, (one, one, two, two), strict=True)]
    rig.onset = values.get("onset", rig.onset)


def _equal(rig: Rig, values: Values) -> None:
    _coulomb(rig, _equal_forces(rig.robot, values))


def _equal_forces(_: Robot, values: Values) -> dict[str, float]:
    return {"force1": values["force"], "force2": values["force"]}


def _by_load(rig: Rig, values: Values) -> None:
    rig.laws.append(RollingResistance(values["mu"], rig.robot.h))


def _forces_of_loads(robot: Robot, values: Values) -> dict[str, float]:
    """With the wheel loads of a stationary robot."""
    one, _, two, _ = values["mu"] * wheel_loads(Rig(robot))
    return {"force1": float(one), "force2": float(two)}


def _quadratic(rig: Rig, values: Values) -> None:
    """(c/4) v^2 at the rim is (c/4) h^3 omega^2."""
    each = values["coefficient_total"] / 4 * rig.robot.h**3
    rig.quadratic = [coefficient + each for coefficient in rig.quadratic]


def _left_right(rig: Rig, values: Values) -> None:
    for platform, name in enumerate(("asymmetry1", "asymmetry2")):
        lean = values.get(name, 0.0)
        rig.kappa[2 * platform] *= 1 + lean
        rig.kappa[2 * platform + 1] *= 1 - lean


def _wheel_inertia(rig: Rig, values: Values) -> None:
    rig.J = [J + values["J"] for J in rig.J]


def _slip(rig: Rig, values: Values) -> None:
    """`mu`: the friction limit of the grip; `creep_compliance`: side speed per side force."""
    rig.mu = values.get("mu", rig.mu)
    rig.creep += values.get("creep_compliance", 0.0)


def _patch(rig: Rig, values: Values) -> None:
    """The drag of each wheel times `multiplier` within a circle or strip, or beyond an edge. A
    robot file gives them a radius of 0."""
    within: Circle | Edge | Strip
    if values.get("radius"):
        within = Circle(values["x"], values["y"], values["radius"])
    else:
        within = Edge(values["edge_x"], values["edge_y"], values["normal"])
        if "width" in values:
            within = Strip(within, values["width"])
    rig.laws.append(Patch(values["multiplier"], within))


def _any_direction(setting: Setting, _: Values) -> Values:
    slope, way = 1.4e-3, setting.rng.uniform(-math.pi, math.pi)
    return {"tilt_x": slope * math.cos(way), "tilt_y": slope * math.sin(way)}


def _round_a_path(setting: Setting, values: Values) -> Values:
    """A circle around a place on a run."""
    x, y = setting.passed()
    radius = float(setting.rng.uniform(0.15, 0.55))
    return {"multiplier": 1 + values["multiplier"] / 2, "x": x, "y": y, "radius": radius}


def _across_a_path(setting: Setting, values: Values) -> Values:
    """An edge through a place on a run."""
    x, y = setting.passed()
    normal = float(setting.rng.uniform(-math.pi, math.pi))
    return {"multiplier": 1 + values["multiplier"] / 2, "normal": normal, "edge_x": x, "edge_y": y}


_HALF_TURN = (-math.pi / 2, math.pi / 2)
"""A strip has two edges; the normal of the one that is told is within these directions."""


def _strip_on_a_path(setting: Setting, values: Values) -> Values:
    """A strip around a place on a run."""
    x, y = setting.passed()
    normal, width = (float(setting.rng.uniform(*ends)) for ends in (_HALF_TURN, (0.1, 0.6)))
    edge_x, edge_y = (
        at - width / 2 * way for at, way in ((x, math.cos(normal)), (y, math.sin(normal)))
    )
    edge = {"normal": normal, "edge_x": edge_x, "edge_y": edge_y, "width": width}
    return {"multiplier": 1 + values["multiplier"] / 2, **edge}


def _lag(rig: Rig, values: Values) -> None:
    """A first-order lag, tau dy/dt = u - y, or with beta a second-order one.

    Exact for a command that is linear within a step.
    """
    tau, beta = values["tau"], values.get("beta", 0.0)

    def follow(t: Array, angle: Array) -> Array:
        from scipy.signal import cont2discrete, lfilter  # slow to import

        system = [1.0], [beta, tau, 1.0] if beta else [tau, 1.0]
        discrete: Any = cont2discrete(system, t[1] - t[0], method="foh")
        above, below = discrete[:2]
        return np.asarray(lfilter(above[0], below, angle - angle[0])) + angle[0]

    rig.shapers.append(follow)


def _second_order(rig: Rig, values: Values) -> None:
    """The damping ratio zeta stays as the lag tau = 2 zeta/omega grows."""
    tau = values["tau"]
    _lag(rig, {"tau": tau, "beta": (tau / (2 * values["zeta"])) ** 2})


def _p_loop(rig: Rig, values: Values) -> None:
    """A motor with the stiffness of its lag, which the load torque deflects too."""
    tau, zeta = values["tau"], values["zeta"]
    stiffness = swing_inertia(rig.robot) * (2 * zeta / tau) ** 2
    rig.motor = Motor(stiffness, stiffness * tau, feedforward=0.0)


def _damped(setting: Setting, values: Values) -> Values:
    """A servo with little overshoot: damping ratio 0.5 to 1.2."""
    return {**values, "zeta": float(setting.rng.uniform(0.5, 1.2))}


def _delay(rig: Rig, values: Values) -> None:
    late = values["delay"]
    rig.shapers.append(lambda t, angle: np.interp(t - late, t, angle))


def _rate_limit(rig: Rig, values: Values) -> None:
    limit = values["rate_limit"]

    def follow(t: Array, angle: Array) -> Array:
        most = limit * (t[1] - t[0])
        made, out = float(angle[0]), np.empty_like(angle)
        for k, asked in enumerate(angle.tolist()):
            made += min(max(asked - made, -most), most)
            out[k] = made
        return out

    rig.shapers.append(follow)


def _below_the_fastest(setting: Setting, _: Values) -> Values:
    """Just below the fastest rate of the commands."""
    fastest = max(gait.peak_rate for gait in setting.gaits)
    return {"rate_limit": float(fastest * setting.rng.uniform(0.8, 0.95))}


def _backlash(rig: Rig, values: Values) -> None:
    rig.play += values["width"]
    rig.hinge_dry += values.get("joint_friction", 0.0)
    if "gear_stiffness" in values:
        rig.gear = values["gear_stiffness"]
    elif compliance := values.get("compliance"):
        rig.gear = 1 / compliance


def _frictional(setting: Setting, values: Values) -> Values:
    """Friction from about the inertial torque of the load, where it begins to hold the load within
    the backlash, to well above."""
    largest = max(gait.amplitude * gait.angular_frequency**2 for gait in setting.gaits)
    inertial = swing_inertia(setting.robot) * largest
    friction = inertial * math.exp(setting.rng.uniform(math.log(0.5), math.log(4.0)))
    return {**values, "joint_friction": float(friction)}


def _compliant(setting: Setting, values: Values) -> Values:
    """A gear that the joint's friction twists by 2 to 15 mrad."""
    drawn = _frictional(setting, values)
    twist = math.exp(setting.rng.uniform(math.log(2e-3), math.log(15e-3)))
    return {**drawn, "gear_stiffness": float(drawn["joint_friction"] / twist)}


def _tether(rig: Rig, values: Values) -> None:
    rig.tether = Tether(values["x"], values["y"], values["slack"], values["stiffness"])


def _beside_a_path(setting: Setting, values: Values) -> Values:
    """Tied to a place beside a run, and taut for a part of it."""
    x, y = setting.passed()
    dx, dy = setting.rng.uniform(-0.3, 0.3, 2)
    return {**values, "x": float(x + dx), "y": float(y + dy)}


def _stribeck(rig: Rig, values: Values) -> None:
    """Dry friction that falls from `force` to `force/3` as the rim's speed grows past `speed`."""
    h = rig.robot.h
    rig.laws.append(Falling(values["force"] * h, values["speed"] / h))


def _drift(rig: Rig, values: Values) -> None:
    rig.laws.append(Drift(values["change"], values["time"]))


def _sprung(rig: Rig, values: Values) -> None:
    """`give` is 1/stiffness."""
    rig.spring = 1 / values["give"]


def _fault(rig: Rig, values: Values) -> None:
    rig.laws.append(Rub(values["force"] * rig.robot.h))


def _load(rig: Rig, values: Values) -> None:
    rig.load = (values["mass"], values["stiffness"])


def _parameter(name: str, row: Mapping[str, Any]) -> Parameter:
    own = dict(row)
    if not own.pop("strength", True):
        own["neutral"] = None
    return Parameter(name, **own)


def _effect(row: Mapping[str, Any]) -> HiddenEffect:
    """A row of `effects.toml`."""
    own = dict(row)
    for key in ("parameters", "also"):
        own[key] = tuple(_parameter(*item) for item in own.get(key, {}).items())
    for key in ("enter", "draw", "derived"):
        if key in own:
            own[key] = globals()[f"_{own[key]}"]
    if "adds" in own:
        own["enter"] = adds(*own.pop("adds"))
    for key in ("sizes", "same_as"):
        if key in own:
            own[key] = tuple(own[key])
    return HiddenEffect(**own)


_TABLE = Path(__file__).with_name("effects.toml")
EVERY = tuple(map(_effect, tomllib.loads(_TABLE.read_text(encoding="utf-8"))["effect"]))

REALISATIONS: dict[str, tuple[HiddenEffect, ...]] = {
    name: tuple(effect for effect in EVERY if effect.name == name)
    for name in dict.fromkeys(effect.name for effect in EVERY)
}
"""By name; a bare name stands for the first."""

NAMED = tuple(name for name, (first, *_) in REALISATIONS.items() if first.named)
OUTSIDE_NAMES = tuple(name for name in REALISATIONS if name not in NAMED)
"""Effects that a diagnosis can name, and those outside its catalogue."""

_BY_KEY = {effect.key: effect for effect in EVERY} | {
    name: first for name, (first, *_) in REALISATIONS.items()
}


def effect_named(key: str) -> HiddenEffect:
    """By NAME or NAME/REALISATION; raises InputError if there is none."""
    if key not in _BY_KEY:
        name = key.partition("/")[0]
        known = [each.key for each in REALISATIONS.get(name, ())] or list(REALISATIONS)
        raise InputError(
            f"The laboratory cannot hide {key!r}. Expected one of: {', '.join(known)}. "
            "Correct the name."
        )
    return _BY_KEY[key]


def rig_with(robot: Robot, effects: Iterable[EffectUse] = ()) -> Rig:
    """The robot with the effects and those in its own `physics`, in the order of the table.

    Raises InputError for an effect or a parameter that is unknown, or required and missing. Unknown
    ones of 0 pass: a robot file gives all of the catalogue, 0 where they do nothing.
    """
    rig = Rig(robot)
    uses = [(effect_named(use.name), use) for use in (*robot.physics, *effects)]
    for effect, use in sorted(uses, key=lambda one: EVERY.index(one[0])):
        given = {name for name, value in use.values.items() if value}
        if unknown := sorted(given - set(effect.accepted)):
            raise InputError(
                f"The effect {use.name} has no parameter {', '.join(unknown)}. Expected: "
                f"{', '.join(sorted(effect.accepted))}. Correct the name."
            )
        try:
            effect.enter(rig, use.values)
        except KeyError as missing:
            raise InputError(
                f"The effect {use.name} is missing its parameter {missing.args[0]}. Expected a "
                "value. Give one."
            ) from None
    return rig
