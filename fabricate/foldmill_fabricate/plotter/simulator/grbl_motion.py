"""What the motors, the Z axis and the spindle of a GRBL machine do with a planned leg."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import dist
from typing import TYPE_CHECKING

from foldmill_fabricate.plotter.simulator.drawing import Step
from foldmill_fabricate.toolpath.motion import move_seconds

if TYPE_CHECKING:
    from foldmill_fabricate.plotter.simulator.device import Device

_TENTH = 1e-4
"""mm; Z is told to a tenth of a micrometre."""


@dataclass(frozen=True)
class Leg:
    """A straight way of all three axes."""

    target: tuple[float, ...]
    """mm"""
    fast: bool
    """G0: as fast as the machine can, and a laser's beam is off."""
    feed: float
    """mm/s"""
    power: float
    """S while it runs, 0 with the spindle off"""


class Motors:
    """Where the tool is in three axes, and whether it is in the sheet."""

    def __init__(self, device: Device, laser: bool) -> None:
        self._device, self._laser = device, laser
        self.position: tuple[float, ...] = ()
        self.home()

    def home(self) -> None:
        """Begin at the origin with the spindle off."""
        self.position = (0.0, 0.0, 0.0)
        self._from: tuple[float, ...] = self.position
        self._spindle, self.power = "M5", 0.0

    def switch(self, spindle: str, power: float) -> float:
        """Turn the spindle on or off; return the time, s."""
        self._spindle, self.power = spindle, power if spindle != "M5" else 0.0
        self._lower(self.position[2], fast=spindle == "M4")  # whose beam is off at rest
        return 0.0

    def run(self, leg: Leg) -> float:
        """Begin a leg; return its time, s."""
        carriage, motion = self._device.carriage, self._device.machine.motion
        carriage.begin()
        self._from, self.power = self.position, leg.power
        speed = min(motion.travel_speed if leg.fast else leg.feed, motion.travel_speed)
        carriage.speed = round(speed, 6)
        carriage.setting = self._setting(leg)
        self._lower(min(self.position[2], leg.target[2]), leg.fast)
        step = self._step(leg.target)
        seconds = carriage.move(step, travel=speed) if step != carriage.at else 0.0
        length = dist(self.position, leg.target)
        if not carriage.down or not seconds:
            seconds = float(move_seconds(length, speed, motion.acceleration))
        if carriage.line:
            carriage.line = replace(carriage.line, seconds=seconds)
        self.position = leg.target
        carriage.tally.moving += seconds
        return seconds

    def arrive(self, leg: Leg) -> None:
        """Be at the end of a leg."""
        self._lower(leg.target[2], leg.fast)

    def stop(self, leg: Leg | None) -> None:
        """Stop where the tool is; the spindle goes off, Z stays."""
        self.position = self.place(leg)
        self._spindle, self.power = "M5", 0.0
        self._lower(self.position[2])

    def place(self, leg: Leg | None) -> tuple[float, ...]:
        """Return where it is, mm."""
        if leg is None:
            return self.position
        total = self._device.lasting
        part = min(1.0, max(0.0, self._device.spent / total)) if total else 1.0
        return tuple(a + part * (b - a) for a, b in zip(self._from, leg.target, strict=True))

    def _setting(self, leg: Leg) -> str:
        if self._laser or leg.power:
            return f"S{leg.power:g}"
        depth = min(self.position[2], leg.target[2])
        return f"Z{round(depth / _TENTH) * _TENTH:g}"

    def _lower(self, depth: float, fast: bool = False) -> None:
        """Put the tool into the sheet or take it out: Z and the spindle take the time for it."""
        on = self._spindle != "M5"
        cuts = on and self.power > 0 and not fast if self._laser else on or depth < 0
        self._device.carriage.set_pen(cuts)

    def _step(self, target: tuple[float, ...]) -> Step:
        axes = self._device.machine.axes
        x, y = (round(each * axes.units_per_mm) for each in target[:2])
        return (y, x) if axes.swap else (x, y)
