"""Few lines are drawn as lines, very many as dots."""

from __future__ import annotations

import numpy as np

from foldmill_fabricate.pictures import canvas


def drawing(count: int) -> bytes:
    """Return an SVG of a picture with so many lines."""
    with canvas.own_style():
        figure = canvas.figure(60, 60)
        axes = canvas.flat_axes(figure, (0, 0, 1, 1))
        spots = np.random.default_rng(1).uniform(0, 60, (count, 2, 2))
        canvas.add_lines(axes, spots, color="#d62020", linewidth=1.4)
        axes.set_xlim(0, 60)
        axes.set_ylim(0, 60)
        return canvas.svg(figure)


def test_as_many_lines_as_a_page_can_show_are_drawn_one_by_one() -> None:
    drawn = drawing(canvas.MANY)
    assert b"<image" not in drawn
    assert drawn.count(b"stroke: #d62020") + drawn.count(b"<use ") >= canvas.MANY


def test_more_lines_than_that_are_one_image_and_the_same_one_each_time() -> None:
    drawn = drawing(3 * canvas.MANY)
    assert drawn.count(b"<image") == 1
    assert drawn == drawing(3 * canvas.MANY)
    assert len(drawn) < len(drawing(canvas.MANY))
