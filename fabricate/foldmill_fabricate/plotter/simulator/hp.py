"""The firmware of an HP-GL machine: device control, flow control, HP-GL in parse order."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

from foldmill_fabricate.plotter.simulator.agreement import ACK, ENQ, Agreement
from foldmill_fabricate.plotter.simulator.control import (
    ESC,
    HP_7475,
    HP_7550,
    PARAMETER_RANGE,
    Command,
    ControlChannel,
)
from foldmill_fabricate.plotter.simulator.firmware import OVERFLOW, OVERLAP, Plain
from foldmill_fabricate.plotter.simulator.hpgl import Hpgl
from foldmill_fabricate.plotter.simulator.parser import ENDS, UNKNOWN, Parser
from foldmill_fabricate.plotter.simulator.quirks import Quirk

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.simulator.device import Device

_LAST_CHARACTER = 126
_ANSWER_TIME = 0.002
"""s from a question's last byte to the answer's first."""

_BLANK = bytes(range(0x21))
"""Bytes between which no instruction is."""


@cache
def _plain(signs: frozenset[int], idle: bool) -> frozenset[int]:
    """Return the bytes that are no signs; to a machine that waits, ends of units are."""
    return frozenset(range(256)) - signs - (ENDS if idle else frozenset())


class HpFirmware:
    """Listens to device control at once, and to HP-GL when its turn comes."""

    def __init__(self, device: Device, quirks: frozenset[Quirk]) -> None:
        self._device, self._quirks = device, quirks
        extended = device.machine.dialect.controls == "hp-7550"
        self._letters = HP_7550 if extended else HP_7475
        self._stuck = False
        self._clear()

    def start(self, now: float) -> None:  # noqa: ARG002
        """Begin with the defaults of the profile."""
        self._clear()

    def _clear(self) -> None:
        device = self._device
        self.agreement = Agreement.built_in(device.machine)
        self._hpgl = Hpgl(device.machine, device.carriage, self._quirks)
        self._parser, self._control = Parser(), ControlChannel(self._letters)
        self._on = True
        self._io_error = 0
        self._size_asked = self._inside = self._held = self._enquired = self._garbled = False
        self._kept_back: list[str] = []
        self._last = b""

    @property
    def holds(self) -> bool:
        """Whether it has sent XOFF and no XON since."""
        return self._held

    @property
    def ready(self) -> bool:
        """Level of the ready line."""
        if self._stuck:
            return False
        return not self.agreement.hardware or self._device.free > self.agreement.low

    def scanner(self) -> Callable[[int], bool]:
        """Return a function that tells device control from HP-GL."""
        control = ControlChannel(self._letters)
        return lambda byte: isinstance(control.feed(byte), int)

    def hear(self, byte: int, now: float) -> None:
        """Take a byte off the line."""
        heard = self._control.feed(byte)
        if isinstance(heard, Command):
            self._obey(heard, now)
        elif heard is None or not self._on:
            return
        elif heard == self.agreement.trigger and heard:
            self._send_kept()
        elif heard == (self.agreement.enq or ENQ):
            self._enquire(now)
        else:
            self._store(heard, now)

    @property
    def plain(self) -> Plain:
        """Bytes that go into the buffer and begin nothing."""
        device, agreed = self._device, self.agreement
        watchful = self._garbled or Quirk.SECOND_IN_CANCELS in self._quirks
        if watchful or not self._on or self._control.under_way:
            return Plain()
        kept = agreed.low if agreed.xon and agreed.xoff and not self._held else 0
        signs = frozenset((ESC, agreed.enq or ENQ, agreed.trigger))
        return Plain(_plain(signs, device.idle), device.free - kept - 1)

    def hear_plain(self, data: bytes) -> None:
        """Keep them."""
        ended = max(data.rfind(b";"), data.rfind(b"\x03"))
        behind = data[ended + 1 :].translate(None, _BLANK)
        self._inside = bool(behind) or (self._inside and ended < 0)
        self._device.buffer.store_all(data)

    def begin(self, now: float) -> float | None:
        """Begin the next unit. It frees its bytes then: it is decoded."""
        buffer = self._device.buffer
        before = len(buffer.data)
        unit = self._parser.take(buffer.data)
        buffer.traffic.begun += before - len(buffer.data)
        if unit is None:
            if buffer.free > 0:
                return None
            buffer.discard()  # it is full and holds no whole instruction: it never will
            self._parser.reset()
            self._device.carriage.wrong(UNKNOWN)
            return 0.0
        outcome = self._hpgl.execute(unit)
        if outcome.reply is not None:
            self._say(outcome.reply, now)
        return outcome.seconds

    def ended(self, now: float) -> None:
        """Nothing is to be said."""

    def settle(self, now: float) -> None:
        """Send XON, an ACK or the buffer's size, if they are due."""
        device = self._device
        self._let_go(now)
        if self._enquired and device.free >= self.agreement.block and not self._stuck:
            self._enquired = False
            device.out.put(self.agreement.acks, now)
        if self._size_asked and not device.buffer.data:
            self._size_asked = False
            self._say(str(device.size), now)

    def fault(self, error: int) -> None:
        """Note an I/O error until ESC.E asks for it."""
        self._io_error = error
        self._device.traffic.errors[error] += 1

    def wait(self, stuck: bool, now: float) -> None:
        """Say "wait", and nothing else until it is no longer stuck."""
        self._stuck = stuck
        if stuck and not self._held:
            self._held = True
            self._device.out.put_first(self.agreement.xoff or 0x13, now)
        elif not stuck:
            self.settle(now)

    def _store(self, byte: int, now: float) -> None:
        device = self._device
        self._inside = byte not in b";\x03" and (self._inside or byte > 0x20)
        if self._garbled:
            self._garbled = False
            return
        if not device.buffer.store(byte):
            self.fault(OVERFLOW)
            return
        if Quirk.SECOND_IN_CANCELS in self._quirks:
            self._watch_for_in(byte)
        if device.idle and (byte in ENDS or not device.free):
            device.work(now)
        self._hold(now)

    def _watch_for_in(self, byte: int) -> None:
        """An IN takes effect as it arrives, and what waits is lost."""
        self._last = (self._last + bytes((byte,)))[-3:].upper()
        if self._last == b"IN;" and self._device.buffer.data[:-3].strip():
            self._device.buffer.discard(but=3)
            self._parser.reset()

    @property
    def _speaking(self) -> bool:
        out = self._device.out
        return bool(out.queue) or out.sending or self._size_asked

    def _say(self, text: str, now: float) -> None:
        if not self._device.machine.serial.answers:
            return
        if self.agreement.trigger:
            self._kept_back.append(text)
        else:
            self._send(text, now)

    def _send(self, text: str, now: float) -> None:
        agreed, out = self.agreement, self._device.out
        out.not_before = now + _ANSWER_TIME + agreed.delay
        out.between = agreed.between
        begins = bytes((agreed.begins,)) if agreed.begins else b""
        out.put(begins + text.encode() + bytes(agreed.ends), now)

    def _send_kept(self) -> None:
        if self._kept_back:
            self._send(self._kept_back.pop(0), self._device.now)

    def _answer(self, text: str, now: float) -> None:
        """Answer device control; a question while an answer is under way is error 10."""
        if self._speaking:
            self.fault(OVERLAP)
        else:
            self._say(text, now)

    def _enquire(self, now: float) -> None:
        """Without an ENQ of its own the machine acknowledges each at once: the dummy handshake."""
        agreed, device = self.agreement, self._device
        if not agreed.enq:
            device.out.put((ACK,), now)
            return
        self._enquired = True
        if device.free < agreed.block and agreed.mode == 2:
            device.out.put(agreed.immediate, now)
        self.settle(now)

    def _obey(self, command: Command, now: float) -> None:
        if command.error:
            self.fault(command.error)
        elif not self._on and command.letter not in "(Y":
            return
        elif command.letter in "ABELOS":
            self._tell(command.letter, now)
        elif command.letter == "J":
            self._device.out.queue.clear()
            self._kept_back.clear()
            self._size_asked = False
        elif command.letter == "K":
            self._forget(now)
        elif command.letter == "R":
            self.agreement = Agreement.built_in(self._device.machine)
        elif command.letter in "@HIMNP":
            self._agree(command)
        elif command.letter in "(Y)Z":
            self._on = command.letter in "(Y"

    def _agree(self, command: Command) -> None:
        """Set a handshake; behind the first parameter of H, I, M and N stand characters."""
        if command.letter in "HIMN" and max(command.parameters[1:], default=0) > _LAST_CHARACTER:
            self.fault(PARAMETER_RANGE)
            return
        self.agreement.obey(command.letter, command.parameters)
        size = self._device.size
        self.agreement.block = min(self.agreement.block, size // 2)
        self.agreement.low = min(self.agreement.low, size // 2)

    def _tell(self, letter: str, now: float) -> None:
        device = self._device
        if letter == "B":
            device.traffic.split += self._inside
            self._garbled |= self._inside and Quirk.SPLIT_GARBLES in self._quirks
            self._answer(str(device.free), now)
        elif letter == "E":
            self._answer(str(self._io_error), now)
            self._io_error = 0
        elif letter == "O":
            status = 0 if device.buffer.data else 8
            self._answer(str(status + 16 * device.paused + 32 * device.lever_up), now)
        elif letter in "AS":
            self._answer(device.machine.slug if letter == "A" else str(device.size), now)
        elif self._speaking:
            self.fault(OVERLAP)
        elif device.buffer.data:
            self._size_asked = True  # answered once the buffer is empty
        else:
            self._say(str(device.size), now)

    def _forget(self, now: float) -> None:
        """ESC.K: drop what is not being executed."""
        self._device.buffer.discard()
        self._parser.reset()
        self._inside = False
        self._device.work(now)

    def _hold(self, now: float) -> None:
        agreed = self.agreement
        full = self._device.free <= agreed.low
        if agreed.xon and agreed.xoff and not self._held and full:
            self._held = True
            self._device.out.put_first(agreed.xoff, now)

    def _let_go(self, now: float) -> None:
        if not self._held or self._stuck:
            return
        size, agreed = self._device.size, self.agreement
        if self._device.free >= max(size // 2, agreed.low + 1):
            self._held = False
            self._device.out.put_first(agreed.xon or 0x11, now)
