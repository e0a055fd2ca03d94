"""The recording that would tell best between what is still open.

What a recording that is not made yet would tell between two explanations.

The accepted explanation says what would be recorded. Its rival is re-fitted to that and to all
recordings there are, which count through their curvature at the rival's fit; what it then is
still off is what tells the two apart. For a choice among many this is linearised. To check the
chosen one, the rival is fitted to the simulated recording step by step.

The recording that would narrow down most what is known worst.

Of a linearised fit the covariance of the values is known, and what a new recording adds to its
inverse. The standard deviation of each value is counted against what was known of it beforehand,
or, of an effect and of what nothing was known of, against the value itself.

That is the accepted explanation and its closest rival; where there is none, the value that is known
worst. Gaits are ranked first, then starts and headings of the best of them, all linearised, and the
winner is checked by simulation.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.mechanics.kinematics import robot_values
from rr_opt.model.experiment import CHANNELS, Recording, Run, Start
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.motion.floor_motion import floor_motion
from rr_opt.sysid.candidate import Explanation
from rr_opt.sysid.diagnosis import NextExperiment
from rr_opt.sysid.least_squares import Problem, bounded_step, box, scaled, unscaled
from rr_opt.sysid.model import Asked, Piece, Quantity
from rr_opt.sysid.values import covariance

CLEARANCE = 0.25
"""The least S1 = c1 cos phi + c2 over c1 + c2 that a plan comes to: near 0 is the singularity."""

FIERCEST = 30.0
"""Peak of phi's acceleration, rad/s2, beyond which real wheels let go."""

_AMPLITUDES = (0.25, 0.4, 0.6, 0.8, 1.0, 1.3)
_PERIODS = (0.6, 0.8, 1.0, 1.4, 2.0, 2.8)
_OFFSETS = (0.0, 0.15, 0.3, 0.5)
_SETTLING = 20.0
"""So long a robot that is `running` has been driven before, s."""


@dataclass(frozen=True)
class Plan:
    """A recording to be made: a sine, how long (s), from rest or running, heading (rad)."""

    gait: SineGait
    seconds: float
    start: Start
    heading: float


def gaits(robot: Robot) -> list[SineGait]:
    """Sines within the servo's limits and away from the singular posture, both sides."""
    offsets = sorted({side * offset for offset in _OFFSETS for side in (1, -1)})
    every = (SineGait(*one) for one in itertools.product(_AMPLITUDES, _PERIODS, offsets))
    return [gait for gait in every if allowed(robot, gait)]


def allowed(robot: Robot, gait: SineGait) -> bool:
    """Whether the servo can do it, and the robot stays away from the singular posture."""
    c1, c2 = robot.platform1.c, robot.platform2.c
    S1 = c1 * math.cos(min(gait.peak_angle, math.pi)) + c2
    return (
        gait.peak_angle <= robot.servo.angle_limit
        and gait.peak_rate <= robot.servo.rate_limit
        and gait.amplitude * gait.angular_frequency**2 <= FIERCEST
        and CLEARANCE * (c1 + c2) <= S1
    )


@dataclass(frozen=True)
class Imagined:
    """Runs that were never made, as those of a model, and the states in which they start."""

    model: RollerRacer
    starts: Mapping[Piece, Array]

    def within(self, room: float) -> dict[Piece, Array]:
        """Those that go no farther than `room`, m, and keep to the numbers."""
        values = {piece: self.model.runs[piece.run].values for piece in self.starts}
        return {
            piece: start
            for piece, start in self.starts.items()
            if np.isfinite(values[piece][1:]).any() and extent([values[piece][:, :2]]) <= room
        }


def imagined(
    model: RollerRacer,
    plans: Sequence[Plan],
    rate: float,
    values: Mapping[str, float],
    effects: tuple[str, ...],
) -> Imagined:
    """The runs of plans, sampled at `rate`, 1/s, as the model with the effects predicts them.

    They start from where the recorded runs did, in the middle of them.
    """
    first = np.nanmedian([data.values[:20, :2] for data in model.runs], axis=(0, 1))
    starts = [np.array([*first, plan.heading, 0.0, 0.0, 0.0]) for plan in plans]
    for k, z in _settled(model, plans, values, effects, starts).items():
        starts[k][3] = z
    times = [np.arange(round(plan.seconds * rate) + 1) / rate for plan in plans]
    empty, predicted = _driven(model, plans, times, values, effects, starts)
    runs = [
        replace(run, recording=_recording(model, t, seen))
        for run, t, seen in zip(empty.experiment.runs, times, predicted, strict=True)
    ]
    # A run that leaves the numbers says nothing of what is usual, and no plan changes another's.
    made = RollerRacer(replace(model.experiment, runs=tuple(runs)), model.setting)
    pieces = (Piece(k, 0, t.size) for k, t in enumerate(times))
    return Imagined(made, dict(zip(pieces, starts, strict=True)))


