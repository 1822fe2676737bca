"""Looking for a shape that meets targets: the command search."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill import FoldmillError, InvalidInput
from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import AsJson, say

if TYPE_CHECKING:
    from foldmill import Design
    from foldmill_fabricate.explore.search import Outcome, Request, Result, Target
    from foldmill_fabricate.explore.search.fit import Room
    from foldmill_fabricate.explore.search.run import Tell

SECONDS = 110.0
"""After so long a search stops between two rounds, to be done within two minutes."""


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    settings = {"allow_extra_args": True, "ignore_unknown_options": True}
    app.command(context_settings=settings)(search)


def search(
    context: typer.Context,
    family: Annotated[str, typer.Argument(help="A slug of `foldmill families`.")],
    target: Annotated[
        list[str] | None,
        typer.Option(help="NAME=MM, NAME=MM±MM or NAME=MM±SHARE%; several. Without ±: 1 %."),
    ] = None,
    sheet: Annotated[
        str | None, typer.Option(help="Largest sheet, WxH in mm; default: the material's stock.")
    ] = None,
    material: Annotated[
        str, typer.Option(help="Whose clearance and smallest feature are kept.")
    ] = "pp-0.75",
    min_crease: Annotated[
        float | None, typer.Option(help="Shortest crease, mm; default: the material's.")
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(help="Only these parameters vary, such as points.*.a; several."),
    ] = None,
    preset: Annotated[
        list[str] | None, typer.Option(help="Start from this preset only; several.")
    ] = None,
    results: Annotated[int, typer.Option(help="How many forms are wanted.")] = 5,
    seed: Annotated[int, typer.Option(help="Another one finds other forms.")] = 0,
    evaluations: Annotated[
        int | None, typer.Option(help="How many forms are folded and measured; default: 2400.")
    ] = None,
    seconds: Annotated[
        float, typer.Option(help="Stop early after about so long; it is said where that happens.")
    ] = SECONDS,
    jobs: Annotated[int, typer.Option(help="Processes; -1: one per core.")] = -1,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="A folder for forms, table and picture.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find parameters that meet targets: foldmill search FAMILY --target height=150 … -o DIR.

    Targets: height, width, width_x, width_y, seat, footprint. A parameter is given by its dotted
    name, such as --n 6; all other numbers may vary.
    """
    from foldmill import installed
    from foldmill_fabricate.explore.search import Request, contents, report
    from foldmill_fabricate.explore.search import search as look
    from foldmill_fabricate.explore.search.request import EVALUATIONS
    from foldmill_fabricate.files import require_place, write_all

    offered = installed().design(family)
    if jobs == 0 or jobs < -1:
        raise FoldmillError(f"--jobs must be 1 or more, or -1 for every core, not {jobs}.")
    if not seconds > 0:
        raise FoldmillError(f"--seconds must be above 0, not {seconds:g}.")
    room, least = _limits(material, sheet, min_crease)
    targets, given = _targets(offered, target or ())
    request = Request(
        targets,
        room,
        least,
        fixed=given | _fixed(context.args),
        vary=tuple(vary or ()),
        presets=tuple(preset or ()),
        seed=seed,
        results=results,
        evaluations=EVALUATIONS if evaluations is None else evaluations,
    )
    if output is not None:
        require_place(output / "results.csv")
    with telling() as tell:
        outcome = look(offered, request, jobs=jobs, seconds=seconds, tell=tell)
    if output is not None and outcome.results:
        write_all(output, contents(outcome, request, family), stale=_older(output))
    say(as_json, report.data(outcome, request, family), _text(outcome, request, output))
    if not outcome.results or outcome.results[0].missed:
        raise typer.Exit(1)


