"""CFF2 drawings, ``.cf2``: what makers of dies and of digital cutting tables exchange.

One file for each face, as the machine sees it: the format has no word for the reverse that every
reader takes for the same. Lines carry a type (1 cut, 2 crease, 3 perforation, by the profile), mm.
Ties are real gaps, so no line has a bridge; a perforation is one line again, because its type says
that the reader makes the dashes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.formats.svg import number
from foldmill_fabricate.materials.processes import Perforation
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Style, find

Floats = NDArray[np.float64]

WEIGHT = 2
"""Points of thickness of a rule: what stands first in every line."""
_ONE_ROW = 1.5
"""Times the gap of a perforation: dashes farther apart belong to two creases."""
_PLACES = 5
"""Decimals of direction and distance to which dashes lie on one line."""


def write(plan: Plan, fold: Fold, style: Style | None = None) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``front.cf2`` and ``reverse.cf2``; style : the profile with the types of lines."""
    profile = style.profile if style else find()
    views = islice(d.drawings(plan, profile), len(plan.passes))  # the faces, not the master
    return {f"{view.name}.cf2": _cf2(plan, view) for view in views}


def _cf2(plan: Plan, view: d.Drawing) -> bytes:
    corner = f"{number(view.width)},{number(view.height)}"
    title = re.sub(r"[^A-Za-z0-9]+", "_", f"{plan.title} {view.name}").strip("_")
    head = ["$BOF", "V2", "ORDER", "END", f"MAIN,{title}", "UM", "LL,0,0", f"UR,{corner}"]
    lines = [line for group in view.groups for line in _group(plan, view, group)]
    return "\r\n".join([*head, "SCALE,1,1", *lines, "END", "$EOF", ""]).encode("ascii")


def _group(plan: Plan, view: d.Drawing, group: d.Group) -> Iterator[str]:
    score = plan.material.score
    lines = list(group.lines)
    if group.layer is view.layers.perforation and isinstance(score, Perforation):
        others = [line for line in lines if len(line) != 2]
        lines = rows([line for line in lines if len(line) == 2], _ONE_ROW * score.gap) + others
    begin = f"L,{WEIGHT},{group.layer.cf2},0,"
    for x, y, u, v in zip(*segments(lines).T.tolist(), strict=True):
        yield f"{begin}{number(x)},{number(y)},{number(u)},{number(v)},0,0"


def segments(lines: Sequence[Floats]) -> Floats:
    """Return the straight pieces of lines (n, 2) mm, in order: x, y, x, y of each (k, 4)."""
    if not lines:
        return np.zeros((0, 4))
    points = np.vstack(lines)
    inner = np.ones(len(points), bool)
    inner[np.cumsum([len(line) for line in lines]) - 1] = False
    begins = np.flatnonzero(inner)
    return np.hstack([points[begins], points[begins + 1]])


def rows(dashes: Iterable[Floats], apart: float) -> list[Floats]:
    """Join dashes (2, 2) on one straight line that are at most ``apart`` mm apart.

    In order of each row's first dash; every row (2, 2) runs from its first end to its last.
    """
    ends = np.array(list(dashes))
    steps = ends[:, 1] - ends[:, 0]
    along = steps / np.hypot(*steps.T)[:, None]
    along *= np.where((np.round(along, _PLACES) @ (2.0, 1e-3)) < 0, -1.0, 1.0)[:, None]
    angle = np.round(np.arctan2(along[:, 1], along[:, 0]), _PLACES)
    off = np.round(along[:, 0] * ends[:, 0, 1] - along[:, 1] * ends[:, 0, 0], _PLACES - 2)
    places = np.sort(np.einsum("dek,dk->de", ends, along), axis=1)
    order = np.lexsort([places[:, 0], off, angle])
    same = (angle[order][1:] == angle[order][:-1]) & (off[order][1:] == off[order][:-1])
    near = places[order][1:, 0] - places[order][:-1, 1] <= apart
    row = np.concatenate([[0], np.cumsum(~(same & near))])
    found: dict[int, list[int]] = {}
    for k, of in sorted(zip(order.tolist(), row.tolist(), strict=True)):
        found.setdefault(of, []).append(k)
    return [_row(ends[members], along[members[0]]) for members in found.values()]


def _row(dashes: Floats, along: Floats) -> Floats:
    points = dashes.reshape(-1, 2)
    places = points @ along
    result: Floats = points[[int(places.argmin()), int(places.argmax())]]
    return result
