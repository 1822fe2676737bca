"""Drawings in several pieces that do not touch: which edge is part of which, and which are loops.

In a small piece there is next to nothing to gain by matching its ends: they are ordered with the
strokes of all other pieces. What has no loose end, a *loop*, must be joined to a stroke or opened.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import tours

Indices = NDArray[np.intp]

FEW = 20
"""Loose ends of a piece up to which they are not matched."""


def labels(edges: Indices) -> Indices:
    """Return which piece (E,) each edge (E, 2) is part of, from 0."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = int(edges.max()) + 1
    links = coo_array((np.ones(len(edges)), edges.T), shape=(count, count))
    label = connected_components(links, directed=False)[1]
    found: Indices = np.unique(label[edges[:, 0]], return_inverse=True)[1].astype(np.intp)
    return found


def with_few_ends(left: Indices, own: Indices) -> Indices:
    """Return those of the loose ends (n,) that lie on a piece with few; own : (E,) as labels."""
    piece = own[left // 2]
    return left[np.bincount(piece, minlength=1)[piece] <= FEW]


def other_ends(left: Indices, partner: Indices) -> Indices:
    """Return the loose end that is met first (n,) when one goes on from each loose end."""
    links, found = partner.tolist(), []
    for end in left.tolist():
        far = end ^ 1
        while links[far] >= 0:
            far = links[far] ^ 1
        found.append(far)
    return np.array(found, np.intp)


def loops(partner: Indices, vertices: Indices) -> NDArray[np.bool_]:
    """Return of each tour, as ``tours.labels`` numbers them, whether the tool never hops in it.

    partner, vertices : (2E,) of each end; the depot, which lies nowhere, is no loop.
    """
    tour = tours.labels(partner)
    found = np.ones(int(tour.max()) + 1, bool)
    found[tour[np.flatnonzero(vertices != vertices[partner]) // 2]] = False
    return found
