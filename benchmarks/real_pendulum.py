"""A real pendulum, diagnosed: `python -m benchmarks.real_pendulum PATH/TO/data_measured.csv`.

The recording is that of the DFKI RIC Underactuated Robotics Lab's torque-limited simple pendulum
(system identification under PD control: time, position, velocity, torque). Begun with viscous
friction only. Writes results/pendulum: README.md, diagnosis.json, pendulum.svg.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.linalg import block_diag
from scipy.signal import butter, sosfiltfilt

from benchmarks.pendulum_page import Cut, Told, drawn, page, record, rms_of
from rr_opt.machines.pendulum.pendulum import Pendulum, Swing
from rr_opt.model.experiment import Uncertainty
from rr_opt.outcome import InputError
from rr_opt.report.archive import write_json, write_text
from rr_opt.sysid.candidate import whole
from rr_opt.sysid.diagnose import diagnose
from rr_opt.sysid.diagnosis import Misfit
from rr_opt.sysid.least_squares import Fit, Problem, solve
from rr_opt.sysid.model import Piece
from rr_opt.sysid.values import estimates

PUBLISHED = {"J": 6.259e-2, "ml": 1.022e-1, "b": 4.707e-2}
"""kg m2, kg m, N m s: what came with the recording, from derivatives of it and least squares."""

ATAN = 1.839e-1
"""N m: published as Coulomb friction, but as the factor of atan(100 w), which tends to pi/2."""

EXTRA = {"coulomb_friction.torque": ATAN * math.pi / 2, "torque_offset.torque": 7.586e-2}
"""N m. The offset was published as what the reading has too little of, with a minus."""

PARTS_LIST = {"J": 0.139625, "ml": 0.6755 * 0.5}
"""kg m2, kg m: the inertia, and mass times length, in the parameter files of the same pendulum."""

FACTOR = 5.0
"""Each published value is believed to within this factor."""

CUTS: Mapping[int, tuple[int, ...]] = {4: (2,), 1: (), 2: (), 6: (2, 4)}
"""Parts of the recording: which are held out. The first is shown, the others are to agree."""

RIGID = 10.0
"""Hz: faster than this the arm does not move; faster is vibration."""

CUTOFFS = (3.0, 5.0, 8.0, 12.0)
"""Hz, of the low pass in a linear regression."""

OUT = Path("results/pendulum")
NAMES = ("time", "position", "velocity", "torque")


def read(path: Path) -> Mapping[str, np.ndarray]:
    if not path.is_file():
        raise InputError(
            f"{str(path)!r} is no file. Expected a CSV with {', '.join(NAMES)}. Give its path."
        )
    table = np.genfromtxt(path, delimiter=",", names=True)
    if table.dtype.names != NAMES:
        raise InputError(
            f"{path} has the columns {table.dtype.names}. Expected {NAMES}. Give that recording."
        )
    return {name: table[name] for name in NAMES}


def slow(data: Mapping[str, np.ndarray], name: str, cutoff: float) -> np.ndarray:
    """What of a column is slower than `cutoff`, Hz, without a delay."""
    rate = 1 / float(np.median(np.diff(data["time"])))
    sections = butter(3, cutoff, fs=rate, output="sos")
    return np.asarray(sosfiltfilt(sections, data[name]))


def shaking(data: Mapping[str, np.ndarray]) -> float:
    """RMS of the angle faster than RIGID, rad: encoder steps, and what shakes."""
    return float(np.std(data["position"] - slow(data, "position", RIGID)))


def cut(
    data: Mapping[str, np.ndarray], sigma: float, parts: int, out: Sequence[int]
) -> tuple[Pendulum, np.ndarray]:
    """The recording in parts as runs, and when they begin, s."""
    edges = np.linspace(0, data["time"].size, parts + 1).astype(int)
    begins = data["time"][edges[:-1]]
    swings = [
        Swing(
            f"part {k + 1}",
            data["time"][a:b] - data["time"][a],
            data["position"][a:b],
            data["torque"][a:b],
            sigma,
            k in out,
        )
        for k, (a, b) in enumerate(itertools.pairwise(edges))
    ]
    believed = dict.fromkeys(PUBLISHED, Uncertainty(factor=FACTOR))
    return Pendulum(swings, PUBLISHED, believed), begins


def as_published(model: Pendulum) -> list[Misfit]:
    """The published model with the published values, each part starting where it fits best."""
    names = tuple(name.split(".")[0] for name in EXTRA)
    values, out = PUBLISHED | EXTRA, []
    for piece in whole(model, range(len(model.runs))):
        problem = Problem(model, [piece], names, (), values)
        guess = model.start(piece)
        fits = [
            solve(problem, {}, {piece: guess + np.array([0.0, faster])}, steps=30)
            for faster in (-4.0, -2.0, 0.0, 2.0, 4.0)
        ]
        start = min(fits, key=lambda fit: fit.cost).starts[piece]
        data, predicted = (
            model.runs[piece.run],
            model.respond(piece, values, names, start).predicted,
        )
        r = (predicted - data.values) / data.sigma
        rms = float(np.sqrt(np.nanmean(r**2)))
        out.append(Misfit(data.name, data.held_out, rms, {"angle": rms}, data.t, predicted, r))
    return out


def with_published_terms(model: Pendulum, values: Mapping[str, float]) -> Fit:
    """All published terms fitted by simulation error, needed or not; `values` to begin with."""
    names = tuple(name.split(".")[0] for name in EXTRA)
    forms = [model.catalogue[name].forms[0] for name in names]
    quantities = (*model.parameters, *(q for form in forms for q in form.quantities))
    pieces = whole(model, [k for k, run in enumerate(model.runs) if not run.held_out])
    starts = {piece: model.start(piece) for piece in pieces}
    begins = [PUBLISHED | EXTRA, dict(values) | dict.fromkeys(EXTRA, 0.0)]
    fits = []
    for begin in begins:
        near = solve(Problem(model, pieces, names, (), begin), {}, starts)
        problem = Problem(model, pieces, names, quantities)
        fits.append(solve(problem, begin, near.starts, steps=40))
    return min(fits, key=lambda fit: fit.cost)


def torque_error(model: Pendulum, values: Mapping[str, float], misfit: float) -> float:
    """The white error of the torque's samples, N m RMS, that would leave so much misfit, rad RMS.

    What a little of it changes is predicted 20 times over; what the parts' starts and the
    parameters would take up of the change is taken out of it.
    """
    rng, small, names = np.random.default_rng(0), 1e-3, tuple(PUBLISHED)
    by_value, by_start, changes = [], [], []
    for piece in whole(model, range(len(model.runs))):
        alone = Problem(model, [piece], (), (), dict(values))
        start = solve(alone, {}, {piece: model.start(piece)}).starts[piece]
        out = model.respond(piece, values, (), start, names)
        of_values, of_start = out.slopes
        by_value.append(of_values[:, 0])
        by_start.append(of_start[:, 0])
        swing, part = model.swings[piece.run], Piece(0, piece.first, piece.last)
        noisy = []
        for _ in range(20):
            torque = swing.torque + small * rng.standard_normal(swing.t.size)
            other = Pendulum([replace(swing, torque=torque)], PUBLISHED, {})
            noisy.append((other.respond(part, values, (), start).predicted - out.predicted)[:, 0])
        changes.append(np.array(noisy).T)
    basis, _ = np.linalg.qr(np.hstack([np.vstack(by_value), np.asarray(block_diag(*by_start))]))
    change = np.vstack(changes)
    left = change - basis @ (basis.T @ change)
    return small * misfit / float(np.sqrt(np.mean(left**2)))


def regressed(data: Mapping[str, np.ndarray], cutoff: float) -> float:
    """The inertia by linear least squares on derivatives, low-passed at `cutoff` Hz, kg m2."""
    t, angle = data["time"], slow(data, "position", cutoff)
    w = np.asarray(np.gradient(angle, t))
    terms = np.ones((t.size, 5))
    terms[:, 0], terms[:, 1] = np.asarray(np.gradient(w, t)), np.sin(angle)
    terms[:, 2], terms[:, 3] = w, np.arctan(100 * w)
    found = np.linalg.lstsq(terms, slow(data, "torque", cutoff))
    return float(found[0][0])


def main() -> int:
    try:
        path = Path(sys.argv[1] if len(sys.argv) > 1 else "")
        data = read(path)
    except InputError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    sigma = shaking(data)
    cuts = []
    for parts, out in CUTS.items():
        print(f"diagnosing it in {parts} part{'s' * (parts > 1)}", file=sys.stderr)
        model, _ = cut(data, sigma, parts, out)
        found = diagnose(model)
        terms = estimates(model, with_published_terms(model, found.values))
        cuts.append(Cut(parts, tuple(k + 1 for k in out), found, terms))
    first, found = next(iter(CUTS)), cuts[0].found
    model, begins = cut(data, sigma, first, CUTS[first])
    told = Told(
        digest=hashlib.sha256(path.read_bytes()).hexdigest(),
        sigma=sigma,
        rigid=RIGID,
        factor=FACTOR,
        values=PUBLISHED | EXTRA,
        elsewhere=PARTS_LIST,
        atan=ATAN,
        published=as_published(model),
        torque_error=torque_error(model, found.values, sigma * rms_of(found.final)),
        regressed={cutoff: regressed(data, cutoff) for cutoff in CUTOFFS},
        cuts=cuts,
    )
    write_text(OUT / "pendulum.svg", drawn(model.runs, begins, told))
    write_json(OUT / "diagnosis.json", record(told))
    write_text(OUT / "README.md", page(told))
    print(found.summary)
    return 0


if __name__ == "__main__":
    sys.exit(main())
