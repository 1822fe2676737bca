"""The simulated plotters of this process: which one stands behind which ``sim://`` address.

The same address is the same machine as long as the process lives, so what one program drew is there
when the next one comes.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from urllib.parse import parse_qsl, urlsplit

from pydantic import ValidationError

from foldmill.errors import InvalidInput
from foldmill.refusals import explain
from foldmill_fabricate import shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock, RealClock, VirtualClock
from foldmill_fabricate.plotter.simulator import faults, quirks
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.modem import Wiring

_plugged: dict[str, Simulator] = {}

_CLOCKS: dict[str, Callable[[], Clock]] = {"virtual": VirtualClock, "real": RealClock}


def plug(name: str, simulator: Simulator) -> str:
    """Put a simulator behind ``sim://name`` and return that address."""
    url = f"sim://{name}"
    _plugged[url] = simulator
    return url


def unplug(url: str) -> None:
    """Take away what stands behind an address, if anything does."""
    _plugged.pop(url, None)


def behind(url: str) -> Simulator:
    """Return the simulator behind an address, made on first use.

    ``sim://NAME?machine=SLUG&buffer=255&handshake=esc-b&baud=9600&answers=no&speed_up=10&clock=real
    &fault=silence@5000,slow@0x1.5&quirk=needs-in&wiring=three-wires``; the machine is NAME where
    none is given. Raises UnknownName for a machine, InvalidInput for an option, that there is not.
    """
    if url not in _plugged:
        parts = urlsplit(url)
        _plugged[url] = made(parts.netloc, dict(parse_qsl(parts.query, keep_blank_values=True)))
    return _plugged[url]


def made(name: str, options: dict[str, str]) -> Simulator:
    """Make a simulator of a machine, changed by options as in an address; raises as ``behind``."""
    left = dict(options)
    machine: Machine = shelf.machine(left.pop("machine", name))
    changed: dict[str, str] = {
        key: left.pop(key) for key in ("buffer", "handshake", "baud", "answers") if key in left
    }
    speed_up = _number(left, "speed_up")
    clock, wiring = left.pop("clock", "virtual"), left.pop("wiring", Wiring.FULL)
    wrong, habits = left.pop("fault", ""), left.pop("quirk", "")
    if left or clock not in _CLOCKS or wiring not in set(Wiring):
        option = next(iter(left), f"clock={clock}" if clock not in _CLOCKS else f"wiring={wiring}")
        raise InvalidInput(
            f"A simulated plotter has no option {option!r}. There are: machine, buffer, handshake, "
            "baud, answers, speed_up, fault, quirk, wiring=full or wiring=three-wires, and "
            "clock=virtual or clock=real."
        )
    return Simulator(
        adjusted(machine, changed),
        clock=_CLOCKS[clock](),
        speed_up=speed_up,
        faults=faults.parse(wrong),
        quirks=quirks.parse(habits),
        wiring=Wiring(wiring),
    )


def adjusted(machine: Machine, serial: dict[str, str]) -> Machine:
    """Return the machine with other serial settings; raises InvalidInput for impossible ones."""
    try:
        settings = type(machine.serial).model_validate(machine.serial.model_dump() | serial)
    except ValidationError as error:
        given = ", ".join(f"{key}={value}" for key, value in serial.items())
        raise InvalidInput(f"No plotter is like this: {given}. {explain(error)}") from None
    return machine.model_copy(update={"serial": settings})


def _number(options: dict[str, str], key: str) -> float:
    text = options.pop(key, "1")
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < inf:
        raise InvalidInput(f"{key}={text} is no number above 0.")
    return value
