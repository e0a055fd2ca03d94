"""What system identification needs of a machine: the protocol that a model implements.

A model has runs that were recorded, quantities (the parameters it always has, and those of its
effects), and a state that it steps. Runs are cut into segments, each with an initial state of its
own, so that a fit never has to simulate for longer than the model can be trusted.
"""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid.settings import SETTINGS


@dataclass(frozen=True)
class Quantity:
    """A number that a fit may change.

    value       its nominal value; an effect's neutral one
    scale       one standard deviation of what was known before, or the usual size of an effect
    known       whether `scale` is prior knowledge or only a typical size
    low, high   bounds
    neutral     where an effect vanishes; for a parameter its nominal value
    free        known only to within a factor: another value is no surprise, but a finding
    form_error  relative deviation between models of the effect in this value, one sigma
    """

    name: str
    unit: str
    value: float
    scale: float
    known: bool
    low: float
    high: float
    neutral: float
    free: bool = False
    form_error: float = 0.0

    @property
    def centre(self) -> float:
        """The mean of its prior; for an effect that vanishes at infinity, its usual size."""
        if self.known:
            return self.value
        return (
            self.neutral if abs(self.neutral) <= SETTINGS.effect_prior * self.scale else self.scale
        )


@dataclass(frozen=True)
class Form:
    """Quantities of an effect that are fitted together, and initial guesses of them."""

    quantities: tuple[Quantity, ...]
    guesses: tuple[Mapping[str, float], ...] = ({},)


@dataclass(frozen=True)
class EffectInfo:
    """An effect that may be missing from the nominal model.

    channel     where it would show
    smooth      the prediction is differentiable in its quantities where it vanishes, so that a
                score test can detect it
    tangent     if not: the effect that equals it to first order in its first form, or none
    upstream    it changes the machine's drive, which is recorded separately
    form_error  relative deviation of machines from this model of the effect
    named       a diagnosis may name it; if not, it is only a lookalike of others
    lookalikes  effects that are not named and move a machine much as it does: none may predict
                better if it is to be named
    unmodelled  what has no model and moves a machine much as it does, in words
    """

    name: str
    channel: str
    forms: tuple[Form, ...]
    smooth: bool = True
    tangent: str = ""
    upstream: bool = False
    form_error: float = 0.02
    named: bool = True
    lookalikes: tuple[str, ...] = ()
    unmodelled: tuple[str, ...] = ()


@dataclass(frozen=True, order=True)
class Choice:
    """An effect, in one of its forms."""

    name: str
    form: int = 0


@dataclass(frozen=True)
class ChannelNoise:
    """The noise of a channel.

    level        standard deviation, relative to that assumed
    correlation  its power at low frequencies over that of white noise of this level: the number of
                 samples worth one independent one
    """

    level: float = 1.0
    correlation: float = 1.0

    @property
    def quieter(self) -> bool:
        """Whether its level is certainly below that assumed."""
        return math.log(self.level) < -SETTINGS.misstated

    def differs(self, correlation: float = 1.0) -> bool:
        """Whether it certainly differs from the assumed level and correlation."""
        longer = abs(math.log(self.correlation / correlation))
        return abs(math.log(self.level)) > SETTINGS.misstated or longer > math.log(
            SETTINGS.correlated
        )


@dataclass(frozen=True)
class Data:
    """One recorded run: t (n,) s; values, sigma (n, channels), NaN where there are no data.

    correlation  (channels,) number of samples worth one with independent noise
    """

    name: str
    t: Array
    values: Array
    sigma: Array
    held_out: bool
    correlation: Array | float = 1.0

    @property
    def weighted_sigma(self) -> Array:
        """Sigma (n, channels) raised so that correlated samples may be treated as independent."""
        return self.sigma * np.sqrt(self.correlation)

    def worth(self, span: slice) -> float:
        """Effective number of independent samples in a span."""
        return float(np.sum(np.isfinite(self.values[span]).sum(axis=0) / self.correlation))

    @property
    def duration(self) -> float:
        """Length of the recording, s."""
        return float(self.t[-1] - self.t[0])


