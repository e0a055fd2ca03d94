"""A case as the files of its folder: experiment.yaml, the recordings, the servo's logs."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from rr_opt.experiment.recording import Recording
from rr_opt.lab.c3d import c3d_bytes
from rr_opt.lab.capture import captured
from rr_opt.lab.case import Case, Plan, motion_of
from rr_opt.lab.delivery import Delivery
from rr_opt.lab.effects import rig_with
from rr_opt.lab.experiment_text import experiment_text
from rr_opt.lab.markers import seen
from rr_opt.lab.servo_log import log_text
from rr_opt.lab.streams import stream
from rr_opt.lab.vicon_csv import vicon_text

PLAIN = Delivery()


def folder_of(
    case: Case, delivery: Delivery = PLAIN, progress: Callable[[str], None] = lambda _: None
) -> Iterator[tuple[str, bytes]]:
    """Names and contents of the files of a case, each made when it is asked for.

    `progress` is told of each recording before it is made. Raises InputError if a package that the
    form needs is missing.
    """
    for n, plan in enumerate(case.plans):
        progress(f"recording {n + 1} of {len(case.plans)}")
        yield delivery.file(plan), _recorded(case, plan, n, delivery)
        if delivery.servo_log:
            rig = rig_with(case.robot, case.effects)
            log = log_text(rig, plan.gait, plan.outing, delivery.clock)
            yield delivery.log(plan), log.encode()
    # Last, so that a folder with this file has all that it names.
    yield "experiment.yaml", experiment_text(case, delivery).encode()


def _recorded(case: Case, plan: Plan, n: int, delivery: Delivery) -> bytes:
    motion, rng = motion_of(case, plan, torque=delivery.torque), stream(case.seed, "noise", n)
    tracked = rig_with(case.robot, case.effects).tracked
    if delivery.form == "csv":
        recording = captured(
            motion,
            plan.name,
            case.noise,
            rng,
            tracked=tracked,
            missing=case.missing,
        )
        return csv_text(recording).encode()
    sigma = case.noise.position
    markers = seen(motion, case.nominal, sigma, rng, tracked=tracked, missing=case.missing)
    return vicon_text(markers).encode() if delivery.form == "vicon" else c3d_bytes(markers)


def csv_text(recording: Recording) -> str:
    """t and the channels, SI; a value that is missing is left empty."""
    lines = [",".join(("t", *recording.channels))]
    columns = [recording.data(channel) for channel in recording.channels]
    for t, *row in zip(recording.t, *columns, strict=True):
        values = ("" if np.isnan(value) else f"{value:.6f}" for value in row)
        lines.append(",".join((f"{t:.3f}", *values)))
    return "\n".join(lines) + "\n"
