"""Compile the inner loops where numba is installed; without it they run as they are."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

SWITCH = "FOLDMILL_NO_JIT"
"""Environment variable: with any value but 0, nothing is compiled."""


def jit(function: F) -> F:
    """Compile a function when it is first called; the same results, only sooner."""
    if os.environ.get(SWITCH, "0") not in {"", "0"} or find_spec("numba") is None:
        return function
    numba: Any = import_module("numba")
    try:
        compiled: F = numba.njit(cache=True)(function)
    except RuntimeError:  # numba finds no folder to keep it in
        compiled = numba.njit(function)
    return compiled
