"""Write to the ledger and read it: every change is a compare-and-set in one transaction."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, insert, select
from sqlalchemy.exc import SQLAlchemyError

from foldmill_fabricate.plotter.errors import Fenced, LedgerFailed, LedgerRefused, Spoiled
from foldmill_fabricate.plotter.holding import Holder
from foldmill_fabricate.plotter.ledger import devices, origins, reading, sharing, words, writing
from foldmill_fabricate.plotter.ledger.advancing import Advance
from foldmill_fabricate.plotter.ledger.origins import GoesOn, Origin
from foldmill_fabricate.plotter.ledger.places import ledger_file as ledger_file
from foldmill_fabricate.plotter.ledger.places import ledger_place as ledger_place
from foldmill_fabricate.plotter.ledger.places import state_folder as state_folder
from foldmill_fabricate.plotter.ledger.places import told
from foldmill_fabricate.plotter.ledger.reading import (
    not_ready,
    program_row,
    sheet_record,
)
from foldmill_fabricate.plotter.ledger.run import Run
from foldmill_fabricate.plotter.ledger.tables import AUDIT, PROGRAMS, RUNS, SHEETS, connect
from foldmill_fabricate.plotter.ledger.tables import reading as reading_of
from foldmill_fabricate.plotter.ledger.values import (
    Answered,
    Program,
    Record,
    SheetRecord,
    State,
    Word,
)
from foldmill_fabricate.plotter.ledger.writing import note, set_state, stamp

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789"
"""Of a sheet's id: none that a hand-written one is mistaken for."""
_CRASHED = "The run before was never ended: it crashed, or was killed."


def utc() -> datetime:
    """Return the time on the wall."""
    return datetime.now(UTC)


