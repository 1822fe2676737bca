"""How far a sender may run ahead of a machine, found without looking at all it could send."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill_fabricate.plotter.handshakes.feed import Sums
from foldmill_fabricate.plotter.program import Instruction, Job


def job(seed: int) -> Job:
    """Return strokes of one to forty instructions, of a millisecond to two seconds each."""
    random = np.random.default_rng(seed)
    lengths = random.integers(1, 40, 30)
    strokes = np.repeat(np.arange(30), lengths).tolist()
    seconds = np.exp(random.uniform(np.log(1e-3), np.log(2.0), len(strokes))).tolist()
    parts = [
        Instruction(b"PD0,0;", s, k, (0.0, 0.0)) for s, k in zip(seconds, strokes, strict=True)
    ]
    return Job(tuple(parts), None, 30)


@pytest.mark.parametrize("seed", range(5))
def test_nothing_beyond_the_reach_may_follow_and_hardly_anything_within_may_not(seed: int) -> None:
    sums = Sums(job(seed))
    count = len(sums.parts)
    for done in range(count):
        allowed = [k for k in range(done, count) if sums.may_follow(done, k)]
        assert max(allowed) < sums.reach(done) <= max(allowed) + 4
