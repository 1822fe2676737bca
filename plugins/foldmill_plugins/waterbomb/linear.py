"""Solve one symmetric sparse system after another of the same pattern.

qdldl where it is installed and the system is small enough for its simple factorisation, else
SciPy's SuperLU in its symmetric mode.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]

MOST_QDLDL = 30_000
"""Rows beyond which SuperLU is the quicker one: qdldl works column by column."""


def _qdldl() -> Any:
    try:
        import qdldl
    except ImportError:
        return None
    return qdldl


class Factorised:
    """A solver that remembers the pattern of its matrix between calls."""

    def __init__(self) -> None:
        self._pattern: tuple[Indices, Indices] | None = None
        self._column: Indices = np.zeros(0, np.int32)
        self._kept: Any = None

    def solve(self, gram: Any, damping: float, right: Floats) -> Floats | None:
        """Return x of (gram + damping) x = right, or None where the matrix is singular.

        gram : symmetric CSC matrix (m, m) with its whole diagonal stored.
        """
        gram.sort_indices()
        self._recognise(gram)
        values = gram.data + damping * (gram.indices == self._column)
        is_small = gram.shape[0] <= MOST_QDLDL
        library = _qdldl() if is_small else None
        try:
            found = (
                self._by_qdldl(library, gram, values, right)
                if library
                else _by_scipy(gram, values, right)
            )
        except (RuntimeError, ValueError):  # both say so of a singular matrix
            self._kept = None
            return None
        return found if np.isfinite(found).all() else None

    def _recognise(self, gram: Any) -> None:
        """Forget what is kept where the pattern is another: sums that vanish leave the matrix."""
        here = (gram.indptr, gram.indices)
        if self._pattern is not None and all(
            np.array_equal(one, two) for one, two in zip(self._pattern, here, strict=True)
        ):
            return
        self._pattern, self._kept = here, None
        self._column = np.repeat(np.arange(gram.shape[0], dtype=np.int32), np.diff(gram.indptr))

    def _by_qdldl(self, library: Any, gram: Any, values: Floats, right: Floats) -> Floats:
        from scipy.sparse import csc_matrix

        is_upper = gram.indices <= self._column
        ends = np.concatenate([[0], np.cumsum(is_upper)])[gram.indptr]
        upper = csc_matrix((values[is_upper], gram.indices[is_upper], ends), shape=gram.shape)
        if self._kept is None:
            self._kept = library.Solver(upper, upper=True)
        else:
            self._kept.update(upper, upper=True)
        found: Floats = self._kept.solve(right)
        return found


def _by_scipy(gram: Any, values: Floats, right: Floats) -> Floats:
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import splu

    factors = splu(
        csc_matrix((values, gram.indices, gram.indptr), shape=gram.shape),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    found: Floats = factors.solve(right)
    return found
