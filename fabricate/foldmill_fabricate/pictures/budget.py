"""The error between both faces, cause by cause, beside half the thickness."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from foldmill_fabricate.passes import Budget
from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = ("#3060a0", "#d07020", "#70a050", "#a0c880", "#909090")
"""Of the shares, in their order."""


def budget_picture(budgets: Mapping[str, Budget]) -> bytes:
    """Return a PNG with a bar for each budget by name: its shares end to end, which is the worst
    that can happen, and a mark at what is likely.
    """
    with canvas.own_style():
        figure = canvas.figure(180, 26 + 13 * len(budgets))
        axes = figure.add_axes((0.13, 0.22, 0.84, 0.6))
        names = [*reversed(list(budgets))]
        for row, name in enumerate(names):
            _bar(axes, row, budgets[name])
        axes.set_xlim(0, 1.2 * max(budget.worst for budget in budgets.values()))
        limit = next(iter(budgets.values())).limit
        axes.axvline(limit, color=canvas.ALARM, linewidth=1.4, label="half the thickness")
        axes.set_yticks(range(len(budgets)), names)
        axes.set_xlabel("± mm between the faces, at the worst point")
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        axes.legend(
            loc="lower center", bbox_to_anchor=(0.45, 1.0), ncols=7, frameon=False, fontsize=7
        )
        return canvas.png(figure)


def _bar(axes: Axes, row: int, budget: Budget) -> None:
    left = 0.0
    for share, colour in zip(budget.shares, COLOURS, strict=True):
        label = share.name if row == 0 else None
        axes.barh(row, share.error, 0.6, left, color=colour, label=label)
        left += share.error
    look = {"marker": "D", "color": "black", "markersize": 6, "linestyle": "none"}
    axes.plot([budget.likely], [row], label="likely" if row == 0 else None, **look)  # type: ignore[arg-type]
    axes.text(
        left + 0.01, row, f"{budget.likely:.2f}, at worst {left:.2f}", va="center", fontsize=8
    )
