"""Things numbered 1, 2, 3 …: put one in or take one out, and the later ones get new numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from foldmill.errors import InvalidParameters

Item = TypeVar("Item")


def inserted(items: Mapping[int, Item], i: int) -> dict[int, int]:
    """Return old number → new number where number i becomes free for another item.

    One above the last number adds at the end. Raises InvalidParameters for any other number that
    is not there.
    """
    last = max(items, default=-1)
    if i != last + 1 and i not in items:
        raise InvalidParameters(
            f"Nothing can be inserted as number {i}: there are {_numbers(items)}, so that a new "
            f"one is number {min(items, default=0)} to {last + 1}."
        )
    return {k: k + (k >= i) for k in items}


def removed(items: Mapping[int, Item], i: int) -> dict[int, int]:
    """Return old number → new number of all items but number i.

    Raises InvalidParameters where there is no such number.
    """
    if i not in items:
        raise InvalidParameters(
            f"There is no number {i} to leave out: there are {_numbers(items)}."
        )
    return {k: k - (k > i) for k in items if k != i}


def moved(items: Mapping[int, Item], numbers: Mapping[int, int]) -> dict[int, Item]:
    """Return the items under their new numbers, ascending."""
    return {numbers[k]: items[k] for k in sorted(numbers, key=numbers.__getitem__)}


def _numbers(items: Mapping[int, object]) -> str:
    return f"{min(items)} to {max(items)}" if items else "none"
