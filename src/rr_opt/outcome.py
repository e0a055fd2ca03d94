"""How a piece of work can end: a status, a sentence, and an exit code."""

from collections.abc import Mapping
from enum import StrEnum


class Status(StrEnum):
    """How a solve ended, and what the command that ran it returns to the shell."""

    OPTIMAL = "optimal"
    INFEASIBLE = "infeasible"
    NOT_CONVERGED = "not_converged"

    @property
    def words(self) -> str:
        """`not converged`."""
        return self.value.replace("_", " ")

    @classmethod
    def of_cases(cls, counts: Mapping["Status", int]) -> "Status":
        """Of many cases: OPTIMAL if any is, else NOT_CONVERGED if any is, else INFEASIBLE."""
        order = (cls.OPTIMAL, cls.NOT_CONVERGED)
        return next((one for one in order if counts[one]), cls.INFEASIBLE)

    @property
    def exit_code(self) -> int:
        """What the shell gets."""
        return {"optimal": 0, "infeasible": 3, "not_converged": 4}[self.value]


EXIT_WRONG_INPUT = 2
EXIT_INTERRUPTED = 130


class RollerRacerError(Exception):
    """Base of the errors a user can act on; the text says what, where and what to do."""

    exit_code = EXIT_WRONG_INPUT


class InputError(RollerRacerError):
    """A file or a value given by the user is wrong."""

    exit_code = EXIT_WRONG_INPUT


class NotConvergedError(RollerRacerError):
    """A numerical method stopped before it had an answer."""

    exit_code = Status.NOT_CONVERGED.exit_code
