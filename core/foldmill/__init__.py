"""foldmill: from an origami design to a sheet that a cutting plotter scores on both faces.

This is the face for plugin authors and notebooks. Millimetres and degrees throughout.
"""

from foldmill.batch import Outcome, Outcomes
from foldmill.design import Angle, Coordinate, Count, Design, Fold, Length, Params, Symmetry
from foldmill.errors import (
    FoldmillError,
    ImpossibleGeometry,
    InvalidInput,
    InvalidParameters,
    InvalidPattern,
    NoCandidate,
    PluginFault,
    UnknownName,
    UnreadableFile,
)
from foldmill.folded import FoldedForm
from foldmill.hooks import hookimpl
from foldmill.pattern import Assignment, CreasePattern
from foldmill.registry import installed
from foldmill.stage import Stage

__all__ = [
    "Angle",
    "Assignment",
    "Coordinate",
    "Count",
    "CreasePattern",
    "Design",
    "Fold",
    "FoldedForm",
    "FoldmillError",
    "ImpossibleGeometry",
    "InvalidInput",
    "InvalidParameters",
    "InvalidPattern",
    "Length",
    "NoCandidate",
    "Outcome",
    "Outcomes",
    "Params",
    "PluginFault",
    "Stage",
    "Symmetry",
    "UnknownName",
    "UnreadableFile",
    "hookimpl",
    "installed",
]
