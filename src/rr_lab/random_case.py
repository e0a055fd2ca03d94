"""A random case: a robot, its runs, and what is hidden in it."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rr_lab.case import Case, Plan, Verdict, stream
from rr_lab.disturbances import disturbance_named
from rr_lab.effect_size import EffectSize, scaled_to
from rr_lab.effects import NAMED, OUTSIDE_NAMES, REALISATIONS, effect_named, rig_with
from rr_lab.effects.hidden_effect import HiddenEffect
from rr_lab.engines import Engine
from rr_lab.sampling import draw_effect, draw_near, draw_noise, draw_plans, draw_robot, draw_wrong
from rr_opt.model.experiment import Noise
from rr_opt.model.parameters import default_uncertainty
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError

KINDS = ("null", "parameters", "single", "pair", "outside")

# Wheel inertia is a change of parameters in disguise: it is hidden only on request.
SINGLES = tuple(name for name in NAMED if name != "wheel_inertia")

SIZES = 3.0, 60.0
"""Between which the effect size is drawn, sigma, uniformly in its logarithm."""

GAUGED = 3
"""Runs on which the strength is set."""


@dataclass(frozen=True)
class Request:
    """What a case is made from; the same seed, kind and engine give the same.

    robot, plans, noise  drawn if left out
    effects     what is hidden; or
    kind        null, parameters, single, pair, outside or random; single:EFFECT, outside:EFFECT and
                pair:EFFECT+EFFECT name what is hidden, a realisation as EFFECT/REALISATION
    seed        of all that is drawn; 0 if left out, and with a kind a random one
    seconds     of each run that is drawn, at most
    missing     fraction of lost samples
    engine      what drives it; robot, runs and effects are the same for all
    disturbance  of the recordings, by name
    spread      0: but for what is hidden the nominal values are true; 1: they are drawn within
                their uncertainties
    target      size of each effect, sigma; drawn if left out
    size        RMS deviation of a case from its nominal, in sigma; `EffectSize` if left out
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
    """A case that is all drawn; more: fields of `Request`. Raises as `Request.case` does."""
    return Request(kind=kind, seed=seed, **more).case()


def bare_case(
    seed: int,
    seconds: float,
    *,
    spread: float = 0.0,
    robot: Robot | None = None,
    engine: Engine = "mujoco",
) -> Case:
    """A case with nothing hidden, of the robot or of one drawn."""
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
    """The case with what its seed and the kind hide in it; see `Request`."""
    head, names = read_kind(kind, case.seed)
    if head == "null":
        return case
    if head == "parameters":
        rng = stream(case.seed, "wrong")
        robot, changed = draw_wrong(rng, case.nominal, dict(case.uncertainty))
        return replace(case, robot=robot, changed=changed, verdict="parameters")
    rng = stream(case.seed, "effects")
    effects = [_realisation(rng, name) for name in names or _names(rng, head)]
    # Strength is that of the effect alone: errors of the nominal values are not to mask it.
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
    """What a right diagnosis says of these effects."""
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
                f"The kind of case {kind!r} does not go with its effect. Expected single or pair "
                f"for an effect of the catalogue ({', '.join(NAMED)}), and outside for another one "
                f"({', '.join(OUTSIDE_NAMES)}). Correct it."
            )
    return head, names


def _names(rng: np.random.Generator, kind: str) -> tuple[str, ...]:
    if kind == "outside":
        return (str(rng.choice(OUTSIDE_NAMES)),)
    count = 2 if kind == "pair" else 1
    return tuple(str(name) for name in rng.choice(SINGLES, count, replace=False))


def _realisation(rng: np.random.Generator, name: str) -> HiddenEffect:
    """The realisation that a text asks for; any, if it is a bare name."""
    if "/" in name:
        return effect_named(name)
    several = REALISATIONS[name]
    return several[int(rng.integers(len(several)))]
