"""How a form came about, from left to right: the shapes on the way, the form, its pattern."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, Stage
from foldmill_fabricate.pictures import canvas, folded, pattern
from foldmill_fabricate.pictures.folded import ABOVE
from foldmill_fabricate.pictures.render import Ball, form_of, render, render_triangles

Floats = NDArray[np.float64]

WHITE = 0.999
WIDTH, HEIGHT = 76, 84
"""mm, of one part of the picture."""
PIXELS = 520
"""Of a form before what is empty round all of them is cut off."""
FULL = 400
"""Edges of a pattern that may be drawn as thick as usual; more are thinner, to be told apart."""
STEP = 8
"""Of 255: colours are rounded to it, as finer shades would only make the file larger."""


def stages_picture(fold: Fold, stages: Sequence[Stage]) -> bytes:
    """Return a PNG: each stage, the folded form, all in one scale, and the crease pattern.

    Raises InvalidInput where the fold has no folded form.
    """
    form = form_of(fold)
    view = Ball.around(np.vstack([stage.vertices for stage in stages] + [form.vertices]))
    images = [
        render_triangles(stage.vertices[stage.faces], stage.is_drawn, ABOVE, PIXELS, view)
        for stage in stages
    ]
    images.append(render(fold, ABOVE, PIXELS, view))
    images = cropped(images)
    names = [*(stage.name for stage in stages), f"form, {folded.size_text(fold)}"]
    parts = len(images) + 1
    with canvas.own_style():
        figure = canvas.figure(parts * WIDTH, HEIGHT)
        for k, (image, name) in enumerate(zip(images, names, strict=True)):
            axes = canvas.flat_axes(figure, (k / parts, 0.03, 0.98 / parts, 0.83))
            axes.imshow(image, interpolation="bilinear")
            axes.set_title(name, fontsize=9)
        axes = canvas.flat_axes(figure, ((parts - 0.97) / parts, 0.05, 0.94 / parts, 0.81))
        thickness = min(1.0, (FULL / len(fold.pattern.edges)) ** 0.5)
        pattern.draw(axes, fold.pattern, legend=False, thickness=thickness)
        width, height = np.ptp(fold.pattern.vertices, axis=0)
        axes.set_title(f"pattern, {width:.0f} × {height:.0f} mm", fontsize=9)
        figure.suptitle(str(fold.meta.get("title", "Crease pattern")), fontsize=11)
        canvas.warn(figure, fold)
        return _rounded(canvas.png(figure))


def cropped(images: list[Floats]) -> list[Floats]:
    """Cut off, alike from all images, the rows and columns in which all of them are white."""
    is_white = np.stack(images).min(axis=(0, 3)) > WHITE
    rows, columns = (np.flatnonzero(~is_white.all(axis=axis)) for axis in (1, 0))
    return [image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] for image in images]


def _rounded(content: bytes) -> bytes:
    from PIL import Image

    with Image.open(BytesIO(content)) as image:
        levels = np.asarray(image.convert("RGB"), np.int16)
    rounded = np.minimum((levels + STEP // 2) // STEP * STEP, 255).astype(np.uint8)
    out = BytesIO()
    Image.fromarray(rounded).save(out, format="PNG", optimize=True)
    return out.getvalue()
