"""The motion of a Roller Racer as a system that is stepped."""

from __future__ import annotations

from functools import lru_cache

from rr_opt.diagnose.shoot import System
from rr_opt.physics.floor_motion import FloorMotion, floor_motion


@lru_cache
def driven(effects: tuple[str, ...]) -> tuple[System, FloorMotion]:
    """The motion with these effects, the same for every recording."""
    motion = floor_motion(effects)
    return System(motion.rates, motion.seen, stiff_states(motion), lasts=True), motion


def stiff_states(motion: FloorMotion) -> int:
    """How many states settle at once: the speeds of axles that slip."""
    return len(motion.free) if motion.slips else 0
