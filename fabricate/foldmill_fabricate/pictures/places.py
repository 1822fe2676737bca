"""Where planning found something: the sheet with numbered marks, and what they stand for."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from textwrap import fill
from typing import TYPE_CHECKING, NamedTuple

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures import canvas, sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = {Severity.ERROR: "#d01010", Severity.WARNING: "#c07000", Severity.INFO: "#306090"}
TOLD = 10
"""Places that are written out; the others are marked as well."""
NEAR = 3.0
"""mm. Findings of one kind this near to each other are one place."""
WIDTH = 135
"""Letters in a line of words."""


class Place(NamedTuple):
    """A place of the sheet, mm, and what was found there: the first, and how many of its kind."""

    at: tuple[float, float]
    finding: Finding
    times: int


def places_picture(plan: Plan) -> bytes:
    """Return a PNG of the sheet from the front, a mark at every place where something was found."""
    found = places(plan.findings)
    with canvas.own_style():
        figure = canvas.figure(200, 290)
        axes = canvas.flat_axes(figure, (0.03, 0.32, 0.94, 0.62))
        sheet.draw(axes, plan)
        for number, place in enumerate(found, start=1):
            _mark(axes, number, place)
        alike = f", the same on each of {plan.quantity} copies" if plan.quantity > 1 else ""
        figure.suptitle(f"{plan.title}: {_count(len(found))}{alike}", fontsize=11)
        figure.text(0.04, 0.25, _words(found), fontsize=6.5, va="top")
        return canvas.png(figure)


def places(findings: Sequence[Finding]) -> list[Place]:
    """Return the places of findings that have one, errors first."""
    order = list(COLOURS)
    found: list[Place] = []
    for finding in sorted(findings, key=lambda finding: order.index(finding.severity)):
        if finding.at is None:
            continue
        for k, place in enumerate(found):
            if place.finding.code == finding.code and dist(place.at, finding.at) <= NEAR:
                found[k] = place._replace(times=place.times + 1)
                break
        else:
            found.append(Place(finding.at, finding, 1))
    return found


def _mark(axes: Axes, number: int, place: Place) -> None:
    colour = COLOURS[place.finding.severity]
    x, y = place.at
    axes.plot(
        [x], [y], "o", markersize=12, color=colour, fillstyle="none", markeredgewidth=1.6, zorder=6
    )
    look = {"fontsize": 9, "color": colour, "weight": "bold", "textcoords": "offset points"}
    axes.annotate(str(number), place.at, xytext=(8, 8), **look)  # type: ignore[arg-type]


def _words(found: Sequence[Place]) -> str:
    told = []
    for number, (_, finding, times) in enumerate(found[:TOLD], start=1):
        more = f" ({times - 1} more of this kind there.)" if times > 1 else ""
        told.append(fill(f"{number}  {finding.severity}: {finding}{more}", WIDTH))
    left = len(found) - TOLD
    return "\n".join([*told, *([f"and {left} more places"] if left > 0 else [])])


def _count(count: int) -> str:
    if not count:
        return "nothing was found at any place"
    return "one place to look at" if count == 1 else f"{count} places to look at"
