"""The dihedral angles of a vertex over a motion, as a plot (thesis figure 5.10 and its like)."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from foldmill.dihedral import DihedralTable
from foldmill.motion import Motion
from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ALIKE_DEG = 1e-6
"""Creases whose angles differ by no more, all the way, are one line: mirror images."""

MOST_NAMED = 3
"""Creases named for one line; round the centre of a form there are as many as wedges."""


def angles_picture(table: DihedralTable, motion: Motion, suffix: str = ".png") -> bytes:
    """Return a plot of every crease's interior dihedral angle, as PNG or SVG by the suffix."""
    with canvas.own_style():
        figure = canvas.figure(200, 130)
        axes = figure.add_axes((0.09, 0.12, 0.62, 0.78))
        _draw(axes, table, motion)
        axes.set_title(f"{motion.title}: vertex {table.vertex}", fontsize=10)
        return canvas.svg(figure) if suffix == ".svg" else canvas.png(figure)


def groups(table: DihedralTable) -> list[list[int]]:
    """Return the columns of the table, those together whose angles are the same all the way."""
    found: list[list[int]] = []
    for k in range(len(table.names)):
        for group in found:
            if np.abs(table.angles[:, k] - table.angles[:, group[0]]).max() <= ALIKE_DEG:
                group.append(k)
                break
        else:
            found.append([k])
    return found


def _label(table: DihedralTable, group: list[int]) -> str:
    names = [table.names[k] for k in group]
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return ", ".join(names[:MOST_NAMED]) + more


def _draw(axes: Axes, table: DihedralTable, motion: Motion) -> None:
    measure = motion.measure
    progress = [measure.at(float(t)) for t in table.times]
    for group in groups(table):
        angles = table.angles[:, group[0]]
        axes.plot(progress, angles, label=_label(table, group), linewidth=1.6)
    axes.set_xlim(measure.at(0.0), measure.at(1.0))
    axes.set_ylim(-4, 184)
    axes.set_yticks(range(0, 181, 30))
    axes.set_xlabel(f"{measure.name} ({measure.unit})" if measure.unit else measure.name)
    axes.set_ylabel("dihedral angle (°)")
    axes.grid(color="#e0e0e0", linewidth=0.6)
    if motion.reason:
        stop = measure.at(motion.reach)
        axes.axvline(stop, color="black", linestyle="--", linewidth=1.0)
        axes.text(1.03, 0.0, fill(motion.reason, 34), transform=axes.transAxes, fontsize=8)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=8)
