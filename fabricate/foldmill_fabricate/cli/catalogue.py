"""What there is: families, plugins, materials, machines, profiles of drawings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import AsJson, say

if TYPE_CHECKING:
    from foldmill_fabricate.machines import Machine
    from foldmill_fabricate.materials import Material
    from foldmill_fabricate.presets import Sourced


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    for command in (families, plugins, materials, machines, profiles):
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


LONG = 60
"""Letters from which on a value stands below the table."""
Show = Annotated[str | None, typer.Option("--show", help="Show every field of one of them.")]


def materials(show: Show = None, as_json: AsJson = False) -> None:
    """List the sheet materials."""
    from foldmill_fabricate.materials import Material

    _presets(Material, show, as_json)


def machines(show: Show = None, as_json: AsJson = False) -> None:
    """List the machines."""
    from foldmill_fabricate.machines import Machine

    _presets(Machine, show, as_json)


def _presets(model: type[Material] | type[Machine], show: str | None, as_json: bool) -> None:
    from foldmill_fabricate import shelf
    from foldmill_fabricate.machines import Machine
    from foldmill_fabricate.materials import Material

    if show is not None:
        found = shelf.material(show) if model is Material else shelf.machine(show)
        say(as_json, found.model_dump(mode="json"), described(found))
        return
    every = shelf.everything(Material) if model is Material else shelf.everything(Machine)
    rows = [
        {
            "slug": slug,
            "title": value.title,
            "provenance": value.provenance,
            "owner": every.owners[slug],
        }
        for slug, value in every.presets.items()
    ]
    lines = [("SLUG", "TITLE", "OWNER")]
    lines += [(row["slug"], row["title"], row["owner"]) for row in rows]
    say(as_json, rows, "\n".join([table(lines), *every.broken]))
    if every.broken:
        raise typer.Exit(1)


def described(preset: Sourced) -> str:
    """Return every field of a preset with its unit and where its value comes from."""
    from foldmill_fabricate.presets import rows, shown

    told = [(row, _with_unit(shown(row.value), row.unit)) for row in rows(preset)]
    lines = [("FIELD", "VALUE", "SOURCE")]
    lines += [
        (row.name, value, preset.sources.get(row.name, ""))
        for row, value in told
        if len(value) <= LONG
    ]
    texts = [f"{row.name}: {value}" for row, value in told if len(value) > LONG]
    return "\n".join([table(lines), *texts])


def _with_unit(value: str, unit: str) -> str:
    """Return a value and its unit; what has none is a dash alone."""
    return value if value == "-" else f"{value} {unit}".strip()


def profiles(show: Show = None, as_json: AsJson = False) -> None:
    """List the profiles of drawings, or the legend of one: a name or a TOML file."""
    from foldmill_fabricate import profiles as known

    if show is None:
        found = {name: known.find(name).title for name in known.names()}
        say(as_json, found, table([("PROFILE", "TITLE"), *found.items()]))
        return
    one = known.find(show)
    rows = [
        (look.name, look.colour, str(look.aci), str(look.pen), about)
        for look, about in known.legend(one)
    ]
    text = table([("LAYER", "SVG", "DXF", "PEN", "FOR"), *rows])
    said = f"{one.slug}: {one.title}\n{one.provenance}\n{text}"
    say(as_json, one.model_dump(mode="json"), said)
