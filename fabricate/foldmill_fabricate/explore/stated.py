"""What all rows of a sweep share, in words: the nearest preset, and what differs from it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from foldmill import Design, Params
from foldmill.schema import leaves
from foldmill_fabricate.explore.sweep import Sweep

MOST = 4
"""Parameters that are told one by one."""
DEFAULTS = "defaults"
_ABSENT = object()


def stated(sweep: Sweep[Any]) -> str:
    """Return the preset and the parameters that are not as in it: "vase, phi = 90 deg".

    What varies is left out.
    """
    here = _values(sweep.base)
    fixed = [name for name in here if name not in {axis.name for axis in sweep.grid.axes}]
    name, there = min(_known(sweep.design), key=lambda known: _distance(known[1], here, fixed))
    other = [each for each in fixed if there.get(each, _ABSENT) != here[each]]
    told = [_told(sweep.base, each, here[each]) for each in other[:MOST]]
    more = [f"and {len(other) - MOST} more"] if len(other) > MOST else []
    gone = ["without some of its parts"] if set(there) - set(here) else []
    return ", ".join([name, *told, *more, *gone])


def _known(design: Design[Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the presets, then the defaults, where there are any."""
    for name, preset in design.presets.items():
        yield name, _values(preset)
    try:
        yield DEFAULTS, _values(design.params())
    except ValidationError:
        return


def _distance(there: dict[str, Any], here: dict[str, Any], fixed: list[str]) -> int:
    """Return how many parameters differ, or are there and not here."""
    missing = len(set(there) - set(here))
    return missing + len([name for name in fixed if there.get(name, _ABSENT) != here[name]])


def _values(params: Params) -> dict[str, Any]:
    return dict(_flat("", params.model_dump(mode="json")))


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield what has no parts, by dotted name."""
    if not isinstance(value, dict | list):
        yield name, value
        return
    for key, part in value.items() if isinstance(value, dict) else enumerate(value):
        yield from _flat(f"{name}.{key}" if name else str(key), part)


def _told(base: Params, name: str, value: Any) -> str:
    known = leaves(base.model_json_schema(), base.model_dump(mode="json"))
    unit = next((leaf.unit for leaf in known if leaf.name == name and leaf.unit), "")
    words = f"{value:.6g}" if isinstance(value, float) else str(value).lower()
    return f"{name} = {words} {unit}".rstrip()
