"""Which firmware a machine has."""

from __future__ import annotations

from foldmill_fabricate.plotter.simulator.device import Device
from foldmill_fabricate.plotter.simulator.firmware import Firmware
from foldmill_fabricate.plotter.simulator.gpgl import GpglFirmware
from foldmill_fabricate.plotter.simulator.grbl import GrblFirmware
from foldmill_fabricate.plotter.simulator.hp import HpFirmware
from foldmill_fabricate.plotter.simulator.quirks import Quirk


def firmware_of(device: Device, quirks: frozenset[Quirk]) -> Firmware:
    """Return what takes a device's bytes, by the language of its profile."""
    if device.machine.language == "gcode":
        return GrblFirmware(device)
    if device.machine.language == "gp-gl":
        return GpglFirmware(device)
    return HpFirmware(device, quirks)
