"""Letters stand on creases that are seen, and nowhere else."""

from __future__ import annotations

import hand_made
import numpy as np
import stools

from foldmill import Fold, FoldedForm
from foldmill_fabricate.jobsheet.creases import groups
from foldmill_fabricate.pictures.lettered import placed
from foldmill_fabricate.pictures.render import Camera, render, spots

TOP, BOTTOM = Camera(-90, 89.9), Camera(-90, -89.9)


def test_a_point_on_the_paper_is_in_the_picture_where_the_paper_is() -> None:
    fold = hand_made.fold()
    form = fold.folded
    assert form is not None
    camera = Camera(-60, 30)
    middles = form.vertices[fold.pattern.faces].mean(axis=1)
    image = render(fold, camera, 300)
    for spot in spots(fold, camera, middles):
        row, column = int(300 * (1 - spot.at[1])), int(300 * spot.at[0])
        assert (image[row, column] < 0.999).any()


def test_what_another_facet_hides_is_not_seen() -> None:
    fold = hand_made.fold()
    flat = np.column_stack([fold.pattern.vertices, np.zeros(8)])
    flat[[3, 7]] = flat[[1, 5]] + (0.0, 0.0, 9.0)  # the last third lies above the middle one
    over = Fold(fold.pattern, FoldedForm(flat))
    below, above = np.array([[30.0, 20.0, 0.0]]), np.array([[30.0, 20.0, 4.5]])
    assert not spots(over, TOP, below)[0].seen
    assert spots(over, BOTTOM, below)[0].seen
    assert spots(over, TOP, above)[0].seen
    assert not spots(over, BOTTOM, above)[0].seen


def test_the_seats_edge_is_seen_from_above_and_the_tucks_only_from_below() -> None:
    stool = stools.stool()
    letters = {group.letter: group.edges for group in groups(stool.pattern)}
    above, below = placed(stool, TOP, letters), placed(stool, Camera(30, -40), letters)
    assert "A" in above
    assert "L" not in above
    assert {"L", "M"} <= set(below)


def test_letters_do_not_stand_on_each_other() -> None:
    stool = stools.stool()
    letters = {group.letter: group.edges for group in groups(stool.pattern)}
    spots_ = list(placed(stool, Camera(-68, 27), letters).values())
    apart = [np.hypot(*(a - b)) for k, a in enumerate(spots_) for b in spots_[:k]]
    assert min(apart) > 0.02
