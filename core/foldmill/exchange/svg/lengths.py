"""Lengths of SVG and the size of its drawing."""

from __future__ import annotations

import re
from collections.abc import Mapping

from foldmill.errors import UnreadableFile

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([a-zA-Z%]*)\s*")
_PX = {
    "": 1.0,
    "px": 1.0,
    "mm": 96 / 25.4,
    "cm": 960 / 25.4,
    "q": 24 / 25.4,
    "in": 96.0,
    "pt": 96 / 72,
    "pc": 16.0,
}
"""px per unit, by CSS: 96 px are an inch."""
PX_MM = 25.4 / 96


def length(text: str, name: str) -> tuple[float, str]:
    """Return a number and its unit, in small letters; raises UnreadableFile for no length."""
    found = _LENGTH.fullmatch(text)
    if not found:
        raise UnreadableFile(f"The {name} {text.strip()[:40]!r} is no length.")
    return float(found[1]), found[2].lower()


def px(attributes: Mapping[str, str], name: str, default: float = 0.0) -> float:
    """Return an attribute in px; raises UnreadableFile for no length and for shares of a page."""
    if name not in attributes:
        return default
    value, unit = length(attributes[name], name)
    if unit not in _PX:
        raise UnreadableFile(
            f"The {name} {attributes[name].strip()[:40]!r} is in {unit}, which says no length of "
            f"its own; write it in mm or without a unit."
        )
    return value * _PX[unit]


def numbers(text: str, name: str) -> list[float]:
    """Return numbers parted by spaces and commas; raises UnreadableFile for anything else."""
    rest = re.sub(NUMBER, " ", text)
    if rest.strip(" ,\t\r\n\f"):
        raise UnreadableFile(f"The {name} {text.strip()[:40]!r} holds what is no number.")
    return [float(each) for each in re.findall(NUMBER, text)]


def page(attributes: Mapping[str, str]) -> tuple[float, float, float | None]:
    """Return how a drawing's units go to px along x and y, and mm per px where it says any.

    A drawing whose width is in mm, cm, in, pt or pc says how large it is; px are what each program
    likes, 72 or 96 to the inch, and so say nothing.
    """
    scales: list[float] = []
    is_physical = False
    box = numbers(attributes.get("viewBox", ""), "viewBox")
    for name, side in (("width", 2), ("height", 3)):
        if name not in attributes or attributes[name].strip() == "auto":
            continue
        value, unit = length(attributes[name], name)
        if unit not in _PX:
            continue
        is_physical |= unit not in {"", "px"}
        if len(box) == 4 and box[side] > 0 and value > 0:
            scales.append(value * _PX[unit] / box[side])
    across = _uniform(scales, attributes.get("preserveAspectRatio", ""))
    return *across, PX_MM if is_physical else None


def refuse_unplaced(attributes: Mapping[str, str]) -> None:
    """Refuse a drawing in a drawing whose viewBox does not fill a place of a size of its own."""
    box = numbers(attributes.get("viewBox", ""), "viewBox")
    if len(box) != 4 or attributes.get("preserveAspectRatio", "").split()[:1] == ["none"]:
        return
    wide, high = px(attributes, "width"), px(attributes, "height")
    if not (wide > 0 and high > 0 and abs(wide * box[3] - high * box[2]) <= 1e-6 * wide * box[3]):
        raise UnreadableFile(
            "A drawing within this drawing (<svg> in <svg>, or a <symbol>) has a viewBox of other "
            "proportions than its width and height, or no such size; write both alike."
        )


def _uniform(scales: list[float], aspect: str) -> tuple[float, float]:
    if not scales:
        return 1.0, 1.0
    if len(scales) == 2 and aspect.split()[:1] == ["none"]:
        return scales[0], scales[1]
    both = max(scales) if "slice" in aspect else min(scales)
    return both, both
