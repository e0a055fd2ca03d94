"""A case from what is given, and by lot what is not."""

from __future__ import annotations

import secrets
from dataclasses import replace

from rr_opt.experiment.experiment import Noise
from rr_opt.lab.case import Case, Plan
from rr_opt.lab.effects import effect_named, rig_with
from rr_opt.lab.engines import Engine
from rr_opt.lab.random_case import bare_case, hidden_in
from rr_opt.robot.parameters import EffectUse, Robot


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
