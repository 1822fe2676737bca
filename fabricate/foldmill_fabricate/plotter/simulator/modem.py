"""The handshake lines of the cable: what each end says without bytes.

The machine's ready line follows the room in its buffer where its profile or ESC.@ says so: RTS of
a machine with the handshake ``rts-cts``, which the host sees as CTS; DTR of the others, which the
host sees as DSR. The other of the two, and carrier detect, say that it has power.
"""

from __future__ import annotations

from enum import StrEnum

from foldmill_fabricate.plotter.simulator.device import Device


class Wiring(StrEnum):
    """The cable."""

    FULL = "full"
    """All lines, crossed as they should be."""
    THREE_WIRES = "three-wires"
    """Data and ground only: every line that comes in is low. So are cheap USB adapters."""


class Modem:
    """RTS and DTR of the host; CTS, DSR and carrier detect as it sees them."""

    def __init__(self, device: Device, wiring: Wiring) -> None:
        self._device, self.wiring = device, wiring
        self.rts = self.dtr = True
        self.changes: list[tuple[float, str, bool]] = []
        """When the host's program changed a line, s, which and to what; opening does not count."""

    @property
    def cts(self) -> bool:
        """Clear to send, at the host."""
        return self._level(self._hard)

    @property
    def dsr(self) -> bool:
        """Data set ready, at the host."""
        return self._level(not self._hard)

    @property
    def cd(self) -> bool:
        """Carrier detect, at the host."""
        return self._level(False)

    def set_rts(self, level: bool, now: float) -> None:
        """Change the host's RTS: a machine with RTS/CTS says nothing while it is low."""
        if level == self.rts:
            return
        self.rts = level
        self.changes.append((now, "rts", level))
        if self._hard and self.wiring is Wiring.FULL:
            out = self._device.out
            out.release(now) if level else out.hold(0)

    def set_dtr(self, level: bool, now: float) -> None:
        """Change the host's DTR; no machine here minds."""
        if level != self.dtr:
            self.dtr = level
            self.changes.append((now, "dtr", level))

    @property
    def _hard(self) -> bool:
        return self._device.machine.serial.handshake == "rts-cts"

    def _level(self, follows_room: bool) -> bool:
        device = self._device
        if self.wiring is Wiring.THREE_WIRES or not (device.powered and device.connected):
            return False
        return device.ready if follows_room else True
