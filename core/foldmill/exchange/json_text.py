"""JSON as a person reads it: one key per line, one vertex, edge or face per line."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from foldmill.errors import UnreadableFile

Frame = dict[str, Any]
"""One frame of a FOLD file, or the whole file."""

_PER_ROW = 12
"""How many plain numbers or letters of an array share a row."""
_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
_EXACT = 2.0**53
"""Beyond this a float says nothing about units, so it is left as it is."""


def plain(value: float) -> int | float:
    """Return a number as short as JSON can say it: 3.0 as 3, -0.0 as 0."""
    whole = value.is_integer() and abs(value) < _EXACT
    return int(value) if whole else float(value)


def dump(data: Mapping[str, Any]) -> str:
    """Return a frame, and the frames in it, as JSON text that ends in a newline."""
    text = _mapping(data, "") + "\n"
    # A lone surrogate, which JSON can carry and UTF-8 cannot, becomes its JSON escape.
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _mapping(data: Mapping[str, Any], indent: str) -> str:
    inner = indent + " "
    rows = [f"{inner}{_compact(key)}: {_value(key, item, inner)}" for key, item in data.items()]
    return "{\n" + ",\n".join(rows) + f"\n{indent}}}" if rows else "{}"


def _value(key: str, value: Any, indent: str) -> str:
    if key == "file_frames":
        frames = [f"{indent} {_mapping(frame, indent + ' ')}" for frame in value]
        return _block(frames, indent)
    if key.startswith(("vertices_", "edges_", "faces_")) or key in {"faceOrders", "edgeOrders"}:
        return _elements(value, indent)
    return _compact(value)


def _elements(value: Any, indent: str) -> str:
    if not isinstance(value, list) or not value:
        return _compact(value)
    if all(map(_is_numbers, value)):
        return _block([f"{indent} [{row}]" for row in _compact(value)[2:-2].split("], [")], indent)
    per_row = 1 if any(isinstance(item, list | dict) for item in value) else _PER_ROW
    rows = [value[k : k + per_row] for k in range(0, len(value), per_row)]
    return _block([f"{indent} {_compact(row)[1:-1]}" for row in rows], indent)


def _is_numbers(item: Any) -> bool:
    """Tell whether an item is a list of numbers: many of those are written at once."""
    return type(item) is list and bool(item) and {*map(type, item)} <= {int, float}


def _block(rows: Sequence[str], indent: str) -> str:
    return "[\n" + ",\n".join(rows) + f"\n{indent}]" if rows else "[]"


def _compact(value: Any) -> str:
    return _ENCODER.encode(value)


def parse(text: str) -> Frame:
    """Return the object of a JSON text; raises UnreadableFile with the line where it breaks."""
    try:
        data = json.loads(text.removeprefix("\ufeff"), parse_constant=_no_number)
    except UnreadableFile:
        raise
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise UnreadableFile(f"This is no JSON: {error.msg} at {place}.") from None
    except RecursionError:
        raise UnreadableFile("This JSON is nested too deeply to be a FOLD file.") from None
    except ValueError as error:
        raise UnreadableFile(f"This is no JSON: {error}.") from None
    if not isinstance(data, dict):
        raise UnreadableFile(f"A FOLD file is a JSON object, this one is a {_kind(data)}.")
    return data


def _no_number(word: str) -> float:
    raise UnreadableFile(f"This is no JSON: {word} is no number.")


def _kind(data: object) -> str:
    return {list: "list", str: "text", bool: "truth value", type(None): "null"}.get(
        type(data), "number"
    )
