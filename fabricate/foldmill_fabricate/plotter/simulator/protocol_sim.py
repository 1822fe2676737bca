"""``sim://`` as a pyserial port: the simulator behind it, through the calls of a real port.

Waiting passes the simulator's clock, so with a virtual clock hours of plotting take seconds.
"""

from __future__ import annotations

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
    """A port with a simulated plotter behind it; modem lines are not wired."""

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
    def clock(self) -> Clock:
        """The clock that this port waits by."""
        return self.simulator.clock

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        return self.simulator.waiting

    @property
    def out_waiting(self) -> int:
        """Bytes that are not yet on the line."""
        self.simulator.advance()
        return self.simulator.queued

    def read(self, size: int = 1) -> bytes:
        """Read up to ``size`` bytes, waiting for them as long as ``timeout`` says."""
        self._wait(lambda: self.in_waiting >= size, self._timeout)
        return self.simulator.read(size)

    def write(self, data: Any) -> int:
        """Queue bytes; raises SerialTimeoutException after ``write_timeout`` without room."""
        content = to_bytes(data)
        for start in range(0, len(content), _DRIVER):
            piece = content[start : start + _DRIVER]
            room = _DRIVER - len(piece)
            if not self._wait(partial(self._fits, room), self._write_timeout):
                raise SerialTimeoutException("Write timeout")
            self.simulator.write(piece)
        return len(content)

    def _fits(self, most: int) -> bool:
        return self.out_waiting <= most

    def flush(self) -> None:
        """Wait until everything has left."""
        self._wait(lambda: self.out_waiting == 0 and not self.simulator.line.sending, None)

    def reset_input_buffer(self) -> None:
        """Drop what has come and is not read."""
        self.simulator.read()

    def reset_output_buffer(self) -> None:
        """Drop what is not yet on the line."""
        self.simulator.discard_output()

    def set_output_flow_control(self, enable: bool = True) -> None:
        """Let go of, or hold, what is to be sent, whatever the plotter has said."""
        if enable:
            self.simulator.lift_xoff()
        else:
            self.simulator.line.hold(0)

    @property
    def cts(self) -> bool:
        """Not wired."""
        return False

    dsr = ri = cd = cts

    def _wait(self, over: Callable[[], bool], timeout: float | None) -> bool:
        """Pass time from event to event until it is over, or return False after the timeout."""
        clock = self.clock
        deadline = inf if timeout is None else clock.now() + timeout
        while not over():
            if clock.now() >= deadline:
                return False
            moment = min(self.simulator.next_event, deadline)
            if moment == inf:
                raise SerialException("The simulated plotter is silent, and would be for ever.")
            clock.sleep_until(moment)
        return True

    def _reconfigure_port(self) -> None:
        if self.is_open:
            self._simulator.honours_xoff = bool(self._xonxoff)
            self._simulator.baud = self._baudrate

    def _update_dtr_state(self) -> None:
        """Not wired."""

    _update_rts_state = _update_break_state = _update_dtr_state
