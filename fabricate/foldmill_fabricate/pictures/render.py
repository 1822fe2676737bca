"""Shaded triangles with exact hidden surfaces: a depth buffer, no more and no less.

Terminology: the *camera* looks at the form's middle from an azimuth and an elevation; a pixel is
drawn from the facet that is nearest to the camera there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern, Fold, FoldedForm, InvalidInput
from foldmill.folded import face_normals
from foldmill.tolerances import CLOSED_DEG

Floats = NDArray[np.float64]

OUTSIDE, INSIDE = (0.96, 0.74, 0.40), (0.52, 0.68, 0.84)
"""Red, green, blue of the front and of the reverse of the sheet, fully lit."""
INK = (0.22, 0.20, 0.18)
LAYER_GAP = 0.0015
"""Share of the form's size by which facets that lie on each other are drawn apart, as thickness
holds them apart in a real sheet: without it, which one is seen would be a matter of rounding."""
SAMPLES = 2
"""Samples per pixel and direction."""
EDGE_PIXELS = 0.9
"""Half the width of a drawn edge."""
_LIGHT = (-0.35, 0.60, 0.72)
"""Towards the light, in the camera's right, up and towards: over its left shoulder."""


@dataclass(frozen=True)
class Camera:
    """Where one looks from: degrees about z from +x, and degrees above the horizon."""

    azimuth: float
    elevation: float
    distance: float = 4.5
    """In sizes of the form: perspective without distortion."""

    def axes(self) -> Floats:
        """Return right, up and towards the camera as rows (3, 3)."""
        a, e = np.radians([self.azimuth, self.elevation])
        toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.array([right, np.cross(toward, right), toward])


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball that holds a form, or all the forms of a motion: what a fixed camera has in view."""

    middle: Floats
    """(3,) mm."""
    reach: float
    """mm."""

    @classmethod
    def around(cls, places: Floats) -> Ball:
        """Return the ball about the middle of the box of points (..., 3)."""
        points = places.reshape(-1, 3)
        middle = (points.max(axis=0) + points.min(axis=0)) / 2
        return cls(middle, float(np.linalg.norm(points - middle, axis=1).max()))


@dataclass(frozen=True, eq=False)
class Spot:
    """Where a point of the form is in its picture."""

    at: Floats
    """(2,) shares of the picture's side, from its lower left corner."""
    seen: bool
    """Whether no facet hides it."""


def spots(fold: Fold, camera: Camera, points: Floats) -> list[Spot]:
    """Return where points (k, 3) mm of the folded form are in the picture that ``render`` makes.

    Raises InvalidInput where the fold has no folded form.
    """
    ball = Ball.around(form_of(fold).vertices)
    facets, nearness = _projected(_spread(fold), camera, ball)
    flat, near = _projected(points[:, None, :], camera, ball)
    places = facets.reshape(-1, 2)
    low, high = places.min(axis=0), places.max(axis=0)
    shares = (flat[:, 0] - (low + high) / 2) * (0.96 / (high - low).max()) + 0.5
    return [
        Spot(share, not _hidden(spot, own, facets, nearness))
        for share, spot, own in zip(shares, flat[:, 0], near[:, 0], strict=True)
    ]


def _projected(corners: Floats, camera: Camera, view: Ball) -> tuple[Floats, Floats]:
    """Return places (..., 2) on a plane before the camera, and how near they are (...)."""
    seen = (corners - view.middle) @ camera.axes().T
    nearness = 1.0 / (camera.distance * view.reach - seen[..., 2])
    return seen[..., :2] * nearness[..., None], nearness


def _hidden(spot: Floats, own: float, facets: Floats, nearness: Floats) -> bool:
    """Tell whether a facet (F, 3, 2) lies before a spot (2,); a facet it lies on does not."""
    edges = np.roll(facets, -1, axis=1) - facets
    off = spot - facets
    turned = edges[:, :, 0] * off[:, :, 1] - edges[:, :, 1] * off[:, :, 0]
    total = turned.sum(axis=1)
    wide = np.abs(total) > 1e-12
    share = np.roll(turned[wide], 2, axis=1) / total[wide, None]
    here = (share * nearness[wide]).sum(axis=1)
    return bool(((share >= 0).all(axis=1) & (here > own * (1 + 3 * LAYER_GAP))).any())


def render(fold: Fold, camera: Camera, pixels: int, view: Ball | None = None) -> Floats:
    """Return an image (pixels, pixels, 3) in 0..1 of the folded form on white.

    view : what must fit into the image; where it is not given, the form itself, as large as it
    can be. Raises InvalidInput where the fold has no folded form.
    """
    ball = view or Ball.around(form_of(fold).vertices)
    return render_triangles(
        _spread(fold), _inked_sides(fold), camera, pixels, ball, is_fitted=view is None
    )


def render_triangles(
    corners: Floats,
    inked: NDArray[np.bool_],
    camera: Camera,
    pixels: int,
    view: Ball,
    *,
    is_fitted: bool = False,
) -> Floats:
    """Return an image (pixels, pixels, 3) in 0..1 of triangles (F, 3, 3) on white.

    inked : (F, 3) whether side k of a triangle is drawn; view : what must fit into the image;
    is_fitted : make what is seen as large as it can be, whatever the view.
    """
    side = pixels * SAMPLES
    seen = (corners - view.middle) @ camera.axes().T
    flat, nearness = _projected(corners, camera, view)
    screen = _fitted(flat, side) if is_fitted else _fixed(flat, camera, side)
    colours = _shade(seen, camera.distance * view.reach)
    image = _fill(screen, nearness, colours, inked, side)
    small: Floats = image.reshape(pixels, SAMPLES, pixels, SAMPLES, 3).mean(axis=(1, 3))
    return small[::-1]


