"""Every preset of every family as a picture, and a page that shows them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from foldmill import Design
from foldmill_fabricate.pictures.show import show_picture

PAGE = "gallery.md"


def gallery(designs: Mapping[str, Design[Any]]) -> dict[str, bytes]:
    """Return the files of the gallery by name: a page in Markdown, a PNG for each preset."""
    files = {
        picture_name(slug, name): show_picture(design.run(params))
        for slug, design in designs.items()
        for name, params in design.presets.items()
    }
    return {**files, PAGE: page(designs).encode()}


def page(designs: Mapping[str, Design[Any]]) -> str:
    """Return the gallery's page: each preset with its command and its picture."""
    lines = ["# Gallery", "", "Made by the code, from the presets: `make pictures`.", ""]
    for slug, design in designs.items():
        lines += [f"## {design.title} (`{slug}`)", ""]
        for name in design.presets:
            command = f"foldmill design {slug} --preset {name} -o {name}.fold"
            shown = f"![{name}]({picture_name(slug, name)})"
            lines += [f"### {name}", "", f"    {command}", "", shown, ""]
    return "\n".join(lines)


def picture_name(slug: str, preset: str) -> str:
    """Return where the picture of a preset lies, beside the page."""
    return f"pictures/{slug}-{preset}.png"