def _targets(
    design: Design[Any], texts: Sequence[str]
) -> tuple[tuple[Target, ...], dict[str, float]]:
    """Return the measures aimed at; a parameter that is named as one, such as n=6, is given."""
    from fnmatch import fnmatchcase

    from foldmill.schema import leaves
    from foldmill_fabricate.explore.search import Target

    targets: list[Target] = []
    given: dict[str, float] = {}
    for text in texts:
        name, _, value = (part.strip() for part in text.partition("="))
        if any(fnmatchcase(name, leaf.kind) for leaf in leaves(design.schema())):
            given |= _fixed([f"--{name}", value])
        else:
            targets.append(Target.read(text))
    return tuple(targets), given


def _limits(material: str, sheet: str | None, least: float | None) -> tuple[Room, float]:
    """Return the sheet there is, and the shortest crease."""
    from foldmill_fabricate import shelf
    from foldmill_fabricate.explore.search.fit import Room

    chosen = shelf.material(material)
    stock = (chosen.stock_width, chosen.stock_height)
    width, height = stock if sheet is None else _size(sheet)
    return Room(
        width, height, chosen.part_clearance
    ), chosen.min_feature if least is None else least


def _size(text: str) -> tuple[float, float]:
    try:
        width, height = (float(side) for side in text.lower().replace("×", "x").split("x"))
    except ValueError:
        raise InvalidInput(
            f"--sheet: write WIDTHxHEIGHT in mm, such as 500x500; not {text!r}."
        ) from None
    return width, height


def _fixed(words: Sequence[str]) -> dict[str, float]:
    """Read parameters that are given: --n 6, --points.1.a=100."""
    from foldmill_fabricate.cli.parameters import pairs

    given: dict[str, float] = {}
    for name, text in pairs(words):
        try:
            given[name] = float(text)
        except ValueError:
            raise InvalidInput(f"--{name}: a search is given numbers only, not {text!r}.") from None
    return given


def _older(folder: Path) -> list[str]:
    """Return the names of forms that an earlier search left in a folder."""
    from foldmill_fabricate.explore.search.report import LISTING, fold_name

    try:
        count = len(json.loads((folder / LISTING).read_bytes())["results"])
    except (OSError, ValueError, LookupError, TypeError):
        return []
    return [fold_name(rank) for rank in range(1, count + 1)]


def _text(outcome: Outcome, request: Request, output: Path | None) -> str:
    from foldmill_fabricate.explore.search.report import missed

    lines = []
    if outcome.stopped:
        lines.append(
            f"Stopped early, after {outcome.evaluations} of {request.evaluations} evaluations: "
            f"--seconds allows more, and only a whole search finds the same again."
        )
    if not outcome.results:
        lines.append(
            "Nothing was found that folds without penetration on this sheet, and is no preset. "
            "Take a larger sheet, other targets, or more --evaluations."
        )
        return "\n".join(lines)
    lines.append(_listed(outcome.results, request))
    first = outcome.results[0]
    if first.missed:
        by = "; ".join(missed(target, first) for target in first.missed)
        lines.append(f"The targets are not met. Of the nearest, number 1, {by}.")
    if output is not None:
        lines.append(f"{output}: {len(outcome.results)} forms, results.csv, results.png")
    return "\n".join(lines)


def _listed(results: Sequence[Result], request: Request) -> str:
    names = [target.name for target in request.targets]
    head = ("", *names, "sheet", "crease", "error", "from")
    rows = [
        (
            str(rank),
            *(f"{each.figures[name]:.2f}" for name in names),
            f"{each.figures['sheet_x']:.0f} × {each.figures['sheet_y']:.0f}",
            f"{each.figures['crease']:.1f}",
            f"{100 * each.error:.2f} %",
            each.start,
        )
        for rank, each in enumerate(results, 1)
    ]
    return table([head, *rows])


@contextmanager
def telling() -> Iterator[Tell]:
    """Show on standard error how far a search is: a bar on a terminal, else a line per stage."""
    if not sys.stderr.isatty():
        yield lambda stage, step, steps, best: typer.echo(
            f"{stage} ({step} of {steps}): best score {best:.4f}", err=True
        )
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starts", total=None)
        yield lambda stage, step, steps, best: bar.update(
            task, description=f"{stage}, best {best:.4f}", completed=step, total=steps
        )
