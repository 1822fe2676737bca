"""The kinds of things that a person chooses among, as words; who asks for one loads no more."""

from __future__ import annotations

from typing import Literal

Kind = Literal[
    "half-cut",
    "crease-wheel",
    "stylus",
    "perforation",
    "v-score",
    "through-cut",
    "score-and-snap",
    "pen",
]
"""Every process there is."""
RegistrationKind = Literal["holes", "l-marks", "edge", "pins", "none"]
"""What may keep the faces in register."""
FlipKind = Literal["left-right", "end-over-end"]
"""About which axis a sheet may be turned over."""
Unassigned = Literal["front", "reverse", "skip"]
"""Where creases without mountain or valley may be scored."""
