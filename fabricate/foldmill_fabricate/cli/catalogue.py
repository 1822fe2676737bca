"""What there is: families, plugins, materials, machines."""

from __future__ import annotations

from typing import Annotated

import typer

from foldmill_fabricate.cli.output import AsJson, figure_lines, say, table


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    for command in (families, plugins, materials, machines):
        app.command()(command)


def families(as_json: AsJson = False) -> None:
    """List the pattern families: slug, title, presets, owner."""
    from foldmill import installed

    offers = installed().offers.get("foldmill_designs", {})
    found = [
        {
            "slug": slug,
            "title": offer.value.title,
            "presets": sorted(offer.value.presets),
            "owner": offer.owner,
            "plugin": offer.plugin,
        }
        for slug, offer in sorted(offers.items())
    ]
    lines = [(row["slug"], row["title"], ", ".join(row["presets"]), row["owner"]) for row in found]
    text = table([("FAMILY", "TITLE", "PRESETS", "OWNER"), *lines])
    broken = [str(each) for each in installed().broken]
    say(as_json, found, "\n".join([text, *broken]))


def plugins(as_json: AsJson = False) -> None:
    """List the installed plugins, what they offer, and the broken ones."""
    from foldmill import installed

    registry = installed()
    found: dict[tuple[str, str], list[str]] = {}
    for hook, offers in sorted(registry.offers.items()):
        for slug, offer in sorted(offers.items()):
            kind = hook.removeprefix("foldmill_")
            found.setdefault((offer.plugin, offer.owner), []).append(f"{kind}:{slug}")
    rows = [(plugin, owner, " ".join(slugs)) for (plugin, owner), slugs in sorted(found.items())]
    broken = [str(each) for each in registry.broken]
    data = {
        "plugins": [dict(zip(("plugin", "owner", "offers"), row, strict=True)) for row in rows],
        "broken": broken,
    }
    say(as_json, data, "\n".join([table([("PLUGIN", "OWNER", "OFFERS"), *rows]), *broken]))
    if broken:
        raise typer.Exit(1)


Show = Annotated[str | None, typer.Option("--show", help="Show every field of one of them.")]


def materials(show: Show = None, as_json: AsJson = False) -> None:
    """List the sheet materials."""
    _presets("foldmill_materials", "material", show, as_json)


def machines(show: Show = None, as_json: AsJson = False) -> None:
    """List the machines."""
    _presets("foldmill_machines", "machine", show, as_json)


def _presets(hook: str, kind: str, show: str | None, as_json: bool) -> None:
    from foldmill import installed
    from foldmill_fabricate.cli.parameters import rows

    registry = installed()
    if show is None:
        found = [(slug, value.title, value.provenance) for slug, value in registry.of(hook).items()]
        data = [dict(zip(("slug", "title", "provenance"), row, strict=True)) for row in found]
        say(as_json, data, table([row[:2] for row in found]))
        return
    value = registry.get(hook, kind, show)
    fields = {row.name: f"{row.value} {row.unit}".strip() for row in rows(value)}
    say(as_json, value.model_dump(mode="json"), figure_lines(fields))
