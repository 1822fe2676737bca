"""Dihedral angles as a table, read again by Python's own CSV reader."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest

from foldmill.dihedral import dihedral_angles
from foldmill.exchange.angles import dihedral_csv
from foldmill.motion import PLAIN, Measure
from foldmill_plugins.six_crease import DESIGN


@pytest.mark.parametrize("measure", [PLAIN, Measure("angle θ", "°", 18.0, 0.0)])
def test_a_reader_finds_every_angle_and_the_motions_own_measure(measure: Measure) -> None:
    fold = DESIGN.run(DESIGN.preset("ball"))
    motion = replace(fold.motions["along-arc"], measure=measure)
    table = dihedral_angles(fold, motion, 17, np.linspace(0, 1, 7))
    head, *rows = csv.reader(StringIO(dihedral_csv(table, motion)))
    numbers = np.array(rows, float)
    own = [] if measure == PLAIN else ["angle θ (°)"]
    assert head == ["t", *own, *(f"{name} (deg)" for name in table.names)]
    assert numbers[:, 0] == pytest.approx(table.times)
    assert np.abs(numbers[:, 1 + len(own) :] - table.angles).max() <= 5e-7
    if own:
        assert numbers[:, 1] == pytest.approx(18 - 18 * table.times)
