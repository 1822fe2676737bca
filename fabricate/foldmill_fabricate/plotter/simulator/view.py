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
_BAR = 12
"""Characters of a full buffer."""


def table(simulators: Mapping[str, Simulator]) -> Table:
    """Return one row for each plotter: address → simulator."""
    from rich.table import Table

    shown = Table(expand=False)
    for title in ("", "plotter", "does", "x, y mm", "tool", "buffer", "lost", "strokes", "faults"):
        shown.add_column(title, no_wrap=True)
    for number, (address, simulator) in enumerate(simulators.items(), 1):
        shown.add_row(str(number), *row(address, simulator))
    return shown


def row(address: str, simulator: Simulator) -> list[str]:
    """Return what is told of one plotter, in words."""
    simulator.advance()
    device, sheet = simulator.device, simulator.sheet
    x, y = (each / simulator.machine.axes.units_per_mm for each in device.carriage.at)
    counts = [len(sheet.seen(face)) for face in Face]
    strokes = " ".join(
        f"{face}{'*' if face is sheet.up else ''} {count}"
        for face, count in zip(Face, counts, strict=True)
    )
    return [
        f"{simulator.machine.slug} {address}",
        simulator.doing,
        f"{x:.1f}, {y:.1f}",
        f"{device.carriage.tool} {'down' if device.carriage.down else 'up'}",
        f"{_bar(device.size - device.free, device.size)} {device.size - device.free}/{device.size}",
        str(device.traffic.overruns),
        strokes,
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
