"""Random effects, plans of runs, robots, and wrong nominal values."""

import math
import secrets
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rr_lab.case import Case, Engine, Plan, Verdict, motion_of, stream
from rr_lab.disturbances import disturbance_named
from rr_lab.effect_size import COARSE, EffectSize, scaled_to
from rr_lab.effects import (
    NAMED,
    OUTSIDE_NAMES,
    REALISATIONS,
    HiddenEffect,
    Setting,
    effect_named,
    rig_with,
)
from rr_opt.model.experiment import Noise
from rr_opt.model.gait import SineGait
from rr_opt.model.parameters import Uncertainty, default_uncertainty, parameters_of, with_parameters
from rr_opt.model.robot import EffectUse, Platform, Robot, Servo
from rr_opt.outcome import InputError

GAUGED = 3
"""Runs used to set the strength."""


def draw_effect(rng: np.random.Generator, effect: HiddenEffect, case: Case) -> EffectUse:
    """An effect around its typical size for a case that does not have it yet.

    `effect_size.scaled_to` corrects its strength later, on the runs where a place is drawn.
    """
    plans = case.plans[:GAUGED]

    def passed() -> tuple[float, float]:
        plan = plans[int(rng.integers(len(plans)))]
        path = motion_of(case, plan, COARSE).one
        at = int(rng.uniform(0.3, 0.7) * len(path))
        return float(path[at, 0]), float(path[at, 1])

    gaits = tuple(plan.gait for plan in case.plans)
    setting = Setting(rng, case.nominal, gaits, passed)
    return EffectUse(effect.key, effect.drawn(setting))


GENTLEST, FIERCEST = 3.0, 42.0
"""rad/s2, peak acceleration of phi: below it the robot hardly moves, above it real wheels slip."""

CLEARANCE = 0.25
"""Least S1 = c1 cos phi + c2 relative to c1 + c2: a margin to the singular posture."""

SHORTEST = 0.65
"""Shortest run relative to the longest: recorded runs differ in length."""


def draw_plans(rng: np.random.Generator, robot: Robot, seconds: float = 30.0) -> tuple[Plan, ...]:
    """Seven or eight runs of up to `seconds`: at least three and at most all but two with an
    offset, one to three from rest, two held out."""
    count = int(rng.integers(7, 9))
    turning = rng.permutation(count) < int(rng.integers(3, count - 1))
    resting = rng.permutation(count) < int(rng.integers(1, 4))
    held_out = rng.permutation(count) < 2
    return tuple(
        Plan(
            f"run{n + 1:02d}.csv",
            draw_gait(rng, robot, bool(turning[n])),
            round(seconds * float(rng.uniform(SHORTEST, 1.0)), 2),
            "rest" if resting[n] else "running",
            "holdout" if held_out[n] else "fit",
            _pose(rng),
            int(rng.integers(1, 6)),
        )
        for n in range(count)
    )


def draw_gait(rng: np.random.Generator, robot: Robot, turning: bool) -> SineGait:
    """Amplitude 0.3 to 1.05 rad, period 0.8 to 2 s, offset up to +-0.36 rad or none."""
    while True:
        amplitude = round(float(rng.uniform(0.3, 1.05)), 3)
        period = round(0.05 * float(rng.integers(16, 41)), 2)
        offset = round(float(rng.uniform(0.05, 0.36) * rng.choice([-1, 1])), 3) if turning else 0.0
        gait = SineGait(amplitude, period, offset)
        fierce = amplitude * gait.angular_frequency**2
        c1, c2 = robot.platform1.c, robot.platform2.c
        S1 = c1 * math.cos(gait.peak_angle) + c2
        if GENTLEST < fierce < FIERCEST and CLEARANCE * (c1 + c2) < S1:
            return gait


def _pose(rng: np.random.Generator) -> tuple[float, float, float]:
    x, y = rng.uniform(-0.3, 0.3, 2)
    return float(x), float(y), float(rng.uniform(-math.pi, math.pi))


def draw_robot(rng: np.random.Generator) -> Robot:
    """A Roller Racer with its longer platform first, rounded as a builder would write it."""
    h = round(rng.uniform(0.015, 0.03), 4)
    c1, c2 = rng.uniform(0.13, 0.24), rng.uniform(0.048, 0.127)
    m1, m2 = rng.uniform(0.3, 0.7), rng.uniform(0.17, 0.6)
    # Both platforms have similar wheels; k, N s/m, spreads over a decade between robots.
    k = np.exp(rng.uniform(np.log(0.0105), np.log(0.085)))
    rate, torque = rng.choice([math.pi, 4.2, 5.5, 6.28]), rng.choice([1.37, 1.5, 2.0, 3.0])
    return Robot(
        _platform(rng, m1, c1, k * rng.uniform(0.82, 1.18), h),
        _platform(rng, m2, c2, k * rng.uniform(0.82, 1.18), h),
        h,
        Servo(2.6, round(float(rate), 5), float(torque)),
    )


