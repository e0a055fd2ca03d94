"""The recording that would best decide what is still open.

Two candidate models predict a recording that is not made yet; the misfit of the rival, refitted to
it and to all existing recordings, discriminates between the two (T-optimal design, Atkinson and
Fedorov 1975). With a single candidate left, the recording is sought that most narrows the least
certain value that a recording can narrow. Both are linearised: every feasible gait is one run.
"""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.formatting import words_of
from rr_opt.machines.racer.model import RacerModel
from rr_opt.messages import listed
from rr_opt.model.experiment import CHANNELS, Recording, Run, Start
from rr_opt.model.gait import SineGait
from rr_opt.sysid.diagnosis import NextExperiment
from rr_opt.sysid.estimation import Fit, FitProblem, Linear, bounded_minimum, solve
from rr_opt.sysid.model import Request, Segment

_AMPLITUDES = (0.25, 0.45, 0.7, 1.0, 1.3)
_PERIODS = (0.6, 0.9, 1.3, 1.9, 2.8)
_OFFSETS = (0.0, 0.2, 0.45)
_STARTS: tuple[Start, Start] = ("rest", "running")
_HEADINGS = (0.0, math.pi / 2)
CLEARANCE = 0.25
"""The least S1 = c1 cos phi + c2 over c1 + c2 of a gait: near 0 is the singularity."""
FIERCEST = 30.0
"""Peak of phi's acceleration, rad/s2, beyond which real wheels let go."""
_RATE = 25.0
"""Samples a second of a planned recording; more add information, but do not change the ranking."""
_TOLD_APART = 0.3
"""RMS separation of two candidates, in sigma, that makes a recording worthwhile."""
_NARROWER = 1.1
"""Factor by which a recording has to narrow an interval to be worthwhile."""

_THEN = "Add it to experiment.yaml and diagnose again."

_AT_ONCE = 8
"""Plans that are simulated together."""
_STATE_STEPS = 3
"""Gauss-Newton steps for the initial states, as a poor guess of them counts as a difference."""


def next_experiment(
    racer: RacerModel, best: Fit, rival: tuple[str, Fit] | None
) -> NextExperiment | None:
    """The recording to make next.

    rival  the runner-up, its name first
    """
    plans = _plans(racer)
    if not plans:
        return None
    # A few at a time: all steps of all plans would be large.
    batches = [plans[k : k + _AT_ONCE] for k in range(0, len(plans), _AT_ONCE)]
    planned = (_planned(racer, best, some) for some in batches)
    if rival is not None:
        name, fit = rival
        experiments, separations = [], []
        for model, begun in planned:
            experiments.append((model.experiment, begun))
            separations.append(_separations(model, begun, fit))
        planned = ((racer.beside(one), begun) for one, begun in experiments)
        apart = np.concatenate(separations)
        k = int(np.argmax(apart))
        if apart[k] > _TOLD_APART:
            sentence = (
                f"{plans[k].asked} If the cause is {_words(best) or _NOMINAL}, a model with "
                f"{_words(fit) or name} would miss this recording by {apart[k]:.1f} sigma even "
                f"after refitting. {_THEN}"
            )
            return _answer(plans[k], (_names(best), name), float(apart[k]), sentence)
    known = _narrowed(best, planned)
    if known is None:
        return None
    k, quantity, factor, apart = known
    sentence = (
        f"{plans[k].asked} This would narrow the interval of {words_of(quantity)} by a factor of "
        f"{factor:.1f}. {_THEN}"
    )
    return _answer(plans[k], (_names(best), quantity), apart, sentence)


