"""Thirty-two plotters driven from one process at 9600 baud, in real time.

    python benchmarks/many_plotters.py [PLOTTERS] [SECONDS]

Every plotter is a simulated ESC.B machine whose motion is slower than its line, on a clock of its
own that follows the wall; each has a thread that sends. The simulators run in the same process, so
the figures hold their work too. The second run has four designs computed by other processes at the
same time. Columns:

starved      times a plotter was seen at rest with an empty buffer, after its first fill
gap          how much later than asked a sender woke at worst once all had filled their machines, ms
cpu          processor time, share of one core
memory       highest resident size, MB
"""

from __future__ import annotations

import multiprocessing
import resource
import sys
import threading
import time
from dataclasses import dataclass

from foldmill import installed
from foldmill_fabricate.beside import step_aside
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Progress, send
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.trial import fine_lines

_STEP = 80
"""Steps a tooth: 2 mm, so that motion takes longer than the line."""


@dataclass
class Watch:
    """What was seen of one plotter."""

    starved: int = 0
    late: float = 0.0
    """s, the longest"""
    filled: bool = False
    done: bool = False


def machine() -> Machine:
    """Return a machine that is slower than its line."""
    base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
    serial = base.serial.model_copy(update={"handshake": "esc-b", "baud": 9600, "buffer": 1024})
    return base.model_copy(update={"serial": serial})


class Late(RealClock):
    """Notes how much later than asked a thread wakes: the gap that a busy process makes."""

    def __init__(self, watch: Watch, all_filled: threading.Event) -> None:
        self._watch, self._all = watch, all_filled

    def sleep(self, seconds: float) -> None:
        """Wait, and note by how much too long."""
        before = self.now()
        super().sleep(seconds)
        if self._all.is_set():
            late = self.now() - before - max(0.0, seconds)
            self._watch.late = max(self._watch.late, late)


def drive(
    number: int, program: bytes, watch: Watch, filled: threading.Event, stop: threading.Event
) -> None:
    """Send to one plotter until the time is over."""
    cutter, clock = machine(), Late(watch, filled)
    simulator = Simulator(cutter, clock=clock)
    url = devices.plug(f"many-{number}", simulator)

    def look(progress: Progress) -> None:
        device = simulator.device
        watch.filled |= progress.bytes > device.size
        if watch.filled and not device.buffer.data and device.idle:
            watch.starved += 1
        if stop.is_set():
            raise KeyboardInterrupt

    try:
        with open_port(url, cutter) as port:
            send(program, port, cutter, progress=look)
    except OSError:
        watch.done = stop.is_set()
    finally:
        devices.unplug(url)


def designs(stop: object) -> None:
    """Compute designs, again and again, at the low priority at which the service computes."""
    step_aside()
    family = installed().design("rotational")
    params = family.preset(next(iter(family.presets)))
    while not stop.is_set():  # type: ignore[attr-defined]
        family.run(params)


def run(plotters: int, seconds: float) -> None:
    """Drive them for so long and print the figures."""
    program = fine_lines(40_000, _STEP)
    watches = [Watch() for _ in range(plotters)]
    filled, stop = threading.Event(), threading.Event()
    threads = [
        threading.Thread(target=drive, args=(number, program, watch, filled, stop))
        for number, watch in enumerate(watches)
    ]
    for thread in threads:
        thread.start()
    while not all(watch.filled for watch in watches):
        time.sleep(0.1)
    filled.set()
    before, began = time.process_time(), time.perf_counter()
    time.sleep(seconds)
    cpu = (time.process_time() - before) / (time.perf_counter() - began)
    stop.set()
    for thread in threads:
        thread.join()
    starved, late = sum(each.starved for each in watches), max(each.late for each in watches)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{plotters:8d} {seconds:7.0f} {starved:8d} {1000 * late:8.1f} {cpu:6.1%} {memory:7.0f}")


def main() -> None:
    """Print one row without other work and one beside four designs."""
    plotters = int(sys.argv[1]) if len(sys.argv) > 1 else 32
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 30.0
    print("plotters seconds  starved   gap ms    cpu  memory")
    run(plotters, seconds)
    context = multiprocessing.get_context("spawn")
    over = context.Event()
    workers = [context.Process(target=designs, args=(over,)) for _ in range(4)]
    for worker in workers:
        worker.start()
    run(plotters, seconds)
    over.set()
    for worker in workers:
        worker.join()


if __name__ == "__main__":
    main()
