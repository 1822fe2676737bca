"""One hand on a device, and one on a sheet, among all who share a ledger: on every computer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from foldmill_fabricate.plotter.errors import LedgerRefused, PlotterError, PortUnavailable
from foldmill_fabricate.plotter.holding import Held, Holder, locked
from foldmill_fabricate.plotter.ledger.ledger import Ledger, ledger_place
from foldmill_fabricate.plotter.lock import at_work, held, lock_file

_SHARED, _OWN = "socket://", "socket://localhost:"


def own_ledger(url: str, who: str = "") -> Ledger:
    """Return the ledger that a device's sheets are in; who : signs in it.

    A simulator in this process ends with it, and so do its sheets: they are kept in memory.
    """
    return Ledger("sqlite://" if url.startswith("sim://") else ledger_place(), who=who)


def by_hand(command: str) -> Holder:
    """Return what others are told while a person's command is at work."""
    return Holder(f"foldmill {command}", "Wait until it is done, or end it where it runs.")


@contextmanager
def alone(url: str, holder: Holder, ledger: Ledger) -> Iterator[str]:
    """Hold a device while the context lasts, and give its name.

    A machine that is reached over the network is held in the ledger, too: other computers reach it
    as well. Raises PortUnavailable with who has it, since when, and what to do.
    """
    with held(url, holder) as device, ExitStack() as stack:
        shared = device.startswith(_SHARED) and not device.startswith(_OWN)
        try:
            stack.enter_context(ledger.reserved([f"device {device}"] if shared else [], holder))
        except Held as error:
            raise PortUnavailable(at_work(url, error.by)) from None
        yield device


@contextmanager
def alone_on(sheet: str, holder: Holder, ledger: Ledger) -> Iterator[None]:
    """Hold a sheet while the context lasts: it lies on one machine, at whatever port that is.

    Who finds a run of it without an end, and holds it, may take that run for dead. Raises
    LedgerRefused with who has it, since when, and what to do.
    """
    with ExitStack() as stack:
        try:
            stack.enter_context(ledger.reserved([f"sheet {sheet}"], holder))
            if file := ledger.file:
                stack.enter_context(locked(lock_file(f"sheet {sheet} of {file}"), holder, 0o666))
        except Held as error:
            by = error.by or holder
            raise LedgerRefused(
                f"Sheet {sheet} is worked on already: {by}. Nothing was sent. {by.remedy}"
            ) from None
        except OSError as error:
            if isinstance(error, PlotterError):
                raise
            raise LedgerRefused(f"Sheet {sheet} cannot be locked: {error}.") from None
        yield
