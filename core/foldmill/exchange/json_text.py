"""JSON as a person reads it: one key per line, one vertex, edge or face per line."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from foldmill.errors import UnreadableFile

Frame = dict[str, Any]
"""One frame of a FOLD file, or the whole file."""

_PER_ROW = 12
"""How many plain numbers or letters of an array share a row."""
_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
_EXACT = 2.0**53
"""Beyond this a float says nothing about units, so it is left as it is."""


def plains(values: ArrayLike) -> list[int | float]:
    """Return the numbers of an array in its order, as short as JSON can say them.

    3.0 becomes 3 and -0.0 becomes 0.
    """
    given = np.asarray(values, float).ravel()
    found: list[int | float] = given.tolist()
    whole = (given == np.floor(given)) & (np.abs(given) < _EXACT)
    for k in np.flatnonzero(whole).tolist():
        found[k] = int(found[k])
    return found


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
    if _are_rows(value):
        return _block([f"{indent} [{row}]" for row in _compact(value)[2:-2].split("], [")], indent)
    if _is_flat(value):
        words = _compact(value)[1:-1].split(", ")
        cut = range(0, len(words), _PER_ROW)
        return _block([f"{indent} {', '.join(words[k : k + _PER_ROW])}" for k in cut], indent)
    per_row = 1 if any(isinstance(item, list | dict) for item in value) else _PER_ROW
    rows = [value[k : k + per_row] for k in range(0, len(value), per_row)]
    return _block([f"{indent} {_compact(row)[1:-1]}" for row in rows], indent)


def _are_rows(value: list[Any]) -> bool:
    """Tell whether items are lists of numbers, none of them empty: all are written at once."""
    if not {*map(type, value)} <= {list, tuple} or not all(value):
        return False
    return {*map(type, chain.from_iterable(value))} <= {int, float}


def _is_flat(value: list[Any]) -> bool:
    """Tell whether items are numbers, or words without commas: all of them are written at once."""
    kinds = {*map(type, value)}
    return kinds <= {int, float} or (kinds == {str} and "," not in "".join(value))


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
