"""Every preset of every family as a picture, those that move as a moving one, and their page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from foldmill import Design, Fold, Stage
from foldmill.motion import Motion
from foldmill_fabricate.pictures.motion import motion_picture
from foldmill_fabricate.pictures.show import show_picture
from foldmill_fabricate.pictures.stages import stages_picture

PAGE = "gallery.md"
STEPS, PIXELS = 10, 240
"""Of a moving picture: it shows the way, and stays small."""

Folds = Mapping[str, Mapping[str, Fold]]
"""Slug → preset → its fold."""


def made(designs: Mapping[str, Design[Any]]) -> Folds:
    """Return the folds of all presets."""
    return {
        slug: {name: design.run(params) for name, params in design.presets.items()}
        for slug, design in designs.items()
    }


def gallery(designs: Mapping[str, Design[Any]]) -> dict[str, bytes]:
    """Return the files of the gallery by name: a page in Markdown, the pictures of each preset."""
    folds = made(designs)
    files: dict[str, bytes] = {}
    for slug, presets in folds.items():
        for name, fold in presets.items():
            files |= pictures(slug, name, fold, stages_of(designs[slug], name))
    return {**files, PAGE: page(designs, folds).encode()}


def stages_of(design: Design[Any], preset: str) -> tuple[Stage, ...]:
    """Return the shapes on the way to a preset's form, where the family has any."""
    return design.stages(design.preset(preset)) if design.stages else ()


def still_picture(fold: Fold, stages: tuple[Stage, ...]) -> bytes:
    """Return the picture of a preset: pattern and form, and before them what led to it."""
    return stages_picture(fold, stages) if stages else show_picture(fold)


def pictures(
    slug: str, preset: str, fold: Fold, stages: tuple[Stage, ...] = ()
) -> dict[str, bytes]:
    """Return the pictures of a preset by name: how it looks, and how it moves if it does."""
    files = {picture_name(slug, preset): still_picture(fold, stages)}
    motion = shown_motion(fold)
    if motion is not None:
        moving = motion_picture(fold, motion, STEPS, ".gif", PIXELS)
        files[motion_name(slug, preset)] = moving
    return files


def shown_motion(fold: Fold) -> Motion | None:
    """Return the first motion of a fold that moves at all."""
    return next((motion for motion in fold.motions.values() if motion.reach > 0), None)


def page(designs: Mapping[str, Design[Any]], folds: Folds) -> str:
    """Return the gallery's page: each preset with its commands and its pictures."""
    lines = ["# Gallery", "", "Made by the code, from the presets: `make pictures`.", ""]
    for slug, design in designs.items():
        lines += [f"## {design.title} (`{slug}`)", ""]
        for name, fold in folds[slug].items():
            command = f"foldmill design {slug} --preset {name} -o {name}.fold"
            shown = f"![{name}]({picture_name(slug, name)})"
            lines += [f"### {name}", "", f"    {command}", "", shown, ""]
            lines += _moving(slug, name, shown_motion(fold))
    return "\n".join(lines)


def _moving(slug: str, preset: str, motion: Motion | None) -> list[str]:
    if motion is None:
        return []
    chosen = f"--motion {motion.name} --steps {STEPS}"
    command = f"foldmill motion {slug} --preset {preset} {chosen} -o {preset}.gif"
    said = f"{motion.title}. {motion.reason}".strip()
    return [f"    {command}", "", f"![{said}]({motion_name(slug, preset)})", "", said, ""]


def picture_name(slug: str, preset: str) -> str:
    """Return where the picture of a preset lies, beside the page."""
    return f"pictures/{slug}-{preset}.png"


def motion_name(slug: str, preset: str) -> str:
    """Return where the moving picture of a preset lies, beside the page."""
    return f"pictures/{slug}-{preset}.gif"
