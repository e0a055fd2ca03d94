"""Diagnoses that are made up: no fit is run, so every kind of verdict can be reported."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run, Uncertainty
from rr_opt.model.gait import SineGait
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.sysid.diagnosis import (
    Curve,
    Diagnosis,
    Estimate,
    Finding,
    Misfit,
    Mismatch,
    NextExperiment,
    Remainder,
    Residue,
    Stage,
    Tie,
    Tried,
)
from tests.robots import BENCHMARK

NOISE = Noise(position=0.001, angle=0.003)
SIGMA = np.array([NOISE.of(name) for name in CHANNELS])
T = np.arange(0, 20, 0.01)
FRICTION = {
    "force1": Estimate(0.0152, 0.0141, 0.0163, "N"),
    "force2": Estimate(0.0098, 0.0089, 0.0107, "N"),
}


def _truth(number):
    turn = 0.1 * (number + 1)
    psi = turn * T + 0.2 * np.sin(2 * np.pi * T)
    x, y = (np.cumsum(0.1 * f(psi)) * 0.01 for f in (np.cos, np.sin))
    return np.column_stack([x, y, psi, 0.7 * np.sin(2 * np.pi * T / 1.2)])


def _run(number, use):
    rng = np.random.default_rng(number)
    values = _truth(number) + SIGMA * rng.normal(size=(T.size, 4))
    flags = np.zeros((T.size, 4), np.uint8)
    flags[400:430] = 1
    recording = Recording(
        f"run0{number + 1}.csv",
        T,
        {name: values[:, k] for k, name in enumerate(CHANNELS)},
        {name: np.full(T.size, SIGMA[k]) for k, name in enumerate(CHANNELS)},
        {name: flags[:, k] for k, name in enumerate(CHANNELS)},
    )
    return Run(recording, SineGait(0.7, 1.2), use, "rest")


def _misfit(run, number, drift):
    data = np.column_stack([run.recording.data(name) for name in CHANNELS])
    predicted = _truth(number) + drift * SIGMA * np.outer(T / T[-1], [1, 1, 1, 0])
    residuals = (predicted - data) / SIGMA
    channels = {
        name: float(np.sqrt(np.nanmean(residuals[:, k] ** 2))) for k, name in enumerate(CHANNELS)
    }
    total = float(np.sqrt(np.nanmean(residuals**2)))
    return Misfit(run.name, run.use == "holdout", total, channels, T, predicted, residuals)


def _experiment():
    runs = tuple(_run(k, use) for k, use in enumerate(("fit", "holdout", "fit", "holdout")))
    known = {"m1": Uncertainty(0.005), "kappa1": Uncertainty(factor=5.0)}
    return Experiment(BENCHMARK, NOISE, known, runs, "trial")


def _stages():
    at = np.linspace(-0.2, 0.2, 12)
    curve = Curve("speed", "m/s", at, 4 * np.tanh(at / 0.05), np.full(12, 0.3))
    other = Curve("phase", "rad", np.linspace(0, 6, 12), np.zeros(12), np.full(12, 0.3))
    return (
        Stage("measurement", "measurement", 8.1, 0.42, 0.01, False, ""),
        Stage("actuation", "actuation", 5.0, 0.75, 0.0, False, ""),
        Stage("kinematics", "constraint_axle1", 11.0, 0.2, 0.03, False, ""),
        Stage("rolling", "rolling", 310.0, 1e-40, 3.1, True, "it resists motion at every speed",
              (curve, other)),
        Stage("floor", "floor", 70.0, 1e-9, 0.8, False, "heading"),
    )  # fmt: skip


def _found(experiment):
    levels = [
        tuple(_misfit(run, k, drift) for k, run in enumerate(experiment.runs))
        for drift in (14.0, 9.0, 0.0)
    ]
    m1 = Estimate(0.4691, 0.4605, 0.4777, "kg")
    kappa1 = Estimate(2.1e-5, 1.8e-5, 2.4e-5, "N m s")
    friction = {f"coulomb_friction.{name}": one for name, one in FRICTION.items()}
    parameters = {"m1": m1, "kappa1": kappa1, **friction}
    return Diagnosis(
        verdict="missing_physics",
        summary="The model leaves out coulomb friction. It was 8.1 sigma off.",
        mismatch=Mismatch(8.0, 0.0),
        channel="rolling",
        where="",
        stages=_stages(),
        findings=(Finding("coulomb_friction", 0.99, FRICTION, 0.97),),
        parameters=parameters,
        tried=(
            Tried(("coulomb_friction",), 0.02, 1000.0, {}, True),
            Tried(("quadratic_drag",), float("nan"), 1900.0, {}, False),
            Tried((), 8.0, 3000.0, {}, False),
        ),
        ties=(Tie(("coulomb_friction",), ("floor_patch",)),),
        next_experiment=NextExperiment(
            0.9, 0.8, 0.1, 30.0, "rest", 0.0, ("coulomb_friction", "floor_patch"), 4.2,
            "Drive the same gait over another part of the floor.",
        ),
        residue=(),
        nominal=levels[0],
        refitted=levels[1],
        final=levels[2],
        before=8.1,
        after=1.0,
        values={name: one.value for name, one in parameters.items()},
        seconds={"fitting the parameters": 3.2, "looking for what is missing": 11.5},
        remainder=Remainder("none", 0.05, 0.01, "", "It places the robot to within 0.4 mm."),
    )  # fmt: skip


@pytest.fixture(scope="session")
def missing():
    """Missing physics, every part of it filled in."""
    experiment = _experiment()
    return ExplainedExperiment(
        "trial", "ab" * 32, experiment, _found(experiment), ("run09.csv: too short.",)
    )


@pytest.fixture(scope="session")
def wrong_values(missing):
    """A parameter that differs from nominal, and no stages tested."""
    kappa = missing.found.parameters["kappa1"]
    found = replace(
        missing.found,
        verdict="parameters",
        channel="none",
        stages=(),
        findings=(Finding("kappa1", 1.0, MappingProxyType({"kappa1": kappa}), 1.0),),
        ties=(),
        next_experiment=None,
        parameters={name: missing.found.parameters[name] for name in ("m1", "kappa1")},
        values={name: missing.found.values[name] for name in ("m1", "kappa1")},
    )
    return replace(missing, found=found, left_out=())


@pytest.fixture(scope="session")
def consistent(wrong_values):
    """Nothing wrong."""
    return replace(
        wrong_values, found=replace(wrong_values.found, verdict="consistent", findings=())
    )


@pytest.fixture(scope="session")
def unexplained(missing):
    """A force without a name, in recordings of which none is held out."""
    at = np.linspace(0.0, 0.2, 10)
    force = Residue("rolling_force", "speed", "m/s", at, -0.02 * np.exp(-at / 0.05),
                    np.full(10, 1e-3), 0.8, "It resists motion and falls with speed.")  # fmt: skip
    levels = {
        name: tuple(replace(one, held_out=False) for one in getattr(missing.found, name))
        for name in ("nominal", "refitted", "final")
    }
    left = Remainder("large", 7.9, 0.97, "a force along the wheels that depends on the speed")
    found = replace(
        missing.found,
        verdict="unexplained",
        findings=(),
        residue=(force,),
        remainder=left,
        **levels,
    )
    return replace(missing, found=found)


@pytest.fixture(scope="session")
def every(missing, wrong_values, consistent, unexplained):
    """One of each verdict, by verdict."""
    return {one.found.verdict: one for one in (missing, wrong_values, consistent, unexplained)}
