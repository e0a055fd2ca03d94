"""How a piece of work can end: a status, a sentence, and an exit code."""

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
