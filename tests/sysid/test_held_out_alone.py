"""What shows in a held-out recording alone is not looked for, and the answer says so."""

from dataclasses import replace

from rr_opt.machines.racer.diagnose import diagnose_racer
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.model import Piece
from tests.sysid.made_up import experiment, recorded

STICKS = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}


def test_the_recording_is_named():
    given = experiment()
    first, *rest = given.runs
    given = replace(given, runs=(replace(first, use="holdout"), *rest))
    empty = RollerRacer(given)

    def predict(k, start):
        piece = Piece(k, 0, len(given.runs[k].recording.t))
        hidden = ("coulomb_friction",) if k == 0 else ()
        return empty.respond(piece, STICKS, hidden, start).predicted

    found = diagnose_racer(recorded(given, predict, seed=3))
    assert found.verdict == "unexplained"
    assert "held-out recordings alone: run0." in found.summary
