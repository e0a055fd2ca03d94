"""The Roller Racer as a machine to diagnose; implements `sysid.machine.MachineModel`."""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from rr_opt.machines.racer import floor_map, grip
from rr_opt.machines.racer.actuation import actuation_sets
from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.next_experiment import next_experiment
from rr_opt.machines.racer.unknown_input import unknown_terms
from rr_opt.sysid.diagnosis import Misfit, NextExperiment
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import Term
from rr_opt.sysid.model import Choice, Linearisation, Segment

_FLOORS = (
    *("kappa1", "kappa2"),
    *(f"{dry}_friction.force{i}" for dry in ("coulomb", "stribeck") for i in (1, 2)),
)
"""What a floor patch multiplies."""


class RollerRacer(RacerModel):
    """A Roller Racer, and where to look for what its model lacks."""

    inputs: Mapping[str, str] = MappingProxyType(
        {
            "rolling": "a force along the wheels",
            "yaw": "a yaw moment",
            "constraint_axle1": "a sideways speed of axle 1",
            "constraint_axle2": "a sideways speed of axle 2",
            "actuation": "an error in the joint angle",
        }
    )

    def upstream(self) -> Sequence[tuple[tuple[Choice, ...], Mapping[str, float]]]:
        """Sets of effects of servo and clock that explain the recorded angle."""
        return actuation_sets(self, [k for k, run in enumerate(self.runs) if not run.held_out])

    def proposals(
        self, fit: Fit, complete: Sequence[str]
    ) -> Sequence[tuple[Choice, Mapping[str, float]]]:
        """Guesses of wheel slip and of floor patches."""
        out = []
        if "lateral_slip" in self.catalogue and "lateral_slip" not in complete:
            out += [(Choice("lateral_slip", k), guess) for k, guess in grip.slips(self, fit)]
        if "floor_patch" in self.catalogue and "floor_patch" not in complete:
            out += [(Choice("floor_patch", k), guess) for k, guess in floor_map.patches(self, fit)]
        return out

    def unknown_inputs(self, fit: Fit) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
        """Forces along the wheels, a moment, side speeds of the axles, errors of the angle."""
        return unknown_terms(self, fit)

    def equivalent(self, values: Mapping[str, float]) -> Mapping[str, float] | None:
        """The two halves of a floor exchanged: which is the usual one, and which the patch.

        Or not exchanged, with the edge's direction wrapped to half a turn either way. Of the edges
        of a strip, the one whose direction is at most a quarter turn.
        """
        if "floor_patch.normal" not in values:
            return None
        normal = math.remainder(values["floor_patch.normal"], math.tau)
        if "floor_patch.width" in values:
            return _first_edge(values, normal)
        factor, given = values["floor_patch.multiplier"], {**self.nominal, **values}
        own = [name for name in _FLOORS if given[name]]
        ratios = [given[name] / self.nominal[name] for name in own if self.nominal[name]]
        away = sum(map(math.log, ratios))
        # What is not fitted cannot become that of the other half.
        fixed = any(name not in values for name in own)
        if fixed or factor <= 0 or abs(away + len(ratios) * math.log(factor)) >= abs(away):
            plain = {**values, "floor_patch.normal": normal}
            return None if plain == values else plain
        turned = math.remainder(normal + math.pi, math.tau)
        other = {"floor_patch.multiplier": 1 / factor, "floor_patch.normal": turned}
        return {**values, **other, **{name: factor * values[name] for name in own}}

    def next_experiment(self, best: Fit, rival: tuple[str, Fit] | None) -> NextExperiment | None:
        """The most informative gait."""
        return next_experiment(self, best, rival)

    def worth(self, before: Sequence[Misfit], after: Sequence[Misfit]) -> str:
        """Errors of the simulated place."""
        return (
            f"the simulated position was {_off(before)} off (RMS beyond the noise) and is now "
            f"{_off(after)} off; "
        )

    def accuracy(self, misfits: Sequence[Misfit]) -> str:
        """The same, of the corrected simulation."""
        return f"The corrected position is {_off(misfits)} off (RMS beyond the noise)."


def _first_edge(values: Mapping[str, float], normal: float) -> Mapping[str, float] | None:
    across = values["floor_patch.width"] if abs(normal) > math.pi / 2 else 0.0
    moved = {
        "floor_patch.normal": math.remainder(normal + math.pi, math.tau) if across else normal,
        "floor_patch.edge_x": values["floor_patch.edge_x"] + across * math.cos(normal),
        "floor_patch.edge_y": values["floor_patch.edge_y"] + across * math.sin(normal),
    }
    return None if moved.items() <= values.items() else {**values, **moved}


def _off(misfits: Sequence[Misfit]) -> str:
    """RMS distance of the simulated from the recorded place, less the noise; of held-out
    recordings if there are any."""
    some = [one for one in misfits if one.held_out] or list(misfits)
    squares = []
    for one in some:
        off = np.sum((one.predicted[:, :2] - one.recorded[:, :2]) ** 2, axis=1)
        noise = np.broadcast_to(one.sigma, one.predicted.shape)[:, :2]
        squares.append(off - np.sum(noise**2, axis=1))
    distance = 1e3 * float(np.sqrt(max(np.nanmean(np.concatenate(squares)), 0.0)))
    return f"{distance:.1f} mm" if distance > 0.1 else "less than 0.1 mm"
