"""The one place where Python is compiled, and where it is decided whether it is.

Modules of kernels are imported only inside the functions that need them, so that numba is loaded by
those who compute many configurations, and by nobody else.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

SWITCH = "FOLDMILL_NO_JIT"
"""Environment variable: with any value but 0, nothing is compiled."""


def is_compiling() -> bool:
    """Tell whether kernels are compiled: numba is there, and nobody has switched it off."""
    return os.environ.get(SWITCH, "0") in {"", "0"} and _numba() is not None


@cache
def _numba() -> Any:
    """Return numba, or None where it is not installed or does not work with this NumPy."""
    try:
        return import_module("numba")
    except ImportError:
        return None


def jit(function: F) -> F:
    """Compile a function when it is first called, and keep what was compiled for the next process.

    Without numba it stays as it is. A compiled function is kept beside its module, or in the user's
    cache where that folder is read-only; where neither can be written it is compiled every time.
    """
    if not is_compiling():
        return function
    # No fastmath: NaN and the order of sums must mean what they mean without a compiler.
    options = {"fastmath": False, "nogil": True, "error_model": "numpy"}
    try:
        compiled: F = _numba().njit(cache=True, **options)(function)
    except RuntimeError:  # numba finds no folder to keep it in
        compiled = _numba().njit(**options)(function)
    return compiled
