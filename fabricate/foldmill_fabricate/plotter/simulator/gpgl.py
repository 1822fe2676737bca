"""The firmware of a GP-GL machine, as Graphtec's and Silhouette's cutters.

Commands end with ETX (3). ``M`` moves and ``D`` draws to absolute places, ``O`` and ``E`` by
differences, ``H`` and ``TT`` go home; ``J`` takes a tool, ``!`` a speed and ``FX`` a force in the
machine's own units. ``FG`` tells the name, ``TB71`` and ``FA`` numbers, ``FC`` … are taken as read.
ESC EOT starts anew; ESC ENQ is answered at once: 0 ready, 1 moving, 2 nothing loaded. Answers end
with ETX. There is no other handshake and no error that could be asked for.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING

from foldmill_fabricate.plotter.simulator.firmware import Careful

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.simulator.device import Device

ETX, EOT, ENQ, ESC = 3, 4, 5, 0x1B
_NUMBERS = re.compile(r"[+-]?\d{1,9}(?:\.\d{0,9})?(?:,[+-]?\d{1,9}(?:\.\d{0,9})?)*")
_COMMAND = re.compile(r"([MDOEHJ!]|[FTSRCL][A-Z&]?|[A-Z\\&\[^Z])(.*)")
_LONGEST = 1 << 16
"""Bytes of one command."""


class GpglFirmware(Careful):
    """Takes whole commands, and draws them leg by leg."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._stuck = False
        self._clear()

    def start(self, now: float) -> None:  # noqa: ARG002
        """Begin as after switching on."""
        self._clear()

    def _clear(self) -> None:
        self._escape = False
        self._command = bytearray()
        self._legs: deque[tuple[bool, bool, tuple[float, float]]] = deque()
        """(draws, by differences, (x, y)) of the command that is executed."""

    @property
    def holds(self) -> bool:
        """It never says "wait" by a character."""
        return False

    @property
    def ready(self) -> bool:
        """Level of the ready line: the USB of such a machine stops its host by it."""
        return self._device.free > min(128, self._device.size // 4) and not self._stuck

    def wait(self, stuck: bool, now: float) -> None:  # noqa: ARG002
        """Tell "moving" for as long as it is stuck."""
        self._stuck = stuck

    def fault(self, error: int) -> None:
        """Count it; GP-GL does not tell."""
        self._device.traffic.errors[error] += 1

    def scanner(self) -> Callable[[int], bool]:
        """Return a function that tells ESC and what follows from the program."""
        escaped = [False]

        def program(byte: int) -> bool:
            was, escaped[0] = escaped[0], byte == ESC
            return not (was or escaped[0])

        return program

    def hear(self, byte: int, now: float) -> None:
        """Take a byte: ESC sequences at once, the rest into the buffer."""
        if byte == ESC:
            self._escape = True
        elif self._escape:
            self._escape = False
            self._control(byte, now)
        else:
            if not self._device.buffer.store(byte):
                self.fault(16)
            if self._device.idle:
                self._device.work(now)

    def begin(self, now: float) -> float | None:
        """Begin the next leg, or the next command."""
        if self._legs:
            return self._go(*self._legs.popleft())
        data, traffic = self._device.buffer.data, self._device.traffic
        end = data.find(ETX)
        taken = len(data) if end < 0 else end + 1
        self._command += data[:taken]
        del data[:taken]
        traffic.begun += taken
        if len(self._command) > _LONGEST:
            self._command.clear()
            self._device.carriage.wrong(2)
        if end < 0:
            return None
        text = self._command[:-1].translate(None, b"\r\n").decode("latin-1")
        self._command.clear()
        return self._execute(text, now)

    def ended(self, now: float) -> None:
        """Nothing is to be said."""

    def settle(self, now: float) -> None:
        """Nothing is to be said."""

    def _say(self, text: str, now: float) -> None:
        self._device.out.put(text.encode("latin-1") + bytes((ETX,)), now)

    def _control(self, byte: int, now: float) -> None:
        if byte == ENQ:
            moving = not self._device.idle or bool(self._legs) or bool(self._device.buffer.data)
            loaded = not self._device.lever_up
            self._say(("1" if moving or self._stuck else "0") if loaded else "2", now)
        elif byte == EOT:
            self._device.buffer.discard()
            self._clear()
            self._device.carriage.set_pen(False)

    def _execute(self, text: str, now: float) -> float:
        carriage = self._device.carriage
        carriage.tally.units += 1
        carriage.begin()
        found = _COMMAND.fullmatch(text)
        if not found:
            if text:
                carriage.wrong(1)
            return 0.0
        name, rest = found[1], found[2]
        if name in ("FG", "TB", "FA"):
            answer = f"{self._device.machine.slug} V1.00" if name == "FG" else "    0,    0"
            self._say(answer, now)
            return 0.0
        if name in ("H", "TT"):
            return self._go(False, False, (0.0, 0.0))
        numbers = self._numbers(rest)
        if numbers is None:
            carriage.wrong(2)
            return 0.0
        return self._set(name, numbers)

    def _numbers(self, text: str) -> list[float] | None:
        if not text:
            return []
        return [float(each) for each in text.split(",")] if _NUMBERS.fullmatch(text) else None

    def _set(self, name: str, numbers: list[float]) -> float:
        carriage, tools = self._device.carriage, self._device.machine.tools
        if name in "MDOE":
            return self._trace(name, numbers)
        if name == "J" and numbers:
            return carriage.select(int(min(99, max(0, numbers[0]))))
        if name == "!" and numbers:
            carriage.speed = max(1.0, numbers[0]) * tools.speed_unit
        elif name == "FX" and numbers:
            carriage.force = numbers[0] * tools.force_unit
        return 0.0

    def _trace(self, name: str, numbers: list[float]) -> float:
        if not numbers or len(numbers) % 2:
            self._device.carriage.wrong(2)
            return 0.0
        draws, differs = name in "DE", name in "OE"
        pairs = zip(numbers[::2], numbers[1::2], strict=True)
        self._legs.extend((draws, differs, pair) for pair in pairs)
        return self._go(*self._legs.popleft())

    def _go(self, draws: bool, differs: bool, pair: tuple[float, float]) -> float:
        carriage, axes = self._device.carriage, self._device.machine.axes
        lead = carriage.set_pen(draws)
        x, y = (int(each) for each in pair)
        to = (carriage.at[0] + x, carriage.at[1] + y) if differs else (x, y)
        if not all(axes.lowest <= each <= axes.highest for each in to):
            carriage.wrong(3)
            return lead
        seconds = lead + carriage.move(to, lead)
        carriage.tally.moving += seconds
        return seconds
