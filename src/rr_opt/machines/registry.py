"""The machines that an experiment file may name; the Roller Racer has an experiment of its own."""

from importlib import import_module

from rr_opt.messages import unknown_word
from rr_opt.model.machine import Machine
from rr_opt.outcome import InputError

RACER = "racer"
MACHINES = ("pendulum", "servo", "car")
"""Each a folder here, with the machine under its name in capitals."""


def machine_named(name: str) -> Machine:
    """The machine of a name. Raises InputError."""
    if name not in MACHINES:
        raise InputError(unknown_word(name, (RACER, *MACHINES), "machine"))
    return getattr(import_module(f"rr_opt.machines.{name}"), name.upper())
