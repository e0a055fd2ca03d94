"""What the diagnosis needs of a machine: the protocol that a model answers.

A model has quantities (the parameters it always has, and those of its effects), runs that were
recorded of it, and channels in which they were. It predicts a run, and says how the prediction
changes with every quantity and with the state the run starts in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from rr_opt.array import Array

if TYPE_CHECKING:
    from rr_opt.sysid.least_squares import Fit


@dataclass(frozen=True)
class Quantity:
    """A number that a fit may change.

    value       where it starts: a parameter's nominal value, an effect's first guess
    scale       one standard deviation of what was known before, or the usual size of an effect
    known       whether `scale` is knowledge (a prior) or only a size
    free        known only to within a factor: another value is no surprise, but a finding
    low, high   where it may lie
    neutral     at which an effect vanishes; for a parameter its nominal value
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


@dataclass(frozen=True)
class Form:
    """Quantities of an effect that are looked for together, and from where.

    starts  values by quantity; the fit begins at that which promises most. From where to look for
            an effect that jumps, the model proposes
    """

    quantities: tuple[Quantity, ...]
    starts: tuple[Mapping[str, float], ...]


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing from the nominal model.

    channel   where it would show, in the words of the verdict
    imitates  candidates with no more quantities that a form of this one comes close to
    """

    name: str
    family: str
    channel: str
    sentence: str
    forms: tuple[Form, ...]
    imitates: tuple[str, ...] = ()


@dataclass(frozen=True)
class Proposal:
    """From where to look for an effect that jumps.

    gain   by how much it promises to lower the chi-square of a fit without it
    doubt  of that fit; see `problem.doubt`
    """

    values: Mapping[str, float]
    gain: float
    doubt: float


@dataclass(frozen=True)
class Data:
    """One run as the fit sees it: t (n,) s; values, sigma (n, channels), NaN for no data."""

    name: str
    t: Array
    values: Array
    sigma: Array
    held_out: bool


@dataclass(frozen=True)
class Piece:
    """The samples first <= k < last of a run, which is all of it or a part."""

    run: int
    first: int
    last: int

    @property
    def span(self) -> slice:
        """As a slice."""
        return slice(self.first, self.last)


@dataclass(frozen=True)
class Response:
    """What a model predicts of a run, and its derivatives.

    predicted  (n, channels)
    by_value   (n, channels, quantities) by those asked for
    by_start   (n, channels, start) by the state at the start
    """

    predicted: Array
    by_value: Array | None = None
    by_start: Array | None = None

    @property
    def slopes(self) -> tuple[Array, Array]:
        """by_value and by_start, which were asked for."""
        if self.by_value is None or self.by_start is None:
            raise ValueError("derivatives were not asked for")
        return self.by_value, self.by_start


@dataclass(frozen=True)
class Asked:
    """A piece of a run, and the values and the start with which it is to be predicted."""

    piece: Piece
    values: Mapping[str, float]
    start: Array


class Model(Protocol):
    """A machine with a catalogue of what may be missing from its nominal model."""

    @property
    def channels(self) -> tuple[str, ...]:
        """What is recorded, in order."""
        ...

    @property
    def runs(self) -> Sequence[Data]:
        """The recorded runs."""
        ...

    @property
    def window(self) -> float:
        """Seconds of the pieces in which a fit begins: so short that it has no wrong minima."""
        ...

    @property
    def inexact(self) -> float:
        """Misfit, RMS in sigma, by which machines of this kind differ from any model of them."""
        ...

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        """Of the nominal model, with what is known of each."""
        ...

    @property
    def catalogue(self) -> Mapping[str, Candidate]:
        """The effects it knows, by name."""
        ...

    @property
    def jumping(self) -> frozenset[str]:
        """The effects that have no derivative where they vanish."""
        ...

    @property
    def dear(self) -> frozenset[str]:
        """Those of them that are dear to look for, and so only where nothing else will do."""
        ...

    @property
    def placed(self) -> frozenset[str]:
        """Those that are at some place, so that they can follow what is missing elsewhere."""
        ...

    @property
    def rough(self) -> frozenset[str]:
        """Quantities of effects of which there are as many models as machines, none exact."""
        ...

    @property
    def vague(self) -> Mapping[str, float]:
        """By what share of such a quantity's value those models differ in it, one sigma."""
        ...

    def propose(self, name: str, form: int, fit: Fit) -> Sequence[Proposal]:
        """From where to look for an effect that jumps, beside a fit without it."""
        ...

    def twin(self, values: Mapping[str, float]) -> Mapping[str, float] | None:
        """Values that predict the same and are nearer to what was believed, if there are any."""
        ...

    def nameless(self, whole: Fit, windows: Fit) -> Fit | None:
        """The parameters with a term of its own that has no name, over whole runs, from fits of
        the parameters over whole runs and of the starts in windows; None if there is no such term.
        """
        ...

    def start(self, piece: Piece) -> Array:
        """A first guess of the state in which a piece of a run starts."""
        ...

    @property
    def start_within(self) -> Array:
        """One sigma of each number of a start of which it is known that it is about 0, or inf."""
        ...

    def respond(
        self,
        piece: Piece,
        values: Mapping[str, float],
        effects: tuple[str, ...],
        start: Array,
        wanted: tuple[str, ...] | None = None,
    ) -> Response:
        """Predict a piece of a run from its start; derivatives by `wanted`, if any."""
        ...

    def off(self, asked: Sequence[Asked], effects: tuple[str, ...]) -> Sequence[Array]:
        """(predicted - recorded)/sigma (n, channels) of each piece, 0 where there are no data."""
        ...

    def grams(
        self,
        asked: Sequence[Asked],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        *,
        stray: bool = False,
    ) -> Sequence[Array]:
        """J'J of each piece, J = [by the start | by `wanted` | off] in sigmas at all data; with
        `stray` what no model has exactly, one sigma of it, is one more number of the start."""
        ...