def _settled(
    model: RollerRacer,
    plans: Sequence[Plan],
    values: Mapping[str, float],
    effects: tuple[str, ...],
    starts: Sequence[Array],
) -> dict[int, float]:
    """z, m/s, of the plans that start running, after whole periods of the gait begun at rest."""
    running = [k for k, plan in enumerate(plans) if plan.start == "running"]
    before = [replace(plans[k], start="rest") for k in running]
    times = []
    for plan in before:
        period = plan.gait.period
        end = math.ceil(_SETTLING / period) * period
        t = np.arange(0.0, end - period / 40, period / 40)
        times.append(np.append(t, [end - 1e-3, end]))
    _, predicted = _driven(model, before, times, values, effects, [starts[k] for k in running])
    p = robot_values(model.experiment.robot)
    out = {}
    for k, seen in zip(running, predicted, strict=True):
        dx, dy = (seen[-1, :2] - seen[-2, :2]) / 1e-3
        # P moves at v along platform 1's axis, and the state holds z = v - g dphi.
        v = float(dx * np.cos(seen[-1, 2]) + dy * np.sin(seen[-1, 2]))
        gait = plans[k].gait
        angle = [float(gait.angle(0.0)), float(gait.rate(0.0))]
        out[k] = v - float(floor_motion().speeds([*starts[k][:3], 0.0], angle, p)[0])
    return out


def _driven(
    model: RollerRacer,
    plans: Sequence[Plan],
    times: Sequence[Array],
    values: Mapping[str, float],
    effects: tuple[str, ...],
    starts: Sequence[Array],
) -> tuple[RollerRacer, Sequence[Array]]:
    """A model with the runs of plans, still empty, and its predictions of them (n, 4)."""
    runs = tuple(
        Run(_recording(model, t, np.zeros((t.size, len(CHANNELS)))), plan.gait, "fit", plan.start)
        for plan, t in zip(plans, times, strict=True)
    )
    empty = RollerRacer(replace(model.experiment, runs=runs), model.setting)
    asked = [
        Asked(Piece(k, 0, t.size), values, start)
        for k, (t, start) in enumerate(zip(times, starts, strict=True))
    ]
    return empty, empty.simulated.predicted(asked, effects)


def _recording(model: RollerRacer, t: Array, values: Array) -> Recording:
    noise = model.experiment.noise
    return Recording(
        "to be made",
        t,
        dict(zip(CHANNELS, values.T, strict=True)),
        {name: np.full(t.size, noise.of(name)) for name in CHANNELS},
        {name: np.zeros(t.size, np.uint8) for name in CHANNELS},
    )


def extent(paths: Sequence[Array]) -> float:
    """How far any of the paths (n, 2) goes from where it starts, m."""
    return max(float(np.nanmax(np.hypot(*(path - path[_first(path)]).T))) for path in paths)


def _first(path: Array) -> int:
    return int(np.flatnonzero(np.isfinite(path).all(axis=1))[0])


RANKED_RATE, _CHECKED_RATE = 25.0, 100.0
"""Samples a second of a made-up recording, to choose and to check."""


@dataclass(frozen=True)
class Rival:
    """What is to be told from the accepted explanation.

    H      curvature of the present cost at its fit, scaled, by the quantities that are fitted
    tells  a sentence on what the recording is good for, if it is not for the two names
    """

    name: str
    effects: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    values: Mapping[str, float]
    H: Array
    tells: str = ""


