"""The service: start it, and say who may use it."""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class ScopeChoice(StrEnum):
    """What a token allows."""

    VIEW = "view"
    SUBMIT = "submit"
    OPERATE = "operate"


_GREETING = "foldmill serves on {}\nplotters: {}"
"""What a terminal hears first, when it is served; the log goes to standard error."""


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command(name="serve")(serve_command)


def serve_command(
    host: Annotated[str, typer.Option(help="Address to serve on; others demand tokens.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes a free one.")] = 8765,
    name: Annotated[
        list[str] | None, typer.Option(help="A further name it is reached by, as of a proxy.")
    ] = None,
    state: Annotated[
        Path | None, typer.Option(help="Folder for what it keeps; default: beside the ledger.")
    ] = None,
    plotter: Annotated[
        list[str] | None,
        typer.Option(help="A plotter beside those of plotters.toml: NAME=PORT@MACHINE."),
    ] = None,
    keep_days: Annotated[
        int,
        typer.Option(
            min=1, help="Days for which what no job needs is kept after it was last asked for."
        ),
    ] = 30,
    host_name: Annotated[
        str, typer.Option(help="Of this computer, always the same; with a database of many.")
    ] = "",
    demand_tokens: Annotated[
        bool, typer.Option("--demand-tokens", help="Demand tokens even on this computer.")
    ] = False,
    new_token: Annotated[
        str | None, typer.Option(metavar="NAME", help="Make a token for somebody, tell it, end.")
    ] = None,
    scope: Annotated[ScopeChoice, typer.Option(help="What the new token allows.")] = (
        ScopeChoice.VIEW
    ),
    revoke_token: Annotated[
        str | None, typer.Option(metavar="NAME", help="Let a token no longer count, and end.")
    ] = None,
    list_tokens: Annotated[
        bool, typer.Option("--list-tokens", help="List the names of tokens, and end.")
    ] = False,
) -> None:
    """Serve the HTTP API and run the jobs of this computer's plotters, until Ctrl-C or SIGTERM."""
    from foldmill_fabricate.jobs import Places
    from foldmill_fabricate.service.tokens import Scope, Tokens

    places = Places() if state is None else Places(state.absolute())
    places = replace(places, keep_days=keep_days)
    tokens = Tokens(places.root)
    if new_token is not None:
        typer.echo(tokens.new(new_token, Scope(scope.value)))
        typer.echo("Keep it: it is not told again.", err=True)
    if revoke_token is not None:
        tokens.revoke(revoke_token)
    if list_tokens:
        for token in tokens.every:
            typer.echo(f"{token.name}  {token.scope.value}")
    if new_token is None and revoke_token is None and not list_tokens:
        _require_packages()
        from foldmill_fabricate.jobs import plotters
        from foldmill_fabricate.service import logs
        from foldmill_fabricate.service.server import policy, serve
        from foldmill_fabricate.service.workshop import Workshop

        who = policy(places.root, host, tuple(name or ()), demand_tokens)
        known = plotters.read(more=plotter or ())
        there = ", ".join(sorted(known)) or (
            f"none yet: name them in {plotters.plotters_file()}, or with --plotter"
        )
        workshop = Workshop(places, known, host_name)
        logs.configure()
        serve(workshop, who, port, lambda url: typer.echo(_GREETING.format(url, there)))


def _require_packages() -> None:
    """Raise FoldmillError where a package of the service is missing."""
    from importlib.util import find_spec

    from foldmill import FoldmillError
    from foldmill_fabricate.cli.working import MISSING

    if any(find_spec(name) is None for name in ("fastapi", "uvicorn", "prometheus_client", "dbos")):
        raise FoldmillError(MISSING)
