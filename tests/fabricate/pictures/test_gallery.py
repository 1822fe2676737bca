"""The gallery is made from the presets."""

from __future__ import annotations

from pathlib import Path

from foldmill import installed
from foldmill_fabricate.pictures import gallery
from foldmill_fabricate.pictures.gallery import page, picture_name

DOCS = Path(__file__).parents[3] / "docs"
OURS = {
    slug: offer.value
    for slug, offer in sorted(installed().offers["foldmill_designs"].items())
    if offer.owner == "foldmill"
}


def test_the_page_in_the_docs_shows_every_preset_there_is() -> None:
    assert (DOCS / "gallery.md").read_text("utf-8") == page(OURS)
    for slug, design in OURS.items():
        for name in design.presets:
            assert (DOCS / picture_name(slug, name)).read_bytes().startswith(b"\x89PNG")


def test_each_preset_of_a_family_gets_its_picture() -> None:
    files = gallery({"rotational": OURS["rotational"]})
    names = [picture_name("rotational", name) for name in OURS["rotational"].presets]
    assert sorted(files) == sorted([*names, "gallery.md"])
    assert len({files[name] for name in names}) == len(names)