def _platform(rng: np.random.Generator, m: float, c: float, k: float, h: float) -> Platform:
    """The radius of gyration of real platforms is 65 to 110 mm, for any c."""
    gyration = rng.uniform(0.065, 0.11)
    return Platform(
        m=round(m, 3),
        I=float(f"{m * gyration**2:.3g}"),
        c=round(c, 4),
        a=round(rng.uniform(0.0, 0.04), 4),
        b=round(rng.uniform(0.038, 0.075), 4),
        kappa=float(f"{k * h**2:.3g}"),
    )


def draw_noise(rng: np.random.Generator) -> Noise:
    """The noise of a capture system: 0.5 to 1.5 mm, 3 to 4 mrad."""
    return Noise(float(rng.choice([0.5e-3, 1e-3, 1.5e-3])), float(rng.choice([3e-3, 4e-3])))


CANDIDATES = ("m1", "m2", "I1", "I2", "c1", "c2", "a1", "a2", "kappa1", "kappa2")

SIGMAS = 4.0, 8.0
"""Error of a wrong known value, in standard deviations: larger than chance."""

FACTORS = 1.5, 3.0
"""Factor of a wrong friction, up or down."""


def draw_wrong(
    rng: np.random.Generator, nominal: Robot, uncertainty: dict[str, Uncertainty]
) -> tuple[Robot, tuple[str, ...]]:
    """The robot with one or two values changed, and their names."""
    count = 1 if rng.random() < 0.6 else 2
    names = tuple(sorted(str(name) for name in rng.choice(CANDIDATES, count, replace=False)))
    changed = {}
    for name in names:
        value, known = parameters_of(nominal)[name], uncertainty[name]
        if known.factor is not None:
            value *= rng.uniform(*FACTORS) ** rng.choice([-1, 1])
        else:
            value += known.sigma * rng.uniform(*SIGMAS) * rng.choice([-1, 1])
        changed[name] = float(value)
    return with_parameters(nominal, changed), names


def draw_near(
    rng: np.random.Generator, nominal: Robot, uncertainty: dict[str, Uncertainty], spread: float
) -> Robot:
    """The robot with random errors in every value, `spread` times its uncertainty."""
    values = parameters_of(nominal)
    for name in sorted(uncertainty):
        off = spread * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        values[name] += uncertainty[name].sigma * off
    return with_parameters(nominal, values)


KINDS = ("null", "parameters", "single", "pair", "outside")

# Wheel inertia is equivalent to a change of parameters: hidden only on request.
SINGLES = tuple(name for name in NAMED if name != "wheel_inertia")

SIZES = 3.0, 60.0
"""Range of the effect size, sigma, drawn log-uniformly."""


@dataclass(frozen=True)
class Request:
    """The specification of a case; equal seed, kind and engine give equal cases.

    robot, plans, noise  drawn if left out
    effects     the hidden effects; or
    kind        null, parameters, single, pair, outside or random; single:EFFECT, outside:EFFECT and
                pair:EFFECT+EFFECT name the hidden effects, a realisation as EFFECT/REALISATION
    seed        of all random draws; default 0, or random if a kind is given
    seconds     of each drawn run, at most
    missing     fraction of lost samples
    engine      the physics engine; robot, runs and effects do not depend on it
    disturbance  of the recordings, by name
    spread      0: the nominal values are true but for the hidden changes; 1: they are drawn within
                their uncertainties
    target      size of each effect, sigma; drawn if left out
    size        RMS deviation of a case from its nominal, in sigma; default `EffectSize`
    """

    robot: Robot | None = None
    plans: tuple[Plan, ...] = ()
    effects: tuple[EffectUse, ...] = ()
    noise: Noise | None = None
    kind: str | None = None
    seed: int | None = None
    seconds: float = 30.0
    missing: float = 0.0
    engine: Engine = "mujoco"
    disturbance: str = ""
    spread: float = 0.0
    target: float | None = None
    size: Callable[[Case], float] | None = None

    def case(self) -> Case:
        """Raises InputError for an unknown kind or disturbance, or a wrong effect."""
        disturbance_named(self.disturbance)
        seed = self.seed
        if seed is None:
            seed = secrets.randbits(48) if self.kind else 0
        case = bare_case(
            seed, self.seconds, spread=self.spread, robot=self.robot, engine=self.engine
        )
        plans, noise = self.plans or case.plans, self.noise or case.noise
        case = replace(case, plans=plans, noise=noise, missing=self.missing)
        if self.kind:
            case = _hidden_in(case, self.kind, self.target, self.size)
        else:
            rig_with(case.robot, self.effects)
            verdict = _verdict([effect_named(use.name) for use in self.effects])
            case = replace(case, effects=self.effects, verdict=verdict)
        return replace(case, disturbance=self.disturbance)