class Segment(NamedTuple):
    """A part of a run: its data are the samples first <= k < until, and it is simulated up to
    sample `last`, where the next segment begins."""

    run: int
    first: int
    until: int
    last: int

    @property
    def span(self) -> slice:
        """The samples over which it is simulated."""
        return slice(self.first, self.last + 1)


def segments(runs: Mapping[int, Data], length: float = np.inf) -> tuple[Segment, ...]:
    """Runs, by their index, cut into equal parts of about `length` s."""
    out = []
    for run, data in runs.items():
        parts = max(round(data.duration / length), 1)
        begun = np.searchsorted(data.t, np.linspace(data.t[0], data.t[-1], parts + 1)[:-1])
        # No segment begins in a gap, nor at the last sample, which no step follows.
        inner = np.unique(begun[(begun > 0) & (begun < data.t.size - 1)])
        for first, until in itertools.pairwise([0, *inner.tolist(), data.t.size]):
            out.append(Segment(run, first, until, min(until, data.t.size - 1)))
    return tuple(out)


@dataclass(frozen=True)
class Request:
    """A segment, and the values and the initial state with which it is simulated."""

    segment: Segment
    values: Mapping[str, float]
    state: Array


@dataclass(frozen=True)
class Simulation:
    """A simulated segment: residuals (n, channels) in sigma, 0 where there are no data; the state
    at its end."""

    residuals: Array
    end: Array

    @property
    def cost(self) -> float:
        """Sum of the squared residuals; inf where the simulation diverged."""
        cost = float(np.vdot(self.residuals, self.residuals))
        return cost if np.isfinite(cost) and np.isfinite(self.end).all() else np.inf


@dataclass(frozen=True)
class Linearisation:
    """gram  J'J with J = [by the state | by the quantities | residual], in sigmas
    end   (size, size + quantities) derivatives of the final state by initial state, quantities"""

    gram: Array
    end: Array


class Model(Protocol):
    """A machine with a catalogue of what may be missing from its nominal model.

    channels        what is recorded, in order
    runs            recorded
    segment_length  s, over which the machine is simulated as well as it is known
    horizon         s, beyond which a simulation says nothing: recordings are predicted in windows
                    of this length, each with its own initial state; inf: whole
    bandwidth       Hz; slower motion may be the machine's, anything faster is noise
    correlation_time  s, after which errors of the model are independent
    parameters      of the nominal model, with what is known of each
    catalogue       the effects it knows, by name
    form_error      RMS in sigma by which machines of this kind deviate from any model of them,
                    noise of their inputs included
    """

    @property
    def channels(self) -> tuple[str, ...]: ...  # noqa: D102
    @property
    def runs(self) -> Sequence[Data]: ...  # noqa: D102
    @property
    def segment_length(self) -> float: ...  # noqa: D102
    @property
    def horizon(self) -> float: ...  # noqa: D102
    @property
    def bandwidth(self) -> float: ...  # noqa: D102
    @property
    def correlation_time(self) -> float: ...  # noqa: D102
    @property
    def parameters(self) -> tuple[Quantity, ...]: ...  # noqa: D102
    @property
    def catalogue(self) -> Mapping[str, EffectInfo]: ...  # noqa: D102
    @property
    def form_error(self) -> float: ...  # noqa: D102

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """An initial guess of the state at the start of a segment."""
        ...

    def converted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The state of a model with other effects that corresponds to this one."""
        ...

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """Standard deviation of each state's process noise over a segment, at strength 1."""
        ...

    def least_process_noise(self, run: int, effects: tuple[str, ...]) -> Array:
        """Process noise of each state over a segment of a run that machines of this kind have under
        any model, one sigma."""
        ...

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """Prior standard deviation of each state of a run's start that is known to be about 0; else
        inf."""
        ...

    def prepare(self, every: Iterable[tuple[str, ...]]) -> None:
        """Get ready to simulate with each of these sets of effects soon."""
        ...

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        ...

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments in their initial state and in the quantities named."""
        ...

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The predicted recording of a segment (n, channels)."""
        ...
