"""The simulator as a tool in a terminal: it prints its addresses and takes short commands."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from threading import Event

from foldmill.errors import FoldmillError
from foldmill_fabricate.plotter.simulator import faults
from foldmill_fabricate.plotter.simulator.draw import draw
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.offers import Offer, served
from foldmill_fabricate.plotter.simulator.view import redrawn

COMMANDS = {
    "flip": "turn the sheet over",
    "new": "lay a new sheet on the machine",
    "pause": "press the machine's pause key",
    "resume": "press it again",
    "fault": "let something go wrong now, such as: fault stall@0:5s",
    "draw": "write what was drawn so far",
    "status": "say what it is doing",
    "quit": "end",
}
Say = Callable[[str], None]


def run(
    offers: Sequence[Offer],
    commands: Iterable[str],
    say: Say,
    folder: Path | None = None,
    live: bool = False,
) -> None:
    """Serve until ``quit`` or an interrupt; raises PortUnavailable where it cannot be served.

    commands : lines, such as ``sys.stdin``; where they end it goes on serving. A number behind a
    command names one plotter of several. folder : where ``draw`` and the end leave front and
    reverse as SVG and PNG, in a folder of its own for each of several. live : whether a table is
    redrawn in the terminal.
    """
    simulators = [each.simulator for each in offers]
    try:
        with served(offers) as addresses:
            for each, address in zip(simulators, addresses, strict=True):
                say(f"{each.machine.title} at {address}")
            say("Commands: " + ", ".join(COMMANDS))
            if live:
                with redrawn(dict(zip(addresses, simulators, strict=True))) as say_above:
                    _serve(simulators, commands, say_above, folder)
            else:
                _serve(simulators, commands, say, folder)
    except KeyboardInterrupt:
        say("Interrupted.")
    finally:
        _draw(simulators, simulators, say, folder)


def _serve(
    simulators: Sequence[Simulator], commands: Iterable[str], say: Say, folder: Path | None
) -> None:
    """Obey until there is nothing more to hear; then serve on, unless ``quit`` was said."""
    for line in commands:
        words = line.lower().split()
        if words == ["quit"]:
            return
        try:
            _obey(words, simulators, say, folder)
        except FoldmillError as error:
            say(str(error))
    Event().wait()  # no terminal to talk to: until it is interrupted


def _obey(words: list[str], simulators: Sequence[Simulator], say: Say, folder: Path | None) -> None:
    actions: dict[str, Callable[[Simulator], None]] = {
        "flip": Simulator.flip,
        "new": Simulator.new_sheet,
        "pause": Simulator.pause,
        "resume": Simulator.resume,
        "draw": lambda each: _draw([each], simulators, say, folder),
        "status": lambda _: None,
        "fault": lambda each: each.fail(faults.parse(",".join(words[1:2]))),
    }
    numbers = [word for word in words[1:] if word.isdigit()]
    chosen = [each for n, each in enumerate(simulators, 1) if not numbers or str(n) in numbers]
    if not words or words[0] not in actions or not chosen:
        say("Commands: " + "; ".join(f"{name} ({what})" for name, what in COMMANDS.items()))
        return
    for each in chosen:
        actions[words[0]](each)
        say(each.status())


def _draw(
    some: Sequence[Simulator], of: Sequence[Simulator], say: Say, folder: Path | None
) -> None:
    if folder is None:
        return
    for each in some:
        place = folder if len(of) == 1 else folder / str(of.index(each) + 1)
        paths = draw(each.sheet, each.machine, place)
        say("Drawn: " + ", ".join(str(path) for path in paths))
