"""A form with two blanks in each half wedge, which several tests tuck."""

from __future__ import annotations

from typing import Any

DOME: dict[str, Any] = {
    "n": 7,
    "phi": 117,
    "points": {
        1: {"a": 64.6},
        2: {"a": 59.9, "branch": -1},
        3: {"a": 110.3},
        4: {"r": 105.7, "z": -89.6},
        5: {"r": 120.4, "z": -77.7},
        6: {"a": 175.3, "branch": -1},
        7: {"a": 214.9},
        8: {"a": 221.3},
    },
}
"""A form with two blanks in each half wedge: one tucked inside, one flap outside."""
