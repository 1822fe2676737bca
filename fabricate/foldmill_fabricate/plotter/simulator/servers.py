"""The simulator behind a real wire: a pseudo-terminal or a TCP port. A thread serves each.

The pseudo-terminal stands for a serial port, so it stops at XOFF where its user asked for that. The
TCP port stands for a device server, which looks after XON/XOFF itself where the machine uses it.
"""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from select import select

from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.plotter.simulator.machine import Simulator

_LONGEST_WAIT = 0.02
"""s between two looks at the wire."""
_SHORTEST_WAIT = 0.0005
"""s; a machine that is late for its own events still leaves the processor to others."""


@contextmanager
def serve_pty(simulator: Simulator, link: Path | None = None) -> Iterator[str]:
    """Offer the simulator as a serial port while the context lasts; yields the port's path.

    link : a symbolic link to make to the port, and to remove in the end. Raises PortUnavailable
    where the system has no pseudo-terminals, or something else stands in the link's place.
    """
    try:
        import pty
        import termios
        import tty
    except ImportError:
        raise PortUnavailable("This system has no pseudo-terminals; use a TCP port.") from None

    ours, theirs = pty.openpty()  # theirs stays open here, so a user may close it and come again
    tty.setraw(theirs)
    os.set_blocking(ours, False)

    def adopt() -> None:
        simulator.honours_xoff = bool(termios.tcgetattr(ours)[0] & termios.IXON)

    path = os.ttyname(theirs)
    try:
        with _linked(path, link) as name, _thread(lambda stop: _pump(simulator, ours, stop, adopt)):
            yield name
    finally:
        os.close(ours)
        os.close(theirs)


@contextmanager
def serve_tcp(simulator: Simulator, host: str = "127.0.0.1", port: int = 0) -> Iterator[str]:
    """Offer the simulator on a TCP port while the context lasts; yields its ``socket://`` address.

    port : 0 for any that is free. One user at a time; the machine stays when one leaves. Raises
    PortUnavailable where the port cannot be had.
    """
    try:
        listener = socket.create_server((host, port), backlog=1)
    except OSError as error:
        raise PortUnavailable(
            f"TCP port {port} on {host} cannot be had: {error.strerror}. Take another."
        ) from None
    with listener, _thread(lambda stop: _admit(simulator, listener, stop)):
        yield f"socket://{host}:{listener.getsockname()[1]}"


@contextmanager
def _linked(path: str, link: Path | None) -> Iterator[str]:
    if link is None:
        yield path
        return
    if link.is_symlink():
        link.unlink()
    try:
        link.symlink_to(path)
    except OSError as error:
        raise PortUnavailable(f"No link can be made at {link}: {error.strerror}.") from None
    try:
        yield str(link)
    finally:
        link.unlink(missing_ok=True)


@contextmanager
def _thread(work: Callable[[threading.Event], None]) -> Iterator[None]:
    stop = threading.Event()
    thread = threading.Thread(target=work, args=(stop,), daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def _admit(simulator: Simulator, listener: socket.socket, stop: threading.Event) -> None:
    listener.settimeout(_LONGEST_WAIT)
    while not stop.is_set():
        with suppress(TimeoutError, ConnectionError):
            user, _ = listener.accept()
            with user:
                user.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                user.setblocking(False)
                _pump(simulator, user, stop, lambda: None)
        simulator.read()  # what nobody is there to hear is lost


def _pump(
    simulator: Simulator,
    wire: int | socket.socket,
    stop: threading.Event,
    adopt: Callable[[], None],
) -> None:
    """Carry bytes until told to stop, or until the user of a socket leaves."""
    while not stop.is_set():
        adopt()
        heard = simulator.read()
        if heard:
            with suppress(BlockingIOError):  # nobody reads: a serial line loses that, too
                _give(wire, heard)
        appetite = simulator.appetite
        wait = simulator.next_event - simulator.clock.now()
        wait = min(max(wait, _SHORTEST_WAIT), _LONGEST_WAIT)
        if appetite <= 0:
            stop.wait(wait)
        elif select([wire], [], [], wait)[0]:
            data = _take(wire, appetite)
            if not data:
                return
            simulator.write(data)


def _give(wire: int | socket.socket, data: bytes) -> None:
    if isinstance(wire, int):
        os.write(wire, data)
    else:
        wire.sendall(data)


def _take(wire: int | socket.socket, most: int) -> bytes:
    return os.read(wire, most) if isinstance(wire, int) else wire.recv(most)
