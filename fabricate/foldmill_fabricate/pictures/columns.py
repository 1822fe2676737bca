"""The columns of a report over its rows, one graph for each kind, such as thesis Fig. 6.6."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from foldmill import InvalidInput
from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Columns = dict[str, list[float]]

WIDE = 1e3
"""A kind whose values span more than this is drawn with a logarithmic scale."""
ZERO = 1e-16
"""Where a zero is drawn on a logarithmic scale: below any rounding error that is not one."""


def columns_of(figures: Mapping[str, Any]) -> Columns:
    """Return the figures of a report that are lists of numbers, all of one length.

    Raises InvalidInput for a report that has none.
    """
    lists = {name: values for name, values in figures.items() if _is_column(values)}
    longest = max((len(values) for values in lists.values()), default=0)
    found = {name: [float(v) for v in own] for name, own in lists.items() if len(own) == longest}
    if longest < 2:
        raise InvalidInput("This report has no columns to draw or to put in a table; leave -o out.")
    return found


def columns_csv(columns: Columns) -> bytes:
    """Return the columns as CSV, the row's number first."""
    lines = [",".join(["step", *columns])]
    rows = enumerate(zip(*columns.values(), strict=True))
    lines += [",".join([str(step), *map(repr, values)]) for step, values in rows]
    return ("\n".join(lines) + "\n").encode()


def columns_picture(title: str, columns: Columns, suffix: str = ".png") -> bytes:
    """Return graphs of columns, as PNG or SVG by the suffix; alpha_max and alpha_min share one."""
    kinds: dict[str, Columns] = {}
    for name, values in columns.items():
        kinds.setdefault(name.partition("_")[0], {})[name] = values
    with canvas.own_style():
        figure = canvas.figure(110 * len(kinds), 95)
        for k, own in enumerate(kinds.values()):
            axes = figure.add_subplot(1, len(kinds), k + 1)
            _draw(axes, own)
        figure.suptitle(title, fontsize=11)
        figure.tight_layout()
        return canvas.svg(figure) if suffix == ".svg" else canvas.png(figure)


def _draw(axes: Axes, columns: Columns) -> None:
    from matplotlib.ticker import MaxNLocator

    values = [value for own in columns.values() for value in own]
    is_log = min(values) >= 0 and max(values) > WIDE * max(min(values), ZERO)
    for name, own in columns.items():
        shown = [max(value, ZERO) for value in own] if is_log else own
        axes.plot(shown, marker="o", markersize=3.5, linewidth=1.4, label=name.replace("_", " "))
    if is_log:
        axes.set_yscale("log")
    else:
        axes.ticklabel_format(axis="y", useOffset=False)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("step")
    axes.grid(color="#e0e0e0", linewidth=0.6)
    axes.legend(frameon=False, fontsize=8)


def _is_column(values: Any) -> bool:
    is_list = isinstance(values, Sequence) and not isinstance(values, str)
    return is_list and all(type(value) in {int, float} for value in values)
