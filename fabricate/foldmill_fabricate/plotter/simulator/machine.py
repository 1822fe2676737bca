"""The whole stand-in: a device, the two directions of its line, a clock, and a sheet under it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf
from threading import RLock

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import Clock, VirtualClock
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.simulator.agreement import XOFF, XON
from foldmill_fabricate.plotter.simulator.device import Device
from foldmill_fabricate.plotter.simulator.drawing import PERFECT, DrawnSheet, Imperfection
from foldmill_fabricate.plotter.simulator.faults import Fault
from foldmill_fabricate.plotter.simulator.firmwares import firmware_of
from foldmill_fabricate.plotter.simulator.gauge import Gauge
from foldmill_fabricate.plotter.simulator.modem import Modem, Wiring
from foldmill_fabricate.plotter.simulator.quirks import Quirk
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
        faults: Iterable[Fault] = (),
        quirks: Iterable[Quirk] = (),
        wiring: Wiring = Wiring.FULL,
        imperfection: Imperfection = PERFECT,
    ) -> None:
        self.machine, self.imperfection = machine, imperfection
        self.clock = clock or VirtualClock()
        self.sheets = [DrawnSheet(imperfection=imperfection)]
        byte_time = 10 / machine.serial.baud
        self.device = Device(machine, self.sheet, firmware_of, byte_time, speed_up, faults, quirks)
        self.modem = Modem(self.device, wiring)
        """The handshake lines."""
        self.line = Transmitter(byte_time)
        """From the host to the machine."""
        self.honours_xoff = True
        """Whether the host's end of the line stops at XOFF; set by whoever opens it."""
        self.honours_cts = False
        """Whether it stops at a low CTS."""
        self.visit = 0
        """How often the cable was pulled: a port that was opened before is dead."""
        self.unplugged = False
        """Whether the cable is out."""
        self.baud = machine.serial.baud
        """Rate of the host's end; another than the machine's garbles every byte."""
        self.gauge = Gauge((), 0)
        self._heard = bytearray()
        self._written = self._arrived_before = self._begun_before = 0
        self._scanner = self.device.firmware.scanner()
        self._now = self.clock.now()
        self._lock = RLock()
        self._stops: set[str] = set()
        """Why the host's end does not send."""
        self.device.firmware.start(self._now)

    @property
    def sheet(self) -> DrawnSheet:
        """The sheet on the machine."""
        return self.sheets[-1]

    @property
    def next_event(self) -> float:
        """When something happens by itself, a fault included, s; infinite for never."""
        return min(self.line.next_event, self.device.next_event)

    @property
    def queued(self) -> int:
        """Bytes given to the line that are not yet on their way."""
        return len(self.line.queue)

    @property
    def waiting(self) -> int:
        """Bytes that have reached the host and are not yet read."""
        self.advance()
        return self.heard

    @property
    def heard(self) -> int:
        """The same of the moment it was last brought to: nothing happens by asking."""
        return len(self._heard)

    @property
    def appetite(self) -> int:
        """Bytes that a host's UART would take from its driver now."""
        if self.line.held:
            return 0
        return max(_FIFO, int(_AHEAD / self.line.byte_time)) - self.queued

    def watch(
        self,
        instructions: Sequence[bytes],
        reserve: int,
        motion: Sequence[tuple[float, int]] = (),
    ) -> Gauge:
        """Measure from now on how well the line is used for these instructions.

        motion : the seconds and the stroke of each, where what is in flight is limited by them.
        """
        with self._lock:
            self.advance()
            self.gauge, self._written = Gauge(instructions, reserve, motion), 0
            self._begun_before = self.device.traffic.begun
            self._arrived_before = len(self.device.traffic.program)
            return self.gauge

    def write(self, data: bytes) -> None:
        """Put bytes on the line, as the host does."""
        with self._lock:
            self.advance()
            if not self.device.connected:
                return
            self._sense()
            program = sum(map(self._scanner, data))
            self._written += program
            self.gauge.written(data, program)
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
            self._scanner = self.device.firmware.scanner()

    def lift_xoff(self) -> None:
        """Let the host send again although the machine said XOFF."""
        with self._lock:
            self.advance()
            self._let("xoff")

    def hold_line(self, stop: bool) -> None:
        """Stop the host's end, or let it go on, as its own program says."""
        with self._lock:
            self.advance()
            self._stop("host", 0) if stop else self._let("host")

    def set_rts(self, level: bool) -> None:
        """Set the host's RTS: False for "do not send to me"."""
        with self._lock:
            self.advance()
            self.modem.set_rts(level, self._now)

    def set_dtr(self, level: bool) -> None:
        """Set the host's DTR: True for "I am here"."""
        with self._lock:
            self.advance()
            self.modem.set_dtr(level, self._now)

    def flip(self) -> None:
        """Turn the sheet over, once the machine has come to rest; raises as ``rest``."""
        self.rest()
        with self._lock:
            self.sheet.flip()

    def new_sheet(self) -> None:
        """Lay a new sheet on the machine, once it has come to rest; raises as ``rest``."""
        self.rest()
        with self._lock:
            self.sheets.append(DrawnSheet(imperfection=self.imperfection))
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

    def fail(self, faults: Iterable[Fault]) -> None:
        """Let more go wrong, at once where its place has been passed."""
        with self._lock:
            self.advance()
            self.device.fail(faults, self._now)
            self._sense()

    def rest(self) -> None:
        """Wait until the machine has done all it has been given.

        Raises PlotterError where it then stands with the tool down, is paused or has gone silent.
        """
        self.advance()
        while (event := min(self.line.next_event, self.device.next_own_event)) < inf:
            self.clock.sleep_until(event)
            self.advance()
        why = self._unrest()
        if why:
            raise PlotterError(
                f"The simulated plotter has not finished: it is {why}. Finish or stop the program "
                "before the sheet is touched."
            )

    def _unrest(self) -> str:
        device = self.device
        reasons = {
            "without power": not device.powered,
            "silent": device.dead,
            "paused": device.paused,
            "halted within a line": device.halted,
            "waiting for its lever": device.lever_up,
            "standing, tool down": device.carriage.down,
        }
        return next((why for why, true in reasons.items() if true), "")

    def status(self) -> str:
        """Describe it in one line, for a person."""
        self.advance()
        device, traffic, tally = self.device, self.device.traffic, self.device.carriage.tally
        x, y = device.carriage.at
        drawn = ", ".join(f"{len(self.sheet.strokes[face])} on the {face}" for face in Face)
        return (
            f"{self.machine.slug}: {self.doing} at {x},{y}; sheet "
            f"{len(self.sheets)}, {self.sheet.up} up, strokes: {drawn}; {len(traffic.received)} "
            f"bytes received, fullest {traffic.fullest} of {device.size}, {traffic.overruns} lost, "
            f"{tally.errors} errors, {tally.second_in} IN inside a job"
        )

    @property
    def doing(self) -> str:
        """What it does, in a word or two."""
        why = self._unrest()
        if why and why != "standing, tool down":
            return why
        return "at rest" if self.device.idle else "moving"

    def advance(self) -> float:
        """Let everything happen up to the clock's time; return when the next thing will, s."""
        with self._lock:
            until = self.clock.now()
            while True:
                sending, working = self.line.next_event, self.device.next_event
                event = min(working, sending)
                if event > until:
                    break
                if sending < working and self._take_run(until, working):
                    continue
                self._pass(event)
                if sending <= event:
                    self._arrive(self.line.happen(event))
                if working <= event:
                    self._return(self.device.happen(event))
                if self.honours_cts or self.device.active or self.unplugged:
                    self._sense()
            if until > self._now:
                self._pass(until)
            return event

    def _take_run(self, until: float, before: float) -> bool:
        """Let plain bytes arrive in one go, up to ``until`` and before something else happens.

        Return whether any did.
        """
        line = self.line
        if line.held or line.urgent or self.honours_cts or self.unplugged:
            return False
        if line.done == inf or self.baud != self.machine.serial.baud:
            return False
        plain = self.device.plain
        taken, last = line.run(plain.bytes, plain.most, until, before)
        if taken:
            self.gauge.use.busy += last - self._now
            self._now = last
            self.device.receive_plain(bytes(taken), last)
        return bool(taken)

    def _sense(self) -> None:
        """Look at the cable, and at CTS where the host's end obeys it."""
        if self.unplugged == self.device.connected:
            self.unplugged = not self.device.connected
            if self.unplugged:
                self.visit += 1
                self.line.silence()
                self._heard.clear()
        blocked = self.honours_cts and not self.modem.cts
        if blocked and "cts" not in self._stops:
            self._stop("cts", _FIFO)
        elif not blocked and "cts" in self._stops:
            self._let("cts")

    def _stop(self, why: str, grace: int) -> None:
        """Stop but for what is in the chip already, ``grace`` bytes of it at most."""
        self._stops.add(why)
        self.line.hold(min(grace, len(self.line.queue)))

    def _let(self, why: str) -> None:
        self._stops.discard(why)
        if not self._stops:
            self.line.release(self._now)

    def _pass(self, until: float) -> None:
        spent, self._now = until - self._now, max(until, self._now)
        if spent <= 0:
            return
        if self.line.sending:
            self.gauge.use.busy += spent
        elif self._has_room():
            self.gauge.missed(spent, self.device.traffic.begun - self._begun_before)

    def _has_room(self) -> bool:
        needs = self.gauge.needs()
        if needs is None:
            return False
        if self.machine.serial.handshake == "xon-xoff":
            return not self.device.holds
        if self.machine.serial.handshake in ("rts-cts", "dtr"):
            return self.device.ready
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
        if byte is None or self.unplugged:
            return
        if self.honours_xoff and byte in (XON, XOFF):
            if byte == XOFF:
                self._stop("xoff", _FIFO)
            else:
                self._let("xoff")
        else:
            self._heard.append(byte)
