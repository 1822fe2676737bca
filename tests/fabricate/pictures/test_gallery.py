"""The gallery is made from the presets, and its pictures are what the code draws now.

Pictures are compared by their pixels with some tolerance, as letters differ by a hair between
versions of the drawing libraries; `--update-goldens` draws them anew, as `make pictures` does.
"""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image, ImageSequence

from foldmill import Fold, FoldedForm, installed
from foldmill_fabricate.files import write_whole
from foldmill_fabricate.pictures import gallery, show_picture
from foldmill_fabricate.pictures.folded import ABOVE
from foldmill_fabricate.pictures.gallery import (
    PIXELS,
    STEPS,
    made,
    motion_name,
    page,
    picture_name,
    pictures,
    shown_motion,
    stages_of,
    still_picture,
)
from foldmill_fabricate.pictures.render import Ball, render

if TYPE_CHECKING:
    from conftest import Golden

DOCS = Path(__file__).parents[3] / "docs"
OURS = {
    slug: offer.value
    for slug, offer in sorted(installed().offers["foldmill_designs"].items())
    if offer.owner == "foldmill"
}
EACH = [(slug, name) for slug, design in OURS.items() for name in design.presets]
MEAN, SHARE, FAR = 1.0, 0.005, 48
"""Of 255: largest mean difference; and the largest share of pixels that differ by FAR."""


def likeness(one: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """Return mean difference, and the share of pixels that are far from each other."""
    assert one.shape == other.shape, (one.shape, other.shape)
    gap = np.abs(one.astype(float) - other.astype(float)).max(axis=2)
    return float(gap.mean()), float((gap > FAR).mean())


def is_like(one: np.ndarray, other: np.ndarray) -> bool:
    mean, far = likeness(one, other)
    return mean <= MEAN and far <= SHARE


def pixels(content: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(content)).convert("RGB"))


def frames(content: bytes) -> list[np.ndarray]:
    with Image.open(BytesIO(content)) as image:
        return [np.asarray(each.convert("RGB")) for each in ImageSequence.Iterator(image)]


def run(slug: str, name: str) -> Fold:
    design = OURS[slug]
    fold: Fold = design.run(design.preset(name))
    return fold


def seen_at(fold: Fold, k: int) -> np.ndarray:
    """Draw one place of the motion by itself."""
    motion = shown_motion(fold)
    assert motion is not None
    times = motion.reach * np.array([*range(STEPS), 0.999 * STEPS]) / STEPS
    places = [motion.at(float(t)) for t in times]
    still = Fold(fold.pattern, FoldedForm(places[k]))
    image = render(still, ABOVE, PIXELS, Ball.around(np.array(places)))
    return np.rint(255 * image)


def test_the_page_in_the_docs_shows_every_preset_there_is(golden: Golden) -> None:
    folds = made(OURS)
    if golden.update:
        write_whole(DOCS / "gallery.md", page(OURS, folds).encode())
    assert (DOCS / "gallery.md").read_text("utf-8") == page(OURS, folds)
    named = {picture_name(slug, name) for slug, name in EACH}
    named |= {motion_name(slug, name) for slug, name in EACH if shown_motion(folds[slug][name])}
    assert {f"pictures/{file.name}" for file in (DOCS / "pictures").iterdir()} >= named


@pytest.mark.long
@pytest.mark.parametrize(("slug", "name"), EACH)
def test_the_pictures_in_the_docs_are_what_is_drawn_now(
    slug: str, name: str, golden: Golden
) -> None:
    fold, stages = run(slug, name), stages_of(OURS[slug], name)
    if golden.update:
        for file, content in pictures(slug, name, fold, stages).items():
            write_whole(DOCS / file, content)
    still = (DOCS / picture_name(slug, name)).read_bytes()
    assert len(still) < 300_000 or not stages
    drawn = pixels(still_picture(fold, stages))
    assert is_like(pixels(still), drawn), "draw it anew with `make pictures`"
    if shown_motion(fold) is None:
        return
    moving = (DOCS / motion_name(slug, name)).read_bytes()
    assert len(moving) < 300_000
    shown = frames(moving)
    assert len(shown) == 2 * STEPS
    for k in (0, STEPS // 2, STEPS):
        assert is_like(shown[k], seen_at(fold, k)), "draw it anew with `make pictures`"


def test_another_shape_is_not_like_it() -> None:
    """Comparing bites: two degrees of φ, another branch, or a step of the motion are seen."""
    design = OURS["rotational"]
    params = design.preset("bowl-n8")
    kept = pixels((DOCS / picture_name("rotational", "bowl-n8")).read_bytes())
    opened: Any = params.model_copy(update={"phi": params.phi + 2})
    assert not is_like(kept, pixels(show_picture(design.run(opened))))
    fold = run("rotational", "bowl-n8")
    shown = frames((DOCS / motion_name("rotational", "bowl-n8")).read_bytes())
    assert not is_like(shown[0], seen_at(fold, 1))


def test_each_preset_of_a_family_gets_its_pictures() -> None:
    one = OURS["rotational"].presets["star-n6"]
    files = gallery({"rotational": _with(OURS["rotational"], {"star-n6": one})})
    names = [picture_name("rotational", "star-n6"), motion_name("rotational", "star-n6")]
    assert sorted(files) == sorted([*names, "gallery.md"])
    assert "foldmill motion rotational --preset star-n6 --motion unfold" in files[
        "gallery.md"
    ].decode("utf-8")


def _with(design: Any, presets: dict[str, Any]) -> Any:
    from dataclasses import replace

    return replace(design, presets=presets)
