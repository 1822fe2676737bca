"""A target as three expressions in u and v."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from foldmill import Params
from foldmill_plugins.waterbomb.expression import parsed, value
from foldmill_plugins.waterbomb.sound import sound
from foldmill_plugins.waterbomb.surfaces import Jet, Span, Surface

Floats = NDArray[np.float64]


def _as_text(given: Any) -> Any:
    """Take a number for the expression that it is: a command line reads 0 as a number."""
    is_number = isinstance(given, int | float) and not isinstance(given, bool)
    return repr(given) if is_number else given


def _expression(text: str) -> str:
    parsed(text)
    return text


def _constant(text: str) -> str:
    value(text)
    return text


Expression = Annotated[str, BeforeValidator(_as_text), AfterValidator(_expression)]
"""Text such as "cos(u)*(2+cos(v))"."""
Constant = Annotated[str, BeforeValidator(_as_text), AfterValidator(_constant)]
"""Text such as "2*pi", without u and v."""


class ExpressionSurface(Params):
    """Any surface P(u, v) that can be written down."""

    kind: Literal["expression"] = "expression"
    """Three expressions in u and v: numbers, pi, e, + - * / **, brackets, sin cos tan asin acos
    atan sinh cosh tanh asinh acosh atanh exp log sqrt abs."""
    x: Expression = "u"
    """x, such as "cos(u)*(2+cos(v))"; the target's unit is of no matter, see `size`."""
    y: Expression = "v"
    """y, such as "sin(u)*(2+cos(v))"."""
    z: Expression = "u*v/2"
    """z, such as "sin(v)"."""
    u_start: Constant = "-1"
    """Where u begins, a number such as "-pi/2"."""
    u_end: Constant = "1"
    """Where u ends."""
    v_start: Constant = "-1"
    """Where v begins."""
    v_end: Constant = "1"
    """Where v ends."""
    u_closes: bool = Field(default=False)
    """Whether the surface closes on itself along u: its point at u_end is that at u_start."""
    v_closes: bool = Field(default=False)
    """Whether it closes on itself along v."""

    @model_validator(mode="after")
    def _forwards(self) -> ExpressionSurface:
        for name, (low, high) in (("u", self.span("u")), ("v", self.span("v"))):
            if not low < high:
                raise ValueError(
                    f"{name}_end must be more than {name}_start, and {high:g} is not more than "
                    f"{low:g}"
                )
        return self

    def span(self, name: str) -> Span:
        """Return where u or v begins and ends."""
        return value(getattr(self, f"{name}_start")), value(getattr(self, f"{name}_end"))

    def surface(self) -> Surface:
        """Return the surface; raises ImpossibleGeometry where it is none."""
        return _surface(self)


@lru_cache(maxsize=16)
def _surface(params: ExpressionSurface) -> Surface:
    trees = [parsed(text) for text in (params.x, params.y, params.z)]

    def jet(u: Floats, v: Floats) -> Jet:
        u, v = np.broadcast_arrays(np.asarray(u, np.float64), np.asarray(v, np.float64))
        series = np.stack([tree.series(u, v) for tree in trees], axis=2)
        return Jet(*series)

    closes = params.u_closes, params.v_closes
    return sound(Surface("surface", jet, params.span("u"), params.span("v"), *closes))
