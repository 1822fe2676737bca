"""The tessellations of Tables 6.1 and 6.3, by name."""

from __future__ import annotations

from foldmill_plugins.waterbomb.params import Name, TableSurface, WaterbombParams


def _on(kind: Name, n_u: int, n_v: int) -> WaterbombParams:
    return WaterbombParams(surface=TableSurface(kind=kind), n_u=n_u, n_v=n_v)


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
}
