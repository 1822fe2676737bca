"""The target surfaces of thesis Table 6.2, each with its first and second derivatives.

Surfaces are unitless; a design is scaled to millimetres once it is flat.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Span = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Jet:
    """Points of a surface and their derivatives, each (n, 3)."""

    p: Floats
    u: Floats
    v: Floats
    uu: Floats
    uv: Floats
    vv: Floats

    @property
    def cross(self) -> Floats:
        """P_u × P_v, (n, 3): along the normal n, as long as the area element."""
        area: Floats = np.cross(self.u, self.v)
        return area


@dataclass(frozen=True, eq=False)
class Surface:
    """A parametric surface P(u, v) over a rectangle."""

    name: str
    jet: Callable[[Floats, Floats], Jet]
    """(n,) u and (n,) v → points and derivatives; works beyond the rectangle as well."""
    u: Span
    v: Span
    is_u_periodic: bool = False
    """P(u_e, v) = P(u_s, v), so that the form closes on itself along u."""
    is_v_periodic: bool = False
    is_outward: bool = True
    """Whether P_u × P_v points to the outside; for an open sheet the outside is where it points."""
    is_revolution: bool = False
    """Whether |P_u|, |P_v| and P_u·P_v = 0 depend on v alone."""

    def points(self, u: Floats, v: Floats) -> Floats:
        """Return P (n, 3)."""
        return self.jet(u, v).p

    def steps(self, n_u: int, n_v: int) -> tuple[float, float]:
        """Return Δu and Δv of a grid of n_u × n_v quads."""
        return (self.u[1] - self.u[0]) / n_u, (self.v[1] - self.v[0]) / n_v


Profile = Callable[[Floats], tuple[Floats, ...]]
"""v → r, r', r'', z, z', z''."""
TURN: Span = (0.0, 2 * np.pi)


def revolution(
    name: str, profile: Profile, v: Span, *, is_clockwise: bool = False, is_outward: bool = True
) -> Surface:
    """Return a surface of revolution about z; clockwise: (r sin u, r cos u, z)."""

    def jet(u: Floats, v: Floats) -> Jet:
        r, r1, r2, z, z1, z2 = profile(v)
        e, e1 = (np.sin(u), np.cos(u)) if is_clockwise else (np.cos(u), np.sin(u))
        d, d1 = (np.cos(u), -np.sin(u)) if is_clockwise else (-np.sin(u), np.cos(u))
        o = np.zeros_like(r * u)
        return Jet(
            np.column_stack([r * e, r * e1, z + o]),
            np.column_stack([r * d, r * d1, o]),
            np.column_stack([r1 * e, r1 * e1, z1 + o]),
            np.column_stack([-r * e, -r * e1, o]),
            np.column_stack([r1 * d, r1 * d1, o]),
            np.column_stack([r2 * e, r2 * e1, z2 + o]),
        )

    closes = name == "torus"
    return Surface(name, jet, TURN, v, True, closes, is_outward, True)


def _catenoid(v: Floats) -> tuple[Floats, ...]:
    s, c, o = np.sinh(v / 2.5), np.cosh(v / 2.5), np.zeros_like(v)
    return c, s / 2.5, c / 6.25, v, o + 1, o


def _sphere(v: Floats) -> tuple[Floats, ...]:
    s, c = np.sin(v), np.cos(v)
    return c, -s, -c, s, c, -s


def _cylinder(v: Floats) -> tuple[Floats, ...]:
    o = np.zeros_like(v)
    return o + 1, o, o, v, o + 1, o


def _vase(v: Floats) -> tuple[Floats, ...]:
    s, c, o = np.sin(v), np.cos(v), np.zeros_like(v)
    return 2 + s, c, -s, -v, o - 1, o


def _torus(v: Floats) -> tuple[Floats, ...]:
    s, c = np.sin(v), np.cos(v)
    return 3 + c, -s, -c, s, c, -s


def _hyperbolic_paraboloid(u: Floats, v: Floats) -> Jet:
    o = np.zeros_like(u * v)
    flat = np.column_stack([o, o, o])
    return Jet(
        np.column_stack([u + o, v + o, u * v]),
        np.column_stack([o + 1, o, v + o]),
        np.column_stack([o, o + 1, u + o]),
        flat,
        np.column_stack([o, o, o + 1]),
        flat,
    )


def _moebius(u: Floats, v: Floats) -> Jet:
    c, s, ch, sh = np.cos(u), np.sin(u), np.cos(u / 2), np.sin(u / 2)
    o = np.zeros_like(u * v)
    r, ru, ruu, rv, ruv = 1 + v / 2 * ch, -v / 4 * sh, -v / 8 * ch, ch / 2, -sh / 4
    return Jet(
        np.column_stack([r * c, r * s, v / 2 * sh]),
        np.column_stack([ru * c - r * s, ru * s + r * c, v / 4 * ch]),
        np.column_stack([rv * c, rv * s, sh / 2 + o]),
        np.column_stack([ruu * c - 2 * ru * s - r * c, ruu * s + 2 * ru * c - r * s, -v / 8 * sh]),
        np.column_stack([ruv * c - rv * s, ruv * s + rv * c, ch / 4 + o]),
        np.column_stack([o, o, o]),
    )


_PI = float(np.pi)
TABLE = {
    surface.name: surface
    for surface in (
        revolution("catenoid", _catenoid, (-_PI, _PI)),
        revolution("sphere", _sphere, (-_PI / 2.2, _PI / 2.2)),
        revolution("cylinder", _cylinder, (-_PI, _PI)),
        revolution("vase", _vase, (-3.0, 4.0), is_outward=False),
        revolution("torus", _torus, (-_PI, _PI), is_clockwise=True, is_outward=False),
        Surface("hyperbolic-paraboloid", _hyperbolic_paraboloid, (-1.0, 1.0), (-1.0, 1.0)),
        Surface("moebius", _moebius, TURN, (-1.0, 1.0)),
    )
}
"""The seven surfaces of Table 6.2 by name."""
