"""One worker on jobs: in a folder, in a database in a file, and of a name among many computers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager

from foldmill_fabricate.jobs.errors import JobRefused
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.store import JobStore
from foldmill_fabricate.plotter.holding import Held, Holder, is_held, locked
from foldmill_fabricate.plotter.ledger.sharing import Keep

_REMEDY = (
    "Stop that one first, leave the work to it, or give this one a name, plotters and a state "
    "folder of its own."
)
_HOLDER = Holder("`foldmill serve` or `foldmill job work`", _REMEDY)

_COMPUTER = "computer "
"""What a computer's name begins with among the names it holds."""


@contextmanager
def alone(places: Places) -> Iterator[None]:
    """Hold what one process of a computer may have: a folder, and a database that is a file.

    Raises JobRefused with who has it.
    """
    with ExitStack() as stack:
        for file in places.locks:
            try:
                file.parent.mkdir(parents=True, exist_ok=True)
                stack.enter_context(locked(file, _HOLDER))
            except Held as error:
                raise JobRefused(_taken(f"the jobs in {file.parent}", error.by)) from None
            except OSError as error:
                raise JobRefused(f"{file} cannot be locked: {error}.") from None
        yield


@contextmanager
def alone_in(store: JobStore, name: str, plotters: Iterable[str]) -> Iterator[Keep]:
    """Hold a computer's name and its plotters' in a database that others reach; raises JobRefused.

    Two of one name would take each other's turns, and two with one plotter each other's jobs. Gives
    what holds them again after the server was started anew; that raises JobRefused, too.
    """
    whole = {f"{_COMPUTER}{name}": f"jobs as {name!r} with this database"}
    whole |= {plotter_name(one): f"the jobs of plotter {one!r}" for one in plotters}

    @contextmanager
    def telling() -> Iterator[None]:
        try:
            yield
        except Held as error:
            raise JobRefused(_taken(whole[error.name], error.by)) from None

    def kept() -> None:
        with telling():
            keep()

    with ExitStack() as stack:
        with telling():
            keep = stack.enter_context(store.ledger.reserved([*whole], _HOLDER))
        yield kept


def is_worked_on(places: Places, store: JobStore) -> bool:
    """Tell whether some process works on the jobs here, on any computer; asking changes nothing."""
    return any(map(is_held, places.locks)) or store.ledger.is_any_reserved(_COMPUTER)


def plotter_name(plotter: str) -> str:
    """Return what a host holds of a plotter in a database of many computers."""
    return f"plotter {plotter}"


def _taken(what: str, by: Holder | None) -> str:
    who = f"Another foldmill works on {what} already"
    who += f": {by}" if by else ", `foldmill serve` or `foldmill job work`"
    return f"{who}. {_HOLDER.remedy}"
