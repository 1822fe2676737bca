"""Drawings in SVG as lines: by layer and by colour, opacity for the fold angle."""

from __future__ import annotations

from foldmill.exchange.svg.reading import read

__all__ = ["read"]
