"""A real pendulum, diagnosed: `python -m benchmarks.real_pendulum FILE [PARTS]`.

The file is a CSV with time (s), position (rad) and torque (N m) of a pendulum that a motor drives.
It is cut into parts, each a run with an initial state of its own, of which the second is held out.
The nominal model has viscous friction only; every value is believed to within a factor of five.
"""

from __future__ import annotations

import itertools
import sys
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfiltfilt

from rr_opt.machines.pendulum.pendulum import Pendulum, Swing
from rr_opt.model.experiment import Uncertainty
from rr_opt.sysid.diagnose import diagnose
from rr_opt.sysid.diagnosis import Estimate

NOMINAL = {"J": 6.259e-2, "ml": 1.022e-1, "b": 4.707e-2}
"""kg m2, kg m, N m s: the values published with the torque-limited simple pendulum."""

FACTOR = 5.0
RIGID = 10.0
"""Hz: faster than this the arm does not move; faster is noise."""


def swings(path: Path, parts: int) -> list[Swing]:
    """The recording in parts."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    t, angle, torque = (table[name] for name in ("time", "position", "torque"))
    sections = butter(3, RIGID, fs=1 / float(np.median(np.diff(t))), output="sos")
    sigma = float(np.std(angle - sosfiltfilt(sections, angle)))
    edges = np.linspace(0, t.size, parts + 1).astype(int)
    return [
        Swing(f"part {k + 1}", t[a:b] - t[a], angle[a:b], torque[a:b], sigma, held_out=k == 1)
        for k, (a, b) in enumerate(itertools.pairwise(edges))
    ]


def _text(one: Estimate) -> str:
    return f"{one.value:.4g} [{one.low:.4g}, {one.high:.4g}] {one.unit}"


def main() -> None:
    """Diagnose it, and print what was found."""
    parts = int(sys.argv[2]) if sys.argv[2:] else 4
    known = dict.fromkeys(NOMINAL, Uncertainty(factor=FACTOR))
    found = diagnose(Pendulum(swings(Path(sys.argv[1]), parts), NOMINAL, known))
    print(f"{found.verdict}: {found.summary}")
    for finding in found.findings:
        for name, one in finding.parameters.items():
            print(f"  {finding.name} {name} {_text(one)}")
    for name, one in found.parameters.items():
        print(f"  {name} {_text(one)}")


if __name__ == "__main__":
    main()
