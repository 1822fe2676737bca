"""The simulator as a network serial port (RFC 2217): baud rate, handshake lines and all.

pyserial's own ``PortManager`` speaks the protocol; behind it stands a ``sim://`` port, so a client
sees CTS and DSR move as the simulated cable moves them.
"""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from select import select
from threading import Event
from typing import Any

from serial.rfc2217 import PortManager

from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.protocol_sim import Serial
from foldmill_fabricate.plotter.simulator.servers import accepted, listening, threaded

_WAIT = 0.005
"""s between two looks at the wire."""
_PIECE = 64
"""Bytes taken from the network at once, so that a client feels a line that is held."""

_numbers = count()


@contextmanager
def serve_rfc2217(simulator: Simulator, host: str = "127.0.0.1", port: int = 0) -> Iterator[str]:
    """Offer the simulator as a network serial port while the context lasts.

    Yields its ``rfc2217://`` address. port : 0 for any that is free. One client at a time. Raises
    PortUnavailable where the port cannot be had.
    """
    url = devices.plug(f"rfc2217-{next(_numbers)}", simulator)
    try:
        with (
            listening(host, port) as listener,
            threaded(lambda stop: _admit(simulator, url, listener, stop)),
        ):
            yield f"rfc2217://{host}:{listener.getsockname()[1]}"
    finally:
        devices.unplug(url)


class _Client:
    """What ``PortManager`` writes to."""

    def __init__(self, user: socket.socket) -> None:
        self._user = user

    def write(self, data: bytes) -> None:
        """Send it whole."""
        self._user.sendall(data)


def _admit(simulator: Simulator, url: str, listener: socket.socket, stop: Event) -> None:
    for user in accepted(simulator, listener, stop):
        with suppress(OSError), Serial(url, timeout=0) as port:
            _serve(simulator, port, user, stop)


def _serve(simulator: Simulator, port: Any, user: socket.socket, stop: Event) -> None:
    """Carry bytes and lines until told to stop, the client leaves or the cable is pulled."""
    manager = PortManager(port, _Client(user))
    while not stop.is_set():
        heard = port.read(4096)
        if heard:
            user.sendall(b"".join(manager.escape(heard)))
        manager.check_modem_lines()
        if simulator.appetite <= 0:
            stop.wait(_WAIT)
        elif select([user], [], [], _WAIT)[0]:
            data = user.recv(_PIECE)
            if not data:
                return
            port.write(b"".join(manager.filter(data)))
