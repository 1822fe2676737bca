"""The simulator behind a real wire: a pseudo-terminal or a TCP port. A thread serves each.

The pseudo-terminal stands for a serial port, so it stops at XOFF where its user asked for that; it
has no handshake lines: the kernel keeps none for it. The TCP port stands for a device server, which
looks after XON/XOFF and RTS/CTS itself where the machine uses them. When the simulated cable is
pulled the pseudo-terminal hangs up and its link vanishes, and a TCP user is sent away; both are
there again when the cable is.
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

    link : a symbolic link to make to the port, and to remove in the end. Without one, a port that
    comes back after its cable was pulled has another path, which nobody learns. Raises
    PortUnavailable where the system has no pseudo-terminals, or something else stands in the
    link's place.
    """
    try:
        import pty  # noqa: F401
    except ImportError:
        raise PortUnavailable("This system has no pseudo-terminals; use a TCP port.") from None
    terminal = Terminal(link)
    try:
        with threaded(lambda stop: _attend(simulator, terminal, stop)):
            yield str(link or terminal.path)
    finally:
        terminal.hang_up()


class Terminal:
    """A pseudo-terminal that can hang up and come back; raises PortUnavailable for its link."""

    def __init__(self, link: Path | None) -> None:
        self._link = link
        self.wire = -1
        self.dial()

    def dial(self) -> None:
        """Open it, if it is not."""
        import pty
        import tty

        if self.wire >= 0:
            return
        self.wire, self._theirs = pty.openpty()  # theirs stays open, so a user may come again
        tty.setraw(self._theirs)
        os.set_blocking(self.wire, False)
        self.path = os.ttyname(self._theirs)
        if self._link:
            try:
                _point(self._link, self.path)
            except PortUnavailable:
                self._link = None
                self.hang_up()
                raise

    def hang_up(self) -> None:
        """Close it, so that whoever has it open gets an input/output error."""
        if self.wire < 0:
            return
        os.close(self.wire)
        os.close(self._theirs)
        self.wire = -1
        if self._link:
            self._link.unlink(missing_ok=True)

    @property
    def obeys_xoff(self) -> bool:
        """Whether its user asked for XON/XOFF."""
        import termios

        return bool(termios.tcgetattr(self.wire)[0] & termios.IXON)


@contextmanager
def serve_tcp(simulator: Simulator, host: str = "127.0.0.1", port: int = 0) -> Iterator[str]:
    """Offer the simulator on a TCP port while the context lasts; yields its ``socket://`` address.

    port : 0 for any that is free. One user at a time; the machine stays when one leaves. Raises
    PortUnavailable where the port cannot be had.
    """
    simulator.honours_cts = simulator.machine.serial.handshake == "rts-cts"
    with (
        listening(host, port) as listener,
        threaded(lambda stop: _admit(simulator, listener, stop)),
    ):
        yield f"socket://{host}:{listener.getsockname()[1]}"


@contextmanager
def listening(host: str, port: int) -> Iterator[socket.socket]:
    """Listen on a TCP port; raises PortUnavailable."""
    try:
        listener = socket.create_server((host, port), backlog=1)
    except OSError as error:
        raise PortUnavailable(
            f"TCP port {port} on {host} cannot be had: {error.strerror}. Take another."
        ) from None
    with listener:
        listener.settimeout(_LONGEST_WAIT)
        yield listener


@contextmanager
def threaded(work: Callable[[threading.Event], None]) -> Iterator[None]:
    """Work in another thread while the context lasts; it is told to stop by an event."""
    stop = threading.Event()
    thread = threading.Thread(target=work, args=(stop,), daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def accepted(
    simulator: Simulator, listener: socket.socket, stop: threading.Event
) -> Iterator[socket.socket]:
    """Yield one user after the other until told to stop; what nobody hears meanwhile is lost."""
    while not stop.is_set():
        simulator.read()
        with suppress(TimeoutError, ConnectionError):
            user, _ = listener.accept()
            with user:
                user.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                user.setblocking(True)
                yield user


def _point(link: Path, path: str) -> None:
    if link.is_symlink():
        link.unlink()
    try:
        link.symlink_to(path)
    except OSError as error:
        raise PortUnavailable(f"No link can be made at {link}: {error.strerror}.") from None


def _attend(simulator: Simulator, terminal: Terminal, stop: threading.Event) -> None:
    """Serve a terminal, which is there as long as the cable is."""
    while not stop.is_set():
        simulator.advance()
        if simulator.unplugged:
            terminal.hang_up()
            stop.wait(_LONGEST_WAIT)
        else:
            terminal.dial()
            _pump(simulator, terminal.wire, stop, lambda: _adopt(simulator, terminal))


def _adopt(simulator: Simulator, terminal: Terminal) -> None:
    simulator.honours_xoff = terminal.obeys_xoff


def _admit(simulator: Simulator, listener: socket.socket, stop: threading.Event) -> None:
    for user in accepted(simulator, listener, stop):
        user.setblocking(False)
        with suppress(ConnectionError):
            if not simulator.unplugged:
                _pump(simulator, user, stop, lambda: None)


def _pump(
    simulator: Simulator,
    wire: int | socket.socket,
    stop: threading.Event,
    adopt: Callable[[], None],
) -> None:
    """Carry bytes until told to stop, the user of a socket leaves or the cable is pulled."""
    while not stop.is_set() and not simulator.unplugged:
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
