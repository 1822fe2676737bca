"""Dihedral angles along a motion as a CSV table."""

from __future__ import annotations

import csv
from io import StringIO

from foldmill.dihedral import DihedralTable
from foldmill.motion import PLAIN, Motion


def dihedral_csv(table: DihedralTable, motion: Motion) -> str:
    """Return a row for every t: t, the motion's own measure where it has one, an angle per crease.

    Angles are deg with six decimals; the creases are named by their two vertices and their letter.
    """
    measure = motion.measure
    named = [] if measure == PLAIN else [f"{measure.name} ({measure.unit})"]
    out = StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["t", *named, *(f"{name} (deg)" for name in table.names)])
    for t, angles in zip(table.times.tolist(), table.angles.tolist(), strict=True):
        progress = [f"{measure.at(t):.8g}"] if named else []
        rows.writerow([f"{t:.8g}", *progress, *(f"{angle:.6f}" for angle in angles)])
    return out.getvalue()
