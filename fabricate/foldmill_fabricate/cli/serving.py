"""The service: start it, and say who may use it."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class ScopeChoice(StrEnum):
    """What a token allows."""

    VIEW = "view"
    SUBMIT = "submit"
    OPERATE = "operate"


def add_to(app: typer.Typer) -> None:
    """Add this command to the application."""
    app.command()(serve)


def serve(
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
    from foldmill_fabricate.service.reach import state_folder
    from foldmill_fabricate.service.tokens import Scope, Tokens

    folder = (state or state_folder()).absolute()
    tokens = Tokens(folder)
    if new_token is not None:
        typer.echo(tokens.new(new_token, Scope(scope.value)))
        typer.echo("Keep it: it is not told again.", err=True)
    if revoke_token is not None:
        tokens.revoke(revoke_token)
    if list_tokens:
        for token in tokens.every:
            typer.echo(f"{token.name}  {token.scope.value}")
    if new_token is None and revoke_token is None and not list_tokens:
        _serve(folder, host, port, tuple(name or ()), demand_tokens)


def _serve(folder: Path, host: str, port: int, names: tuple[str, ...], demand: bool) -> None:
    from foldmill_fabricate.service import logs
    from foldmill_fabricate.service.server import policy, serve

    who = policy(folder, host, names, demand)
    logs.configure()
    serve(folder, who, port, lambda url: typer.echo(f"foldmill serves on {url}"))
