"""The diagnosis in a paragraph."""

from rr_opt.formatting import words_of
from rr_opt.sysid.diagnosis import Diagnosis


def summary_of(found: Diagnosis, worth: str = "", doubt: str = "") -> str:
    """What was found, how sure, what it is worth, what remains, what to record next.

    worth  what it is worth in the machine's own terms: `the place was 8 mm off and is 1 mm off; `
    doubt  why nothing is named, where something is left out
    """
    names = (words_of(one.name) for one in found.findings)
    listed = " and ".join(names)
    sure = ", ".join(f"{100 * one.confidence:.0f} %" for one in found.findings)
    opening = {
        "consistent": "The nominal model explains the recordings.",
        "parameters": f"The model is right, but the value of {listed} is not.",
        "missing_physics": f"The model leaves out {listed} (confidence {sure}).",
        "unexplained": "Something is left out, and no effect of the catalogue is shown to be it.",
    }[found.verdict]
    held = any(one.held_out for one in found.final)
    which = "recordings that were not fitted" if held else "the recordings, which were all fitted"
    before, after = (f"{one:.2f}" for one in (found.before, found.after))
    moved = "rose" if found.after > found.before else "fell"
    change = f"stayed at {after}" if before == after else f"{moved} from {before} to {after}"
    misfit = f"On {which}, {worth}the misfit {change} sigma, where 1 is the noise."
    remainder, remains = found.remainder, ""
    if found.verdict != "consistent" and remainder.size != "none":
        depends = f": {remainder.depends_on}" if remainder.depends_on else ""
        share = f"{100 * remainder.share:.0f} % of the misfit"
        remains = f"What remains is {remainder.size} ({share}){depends}."
    doubtful = found.verdict != "consistent" and (remains or found.indistinguishable)
    plan = found.next_experiment.sentence if found.next_experiment and doubtful else ""
    why = doubt if found.verdict == "unexplained" else ""
    return " ".join(part for part in (opening, why, misfit, remains, plan) if part)
