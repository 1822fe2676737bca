"""The sheets that are under work: what is certain, what is in doubt, who said what."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from foldmill_fabricate.cli.output import AsJson, say

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.ledger import Record, SheetRecord


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(sheets)


def sheets(
    name: Annotated[str, typer.Argument(help="A sheet's id; all open sheets without.")] = "",
    spoiled: Annotated[
        bool, typer.Option("--spoiled", help="Give this sheet up: nothing more is cut on it.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """List the sheets that are begun and not finished, or tell all about one."""
    from foldmill import FoldmillError
    from foldmill_fabricate.plotter.ledger import Ledger, ledger_file

    if spoiled and not name:
        raise FoldmillError("--spoiled gives one sheet up: name it by its id.")
    if not name and not ledger_file().exists():
        say(as_json, [], "No sheet is under work.")
        return
    ledger = Ledger(ledger_file())
    if not name:
        found = ledger.open_sheets()
        say(as_json, [_row(one) for one in found], _list(found))
        return
    if spoiled:
        ledger.give_up(ledger.sheet(name).id)
    sheet = ledger.sheet(name)
    history = ledger.history(sheet.id)
    say(as_json, _row(sheet) | {"history": history}, _whole(sheet, history))


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
    return f"{sheet.id}  {sheet.title}, {sheet.material}, {sheet.machine}, begun {sheet.begun}"


def _programs(sheet: SheetRecord) -> str:
    return "\n".join(f"      {_program(record)}" for record in sheet.records)


def _program(record: Record) -> str:
    from foldmill_fabricate.plotter.ledger import State, account

    told = f"{record.program.name:28} {record.state.value}"
    if record.state is State.RUNNING:
        return f"{told}, or killed: send tells. {account(record)}"
    if record.state in {State.INTERRUPTED, State.UNCONFIRMED, State.SPOILED} and record.runs:
        told += f". {record.note} {account(record)}".replace(". .", ".").replace("  ", " ")
    return told


def _whole(sheet: SheetRecord, history: list[tuple[str, str, str]]) -> str:
    lines = [f"      {when}  {who}: {what}" for when, who, what in history]
    return "\n".join([_head(sheet), _programs(sheet), "", *lines])
