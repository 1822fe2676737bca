"""The few loops that are worth compiling, and their second form over whole columns.

``judge`` solves many strips and says of each whether its half wedge passes through itself. With
numba it runs compiled (``strips``), without it over columns (``columns``); both follow the rules of
``foldmill.axisymmetric.strip`` and ``foldmill.check.intersection``, and agree.
"""

from __future__ import annotations

from foldmill.kernels.jit import SWITCH, is_compiling
from foldmill.kernels.judging import judge
from foldmill.kernels.tables import CODES, Limits, Strips, Verdicts

__all__ = ["CODES", "SWITCH", "Limits", "Strips", "Verdicts", "is_compiling", "judge"]
