"""No bytes crash the reader of foreign drawings, or keep it long: it reads them or says why not."""

from __future__ import annotations

import random
import time

from fabricate.half_made import PENS
from fuzzed_hpgl import WORDS, written
from hypothesis import given
from hypothesis import strategies as st
from soaking import Soak

from foldmill import FoldmillError
from foldmill.errors import UnreadableFile
from foldmill_fabricate import shelf
from foldmill_fabricate.foreign import Drawing, Use, limits, plan_drawing, read
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material

SEED = 20261123
SLOWEST = 20.0
"""s of processor time, on a machine that does other things: a thousand times what is usual."""


def sentence(data: bytes) -> Drawing | None:
    """Read; None where it was refused, in words and with the file's name."""
    try:
        found = read(data, "fuzz.plt")
    except UnreadableFile as refused:
        said = str(refused)
        assert said.startswith("fuzz.plt ")
        assert said.endswith(".")
        assert len(said) < 2_000
        assert said.isprintable()
        return None
    points = [spot for own in found.pens.values() for way in own for spot in way]
    assert len(points) <= 2 * limits.POINTS
    assert all(abs(each) <= limits.REACH_MM for spot in points for each in spot)
    assert all(len(way) > 1 for own in found.pens.values() for way in own)
    return found


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused_in_words(data: bytes) -> None:
    sentence(data)


@given(st.lists(st.sampled_from(WORDS), max_size=40), st.data())
def test_any_sequence_of_instructions_is_read_or_refused_in_words(
    words: list[str], data: st.DataObject
) -> None:
    numbers = st.one_of(st.integers(-9000, 9000), st.floats(-1e12, 1e12), st.just(0))
    text = "".join(words)
    filled = "".join(str(data.draw(numbers)) if each == "#" else each for each in text)
    sentence(filled.encode("latin-1"))


def test_seeded_drawings_are_read_or_refused_within_bounds(soak: Soak) -> None:
    """``make soak PART=foreign`` reads ten thousand."""
    count = soak.size(150, 10_000)
    material, machine = shelf.material("pp-0.75"), shelf.machine(PENS)
    was_read = 0
    with soak.part("foreign", SEED, count, "drawings") as progress:
        for number in range(progress.before, count):
            data = written(random.Random(f"{SEED} {number}"))
            began = time.process_time()
            found = sentence(data)
            was_read += found is not None
            if found is not None:
                try_to_plan(found, material, machine)
            assert time.process_time() - began < SLOWEST, number
            if number % 100 == 99:
                progress.reached(number + 1)
        assert was_read > (count - progress.before) / 10


def try_to_plan(found: Drawing, material: Material, machine: Machine) -> None:
    """What was read is planned, or refused in words."""
    if sum(len(way) for own in found.pens.values() for way in own) > 2_000:
        return
    uses = dict.fromkeys(found.pens, Use.CUT)
    said = "."
    try:
        plan_drawing(found, uses, material, machine)
    except FoldmillError as refused:
        said = str(refused)
    assert said.endswith(".")
