"""A case by lot: a robot, its runs, and what is hidden in it."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rr_lab.case import Case, Plan, stream
from rr_lab.draw import draw_effect, draw_near, draw_noise, draw_plans, draw_robot, draw_wrong
from rr_lab.effects import EFFECTS, effect_named, rig_with
from rr_lab.engines import Engine
from rr_lab.visibility import Gauge, at_visibility
from rr_opt.model.experiment import Noise
from rr_opt.model.parameters import default_uncertainty
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError

NAMED = tuple(name for name, effect in EFFECTS.items() if effect.named)
STRANGE = tuple(name for name, effect in EFFECTS.items() if not effect.named)
KINDS = ("null", "parameters", "single", "pair", "outside")

SEEN = 3.0, 40.0
"""Between which the visibility is drawn, sigma, evenly in its logarithm."""

GAUGED = 3
"""Runs on which the strength is set."""

Visibility = Callable[[Case], float]


def random_case(
    seed: int,
    kind: str = "random",
    *,
    seconds: float = 30.0,
    spread: float = 0.0,
    target: float | None = None,
    visibility: Visibility | None = None,
    engine: Engine = "mujoco",
) -> Case:
    """Draw a case; the same seed, kind and engine give the same.

    kind        null, parameters, single, single:EFFECT, pair, outside, outside:EFFECT or random
    spread      0: but for what is hidden the nominal values are true; 1: they are off by chance, as
                far as their uncertainties say
    target      visibility of each effect, sigma; drawn if left out
    visibility  RMS deviation of a case from its nominal, in sigma; by default the laboratory's own
                `Gauge`
    engine      what drives it; robot, runs and effects are drawn alike for all
    Raises InputError for an unknown kind.
    """
    case = bare_case(seed, seconds, spread=spread, engine=engine)
    return hidden_in(case, kind, target=target, visibility=visibility)


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


def hidden_in(
    case: Case, kind: str, *, target: float | None = None, visibility: Visibility | None = None
) -> Case:
    """The case with what its seed and the kind hide in it; see `random_case`."""
    kind, name = _known(kind, case.seed)
    if kind == "null":
        return case
    if kind == "parameters":
        rng = stream(case.seed, "wrong")
        robot, changed = draw_wrong(rng, case.nominal, dict(case.uncertainty))
        return replace(case, robot=robot, changed=changed, verdict="parameters")
    rng = stream(case.seed, "effects")
    names = (effect_named(name).name,) if name else _names(rng, kind)
    # Strength is that of the effect alone: what is off by chance is not to hide it.
    alone = replace(case, robot=case.nominal)
    gauge = visibility or Gauge.of(alone, GAUGED)
    uses, notes = [], {}
    for each in names:
        wanted = target or float(np.exp(rng.uniform(*np.log(SEEN))))
        use, reached = _one(rng, each, alone, wanted, gauge)
        uses.append(use)
        notes[f"visibility_{each}"] = reached
    known = all(effect_named(each).named for each in names)
    verdict = "missing_physics" if known else "unexplained"
    return replace(case, effects=tuple(uses), verdict=verdict, notes=notes)


def _known(kind: str, seed: int) -> tuple[str, str]:
    """The kind and the effect that a text names; raises InputError if there is no such kind."""
    head, _, name = kind.partition(":")
    if head == "random" and not name:
        head = str(stream(seed, "kind").choice(KINDS, p=(0.15, 0.15, 0.4, 0.15, 0.15)))
    if head not in KINDS or (name and head not in ("single", "outside")):
        raise InputError(
            f"The laboratory has no kind of case {kind!r}. Expected {', '.join(KINDS)}, random, "
            "single:EFFECT or outside:EFFECT. Correct it."
        )
    return head, name


def _names(rng: np.random.Generator, kind: str) -> tuple[str, ...]:
    if kind == "outside":
        return (str(rng.choice(STRANGE)),)
    # Wheel inertia is a change of parameters in disguise: it is hidden only if it is asked for.
    names = [name for name in NAMED if name != "wheel_inertia"]
    count = 2 if kind == "pair" else 1
    return tuple(str(name) for name in rng.choice(names, count, replace=False))


def _one(
    rng: np.random.Generator, name: str, case: Case, target: float, gauge: Visibility
) -> tuple[EffectUse, float]:
    """An effect by lot that is seen as well as `target` says, and how well it is."""
    alone = replace(case, effects=(draw_effect(rng, name, case),))
    found, reached = at_visibility(alone, target, gauge)
    return found.effects[0], reached


def case_of(
    *,
    robot: Robot | None = None,
    plans: tuple[Plan, ...] = (),
    effects: tuple[EffectUse, ...] = (),
    noise: Noise | None = None,
    kind: str | None = None,
    seed: int | None = None,
    seconds: float = 30.0,
    missing: float = 0.0,
    engine: Engine = "mujoco",
) -> Case:
    """A case with the effects given, or with what a kind of case draws, see `random_case`.

    robot, plans, noise  drawn if left out
    seed                 of all that is drawn; 0 if left out, and with a kind one by chance
    Raises InputError for an unknown kind, or a wrong effect.
    """
    if seed is None:
        seed = secrets.randbits(48) if kind else 0
    case = bare_case(seed, seconds, robot=robot, engine=engine)
    case = replace(case, plans=plans or case.plans, noise=noise or case.noise, missing=missing)
    if kind:
        return hidden_in(case, kind)
    rig_with(case.robot, effects)
    known = all(effect_named(use.name).named for use in effects)
    verdict = "consistent" if not effects else "missing_physics" if known else "unexplained"
    return replace(case, effects=effects, verdict=verdict)
