"""Cases of a trial written by hand: what was hidden, and what was said."""

from rr_lab.trial.outcome import Case, Claim, Named, Truth


def truth(kind, *hidden, remains=5.0, size=10.0, values=None, spread=0.0, engine="mujoco", **more):
    """What was hidden; every effect leaves `remains` sigma after the re-fit."""
    names = ("unknown",) if kind == "outside" else hidden
    values = values or {name: {} for name in names}
    effects = () if kind == "parameters" else hidden
    each = dict.fromkeys(effects, size)
    return Truth(
        kind, effects, values, each, dict.fromkeys(effects, remains), spread, engine, **more
    )


def said(verdict, *names, sure=1.0, groups=(), intervals=None, **more):
    """What was said; intervals by name."""
    named = tuple(Named(name, sure, (intervals or {}).get(name, {})) for name in names)
    return Claim(verdict, named, tuple(map(frozenset, groups)), **more)


def case(hidden, claim, id="001", **more):
    """One of the other."""
    return Case(id, hidden, claim, **more)


def single(name, claim, **more):
    """A case with one effect."""
    return case(truth("single", name, **more), claim)
