"""Open a port by any address that pyserial knows, and ``sim://``; say plainly why it cannot be.

Modem lines are touched only where the profile's handshake is one: pseudo-terminals and many
adapters have none.
"""

from __future__ import annotations

import errno
import re
from collections.abc import Callable
from typing import Any

import serial

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock, RealClock
from foldmill_fabricate.plotter.errors import PortUnavailable

SIMULATORS = "foldmill_fabricate.plotter.simulator"
"""Package in which pyserial finds ``protocol_sim``."""

_TIMEOUT = 0.1
"""s that a read waits."""
_WRITE_PATIENCE = 60.0
"""s that a machine may hold by XOFF before a write fails."""

if SIMULATORS not in serial.protocol_handler_packages:
    serial.protocol_handler_packages.append(SIMULATORS)


def open_port(url: str, machine: Machine) -> Any:
    """Open a port with the machine's settings and return it, a ``serial.Serial`` or its like.

    url : ``/dev/ttyUSB0``, ``COM3``, ``socket://host:port``, ``rfc2217://host:port``,
    ``sim://machine`` …. Raises PortUnavailable.
    """
    if not url.strip():
        raise PortUnavailable("Name a port, such as /dev/ttyUSB0, COM3 or socket://host:port.")
    served = url.lower().startswith("rfc2217://")
    opened = _served if served else serial.serial_for_url
    try:
        return opened(
            url,
            baudrate=machine.serial.baud,
            xonxoff=machine.serial.handshake == "xon-xoff",
            rtscts=machine.serial.handshake == "rts-cts",
            timeout=_TIMEOUT,
            write_timeout=None if served else _WRITE_PATIENCE,
            exclusive=True,
        )
    except serial.SerialException as error:
        raise PortUnavailable(_sentence(url, error)) from None
    except ValueError as error:
        raise PortUnavailable(_unknown(url, error)) from None
    except TypeError:  # pyserial's way of missing a part of an address
        raise PortUnavailable(f"{url} is no whole address: write socket://host:port.") from None


def _served(url: str, **settings: Any) -> Any:
    """Open a network serial port that does not ask a server to drop bytes which has gone.

    pyserial's own waits three seconds for the answer, and as long nobody is told to stop the
    machine by hand.
    """
    from serial import rfc2217

    class Leaving(rfc2217.Serial):  # type: ignore[misc]
        def reset_output_buffer(self) -> None:
            thread = getattr(self, "_thread", None)
            if thread is not None and thread.is_alive():
                super().reset_output_buffer()

    return Leaving(url, **settings)


def clock_of(port: Any) -> Clock:
    """Return the clock a port waits by: a simulator's own, else the one on the wall."""
    clock: Clock = getattr(port, "clock", None) or RealClock()
    return clock


def _unknown(url: str, error: ValueError) -> str:
    if "://" in url and "not known" in str(error):
        scheme = url.split("://", 1)[0]
        return f"No port is addressed by {scheme}://. There are socket://, rfc2217:// and sim://."
    return f"The port {url} does not take these settings: {error}."


def _sentence(url: str, error: Exception) -> str:
    number = _number(error)
    if number in _REASONS:
        return _REASONS[number](url)
    detail = str(error).rstrip(".")
    return detail + "." if "://" in url else f"The port {url} cannot be opened: {detail}."


def explained(url: str, number: int) -> str:
    """Return the sentence for a system error at a port."""
    return _REASONS[number](url)


def _number(error: Exception) -> int | None:
    """Return the system's error number; pyserial sometimes keeps it in the text only."""
    number = getattr(error, "errno", None)
    found = re.search(r"\[Errno (\d+)\]", str(error))
    return number or (int(found[1]) if found else None)


def _missing(url: str) -> str:
    from serial.tools.list_ports import comports

    names = ", ".join(sorted(port.device for port in comports())) or "none"
    host, _, number = url.rpartition(":")
    meant = f" One on the network is named socket://{url}." if host and number.isdecimal() else ""
    return f"There is no port {url}. Ports on this computer: {names}.{meant}"


def _busy(url: str) -> str:
    return f"The port {url} is in use by another program. Close that one first."


def _forbidden(url: str) -> str:
    return (
        f"You may not use the port {url}. On Linux, join the group that owns it (often dialout) "
        "and log in again."
    )


def _refused(url: str) -> str:
    return f"Nobody answers at {url}. Is the device server on, and are address and port right?"


_REASONS: dict[int | None, Callable[[str], str]] = {
    errno.ENOENT: _missing,
    errno.ENODEV: _missing,
    errno.ENXIO: _missing,
    errno.EBUSY: _busy,
    errno.EAGAIN: _busy,
    errno.EACCES: _forbidden,
    errno.EPERM: _forbidden,
    errno.ECONNREFUSED: _refused,
    errno.EHOSTUNREACH: _refused,
}
