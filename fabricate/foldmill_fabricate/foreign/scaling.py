"""User units of HP-GL: SC between the points of IP (HP 7475A manual, chapter 4).

Anisotropic scaling only, exactly: x = P1x + (X − Xmin)·(P2x − P1x)/(Xmax − Xmin).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

XY = tuple[float, float]


class Unscalable(ValueError):
    """IP or SC that cannot be carried out; its text is the reason."""


@dataclass(frozen=True)
class Scale:
    """From user units to plotter units."""

    corners: tuple[float, float, float, float] | None = None
    """P1x, P1y, P2x, P2y, plotter units; None before any IP, for then they are the machine's."""
    origin: XY = (0.0, 0.0)
    """User units at P1."""
    factor: XY = (1.0, 1.0)
    """Plotter units for each user unit."""
    wanted: tuple[float, float, float, float] | None = field(default=None, repr=False)
    """Xmin, Xmax, Ymin, Ymax; None without SC."""

    def point(self, x: float, y: float) -> XY:
        """Turn a place in user units into plotter units."""
        if self.wanted is None or self.corners is None:
            return x, y
        return (
            self.corners[0] + (x - self.origin[0]) * self.factor[0],
            self.corners[1] + (y - self.origin[1]) * self.factor[1],
        )

    def user(self, x: float, y: float) -> XY:
        """Turn a place in plotter units into user units."""
        if self.wanted is None or self.corners is None:
            return x, y
        return (
            self.origin[0] + (x - self.corners[0]) / self.factor[0],
            self.origin[1] + (y - self.corners[1]) / self.factor[1],
        )

    @property
    def largest(self) -> float:
        """Plotter units that a user unit is at the most."""
        return max(abs(each) for each in self.factor)

    def between(self, values: list[float]) -> Scale:
        """Carry out IP; raises Unscalable."""
        if len(values) != 4:
            raise Unscalable("sets points that depend on the machine; give it four numbers")
        x1, y1, x2, y2 = values
        if x1 == x2 or y1 == y2:
            raise Unscalable("sets two points with nothing between them")
        moved = replace(self, corners=(x1, y1, x2, y2))
        return moved.scaled(list(self.wanted)) if self.wanted else moved

    def scaled(self, values: list[float]) -> Scale:
        """Carry out SC; without numbers it ends scaling. Raises Unscalable."""
        if not values:
            return Scale(self.corners)
        if len(values) != 4:
            raise Unscalable("scales otherwise than by four numbers")
        if self.corners is None:
            raise Unscalable("scales to points that depend on the machine; put IP before it")
        left, right, low, high = values
        if left == right or low == high:
            raise Unscalable("scales an empty range")
        x1, y1, x2, y2 = self.corners
        factor = ((x2 - x1) / (right - left), (y2 - y1) / (high - low))
        if not 1e-9 < min(map(abs, factor)) <= max(map(abs, factor)) < 1e9:
            raise Unscalable("scales by a factor that nobody draws with")
        return Scale(self.corners, (left, low), factor, (left, right, low, high))
