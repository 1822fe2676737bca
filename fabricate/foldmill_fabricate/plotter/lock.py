"""One hand on a device: a lock that lives as long as the process that holds it."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from foldmill_fabricate.plotter.errors import PortUnavailable


def device_of(url: str) -> str:
    """Return the name of the device behind a port's address: one name for all ways to write it.

    Links such as ``/dev/serial/by-id/…`` are followed; options of an address do not count, nor
    does the case of a host.
    """
    if "://" in url:
        scheme, _, rest = url.partition("://")
        place = rest.split("?", 1)[0].rstrip("/")
        return f"{scheme}://{place}".lower()
    return os.path.realpath(url) if os.sep in url else url.upper()


@contextmanager
def held(url: str) -> Iterator[str]:
    """Hold the lock of a device and give its name.

    Simulators in this process need none: no other process reaches them. Raises PortUnavailable
    where another process of this computer holds it. The lock ends with the process, whatever ends
    it.
    """
    device = device_of(url)
    if device.startswith("sim://"):
        yield device
        return
    lock = FileLock(_file(device), timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise PortUnavailable(
            f"Another foldmill on this computer is at work on {url}. Wait until it is done, or "
            "stop it."
        ) from None
    except OSError as error:
        raise PortUnavailable(f"{url} cannot be locked: {error}.") from None
    try:
        yield device
    finally:
        lock.release()


def _file(device: str) -> Path:
    """Return the lock's file: the same for all users of this computer."""
    digest = hashlib.sha256(device.encode()).hexdigest()[:16]
    return Path(tempfile.gettempdir()) / f"foldmill-{digest}.lock"
