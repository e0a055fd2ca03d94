"""A linear machine: every fit of it can be done again by plain least squares over everything."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid.model import (
    Data,
    EffectInfo,
    Linearisation,
    Quantity,
    Request,
    Segment,
    Simulation,
)

A = np.array([[0.96, 0.2], [-0.2, 0.96]])
C = np.array([[1.0, 0.3], [0.0, 1.0]])
TRUE = MappingProxyType({"a": 0.3, "b": -0.4})


class LinearModel:
    """x' = A x + (a u1, b u2), y = C x; answers `sysid.model.Model`."""

    channels = ("y1", "y2")
    segment_length = correlation_time = 1.0
    horizon, bandwidth = float("inf"), 2.0
    form_error = 0.0
    catalogue: Mapping[str, EffectInfo] = MappingProxyType({})
    parameters = (
        Quantity("a", "m", 0.0, 0.5, True, -9.0, 9.0, 0.0),
        Quantity("b", "m", 0.0, 2.0, True, -9.0, 9.0, 0.0),
    )

    def __init__(
        self,
        seed: int = 0,
        runs: int = 3,
        true: Mapping[str, float] = TRUE,
        disturbed: float = 0.0,
        prior: tuple[float, float] = (np.inf, 0.7),
        least: float | Array = 0.0,
    ) -> None:
        """disturbed: a random push of the state at every sample, which the model lacks."""
        rng = np.random.default_rng(seed)
        t = np.arange(41) / 10
        self._inputs = rng.normal(size=(runs, t.size, 2))
        self._prior = np.array(prior)
        self.least = np.zeros(2) + least
        self.runs: Sequence[Data] = []
        for k in range(runs):
            x, values = 0.5 * rng.normal(size=2), []
            for n in range(t.size):
                values.append(C @ x)
                push = disturbed * rng.normal(size=2)
                x = A @ x + self._inputs[k, n] * [true["a"], true["b"]] + push
            sigma = np.full((t.size, 2), 0.1)
            noisy = np.array(values) + sigma * rng.normal(size=sigma.shape)
            noisy[rng.uniform(size=noisy.shape) < 0.1] = np.nan
            self.runs.append(Data(f"run{k}", t, noisy, sigma, held_out=False))

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """Anything."""
        return np.array([0.3, -0.2])

    def converted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """The same."""
        return request.state

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """Two different ones."""
        return np.array([0.1, 0.02])

    def least_process_noise(self, run: int, effects: tuple[str, ...]) -> Array:
        """As set."""
        return self.least

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """The second may be known."""
        return self._prior

    def prepare(self, every) -> None:
        """Nothing to do."""

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        return [Simulation(self._residuals(one), self._states(one)[-1]) for one in requests]

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """What would be recorded."""
        return self._states(request) @ C.T

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments: the model is linear, so by differences."""
        out = []
        for one in requests:
            here, end = self._residuals(one), self._states(one)[-1]
            moved = [Request(one.segment, one.values, one.state + e) for e in np.eye(2)]
            moved += [
                Request(one.segment, {**one.values, name: one.values[name] + 1.0}, one.state)
                for name in wanted
            ]
            columns = [(self._residuals(m) - here).ravel() for m in moved]
            J = np.column_stack([*columns, here.ravel()])
            ends = np.column_stack([self._states(m)[-1] - end for m in moved])
            out.append(Linearisation(J.T @ J, ends))
        return out

    def upstream(self):
        """Nothing."""
        return [((), {})]

    def proposals(self, fit, complete):
        """None."""
        return []

    def equivalent(self, values: Mapping[str, float]) -> None:
        """None."""

    def _states(self, one: Request) -> Array:
        by_state, by_values = self._maps(one.segment)
        return by_state @ one.state + by_values @ np.array([one.values["a"], one.values["b"]])

    @cache  # noqa: B019
    def _maps(self, segment: Segment) -> tuple[Array, Array]:
        """The states (n, 2) as linear functions of the first, and of a and b: (n, 2, 2) each."""
        by_state, by_values = [np.eye(2)], [np.zeros((2, 2))]
        for n in range(segment.first, segment.last):
            by_state.append(A @ by_state[-1])
            by_values.append(A @ by_values[-1] + np.diag(self._inputs[segment.run, n]))
        return np.array(by_state), np.array(by_values)

    def _residuals(self, one: Request) -> Array:
        data, segment = self.runs[one.segment.run], one.segment
        off = (self._states(one) @ C.T - data.values[segment.span]) / data.sigma[segment.span]
        off[segment.until - segment.first :] = 0.0
        return np.nan_to_num(off)


def stacked(problem, runs, states, values):
    """Residuals (rows,) of everything, and their derivatives by all states and the scaled
    quantities, without any elimination; the quantities' prior is not among them."""
    parts = [one for one in problem.segments if one.run in runs]
    model, names = problem.model, problem.names
    tight = 1 / np.hypot(problem.q * model.state_scale(()), model.least)
    weak = 1 / model.state_prior(())

    def residuals(x):
        own = dict(zip(names, x[2 * len(parts) :] * problem.scale, strict=True))
        moved = {**values, **{k: values[k] + v for k, v in own.items()}}
        begun = [states[one] + x[2 * k : 2 * k + 2] for k, one in enumerate(parts)]
        made = model.simulate(
            [Request(one, moved, s) for one, s in zip(parts, begun, strict=True)], ()
        )
        rows = [one.residuals.ravel() for one in made]
        # Of a run's first state.
        rows += [weak * s for one, s in zip(parts, begun, strict=True) if one.first == 0]
        for k in range(len(parts) - 1):
            if parts[k].run == parts[k + 1].run:
                rows.append(tight * (made[k].end - begun[k + 1]))
        return np.concatenate(rows)

    size = 2 * len(parts) + len(names)
    here = residuals(np.zeros(size))
    return here, np.column_stack([residuals(e) - here for e in np.eye(size)])
