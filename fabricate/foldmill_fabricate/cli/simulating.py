"""Being a plotter: the simulator behind serial and TCP ports."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from foldmill import FoldmillError


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(simulate)


def simulate(
    machine: Annotated[
        str, typer.Option(help="A slug of `foldmill machines`.")
    ] = "generic-hpgl-600",
    pty: Annotated[
        list[str] | None,
        typer.Option(help="Offer a serial port, with this symbolic link to it; repeatable."),
    ] = None,
    tcp: Annotated[
        list[str] | None, typer.Option(help="Offer a TCP port of this number; repeatable.")
    ] = None,
    rfc2217: Annotated[
        list[str] | None,
        typer.Option(help="Offer a network serial port of this number; repeatable."),
    ] = None,
    draw: Annotated[Path | None, typer.Option(help="A folder for front and reverse.")] = None,
    speed_up: Annotated[float, typer.Option(help="How many times faster than the machine.")] = 1.0,
    buffer: Annotated[int | None, typer.Option(help="Bytes of its buffer.")] = None,
    handshake: Annotated[
        str | None, typer.Option(help="none, xon-xoff, rts-cts, dtr, esc-b or enq-ack.")
    ] = None,
    fault: Annotated[
        list[str] | None,
        typer.Option(help="NAME@PLACE[xAMOUNT][:SECONDS], such as stall@3strokes:5s; repeatable."),
    ] = None,
    quirk: Annotated[
        list[str] | None, typer.Option(help="A habit, such as second-in-cancels; repeatable.")
    ] = None,
    live: Annotated[
        bool | None, typer.Option(help="Redraw a table of what it does; on a terminal it does.")
    ] = None,
    imperfect: Annotated[
        str,
        typer.Option(
            help="What it makes off: scale_x=1.003,scale_y=1.003,skew=0.1,flip_dx=0.35,flip_dy=0.2 "
            "(mm, degrees), or some of them."
        ),
    ] = "",
) -> None:
    """Be one plotter or several behind serial or TCP ports, and draw what is cut on each face.

    Each port may have options of its own: --tcp "9100?machine=hp-7475a&fault=silence@500".
    """
    from foldmill_fabricate.plotter.simulator import run
    from foldmill_fabricate.plotter.simulator.offers import offer

    if not (pty or tcp or rfc2217):
        raise FoldmillError(
            "Say where the simulator is found: --pty LINK, --tcp PORT or --rfc2217 PORT."
        )
    options = {"machine": machine, "speed_up": str(speed_up)}
    options |= {"buffer": str(buffer)} if buffer is not None else {}
    options |= {"handshake": handshake} if handshake is not None else {}
    options |= {"fault": ",".join(fault or []), "quirk": ",".join(quirk or [])}
    options |= dict(_pair(each) for each in imperfect.split(",") if each.strip())
    offers = [offer("pty", each, options) for each in pty or []]
    offers += [offer("tcp", each, options) for each in tcp or []]
    offers += [offer("rfc2217", each, options) for each in rfc2217 or []]
    terminal = sys.stdout.isatty() if live is None else live
    run.run(offers, sys.stdin, typer.echo, draw, terminal)


def _pair(text: str) -> tuple[str, str]:
    name, _, value = text.strip().partition("=")
    return name.strip(), value.strip()
