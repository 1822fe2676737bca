"""Which form of the kernel judges: compiled loops, or columns."""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill.kernels.jit import is_compiling
from foldmill.kernels.tables import Limits, Strips, Verdicts, wheels

COMPILED_FROM = 200_000
"""Configurations. Fewer are judged over columns before numba is loaded, which takes 0.6 s."""


def judge(strips: Strips, limits: Limits | None = None, among: int = 0) -> Verdicts:
    """Solve strips and test their half wedges: compiled where numba is and it is worth loading.

    Elsewhere over columns. Which of the two depends on the numbers alone, never on what was loaded
    before, so that the same call gives the same bytes. among : configurations from which these
    strips are left, where that are more.
    """
    loop: Any
    if max(len(strips), among) >= COMPILED_FROM and is_compiling():
        from foldmill.kernels.strips import judge as loop
    else:
        from foldmill.kernels.columns import judge as loop
    return judge_with(loop, strips, limits or Limits())


def judge_with(loop: Any, strips: Strips, limits: Limits) -> Verdicts:
    """Run one form of the kernel."""
    orders, wheel = np.unique(strips.order, return_inverse=True)
    out = Verdicts.empty(len(strips))
    loop(
        wheel.astype(np.int64).reshape(-1),
        wheels(orders, strips.is_first_on_l2),
        *(np.ascontiguousarray(each, np.float64) for each in (strips.start, strips.paper)),
        np.ascontiguousarray(strips.branches, np.float64),
        limits.as_row(),
        *(out.codes, out.at, out.extents),
    )
    return out
