"""Solve one symmetric sparse system after another of the same pattern.

qdldl where it is installed and the system is small enough for its simple factorisation, else
SciPy's SuperLU in its symmetric mode. The factors of a large system are kept: conjugate gradients
with them solve the next one in a few rounds, as long as it has not changed much.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int32]

MOST_QDLDL = 30_000
"""Rows beyond which SuperLU is the quicker one: qdldl works column by column, and takes twice as
long for the 150,000 rows of 50,000 bases."""
MANY = 60_000
"""Rows beyond which factors are used again: new ones of 20,000 rows are as quick."""
SHARE, LEAST, MOST = 1e-2, 1e-8, 1e-3
"""What conjugate gradients may leave of the right side: a share of its largest number, within
bounds. A step of Newton's method leaves its square, so that more would be wasted."""
ROUNDS = 30
"""Rounds of conjugate gradients that are still cheaper than new factors."""


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
                else self._by_scipy(gram, values, right)
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

    def _by_scipy(self, gram: Any, values: Floats, right: Floats) -> Floats:
        from scipy.sparse import csc_matrix

        matrix = csc_matrix((values, gram.indices, gram.indptr), shape=gram.shape)
        if self._kept is not None:
            again = _by_gradients(matrix, self._kept, right)
            if again is not None:
                return again
        self._kept = _superlu(matrix)
        found: Floats = self._kept.solve(right)
        if gram.shape[0] < MANY:
            self._kept = None
        return found


def _superlu(matrix: Any) -> Any:
    from scipy.sparse.linalg import splu

    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _by_gradients(matrix: Any, factors: Any, right: Floats) -> Floats | None:
    """Return the solution by conjugate gradients with the factors of a like matrix, or None."""
    from scipy.sparse.linalg import LinearOperator, cg

    exact = float(np.clip(SHARE * np.abs(right).max(), LEAST, MOST))
    like = LinearOperator(matrix.shape, factors.solve)
    found, left = cg(matrix, right, rtol=exact, atol=0.0, maxiter=ROUNDS, M=like)
    return found if left == 0 else None
