"""Values that carry their first and second derivatives by u and v: exact, without differences.

Terminology: a *series* is (6, n): f, f_u, f_v, f_uu, f_uv, f_vv at n places.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Slopes = tuple[Floats, Floats, Floats]
"""h, h' and h'' of a function of one variable, each (n,)."""


def number(value: float, n: int) -> Floats:
    """Return the series of a constant at n places."""
    out = np.zeros((6, n))
    out[0] = value
    return out


def variable(values: Floats, axis: int) -> Floats:
    """Return the series of u (axis 0) or v (axis 1) at places (n,)."""
    out = np.zeros((6, len(values)))
    out[0], out[1 + axis] = values, 1.0
    return out


def times(a: Floats, b: Floats) -> Floats:
    """Return the product of two series."""
    return np.stack(
        [
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            a[2] * b[0] + a[0] * b[2],
            a[3] * b[0] + 2 * a[1] * b[1] + a[0] * b[3],
            a[4] * b[0] + a[1] * b[2] + a[2] * b[1] + a[0] * b[4],
            a[5] * b[0] + 2 * a[2] * b[2] + a[0] * b[5],
        ]
    )


def through(a: Floats, slopes: Slopes) -> Floats:
    """Return h(a) by the chain rule; slopes : of h at the values of a."""
    value, one, two = slopes
    return np.stack(
        [
            value,
            one * a[1],
            one * a[2],
            two * a[1] ** 2 + one * a[3],
            two * a[1] * a[2] + one * a[4],
            two * a[2] ** 2 + one * a[5],
        ]
    )


def over(a: Floats, b: Floats) -> Floats:
    """Return a / b."""
    return times(a, to_the(b, -1.0))


def to_the(a: Floats, exponent: float) -> Floats:
    """Return a to a constant exponent; a whole one from 0 upwards at a = 0 too."""
    x, c = a[0], exponent
    one = c * x ** (c - 1) if c != 0 else 0 * x
    two = c * (c - 1) * x ** (c - 2) if c not in (0, 1) else 0 * x
    return through(a, (x**c, one, two))


def power(a: Floats, b: Floats) -> Floats:
    """Return a to the b, for positive a."""
    return call("exp", times(b, call("log", a)))


def call(name: str, a: Floats) -> Floats:
    """Return a function of ``FUNCTIONS`` of a series."""
    return through(a, FUNCTIONS[name](a[0]))


def _tan(x: Floats) -> Slopes:
    t = np.tan(x)
    return t, 1 + t * t, 2 * t * (1 + t * t)


def _tanh(x: Floats) -> Slopes:
    t = np.tanh(x)
    return t, 1 - t * t, -2 * t * (1 - t * t)


def _arc(inverse: Callable[[Floats], Floats], sign: float) -> Callable[[Floats], Slopes]:
    """Return the slopes of arcsin (sign 1) or arccos (sign -1)."""

    def slopes(x: Floats) -> Slopes:
        root = np.sqrt(1 - x * x)
        return inverse(x), sign / root, sign * x / root**3

    return slopes


def _atan(x: Floats) -> Slopes:
    one = 1 / (1 + x * x)
    return np.arctan(x), one, -2 * x * one**2


def _asinh(x: Floats) -> Slopes:
    root = np.sqrt(x * x + 1)
    return np.arcsinh(x), 1 / root, -x / root**3


def _acosh(x: Floats) -> Slopes:
    root = np.sqrt(x * x - 1)
    return np.arccosh(x), 1 / root, -x / root**3


def _atanh(x: Floats) -> Slopes:
    one = 1 / (1 - x * x)
    return np.arctanh(x), one, 2 * x * one**2


def _sqrt(x: Floats) -> Slopes:
    root = np.sqrt(x)
    return root, 0.5 / root, -0.25 / root**3


FUNCTIONS: Mapping[str, Callable[[Floats], Slopes]] = MappingProxyType(
    {
        "sin": lambda x: (np.sin(x), np.cos(x), -np.sin(x)),
        "cos": lambda x: (np.cos(x), -np.sin(x), -np.cos(x)),
        "tan": _tan,
        "asin": _arc(np.arcsin, 1.0),
        "acos": _arc(np.arccos, -1.0),
        "atan": _atan,
        "sinh": lambda x: (np.sinh(x), np.cosh(x), np.sinh(x)),
        "cosh": lambda x: (np.cosh(x), np.sinh(x), np.cosh(x)),
        "tanh": _tanh,
        "asinh": _asinh,
        "acosh": _acosh,
        "atanh": _atanh,
        "exp": lambda x: (np.exp(x), np.exp(x), np.exp(x)),
        "log": lambda x: (np.log(x), 1 / x, -1 / x**2),
        "sqrt": _sqrt,
        "abs": lambda x: (np.abs(x), np.sign(x), 0 * x),
    }
)
"""Every function an expression may call: x (n,) → h, h', h'' (n,)."""
