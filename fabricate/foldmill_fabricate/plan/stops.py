"""Where stops stand when the sheet's edges are all that keeps the faces in register.

The same two edges of the sheet touch stops in both passes: the one that stays where it is, and one
beside it. When a sheet is turned left-right its left edge goes to the right, and its stop goes with
it. So it does not matter whether the blank is exactly as wide as it should be.
"""

from __future__ import annotations

from foldmill_fabricate.passes import Face, Flip, Sheet, Stop

APART = 0.15
"""Share of an edge from its ends to the two stops that the sheet lies against along it."""


def stops(sheet: Sheet, flip: Flip) -> tuple[Stop, ...]:
    """Return three stops for each pass: two along the datum edge, one at the edge beside it."""
    found = []
    for face in Face:
        moved = face is Face.REVERSE
        if flip.kind == "left-right":
            spots = [("bottom", share, 0.0) for share in (APART, 1 - APART)]
            spots.append(("right", 1.0, 0.5) if moved else ("left", 0.0, 0.5))
        else:
            spots = [("left", 0.0, share) for share in (APART, 1 - APART)]
            spots.append(("top", 0.5, 1.0) if moved else ("bottom", 0.5, 0.0))
        found += [
            Stop.model_validate(
                {
                    "face": face,
                    "edge": edge,
                    "x": sheet.dx + x * sheet.width,
                    "y": sheet.dy + y * sheet.height,
                }
            )
            for edge, x, y in spots
        ]
    return tuple(found)