def random_case(seed: int, kind: str = "random", **more: Any) -> Case:
    """A fully random case; more: fields of `Request`. Raises as `Request.case` does."""
    return Request(kind=kind, seed=seed, **more).case()


def bare_case(
    seed: int,
    seconds: float,
    *,
    spread: float = 0.0,
    robot: Robot | None = None,
    engine: Engine = "mujoco",
) -> Case:
    """A case with nothing hidden, of the given robot or a random one."""
    nominal = robot or draw_robot(stream(seed, "robot"))
    uncertainty = default_uncertainty(nominal)
    true = nominal
    if spread:
        true = draw_near(stream(seed, "spread"), nominal, uncertainty, spread)
    return Case(
        f"case-{seed}",
        nominal,
        true,
        (),
        draw_plans(stream(seed, "plans"), nominal, seconds),
        draw_noise(stream(seed, "capture")),
        uncertainty,
        "consistent",
        seed,
        engine=engine,
    )


def _hidden_in(
    case: Case, kind: str, target: float | None, size: Callable[[Case], float] | None
) -> Case:
    """The case with effects hidden according to its seed and the kind; see `Request`."""
    head, names = read_kind(kind, case.seed)
    if head == "null":
        return case
    if head == "parameters":
        rng = stream(case.seed, "wrong")
        robot, changed = draw_wrong(rng, case.nominal, dict(case.uncertainty))
        return replace(case, robot=robot, changed=changed, verdict="parameters")
    rng = stream(case.seed, "effects")
    effects = [_realisation(rng, name) for name in names or _names(rng, head)]
    # The strength of the effect alone: errors of the nominal values must not mask it.
    alone = replace(case, robot=case.nominal)
    size = size or EffectSize.of(alone, GAUGED)
    uses, notes = [], {}
    for effect in effects:
        wanted = target or float(np.exp(rng.uniform(*np.log(SIZES))))
        if effect.sizes:
            wanted = float(np.clip(wanted, *effect.sizes))
        drawn = replace(alone, effects=(draw_effect(rng, effect, alone),))
        scaled, reached = scaled_to(drawn, wanted, size)
        uses.append(scaled.effects[0])
        notes[f"visibility_{effect.name}"] = reached
    return replace(case, effects=tuple(uses), verdict=_verdict(effects), notes=notes)


def _verdict(effects: list[HiddenEffect]) -> Verdict:
    """The verdict of a correct diagnosis for these effects."""
    if not effects:
        return "consistent"
    return "missing_physics" if all(effect.named for effect in effects) else "unexplained"


def read_kind(kind: str, seed: int = 0) -> tuple[str, tuple[str, ...]]:
    """The kind and the effects that a text such as `pair:servo_lag/second_order+clock_offset`
    names; raises InputError if there is no such kind or effect."""
    head, _, rest = kind.partition(":")
    if head == "random" and not rest:
        head = str(stream(seed, "kind").choice(KINDS, p=(0.15, 0.15, 0.4, 0.15, 0.15)))
    names = tuple(filter(None, (name.strip() for name in rest.split("+"))))
    count = {"single": 1, "pair": 2, "outside": 1}.get(head, 0)
    if head not in KINDS or (names and len(names) != count):
        raise InputError(
            f"The laboratory has no kind of case {kind!r}. Expected {', '.join(KINDS)}, random, "
            "single:EFFECT, outside:EFFECT or pair:EFFECT+EFFECT. Correct it."
        )
    for name in names:
        if effect_named(name).named != (head != "outside"):
            raise InputError(
                f"The kind of case {kind!r} does not match its effect. Expected single or pair "
                f"for an effect in the catalogue ({', '.join(NAMED)}), outside for any other "
                f"({', '.join(OUTSIDE_NAMES)}). Correct it."
            )
    return head, names


def _names(rng: np.random.Generator, kind: str) -> tuple[str, ...]:
    if kind == "outside":
        return (str(rng.choice(OUTSIDE_NAMES)),)
    count = 2 if kind == "pair" else 1
    return tuple(str(name) for name in rng.choice(SINGLES, count, replace=False))


def _realisation(rng: np.random.Generator, name: str) -> HiddenEffect:
    """The realisation that a text names; a random one for a bare name."""
    if "/" in name:
        return effect_named(name)
    several = REALISATIONS[name]
    return several[int(rng.integers(len(several)))]
