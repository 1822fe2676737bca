"""Who computes the chunks of a sweep: processes of this machine, or a Dask cluster that is there.

joblib is the only way in; what a sweep gives does not depend on the engine.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pickle import PicklingError
from typing import Any, TypeVar

from foldmill import FoldmillError
from foldmill.errors import one_line
from foldmill_fabricate.errors import CannotExplore, EngineFailed

R = TypeVar("R")


@dataclass(frozen=True)
class Local:
    """Processes of this machine."""

    jobs: int = -1
    """How many; -1 for one per core. With 1 the work is done in this process."""

    def __post_init__(self) -> None:
        if self.jobs == 0 or self.jobs < -1:
            raise CannotExplore(f"{self.jobs} processes compute nothing; take 1 or more.")


@dataclass(frozen=True)
class Cluster:
    """A Dask cluster that runs already. Whoever can reach it can run code on it: trust it."""

    address: str
    """Of the scheduler: ``tcp://host:8786`` or ``tls://host:8786``."""
    patience_s: float = 10.0
    """How long to wait for the scheduler, for its first worker, and for one when all are lost."""

    def __post_init__(self) -> None:
        if not re.fullmatch(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[\w.-]+):\d{1,5}", self.address):
            raise CannotExplore(
                f"{self.address!r} is no address of a Dask scheduler; write tcp://HOST:PORT, such "
                "as tcp://127.0.0.1:8786."
            )


Engine = Local | Cluster


def run(
    engine: Engine, work: Callable[[int], R], numbers: Iterable[int], packages: Iterable[str]
) -> Generator[R, None, None]:
    """Yield the results of the work on each number, in whatever order they are done.

    packages : what workers of a cluster must be able to import. Raises EngineFailed where workers
    are missing, unlike or lost, and whatever the work raises.
    """
    wanted = list(numbers)
    if isinstance(engine, Local):
        jobs = engine.jobs if len(wanted) > 1 else 1
        with _told("a process that computes"):
            yield from _parallel(work, wanted, backend="loky", n_jobs=jobs)
        return
    from foldmill_fabricate.explore.cluster import backend, connected, watched

    with connected(engine, packages) as client, _told(f"the cluster at {engine.address}"):
        results = _parallel(work, wanted, backend=backend(client), n_jobs=-1)
        yield from watched(results, client, engine)


def _parallel(
    work: Callable[[int], R], numbers: list[int], backend: Any, n_jobs: int
) -> Iterator[R]:
    import joblib

    one_thread = {"inner_max_num_threads": 1} if backend == "loky" and n_jobs != 1 else {}
    with joblib.parallel_config(backend=backend, n_jobs=n_jobs, **one_thread):
        together = joblib.Parallel(return_as="generator_unordered", batch_size=1)
        with _closed(together(joblib.delayed(work)(number) for number in numbers)) as results:
            for result in results:  # noqa: UP028 - "yield from" would close them without _closed
                yield result


@contextmanager
def _closed(results: Any) -> Iterator[Any]:
    """Close results that nobody takes any more; joblib warns of them as of a waste."""
    try:
        yield results
    finally:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            results.close()


@contextmanager
def _told(whose: str) -> Iterator[None]:
    """Turn the failures of an engine into sentences."""
    try:
        yield
    except FoldmillError:
        raise
    except BrokenExecutor:
        raise EngineFailed(
            "A process that computes was ended from outside, most often for want of memory; take "
            "fewer of them with --jobs."
        ) from None
    except PicklingError as error:
        raise EngineFailed(
            f"The family cannot be sent to {whose}: {one_line(error)}. Put its functions into a "
            "module, or compute in one process with --jobs 1."
        ) from None
    except Exception as error:
        raise EngineFailed(
            f"{whose[0].upper()}{whose[1:]} failed with {one_line(error)}"
        ) from error
