"""The whole stand-in: a device, the two directions of its line, a clock, and a sheet under it."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from threading import RLock

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import Clock, VirtualClock
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.simulator.control import ControlChannel
from foldmill_fabricate.plotter.simulator.device import XOFF, XON, Device, Faults
from foldmill_fabricate.plotter.simulator.drawing import DrawnSheet
from foldmill_fabricate.plotter.simulator.gauge import Gauge
from foldmill_fabricate.plotter.simulator.uart import Transmitter

_FIFO = 16
"""Bytes in the host's UART that XOFF cannot stop (16550)."""
_AHEAD = 0.005
"""s of bytes that a host's chip takes from its driver at once."""


class Simulator:
    """A plotter at the end of a serial line.

    Nothing happens by itself: every call first brings the machine to the clock's time. It may be
    called from several threads.
    """

    def __init__(
        self,
        machine: Machine,
        *,
        clock: Clock | None = None,
        speed_up: float = 1.0,
        faults: Faults | None = None,
    ) -> None:
        self.machine = machine
        self.clock = clock or VirtualClock()
        self.sheets = [DrawnSheet()]
        byte_time = 10 / machine.serial.baud
        self.device = Device(machine, self.sheet, byte_time, speed_up, faults or Faults())
        self.line = Transmitter(byte_time)
        """From the host to the machine."""
        self.honours_xoff = True
        """Whether the host's end of the line stops at XOFF; set by whoever opens it."""
        self.baud = machine.serial.baud
        """Rate of the host's end; another than the machine's garbles every byte."""
        self.gauge = Gauge((), 0)
        self._heard = bytearray()
        self._written = self._arrived_before = 0
        self._scanner = ControlChannel()
        self._now = self.clock.now()
        self._lock = RLock()

    @property
    def sheet(self) -> DrawnSheet:
        """The sheet on the machine."""
        return self.sheets[-1]

    @property
    def next_event(self) -> float:
        """When something happens by itself, s; infinite for never."""
        return min(self.line.next_event, self.device.next_event)

    @property
    def queued(self) -> int:
        """Bytes given to the line that are not yet on their way."""
        return len(self.line.queue)

    @property
    def waiting(self) -> int:
        """Bytes that have reached the host and are not yet read."""
        self.advance()
        return len(self._heard)

    @property
    def appetite(self) -> int:
        """Bytes that a host's UART would take from its driver now."""
        if self.line.held:
            return 0
        return max(_FIFO, int(_AHEAD / self.line.byte_time)) - self.queued

    def watch(self, instructions: Sequence[bytes], reserve: int) -> Gauge:
        """Measure from now on how well the line is used for these instructions."""
        with self._lock:
            self.advance()
            self.gauge, self._written = Gauge(instructions, reserve), 0
            self._arrived_before = len(self.device.traffic.program)
            return self.gauge

    def write(self, data: bytes) -> None:
        """Put bytes on the line, as the host does."""
        with self._lock:
            self.advance()
            program = sum(isinstance(self._scanner.feed(byte), int) for byte in data)
            self._written += program
            self.gauge.use.program += program
            self.gauge.use.questions += len(data) - program
            self.line.put(data, self._now)

    def read(self, size: int | None = None) -> bytes:
        """Take bytes that have reached the host; at most ``size``."""
        with self._lock:
            self.advance()
            taken = bytes(self._heard[:size])
            del self._heard[: len(taken)]
            return taken

    def discard_output(self) -> None:
        """Drop what the host has not yet put on the line."""
        with self._lock:
            self.advance()
            self._written -= len(self.line.queue)
            self.line.queue.clear()
            self._scanner = ControlChannel()

    def lift_xoff(self) -> None:
        """Let the host send again although the machine said XOFF."""
        with self._lock:
            self.advance()
            self.line.release(self._now)

    def flip(self) -> None:
        """Turn the sheet over, once the machine has come to rest; raises as ``rest``."""
        self.rest()
        with self._lock:
            self.sheet.flip()

    def new_sheet(self) -> None:
        """Lay a new sheet on the machine, once it has come to rest; raises as ``rest``."""
        self.rest()
        with self._lock:
            self.sheets.append(DrawnSheet())
            self.device.carriage.sheet = self.sheet

    def pause(self) -> None:
        """Press the pause key: what is being executed ends, nothing else begins."""
        with self._lock:
            self.advance()
            self.device.paused = True

    def resume(self) -> None:
        """Press the pause key again."""
        with self._lock:
            self.advance()
            self.device.resume(self._now)

    def rest(self) -> None:
        """Wait until the machine has done all it has been given.

        Raises PlotterError where it then stands with the tool down, is paused or has gone silent.
        """
        self.advance()
        while self.next_event < inf:
            self.clock.sleep_until(self.next_event)
            self.advance()
        device = self.device
        if device.carriage.down or device.paused or device.dead:
            why = "paused" if device.paused else "silent" if device.dead else "standing, tool down"
            raise PlotterError(
                f"The simulated plotter has not finished: it is {why}. Finish or stop the program "
                "before the sheet is touched."
            )

    def status(self) -> str:
        """Describe it in one line, for a person."""
        self.advance()
        device, traffic, tally = self.device, self.device.traffic, self.device.carriage.tally
        x, y = device.carriage.at
        drawn = ", ".join(f"{len(self.sheet.strokes[face])} on the {face}" for face in Face)
        return (
            f"{self.machine.slug}: {'at rest' if device.idle else 'moving'} at {x},{y}; sheet "
            f"{len(self.sheets)}, {self.sheet.up} up, strokes: {drawn}; {len(traffic.received)} "
            f"bytes received, fullest {traffic.fullest} of {device.size}, {traffic.overruns} lost, "
            f"{tally.errors} errors, {tally.second_in} IN inside a job"
        )

    def advance(self) -> None:
        """Let everything happen up to the clock's time."""
        with self._lock:
            until = self.clock.now()
            while True:
                sending, working = self.line.next_event, self.device.next_event
                event = min(sending, working)
                if event > until:
                    break
                self._pass(event)
                if sending <= event:
                    self._arrive(self.line.happen(event))
                if working <= event:
                    self._return(self.device.happen(event))
            self._pass(until)

    def _pass(self, until: float) -> None:
        spent, self._now = until - self._now, max(until, self._now)
        if spent <= 0:
            return
        if self.line.sending:
            self.gauge.use.busy += spent
        elif self._has_room():
            self.gauge.use.missed += spent

    def _has_room(self) -> bool:
        needs = self.gauge.needs(self._written)
        if needs is None:
            return False
        if self.machine.serial.handshake == "xon-xoff":
            return not self.device.holds
        on_line = self._written + self._arrived_before - len(self.device.traffic.program)
        return self.device.free - on_line >= needs

    def _arrive(self, byte: int | None) -> None:
        if byte is None:
            return
        if self.baud == self.machine.serial.baud:
            self.device.receive(byte, self._now)
        else:
            self.device.garble()

    def _return(self, byte: int | None) -> None:
        if byte is None:
            return
        if self.honours_xoff and byte in (XON, XOFF):
            if byte == XOFF:
                self.line.hold(_FIFO)
            else:
                self.line.release(self._now)
        else:
            self._heard.append(byte)
