"""A motion as an animated picture, seen from one place, as large throughout."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, FoldedForm
from foldmill.exchange.marking import warning
from foldmill.motion import Motion
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.folded import ABOVE
from foldmill_fabricate.pictures.render import Ball, render

Floats = NDArray[np.float64]

PIXELS = 360
FRAME_MS = 60
NEARLY = 0.999
"""Where the last frame is, as a share of the reach: a form that is folded flat has all its layers
in one plane, and which of them is seen would be a matter of rounding."""
REST_MS = 900
"""How long the first and the last frame stay."""


def motion_picture(
    fold: Fold, motion: Motion, steps: int, suffix: str = ".gif", pixels: int = PIXELS
) -> bytes:
    """Return the motion there and back as an animated GIF or WebP, by the suffix."""
    from PIL import Image, ImageDraw

    frames = places(motion, steps)
    view = Ball.around(np.array(frames))
    images = [
        Image.fromarray(np.uint8(np.rint(255 * _image(fold, vertices, view, pixels))))
        for vertices in frames
    ]
    for image in images:
        ImageDraw.Draw(image).text((6, pixels - 16), warning(fold), fill=canvas.ALARM)
    there_and_back = [*images, *images[-2:0:-1]]
    times = [FRAME_MS] * len(there_and_back)
    times[0] = times[len(images) - 1] = REST_MS
    out = BytesIO()
    there_and_back[0].save(
        out,
        format=suffix.lstrip(".").upper(),
        save_all=True,
        append_images=there_and_back[1:],
        duration=times,
        loop=0,
    )
    return out.getvalue()


def places(motion: Motion, steps: int) -> list[Floats]:
    """Return the vertices at ``steps`` + 1 even places, the last one a hair before the reach."""
    shares = [*(k / steps for k in range(steps)), NEARLY]
    return [motion.at(motion.reach * share) for share in shares]


def _image(fold: Fold, vertices: Floats, view: Ball, pixels: int) -> Floats:
    shown = replace(fold, folded=FoldedForm(vertices))
    return render(shown, ABOVE, pixels, view)