class Ledger:
    """The ledger in one database.

    place : a file, made where there is none, or an SQLAlchemy URL. now : the time on the wall. who
    : whoever signs what nobody else signs, by default whoever is at the computer. Raises
    LedgerRefused where it cannot be opened. Every method raises LedgerFailed where the database is
    away or full; what it was to write down is not, and may be tried again.
    """

    def __init__(self, place: Path | str, now: Callable[[], datetime] = utc, who: str = "") -> None:
        self._now, self._who = now, who
        self._unended: dict[tuple[str, int, int], str] = {}
        """Why runs ended of which that could not be written down, by sheet, number and token."""
        try:
            if isinstance(place, Path):
                place.parent.mkdir(parents=True, exist_ok=True)
            self._engine = connect(place)
            self._advance = Advance(self._engine)
        except LedgerFailed:
            raise
        except (SQLAlchemyError, OSError, ImportError) as error:
            reason = str(error).splitlines()[0]
            raise LedgerRefused(
                f"The ledger {told(place)} cannot be opened: {reason}. Nothing is sent without it."
            ) from None

    def close(self) -> None:
        """Let go of the database."""
        self._engine.dispose()

    def reserved(
        self, names: Sequence[str], holder: Holder
    ) -> AbstractContextManager[sharing.Keep]:
        """Hold names among all computers of this database while a context lasts; raises Held.

        What it gives is called now and then by whoever holds them long.
        """
        return sharing.reserved(self._engine, names, holder)

    def is_reserved(self, name: str) -> bool:
        """Tell whether some computer holds a name."""
        return sharing.is_reserved(self._engine, name)

    def is_any_reserved(self, beginning: str) -> bool:
        """Tell whether some computer holds a name that begins so."""
        return sharing.is_any_reserved(self._engine, beginning)

    @property
    def file(self) -> Path | None:
        """The file it is in; None where it is in memory, or on a server."""
        url = self._engine.url
        is_file = url.get_backend_name() == "sqlite" and url.database
        return Path(str(url.database)).resolve() if is_file else None

    @property
    def is_shared(self) -> bool:
        """Whether others can reach it: one that is kept in memory is this thread's alone."""
        return bool(self._engine.url.database)

    def lay(
        self,
        job: str,
        programs: Sequence[Program],
        *,
        title: str,
        machine: str,
        material: str,
        folder: str = "",
        goes_on: GoesOn | None = None,
    ) -> SheetRecord:
        """Begin a new sheet of a job and return it; job : SHA-256 of its plan.

        folder : from which it is begun. goes_on : the sheet that lies there half made, and is given
        up; raises LedgerRefused where that is not as it was, or another goes on with it.
        """
        head = {"job": job, "title": title, "machine": machine, "material": material}
        with self._engine.begin() as at:
            name = _free_name(at, job)
            at.execute(insert(SHEETS).values(id=name, begun=stamp(self._now()), **head))
            ready = {"sheet": name, "state": State.READY.value}
            rows = [{**ready, "number": k, **vars(one)} for k, one in enumerate(programs)]
            at.execute(insert(PROGRAMS), rows)
            note(at, self._now(), name, None, "laid", self._who)
            if goes_on:
                origins.take_over(at, reading.sheet(at, goes_on.sheet), goes_on)
                other, who = goes_on.sheet, self._who
                note(at, self._now(), other, None, f"its rest is made as sheet {name}", who)
                note(at, self._now(), name, None, f"goes on with sheet {other}", who)
            origins.keep(at, name, folder, goes_on.sheet if goes_on else "")
        return self.sheet(name)

    def origin(self, sheet: str) -> Origin:
        """Return from which folder a sheet was begun, and which sheet it goes on with."""
        with reading_of(self._engine) as at:
            return origins.origin(at, sheet)

    def successor(self, sheet: str) -> SheetRecord | None:
        """Return the sheet that goes on with one that was given up."""
        with reading_of(self._engine) as at:
            after = origins.successor(at, sheet)
            return reading.sheet(at, after) if after else None

    def sheet(self, name: str) -> SheetRecord:
        """Return a sheet; raises LedgerRefused where there is none of that id."""
        with reading_of(self._engine) as at:
            return reading.sheet(at, name)

    def open_sheets(self, job: str | None = None) -> list[SheetRecord]:
        """Return the sheets that were begun and are not finished, the newest first."""
        with reading_of(self._engine) as at:
            found = at.execute(reading.open_sheets(job)).all()
            return [sheet_record(at, row) for row in found]

    def record(self, sheet: str, number: int) -> Record:
        """Return one program of a sheet."""
        return self.sheet(sheet).records[number]

    def broken_off(self, device: str) -> devices.BrokenOff | None:
        """Return what was broken off on a device, of whatever sheet, and is not settled since."""
        with reading_of(self._engine) as at:
            return devices.broken_off(at, device)

    def on_device(self, sheet: str, number: int, what: str, device: str) -> None:
        """Add to a sheet's history what went to a device beside its programs, or was done there."""
        with self._engine.begin() as at:
            note(at, self._now(), sheet, number, devices.told(what, device), self._who)

    def history(self, sheet: str) -> list[tuple[str, str, str]]:
        """Return what happened to a sheet: (when, who, what), the oldest first."""
        wanted = select(AUDIT.c.when, AUDIT.c.who, AUDIT.c.what).where(AUDIT.c.sheet == sheet)
        with reading_of(self._engine) as at:
            return [(row[0], row[1], row[2]) for row in at.execute(wanted.order_by(AUDIT.c.id))]

    def answer(
        self, sheet: str, number: int | None, gate: str, told: Mapping[str, Any], who: str = ""
    ) -> None:
        """Keep what a person did and measured at a gate; ``told`` : plain values by name."""
        with self._engine.begin() as at:
            writing.answer(at, self._now(), sheet, number, gate, told, who or self._who)

    def answers(self, sheet: str) -> list[Answered]:
        """Return what was done and measured at the gates of a sheet, the oldest first."""
        with reading_of(self._engine) as at:
            return reading.answers(at, sheet)

    def claim(self, sheet: str, number: int, device: str) -> Run:
        """Take a ready program's token.

        Whoever calls holds device and sheet. Raises LedgerRefused, with the sentence, where the
        program is not ready; one that another run left without an end is interrupted from then on.
        """
        with self._engine.begin() as at:
            row = program_row(at, sheet, number)
            token = row.token + 1
            if State(row.state) is State.READY and set_state(at, row, State.RUNNING, token=token):
                begun = {"first": row.first, "sent": row.first, "acked": row.first}
                place = {"sheet": sheet, "number": number, "token": token, "vertex": row.vertex}
                at.execute(insert(RUNS).values(device=device, **place, **begun))
                begins = devices.told(f"{devices.BEGUN}{row.first + 1}", device)
                note(at, self._now(), sheet, number, begins, self._who)
                return Run(self, sheet, number, token, row.first, row.strokes)
        raise LedgerRefused(not_ready(self.recover(sheet, number)))

    def recover(self, sheet: str, number: int) -> Record:
        """Return a program; a run of it that nobody ended is interrupted from now on.

        Whoever calls holds the sheet (``alone_on``), so that such a run is dead.
        """
        with self._engine.begin() as at:
            row = program_row(at, sheet, number)
            if State(row.state) is State.RUNNING:
                why = self._unended.pop((sheet, number, row.token), _CRASHED)
                set_state(at, row, State.INTERRUPTED, note=why)
                note(at, self._now(), sheet, number, f"interrupted: {why}", self._who)
        return self.record(sheet, number)

    def write(self, run: Run, sent: int, acked: int) -> None:
        """Write down how far a run is; raises Fenced where it lost its token, Spoiled its sheet."""
        if not self._advance(run.sheet, run.number, run.token, sent, acked):
            raise self.loss(run) or _fenced(run)

    def end(self, run: Run, state: State, why: str) -> None:
        """End a run; raises Fenced where it lost its token, Spoiled its sheet.

        Where that cannot be written down now, ``recover`` says why it ended.
        """
        try:
            self._end(run, state, why)
        except LedgerFailed:
            if state is State.INTERRUPTED:
                self._unended[run.sheet, run.number, run.token] = why
            raise

    def _end(self, run: Run, state: State, why: str) -> None:
        with self._engine.begin() as at:
            row = program_row(at, run.sheet, run.number)
            if row.token != run.token or not set_state(at, row, state, note=why):
                raise _lost(run, row)
            told = f"{state.value}: {why}" if why else state.value
            note(at, self._now(), run.sheet, run.number, told, self._who)

    def loss(self, run: Run) -> Fenced | None:
        """Return why a run may not go on, Fenced or Spoiled; None while it holds its token."""
        with reading_of(self._engine) as at:
            row = program_row(at, run.sheet, run.number)
        held = row.token == run.token and State(row.state) is State.RUNNING
        return None if held else _lost(run, row)

    def say(self, sheet: str, number: int, said: words.Said, who: str = "") -> Record:
        """Take a person's word on a program that was interrupted or not confirmed.

        Raises LedgerRefused where it says what cannot be.
        """
        record = self.record(sheet, number)
        words.refuse(record, said)
        with self._engine.begin() as at:
            row = program_row(at, sheet, number)
            if not words.apply(at, row, record, said):
                raise LedgerRefused(
                    f"Somebody else has spoken of {record.program.name} of sheet {sheet} "
                    "meanwhile; look again."
                )
            note(at, self._now(), sheet, number, str(said), who or self._who)
        return self.record(sheet, number)

    def give_up(self, sheet: str, who: str = "") -> SheetRecord:
        """Give up what is left of a sheet, on a person's word; what runs of it is stopped."""
        with self._engine.begin() as at:
            words.give_up(at, sheet)
            note(at, self._now(), sheet, None, Word.SPOILED.value, who or self._who)
        return self.sheet(sheet)


def _free_name(at: Connection, job: str) -> str:
    """Return a short id that no sheet has: the job's and its count's, as four letters."""
    count = len(at.execute(select(SHEETS.c.number).where(SHEETS.c.job == job)).all())
    while True:
        digest = hashlib.sha256(f"{job} {count}".encode()).digest()
        name = "".join(LETTERS[byte % len(LETTERS)] for byte in digest[:4])
        if at.execute(select(SHEETS.c.id).where(SHEETS.c.id == name)).first() is None:
            return name
        count += 1


def _lost(run: Run, row: Any) -> Fenced:
    if State(row.state) is State.SPOILED:
        return Spoiled(f"Sheet {run.sheet} was given up while {row.name} was being cut.")
    return _fenced(run)


def _fenced(run: Run) -> Fenced:
    return Fenced(
        f"Program {run.number + 1} of sheet {run.sheet} was taken over by another process; this "
        "one stops, and sends nothing more."
    )
