"""Colours as CSS writes them, and what crease pattern programs mean by them."""

from __future__ import annotations

import re
from colorsys import rgb_to_hsv
from functools import cache

from foldmill.exchange.drawing import Colour

_HUES = {0: "M", 60: "F", 120: "C", 240: "V", 300: "U"}
"""deg → letter: red, yellow, green, blue and magenta of Origami Simulator. Orange and cyan mean one
thing here and another there, so they mean nothing."""
_HUE_REACH = 20.0
"""deg. Crimson, gold, royalblue and the reds and blues of printers' inks lie within it; orange (30)
and cyan (180) do not."""
_LEAST_SATURATION, _DARK, _LIGHT = 0.4, 0.3, 0.95
"""Less saturated is grey; darker than _DARK is black; lighter grey than _LIGHT is white."""
_PROFILED = " icc-color("
"""Begins the same colour once more, for printers, as older drawing programs add it."""
_FUNCTION = re.compile(r"(rgb|hsl)a?\(([^()]*)\)")


@cache
def parse(text: str) -> tuple[Colour, float] | None:
    """Return a colour and its alpha, 0 to 1; None for "none" and whatever is no plain colour."""
    from PIL import ImageColor

    word = text.strip().lower().partition(_PROFILED)[0].strip()
    alpha = 1.0
    if found := _FUNCTION.fullmatch(word):
        kind, values = found[1], re.split(r"[\s,/]+", found[2].strip())
        alpha = _share(values.pop()) if len(values) == 4 else 1.0
        word = f"{kind}({','.join(values)})"
    elif word.startswith("hsv"):
        return None
    try:
        rgb = ImageColor.getrgb(word)
    except ValueError:
        return None
    alpha *= rgb[3] / 255 if len(rgb) == 4 else 1.0
    red, green, blue = (min(max(int(each), 0), 255) for each in rgb[:3])
    return (red, green, blue), min(max(alpha, 0.0), 1.0)


def _share(text: str) -> float:
    try:
        return float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        return 1.0


@cache
def letter_of(colour: Colour) -> str | None:
    """Return what a colour means: a letter, an empty word for white, None where nobody can tell.

    Black is B, grey F, and the rest goes by hue: red M, blue V, green C, yellow F, magenta U.
    """
    hue, saturation, value = rgb_to_hsv(*(each / 255 for each in colour))
    if value < _DARK:
        return "B"
    if saturation < _LEAST_SATURATION:
        return ("" if value > _LIGHT else "F") if saturation < _LEAST_SATURATION / 4 else None
    for degrees, letter in _HUES.items():
        if abs((hue * 360 - degrees + 180) % 360 - 180) <= _HUE_REACH:
            return letter
    return None
