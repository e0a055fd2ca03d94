"""All figures of one recording."""

from __future__ import annotations

import numpy as np

from rr_opt.recordings.inspection import Inspection
from rr_opt.report.figures.inspect.channels import channels
from rr_opt.report.figures.inspect.command import difference, folded
from rr_opt.report.figures.inspect.noise import noise
from rr_opt.report.figures.inspect.path import path
from rr_opt.report.figures.inspect.residual import by_marker, over_time
from rr_opt.report.figures.inspect.thinned import small
from rr_opt.report.figures.style import figure, styled, svg


def draw(found: Inspection) -> dict[str, str]:
    """SVG texts by name: `path`, `channels`, `noise`, and `command` and `rigid` where they are."""
    drawn: dict[str, str] = {}
    recording = found.recording
    with styled():
        one = figure(6.6, 4.8)
        path(one.subplots(), recording)
        drawn["path"] = svg(one)
        one = figure(7.6, 1.55 * len(recording.channels) + 0.5)
        axes = one.subplots(len(recording.channels), 1, sharex=True)
        channels(list(np.atleast_1d(axes)), recording, found.cleaned.gaps)
        one.align_ylabels()
        drawn["channels"] = svg(one)
        one = figure(6.6, 3.4)
        stated = {name: float(np.median(recording.sigma[name])) for name in recording.channels}
        noise(one.subplots(), found.cleaned.noise, stated)
        drawn["noise"] = svg(one)
        if found.gait is not None:
            one = figure(7.6, 5.2)
            above, below = one.subplots(2, 1, height_ratios=[1.4, 1])
            folded(above, recording.t, recording.data("phi"), found.gait, found.command)
            difference(below, recording.t, recording.data("phi"), found.gait)
            drawn["command"] = svg(one)
        if found.markers is not None:
            one = figure(7.6, 4.8)
            above, below = one.subplots(2, 1)
            over_time(above, found.markers)
            by_marker(below, found.markers)
            drawn["rigid"] = svg(one)
    return {name: small(text) for name, text in drawn.items()}
