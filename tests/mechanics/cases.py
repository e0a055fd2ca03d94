"""Random robots and states for the tests of the physics, and the model evaluated at them."""

from math import cos, sin
from typing import NamedTuple

from hypothesis import Phase, settings
from hypothesis import strategies as st

from rr_opt.effects import CATALOGUE
from rr_opt.model.robot import EffectUse, Platform, Robot
from rr_opt.motion.dynamics import Dynamics, dynamics_of

REPEATABLE = settings(derandomize=True, deadline=None, max_examples=30)
FIRST_FOUND = settings(REPEATABLE, phases=[Phase.generate])
"""For a search whose find need not be the simplest."""


class State(NamedTuple):
    """What the model takes: m/s, rad, rad/s, rad/s2."""

    v: float
    phi: float
    dphi: float
    ddphi: float


class Motion(NamedTuple):
    """What the model gives: m/s2, rad/s, m/s, N m."""

    vdot: float
    w: float
    side: float
    torque: float


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_subnormal=False)


@st.composite
def robots(draw: st.DrawFn, effects: tuple[str, ...] = ()) -> Robot:
    """Robots of the paper's size, give or take a factor of a few, c2 < c1."""
    h = draw(numbers(0.01, 0.04))

    def platform(c: float) -> Platform:
        return Platform(
            m=draw(numbers(0.1, 1.0)),
            I=draw(numbers(5e-4, 1e-2)),
            c=c,
            a=draw(numbers(-0.03, 0.1)),
            b=draw(numbers(0.02, 0.08)),
            kappa=draw(numbers(0.01, 0.5)) * h**2,
        )

    return Robot(
        platform(draw(numbers(0.12, 0.3))),
        platform(draw(numbers(0.03, 0.11))),
        h,
        physics=tuple(EffectUse(name, draw(effect_values(name))) for name in effects),
    )


@st.composite
def effect_values(draw: st.DrawFn, name: str) -> dict[str, float]:
    """Values of an effect's parameters, up to five times their usual size."""
    return {
        p.name: draw(numbers(p.neutral, min(p.neutral + 5 * p.typical, p.bounds[1])))
        for p in CATALOGUE[name].parameters
    }


@st.composite
def cases(draw: st.DrawFn, effects: tuple[str, ...] = ()) -> tuple[Robot, State]:
    """A robot with these effects, in a state that keeps clear of the singular posture."""
    robot = draw(robots(effects))
    state = State(
        v=draw(numbers(-0.6, 0.6)),
        phi=draw(numbers(-0.9, 0.9)) * robot.singular_angle,
        dphi=draw(numbers(-6.0, 6.0)),
        ddphi=draw(numbers(-40.0, 40.0)),
    )
    return robot, state


def motion(robot: Robot, state: State, model: Dynamics | None = None) -> Motion:
    model = model or dynamics_of(robot)
    return Motion(*(float(out) for out in model.motion(*state, model.values(robot))))


def sides(robot: Robot, state: State, model: Dynamics | None = None) -> tuple[float, float]:
    """Side forces on the axles, N."""
    model = model or dynamics_of(robot)
    F1, F2 = model.sides(*state, model.values(robot))
    return float(F1), float(F2)


def energy(robot: Robot, state: State, model: Dynamics | None = None) -> tuple[float, float]:
    """Kinetic energy (J) and dissipation (W)."""
    model = model or dynamics_of(robot)
    kinetic, dissipation = model.energy(*state[:3], model.values(robot))
    return float(kinetic), float(dissipation)


def wheel_speeds(robot: Robot, state: State) -> dict[tuple[int, int], float]:
    """Rolling speed of each wheel by (platform, side), from the no-slip relations, m/s."""
    c1, c2 = robot.platform1.c, robot.platform2.c
    v, phi, dphi, _ = state
    S1, S2 = c1 * cos(phi) + c2, c1 + c2 * cos(phi)
    w = -(v * sin(phi) + c2 * dphi) / S1
    u2 = (v * S2 + c1 * c2 * sin(phi) * dphi) / S1
    return {
        (1, +1): v - robot.platform1.b * w,
        (1, -1): v + robot.platform1.b * w,
        (2, +1): u2 - robot.platform2.b * (w + dphi),
        (2, -1): u2 + robot.platform2.b * (w + dphi),
    }
