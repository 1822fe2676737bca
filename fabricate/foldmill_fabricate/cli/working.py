"""Where jobs are worked on: here, by a service that runs, or by nobody for now."""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Callable, Sequence
from contextlib import suppress
from threading import Event
from typing import TYPE_CHECKING

from foldmill import FoldmillError

if TYPE_CHECKING:
    from foldmill_fabricate.jobs import Jobs, Places

TOKEN, SERVICE = "FOLDMILL_TOKEN", "FOLDMILL_SERVICE"
"""Variables of the environment: a service's token, and the address of one elsewhere."""
MISSING = (
    "Jobs are worked on with the service's packages, and some are missing: install "
    "foldmill[service]."
)


def desk(more: Sequence[str]) -> tuple[Jobs, bool]:
    """Return the verbs of jobs, and whether anybody works on them now.

    Where a service runs it is asked, by the token in ``FOLDMILL_TOKEN`` if it wants one; ``more``
    plotters are its own matter then.
    """
    from foldmill_fabricate.jobs import Desk, Places, plotters
    from foldmill_fabricate.jobs.alone import is_worked_on

    places = Places()
    service = _service(places)
    if service is not None:
        if more:
            raise FoldmillError("A service runs: name its plotters where it is started.")
        return service, True
    made = Desk(places, plotters.read(more=more))
    return made, is_worked_on(places, made.store)


def _service(places: Places) -> Jobs | None:
    """Return the service that runs on this folder, or that FOLDMILL_SERVICE names."""
    url = os.environ.get(SERVICE, "")
    if not url and not places.service.exists():
        return None
    try:
        from foldmill_fabricate.client import Client
        from foldmill_fabricate.service.reach import reached
    except ImportError:
        raise FoldmillError(MISSING) from None
    found = url or reached(places)
    return Client(found, os.environ.get(TOKEN, "")) if found else None


def work_here(more: Sequence[str], host_name: str, tell: Callable[[str], None]) -> None:
    """Work on jobs until SIGINT or SIGTERM, telling of each change."""
    from foldmill_fabricate.jobs import Places, plotters
    from foldmill_fabricate.plotter.errors import LedgerFailed

    try:
        from foldmill_fabricate.jobs.host import Host
    except ImportError:
        raise FoldmillError(MISSING) from None
    known = plotters.read(more=more)
    if not known:
        raise FoldmillError(
            f"There is no plotter to work on: name some in {plotters.plotters_file()}, or with "
            "--plotter NAME=PORT@MACHINE."
        )
    logging.getLogger("dbos").setLevel(logging.ERROR)
    over = Event()
    before = {
        number: signal.signal(number, lambda *_: over.set())
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    host = Host(Places(), known, host_name)
    heard = host.store.last_event()
    host.start()
    tell(f"At work on {', '.join(sorted(known))}; Ctrl-C ends it.")
    try:
        while not over.wait(0.3):
            with suppress(LedgerFailed):  # the log says so; what happens meanwhile is told later
                for event in host.store.events(heard):
                    heard = event.number
                    tell(f"{event.job}  {event.who}: {event.what}")
    finally:
        host.stop()
        for number, handler in before.items():
            signal.signal(number, handler)
