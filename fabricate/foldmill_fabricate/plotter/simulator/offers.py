"""Where simulated plotters are found: several in one process, each with options of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
from urllib.parse import parse_qsl

from foldmill.errors import InvalidInput
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.rfc2217 import serve_rfc2217
from foldmill_fabricate.plotter.simulator.servers import serve_pty, serve_tcp

Kind = Literal["pty", "tcp", "rfc2217"]
_HIGHEST = 65535


@dataclass(frozen=True)
class Offer:
    """One plotter: the simulator, and by what it is reached."""

    simulator: Simulator
    kind: Kind
    place: str
    """a link's path, or a port's number"""


def offer(kind: Kind, text: str, common: Mapping[str, str]) -> Offer:
    """Read ``PLACE?option=value&…``, such as ``9100?machine=hp-7475a&fault=silence@500``.

    common : options that hold where the text has none of its own. Raises InvalidInput.
    """
    place, _, own = text.partition("?")
    if kind != "pty" and not (place.isdigit() and 0 < int(place) <= _HIGHEST):
        raise InvalidInput(f"--{kind}: {place!r} is no port number from 1 to {_HIGHEST}.")
    options = {**common, **dict(parse_qsl(own, keep_blank_values=True)), "clock": "real"}
    return Offer(devices.made(options["machine"], options), kind, place)


@contextmanager
def served(offers: Sequence[Offer]) -> Iterator[list[str]]:
    """Serve them all while the context lasts; yields their addresses; raises PortUnavailable."""
    with ExitStack() as stack:
        yield [stack.enter_context(_server(each)) for each in offers]


def _server(each: Offer) -> AbstractContextManager[str]:
    if each.kind == "pty":
        return serve_pty(each.simulator, Path(each.place) if each.place else None)
    serve = serve_tcp if each.kind == "tcp" else serve_rfc2217
    return serve(each.simulator, port=int(each.place))
