"""Many configurations of a family at once: the command explore."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from foldmill.exchange.marking import marked
from foldmill.finding import has_errors
from foldmill_fabricate.cli.designing import save
from foldmill_fabricate.cli.output import AsJson, finding_lines, say, table
from foldmill_fabricate.cli.progress import SweepProgress
from foldmill_fabricate.errors import CannotExplore

if TYPE_CHECKING:
    from foldmill_fabricate.explore import Engine, Sweep

SHOWN_REGIONS = 8
DEFAULT_AT_MOST = 1_000_000
"""That of the package explore; it is not imported for the sake of --help."""
PICKED = (".fold", ".svg", ".png", ".glb", ".stl", ".obj")


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    settings = {"allow_extra_args": True, "ignore_unknown_options": True}
    app.command(context_settings=settings)(explore)


def explore(
    context: typer.Context,
    family: Annotated[str, typer.Argument(help="A slug of `foldmill families`.")],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            help="NAME=START:STOP:STEP, NAME=START:STOP:xCOUNT or NAME=A,B,C; repeatable."
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="The table, FILE.csv or .parquet.")
    ] = None,
    picture: Annotated[Path | None, typer.Option(help="The map, FILE.png or .svg.")] = None,
    thumbnail: Annotated[
        list[str] | None,
        typer.Option(help="A ROW, or regionK for its centre, to show beside the map; repeatable."),
    ] = None,
    pick: Annotated[
        list[str] | None,
        typer.Option(help="ROW:FILE.fold, or regionK:FILE.fold: write its fold; repeatable."),
    ] = None,
    preset: Annotated[str | None, typer.Option(help="Start from a preset.")] = None,
    params: Annotated[Path | None, typer.Option(help="Parameters from a TOML file.")] = None,
    jobs: Annotated[int | None, typer.Option(help="Processes; default: one per core.")] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="tcp://HOST:PORT of a Dask cluster to compute on.")
    ] = None,
    at_most: Annotated[int, typer.Option(help="Refuse more rows.")] = DEFAULT_AT_MOST,
    resume: Annotated[
        Path | None, typer.Option(help="A folder that keeps what is done, to go on from.")
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Write picks that do not fold, too; they are marked.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Try all combinations: foldmill explore FAMILY [--PARAM V]… --vary NAME=START:STOP:STEP…"""
    from foldmill import installed
    from foldmill_fabricate.cli.parameters import gather
    from foldmill_fabricate.explore import Range, summary
    from foldmill_fabricate.explore import explore as run

    picks = [_pick(text) for text in pick or []]
    _require_files(output, picture, picks)
    offered = installed().design(family)
    base = gather(offered, preset, params, context.args)
    ranges = [Range.read(text) for text in vary or []]
    engine = _engine(jobs, scheduler)
    with SweepProgress(_place(engine)) as told:
        sweep = run(offered, base, ranges, engine, at_most=at_most, resume=resume, progress=told)
    if output:
        _write_table(sweep, output)
    say(as_json, summary(sweep), _text(sweep))
    if picture:
        _write_picture(sweep, picture, thumbnail or [])
    refused = [said for each in picks if (said := _write_pick(sweep, each, force))]
    for said in [*refused, *_fault_lines(sweep)]:
        typer.echo(said, err=True)
    if refused or sweep.faults:
        raise typer.Exit(1)


class Pick(NamedTuple):
    """A row to be written."""

    which: str
    file: Path


def _pick(text: str) -> Pick:
    which, colon, file = text.partition(":")
    if not (which and colon and file):
        raise CannotExplore(f"--pick {text}: write ROW:FILE.fold or regionK:FILE.fold.")
    return Pick(which, Path(file))


def _require_files(output: Path | None, picture: Path | None, picks: Sequence[Pick]) -> None:
    """Refuse files of no known kind before anything is computed."""
    from foldmill_fabricate.explore.picture import require_picture
    from foldmill_fabricate.explore.table import require_writable

    if output:
        require_writable(output)
    if picture:
        require_picture(picture)
    for pick in picks:
        if pick.file.suffix.lower() not in PICKED:
            raise CannotExplore(f"{pick.file}: a pick is written as {' '.join(PICKED)}.")


