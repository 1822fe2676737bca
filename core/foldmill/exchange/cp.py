"""The .cp format of ORIPA and its kin: a line of text for each line, ``type x1 y1 x2 y2``.

Types: 1 border or cut, 2 mountain, 3 valley, 0 and all others auxiliary. Seen on a screen, so y
points downward; no unit; every crease folds flat.
"""

from __future__ import annotations

from foldmill.design import Fold
from foldmill.errors import UnreadableFile
from foldmill.exchange import plain_lines
from foldmill.exchange.drawing import Drawing, Look, drawing_of
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.plain_lines import AUXILIARY, LOOKS

_MOST_TYPE = 99
"""Types up to here are taken for auxiliary lines; a larger number is no type of line."""


def read(text: str, limits: Limits = DEFAULT) -> Drawing:
    """Return the lines of a .cp file; raises UnreadableFile with the number of the wrong line."""
    segments: list[tuple[float, ...]] = []
    looks: list[Look] = []
    for number, row in enumerate(text.removeprefix("\ufeff").splitlines(), 1):
        words = row.split()
        if not words:
            continue
        limits.check_lines(len(segments) + 1)
        kind, ends = _numbers(words, number)
        segments.append(ends)
        looks.append(LOOKS.get(kind, LOOKS[AUXILIARY]))
    return drawing_of(segments, looks, down=True, limits=limits)


def _numbers(words: list[str], number: int) -> tuple[int, tuple[float, ...]]:
    try:
        kind, ends = int(words[0]), tuple(float(word) for word in words[1:])
    except ValueError:
        kind, ends = -1, ()
    if not 0 <= kind <= _MOST_TYPE or len(ends) != 4:
        said = " ".join(words)
        raise UnreadableFile(
            f"Line {number} must be a type and four coordinates, as 2 0 0 100 50; it is "
            f"{said[:40]!r}."
        )
    return kind, ends


def write(fold: Fold, *, canvas: float | None = None) -> str:
    """Return a fold as the text of a .cp file; the same fold gives the same text.

    canvas : side of the square it is made to fill about (0, 0), in the file's units, such as
    ``plain_lines.CANVAS``; by default a unit is 1 mm and nothing is moved. What the format cannot
    hold is told by ``plain_lines.losses``; raises InvalidInput for unassigned creases.
    """
    lines = plain_lines.lines_of(fold, canvas)
    return "".join(f"{line.type} {' '.join(map(repr, line[1:]))}\n" for line in lines)
