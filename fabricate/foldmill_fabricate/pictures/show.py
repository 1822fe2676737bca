"""Pattern and folded form side by side."""

from __future__ import annotations

from foldmill import Fold
from foldmill_fabricate.pictures import canvas, folded, pattern


def show_picture(fold: Fold) -> bytes:
    """Return a PNG: the crease pattern, and beside it the folded form where one is known."""
    with canvas.own_style():
        figure = canvas.figure(300, 165)
        pattern.draw(canvas.flat_axes(figure, (0.01, 0.06, 0.5, 0.84)), fold.pattern)
        beside = canvas.flat_axes(figure, (0.53, 0.06, 0.46, 0.84))
        if fold.folded is None:
            beside.text(0.5, 0.5, "no folded form known", ha="center", va="center")
        else:
            folded.draw(beside, fold)
            beside.set_title(folded.size_text(fold), fontsize=10)
        figure.suptitle(str(fold.meta.get("title", "Crease pattern")), fontsize=13)
        canvas.warn(figure, fold)
        return canvas.png(figure)
