"""Who computes the chunks of a sweep: processes of this machine, or a Dask cluster that is there.

joblib is the only way in; what a sweep gives does not depend on the engine.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from pickle import PicklingError
from typing import Any, TypeVar

from foldmill import FoldmillError
from foldmill.errors import one_line
from foldmill_fabricate.errors import EngineFailed
from foldmill_fabricate.explore.cluster import backend, connected, watched
from foldmill_fabricate.explore.workers import Engine, Local

R = TypeVar("R")


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
