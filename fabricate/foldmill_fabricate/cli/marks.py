"""Measured marks, as they are typed."""

from __future__ import annotations

from math import isfinite

from foldmill import FoldmillError


def read_marks(text: str) -> list[tuple[float, float]]:
    """Read x1,y1;x2,y2;… in mm."""
    try:
        pairs = [mark.split(",") for mark in text.split(";") if mark.strip()]
        read = [(float(x), float(y)) for x, y in pairs]
        if not all(isfinite(value) for mark in read for value in mark):
            raise ValueError
    except ValueError:
        raise FoldmillError(f"--marks: write x1,y1;x2,y2;… in mm, not {text!r}.") from None
    return read
