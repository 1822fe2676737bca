"""What is wrong with an .obj file, and in which line: its readers do not say.

Only what a triangle mesh needs is looked at: lines ``v x y z`` and ``f a b c``, whose numbers count
corners from 1, or backwards from −1 (Wavefront's format, "Polygonal and free-form geometry").
"""

from __future__ import annotations

from math import isfinite

SHOWN = 30
"""Characters of a line that are repeated."""


def first_fault(content: bytes) -> str:
    """Return what is wrong first, a clause without its full stop; empty for nothing."""
    lines = content.decode("utf-8", "replace").splitlines()
    corners = facets = 0
    last = sum(line.split()[:1] == ["v"] for line in lines)
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].split()
        if words[:1] == ["v"]:
            corners, fault = corners + 1, _corner(words[1:])
        elif words[:1] == ["f"]:
            facets, fault = facets + 1, _facet(words[1:], corners, last)
        else:
            continue
        if fault:
            shown = line.strip()
            shown = shown if len(shown) <= SHOWN else f"{shown[:SHOWN]}…"
            return f"line {number} ({shown}) {fault}"
    if not corners or not facets:
        return f'it holds {corners} corners (lines "v x y z") and {facets} facets (lines "f a b c")'
    return ""


def _corner(words: list[str]) -> str:
    try:
        place = [float(word) for word in words]
    except ValueError:
        return "holds something that is no number"
    if len(place) < 3:
        return f"has {len(place)} coordinates, not 3"
    return "" if all(map(isfinite, place[:3])) else "is at no finite place"


def _facet(words: list[str], corners: int, last: int) -> str:
    try:
        named = [int(word.split("/")[0]) for word in words]
    except ValueError:
        return "holds something that is no number of a corner"
    if len(named) < 3:
        return f"has {len(named)} corners, not 3"
    for each in named:
        if not (1 <= each <= last or -corners <= each <= -1):
            return f"names corner {each}, and there are {last}"
    return ""
