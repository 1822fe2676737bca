"""How large a drawing is: what the file says, what the person says, or nobody yet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.options import UNITS, Options
from foldmill.pattern import Floats


def factor(
    lines: Floats, letters: Sequence[str], millimetres: float | None, options: Options
) -> float:
    """Return mm per unit of the file; 1 where nobody says.

    lines : (n, 2, 2); letters : what they are; the width asked for is that of the outline where
    there is one. millimetres : what the file says. Raises UnreadableFile for a width of nothing.
    """
    if options.width is not None:
        cut = [letter in {"B", "C"} for letter in letters]
        own = lines[np.flatnonzero(cut)] if any(cut) else lines
        wide = float(np.ptp(own[..., 0]))
        if wide <= 0:
            raise UnreadableFile("The drawing has no width, so --width cannot scale it.")
        return options.width / wide
    unit = UNITS[options.unit] if options.unit is not None else millimetres
    return (unit or 1.0) * (options.scale or 1.0)


def is_known(millimetres: float | None, options: Options) -> bool:
    """Tell whether file or person say how large the drawing is."""
    said = (options.unit, options.scale, options.width)
    return millimetres is not None or any(each is not None for each in said)