class _Plan:
    """A planned recording: its gait, length (s), start from rest or running, heading (rad)."""

    def __init__(self, gait: SineGait, seconds: float, start: Start, heading: float) -> None:
        self.gait, self.seconds, self.heading = gait, seconds, heading
        self.start: Start = start

    @property
    def asked(self) -> str:
        """What to record, as a sentence."""
        gait = self.gait
        begun = "starting from rest" if self.start == "rest" else "already driving"
        return (
            f"Record {self.seconds:.0f} s at amplitude {gait.amplitude:.2f} rad, period "
            f"{gait.period:.2f} s and offset {gait.offset:.2f} rad, {begun} at "
            f"psi = {math.degrees(self.heading):.0f} deg."
        )


def _answer(
    plan: _Plan, between: tuple[str, str], separation: float, sentence: str
) -> NextExperiment:
    gait = plan.gait
    return NextExperiment(
        *(gait.amplitude, gait.period, gait.offset, plan.seconds, plan.start, plan.heading),
        *(between, separation, sentence),
    )


_NOMINAL = "the nominal model"


def _names(fit: Fit) -> str:
    return " and ".join(fit.effects) or _NOMINAL


def _words(fit: Fit) -> str:
    return listed(map(words_of, fit.effects))


def _plans(racer: RacerModel) -> list[_Plan]:
    """Every feasible gait of the robot, for as long as the existing recordings."""
    robot, runs = racer.experiment.robot, racer.experiment.runs
    seconds = round(float(np.median([run.recording.t[-1] - run.recording.t[0] for run in runs])))
    out = []
    for amplitude, period, offset in itertools.product(_AMPLITUDES, _PERIODS, _OFFSETS):
        gait = SineGait(amplitude=amplitude, period=period, offset=offset)
        peak = amplitude + offset
        fierce = amplitude * (2 * math.pi / period) ** 2 > FIERCEST
        folded = robot.S1(min(peak, math.pi)) < CLEARANCE * robot.S1(0.0)
        limits = robot.servo
        beyond = peak > limits.angle_limit or gait.peak_rate > limits.rate_limit
        if not (fierce or folded or beyond):
            start: Start = _STARTS[len(out) % 2]
            out.append(_Plan(gait, float(max(seconds, 5)), start, _HEADINGS[len(out) // 2 % 2]))
    return out


def _planned(
    racer: RacerModel, best: Fit, plans: Sequence[_Plan]
) -> tuple[RacerModel, Mapping[Segment, Array]]:
    """The racer with the plans' recordings, as the best candidate predicts them, and the initial
    states."""
    noise = racer.experiment.noise
    times = [np.arange(0.0, plan.seconds, 1 / _RATE) for plan in plans]

    def recording(t: Array, values: Array) -> Recording:
        return Recording(
            "to be made",
            t,
            dict(zip(CHANNELS, values.T, strict=True)),
            {name: np.full(t.size, noise.of(name)) for name in CHANNELS},
            {name: np.zeros(t.size, np.uint8) for name in CHANNELS},
        )

    def made(values: Sequence[Array]) -> RacerModel:
        runs = tuple(
            Run(recording(t, one), plan.gait, "fit", plan.start)
            for plan, t, one in zip(plans, times, values, strict=True)
        )
        return racer.beside(replace(racer.experiment, runs=runs))

    empty, middle = made([np.zeros((t.size, len(CHANNELS))) for t in times]), _middle(racer)
    requests = [
        Request(one, best.values, _begun(racer, best, empty, one, plan, middle))
        for one, plan in zip(_whole(times), plans, strict=True)
    ]
    every = empty.simulator.paths(requests, best.effects)
    states = {one.segment: one.state for one in requests}
    planned = made([path.seen for _, path, _, _ in every])
    planned.simulator.reuse(empty.simulator)
    return planned, states


def _whole(times: Sequence[Array]) -> list[Segment]:
    return [Segment(k, 0, t.size, t.size - 1) for k, t in enumerate(times)]


def _middle(racer: RacerModel) -> Array:
    """Middle of the floor that was used (2,), m."""
    ends = np.vstack([run.values[np.isfinite(run.values[:, 0])][:, :2] for run in racer.runs])
    return (np.nanmin(ends, axis=0) + np.nanmax(ends, axis=0)) / 2


def _begun(
    racer: RacerModel, best: Fit, empty: RacerModel, segment: Segment, plan: _Plan, middle: Array
) -> Array:
    """Initial state in the middle of the floor; running robots are as fast as recorded ones."""
    z = 0.0 if plan.start == "rest" else racer.setting.speed
    plain = Request(segment, best.values, np.array([*middle, plan.heading, z]))
    return empty.simulator.converted(plain, best.effects)


def _of_plans(planned: RacerModel, begun: Mapping[Segment, Array], fit: Fit) -> FitProblem:
    return replace(fit.problem, model=planned, segments=tuple(begun), robust=False)


def _linearised(
    planned: RacerModel, begun: Mapping[Segment, Array], fit: Fit
) -> tuple[FitProblem, Mapping[int, tuple[Array, float, Array]]]:
    """H, g and value of every plan for the fit's quantities, its initial state eliminated."""
    problem = _of_plans(planned, begun, fit)
    # Undivided runs need no simulation.
    evidences = Linear.of(problem, dict(fit.values), begun, {}).evidences(problem.q)
    return problem, {run: (e.H, e.excess + e.samples, e.g) for run, e in evidences.items()}


def _separations(planned: RacerModel, begun: Mapping[Segment, Array], rival: Fit) -> Array:
    """RMS misfit of the rival on each plan's recording after refitting, in sigma: its values are
    refitted as linearised, beside initial states that suit it."""
    states = {
        one: planned.converted(Request(one, rival.values, state), rival.effects)
        for one, state in begun.items()
    }
    held = replace(_of_plans(planned, begun, rival), quantities=(), values=dict(rival.values))
    settled = solve(held, rival.values, states, _STATE_STEPS, 1.0)
    problem, plans = _linearised(planned, settled.states, rival)
    H0, _, _ = rival.information()
    low, high = problem.box
    out = []
    for run, (H, value, g) in plans.items():
        left = math.inf
        if np.isfinite(value):
            d = bounded_minimum(H0 + H, g, low - rival.u, high - rival.u)
            left = value + float(2 * g @ d + d @ (H0 + H) @ d)
        count = planned.runs[run].values.size
        out.append(math.sqrt(max(left, 0.0) / count) if math.isfinite(left) else 0.0)
    return np.array(out)


def _narrowed(
    best: Fit, planned: Iterable[tuple[RacerModel, Mapping[Segment, Array]]]
) -> tuple[int, str, float, float] | None:
    """The plan that most narrows a value: the least certain one that any plan narrows. Its index,
    the value's name, the factor, and the size of its effect in the recording, RMS in sigma."""
    if not best.u.size:
        return None
    added: dict[int, Array] = {}
    sizes: list[int] = []
    for some, begun in planned:
        _, plans = _linearised(some, begun, best)
        known = ((run, H) for run, (H, value, _) in plans.items() if np.isfinite(value))
        added |= {len(sizes) + run: H for run, H in known}
        sizes += [run.values.size for run in some.runs]
    if not added:
        return None
    H0, _, _ = best.information()
    before = np.sqrt(np.diag(np.linalg.inv(H0)))
    after = {run: np.sqrt(np.diag(np.linalg.inv(H0 + H))) for run, H in added.items()}
    quantities = best.problem.quantities

    def uncertainty(k: int) -> float:
        q = quantities[k]
        value = 1.0 if q.known else max(abs(best.values[q.name]), 1e-12) / q.scale
        return float(before[k]) / value

    own = [k for k, q in enumerate(quantities) if not q.known] or range(len(quantities))
    for k in sorted(own, key=uncertainty, reverse=True):
        run = min(after, key=lambda run: after[run][k])
        factor = float(before[k] / after[run][k])
        if factor >= _NARROWER:
            shown = math.sqrt(added[run][k, k] / sizes[run]) * float(before[k])
            return run, quantities[k].name, factor, shown
    return None
