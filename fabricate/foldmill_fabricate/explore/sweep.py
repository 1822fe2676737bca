"""All configurations of a family on a grid: what becomes of each, and where the free ones are."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from foldmill import Design, Fold, FoldmillError, Params
from foldmill.batch import Outcome, Outcomes
from foldmill.configurations import outcomes, with_values
from foldmill_fabricate.errors import CannotExplore, EngineFailed
from foldmill_fabricate.explore import engine as engines
from foldmill_fabricate.explore.chunk import FAULT, Chunk, Task, compute, joined_figures
from foldmill_fabricate.explore.grid import AT_MOST, Grid, grid
from foldmill_fabricate.explore.ranges import Range
from foldmill_fabricate.explore.regions import FULL_TURN, Region, closes, regions
from foldmill_fabricate.explore.store import Store, compute_and_keep, modules
from foldmill_fabricate.explore.workers import Engine, Local

P = TypeVar("P", bound=Params)
Progress = Callable[[int, int], None]
"""Told (rows done, rows of the sweep) now and then."""

WORDS = {outcome.value: outcome.name.lower().replace("_", "-") for outcome in Outcome} | {
    FAULT: "fault"
}
"""What an outcome is called in tables and pictures."""
SAME = 1e-6
"""mm; figures of one form computed at an angle and a full turn further differ by rounding alone."""


@dataclass(frozen=True, eq=False)
class Sweep(Generic[P]):
    """What became of every row of a grid."""

    design: Design[P]
    base: P
    """The parameters that all rows share."""
    grid: Grid
    outcomes: Outcomes
    """Row by row; a code may be FAULT, where the family broke down."""
    faults: dict[int, str]
    """What was said there, by row."""
    labels: NDArray[np.int32]
    """(n,) number of the free region each row is in; 0 where it is not free."""
    regions: tuple[Region, ...]
    """The largest first."""
    joined: tuple[bool, ...]
    """Which axes go once round."""

    def __len__(self) -> int:
        return len(self.grid)

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each outcome, by its word; outcomes that no row has are left out."""
        number = np.bincount(self.outcomes.codes, minlength=FAULT + 1)
        return {word: int(number[code]) for code, word in WORDS.items() if number[code]}

    def params(self, row: int) -> P:
        """Return the parameters of a row; raises CannotExplore, InvalidParameters."""
        return with_values(self.design, self.base, self.grid.values(row))

    def fold(self, row: int) -> Fold:
        """Return the fold of a row; raises CannotExplore, with its values, where it has none."""
        told = f"Row {row} ({self.grid.told(row)})"
        try:
            return self.design.run(self.params(row))
        except FoldmillError as error:
            raise CannotExplore(f"{told} has no form: {error}") from None


def explore(
    design: Design[P],
    base: P,
    ranges: Sequence[Range],
    engine: Engine | None = None,
    *,
    at_most: int = AT_MOST,
    resume: Path | None = None,
    progress: Progress | None = None,
) -> Sweep[P]:
    """Compute what becomes of a design over all combinations of values of some parameters.

    base : the parameters that are not varied; engine : if not given, all cores of this machine, or
    one where that is sooner; at_most : rows; resume : a folder that keeps finished chunks, and
    gives back those it has. The result does not depend on the engine.

    Raises CannotExplore, InvalidParameters, EngineFailed; KeyboardInterrupt says what is kept.
    """
    task = Task(design, base, grid(design, base, ranges, at_most))
    engine = engine or Local(1 if task.is_short else -1)
    chunks = _chunks(task, engine, Store(resume, task) if resume else None, progress or _untold)
    found = Outcomes(
        np.concatenate([chunk.codes for chunk in chunks]),
        np.concatenate([chunk.at for chunk in chunks]),
        joined_figures(chunks),
    )
    faults = {row: said for chunk in chunks for row, said in chunk.faults.items()}
    joined = tuple(_is_joined(task, found, place) for place in range(len(task.grid.axes)))
    labels, free = regions(task.grid, found.codes == Outcome.FREE, joined)
    return Sweep(design, base, task.grid, found, faults, labels, free, joined)


def _untold(*_: int) -> None:
    """Tell nobody how far it is."""


def _chunks(task: Task, engine: Engine, store: Store | None, progress: Progress) -> list[Chunk]:
    """Return all chunks in order, those of the store first and the others as they are computed."""
    kept = (store.load(number) for number in range(task.chunks)) if store else ()
    done = {chunk.number: chunk for chunk in kept if chunk}
    rows = sum(len(chunk.codes) for chunk in done.values())
    progress(rows, len(task.grid))
    missing = [number for number in range(task.chunks) if number not in done]
    try:
        for chunk in _computed(task, engine, store, missing):
            done[chunk.number] = chunk
            rows += len(chunk.codes)
            progress(rows, len(task.grid))
    except EngineFailed as error:
        raise EngineFailed(_broken_off(str(error), task, done, store)) from error
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_broken_off("Broken off.", task, done, store)) from None
    return [done[number] for number in range(task.chunks)]


def _computed(
    task: Task, engine: Engine, store: Store | None, missing: list[int]
) -> Iterator[Chunk]:
    """Yield the missing chunks as they are done, kept in the store."""
    if not missing:
        return
    work, is_near = partial(compute, task), isinstance(engine, Local)
    if store and is_near:
        work = partial(compute_and_keep, task, store)
    with closing(engines.run(engine, work, missing, packages(task.design))) as results:
        for chunk in results:
            if store and not is_near:
                store.save(chunk)
            yield chunk


def packages(design: Design[Any]) -> tuple[str, ...]:
    """Return the packages that a worker needs for a family, other than numpy."""
    return ("foldmill", "foldmill_fabricate", *modules(design))


def _broken_off(said: str, task: Task, done: Container[int], store: Store | None) -> str:
    """Add to what is said how much is done, and where it is kept."""
    found = done if store is None else store
    left = [number for number in range(task.chunks) if number not in found]
    if not left or len(left) == task.chunks:
        return said
    place = task.grid.told(int(task.rows(left[0])[0]))
    kept = (
        f"They are kept in {store.folder}: the same sweep goes on there."
        if store
        else "With --resume DIR they would have been kept."
    )
    return (
        f"{said} {task.chunks - len(left)} of {task.chunks} chunks were done; the first that was "
        f"not begins at {place}. {kept}"
    )


def _is_joined(task: Task, found: Outcomes, place: int) -> bool:
    """Tell whether an axis goes once round: the range closes, and so do the configurations.

    The free rows at the first value are computed a full turn further: they must be the same forms.
    """
    axis = task.grid.axes[place]
    if not closes(axis):
        return False
    rows = np.arange(len(task.grid)).reshape(task.grid.shape).take(0, place).ravel()
    rows = rows[found.codes[rows] == Outcome.FREE]
    if not len(rows):
        return False
    columns = task.grid.columns(rows)
    turn = FULL_TURN * np.sign(axis.values[-1] - axis.values[0])
    try:
        again = outcomes(task.design, task.base, columns | {axis.name: columns[axis.name] + turn})
    except Exception:
        return False  # the family broke down there: nothing shows that the axis is a circle
    if not np.array_equal(again.codes, found.codes[rows]):
        return False
    return all(
        np.allclose(again.figures.get(name, np.nan), column[rows], rtol=0, atol=SAME)
        for name, column in found.figures.items()
    )
