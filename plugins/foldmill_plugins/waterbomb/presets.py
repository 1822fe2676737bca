"""The tessellations of Tables 6.1 and 6.3, and some on surfaces given by expressions, by name."""

from __future__ import annotations

from typing import Any

from foldmill_plugins.waterbomb.expression_surface import ExpressionSurface
from foldmill_plugins.waterbomb.params import Name, TableSurface, WaterbombParams


def _on(kind: Name, n_u: int, n_v: int) -> WaterbombParams:
    return WaterbombParams(surface=TableSurface(kind=kind), n_u=n_u, n_v=n_v)


def _given(n_u: int, n_v: int, **surface: Any) -> WaterbombParams:
    return WaterbombParams(surface=ExpressionSurface(**surface), n_u=n_u, n_v=n_v)


HELICOID = {"x": "v*cos(u)", "y": "v*sin(u)", "z": "0.4*u"}
MONKEY_SADDLE = {"x": "u", "y": "v", "z": "(u**3 - 3*u*v**2)/3"}
EGG_CRATE = {"x": "u", "y": "v", "z": "0.15*sin(pi*u)*cos(pi*v)"}
TWISTED_TUBE = {
    "x": "(1 + 0.2*cos(3*u + v))*cos(u)",
    "y": "(1 + 0.2*cos(3*u + v))*sin(u)",
    "z": "v",
}
ELBOW = {"x": "(3 + cos(u))*cos(v)", "y": "(3 + cos(u))*sin(v)", "z": "sin(u)"}
ROUND = {"u_start": "0", "u_end": "2*pi", "u_closes": True}

PRESETS = {
    "catenoid": _on("catenoid", 10, 10),
    "sphere": _on("sphere", 25, 10),
    "cylinder": _on("cylinder", 10, 10),
    "vase": _on("vase", 21, 10),
    "torus": _on("torus", 55, 10),
    "hyperbolic-paraboloid": _on("hyperbolic-paraboloid", 10, 10),
    # Its two ends lie beside each other in space; left free, they would pass through each other.
    "moebius": _on("moebius", 22, 3).model_copy(update={"boundary": "fixed"}),
    "catenoid-8x6": _on("catenoid", 8, 6),
    "catenoid-10x7": _on("catenoid", 10, 7),
    "catenoid-13x9": _on("catenoid", 13, 9),
    "catenoid-20x14": _on("catenoid", 20, 14),
    "helicoid": _given(24, 6, **HELICOID, u_start="0", u_end="2*pi", v_start="0.3", v_end="1.2"),
    "monkey-saddle": _given(14, 14, **MONKEY_SADDLE),
    "egg-crate": _given(14, 14, **EGG_CRATE),
    "twisted-tube": _given(18, 9, **TWISTED_TUBE, **ROUND, v_start="-1.5", v_end="1.5"),
    "elbow": _given(14, 12, **ELBOW, **ROUND, v_start="0", v_end="pi/2"),
}
