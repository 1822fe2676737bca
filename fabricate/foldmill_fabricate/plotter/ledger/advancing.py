"""The one change that is made for every stroke: how far the holder of a token is.

Its statement is made once, and goes to the database past the layers that make statements: on a
simulator these would take longer than all else that is done for a stroke.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import BindParameter, Engine, Update, bindparam, select, update

from foldmill_fabricate.plotter.ledger import failing
from foldmill_fabricate.plotter.ledger.tables import PROGRAMS, RUNS
from foldmill_fabricate.plotter.ledger.values import State


class Advance:
    """Writes ``sent`` and ``acked`` of a run, if its token is still the program's."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._made = _statement().compile(dialect=engine.dialect)
        self._text = str(self._made)

    def __call__(self, sheet: str, number: int, token: int, sent: int, acked: int) -> bool:
        """Write them for good and return True; False, and nothing written, without the token.

        One statement is one transaction: it compares and sets at once. Raises LedgerFailed.
        """
        given = {"of": sheet, "nth": number, "with": token, "sent": sent, "acked": acked}
        values: Any = self._made.construct_params(given)
        if self._made.positiontup is not None:
            values = tuple(values[name] for name in self._made.positiontup)
        try:
            return self._written(values)
        except self._engine.dialect.loaded_dbapi.Error as error:
            found = failing.failed(error, self._engine)
            raise (found or error) from None

    def _written(self, values: Any) -> bool:
        connection = self._engine.raw_connection()
        try:
            cursor = connection.cursor()
            cursor.execute(self._text, values)
            connection.commit()
            return bool(cursor.rowcount == 1)
        except BaseException as error:
            if failing.is_lost(error, self._engine, connection.dbapi_connection):
                connection.invalidate()
            raise
        finally:
            connection.close()  # back to the pool, which undoes what was not committed


def _statement() -> Update:
    sheet: BindParameter[str] = bindparam("of")
    number: BindParameter[int] = bindparam("nth")
    token: BindParameter[int] = bindparam("with")
    program = (PROGRAMS.c.sheet == sheet) & (PROGRAMS.c.number == number)
    running = select(PROGRAMS.c.sheet).where(
        program, PROGRAMS.c.token == token, PROGRAMS.c.state == State.RUNNING.value
    )
    mine = (RUNS.c.sheet == sheet) & (RUNS.c.number == number) & (RUNS.c.token == token)
    running = running.with_for_update(read=True)  # whoever takes the token waits for this, or it
    change = update(RUNS).where(mine, running.exists())
    return change.values(sent=bindparam("sent"), acked=bindparam("acked"))
