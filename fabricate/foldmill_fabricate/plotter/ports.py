"""The ports of this computer, and, on a person's word, what answers at them.

Looking does not open a port: opening one can move a modem line, and a machine at work would take a
question for a part of its program.
"""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from pathlib import Path

from serial.tools.list_ports import comports

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter import link
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.handshakes.grbl import GrblSession
from foldmill_fabricate.plotter.holding import Holder
from foldmill_fabricate.plotter.lock import held
from foldmill_fabricate.plotter.session import SILENCE, Session

_ASKING = Holder("foldmill plotters --ask", "It ends within seconds.")
_QUESTIONS = {"hpgl": b"OI;", "gcode": b"?", "gp-gl": b"FG\x03"}


@dataclass(frozen=True)
class Port:
    """A port, and what is known of it."""

    address: str
    title: str
    """what the system calls the device behind it"""
    state: str
    """free, or why it cannot be used, a sentence; of an open one what answered"""
    answer: str = ""
    """what a machine said of itself; empty for not asked, or for silence"""


def listed() -> list[Port]:
    """Return the serial ports, by name; none of them is opened."""
    found = sorted(comports(), key=lambda port: port.device)
    return [Port(one.device, one.description or "", _permission(one.device)) for one in found]


def asked(address: str, machine: Machine, title: str = "") -> Port:
    """Open a port as a machine's profile says, and ask what is there.

    The question is ``OI;`` of HP-GL, ``?`` of GRBL, ``FG`` of GP-GL: none moves anything, but one
    that meets a machine at work harms its program. Locked, busy and forbidden ports are explained.
    """
    try:
        with held(address, _ASKING), link.open_port(address, machine) as port:
            said = _said(port, machine)
    except (PlotterError, OSError) as error:
        return Port(address, title, str(error))
    if said:
        return Port(address, title, "answers", said)
    return Port(
        address,
        title,
        f"silent at {machine.serial.baud} baud: nothing there, switched off, another rate, or a "
        "machine that never answers",
    )


class _Listener(Session):
    """Keeps the first line that comes."""

    said = ""

    def take(self, line: bytes) -> None:
        self.said = self.said or line.decode("ascii", "replace").strip()


def _said(port: object, machine: Machine) -> str:
    talk = _Listener(port, machine, link.clock_of(port))
    talk.ends = {"gcode": GrblSession.ends, "gp-gl": b"\x03"}.get(machine.language, b"\r")
    talk.open()
    talk.send(_QUESTIONS[machine.language])
    limit = talk.line_free + SILENCE
    while not talk.said and talk.clock.now() < limit:
        talk.wait_a_byte(limit)
    return talk.said


def _permission(device: str) -> str:
    """Say whether a device may be opened, without opening it."""
    if not Path(device).exists() or os.access(device, os.R_OK | os.W_OK):
        return "free to try"
    return link.explained(device, errno.EACCES)
