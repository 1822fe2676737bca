"""Whoever takes a FILE takes anybody's: the options of reading it, and conversion to .fold."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import fields
from enum import StrEnum
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill import FoldmillError, UnreadableFile
from foldmill_fabricate.cli.figures import summary
from foldmill_fabricate.cli.output import AsJson, exit_code, figure_lines, finding_data, say

if TYPE_CHECKING:
    from foldmill import Fold
    from foldmill.exchange.options import Options
    from foldmill_fabricate.importing import Imported

PatternFile = Annotated[
    Path, typer.Argument(help="A crease pattern: FILE.fold .svg .dxf .cp or .opx.")
]


class UnitChoice(StrEnum):
    """What a unit of a file can be."""

    MM = "mm"
    CM = "cm"
    M = "m"
    UM = "um"
    NM = "nm"
    IN = "in"
    PT = "pt"
    PX = "px"


class SideChoice(StrEnum):
    """Which face a file shows."""

    FRONT = "front"
    BACK = "back"


class ByChoice(StrEnum):
    """What says what lines are."""

    AUTO = "auto"
    LAYER = "layer"
    COLOUR = "colour"


class LooseChoice(StrEnum):
    """What becomes of lines that end inside the sheet."""

    REFUSE = "refuse"
    DROP = "drop"


class AnglesChoice(StrEnum):
    """What fold angles of a file are in."""

    DEGREES = "degrees"
    RADIANS = "radians"


_OPTIONS: dict[str, Any] = {
    "width": (
        float | None,
        "How wide the pattern is, mm; scales it, whatever the file says.",
        None,
    ),
    "unit": (UnitChoice | None, "What a unit of the file is, whatever it says.", None),
    "scale": (float | None, "Times what the file says; mm per unit where it says nothing.", None),
    "side": (SideChoice, "Which face of the sheet the file shows.", SideChoice.FRONT),
    "mirror": (bool, "The file shows a mirror image.", False),
    "frame": (int | None, "FOLD: the number of the frame that is the pattern.", None),
    "by": (ByChoice, "What says what lines are; auto: layers, else colours.", ByChoice.AUTO),
    "named": (
        list[str] | None,
        "COLOUR=LETTER or LAYER=LETTER: B M V F U C, or skip; `other` is all else. Repeatable.",
        None,
    ),
    "gap": (float | None, "How far apart ends of lines may be that meet, mm.", None),
    "loose": (LooseChoice, "What becomes of lines that end inside the sheet.", LooseChoice.REFUSE),
    "planarise": (
        bool,
        "FOLD: mend lines that cross or lie upon each other, and say how; others always are.",
        False,
    ),
    "angles": (AnglesChoice | None, "FOLD: what its fold angles are in; else degrees.", None),
}
_SPELT = {"named": "--as"}


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.command("import")(convert)


def with_file_options(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of reading a file; it takes them as one, named ``options``."""

    @wraps(command)
    def taking(**said: Any) -> None:
        own = {name: said.pop(name) for name in _OPTIONS}
        command(**said, options=options_of(own))

    given = inspect.signature(command, eval_str=True).parameters.values()
    kept = [each for each in given if each.name != "options"]
    added = [_parameter(name) for name in _OPTIONS]
    last = [each for each in kept if each.name == "as_json"]
    order = [*(each for each in kept if each.name != "as_json"), *added, *last]
    whole = [each.replace(kind=inspect.Parameter.KEYWORD_ONLY) for each in order]
    taking.__signature__ = inspect.Signature(whole)  # type: ignore[attr-defined]
    taking.__annotations__ = {each.name: each.annotation for each in whole}
    return taking


def _parameter(name: str) -> inspect.Parameter:
    kind, about, default = _OPTIONS[name]
    option = typer.Option(_SPELT.get(name, f"--{name}"), help=about)
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, option]
    )


def options_of(said: dict[str, Any]) -> Options:
    """Return the options of reading a file, from what the command line says."""
    from foldmill.exchange.options import Options, named

    plain: dict[str, Any] = {k: str(v) if isinstance(v, StrEnum) else v for k, v in said.items()}
    return Options(**{**plain, "named": named(plain["named"] or [])})


def load(file: Path, options: Options | None = None) -> Fold:
    """Read anybody's crease pattern; raises UnreadableFile, which names the option that helps."""
    return imported(file, options).fold


def imported(file: Path, options: Options | None = None) -> Imported:
    """Read anybody's crease pattern, and what is still to be asked of it."""
    from foldmill.exchange.options import Options
    from foldmill_fabricate.importing import read_pattern

    said = options or Options()
    try:
        return read_pattern(file, said)
    except UnreadableFile as error:
        if said.planarise or file.suffix.lower() != ".fold" or not _is_mended(file, said):
            raise
        raise UnreadableFile(f"{error} Or let --planarise mend its lines.") from None


def _is_mended(file: Path, options: Options) -> bool:
    """Tell whether a file that cannot be read can be once its lines are mended."""
    from dataclasses import replace

    from foldmill_fabricate.importing import read_pattern

    try:
        found = read_pattern(file, replace(options, planarise=True)).fold.findings
    except UnreadableFile:
        return False
    return any(finding.code.startswith("mended-") for finding in found)


@with_file_options
def convert(
    file: PatternFile,
    output: Annotated[Path, typer.Option("-o", "--output", help="FILE.fold")],
    options: Any = None,
    as_json: AsJson = False,
) -> None:
    """Convert anybody's crease pattern to a .fold file, and say what was changed on the way."""
    from foldmill.exchange import write
    from foldmill_fabricate.cli.output import finding_lines
    from foldmill_fabricate.files import write_whole

    if output.suffix.lower() != ".fold":
        raise FoldmillError(f"{output}: a pattern is converted to .fold.")
    found = imported(file, options)
    write_whole(output, write(found.fold).encode())
    facts = {"format": found.format, **summary(found.fold)}
    data = {
        **facts,
        "findings": finding_data(found.fold.findings),
        "questions": [{f.name: getattr(q, f.name) for f in fields(q)} for q in found.questions],
    }
    say(
        as_json, data, "\n".join([figure_lines(facts), finding_lines(found.fold.findings)]).rstrip()
    )
    exit_code(found.fold.findings)
