"""How far work is, on standard error: a bar on a terminal, else a line for each stage."""

from __future__ import annotations

import sys
from time import perf_counter
from types import TracebackType
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from foldmill_fabricate.passes import ProgramFile
    from foldmill_fabricate.plotter.sender import Progress


class SweepProgress:
    """Told (rows done, rows of the sweep) now and then; a context manager."""

    def __init__(self, place: str) -> None:
        self.place = place
        self.before: int | None = None
        self.done = 0
        self.bar: Any = None
        self.task: Any = None

    def __enter__(self) -> SweepProgress:
        self.begun = perf_counter()
        return self

    def __call__(self, done: int, rows: int) -> None:
        """Show that so many rows of all are done."""
        if self.before is None:
            self.before = done
            kept = f", {done:,} of them done before" if done else ""
            typer.echo(f"{rows:,} configurations {self.place}{kept}", err=True)
            if sys.stderr.isatty():
                self._open_bar(rows)
        self.done = done
        if self.bar:
            self.bar.update(self.task, completed=done)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.bar:
            self.bar.stop()
        if error is None:
            computed, took = self.done - (self.before or 0), perf_counter() - self.begun
            pace = f", {computed / took:,.0f} a second" if computed else ""
            typer.echo(f"{computed:,} computed in {took:.1f} s{pace}", err=True)

    def _open_bar(self, rows: int) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

        columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self.bar = Progress(*columns, console=Console(stderr=True), transient=True)
        self.task = self.bar.add_task("", total=rows)
        self.bar.start()


class ProgressLine:
    """How far a program is: a bar on a terminal, one line per program elsewhere."""

    def __init__(self, aside: bool = False) -> None:
        self._aside = aside
        self._live = sys.stderr.isatty()
        self._shown = -1

    def tell(self, part: ProgramFile, progress: Progress) -> None:
        """Redraw the bar where a person can see it."""
        share = 40 * progress.bytes // max(1, progress.of_bytes)
        if self._live and share != self._shown:
            typer.echo(f"\r{part.name:28} [{'#' * share:40}]", nl=False, err=True)
            self._shown = share

    def end(self, line: str) -> None:
        """Leave the line for good."""
        if self._live:
            typer.echo("\r\033[K", nl=False, err=True)
        self._shown = -1
        typer.echo(line, err=self._aside)