def _fitted(flat: Floats, side: int) -> Floats:
    """Bring what is seen onto the image as large as it can be."""
    spots = flat.reshape(-1, 2)
    scale = 0.96 * side / np.ptp(spots, axis=0).max()
    centre = (spots.max(axis=0) + spots.min(axis=0)) / 2
    screen: Floats = (flat - centre) * scale + side / 2
    return screen


def _fixed(flat: Floats, camera: Camera, side: int) -> Floats:
    """Bring what is seen onto the image so that the whole ball would fit."""
    outline = 1.0 / np.sqrt(camera.distance**2 - 1)
    screen: Floats = flat * (0.48 * side / outline) + side / 2
    return screen


def form_of(fold: Fold) -> FoldedForm:
    """Return the folded form; raises InvalidInput where none is known."""
    if fold.folded is None:
        raise InvalidInput(
            "Only the crease pattern is known here, so its folded form cannot be drawn. Take a "
            "FOLD file with a folded form, or draw the pattern alone."
        )
    return fold.folded


def _spread(fold: Fold) -> Floats:
    """Return the facets' corners (F, 3, 3), those folded onto each other a hair apart.

    Across a valley folded to 180 the front faces touch, so both facets give way backward.
    """
    pattern, form = fold.pattern, form_of(fold)
    closed = np.abs(pattern.fold_angles) >= 180 - CLOSED_DEG
    panels = _panels(pattern)
    away = np.zeros(len(pattern.faces))
    for pair, angle in zip(pattern.edge_faces[closed], pattern.fold_angles[closed], strict=True):
        away[panels[pair]] -= np.sign(angle)
    normals = face_normals(form.vertices, pattern.faces)
    shift = (LAYER_GAP * form.size * away[panels])[:, None] * normals
    corners: Floats = form.vertices[pattern.faces] + shift[:, None, :]
    return corners


def _panels(pattern: CreasePattern) -> NDArray[np.intp]:
    """Return (F,) the number of the flat panel each facet is part of: joined by flat edges."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    one, two = pattern.edge_faces[pattern.assignments == Assignment.F].T
    count = len(pattern.faces)
    joined = coo_array((np.ones(len(one)), (one, two)), shape=(count, count))
    labels: NDArray[np.intp] = connected_components(joined, directed=False)[1].astype(np.intp)
    return labels


def _inked_sides(fold: Fold) -> NDArray[np.bool_]:
    """Return (F, 3): whether side k of a facet, from its corner k to k + 1, is drawn."""
    pattern = fold.pattern
    kinds = {
        frozenset(edge): code != Assignment.F
        for edge, code in zip(pattern.edges.tolist(), pattern.assignments.tolist(), strict=True)
    }
    sides = [
        [kinds[frozenset((f[k], f[(k + 1) % 3]))] for k in range(3)] for f in pattern.faces.tolist()
    ]
    return np.array(sides, bool).reshape(-1, 3)


def _shade(seen: Floats, distance: float) -> Floats:
    """Return the colour (F, 3) of each facet, by the face it shows and how the light falls."""
    normal = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    sight = np.array([0.0, 0.0, distance]) - seen.mean(axis=1)
    front = np.einsum("ij,ij->i", normal, sight) >= 0
    lit = np.where(front[:, None], normal, -normal) @ (np.array(_LIGHT) / np.linalg.norm(_LIGHT))
    brightness = 0.6 + 0.4 * np.clip(lit, 0.0, 1.0)
    colours: Floats = np.where(front[:, None], OUTSIDE, INSIDE) * brightness[:, None]
    return colours


def _fill(
    screen: Floats, nearness: Floats, colours: Floats, inked: NDArray[np.bool_], side: int
) -> Floats:
    """Return the picture (side, side, 3), row 0 at the bottom."""
    image, depth = np.ones((side, side, 3)), np.zeros((side, side))
    for corners, near, colour, ink in zip(screen, nearness, colours, inked, strict=True):
        low = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
        high = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 1, side)
        x, y = np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1])[:, None] + 0.5
        heights = _heights(corners, x, y)
        if heights is None:
            continue
        share, distance = heights
        at = (slice(low[1], high[1]), slice(low[0], high[0]))
        here = np.tensordot(near, share, axes=1)
        wins = (share >= 0).all(axis=0) & (here > depth[at])
        drawn = (distance < EDGE_PIXELS * SAMPLES) & ink[:, None, None]
        depth[at][wins] = here[wins]
        image[at][wins] = colour
        image[at][wins & drawn.any(axis=0)] = INK
    return image


def _heights(corners: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats] | None:
    """Return, per pixel, each corner's share (3, h, w) and each side's distance in pixels.

    Side k runs from corner k to k + 1, so its opposite corner is k + 2. None for a facet that is
    seen edge on.
    """
    starts, steps = corners, np.roll(corners, -1, axis=0) - corners
    area = float(steps[0, 0] * -steps[2, 1] + steps[0, 1] * steps[2, 0])
    if abs(area) < 1e-9:
        return None
    crossed = np.stack(
        [dx * (y - y0) - dy * (x - x0) for (x0, y0), (dx, dy) in zip(starts, steps, strict=True)]
    )
    share = np.roll(crossed, 2, axis=0) / area
    lengths = np.hypot(*steps.T)[:, None, None]
    return share, np.abs(crossed) / lengths