def _engine(jobs: int | None, scheduler: str | None) -> Engine | None:
    from foldmill_fabricate.explore import Cluster, Local

    if scheduler is None:
        return None if jobs is None else Local(jobs)
    if jobs is not None:
        raise CannotExplore("--jobs counts processes here; with --scheduler the cluster has its.")
    return Cluster(scheduler)


def _place(engine: Engine | None) -> str:
    from foldmill_fabricate.explore import Local

    if engine is None:
        return "on this machine"
    if not isinstance(engine, Local):
        return f"on the cluster at {engine.address}"
    return "in one process" if engine.jobs == 1 else f"in {engine.jobs} processes"


def _row(sweep: Sweep[Any], which: str) -> int:
    """Return the row of a number, or of the centre of a region; raises CannotExplore."""
    if which.isascii() and which.isdigit():
        sweep.grid.values(int(which))
        return int(which)
    number = which.removeprefix("region")
    if not (which.startswith("region") and number.isascii() and number.isdigit()):
        raise CannotExplore(f"{which!r} is neither a row's number nor regionK.")
    if not 1 <= int(number) <= len(sweep.regions):
        raise CannotExplore(f"There is no {which}: the free regions are {len(sweep.regions)}.")
    return sweep.regions[int(number) - 1].centre


def _write_table(sweep: Sweep[Any], file: Path) -> None:
    from foldmill_fabricate.explore.table import table as written
    from foldmill_fabricate.files import write_whole

    write_whole(file, written(sweep, file))
    typer.echo(f"{file}", err=True)


def _write_picture(sweep: Sweep[Any], file: Path, thumbnails: Sequence[str]) -> None:
    from foldmill_fabricate.explore.picture import sweep_picture
    from foldmill_fabricate.files import write_whole

    rows = [_row(sweep, which) for which in thumbnails]
    write_whole(file, sweep_picture(sweep, file.suffix.lower(), rows))
    typer.echo(f"{file}", err=True)


def _write_pick(sweep: Sweep[Any], pick: Pick, force: bool) -> str:
    """Write a pick; return why not, where it does not fold and is not forced."""
    from foldmill.check import check

    row = _row(sweep, pick.which)
    fold = sweep.fold(row)
    found = check(fold).findings
    if has_errors(found) and not force:
        return (
            f"{finding_lines(found)}\nRow {row} ({sweep.grid.told(row)}) does not fold, so "
            f"{pick.file} is not written; --force writes it, marked."
        )
    save(marked(fold, found), pick.file)
    typer.echo(f"{pick.file}: row {row}, {sweep.grid.told(row)}", err=True)
    return ""


def _text(sweep: Sweep[Any]) -> str:
    lines = [(word, f"{count:,}") for word, count in sweep.counts.items()]
    text = table([*lines, ("rows", f"{len(sweep):,}")])
    if not sweep.regions:
        return f"{text}\nno free region"
    head = ("REGION", "SIZE", "CENTRE", *(axis.label for axis in sweep.grid.axes))
    shown = [
        (
            str(region.number),
            f"{region.size:,}",
            f"row {region.centre}",
            *(f"{low:g} … {high:g}" for low, high in region.ranges.values()),
        )
        for region in sweep.regions[:SHOWN_REGIONS]
    ]
    more = len(sweep.regions) - len(shown)
    return f"{text}\n\n{table([head, *shown])}" + (f"\nand {more} more regions" if more else "")


def _fault_lines(sweep: Sweep[Any]) -> Iterator[str]:
    for row, said in list(sweep.faults.items())[:SHOWN_REGIONS]:
        yield f"Row {row} ({sweep.grid.told(row)}) broke the family: {said}"
    if len(sweep.faults) > SHOWN_REGIONS:
        yield f"{len(sweep.faults):,} rows broke the family; --json tells more of them."
