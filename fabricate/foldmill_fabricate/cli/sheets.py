"""The sheets that are under work: what is certain, what is in doubt, who said what."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill_fabricate.cli.account import describe, next_steps
from foldmill_fabricate.cli.choices import Formats
from foldmill_fabricate.cli.layout import hanging, moment
from foldmill_fabricate.cli.output import AsJson, say

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.ledger import Ledger, Record, SheetRecord


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(sheets)


def sheets(
    name: Annotated[str, typer.Argument(help="A sheet's id; all open sheets without.")] = "",
    spoiled: Annotated[
        bool, typer.Option("--spoiled", help="Give this sheet up: nothing more is cut on it.")
    ] = False,
    remake: Annotated[
        bool, typer.Option("--remake", help="Plan what is missing on this sheet, into --output.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="A PNG of both faces as cut; with --remake a folder."),
    ] = None,
    doubtful: Annotated[
        list[str] | None,
        typer.Option(
            help="With --remake: cut, missing, or the strokes in doubt that are missing, as 3,5-8; "
            "the others are cut then. PROGRAM: before it where there are several; repeatable."
        ),
    ] = None,
    half: Annotated[
        list[str] | None,
        typer.Option(help="With --remake: strokes in doubt that are cut in part; repeatable."),
    ] = None,
    job: Annotated[
        Path | None,
        typer.Option(help="The folder it was begun from, where that was moved since."),
    ] = None,
    to: Formats = None,
    who: Annotated[str, typer.Option(help="Who says so; default: whoever is here.")] = "",
    as_json: AsJson = False,
) -> None:
    """List the sheets that are begun and not finished, or tell all about one.

    With --output it draws one as cut, or plans with --remake what is missing on it.
    """
    from foldmill import FoldmillError
    from foldmill_fabricate.cli import remaking
    from foldmill_fabricate.plotter.ledger import Ledger, ledger_place

    if (spoiled or remake or output) and not name:
        raise FoldmillError("--spoiled, --remake and --output are about one sheet: name its id.")
    if remake and not output:
        raise FoldmillError("--remake writes a job folder: name it with --output.")
    if (doubtful or half) and not remake:
        raise FoldmillError("--doubtful and --half say what --remake plans; give that, too.")
    place = ledger_place()
    if not name and isinstance(place, Path) and not place.exists():
        say(as_json, [], "No sheet is under work.")
        return
    ledger = Ledger(place, who=who)
    if not name:
        found = ledger.open_sheets()
        say(as_json, [_row(one) for one in found], _list(found))
        return
    if spoiled:
        _give_up(ledger, ledger.sheet(name))
    if remake and output:
        made = remaking.rest(ledger, name, output, doubtful or [], half or [], job, to)
        told = f"{describe(made)}\n{next_steps(made, output)}"
        say(as_json, made.model_dump(mode="json"), told)
        return
    if output:
        remaking.draw(ledger, name, output, job)
        typer.echo(f"drawn: {output}", err=as_json)
    sheet = ledger.sheet(name)
    history = ledger.history(sheet.id)
    say(as_json, _row(sheet) | {"history": history}, _whole(sheet, history))


def _give_up(ledger: Ledger, sheet: SheetRecord) -> None:
    """Give a sheet up, and say so where a machine is at work on it, or may be."""
    from foldmill_fabricate.plotter.ledger import State

    ledger.give_up(sheet.id)
    for record in sheet.records:
        if record.state is State.RUNNING:
            typer.echo(
                f"{record.program.name} was under way: whoever sends it stops the machine now, its "
                "tool up. A software stop is no emergency stop; look at the machine.",
                err=True,
            )


def _row(sheet: SheetRecord) -> dict[str, Any]:
    head = {name: getattr(sheet, name) for name in ("id", "title", "machine", "material", "begun")}
    programs = [
        {
            "program": record.program.name,
            "state": record.state.value,
            "strokes": record.program.strokes,
            "certain": len(record.certain),
            "doubtful": [stroke + 1 for stroke in record.doubtful],
            "note": record.note,
        }
        for record in sheet.records
    ]
    return head | {"programs": programs}


def _list(found: list[SheetRecord]) -> str:
    if not found:
        return "No sheet is under work."
    return "\n".join(_head(sheet) + "\n" + _programs(sheet) for sheet in found)


def _head(sheet: SheetRecord) -> str:
    what = f"{sheet.title}, {sheet.material}, {sheet.machine}"
    return hanging(f"{sheet.id}  {what}, begun {moment(sheet.begun)}", " " * 6)


def _programs(sheet: SheetRecord) -> str:
    lines = (f"      {_program(record)}" for record in sheet.records)
    return "\n".join(hanging(line, " " * 35) for line in lines)


def _program(record: Record) -> str:
    from foldmill_fabricate.plotter.ledger import State, account

    told = f"{record.program.name:28} {record.state.value}"
    if record.state is State.RUNNING:
        return f"{told}, or killed: send tells. {account(record)}"
    if record.state in {State.INTERRUPTED, State.UNCONFIRMED, State.SPOILED} and record.runs:
        told += f". {record.note} {account(record)}".replace(". .", ".").replace("  ", " ")
    return told


def _whole(sheet: SheetRecord, history: list[tuple[str, str, str]]) -> str:
    lines = [
        hanging(f"      {moment(when)}  {who}: {what}", " " * 31) for when, who, what in history
    ]
    return "\n".join([_head(sheet), _programs(sheet), "", *lines])
