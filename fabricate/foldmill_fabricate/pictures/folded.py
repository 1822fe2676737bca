"""The folded form as a picture, from above and from below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from foldmill import Fold
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.render import INSIDE, OUTSIDE, Camera, form_of, render

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ABOVE, BELOW = Camera(azimuth=-68, elevation=27), Camera(azimuth=-68, elevation=-42)


def folded_picture(fold: Fold) -> bytes:
    """Return a PNG of the folded form, outside and inside of the sheet in different colours.

    Raises InvalidInput where the fold has no folded form.
    """
    form_of(fold)
    with canvas.own_style():
        figure = canvas.figure(260, 150)
        for k, (camera, name) in enumerate(((ABOVE, "from above"), (BELOW, "from below"))):
            axes = canvas.flat_axes(figure, (0.01 + 0.5 * k, 0.08, 0.48, 0.78))
            draw(axes, fold, camera)
            axes.set_title(name, fontsize=9)
        figure.suptitle(f"{fold.meta.get('title', 'Folded form')}, {size_text(fold)}", fontsize=12)
        _name_faces(figure.add_axes((0, 0, 1, 0.08)))
        canvas.warn(figure, fold)
        return canvas.png(figure)


def draw(axes: Axes, fold: Fold, camera: Camera = ABOVE, pixels: int = 700) -> None:
    """Draw the folded form into axes."""
    image = render(fold, camera, pixels)
    axes.imshow(image, interpolation="bilinear")


def size_text(fold: Fold) -> str:
    """Return the form's box in words, such as "220 × 220 × 150 mm"."""
    x, y, z = np.ptp(form_of(fold).vertices, axis=0)
    return f"{x:.1f} × {y:.1f} × {z:.1f} mm"


def _name_faces(axes: Axes) -> None:
    axes.set_axis_off()
    for x, colour, name in ((0.32, OUTSIDE, "outside (front)"), (0.55, INSIDE, "inside (reverse)")):
        axes.plot([x], [0.5], marker="s", markersize=9, color=colour)
        axes.text(x + 0.015, 0.5, name, va="center", fontsize=9)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
