"""What a machine is told to do in one set-up: the ways of its tool, or of the tool's holder.

Where the machine makes up for a blade's offset, or the tool has none, these are the ways of the
tip. Elsewhere they are the holder's, a lead-in first. They are worked out as the machine sees the
sheet: a mirrored holder's way would not lead a blade along the mirrored line it starts on. And they
go by the machine's own steps, because rounding a holder's way moves the tip.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Operation, SetUp, Stroke
from foldmill_fabricate.toolpath import knife, pulled
from foldmill_fabricate.toolpath.snapping import Grid
from foldmill_fabricate.toolpath.traversal import traversal, traversals

Floats = NDArray[np.float64]
See = Callable[[ArrayLike], Floats]


class Way(NamedTuple):
    """One motion with the tool down."""

    points: Floats
    """(n, 2) mm, as the machine sees the sheet."""
    light: bool = False
    """Whether the blade only rests on the sheet, to be turned."""


class Joined(NamedTuple):
    """Motions with the tool down, one behind the other."""

    points: Floats
    """(n, 2) mm, as the machine sees the sheet."""
    counts: NDArray[np.intp]
    """(k,) of points of each."""
    light: NDArray[np.bool_]
    """(k,) whether the blade only rests on the sheet."""


def joined(setup: SetUp, machine: Machine, see: See) -> Joined:
    """Return the ways of a set-up in order of work, in one array: there may be very many."""
    if machine.tools.host_offset or machine.bed.pull:
        found = ways(setup, machine, see)
        counts = np.array([len(way.points) for way in found], np.intp)
        light = np.array([way.light for way in found], bool)
        return Joined(np.vstack([np.zeros((0, 2)), *(way.points for way in found)]), counts, light)
    laid = [traversals(operation.strokes, operation) for operation in setup.operations]
    counts = np.concatenate([np.zeros(0, np.intp), *(each.counts for each in laid)])
    points = np.vstack([np.zeros((0, 2)), *(each.points for each in laid)])
    return Joined(see(points), counts, np.zeros(len(counts), bool))


def ways(setup: SetUp, machine: Machine, see: See) -> list[Way]:
    """Return the ways of a set-up in order of work; see : sheet points (n, 2) to the machine's."""
    tips: list[Floats] = []
    for operation in setup.operations:
        if machine.bed.pull:
            for stroke in operation.strokes:
                tips += stroke_ways(stroke, operation, machine, see)
            continue
        laid = traversals(operation.strokes, operation)
        tips += np.split(see(laid.points), np.cumsum(laid.counts)[:-1])
    offset = machine.tools.host_offset
    if not offset:
        return [Way(tip) for tip in tips]
    grid = Grid(machine.axes)
    entry = [Way(grid.rounded(see(setup.lead_in)))] if setup.lead_in else []
    heading = knife.last_heading(entry[0].points) if entry else 0.0
    if setup.swivel_force:
        return entry + [Way(*way) for way in knife.lifted_ways(tips, offset, heading, grid)]
    return entry + [Way(way) for way in knife.holder_ways(tips, offset, heading, grid)]


def stroke_ways(stroke: Stroke, operation: Operation, machine: Machine, see: See) -> list[Floats]:
    """Return the ways (n, 2) of the tip along one stroke; several where it may only pull."""
    if machine.bed.pull is None:
        return [see(traversal(stroke, operation))]
    return pulled.ways(stroke, see(np.asarray(stroke.points)), operation, machine.bed.pull)
