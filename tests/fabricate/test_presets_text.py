"""A preset that is written is the preset that is read."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill_fabricate import presets, shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.presets_text import written

SHIPPED = {
    **{f"material {slug}": each for slug, each in shelf.everything(Material).presets.items()},
    **{f"machine {slug}": each for slug, each in shelf.everything(Machine).presets.items()},
}


@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_every_shipped_preset_survives_being_written(name: str) -> None:
    preset = SHIPPED[name]
    assert presets.read(type(preset), written(preset, "a comment\nof two lines"), name) == preset


@settings(max_examples=40)
@given(notes=st.text(max_size=40), thickness=st.floats(1e-3, 10))
def test_any_words_and_any_number_survive(notes: str, thickness: float) -> None:
    preset = shelf.material("card-250").model_copy(update={"notes": notes, "thickness": thickness})
    read = presets.read(Material, written(preset), "a preset")
    assert (read.notes, read.thickness) == (notes, thickness)
