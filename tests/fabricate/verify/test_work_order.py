"""What lies inside a closed cut is cut before it: in the plan, and in the program besides."""

from __future__ import annotations

from fabricate.verify.corrupt_programs import read, with_program, written
from fabricate.verify.square_job import Job, machine, material, recorded
from fabricate.verify.test_corruptions import errors, verified

from foldmill import CreasePattern, Fold
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.plan import make

SIDES = (0.0, 200.0), (60.0, 140.0), (80.0, 120.0)
"""From where to where the outline goes, and two windows one inside the other, mm."""


def nested() -> Job:
    """A square in which a window is cut that has been cut out of a larger one."""
    corners = [spot for a, b in SIDES for spot in ((a, a), (b, a), (b, b), (a, b))]
    rings = [(4 * k + i, 4 * k + (i + 1) % 4) for k in range(3) for i in range(4)]
    spokes = [(i, i + 4) for i in range(8)]
    letters = "BBBB" + 8 * "C" + 8 * "F"
    pattern = CreasePattern.from_lines(corners, rings + spokes, list(letters))
    plan = make(Fold(pattern), material(), machine("generic-hpgl-600"))
    return recorded(Job(plan, pattern, hpgl.write(plan, Fold(pattern))))


def test_a_program_that_cuts_the_larger_window_first_is_found() -> None:
    good = nested()
    assert errors(verified(good)) == set()
    [name] = good.programs
    parts = read(good.programs[name])
    parts[1], parts[3] = parts[3], parts[1]
    assert errors(verified(with_program(good, name, written(parts)))) == {"cut-in-loose-piece"}
