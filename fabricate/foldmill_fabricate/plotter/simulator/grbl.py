"""The firmware of a GRBL 1.1 machine: lines, a planner, realtime characters.

A line leaves the receive buffer when the parser is free, and is answered ``ok`` when the planner
has taken it: accepted, not executed. The planner holds 15 blocks; while it is full, or a line waits
for the motors to stop (G4, M3 … M5, $ commands), the parser reads no further and the receive buffer
fills. So the ``ok`` of ``G4 P0`` says that all before it is executed.

The tool is in the sheet where Z is below 0 or the spindle is on (a servo that lowers a pen); that
of a laser where it is on with a power above 0, and not on G0.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from foldmill_fabricate.plotter.simulator import gcode
from foldmill_fabricate.plotter.simulator.firmware import Careful
from foldmill_fabricate.plotter.simulator.grbl_motion import Leg, Motors
from foldmill_fabricate.plotter.simulator.grbl_settings import Settings

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.simulator.device import Device

REALTIME = frozenset(b"?!~\x18") | frozenset(range(0x80, 0x100))
"""Characters that are obeyed at once and never enter the buffer."""
BANNER = "\r\nGrbl 1.1f ['$' for help]\r\n"
_SLOWEST = 1.0
"""mm/min: whatever F says."""
_ABORTED, _BEYOND = 3, 2
"""Alarms: reset while in motion; a target beyond the machine's travel."""


@dataclass
class _Modal:
    """What one line leaves to the next."""

    motion: str = "G0"
    inches: bool = False
    relative: bool = False
    spindle: str = "M5"
    feed: float = 0.0
    """mm/min"""
    power: float = 0.0
    target: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    """mm: where the last planned leg ends"""


