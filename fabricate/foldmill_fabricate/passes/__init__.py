"""The plan as a value: passes of a sheet, their set-ups, operations and strokes. No behaviour.

All positions are sheet coordinates: mm, x right, y up, origin in the blank's lower left corner,
the viewer looking at the FRONT face. They are never mirrored here; a writer mirrors the reverse.

Terminology: a *copy* is one part of several on a sheet; a *pass* is one face of the sheet; a
*set-up* is what is done without an operator's hand on the machine; an *operation* is all lines of
one role in it; a *stroke* is one motion with the tool down; a *repeat* is the knife going over a
stroke again without lifting.
"""

from foldmill_fabricate.passes.lying import (
    Fit,
    Flip,
    Hole,
    Mark,
    Placement,
    Register,
    Sheet,
    Stop,
    Tie,
)
from foldmill_fabricate.passes.plan import (
    PenUse,
    Plan,
    ProgramFile,
    Remakes,
    Source,
    There,
)
from foldmill_fabricate.passes.reckoned import (
    Budget,
    Figures,
    Share,
)
from foldmill_fabricate.passes.strokes import (
    Face,
    Gate,
    Operation,
    Pass,
    Role,
    SetUp,
    Stroke,
)
from foldmill_fabricate.passes.value import (
    XY,
)

__all__ = [
    "XY",
    "Budget",
    "Face",
    "Figures",
    "Fit",
    "Flip",
    "Gate",
    "Hole",
    "Mark",
    "Operation",
    "Pass",
    "PenUse",
    "Placement",
    "Plan",
    "ProgramFile",
    "Register",
    "Remakes",
    "Role",
    "SetUp",
    "Share",
    "Sheet",
    "Source",
    "Stop",
    "Stroke",
    "There",
    "Tie",
]