@dataclass(frozen=True)
class Contest:
    """An accepted explanation against a rival; room (m) is how far a plan may go."""

    model: RollerRacer
    accepted: Explanation
    rival: Rival
    room: float

    def promises(self, plans: Sequence[Plan]) -> list[float]:
        """By how much the two would differ on each plan's recording after re-fitting, RMS in sigma,
        linearised; 0 if the plan leaves the floor there is."""
        made = self._made(plans, RANKED_RATE)
        rival, near = self.rival, made.within(self.room)
        normals = self._problem(made).normals(rival.values, near)
        u = scaled(rival.quantities, rival.values)
        out = []
        for piece in made.starts:
            promise = 0.0
            if piece in near:
                normal, count = normals[piece], made.model.runs[piece.run].values.size
                d = _step(rival, normal.H, normal.g, u, np.zeros_like(u))
                cost = normal.at(d) + float(d @ rival.H @ d)
                promise = math.sqrt(max(cost, 0.0) / count) if math.isfinite(cost) else 0.0
            out.append(promise)
        return out

    def checked(self, plan: Plan, steps: int = 6) -> float:
        """The same from simulations: the rival is fitted to the recording step by step."""
        made = self._made([plan], _CHECKED_RATE)
        problem, rival = self._problem(made), self.rival
        ((piece, start),) = made.starts.items()
        u0 = scaled(rival.quantities, rival.values)
        u, least = u0, math.inf
        for _ in range(steps):
            values = dict(rival.values) | unscaled(rival.quantities, u)
            normal = problem.normal(piece, values, start)
            now = self._total(problem, piece, values, start, u - u0)
            least = min(least, now)
            d = _step(rival, normal.H, normal.g, u, u - u0)
            # A step that is too long is halved until it helps.
            for part in (1.0, 0.5, 0.25, 0.1):
                moved = start + normal.shift + normal.follow @ (part * d)
                trial = dict(rival.values) | unscaled(rival.quantities, u + part * d)
                reached = self._total(problem, piece, trial, moved, u + part * d - u0)
                if reached < now:
                    break
            else:
                break
            u, start, least = u + part * d, moved, reached
            if now - reached < 0.01 * reached + 0.1:
                break
        return math.sqrt(least / made.model.runs[0].values.size)

    def _total(
        self, problem: Problem, piece: Piece, values: Mapping[str, float], start: Array, d: Array
    ) -> float:
        """What the new recording and the present ones cost together, in chi-square."""
        return problem.cost(values, {piece: start})[0] + float(d @ self.rival.H @ d)

    def _made(self, plans: Sequence[Plan], rate: float) -> Imagined:
        fit = self.accepted.whole
        return imagined(self.model, plans, rate, fit.values, fit.effects)

    def _problem(self, made: Imagined) -> Problem:
        rival = self.rival
        return Problem(
            made.model, tuple(made.starts), rival.effects, rival.quantities, dict(rival.values)
        )


def _step(rival: Rival, H: Array, g: Array, u: Array, moved: Array) -> Array:
    """The rival's best step, given what the new recording says; `moved` so far (n,)."""
    low, high = box(rival.quantities)
    return bounded_step(H + rival.H, g + rival.H @ moved, 1e-9, u, low, high)


def as_rival(other: Explanation) -> Rival:
    """Another explanation as the rival."""
    fit = other.whole
    return Rival(name_of(other), fit.effects, fit.quantities, fit.values, fit.total().H)


def name_of(explanation: Explanation) -> str:
    """Its effects, for a person."""
    return " + ".join(explanation.names).replace("_", " ") or "the model as it is"


@dataclass(frozen=True)
class Narrowing:
    """The accepted explanation, and how far (m) a plan may go."""

    model: RollerRacer
    accepted: Explanation
    room: float

    def promises(self, plans: Sequence[Plan]) -> list[float]:
        """By how much a value's relative standard deviation would fall at most with each plan's
        recording; 0 if the plan leaves the floor there is."""
        return [
            0.0 if both is None else float(self._drops(*both).max())
            for both in self._deviations(plans)
        ]

    def rival(self, plan: Plan) -> Rival | None:
        """The accepted explanation, but the value that the plan narrows most is off by one
        standard deviation, and all others adjusted so that the present recordings hardly tell."""
        (both,), fit = self._deviations([plan]), self.accepted.whole
        if both is None:
            return None
        k, spread = int(np.argmax(self._drops(*both))), covariance(fit)
        along = spread[:, k] / math.sqrt(spread[k, k])
        _, high = box(fit.quantities)
        if (high - fit.scaled)[k] < along[k]:
            along = -along
        values = dict(fit.values) | unscaled(fit.quantities, fit.scaled + along)
        q = fit.quantities[k]
        rest = [j for j in range(len(fit.quantities)) if j != k]
        now, then = (one[k] * q.scale for one in both)
        return Rival(
            f"{q.name} = {values[q.name]:.3g} {q.unit} instead of {fit.values[q.name]:.3g}",
            fit.effects,
            tuple(fit.quantities[j] for j in rest),
            values,
            fit.total().H[np.ix_(rest, rest)],
            f"It would tell most about {q.name}, which is {fit.values[q.name]:.3g} {q.unit} and "
            f"would be known to {then:.2g} (one standard deviation) instead of {now:.2g}.",
        )

    def _deviations(self, plans: Sequence[Plan]) -> list[tuple[Array, Array] | None]:
        """Standard deviations of the values, scaled, now and with each plan's recording."""
        fit = self.accepted.whole
        if not fit.quantities:
            return [None] * len(plans)
        made = imagined(self.model, plans, RANKED_RATE, fit.values, fit.effects)
        problem = Problem(made.model, tuple(made.starts), fit.effects, fit.quantities)
        normals = problem.normals(fit.values, made.within(self.room))
        H, now = fit.total().H, np.sqrt(np.diag(covariance(fit)))
        before = _deviations(H)
        out: list[tuple[Array, Array] | None] = []
        for piece in made.starts:
            both = None
            if piece in normals:
                # The model is doubted then as it is now.
                then = now * _deviations(H + normals[piece].H) / before
                both = (now, then) if np.isfinite(then).all() else None
            out.append(both)
        return out

    def _drops(self, now: Array, then: Array) -> Array:
        fit = self.accepted.whole
        return (now - then) / [_size(q, fit.values[q.name]) for q in fit.quantities]


