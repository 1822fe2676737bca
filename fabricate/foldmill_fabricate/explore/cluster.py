"""A Dask cluster: looked at before any work is sent, and watched while it works.

Without the look, a worker or scheduler that lacks a package leaves the caller waiting for ever.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

from foldmill.errors import one_line
from foldmill_fabricate.errors import EngineFailed
from foldmill_fabricate.explore.workers import Cluster

R = TypeVar("R")
Versions = Mapping[str, str]

VERSIONED = ("foldmill", "numpy")
"""Distributions that must be the same everywhere, so that the results are."""
ABSENT = "absent"
LOOK_S = 0.5


def backend(client: Any) -> Any:
    """Return joblib's way to a cluster, which sends the work even where one worker is all there is.

    joblib itself would then do it in this process, and a cluster that grows would never be used.
    """
    from joblib._dask import DaskDistributedBackend

    class Sending(DaskDistributedBackend):  # type: ignore[misc]
        def effective_n_jobs(self, n_jobs: int) -> int:
            return max(2, int(super().effective_n_jobs(n_jobs)))

    return Sending(client=client)


@contextmanager
def connected(engine: Cluster, packages: Iterable[str]) -> Iterator[Any]:
    """Give a client of the cluster that has been looked at; closes it. Raises EngineFailed."""
    try:
        import distributed
    except ImportError:
        raise EngineFailed(
            'A cluster needs the extra "cluster": pip install "foldmill[cluster]".'
        ) from None
    try:
        make: Any = distributed.Client
        client = make(engine.address, timeout=engine.patience_s, set_as_default=False)
    except (OSError, TimeoutError, ValueError):
        raise EngineFailed(
            f"No Dask scheduler answers at {engine.address} within {engine.patience_s:g} s. Start "
            "one with `dask scheduler`, and give the address that it prints."
        ) from None
    with client:
        look(client, engine, packages)
        yield client


def look(client: Any, engine: Cluster, packages: Iterable[str]) -> None:
    """Make sure of workers, and that they and the scheduler have what is here.

    Raises EngineFailed, with the place and what it lacks.
    """
    try:
        client.wait_for_workers(1, timeout=engine.patience_s)
    except TimeoutError:
        raise EngineFailed(
            f"The scheduler at {engine.address} has no workers, not even after "
            f"{engine.patience_s:g} s. Start some with `dask worker {engine.address}`."
        ) from None
    ask = fingerprint(tuple(packages))
    try:
        places = {"the scheduler": client.run_on_scheduler(ask)}
        places |= {f"the worker {name}": told for name, told in client.run(ask).items()}
    except Exception as error:
        raise EngineFailed(
            f"The cluster at {engine.address} cannot say what is installed on it: "
            f"{one_line(error)}. It needs the Python and the packages of this machine."
        ) from None
    compare(ask(), places)


def compare(here: Versions, places: Mapping[str, Versions]) -> None:
    """Raise EngineFailed, naming the first place that lacks a package or has another version."""
    unlike = [place for place, found in places.items() if found != here]
    for place in unlike:
        more = f" {len(unlike) - 1} more places are unlike this one." if len(unlike) > 1 else ""
        for name, wanted in here.items():
            found = places[place].get(name, ABSENT)
            if found.startswith(ABSENT):
                raise EngineFailed(
                    f"There is no {name} on {place} ({found}). Install there what is here: "
                    f"{name} {wanted}.{more}"
                )
            if found != wanted:
                raise EngineFailed(
                    f"On {place} {name} is {found}, here it is {wanted}: results could depend on "
                    f"who computes them. Install the same version.{more}"
                )


def fingerprint(packages: tuple[str, ...]) -> Callable[[], dict[str, str]]:
    """Return a function that tells the versions of packages wherever it runs.

    It is made here so that it travels whole: it must also run where foldmill is absent.
    """
    versioned, absent = VERSIONED, ABSENT

    def versions() -> dict[str, str]:
        import importlib
        import importlib.metadata
        import sys

        found = {"python": "{}.{}".format(*sys.version_info)}
        for name in dict.fromkeys((*versioned, *packages)):
            try:
                importlib.import_module(name)
                found[name] = (
                    importlib.metadata.version(name) if name in versioned else "importable"
                )
            except Exception as error:
                found[name] = f"{absent}: {type(error).__name__}: {error}"
        return found

    return versions


def watched(results: Iterator[R], client: Any, engine: Cluster) -> Iterator[R]:
    """Yield results as they come; raises EngineFailed where the cluster has been lost."""
    done: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()

    def take() -> None:
        try:
            for result in results:
                done.put(("result", result))
            done.put(("end", None))
        except BaseException as error:
            done.put(("error", error))

    threading.Thread(target=take, daemon=True, name="foldmill sweep").start()
    without = 0.0
    while True:
        try:
            kind, value = done.get(timeout=LOOK_S)
        except queue.Empty:
            without = 0.0 if _has_workers(client) else without + LOOK_S
            if without >= engine.patience_s:
                raise EngineFailed(
                    f"The cluster at {engine.address} has had no worker for "
                    f"{engine.patience_s:g} s."
                ) from None
            continue
        without = 0.0
        if kind == "error":
            raise value
        if kind == "end":
            return
        yield value


def _has_workers(client: Any) -> bool:
    return client.status == "running" and bool(client.scheduler_info(n_workers=-1)["workers"])