class GrblFirmware(Careful):
    """Parser and planner; the motors are another's business."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._settings = Settings(device.machine)
        self._motors = Motors(device, self._settings.laser)
        self._stuck, self._began = False, False
        self._clear()
        self._alarm = self._dead_end = False

    def start(self, now: float) -> None:
        """Say hello, as after switching on."""
        self._motors.home()
        self._clear()
        self._alarm = self._dead_end = False
        self._say(BANNER, now)

    def _clear(self) -> None:
        self._modal = _Modal(target=list(self._motors.position))
        self._planned: deque[Leg] = deque()
        self._line = bytearray()
        self._parked: Callable[[float], float] | None = None
        self._running: Leg | None = None
        self._dwelling = False
        self._held_since: float | None = None

    @property
    def holds(self) -> bool:
        """GRBL says "wait" by saying nothing."""
        return False

    @property
    def ready(self) -> bool:
        """Its line says nothing."""
        return not self._stuck

    def scanner(self) -> Callable[[int], bool]:
        """Return a function that tells realtime characters from the program."""
        return lambda byte: byte not in REALTIME

    def fault(self, error: int) -> None:
        """Count it; GRBL does not tell."""
        self._device.traffic.errors[error] += 1

    def wait(self, stuck: bool, now: float) -> None:
        """Withhold every ok while stuck."""
        self._stuck = stuck
        if not stuck:
            self._device.work(now)

    def hear(self, byte: int, now: float) -> None:
        """Take a byte: realtime at once, the rest into the buffer."""
        if byte in REALTIME:
            self._realtime(byte, now)
        elif not self._dead_end:
            if not self._device.buffer.store(byte):
                self.fault(16)
            if self._device.idle:
                self._device.work(now)
            else:
                self._parse(now)

    def begin(self, now: float) -> float | None:
        """Begin the next leg, or what waited for the motors to stop."""
        self._parse(now)
        if self._planned:
            self._running = self._planned.popleft()
            return self._motors.run(self._running)
        if self._parked:
            doing, self._parked = self._parked, None
            self._dwelling = True
            return doing(now)
        return None

    def ended(self, now: float) -> None:
        """Answer what was waited for."""
        if self._running:
            self._motors.arrive(self._running)
            self._running = None
        if self._dwelling:
            self._dwelling = False
            self._say("ok\r\n", now)

    def settle(self, now: float) -> None:
        """Nothing is to be said."""

    def _say(self, text: str, now: float) -> None:
        self._device.out.put(text.encode(), now)

    def _parse(self, now: float) -> None:
        """Read lines while the planner has room and nobody waits for the motors."""
        data = self._device.buffer.data
        while data and self._may_parse:
            byte = data.pop(0)
            self._device.traffic.begun += 1
            if byte in b"\r\n":
                line, self._line = self._line.decode("latin-1"), bytearray()
                self._obey(line, now)
            elif len(self._line) <= 4 * gcode.LONGEST_LINE:
                self._line.append(byte)

    @property
    def _may_parse(self) -> bool:
        planned = len(self._planned) + (self._running is not None)
        waiting = self._parked or self._dwelling or self._stuck or self._dead_end
        return planned < self._settings.planner and not waiting

    def _obey(self, text: str, now: float) -> None:
        line = gcode.bare(text)
        self._device.carriage.tally.units += 1
        try:
            if len(line) > gcode.LONGEST_LINE:
                raise gcode.Refused(gcode.TOO_LONG)
            if line.startswith("$"):
                self._ask(line, now)
            elif line and self._alarm:
                raise gcode.Refused(gcode.LOCKED)
            else:
                self._execute(gcode.read(line), now)
        except gcode.Refused as wrong:
            self._device.carriage.wrong(wrong.number)
            self._say(f"{wrong}\r\n", now)

    def _ask(self, line: str, now: float) -> None:
        if line == "$X":
            self._alarm = False
        elif line == "$G":
            self._say(self._modes(), now)
        elif not self._settings.obey(line):
            raise gcode.Refused(5 if line == "$H" else gcode.DOLLAR)
        else:
            self._say(self._settings.answer(line), now)
        self._say("ok\r\n", now)

    def _modes(self) -> str:
        modal = self._modal
        units, way = "G20" if modal.inches else "G21", "G91" if modal.relative else "G90"
        return (
            f"[GC:{modal.motion} G54 G17 {units} {way} G94 {modal.spindle} M9 T0 "
            f"F{modal.feed:g} S{modal.power:g}]\r\n"
        )

    def _execute(self, block: gcode.Block, now: float) -> None:
        """Plan a block; what must wait for the motors is parked, and answered later."""
        modal, codes, values = self._modal, block.codes, block.values
        motion = codes.get("motion", modal.motion)
        inches = codes.get("units", "G20" if modal.inches else "G21") == "G20"
        scale = 25.4 if inches else 1.0
        feed = values.get("F", modal.feed / scale) * scale
        if block.axes and motion == "G1" and not feed:
            raise gcode.Refused(gcode.NO_FEED)
        modal.motion, modal.inches, modal.feed = motion, inches, feed
        modal.relative = codes.get("distance", "G91" if modal.relative else "G90") == "G91"
        modal.power = values.get("S", modal.power)
        if codes.get("stop") in ("M2", "M30"):
            codes = {**codes, "spindle": "M5"}
            modal.motion, modal.relative = "G1", False
        if "dwell" in codes:
            self._parked = lambda _: values["P"]
        elif codes.get("spindle", modal.spindle) != modal.spindle:
            modal.spindle = codes["spindle"]
            self._parked = lambda then: self._switch(block, scale, motion, then)
        elif block.axes and not self._plan(block, scale, motion, now):
            return
        else:
            self._say("ok\r\n", now)

    def _switch(self, block: gcode.Block, scale: float, motion: str, now: float) -> float:
        seconds = self._motors.switch(self._modal.spindle, self._modal.power)
        if block.axes:
            self._plan(block, scale, motion, now)
        return seconds

    def _plan(self, block: gcode.Block, scale: float, motion: str, now: float) -> bool:
        """Put a leg behind the others; False where it leads out of the machine."""
        modal, values = self._modal, block.values
        target = list(modal.target)
        for axis, letter in enumerate("XYZ"):
            if letter in values:
                from_here = target[axis] if modal.relative else 0.0
                target[axis] = from_here + values[letter] * scale
        if self._settings.beyond(target):
            self._lock(_BEYOND, now)
            self._dead_end = True
            self._say("[MSG:Reset to continue]\r\n", now)
            return False
        if target != modal.target:
            fast = motion != "G1"
            power = modal.power if modal.spindle != "M5" else 0.0
            self._planned.append(Leg(tuple(target), fast, max(_SLOWEST, modal.feed) / 60, power))
        modal.target = target
        return True

    def _lock(self, alarm: int, now: float) -> None:
        self._alarm = True
        self._device.carriage.tally.errors += 1
        self._say(f"ALARM:{alarm}\r\n", now)

    def _realtime(self, byte: int, now: float) -> None:
        if byte == 0x18:
            self._reset(now)
        elif byte == ord("?"):
            self._say(self._status(now), now)
        elif byte == ord("!") and not self._alarm and self._held_since is None:
            self._held_since = now
            self._device.halt("hold", now)
        elif byte == ord("~") and self._held_since is not None:
            self._held_since = None
            self._device.go_on("hold", now)

    def _reset(self, now: float) -> None:
        """Drop all; a reset in motion loses the position, one after a hold does not."""
        moving = self._running is not None and not self._stopped(now)
        self._motors.stop(self._running)
        self._device.drop()
        self._device.buffer.discard()
        self._alarm, self._dead_end = self._alarm and not self._dead_end, False
        self._clear()
        if moving:
            self._lock(_ABORTED, now)
        self._say(BANNER, now)
        if self._alarm:
            self._say("[MSG:'$H'|'$X' to unlock]\r\n", now)

    def _stopped(self, now: float) -> bool:
        """Whether a hold has braked the motors to rest."""
        speed = self._device.carriage.speed / self._device.machine.motion.acceleration
        return self._held_since is not None and now >= self._held_since + speed

    def _status(self, now: float) -> str:
        if self._alarm:
            state = "Alarm"
        elif self._held_since is not None:
            state = "Hold:0" if self._running is None or self._stopped(now) else "Hold:1"
        else:
            state = "Idle" if self._device.idle and not self._planned else "Run"
        x, y, z = self._motors.place(self._running)
        parts = [state, f"MPos:{x:.3f},{y:.3f},{z:.3f}"]
        if self._settings.tells_buffers:
            planned = len(self._planned) + (self._running is not None)
            parts.append(f"Bf:{self._settings.planner - planned},{self._device.free}")
        feed = self._device.carriage.speed * 60 if self._running and state == "Run" else 0
        parts.append(f"FS:{feed:.0f},{self._motors.power:.0f}")
        return f"<{'|'.join(parts)}>\r\n"
