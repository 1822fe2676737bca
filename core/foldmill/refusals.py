"""What is wrong with parameters, said to a person: which one, what it must be, what it is."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from foldmill.schema import ANY, leaves, objects

_BRANCHES = {"line", "free"}
"""Names of alternatives that pydantic adds to a place; no person wrote them."""
LONGEST = 80
"""Characters of a given value that a sentence repeats."""
_LIMITS = {
    "greater_than": ("more than", "gt"),
    "greater_than_equal": ("at least", "ge"),
    "less_than": ("less than", "lt"),
    "less_than_equal": ("at most", "le"),
}
_SIZES = {
    "string_too_short": ("at least", "min_length", "characters"),
    "string_too_long": ("at most", "max_length", "characters"),
    "too_short": ("at least", "min_length", "entries"),
    "too_long": ("at most", "max_length", "entries"),
}
_KINDS = {
    "bool_parsing": "yes or no",
    "bool_type": "yes or no",
    "dict_type": "a table of names and values",
    "finite_number": "a finite number",
    "float_parsing": "a number",
    "float_type": "a number",
    "int_from_float": "a whole number",
    "int_parsing": "a whole number",
    "int_parsing_size": "a whole number of fewer digits",
    "int_type": "a whole number",
    "list_type": "a list",
    "model_attributes_type": "a table of names and values",
    "model_type": "a table of names and values",
    "string_type": "text",
    "string_unicode": "text in UTF-8",
    "tuple_type": "a list",
}


def explain(error: ValidationError, model: type[BaseModel] | None = None) -> str:
    """Return a sentence for each fault, with the parameter's dotted name.

    model : where given, limits come with their units, and a misspelt name with those there are.
    """
    return " ".join(sentence for _, sentence in sentences(error, model))


def sentences(
    error: ValidationError, model: type[BaseModel] | None = None
) -> list[tuple[tuple[str | int, ...], str]]:
    """Return the place and the sentence of each fault; ``model`` as for ``explain``."""
    schema = model.model_json_schema() if model else {}
    branches = _BRANCHES | set(_tags(schema))
    return [(fault["loc"], _sentence(fault, schema, branches)) for fault in error.errors()]


def sentence_of(fault: Mapping[str, Any], spelled: Mapping[str, str] | None = None) -> str:
    """Return the sentence of one fault, as pydantic describes it.

    spelled : regular expressions that text has to match, and what such a text is called.
    """
    return _sentence(fault, {}, _BRANCHES, spelled or {})


def _tags(node: Any) -> Iterator[str]:
    """Yield the values by which alternatives are told apart; pydantic adds them to a place too."""
    if isinstance(node, dict):
        yield from node.get("discriminator", {}).get("mapping", {})
    for part in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from _tags(part)


def _sentence(
    fault: Mapping[str, Any],
    schema: dict[str, Any],
    branches: set[str],
    spelled: Mapping[str, str] = {},
) -> str:
    path = tuple(str(part) for part in fault["loc"] if part not in branches)
    name, kind, context = ".".join(path), fault["type"], fault.get("ctx", {})
    if kind == "missing":
        return f"{name} is missing: give it a value."
    if kind == "extra_forbidden":
        return f"There is no {name} to set{_known(path, schema)}."
    if kind in _LIMITS and name:
        words, key = _LIMITS[kind]
        limit, unit = context[key], _unit(path, schema)
        return f"{name} must be {words} {limit:g}{unit}, not {_given(fault)}."
    if kind in _KINDS and name:
        return f"{name} must be {_KINDS[kind]}, not {_given(fault)}."
    if kind in {"literal_error", "enum"} and name:
        expected = context["expected"].replace("''", "empty")
        return f"{name} must be {expected}, not {_given(fault)}."
    if kind in _SIZES and name:
        return f"{name} {_size(fault)}"
    if kind == "string_pattern_mismatch" and name:
        words = spelled.get(context["pattern"], f"written as {context['pattern']}")
        return f"{name} must be {words}, not {_given(fault)}."
    if kind == "union_tag_not_found":
        key = context["discriminator"].strip("'")
        return f"{name}.{key} is missing: say which of its kinds it is."
    if kind == "union_tag_invalid":
        key, known = (context[each].strip("'") for each in ("discriminator", "expected_tags"))
        return f"{name}.{key} must be one of '{known}', not {context['tag']!r}."
    said = fault["msg"].removeprefix("Value error, ").rstrip(".")
    shown = "" if isinstance(fault["input"], (Mapping, list, tuple)) else f" (got {_given(fault)})"
    return f"{name}: {said}{shown}." if name else f"{_opened(said)}."


def _size(fault: Mapping[str, Any]) -> str:
    """Return the end of a sentence on something that is too short or too long."""
    words, key, what = _SIZES[fault["type"]]
    limit = fault["ctx"][key]
    if key == "min_length" and limit == 1:
        return "must not be left empty."
    return f"must have {words} {limit} {what}, not {len(fault['input'])}."


def _opened(said: str) -> str:
    """Begin a sentence with a capital, unless it begins with the name of a parameter."""
    first = said.split(" ", 1)[0]
    is_name = "_" in first or "." in first or first.endswith(":")
    return said if is_name else f"{said[:1].upper()}{said[1:]}"


def _given(fault: Mapping[str, Any]) -> str:
    given = fault["input"]
    if isinstance(given, float):
        return "NaN" if math.isnan(given) else f"{given:g}"
    said = repr(given)
    return said if len(said) <= LONGEST else f"{said[: LONGEST - 3]}..."


def _unit(path: tuple[str, ...], schema: dict[str, Any]) -> str:
    units = {leaf.unit for leaf in leaves(schema) if _matches(leaf.kind, path)} if schema else set()
    return f" {units.pop()}" if len(units) == 1 and units != {""} else ""


def _known(path: tuple[str, ...], schema: dict[str, Any]) -> str:
    names = [
        key
        for place, node in (objects(schema) if schema else ())
        if _matches(place, path[:-1])
        for key in node.get("properties", {})
    ]
    return f"; there are {', '.join(dict.fromkeys(names))}" if names else ""


def _matches(kind: str, path: tuple[str, ...]) -> bool:
    parts = kind.split(".") if kind else []
    pairs = zip(parts, path, strict=False)
    return len(parts) == len(path) and all(a in (ANY, b) for a, b in pairs)
