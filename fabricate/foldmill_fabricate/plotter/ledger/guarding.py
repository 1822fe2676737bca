"""Stop a delivery as soon as its run has lost its token, not only where its next stroke begins."""

from __future__ import annotations

import logging
from threading import Event, Thread

from foldmill_fabricate.plotter.ledger.run import Run
from foldmill_fabricate.plotter.wish import Wish

LOOK = 0.2
"""s between two looks at the ledger."""
_LOG = logging.getLogger(__name__)


class guarded:  # noqa: N801
    """Give, while the context lasts, a wish that is to stop once the run may not go on.

    above : what a person wants of the delivery besides.
    """

    def __init__(self, run: Run, above: Wish | None = None) -> None:
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
