"""The application: its commands, and how errors become one sentence and an exit code.

Exit codes: 0 done, 1 findings of severity error, 2 wrong use or input. Heavy imports stay inside
the commands, so that ``foldmill --help`` is quick.
"""

from __future__ import annotations

import re
import sys
from typing import Annotated, Any

import typer

from foldmill.errors import FoldmillError
from foldmill_fabricate.cli import (
    catalogue,
    designing,
    exploring,
    exporting,
    importing,
    jobs,
    leading,
    making,
    moving,
    running,
    searching,
    serving,
    sheets,
    simulating,
    testing,
)
from foldmill_fabricate.garbage import look_rarely

app = typer.Typer(
    name="foldmill",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    help="From an origami design to a sheet that a cutting plotter scores on both faces. "
    "Lengths in mm, angles in degrees.",
)


def _tell_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        typer.echo(f"foldmill {version('foldmill')}")
        raise typer.Exit


@app.callback()
def _whole(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_tell_version, is_eager=True, help="Tell the version."),
    ] = False,
) -> None:
    pass


catalogue.add_to(app)
designing.add_to(app)
importing.add_to(app)
exporting.add_to(app)
moving.add_to(app)
exploring.add_to(app)
searching.add_to(app)
making.add_to(app)
testing.add_to(app)
running.add_to(app)
simulating.add_to(app)
leading.add_to(app)
sheets.add_to(app)
jobs.add_to(app)
serving.add_to(app)


def main() -> None:
    """Run the command line; expected failures end as one sentence on standard error."""
    look_rarely()
    try:
        code = app(prog_name="foldmill", standalone_mode=False)
    except FoldmillError as error:
        _stop(str(error))
    except BrokenPipeError:
        sys.stderr.close()  # the reader of our output has gone; that is no fault
    except OSError as error:
        _stop(_of_the_disk(error))
    except typer.Abort:
        typer.echo("\nAborted.", err=True)
        sys.exit(1)
    except Exception as error:
        if not hasattr(error, "format_message"):
            raise
        _refuse_use(error)
    else:
        sys.exit(code if isinstance(code, int) else 0)


def _refuse_use(error: Any) -> None:
    """Say what is wrong with the words of a command; alone, a command shows its help."""
    context = getattr(error, "ctx", None)
    said = error.format_message()
    if "\n" in said:
        error.show()
        sys.exit(2)
    command = context.command_path if context else "foldmill"
    said = _NUMBER.sub(r"write \1 in digits, without its unit", said.replace("Value error, ", ""))
    for theirs, ours in _BOUNDS.items():
        said = said.replace(theirs, ours)
    said = said if said.endswith(("?", ".")) else f"{said}."
    _stop(f"{said} `{command} --help` tells what there is.")


_NUMBER = re.compile(r"Input should be a valid (number|integer), unable to parse string as an? \w+")
"""What the reader of options says of what is no number."""
_BOUNDS = {
    "Input should be greater than or equal to": "it must be at least",
    "Input should be less than or equal to": "it must be at most",
    "Input should be": "it must be",
}
"""What it says of what is too small or too large, in our words."""
_REMEDIES: dict[type[OSError], str] = {
    FileNotFoundError: " Check its name, and in which folder you are.",
    FileExistsError: " A file stands where a folder is to be: name another.",
    IsADirectoryError: " Name a file in it.",
    NotADirectoryError: " A part of its name is a file.",
    PermissionError: " You may not read or write there: name another place.",
}


def _of_the_disk(error: OSError) -> str:
    """Return what a disk refused, where, and what to do."""
    place = f"{error.filename}: " if error.filename else ""
    return f"{place}{(error.strerror or str(error)).lower()}.{_REMEDIES.get(type(error), '')}"


def _stop(sentence: str) -> None:
    typer.echo(f"foldmill: {sentence}", err=True)
    sys.exit(2)
