"""From parameters to a fold, and looking at it: design, show, check."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill import FoldmillError
from foldmill.finding import has_errors
from foldmill_fabricate.cli.figures import summary
from foldmill_fabricate.cli.importing import PatternFile, load, with_file_options
from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import (
    AsJson,
    exit_code,
    figure_lines,
    finding_data,
    finding_lines,
    report_text,
    say,
)

if TYPE_CHECKING:
    from foldmill import Design, Fold


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.command(
        context_settings={
            "allow_extra_args": True,
            "ignore_unknown_options": True,
            "help_option_names": [],
        }
    )(design)
    app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})(report)
    app.command()(show)
    app.command()(check)


def design(
    context: typer.Context,
    family: Annotated[str | None, typer.Argument(help="A slug of `foldmill families`.")] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="FILE.fold .svg .png .glb .stl or .obj; by suffix."),
    ] = None,
    preset: Annotated[str | None, typer.Option(help="Start from a preset.")] = None,
    params: Annotated[Path | None, typer.Option(help="Parameters from a TOML file.")] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Write it even where it does not fold; it is marked.")
    ] = False,
    help_wanted: Annotated[
        bool, typer.Option("--help", help="Show a family's parameters.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Make a fold: foldmill design FAMILY [--preset P] [--PARAM V]… -o FILE.

    Parameters go by their dotted names, such as --points.3.a 172.5; foldmill design FAMILY --help
    lists them with units. --insert points.3 makes room for another point 3, --drop points.3 leaves
    one out; later points get new numbers.
    """
    from foldmill import installed
    from foldmill.check import check as check_fold
    from foldmill.exchange.marking import marked
    from foldmill_fabricate.cli.parameters import gather

    if family is None:
        typer.echo(context.get_help())
        raise typer.Exit(0 if help_wanted else 2)
    offered = installed().design(family)
    if help_wanted:
        typer.echo(_describe(offered, preset))
        return
    fold = offered.run(gather(offered, preset, params, context.args))
    found = check_fold(fold).findings
    if output is not None and (force or not has_errors(found)):
        save(marked(fold, found), output)
    data = {**summary(fold), "findings": finding_data(found)}
    say(as_json, data, "\n".join([figure_lines(summary(fold)), finding_lines(found)]).rstrip())
    if output is None:
        typer.echo(f"Nothing is written; -o {family}.fold writes it.", err=True)
    elif has_errors(found) and not force:
        typer.echo("It does not fold, so nothing is written; --force writes it, marked.", err=True)
    exit_code(found)


def report(
    context: typer.Context,
    family: Annotated[str, typer.Argument(help="A slug of `foldmill families`.")],
    name: Annotated[str, typer.Argument(help="Which report; a wrong one tells those there are.")],
    preset: Annotated[str | None, typer.Option(help="Start from a preset.")] = None,
    params: Annotated[Path | None, typer.Option(help="Parameters from a TOML file.")] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Its columns: FILE.csv, or drawn as .png or .svg."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Make one of a family's longer analyses: foldmill report FAMILY NAME [--PARAM V]…"""
    from foldmill import installed
    from foldmill_fabricate.cli.parameters import gather

    if output is not None and output.suffix not in {".csv", ".png", ".svg"}:
        raise FoldmillError(f"{output}: the columns of a report are written as .csv .png or .svg.")
    offered = installed().design(family)
    figures = offered.report(name, gather(offered, preset, params, context.args))
    if output is not None:
        _save_columns(f"{offered.title}: {name}", figures, output)
    say(as_json, dict(figures), report_text(figures))


def _save_columns(title: str, figures: Mapping[str, object], file: Path) -> None:
    from foldmill_fabricate.files import write_whole
    from foldmill_fabricate.pictures.columns import columns_csv, columns_of, columns_picture

    columns = columns_of(figures)
    is_table = file.suffix == ".csv"
    made = columns_csv(columns) if is_table else columns_picture(title, columns, file.suffix)
    write_whole(file, made)


@with_file_options
def show(
    file: PatternFile,
    output: Annotated[Path, typer.Option("-o", "--output", help="FILE.png")],
    options: Any = None,
) -> None:
    """Draw a pattern and its folded form side by side."""
    from foldmill_fabricate.files import write_whole
    from foldmill_fabricate.pictures import show_picture

    if output.suffix != ".png":
        raise FoldmillError(f"{output}: a picture is written as .png.")
    write_whole(output, show_picture(load(file, options)))
    typer.echo(f"{output}")


@with_file_options
def check(
    file: PatternFile,
    flat: Annotated[
        bool, typer.Option("--flat", help="Ask as well whether it folds flat, layers and all.")
    ] = False,
    options: Any = None,
    as_json: AsJson = False,
) -> None:
    """Check that a pattern folds: developable, planar, isometric, free of penetration."""
    from foldmill.check import Report, flat_foldability, layers
    from foldmill.check import check as check_fold

    fold = load(file, options)
    rules = [check_fold, flat_foldability, layers] if flat else [check_fold]
    report = Report.joined(rule(fold) for rule in rules)
    text = [figure_lines(report.figures), finding_lines(report.findings) or "no findings"]
    data = {"figures": dict(report.figures), "findings": finding_data(report.findings)}
    say(as_json, data, "\n".join(text))
    exit_code(report.findings)


def save(fold: Fold, file: Path) -> None:
    """Write a fold as the suffix says."""
    from foldmill_fabricate.files import write_whole

    write_whole(file, _bytes(fold, file))


def _bytes(fold: Fold, file: Path) -> bytes:
    from foldmill.exchange import fold as fold_file
    from foldmill.exchange import mesh
    from foldmill_fabricate import pictures

    suffix = file.suffix.lower()
    if suffix == ".fold":
        return fold_file.write(fold).encode()
    if suffix == ".svg":
        return pictures.pattern_svg(fold)
    if suffix == ".png":
        return pictures.pattern_picture(fold)
    if suffix in {".glb", ".stl", ".obj"}:
        return mesh.write_mesh(fold, suffix)
    raise FoldmillError(f"{file}: write .fold .svg .png .glb .stl or .obj, not {suffix or 'that'}.")


def _describe(design: Design[Any], preset: str | None) -> str:
    """Return a family's parameters as help; what was told of one before is named, not repeated."""
    from shutil import get_terminal_size

    from foldmill_fabricate.cli.parameters import rows

    values = design.preset(preset) if preset else design.params()
    head = f"{design.slug}: {design.title}\npresets: {', '.join(design.presets) or 'none'}\n"
    told: dict[str, str] = {}
    lines = []
    for row in rows(values):
        first = told.setdefault(row.about, row.name)
        about = row.about if first == row.name or not row.about else f"as --{first}"
        lines.append((f"--{row.name}", row.value, row.unit, row.bounds, about))
    heads = ("PARAMETER", "VALUE", "UNIT", "RANGE", "")
    return head + table([heads, *lines], get_terminal_size().columns)
