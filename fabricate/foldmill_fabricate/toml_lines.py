"""On which line of a TOML file a field stands, so that a person finds what is refused."""

from __future__ import annotations

import re
from collections.abc import Sequence

_TABLE = re.compile(r"\s*\[\s*([^\[\]]+?)\s*\]\s*(?:#.*)?$")
_ELEMENT = re.compile(r"\s*\[\[\s*([^\[\]]+?)\s*\]\]\s*(?:#.*)?$")
_KEY = re.compile(r"""\s*((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*=""")
_PART = re.compile(r""""([^"]*)"|'([^']*)'|([\w-]+)""")


def line_of(text: str, place: Sequence[str | int]) -> int:
    """Return the line, from 1, of the field at a place, or of the nearest thing that holds it.

    Parts of the place that stand nowhere in the file (names of alternatives) are passed over.
    """
    best, depth = 1, -1
    wanted = [str(part) for part in place]
    for number, path in _places(text):
        if len(path) > depth and _leads_to(path, wanted):
            best, depth = number, len(path)
    return best


def _leads_to(path: list[str], wanted: list[str]) -> bool:
    """Tell whether the parts of a path occur in order, from the first on, in the place wanted."""
    if not path or not wanted or path[0] != wanted[0]:
        return False
    rest = iter(wanted)
    return all(part in rest for part in path)


def _places(text: str) -> list[tuple[int, list[str]]]:
    table: list[str] = []
    counts: dict[str, int] = {}
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        if element := _ELEMENT.match(line):
            name = element[1]
            counts[name] = counts.get(name, -1) + 1
            table = [*_split(name), str(counts[name])]
        elif header := _TABLE.match(line):
            table = _split(header[1])
        elif key := _KEY.match(line):
            found.append((number, [*table, *_split(key[1])]))
            continue
        else:
            continue
        found.append((number, table))
    return found


def _split(name: str) -> list[str]:
    return [next(part for part in match if part) for match in _PART.findall(name)]
