"""One fold in section, as a preset describes it: thickness, depth, face and direction of fold.

Drawn with the outside of the fold up. The two halves of the sheet turn about a hinge: in the middle
of the web where a groove leaves one, in the middle of the sheet where nothing is taken away, on the
inner face where a cut goes through.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.materials import Material, Score
from foldmill_fabricate.materials.processes import AnyScore
from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

ANGLE = 90.0
"""deg. How far the fold in the picture is closed."""
REACH = 4.0
"""Thicknesses of sheet that are drawn on either side."""


def section(score: AnyScore, thickness: float, angle: float) -> Any:
    """Return the sheet in section, folded by ``angle`` degrees, as a shapely area in mm.

    x across the fold; y up, towards the outside of the fold; the inner face of the flat sheet lies
    at y = 0 and the fold at x = 0.
    """
    import shapely
    from shapely import affinity

    hinge = _hinge(score, thickness)
    parts = []
    for side in (-1, 1):
        half = shapely.Polygon(_half(score, thickness) * (side, 1))
        parts.append(affinity.rotate(half, -side * angle / 2, origin=(0, hinge)))
    folded = shapely.union_all([*parts, *_web(score, thickness, hinge, angle)])
    for dent in _dents(score, thickness, hinge, angle):
        folded = folded.difference(dent)
    return folded


def _hinge(score: AnyScore, thickness: float) -> float:
    """Return the height of the hinge above the inner face, mm."""
    if score.kind == "half-cut":
        return thickness * score.remains / 2
    if score.kind == "v-score":
        return thickness * (1 - score.remains / 2)
    return 0.0 if score.kind == "perforation" else thickness / 2


def _half(score: AnyScore, t: float) -> Floats:
    """Return the right half of the flat sheet."""
    reach = REACH * t
    if score.kind == "v-score":
        depth = t * score.depth_ratio
        top = depth * np.tan(np.radians(ANGLE / 2))
        return np.array([(0, depth), (top, 0), (reach, 0), (reach, t), (0, t)])
    return np.array([(0, 0), (reach, 0), (reach, t), (0, t)])


def _web(score: AnyScore, t: float, hinge: float, angle: float) -> list[Any]:
    """Return what holds the halves together on the outside of the hinge: it is stretched."""
    top = {"half-cut": t * score.remains, "perforation": 0.0}.get(score.kind, t)
    found = [_fan(hinge, top - hinge, angle)] if top > hinge and angle else []
    if score.kind == "crease-wheel":
        found.append(_disc(0.0, t * score.depth_ratio))
    return found


def _fan(hinge: float, radius: float, angle: float) -> Any:
    import shapely

    turns = np.radians(np.linspace(90 - angle / 2, 90 + angle / 2, 25))
    rim = np.column_stack([radius * np.cos(turns), hinge + radius * np.sin(turns)])
    return shapely.Polygon([(0.0, hinge), *rim.tolist()])


def _disc(y: float, radius: float) -> Any:
    import shapely

    return shapely.Point(0, y).buffer(radius)


def _dents(score: AnyScore, t: float, hinge: float, angle: float) -> list[Any]:
    """Return what is pressed in: it is missing from the section."""
    lean = np.cos(np.radians(angle / 2))
    if score.kind == "stylus":
        return [_disc(hinge - (t - hinge) / max(lean, 0.1), t * score.depth_ratio)]
    if score.kind == "crease-wheel":
        return [_disc(t, t * score.depth_ratio)]
    if score.kind == "half-cut" and not angle:
        return [_slit(t * score.remains, t)]
    return [_slit(0.0, t)] if score.kind == "perforation" and not angle else []


def _slit(low: float, high: float) -> Any:
    import shapely

    return shapely.box(-0.01 * high, low, 0.01 * high, high)


def section_picture(material: Material, score: AnyScore) -> bytes:
    """Return a PNG of one mountain fold of a material: as it is scored, and folded."""
    with canvas.own_style():
        figure = canvas.figure(190, 70)
        for k, angle in enumerate((0.0, ANGLE)):
            axes = canvas.flat_axes(figure, (0.02 + 0.49 * k, 0.03, 0.47, 0.74))
            _draw(axes, material, score, angle)
        figure.suptitle(f"{material.title}: {score.title}", fontsize=11)
        return canvas.png(figure)


def _draw(axes: Axes, material: Material, score: AnyScore, angle: float) -> None:
    t = material.thickness
    area = section(score, t, angle)
    for part in getattr(area, "geoms", [area]):
        axes.fill(*np.array(part.exterior.coords).T, facecolor="#b8d4e8", edgecolor="#204060")
    if score.kind == "pen" and not angle:
        axes.plot([0], [0], marker="o", markersize=4, color="black")
    span = 2 * REACH * t
    x0, y0, x1, y1 = area.bounds
    axes.set_xlim(x0 - 0.05 * span, x1 + 0.05 * span)
    axes.set_ylim(y0 - 0.16 * span, y1 + 0.16 * span)
    middle = 0.62 * (x1 if angle else 0) if not angle else 0.0
    axes.text(middle, y1 + 0.05 * span, "outside of the fold (front of a mountain)", **_WORDS)
    low = y0 - 0.06 * span if not angle else y0 + 0.04 * span
    axes.text(0, low, "inside" if angle else "inside of the fold", **_WORDS)
    axes.set_title(_caption(score, t) if not angle else f"folded by {angle:g}°", fontsize=7.5)


_WORDS: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8, "color": "#404040"}


def _caption(score: Score, t: float) -> str:
    depth = getattr(score, "depth_ratio", None)
    where = {"either": "from the reverse"}.get(score.score_face, f"on the {score.score_face}")
    if depth is None:
        return f"flat, {t:g} mm; worked {where}"
    left = f", {t * score.remains:.2f} mm left" if score.remains < 1 else ", pressed"
    return f"flat, {t:g} mm; groove {where}, {t * depth:.2f} mm deep{left}"
