"""Titles, alternative texts and captions of figures, from `rr_paper/data`."""

from rr_opt.documents.document import Captions
from rr_paper.publication import read_data


def captions(of: str) -> Captions:
    """Those of the calibration or of the reproduction, by the figure's name."""
    return {
        name: (one["title"], one["alt"], one["caption"])
        for name, one in read_data(f"{of}_figures.toml").items()
    }
