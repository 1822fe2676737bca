"""How text lies on a terminal: columns that fit it, long lines that go on under their beginning."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from shutil import get_terminal_size
from textwrap import wrap

GAP = 2
"""Blanks between two columns."""
LEAST = 12
"""Letters to which a column may be narrowed; in a narrower terminal the lines are too long."""


def terminal_width() -> int | None:
    """Return the columns of the terminal; None where text goes into a file or another program.

    There a row stays one line, so that ``grep`` and ``cut`` find it whole.
    """
    return get_terminal_size().columns if sys.stdout.isatty() else None


def table(rows: Iterable[tuple[str, ...]], width: int | None = None) -> str:
    """Return rows in aligned columns; what is too wide for so many letters goes on below.

    width : default: the terminal's; none where there is no terminal.
    """
    listed = list(rows)
    if not listed:
        return ""
    columns = zip(*listed, strict=True)
    wanted, words = zip(*map(_wanted, columns), strict=True)
    limit = width or terminal_width()
    widths = wanted if limit is None else _fitted(wanted, words, limit)
    return "\n".join(line for row in listed for line in _lines(row, widths))


def hanging(text: str, indent: str, width: int | None = None) -> str:
    """Return a line that goes on under ``indent`` where it is too long; its own breaks stay."""
    limit = width or terminal_width()
    if limit is None:
        return text
    lines = [_wrapped(line, max(limit, len(indent) + LEAST), indent) for line in text.split("\n")]
    return "\n".join(part for line in lines for part in line)


def moment(when: str) -> str:
    """Return a time of day as people read it: 2026-11-22 19:54:40 UTC, from ISO 8601."""
    from datetime import UTC, datetime

    return f"{datetime.fromisoformat(when).astimezone(UTC):%Y-%m-%d %H:%M:%S} UTC"


def _wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """Return lines between whose words alone they are broken: a name stays one."""
    return wrap(
        text, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    ) or [""]


def _wanted(column: Sequence[str]) -> tuple[int, int]:
    """Return the letters of a column's longest cell and of its longest word."""
    return max(map(len, column)), max(len(word) for cell in column for word in [*cell.split(), ""])


def _fitted(wanted: Sequence[int], words: Sequence[int], limit: int) -> list[int]:
    """Narrow the widest columns alike until all fit, but none below its longest word."""
    room = limit - GAP * (len(wanted) - 1)
    widths = list(wanted)
    while sum(widths) > room:
        wide = [k for k, width in enumerate(widths) if width > max(LEAST, words[k])]
        if not wide:
            break
        widths[max(wide, key=widths.__getitem__)] -= 1
    return widths


def _lines(row: tuple[str, ...], widths: Sequence[int]) -> list[str]:
    """Return the lines of one row."""
    cells = [
        [cell] if len(cell) <= width else _wrapped(cell, width)
        for cell, width in zip(row, widths, strict=True)
    ]
    return [
        (" " * GAP)
        .join(
            (cell[k] if k < len(cell) else "").ljust(width)
            for cell, width in zip(cells, widths, strict=True)
        )
        .rstrip()
        for k in range(max(map(len, cells)))
    ]
