"""``foldmill serve`` as a process: one address, one folder, one end."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib.metadata import version
from pathlib import Path

import uvicorn
from fastapi import FastAPI
from filelock import FileLock, Timeout

from foldmill.errors import InvalidInput
from foldmill.files import fence_process
from foldmill_fabricate.files import write_whole
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.service.app import create
from foldmill_fabricate.service.patience import Patient
from foldmill_fabricate.service.reach import reached
from foldmill_fabricate.service.security import Policy, is_local, plain_name
from foldmill_fabricate.service.tokens import Tokens
from foldmill_fabricate.service.warming import settle
from foldmill_fabricate.service.workshop import Workshop

LOG = logging.getLogger("foldmill.service")
GRACE = 2
"""s that requests under way have when the service ends."""
MOST_AT_ONCE = 400
"""Requests; the next is refused, so that memory is bounded."""


def policy(folder: Path, host: str, names: tuple[str, ...], demand: bool) -> Policy:
    """Return who is let in; raises InvalidInput where that would be everybody.

    names : as people write them, with a port or without. demand : tokens even from this computer.
    """
    names = tuple(_plain(name) for name in names)
    tokens = Tokens(folder)
    if is_local(host) and not demand:
        return Policy(host, names)
    if not tokens.every:
        raise InvalidInput(
            f"On {host} others could reach this service, and there is no token: anybody could "
            "start a cut. Make one first: foldmill serve --new-token NAME --scope operate."
        )
    return Policy(host, names, tokens)


def _plain(name: str) -> str:
    """Return a further name as it is compared; raises InvalidInput for what no Host can be."""
    plain = plain_name(name)
    if not plain:
        raise InvalidInput(
            f"--name {name!r} is no name that a request can call this service by: give a host "
            "alone, such as cutter.example or [fd00::1], without http:// or a path."
        )
    return plain


def serve(
    workshop: Workshop, who: Policy, port: int, told: Callable[[str], None] = lambda _url: None
) -> None:
    """Serve until a signal ends it; ``told`` : hears the address once it is reached.

    Raises PortUnavailable where the address is taken, JobRefused where another works on the jobs.
    """
    places = workshop.places
    with _alone(places), _bound(who.host, port) as listening:
        fence_process(None)  # no parameter that comes from elsewhere names a file of this computer
        url = _url(who.host, listening.getsockname()[1])
        workshop.start()  # here, so that a refusal is told before anything is served
        app = create(workshop, who)
        with suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
            _Server(configured(app), places.service, url, told).run(sockets=[listening])


def configured(app: FastAPI) -> uvicorn.Config:
    """Return how requests are taken, whatever else is installed: no other reader, no sockets."""
    return uvicorn.Config(
        app,
        http=Patient,
        ws="none",
        log_config=None,
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=GRACE,
        limit_concurrency=MOST_AT_ONCE,
    )


class _Server(uvicorn.Server):
    """Says where it is reached, when it is, and no longer when it is not."""

    def __init__(
        self, config: uvicorn.Config, file: Path, url: str, told: Callable[[str], None]
    ) -> None:
        super().__init__(config)
        self._file, self._url, self._told = file, url, told

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, and tell where."""
        await super().startup(sockets)
        settle()
        if self.started:
            said = {"url": self._url, "pid": os.getpid(), "version": version("foldmill")}
            write_whole(self._file, json.dumps(said).encode())
            LOG.info("serving on %s", self._url)
            self._told(self._url)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop, and be found no more."""
        self._file.unlink(missing_ok=True)
        app = self.config.app
        if isinstance(app, FastAPI):
            app.state.stopping.set()  # those who follow what happens are let go
            await asyncio.to_thread(app.state.workshop.stop)  # machines before everything else
            await app.state.plans.finish()
            await asyncio.to_thread(app.state.desk.sandbox.close)  # who waits for it is told
        await super().shutdown(sockets)
        LOG.info("ended")


@contextmanager
def _alone(places: Places) -> Iterator[None]:
    """Hold a service's folder; raises PortUnavailable where another service has it."""
    places.root.mkdir(parents=True, exist_ok=True)
    lock = FileLock(places.root / "service.lock", timeout=0)
    try:
        lock.acquire()
    except Timeout:
        where = reached(places) or "another process"
        raise PortUnavailable(
            f"A service runs in {places.root} already ({where}). Use it, end it, or give this one "
            "a --state of its own."
        ) from None
    with lock:
        yield


def _bound(host: str, port: int) -> socket.socket:
    kind = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Only where the protocol is named does asyncio send small answers at once.
    made = socket.socket(kind, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((host, port))
    except (OSError, OverflowError) as error:
        made.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise PortUnavailable(
            f"{host} port {port} cannot be served on: {reason.lower()}. Is a service running "
            "already? Else choose another --port."
        ) from None
    return made


def _url(host: str, port: int) -> str:
    named = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return f"http://[{named}]:{port}" if ":" in named else f"http://{named}:{port}"
