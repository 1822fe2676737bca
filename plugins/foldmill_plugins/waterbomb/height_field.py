"""A target as heights over a rectangle, read from a picture or from a file of numbers."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from math import prod
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from foldmill import Count, ImpossibleGeometry
from foldmill_plugins.waterbomb.named_file import NamedFile
from foldmill_plugins.waterbomb.patch import FEWEST, patch
from foldmill_plugins.waterbomb.sound import sound
from foldmill_plugins.waterbomb.surfaces import Surface

Floats = NDArray[np.float64]

PICTURES = {
    ".png": "PNG",
    ".jpg": "JPEG",
    ".jpeg": "JPEG",
    ".tif": "TIFF",
    ".tiff": "TIFF",
    ".bmp": "BMP",
}
"""The one format each suffix is read as: a picture is never opened by any other reader."""
NUMBERS = (".csv", ".txt", ".npy")
MOST_NODES = 200
MOST_PIXELS = 20_000_000
MOST_NUMBERS = 4_000_000
"""Numbers of a text that is read."""
LONGEST_LINE = 2_000_000
"""Characters of one of its lines."""


class HeightField(NamedFile):
    """Heights over a rectangle: a picture, brighter is higher, or a grid of numbers.

    The rectangle's longer side is 2 units, and it has the picture's proportions.
    """

    kind: Literal["height-field"] = "height-field"
    """Heights over a rectangle, read from a picture (.png .jpg .tif .bmp: brighter is higher) or a
    grid of numbers (.csv .txt .npy; rows from top to bottom)."""
    relief: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] = 0.15
    """From the lowest to the highest place, as a share of the longer side."""
    nodes: Count = Field(default=41, ge=FEWEST, le=MOST_NODES)
    """Nodes of the spline along the longer side; a finer grid is averaged, which smooths it."""

    def surface(self) -> Surface:
        """Return the surface; raises ImpossibleGeometry for a file that holds no field."""
        return _surface(self)


@lru_cache(maxsize=8)
def _surface(params: HeightField) -> Surface:
    heights = _heights(params)
    low, high = float(heights.min()), float(heights.max())
    if high > low:
        heights = (heights - low) * (2 * params.relief / (high - low))
    field = averaged(heights, params.nodes)
    rows, columns = heights.shape
    half = np.array([columns - 1, rows - 1]) / (max(rows, columns) - 1)
    u, v = (np.linspace(-h, h, n) for h, n in zip(half, field.shape[::-1], strict=True))
    jet = patch(u, v, field[::-1].T[:, :, None])  # the first row is on top
    return sound(Surface("surface", jet, (u[0], u[-1]), (v[0], v[-1])))


def averaged(heights: Floats, nodes: int) -> Floats:
    """Return a grid with at most so many nodes along its longer side, ends upon ends.

    Each node is the mean of what is nearer to it than to the next, weighted down with the distance.
    """
    most = max(heights.shape)
    if most <= nodes:
        return heights
    for axis in (0, 1):
        count = heights.shape[axis]
        wanted = max(FEWEST, 1 + round((count - 1) * (nodes - 1) / (most - 1)))
        if wanted < count:
            place = np.linspace(0, count - 1, wanted)[:, None]
            reach = (count - 1) / (wanted - 1)
            weights = np.maximum(0.0, 1 - np.abs(np.arange(count) - place) / reach)
            weights /= weights.sum(axis=1, keepdims=True)
            heights = np.moveaxis(np.tensordot(weights, heights, (1, axis)), 0, axis)
    return heights


def _heights(params: HeightField) -> Floats:
    """Return the file's numbers (rows, columns); raises ImpossibleGeometry."""
    suffix = Path(params.file).suffix.lower()
    if suffix not in (*PICTURES, *NUMBERS):
        raise ImpossibleGeometry(
            f"{params.file}: a height field is read from {' '.join((*PICTURES, *NUMBERS))}, not "
            f"{suffix or 'a file without a suffix'}."
        )
    content = params.content()
    try:
        found = _read(content, suffix)
    except Exception as error:  # a broken file breaks its reader in whatever way it likes
        raise ImpossibleGeometry(
            f"{params.file} is no {suffix} file with one grid of numbers: "
            f"{' '.join(str(error).split())[:200] or type(error).__name__}."
        ) from None
    return _sane(params.file, found)


def _sane(file: str, found: NDArray[Any]) -> Floats:
    if found.dtype.kind not in "biuf":
        raise ImpossibleGeometry(f"{file} holds no real numbers; save heights as plain numbers.")
    heights: Floats = found.astype(np.float64)
    size = " × ".join(str(n) for n in heights.shape)
    if heights.ndim != 2 and heights.size:
        raise ImpossibleGeometry(
            f"{file} holds an array of {heights.ndim} dimensions ({size or 'one number'}); a field "
            "of heights has 2, rows and columns. Save one layer of it, or one colour."
        )
    if not heights.size or min(heights.shape) < FEWEST:
        raise ImpossibleGeometry(
            f"{file} holds {size} heights; a smooth surface needs at least {FEWEST} × {FEWEST}. "
            "Sample it more finely."
        )
    bad = np.argwhere(~np.isfinite(heights))
    if len(bad):
        row, column = bad[0] + 1
        raise ImpossibleGeometry(
            f"{file}: row {row}, column {column} is no finite number (and {len(bad) - 1} more). "
            "Fill such places, as a surface has no holes."
        )
    return heights


def _read(content: bytes, suffix: str) -> NDArray[Any]:
    if suffix in PICTURES:
        return _picture(content, PICTURES[suffix])
    return _array(content) if suffix == ".npy" else _numbers(content)


def _picture(content: bytes, kind: str) -> NDArray[Any]:
    import warnings

    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # its size is looked at
            image = Image.open(BytesIO(content), formats=[kind])
    except UnidentifiedImageError:
        raise ValueError(f"it is no {kind} picture") from None
    with image:
        if image.width * image.height > MOST_PIXELS:
            raise ValueError(f"it has more than {MOST_PIXELS // 10**6} million pixels")
        is_deep = image.mode.startswith(("I", "F"))
        return np.asarray(image if is_deep else image.convert("L"))


def _array(content: bytes) -> NDArray[Any]:
    file = BytesIO(content)
    version = np.lib.format.read_magic(file)
    old, new = np.lib.format.read_array_header_1_0, np.lib.format.read_array_header_2_0
    shape, _, kind = (old if version == (1, 0) else new)(file)
    if kind.hasobject or prod(shape) * kind.itemsize > len(content):
        raise ValueError("it does not hold the numbers that it says it holds")
    file.seek(0)
    return np.asarray(np.load(file, allow_pickle=False))


def _numbers(content: bytes) -> NDArray[Any]:
    lines = [line for line in content.decode("utf-8-sig").splitlines() if line.strip()]
    mark = next((sign for sign in ";,\t" if lines and sign in lines[0]), None)
    rows: list[Floats] = []
    left = MOST_NUMBERS
    for line in lines:
        if len(line) > LONGEST_LINE:
            raise ValueError(f"one of its lines has more than {LONGEST_LINE} characters")
        rows.append(np.array([float(word) for word in line.split(mark)]))
        left -= len(rows[-1])
        if left < 0:
            raise ValueError(f"it has more than {MOST_NUMBERS // 10**6} million numbers")
    widths = {len(row) for row in rows}
    if len(widths) > 1:
        raise ValueError(f"its rows have {min(widths)} to {max(widths)} numbers")
    return np.array(rows, np.float64)
