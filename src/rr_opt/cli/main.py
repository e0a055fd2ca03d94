"""The command `rr-opt`: its verbs, and how each of them may end.

Whatever a user can put right ends as a message on stderr and an exit code, never as a
traceback. Heavy libraries are loaded by the verb that needs them, so that help comes at once.
"""

from __future__ import annotations

from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from rr_opt import __version__
from rr_opt.cli import interrupt
from rr_opt.cli.calibrate import calibrate
from rr_opt.cli.circle import circle
from rr_opt.cli.diagnose import diagnose
from rr_opt.cli.export import export
from rr_opt.cli.inspect import inspect
from rr_opt.cli.lint import lint
from rr_opt.cli.maximize_speed import maximize_speed
from rr_opt.cli.prove import prove
from rr_opt.cli.record import record
from rr_opt.cli.reproduce import reproduce
from rr_opt.cli.schema import schema
from rr_opt.cli.shapes import shapes
from rr_opt.cli.simulate import simulate
from rr_opt.cli.study import study
from rr_opt.cli.sweep import sweep
from rr_opt.cli.turn import turn
from rr_opt.cli.turn_chart import turn_chart
from rr_opt.outcome import EXIT_INTERRUPTED, EXIT_WRONG_INPUT, RollerRacerError


class Verbs(TyperGroup):
    """The group of verbs; turns the errors a user can act on into messages and exit codes."""

    def invoke(self, ctx: Any) -> Any:
        """Run a verb."""
        try:
            return super().invoke(ctx)
        except RollerRacerError as error:
            if interrupt.seen():
                return _interrupted()
            typer.echo(str(error), err=True)
            raise typer.Exit(error.exit_code) from None
        except KeyboardInterrupt:
            return _interrupted()
        except BrokenPipeError:
            raise
        except OSError as error:
            what = error.strerror or str(error)
            place = f"{error.filename}: " if error.filename else ""
            typer.echo(f"{place}{what}. Check the name, the folder and its permissions.", err=True)
            raise typer.Exit(EXIT_WRONG_INPUT) from None
        except Exception:
            # Ctrl-C comes out of CasADi, and of a library that is being loaded, as another error.
            if interrupt.seen():
                return _interrupted()
            raise


def _interrupted() -> Any:
    typer.echo(interrupt.MESSAGE, err=True)
    raise typer.Exit(EXIT_INTERRUPTED) from None


app = typer.Typer(
    name="rr-opt",
    cls=Verbs,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Find the best gait of a Roller Racer robot, and check it.",
    epilog="Exit codes: 0 done, 2 the input is wrong, 3 no feasible gait, "
    "4 the solver did not converge, 130 interrupted.",
)
app.command("maximize-speed")(maximize_speed)
app.command("shapes")(shapes)
app.command("sweep")(sweep)
app.command("turn")(turn)
app.command("turn-chart")(turn_chart)
app.command("circle")(circle)
app.command("simulate")(simulate)
app.command("export")(export)
app.command("study")(study)
app.command("reproduce")(reproduce)
app.command("calibrate")(calibrate)
app.command("inspect")(inspect)
app.command("record")(record)
app.command("diagnose")(diagnose)
app.command("prove")(prove)
app.command("lint")(lint)
app.command("schema")(schema)


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
