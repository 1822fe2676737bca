"""``sim://`` as a pyserial port: the simulator behind it, through the calls of a real port.

Waiting passes the simulator's clock, so with a virtual clock hours of plotting take seconds.
"""

from __future__ import annotations

import errno
from collections.abc import Callable
from functools import partial
from math import inf
from typing import Any

from serial.serialutil import (
    PortNotOpenError,
    SerialBase,
    SerialException,
    SerialTimeoutException,
    to_bytes,
)

from foldmill.errors import FoldmillError
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator

_DRIVER = 4096
"""Bytes that the host's driver queues before ``write`` blocks."""


class Serial(SerialBase):  # type: ignore[misc]  # pyserial has no types
    """A port with a simulated plotter behind it.

    It stops at XOFF with ``xonxoff``, at a low CTS with ``rtscts``; ``dsrdtr`` changes nothing, as
    under Linux: who wants that must look at ``dsr``. When the cable is pulled every call fails, and
    the port has to be opened anew.
    """

    is_open: bool

    def open(self) -> None:
        """Find or make the plotter; raises SerialException for an address that names none."""
        if self._port is None:
            raise SerialException("Port must be configured before it can be used.")
        if self.is_open:
            raise SerialException("Port is already open.")
        try:
            self._simulator = devices.behind(self._port)
        except FoldmillError as error:
            raise SerialException(str(error)) from None
        self._simulator.advance()
        if self._simulator.unplugged:
            raise SerialException(errno.ENOENT, f"could not open port {self._port}: not there")
        self._visit = self._simulator.visit
        self.is_open = True
        self._reconfigure_port()

    def close(self) -> None:
        """Leave the plotter; it goes on with what it has."""
        self.is_open = False

    @property
    def simulator(self) -> Simulator:
        """The plotter behind this port."""
        if not self.is_open:
            raise PortNotOpenError()
        return self._simulator

    @property
    def _there(self) -> Simulator:
        """The plotter, as it is now; raises SerialException where its cable has been pulled."""
        self._bring_up()
        return self._simulator

    def _bring_up(self) -> float:
        """Bring the plotter to the clock's time; return when something happens next, s."""
        simulator = self.simulator
        event = simulator.advance()
        if simulator.visit != self._visit:
            raise SerialException(errno.EIO, "Input/output error: the device has disconnected")
        return event

    @property
    def clock(self) -> Clock:
        """The clock that this port waits by."""
        return self.simulator.clock

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        return self._there.heard

    @property
    def out_waiting(self) -> int:
        """Bytes that are not yet on the line."""
        return self._there.queued

    def read(self, size: int = 1) -> bytes:
        """Read up to ``size`` bytes, waiting for them as long as ``timeout`` says."""
        self._wait(lambda: self._simulator.heard >= size, self._timeout)
        return self._simulator.read(size)

    def write(self, data: Any) -> int:
        """Queue bytes; raises SerialTimeoutException after ``write_timeout`` without room."""
        content = to_bytes(data)
        for start in range(0, len(content), _DRIVER):
            piece = content[start : start + _DRIVER]
            room = _DRIVER - len(piece)
            if not self._wait(partial(self._fits, room), self._write_timeout):
                raise SerialTimeoutException("Write timeout")
            self._simulator.write(piece)
        return len(content)

    def _fits(self, most: int) -> bool:
        return self._simulator.queued <= most

    def flush(self) -> None:
        """Wait until everything has left."""
        line = self.simulator.line
        self._wait(lambda: not line.queue and not line.sending, None)

    def reset_input_buffer(self) -> None:
        """Drop what has come and is not read."""
        self._there.read()

    def reset_output_buffer(self) -> None:
        """Drop what is not yet on the line."""
        self._there.discard_output()

    def set_output_flow_control(self, enable: bool = True) -> None:
        """Let go of, or hold, what is to be sent, whatever the plotter has said."""
        if enable:
            self._there.lift_xoff()
        self._there.hold_line(not enable)

    @property
    def cts(self) -> bool:
        """Clear to send."""
        return self._there.modem.cts

    @property
    def dsr(self) -> bool:
        """Data set ready."""
        return self._there.modem.dsr

    @property
    def cd(self) -> bool:
        """Carrier detect."""
        return self._there.modem.cd

    @property
    def ri(self) -> bool:
        """Ring indicator: no plotter rings."""
        return False

    def _wait(self, over: Callable[[], bool], timeout: float | None) -> bool:
        """Pass time from event to event until it is over, or return False after the timeout.

        ``over`` looks at the plotter as it was last brought up, once for each event.
        """
        clock = self.clock
        deadline = inf if timeout is None else clock.now() + timeout
        event = self._bring_up()
        while not over():
            if clock.now() >= deadline:
                return False
            moment = min(event, deadline)
            if moment == inf:
                raise SerialException("The simulated plotter is silent, and would be for ever.")
            clock.sleep_until(moment)
            event = self._bring_up()
        return True

    def _reconfigure_port(self) -> None:
        if self.is_open:
            self._simulator.honours_xoff = bool(self._xonxoff)
            self._simulator.honours_cts = bool(self._rtscts)
            self._simulator.baud = self._baudrate

    def _update_dtr_state(self) -> None:
        self._there.set_dtr(bool(self._dtr_state))

    def _update_rts_state(self) -> None:
        self._there.set_rts(bool(self._rts_state))

    def _update_break_state(self) -> None:
        """A break means nothing to a plotter."""
