"""Many configurations of a family at once: the command explore."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from foldmill.finding import has_errors
from foldmill_fabricate.cli.designing import save
from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import AsJson, finding_lines, say
from foldmill_fabricate.cli.progress import SweepProgress
from foldmill_fabricate.errors import CannotExplore

if TYPE_CHECKING:
    from foldmill_fabricate.explore import Engine, Sweep

SHOWN_REGIONS = 8
DEFAULT_AT_MOST = 1_000_000
"""That of the package explore; it is not imported for the sake of --help."""
BROKEN_OFF = 130
"""The exit code that shells know for Ctrl-C."""
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
    from foldmill_fabricate.explore.grid import grid

    picks = [_pick(text) for text in pick or []]
    _require_files(output, picture, picks, resume)
    shown = _thumbnails(thumbnail or [], picture)
    offered = installed().design(family)
    ranges = [Range.read(text) for text in vary or []]
    _refuse_stated([each.name for each in ranges], context.args)
    base = gather(offered, preset, params, context.args)
    rows = len(grid(offered, base, ranges, at_most))
    for which in (*shown, *(each.which for each in picks)):
        which.require(rows)
    engine = _engine(jobs, scheduler)
    try:
        with SweepProgress(_place(engine)) as told:
            sweep = run(
                offered, base, ranges, engine, at_most=at_most, resume=resume, progress=told
            )
    except KeyboardInterrupt as stop:
        typer.echo(str(stop) or "Broken off.", err=True)
        raise typer.Exit(BROKEN_OFF) from None
    if output:
        _write_table(sweep, output)
    say(as_json, summary(sweep), _text(sweep))
    if picture:
        _write_picture(sweep, picture, shown)
    refused = [said for each in picks if (said := _write_pick(sweep, each, force))]
    for said in [*refused, *_fault_lines(sweep)]:
        typer.echo(said, err=True)
    if refused or sweep.faults:
        raise typer.Exit(1)


class Which(NamedTuple):
    """A row by its number, or by that of the region whose centre it is."""

    number: int
    is_region: bool

    @classmethod
    def read(cls, text: str) -> Which:
        """Read ROW or regionK; raises CannotExplore."""
        number = text.removeprefix("region")
        if not (number.isascii() and number.isdigit()):
            raise CannotExplore(f"{text!r} is neither a row's number nor regionK.")
        return cls(int(number), text != number)

    def require(self, rows: int) -> None:
        """Raise CannotExplore for a row that a sweep of so many rows cannot have."""
        if not self.is_region and self.number >= rows:
            raise CannotExplore(f"There is no row {self.number}: the rows are 0 to {rows - 1}.")

    def row(self, sweep: Sweep[Any]) -> int:
        """Return the row; raises CannotExplore where there is no such region."""
        if not self.is_region:
            return self.number
        if not 1 <= self.number <= len(sweep.regions):
            raise CannotExplore(
                f"There is no region{self.number}: the free regions are {len(sweep.regions)}."
            )
        return sweep.regions[self.number - 1].centre


class Pick(NamedTuple):
    """A row to be written."""

    which: Which
    file: Path


def _pick(text: str) -> Pick:
    which, colon, file = text.partition(":")
    if not (which and colon and file):
        raise CannotExplore(f"--pick {text}: write ROW:FILE.fold or regionK:FILE.fold.")
    return Pick(Which.read(which), Path(file))


def _thumbnails(texts: Sequence[str], picture: Path | None) -> list[Which]:
    if texts and picture is None:
        raise CannotExplore("--thumbnail shows a form beside the map: name it, --picture FILE.png.")
    return [Which.read(text) for text in texts]


def _refuse_stated(varied: Sequence[str], options: Sequence[str]) -> None:
    """Refuse a parameter that is both stated and varied: it cannot be both."""
    from foldmill_fabricate.cli.parameters import pairs

    for name, value in pairs(options):
        if name in varied:
            raise CannotExplore(
                f"--{name} {value} and --vary {name}=… contradict each other; leave one out."
            )


def _require_files(
    output: Path | None, picture: Path | None, picks: Sequence[Pick], resume: Path | None
) -> None:
    """Refuse files of no known kind, or without a place, before anything is computed."""
    from foldmill_fabricate.explore.picture import require_picture
    from foldmill_fabricate.explore.table import require_writable
    from foldmill_fabricate.files import require_place

    if output:
        require_writable(output)
    if picture:
        require_picture(picture)
    for pick in picks:
        if pick.file.suffix.lower() not in PICKED:
            raise CannotExplore(f"{pick.file}: a pick is written as {' '.join(PICKED)}.")
    kept = resume and resume / "kept"
    for file in (output, picture, kept, *(pick.file for pick in picks)):
        if file:
            require_place(file)


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


def _write_table(sweep: Sweep[Any], file: Path) -> None:
    from foldmill_fabricate.explore.table import table as written
    from foldmill_fabricate.files import write_whole

    write_whole(file, written(sweep, file))
    typer.echo(f"{file}", err=True)


def _write_picture(sweep: Sweep[Any], file: Path, thumbnails: Sequence[Which]) -> None:
    from foldmill_fabricate.explore.picture import sweep_picture
    from foldmill_fabricate.files import write_whole

    rows = [which.row(sweep) for which in thumbnails]
    write_whole(file, sweep_picture(sweep, file.suffix.lower(), rows))
    typer.echo(f"{file}", err=True)


def _write_pick(sweep: Sweep[Any], pick: Pick, force: bool) -> str:
    """Write a pick; return why not, where it does not fold and is not forced."""
    from foldmill.check import check
    from foldmill.exchange.marking import marked

    row = pick.which.row(sweep)
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
