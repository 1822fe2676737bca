"""The machine behind the line: its buffer, its time, its mains and its faults.

What the bytes mean is the business of its firmware; this is the frame that all languages share.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import inf
from random import Random

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.buffer import InputBuffer, Traffic
from foldmill_fabricate.plotter.simulator.carriage import Carriage
from foldmill_fabricate.plotter.simulator.drawing import DrawnSheet
from foldmill_fabricate.plotter.simulator.faults import Fault, Schedule, Trouble
from foldmill_fabricate.plotter.simulator.firmware import FRAMING, Firmware, Plain
from foldmill_fabricate.plotter.simulator.hpgl import LEVER_UP
from foldmill_fabricate.plotter.simulator.quirks import Quirk, habits
from foldmill_fabricate.plotter.simulator.uart import Transmitter

_DEAD = frozenset({Trouble.SILENCE, Trouble.POWER})
_FLIPPED = 0x04
"""The bit that noise flips."""


class Device:
    """A machine with a byte-accurate input buffer. Times are seconds of the clock it is run by."""

    def __init__(
        self,
        machine: Machine,
        sheet: DrawnSheet,
        firmware: Callable[[Device, frozenset[Quirk]], Firmware],
        byte_time: float,
        speed_up: float = 1.0,
        faults: Iterable[Fault] = (),
        quirks: Iterable[Quirk] = (),
    ) -> None:
        """Build it; firmware : makes what takes its bytes, of the device and its quirks."""
        self.machine, self.traffic = machine, Traffic()
        self.buffer = InputBuffer(machine.serial.buffer, self.traffic)
        self.carriage = Carriage(machine, sheet)
        self.out = Transmitter(byte_time)
        self.schedule = Schedule(faults)
        self.active: set[Trouble] = set()
        """Faults that are there now."""
        self.paused = False
        self.now = 0.0
        self._rate = 1 / speed_up
        self._slower = self._scale = 1.0
        """How many times longer things take; what is under way took its scale when it began."""
        self._began, self._busy_until = -inf, -inf
        self._rest: dict[str, float] = {}
        """Why the carriage is halted within a line → s of that line still to come."""
        self._damage: dict[Trouble, int] = {}
        self.firmware = firmware(self, frozenset(quirks) | habits(machine))

    @property
    def size(self) -> int:
        """Bytes that the buffer holds."""
        return self.buffer.size

    @property
    def free(self) -> int:
        """Bytes that the buffer still takes."""
        return self.buffer.size - len(self.buffer.data)

    @property
    def holds(self) -> bool:
        """Whether it has said "wait" by a character and not "go on" since."""
        return self.firmware.holds

    @property
    def idle(self) -> bool:
        """Whether nothing moves or is halted on its way."""
        return self._busy_until == -inf

    @property
    def halted(self) -> bool:
        """Whether the carriage stands within a line."""
        return bool(self._rest)

    @property
    def dead(self) -> bool:
        """Whether it neither moves nor hears."""
        return bool(self.active) and not self.active.isdisjoint(_DEAD)

    @property
    def powered(self) -> bool:
        """Whether it has power."""
        return Trouble.POWER not in self.active

    @property
    def connected(self) -> bool:
        """Whether its cable is plugged in."""
        return Trouble.DISCONNECT not in self.active

    @property
    def lever_up(self) -> bool:
        """Whether the pinch wheels are off the sheet."""
        return Trouble.LEVER in self.active

    @property
    def ready(self) -> bool:
        """Level of the line by which it says that it has room."""
        return self.powered and self.firmware.ready

    @property
    def next_own_event(self) -> float:
        """When something happens that is under way, s; infinite for never."""
        busy = self._busy_until if self._busy_until > -inf and not self._rest else inf
        if not self.active:
            return min(busy, self.out.next_event)
        ends = self.schedule.next_end
        return ends if self.dead else min(busy, self.out.next_event, ends)

    @property
    def next_event(self) -> float:
        """When something happens here by itself, a fault to come included, s."""
        if not self.active and not self.schedule.waiting:  # asked between any two events
            busy, said = self._busy_until, self.out.done
            said = said if said < inf else self.out.next_event
            return said if busy == -inf or said < busy or self._rest else busy
        own = self.next_own_event
        return min(own, self.schedule.next_begin) if self.schedule.waiting else own

    @property
    def spent(self) -> float:
        """Seconds of the machine's own time since it began what it does."""
        rest = next(iter(self._rest.values()), max(0.0, self._busy_until - self.now))
        return (self._busy_until - self._began - rest) / self._scale

    @property
    def lasting(self) -> float:
        """Seconds of the machine's own time that what it does takes in all."""
        return 0.0 if self.idle else (self._busy_until - self._began) / self._scale

    def happen(self, now: float) -> int | None:
        """Do what is due; return a byte that has reached the host, or None."""
        self.now = now
        if self.schedule.waiting or self.active:
            self._meet(now)
        if self.dead:
            return None
        sent = self.out.happen(now) if self.out.next_event <= now else None
        if -inf < self._busy_until <= now and not self._rest:
            self.work(now)
        return None if Trouble.MUTE in self.active else sent

    def receive(self, byte: int, now: float) -> None:
        """Take one byte off the line."""
        self.now = now
        if self.dead:
            return
        self.traffic.received.append(byte)
        heard = self._damaged(byte) if self._damage else byte
        if heard is not None:
            self.firmware.hear(heard, now)
        if self.schedule.waiting:
            self._meet(now)

    @property
    def plain(self) -> Plain:
        """What it takes off the line now without anything else happening."""
        if self.active or self._damage or self.schedule.waiting or self.buffer.dropping:
            return Plain()
        return self.firmware.plain

    def receive_plain(self, data: bytes, now: float) -> None:
        """Take such bytes off the line, the last of them now."""
        self.now = now
        self.traffic.received += data
        self.firmware.hear_plain(data)

    def garble(self) -> None:
        """Note a byte that came at another rate than the machine's."""
        self.firmware.fault(FRAMING)

    def fail(self, faults: Iterable[Fault], now: float) -> None:
        """Let more go wrong, at once where its place has been passed."""
        self.now = now
        self.schedule.add(faults)
        self._meet(now)

    def resume(self, now: float) -> None:
        """Go on after a pause at the machine."""
        self.paused = False
        self.work(now)

    def work(self, now: float) -> None:
        """Begin whatever can begin."""
        if -inf < self._busy_until <= now and not self._rest:
            self._busy_until = -inf
            self.firmware.ended(now)
        while self._busy_until == -inf and not self._stands:
            seconds = self.firmware.begin(now)
            if seconds is None:
                break
            if seconds > 0:
                self._began, self._scale = now, self._rate * self._slower
                self._busy_until = now + seconds * self._scale
            else:
                self.firmware.ended(now)
            if self.schedule.waiting:
                self._foresee(now)
        self.firmware.settle(now)

    def halt(self, why: str, now: float) -> None:
        """Stand where the carriage is, within a line if it must be."""
        moving = self._busy_until > now
        if moving and not self._rest:
            self.carriage.halt(self.spent)
        self._rest[why] = next(iter(self._rest.values()), max(0.0, self._busy_until - now))

    def go_on(self, why: str, now: float) -> None:
        """Go on, unless there is another reason to stand."""
        rest = self._rest.pop(why, None)
        if rest is None or self._rest:
            return
        if self._busy_until > -inf:
            self.carriage.go_on()
            self._began += now + rest - self._busy_until
            self._busy_until = now + rest
        self.work(now)

    def drop(self) -> None:
        """Give up what is being done; the carriage stands where it is."""
        if self._busy_until > self.now and not self._rest:
            self.carriage.halt(self.spent)
        self.carriage.begin()
        self._busy_until = -inf
        self._rest.clear()

    @property
    def _stands(self) -> bool:
        return self.paused or bool(self._rest) or self.lever_up or self.dead

    def _foresee(self, now: float) -> None:
        """Place in time what shall happen within this line, and meet what is due by strokes."""
        line = self.carriage.line
        if line and self.carriage.down and self._busy_until > now:
            begins, seconds = now + line.lead * self._scale, line.seconds * self._scale
            self.schedule.line_begins(self.carriage.tally.strokes, begins, seconds)
        self._meet(now)

    def _meet(self, now: float) -> None:
        for fault in self.schedule.over(now):
            self._end(fault, now)
        received, program = len(self.traffic.received), len(self.traffic.program)
        for fault in self.schedule.due(received, program, self.carriage.tally.strokes, now):
            self._strike(fault, now)

    def _strike(self, fault: Fault, now: float) -> None:
        trouble = fault.trouble
        if trouble is Trouble.GARBAGE:
            self.out.put(Random(str(fault)).randbytes(int(fault.amount)), now)
        elif trouble is Trouble.OVERFLOW:
            self.buffer.dropping += int(fault.amount)
        elif trouble in (Trouble.NOISE, Trouble.FRAMING):
            self._damage[trouble] = self._damage.get(trouble, 0) + int(fault.amount)
        else:
            self._begin(fault, now)

    def _begin(self, fault: Fault, now: float) -> None:
        trouble = fault.trouble
        if trouble is Trouble.STALL:
            self.halt(trouble, now)
        elif trouble is Trouble.HOLD:
            self.firmware.wait(True, now)
        elif trouble is Trouble.LEVER:
            self.carriage.error = LEVER_UP
        elif trouble is Trouble.SLOW:
            self._slower = fault.amount
        elif trouble is Trouble.POWER:
            self._lose_power()
        self.active.add(trouble)

    def _end(self, fault: Fault, now: float) -> None:
        trouble = fault.trouble
        self.active.discard(trouble)
        if trouble is Trouble.STALL:
            self.go_on(trouble, now)
        elif trouble is Trouble.HOLD:
            self.firmware.wait(False, now)
        elif trouble is Trouble.SLOW:
            self._slower = 1.0
        elif trouble is Trouble.POWER:
            self.firmware.start(now)
        self.work(now)

    def _lose_power(self) -> None:
        self.drop()
        self.carriage.fail()
        self.buffer.discard()
        self.out.silence()
        self.carriage.home()

    def _damaged(self, byte: int) -> int | None:
        """Return what is left of a byte on a bad line."""
        trouble = next(iter(self._damage))
        self._damage[trouble] -= 1
        if self._damage[trouble] <= 0:
            del self._damage[trouble]
        if trouble is Trouble.NOISE:
            return byte ^ _FLIPPED
        self.firmware.fault(FRAMING)
        return None
