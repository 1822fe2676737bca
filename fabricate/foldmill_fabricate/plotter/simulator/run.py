"""The simulator as a tool in a terminal: it prints its address and takes short commands."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from pathlib import Path
from threading import Event

from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.simulator.draw import draw
from foldmill_fabricate.plotter.simulator.machine import Simulator

COMMANDS = {
    "flip": "turn the sheet over",
    "new": "lay a new sheet on the machine",
    "pause": "press the machine's pause key",
    "resume": "press it again",
    "draw": "write what was drawn so far",
    "status": "say what it is doing",
    "quit": "end",
}


def run(
    simulator: Simulator,
    server: AbstractContextManager[str],
    commands: Iterable[str],
    say: Callable[[str], None],
    folder: Path | None = None,
) -> None:
    """Serve until ``quit`` or an interrupt; raises PortUnavailable where it cannot be served.

    server : from ``serve_pty`` or ``serve_tcp``. commands : lines, such as ``sys.stdin``; where
    they end it goes on serving. folder : where ``draw`` and the end leave front and reverse as SVG
    and PNG.
    """
    try:
        with server as address:
            say(f"{simulator.machine.title} at {address}")
            say("Commands: " + ", ".join(COMMANDS))
            if _listen(simulator, commands, say, folder):
                Event().wait()  # no terminal to talk to: until it is interrupted
    except KeyboardInterrupt:
        say("Interrupted.")
    finally:
        _draw(simulator, say, folder)


def _listen(
    simulator: Simulator, commands: Iterable[str], say: Callable[[str], None], folder: Path | None
) -> bool:
    """Obey until there is nothing more to hear; return False after ``quit``."""
    actions: dict[str, Callable[[], None]] = {
        "flip": simulator.flip,
        "new": simulator.new_sheet,
        "pause": simulator.pause,
        "resume": simulator.resume,
        "draw": lambda: _draw(simulator, say, folder),
        "status": lambda: None,
    }
    for line in commands:
        word = line.strip().lower()
        if word == "quit":
            return False
        if word not in actions:
            say("Commands: " + "; ".join(f"{name} ({what})" for name, what in COMMANDS.items()))
            continue
        try:
            actions[word]()
        except PlotterError as error:
            say(str(error))
        else:
            say(simulator.status())
    return True


def _draw(simulator: Simulator, say: Callable[[str], None], folder: Path | None) -> None:
    if folder:
        paths = draw(simulator.sheet, simulator.machine, folder)
        say("Drawn: " + ", ".join(str(path) for path in paths))
