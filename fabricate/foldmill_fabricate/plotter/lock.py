"""One hand on a device: a lock that lives as long as the process that holds it."""

from __future__ import annotations

import hashlib
import os
import socket
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from ipaddress import ip_address
from pathlib import Path

from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.plotter.holding import Held, Holder, locked

_WRAPPED = frozenset({"spy", "alt"})
"""Addresses of pyserial's that hold another."""
_SERVED = frozenset({"socket", "rfc2217"})
"""Ways to speak to a server's port; the machine behind it is one."""
SOMEBODY = Holder("foldmill", "Wait until it is done, or stop it.")


def device_of(url: str) -> str:
    """Return the name of the device behind a port's address: one name for all ways to write it.

    Links such as ``/dev/serial/by-id/…`` are followed, and names of hosts; a port that is listened
    in at (``spy://``) is that port. Options of an address do not count, nor does the case of a
    host, nor in which way a server's port is spoken to.
    """
    scheme, apart, rest = url.partition("://")
    if not apart:
        return os.path.realpath(url) if os.sep in url else url.upper()
    place = rest.split("?", 1)[0]
    if scheme.lower() in _WRAPPED:
        return device_of(place)
    if scheme.lower() in _SERVED:
        host, _, number = place.rstrip("/").rpartition(":")
        return f"socket://{_address(host.lower().strip('[]'))}:{number}"
    return f"{scheme}://{place.rstrip('/')}".lower()


def _address(host: str) -> str:
    """Return the one address of a host: this computer's by any name, others' as they resolve."""
    try:
        found = sorted({str(each[4][0]) for each in socket.getaddrinfo(host, None)})
    except OSError:
        return host  # opening it will say so
    if any(ip_address(each.split("%")[0]).is_loopback for each in found):
        return "localhost"
    return found[0] if found else host


@contextmanager
def held(url: str, holder: Holder = SOMEBODY) -> Iterator[str]:
    """Hold the lock of a device and give its name; holder : what others are told meanwhile.

    Simulators in this process need none: no other process reaches them. Raises PortUnavailable
    where another process of this computer holds it, with its name. The lock ends with the process,
    whatever ends it.
    """
    device = device_of(url)
    if device.startswith("sim://"):
        yield device
        return
    with ExitStack() as stack:
        try:
            stack.enter_context(locked(lock_file(device), holder, mode=0o666))
        except Held as error:
            raise PortUnavailable(at_work(url, error.by)) from None
        except OSError as error:
            raise PortUnavailable(f"{url} cannot be locked: {error}.") from None
        yield device


def at_work(url: str, by: Holder | None) -> str:
    """Say that somebody else is at work on a port, and what to do about that."""
    if by is None:
        return (
            f"Another foldmill on this computer is at work on {url}. Wait until it is done, or "
            "stop it."
        )
    return f"Another foldmill is at work on {url}: {by}. Nothing was sent. {by.remedy}"


def lock_file(name: str) -> Path:
    """Return the lock's file of what has a name: the same for all users of this computer."""
    digest = hashlib.sha256(name.encode()).hexdigest()[:16]
    return Path(tempfile.gettempdir()) / f"foldmill-{digest}.lock"
