"""Solve on a mesh that is good enough: as fine as the gait needs, with limits held where it meets
them."""

from __future__ import annotations

from dataclasses import replace

from rr_opt.design.dense import Dense, dense
from rr_opt.design.mesh import LADDER, Mesh, at_least, intervals_for, regular
from rr_opt.design.setting import Setting, robot_of
from rr_opt.design.solve import Candidate, solve
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError
from rr_opt.robot.gait import Gait

_TRIAL = 36
"""Intervals on which a gait's own error is tried, to choose its mesh."""
_CLAIM = 3e-7
"""Largest error of a claimed speed, relative."""
_PEAK = 1e-6
"""Largest excess over a limit between nodes, relative."""
_SHAPED_PEAK = 3e-5
"""The same where the solver moves peaks aside."""
_PATIENCE = 5
"""Refinements after which the intervals are halved and, after as many more, a margin is kept from
the torque's limit."""
_PER_HARMONIC = 12
"""Intervals of a period of the fastest harmonic, at least."""
_REFINEMENTS = 14
_SUBSTEPS, _FINEST = 4, 192
"""Of a free gait's interval, and intervals of a Fourier gait, at most."""


def solve_from(setting: Setting, sign: int, gait: Gait, share: float) -> Candidate:
    """Solve from a gait on a mesh that is fine enough for its cycle."""
    wanted = setting.problem.gait
    if wanted.shape == "free":
        return solve(setting, sign, gait, share, regular(wanted.intervals))
    seen = dense(setting, gait, share)
    try:
        coarse = steady_cycle(robot_of(setting, share), gait, steps=_TRIAL).speed
        error = abs(coarse - seen.speed) / abs(seen.speed)
        intervals = intervals_for(_TRIAL, error, _CLAIM / 2)
    except NotConvergedError:  # dry friction too steep for so coarse a mesh
        intervals = LADDER[-1]
    if wanted.shape == "sine":
        return solve(setting, sign, gait, share, regular(intervals).with_nodes_at(seen.peaks))
    # Until an optimum is chosen, limits broken between nodes are no matter.
    intervals = max(intervals, at_least(_PER_HARMONIC * wanted.harmonics))
    return solve(setting, sign, gait, share, regular(intervals))


def refine(setting: Setting, candidate: Candidate) -> Candidate:
    """Solve again until the mesh claims the true speed and no limit is broken between nodes."""
    iterations = candidate.iterations
    peak = _PEAK if setting.problem.gait.shape == "sine" else _SHAPED_PEAK
    for number in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting, gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        finer = _finer(setting, candidate.mesh, error)
        if seen.used <= 1 + peak and (finer is None or error <= _CLAIM):
            # With no finer mesh left, the gait is as good as found; its speed is what was seen.
            speed = candidate.speed if error <= _CLAIM else seen.speed
            candidate = replace(candidate, speed=speed)
            break
        mesh = finer or candidate.mesh
        if number == _PATIENCE and setting.problem.gait.shape == "fourier":
            mesh = replace(regular(at_least(2 * mesh.intervals)), checks=mesh.checks)
        mesh = _held(setting, mesh, seen)
        if number >= 2 * _PATIENCE and seen.used > 1 + peak:
            mesh = replace(mesh, margin=max(mesh.margin, 1 - (1 - mesh.margin) / seen.used))
        candidate = solve(setting, candidate.sign, gait, share, mesh)
        iterations += candidate.iterations
        if not (candidate.feasible and candidate.success):
            break
    return replace(candidate, iterations=iterations)


def _held(setting: Setting, mesh: Mesh, seen: Dense) -> Mesh:
    """The mesh with limits held where they were met."""
    if setting.problem.gait.shape == "sine":
        return mesh.with_nodes_at(seen.peaks)
    return mesh.with_torque_at(seen.peaks).with_checks_at(seen.checks)


def _finer(setting: Setting, mesh: Mesh, error: float) -> Mesh | None:
    """The mesh with which to go on; None if no finer one is left.

    The intervals of a free gait are the user's, as its accelerations are defined on them.
    """
    if error <= _CLAIM:
        return mesh
    if setting.problem.gait.shape == "free":
        return replace(mesh, substeps=2 * mesh.substeps) if mesh.substeps < _SUBSTEPS else None
    if mesh.intervals >= (LADDER[-1] if setting.problem.gait.shape == "sine" else _FINEST):
        return None
    finer = regular(intervals_for(mesh.intervals, error, _CLAIM / 4))
    return replace(finer, checks=mesh.checks, margin=mesh.margin)
