"""foldmill: from an origami design to a sheet that a cutting plotter scores on both faces.

This is the face for plugin authors and notebooks. Millimetres and degrees throughout. Each name is
loaded when it is first asked for, so that a command loads no more than it works with.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
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

_HOMES = {
    "batch": ("Outcome", "Outcomes"),
    "design": ("Angle", "Coordinate", "Count", "Design", "Fold", "Length", "Params", "Symmetry"),
    "folded": ("FoldedForm",),
    "hooks": ("hookimpl",),
    "pattern": ("Assignment", "CreasePattern"),
    "registry": ("installed",),
    "stage": ("Stage",),
}
"""Modules and what of them is public; every other public name is one of ``errors``."""


def __getattr__(name: str) -> Any:
    """Load a public name (PEP 562); raises AttributeError for any other."""
    if name not in __all__:
        raise AttributeError(f"module 'foldmill' has no attribute {name!r}")
    home = next((home for home, names in _HOMES.items() if name in names), "errors")
    value = getattr(import_module(f"foldmill.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
