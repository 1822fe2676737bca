"""Products and lengths of many small vectors.

NumPy's own ``cross`` and ``norm`` serve any axis and any width, and spend most of their time
finding out which; a drag calls them hundreds of times for a handful of vectors. These do the same
arithmetic in the same order, to the last bit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def cross(a: Floats, b: Floats) -> Floats:
    """Return a × b (..., 3) of vectors (..., 3); their leading axes are broadcast."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    out = np.zeros((*x.shape, 3))
    out[..., 0] = x
    out[..., 1] = az * bx - ax * bz
    out[..., 2] = ax * by - ay * bx
    return out


def lengths(vectors: Floats) -> Floats:
    """Return the lengths (...) of vectors (..., k)."""
    squares = vectors * vectors
    total = squares[..., 0]
    for k in range(1, squares.shape[-1]):
        total = total + squares[..., k]
    return np.sqrt(total)


def least(triples: Floats) -> Floats:
    """Return the least (...) of three numbers (..., 3)."""
    smaller: Floats = np.minimum(triples[..., 0], triples[..., 1])
    return np.minimum(smaller, triples[..., 2])


def most(triples: Floats) -> Floats:
    """Return the greatest (...) of three numbers (..., 3)."""
    greater: Floats = np.maximum(triples[..., 0], triples[..., 1])
    return np.maximum(greater, triples[..., 2])


def units(vectors: Floats) -> Floats:
    """Return vectors (..., k) of length 1; one without length stays as it is."""
    size = lengths(vectors)[..., None]
    out: Floats = vectors / np.where(size > 0, size, 1.0)
    return out
