"""How freely the sheet moves: degrees of freedom of the hinged triangles (thesis 5.2.1).

A triangulated disc with E_o border edges has E_o − 3 of them, which is 3V − E − 6. Glueing the seam
makes ⌊T/2⌋ vertices of two, and ⌊T/2⌋ − 1 edges.
"""

from __future__ import annotations


def of_sheet(n: int, points: int) -> int:
    """Return 4N + 2(⌊T/2⌋ − 1) − 3, for the open sheet (Eq. 5.7); points : T."""
    return 4 * n + 2 * (points // 2 - 1) - 3


def of_tube(n: int) -> int:
    """Return 4N − 6, for the tube with its seam glued, whatever T."""
    return 4 * n - 6
