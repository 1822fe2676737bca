"""Stop a delivery as soon as its run has lost its token, not only where its next stroke begins."""

from __future__ import annotations

import logging
from threading import Event, Thread
from typing import Protocol

from foldmill_fabricate.plotter.errors import Fenced, Spoiled
from foldmill_fabricate.plotter.ledger.ledger import Ledger
from foldmill_fabricate.plotter.wish import Wish

LOOK = 0.2
"""s between two looks at the ledger."""
_LOG = logging.getLogger(__name__)


class Watched(Protocol):
    """What is cut, and may have to stop."""

    sheet: str

    def loss(self) -> Fenced | None:
        """Return why it may not go on; None while it may."""
        ...

    @property
    def is_shared(self) -> bool:
        """Whether anybody else can say so."""
        ...


class Lying:
    """A sheet that is cut in without a program of its record, as by a test cut."""

    def __init__(self, ledger: Ledger, sheet: str) -> None:
        self._ledger, self.sheet = ledger, sheet

    def loss(self) -> Fenced | None:
        """Return Spoiled once the sheet is given up."""
        if not self._ledger.sheet(self.sheet).is_given_up:
            return None
        return Spoiled(f"Sheet {self.sheet} was given up while a test cut was made in it.")

    @property
    def is_shared(self) -> bool:
        """Whether anybody else can give it up."""
        return self._ledger.is_shared


class guarded:  # noqa: N801
    """Give, while the context lasts, a wish that is to stop once what is cut may not go on.

    above : what a person wants of the delivery besides.
    """

    def __init__(self, run: Watched, above: Wish | None = None) -> None:
        self._run, self._wish, self._over = run, Wish(above), Event()
        name = f"guard of sheet {run.sheet}"
        self._thread = Thread(target=self._watch, name=name, daemon=True)

    def __enter__(self) -> Wish:
        if self._run.is_shared:
            self._thread.start()
        return self._wish

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._run.is_shared:
            self._thread.join()

    def _watch(self) -> None:
        while not self._over.wait(LOOK):
            try:
                if self._run.loss() is not None:
                    self._wish.stop()
                    return
            except Exception:  # a database that is away for a moment must not stop a machine
                _LOG.exception("ledger of sheet %s", self._run.sheet)
