"""Patterns for other people's origami programs: export."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from foldmill import FoldmillError
from foldmill_fabricate.cli.importing import load, with_file_options
from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import AsJson, say


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(export)


@with_file_options
def export(
    file: Annotated[
        Path | None, typer.Argument(help="A crease pattern; without one, the profiles are listed.")
    ] = None,
    profile: Annotated[
        str | None, typer.Option(help="The program it is for: a name of the list.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="The file to write; its suffix decides.")
    ] = None,
    lossy: Annotated[
        bool, typer.Option("--lossy", help="Write it even where the file cannot hold everything.")
    ] = False,
    options: Any = None,
    as_json: AsJson = False,
) -> None:
    """Write a pattern as a file that another origami program accepts."""
    from foldmill_fabricate import exporting
    from foldmill_fabricate.errors import CannotHold
    from foldmill_fabricate.files import write_whole

    if file is None:
        say(as_json, _rows(), table([("PROFILE", "FILES", ""), *map(tuple, _rows())]))
        return
    if profile is None or output is None:
        raise FoldmillError(
            "Name the program with --profile and the file with -o; `foldmill export` alone lists "
            "the programs and their files."
        )
    fold = load(file, options)
    try:
        made = exporting.export(fold, profile, output.suffix, lossy=lossy)
    except CannotHold as error:
        raise CannotHold(f"{error} --lossy writes {output.name} all the same.") from None
    write_whole(output, made.content)
    text = "\n".join([str(output), *(f"not in it: {said}" for said in made.lost)])
    say(as_json, {"file": str(output), "lost": list(made.lost)}, text)


def _rows() -> list[list[str]]:
    from foldmill_fabricate.exporting import PROGRAMS

    return [[each.slug, " ".join(each.files), each.title] for each in PROGRAMS.values()]
