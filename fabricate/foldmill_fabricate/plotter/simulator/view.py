"""What simulated plotters are doing, as a table that a terminal redraws."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from threading import Event
from typing import TYPE_CHECKING

from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import threaded

if TYPE_CHECKING:
    from rich.table import Table

_EVERY = 0.25
"""s between two pictures."""
_BAR = 5
"""Characters of a full buffer."""


def table(simulators: Mapping[str, Simulator]) -> Table:
    """Return one row for each plotter: address → simulator; * is the face that is up."""
    from rich.box import SIMPLE
    from rich.table import Table

    shown = Table(box=SIMPLE, pad_edge=False, padding=(0, 1, 0, 0))
    titles = ("", "plotter", "does", "x, y mm", "tool", "buffer", "lost", "front", "reverse")
    for title in (*titles, "faults"):
        shown.add_column(title, overflow="fold")
    for number, simulator in enumerate(simulators.values(), 1):
        shown.add_row(str(number), *row(simulator))
    return shown


def row(simulator: Simulator) -> list[str]:
    """Return what is told of one plotter, in words."""
    simulator.advance()
    device, sheet = simulator.device, simulator.sheet
    x, y = (each / simulator.machine.axes.units_per_mm for each in device.carriage.at)
    held = device.size - device.free
    return [
        simulator.machine.slug,
        simulator.doing,
        f"{x:.1f}, {y:.1f}",
        f"{device.carriage.tool} {'down' if device.carriage.down else 'up'}",
        f"{_bar(held, device.size)} {held}/{device.size}",
        str(device.traffic.overruns),
        *(f"{len(sheet.seen(face))}{'*' if face is sheet.up else ''}" for face in Face),
        ", ".join(sorted(device.active)),
    ]


@contextmanager
def redrawn(simulators: Mapping[str, Simulator]) -> Iterator[Callable[[str], None]]:
    """Redraw the table in a terminal while the context lasts; yields what prints above it."""
    from rich.live import Live

    with Live(table(simulators), auto_refresh=False) as live:

        def redraw(stop: Event) -> None:
            while not stop.wait(_EVERY):
                live.update(table(simulators), refresh=True)

        with threaded(redraw):
            yield lambda line: live.console.print(line, markup=False, highlight=False)


def _bar(filled: int, size: int) -> str:
    full = -(-_BAR * filled // size)
    return "█" * full + "·" * (_BAR - full)