def _deviations(H: Array) -> Array:
    return np.sqrt(np.diag(np.linalg.pinv(H, hermitian=True)))


def _size(q: Quantity, value: float) -> float:
    """Against what a standard deviation of it, scaled, is large or small."""
    if q.known and not q.free:
        return 1.0
    return max(abs(value - (0.0 if q.free else q.neutral)) / q.scale, 1e-3)


_SHORT, _LONG = 30.0, 60.0
_HEADINGS = tuple(k * math.pi / 2 for k in range(4))
_FINALISTS = 3
_TRIED = 48
"""So many gaits, spread over those that are allowed."""

_CLEAR = 1.0
"""A recording that tells the two apart by so much, RMS in sigma, is long enough."""

_ROOM = 1.5
"""So much farther than the present recordings, the next may go."""


Promises = Callable[[Sequence[Plan]], Sequence[float]]


def next_experiment(
    model: RollerRacer, best: Explanation, rival: Explanation | None = None
) -> NextExperiment | None:
    """The plan that tells best; None if no gait is allowed or none tells anything.

    rival  another explanation; without one, the value that is known worst is to be known better
    """
    room = _ROOM * extent([data.values[:, :2] for data in model.runs])
    if rival is None:
        narrowing = Narrowing(model, best, room)
        plan = _leading(narrowing.promises, model)
        other = narrowing.rival(plan) if plan else None
    else:
        other = as_rival(rival)
        plan = _leading(Contest(model, best, other, room).promises, model)
    if plan is None or other is None:
        return None
    return _checked(Contest(model, best, other, room), plan, other, name_of(best))


def _leading(promises: Promises, model: RollerRacer) -> Plan | None:
    """The plan that promises most: gaits first, then starts and headings of the best."""
    allowed = gaits(model.experiment.robot)
    some = allowed[:: max(len(allowed) // _TRIED, 1)]
    first = _ranked(promises, [Plan(gait, _SHORT, "rest", 0.0) for gait in some])[:_FINALISTS]
    varied = [
        replace(plan, start=start, heading=heading)
        for plan in first
        for start in ("rest", "running")
        for heading in _HEADINGS
    ]
    return next(iter(_ranked(promises, varied)), None)


def _ranked(promises: Promises, plans: Sequence[Plan]) -> list[Plan]:
    """Those that promise anything, most first."""
    if not plans:
        return []
    found = sorted(zip(promises(plans), range(0, -len(plans), -1), strict=True), reverse=True)
    return [plans[-k] for promised, k in found if promised > 0]


def _checked(contest: Contest, plan: Plan, other: Rival, name: str) -> NextExperiment:
    told = contest.checked(plan)
    longer = replace(plan, seconds=_LONG)
    if told < _CLEAR and contest.promises([longer])[0] > 0:
        plan, told = longer, contest.checked(longer)
    return _told(plan, (name, other.name), told, other.tells)


def _told(plan: Plan, between: tuple[str, str], told: float, tells: str) -> NextExperiment:
    gait, degrees = plan.gait, math.degrees
    begin = "from standing still" if plan.start == "rest" else "while it is running"
    tells = tells or (
        f"There {between[0]} and {between[1]} should differ by {told:.2g} sigma, RMS, after both "
        "are fitted to all recordings."
    )
    sentence = (
        f"Record {plan.seconds:.0f} s {begin}, heading {degrees(plan.heading):.0f} deg, with "
        f"amplitude {gait.amplitude:g} rad ({degrees(gait.amplitude):.0f} deg), period "
        f"{gait.period:g} s and offset {gait.offset:g} rad ({degrees(gait.offset):.0f} deg). "
        f"{tells}"
    )
    return NextExperiment(
        gait.amplitude,
        gait.period,
        gait.offset,
        plan.seconds,
        plan.start,
        plan.heading,
        between,
        told,
        sentence,
    )
