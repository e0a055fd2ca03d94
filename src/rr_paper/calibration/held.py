"""A model held against one reading of the columns: fits, profiles, predictions, made data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_paper.calibration.compare import Likelier, likelier
from rr_paper.calibration.fit import Effort, Fit, Library, fit, leave_one_out, library
from rr_paper.calibration.models import AMPLITUDE, Column, Law, Model, Reading, measured, one_way
from rr_paper.calibration.profile import Profile, profiles

TABLE_3_ALONE = (~np.isnan(AMPLITUDE)).astype(float)
"""1 for the six rows whose amplitude is printed."""


@dataclass(frozen=True)
class Searched:
    """A model under one reading of J20/J10, ready to be fitted.

    predict  points (N, unknowns), shares of the boxes -> signed speeds (N, 9)
    """

    model: Model
    predict: Callable[[Array], Array]
    known: Library
    effort: Effort

    def profiles(self, column: Column, law: Law) -> tuple[Profile, ...]:
        """Of each unknown that is told."""
        if not self.model.told:
            return ()
        data = measured(column)
        return tuple(
            profiles(
                lambda x: one_way(self.predict(x)),
                data,
                self.known.points,
                self.known.deviance(data, law),
                unknowns=[self.model.unknowns.index(name) for name in self.model.told],
                law=law,
                values=self.effort.values,
                starts=self.effort.starts,
                steps=self.effort.steps,
            )
        )

    def fit(
        self, column: Column, law: Law, also: Array | None = None, counted: Array | None = None
    ) -> Fit:
        """The best fit, also from the starts `also` (K, unknowns)."""
        work = self.effort
        return fit(
            self.predict, self.known, measured(column), law=law, slices=work.slices,
            steps=work.steps, also=also, counted=counted,
        )  # fmt: skip


@dataclass(frozen=True)
class Held:
    """A model held against one column.

    student, normal  best fits by each law; table3: to the six rows of Table 3 alone, by Student's
    left_out         z (9,) of each row as predicted from the other eight
    profiles         of each unknown that is told, by Student's law
    likelier         its fit against fits to data that the viscous model made
    """

    model: Model
    column: Column
    student: Fit
    normal: Fit
    table3: Fit
    left_out: Array
    profiles: tuple[Profile, ...]
    likelier: Likelier | None


def searched(model: Model, reading: Reading, effort: Effort, tick: Callable[[], None]) -> Searched:
    """The model with its library."""

    def predict(points: Array) -> Array:
        return model(points, reading)

    return Searched(
        model, predict, library(predict, len(model.unknowns), effort.log2_size, tick), effort
    )


def hold(one: Searched, column: Column, viscous: tuple[Searched, Held] | None) -> Held:
    """viscous: the viscous model and what it came to, for the models that contain it."""
    data, size = measured(column), len(one.model.unknowns)
    found = one.profiles(column, "student")
    also = np.concatenate([np.empty((0, size)), *(profile.points for profile in found)])
    if viscous and one.model.nested:
        inner = viscous[1]
        also = np.concatenate([also, _lifted(np.array([inner.student.point, inner.normal.point]))])
    student = one.fit(column, "student", also)
    normal = one.fit(column, "normal", np.concatenate([also, student.point[None]]))
    left_out = leave_one_out(
        one.predict, one.known, data, student, law="student",
        slices=max(1, one.effort.slices // 4), steps=one.effort.steps,
    )  # fmt: skip
    table3 = one.fit(column, "student", student.point[None], TABLE_3_ALONE)
    return Held(
        one.model, column, student, normal, table3, left_out, found,
        _likelier(one, student, column, viscous),
    )  # fmt: skip


def _likelier(
    one: Searched, best: Fit, column: Column, viscous: tuple[Searched, Held] | None
) -> Likelier | None:
    """For the viscous model itself, and for those that contain it."""
    sets, data = one.effort.sets, measured(column)
    if viscous is None:
        return likelier((one.predict, one.known, best), None, data, sets=sets)
    if not one.model.nested:
        return None
    small = (viscous[0].predict, viscous[0].known, viscous[1].student)
    return likelier(small, (one.predict, one.known, best, _lifted), data, sets=sets)


def _lifted(points: Array) -> Array:
    """Points of the viscous model as points of one that contains it, (K, unknowns + 1)."""
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1)
