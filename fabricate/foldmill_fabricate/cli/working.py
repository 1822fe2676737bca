"""Where jobs are worked on: here, by a service that runs, or by nobody for now."""

from __future__ import annotations

import logging
import signal
from collections.abc import Callable, Sequence
from threading import Event
from typing import TYPE_CHECKING

from foldmill import FoldmillError

if TYPE_CHECKING:
    from foldmill_fabricate.jobs import Jobs, Places

MISSING = (
    "Jobs are worked on with the service's packages, and some are missing: install "
    "foldmill[service]."
)


def desk(more: Sequence[str]) -> tuple[Jobs, bool]:
    """Return the verbs of jobs, and whether anybody works on them now."""
    from foldmill_fabricate.jobs import Desk, Places, plotters

    places = Places()
    return Desk(places, plotters.read(more=more)), is_worked_on(places)


def is_worked_on(places: Places) -> bool:
    """Tell whether some process holds the host's lock."""
    from filelock import FileLock, Timeout

    if not places.lock.exists():
        return False
    lock = FileLock(places.lock, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        return True
    lock.release()
    return False


def work_here(more: Sequence[str], host_name: str, tell: Callable[[str], None]) -> None:
    """Work on jobs until SIGINT or SIGTERM, telling of each change."""
    from foldmill_fabricate.jobs import Places, plotters

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
    heard = max((event.number for event in host.store.events(limit=10**9)), default=0)
    host.start()
    tell(f"At work on {', '.join(sorted(known))}; Ctrl-C ends it.")
    try:
        while not over.wait(0.3):
            for event in host.store.events(heard):
                heard = event.number
                tell(f"{event.job}  {event.who}: {event.what}")
    finally:
        host.stop()
        for number, handler in before.items():
            signal.signal(number, handler)
