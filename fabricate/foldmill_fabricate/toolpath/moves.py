"""The moves of ordering: two or three hops of a closed tour exchanged for shorter ones.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result; the arrays are those of ``arrays``.

Read from a node a to the other node x of its hop the tour is X Y Z, X beginning with a. The moves
make of it X' Z (2-opt, Croes 1958), Y' X Z, Y X' Z, Y X Z or X' Y' Z (3-opt in sequence, Lin 1965;
runs of any length, so Or-opt is among them); X' is X turned round. Each new hop is looked for among
the neighbours of a loose node, as long as the hops taken out are longer than those put in (Lin and
Kernighan 1973).
"""

from __future__ import annotations

from typing import Any

from foldmill.kernels.jit import jit
from foldmill_fabricate.toolpath.arrays import gap, mate, turn, wrap

LEAST = 1e-9
"""mm. A smaller gain is rounding."""
SECOND = 5
"""Neighbours that are looked at for the second new hop."""
ALL, FIRST, LAST = 1, 2, 4
"""What of X Y is turned round, one after the other; the sums of these are kinds of moves."""


@jit
def search(  # noqa: C901 - one loop within the other, and compiled
    xy: Any,
    at: Any,
    near: Any,
    far: Any,
    tour: Any,
    pos: Any,
    twins: int,
    most: int,
    a: int,
    ban: Any,
    move: Any,
) -> float:
    """Look for hops to exchange, one of them that of node a; return what the best gains, mm, or 0.

    xy, at : of each node, where it is and which end of a stroke lies there; near, far : of each
    end, the nearest others (−1 for none), and how far; twins : nodes that lie at one end; most :
    nodes that are turned round at the most; ban : of each node, another that it is not hopped to,
    −1 for none; move : (7,) written: the ends of X, those of Y, the
    kind, and two nodes more whose hops are exchanged.
    """
    n, start = len(tour), pos[a]
    ahead = 1 if start % 2 else -1
    x = mate(tour, pos, a)
    old, best = gap(xy, a, x), LEAST
    for k in range(near.shape[1]):
        e = near[at[a], k]
        if e < 0:
            break
        one = old - far[at[a], k]
        if one <= best:
            break
        for twin in range(twins):
            c = e ^ twin
            i = wrap(ahead * (pos[c] - start), n)
            if at[c] != e or c == ban[a] or min(i, n - i) > most:
                continue
            d = mate(tour, pos, c)
            two = one + gap(xy, c, d)
            turned = i % 2 == 0
            if turned and ban[d] != x and two - gap(xy, d, x) > best:
                best = two - gap(xy, d, x)
                move[0], move[1], move[2], move[3], move[4] = a, d, c, x, FIRST
            for m in range(min(SECOND, near.shape[1])):
                f = near[at[d], m]
                if f < 0:
                    break
                three = two - far[at[d], m]
                if three <= best:
                    break
                for other in range(twins):
                    v = f ^ other
                    j = wrap(ahead * (pos[v] - start), n)
                    if at[v] != f or v == ban[d] or min(j, n - j) > most:
                        continue
                    if turned:
                        if not (j > i if j % 2 == 0 else j < i - 1):
                            continue
                    elif not (j < i and j > 0):
                        continue
                    w = mate(tour, pos, v)
                    gain = three + gap(xy, v, w) - gap(xy, w, x)
                    if gain <= best or ban[w] == x:
                        continue
                    best = gain
                    move[0] = a
                    if turned and j % 2 == 0:  # Y' X Z, with X = a … d, Y = c … w
                        move[1], move[2], move[3], move[4] = d, c, w, ALL + FIRST
                    elif turned:  # Y X' Z, with X = a … v, Y = w … d
                        move[1], move[2], move[3], move[4] = v, w, d, ALL + LAST
                    elif j % 2:  # Y X Z, with X = a … v, Y = w … c
                        move[1], move[2], move[3], move[4] = v, w, c, ALL + FIRST + LAST
                    else:  # X' Y' Z, with X = a … w, Y = v … c
                        move[1], move[2], move[3], move[4] = w, v, c, FIRST + LAST
    return best if best > LEAST else 0.0


@jit
def apply(tour: Any, pos: Any, move: Any, log: Any) -> None:
    """Make of X Y what is written in a move."""
    a, b, c, d, kind = move[0], move[1], move[2], move[3], move[4]
    if kind & ALL:
        turn(tour, pos, a, d, log)
    if kind & FIRST:
        turn(tour, pos, a, b, log)
    if kind & LAST:
        turn(tour, pos, c, d, log)
