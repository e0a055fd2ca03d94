"""The command `rr-opt`: its verbs, and how each of them may end.

Errors that a user can correct end as a message on stderr and an exit code, never as a traceback.
Heavy libraries are imported by the verb that needs them, so that help is fast. Other packages
add verbs by the entry points `rr_opt.verbs`.
"""

from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command_from_info
from typer.models import CommandInfo

from rr_opt import interrupt
from rr_opt.cli import verbs
from rr_opt.cli.steps import silence
from rr_opt.outcome import EXIT_INTERRUPTED, EXIT_WRONG_INPUT, RollerRacerError
from rr_opt.version import __version__

VERBS = (
    *("maximize-speed", "shapes", "sweep", "turn", "turn-chart", "route", "circle", "simulate"),
    *("export", "study", "inspect", "diagnose", "init", "lint", "schema"),
)
"""In the order of the help; each is a function of that name in `verbs`."""
_SHORT_HELP = {"help_option_names": ["-h", "--help"]}


class Verbs(TyperGroup):
    """The group of verbs; turns the errors a user can act on into messages and exit codes."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002
        """Every verb, those of other packages last."""
        return [*VERBS, *sorted(_others())]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002
        """A verb, imported now; None if there is none of that name."""
        if cmd_name in VERBS:
            verb = getattr(verbs, cmd_name.replace("-", "_"))
        else:
            other = _others().get(cmd_name)
            if other is None:
                return None
            verb = other.load()
        made = _command(cmd_name, verb)
        made.params += [one for one in _command("quiet", _quiet).params if one.name == "quiet"]
        return made

    def invoke(self, ctx: Any) -> Any:
        """Run a verb."""
        try:
            return super().invoke(ctx)
        except RollerRacerError as error:
            if interrupt.seen():
                return _interrupted()
            typer.echo(str(error), err=True)
            raise typer.Exit(error.exit_code) from None
        except typer.BadParameter as error:
            error.message = error.message.removeprefix("Value error, ")
            raise
        except KeyboardInterrupt as error:
            if str(error):
                typer.echo(str(error), err=True)
            return _interrupted()
        except BrokenPipeError:
            raise
        except OSError as error:
            what = error.strerror or str(error)
            place = f"{error.filename}: " if error.filename else ""
            typer.echo(f"{place}{what}. Check the name, the folder and its permissions.", err=True)
            raise typer.Exit(EXIT_WRONG_INPUT) from None
        except Exception:
            # Ctrl-C emerges from CasADi, and from a library during import, as another error.
            if interrupt.seen():
                return _interrupted()
            raise


def _quiet(
    quiet: Annotated[
        bool,
        typer.Option(
            *("--quiet", "-q"),
            callback=silence,
            expose_value=False,
            help="No progress and no warnings on stderr.",
        ),
    ] = False,
) -> None:
    """A verb with nothing but the option that every verb has."""


def _command(name: str, function: Any) -> Any:
    info = CommandInfo(name=name, callback=function, cls=TyperCommand, context_settings=_SHORT_HELP)
    return get_command_from_info(info, pretty_exceptions_short=False, rich_markup_mode=None)


def _others() -> dict[str, Any]:
    """The verbs of other packages."""
    from importlib.metadata import entry_points

    return {found.name: found for found in entry_points(group="rr_opt.verbs")}


_LEAVING = 1.0
"""s to wait for interrupted compilers, which then leave nothing behind in the cache."""


def _interrupted() -> Any:
    from rr_opt.threads import finish

    finish(_LEAVING)
    typer.echo(interrupt.MESSAGE, err=True)
    raise typer.Exit(EXIT_INTERRUPTED) from None


app = typer.Typer(
    name="rr-opt",
    cls=Verbs,
    no_args_is_help=True,
    context_settings=_SHORT_HELP,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Find the best gait of a Roller Racer robot, and check it.",
    epilog="Exit codes: 0 done, 2 the input is wrong, 3 no feasible gait, "
    "4 the solver did not converge, 130 interrupted.",
)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"rr-opt {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    pass
