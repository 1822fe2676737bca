"""Expressions in u and v: a small language of its own, read into a tree and never run as code.

There are numbers, u, v, pi, e, + − * / **, signs, brackets and the functions of one argument that
``taylor.FUNCTIONS`` lists. Everything else is refused with the words in question.
"""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import InvalidParameters
from foldmill_plugins.waterbomb import taylor

Floats = NDArray[np.float64]

LONGEST = 500
"""Characters of an expression."""
DEEPEST = 100
"""Brackets and operations within each other."""
NAMES = {"pi": math.pi, "e": math.e}
_OPERATIONS: dict[type[ast.operator], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}


@dataclass(frozen=True)
class Number:
    """A constant."""

    value: float

    def series(self, u: Floats, v: Floats) -> Floats:  # noqa: ARG002 - as all trees
        """Return values and derivatives (6, n) at places u, v (n,)."""
        return taylor.number(self.value, len(u))


@dataclass(frozen=True)
class Variable:
    """u (axis 0) or v (axis 1)."""

    axis: int

    def series(self, u: Floats, v: Floats) -> Floats:
        """Return values and derivatives (6, n) at places u, v (n,)."""
        return taylor.variable((u, v)[self.axis], self.axis)


@dataclass(frozen=True)
class Operation:
    """Two parts joined by one of + - * / **."""

    sign: str
    one: Tree
    two: Tree

    def series(self, u: Floats, v: Floats) -> Floats:
        """Return values and derivatives (6, n) at places u, v (n,)."""
        a = self.one.series(u, v)
        if self.sign == "**" and isinstance(self.two, Number):
            return taylor.to_the(a, self.two.value)
        b = self.two.series(u, v)
        if self.sign in "+-":
            return a + b if self.sign == "+" else a - b
        return {"*": taylor.times, "/": taylor.over, "**": taylor.power}[self.sign](a, b)


@dataclass(frozen=True)
class Call:
    """A function of one argument."""

    name: str
    argument: Tree

    def series(self, u: Floats, v: Floats) -> Floats:
        """Return values and derivatives (6, n) at places u, v (n,)."""
        return taylor.call(self.name, self.argument.series(u, v))


Tree = Number | Variable | Operation | Call


def parsed(text: str) -> Tree:
    """Return the tree of an expression.

    Raises InvalidParameters for what is no such expression, too long, too deep, or no finite
    number.
    """
    if len(text) > LONGEST:
        raise InvalidParameters(
            f"an expression has at most {LONGEST} characters, not {len(text)}; write it shorter"
        )
    try:
        whole = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InvalidParameters(
            "this is no expression; write it with numbers, u, v, pi, e, + - * / ** and brackets"
        ) from None
    return _tree(whole, text.strip(), DEEPEST)


def value(text: str) -> float:
    """Return the finite number that an expression without u and v is; raises InvalidParameters."""
    tree = parsed(text)
    if not isinstance(tree, Number):
        raise InvalidParameters("here u and v mean nothing; write a number, such as 2*pi")
    return tree.value


def _tree(node: ast.expr, text: str, room: int) -> Tree:
    if room == 0:
        raise InvalidParameters(
            f"more than {DEEPEST} operations lie within each other; write it shorter"
        )
    tree = _made(node, text, room)
    if isinstance(tree, Number) or not all(isinstance(part, Number) for part in _parts(tree)):
        return tree
    return _folded(tree, _words(node, text))


def _made(node: ast.expr, text: str, room: int) -> Tree:
    match node:
        case ast.Constant(value=int() | float() as given) if not isinstance(given, bool):
            return _number(given, _words(node, text))
        case ast.Name(id="u" | "v" as name):
            return Variable("uv".index(name))
        case ast.Name(id=name) if name in NAMES:
            return Number(NAMES[name])
        case ast.UnaryOp(op=ast.USub(), operand=part):
            return Operation("*", Number(-1.0), _tree(part, text, room - 1))
        case ast.UnaryOp(op=ast.UAdd(), operand=part):
            return _tree(part, text, room - 1)
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATIONS:
            one, two = (_tree(part, text, room - 1) for part in (left, right))
            return Operation(_OPERATIONS[type(sign)], one, two)
        case ast.Call(func=ast.Name(id=name), args=[part], keywords=[]) if name in taylor.FUNCTIONS:
            return Call(name, _tree(part, text, room - 1))
    raise InvalidParameters(_refusal(node, _words(node, text)))


def _parts(tree: Tree) -> tuple[Tree, ...]:
    if isinstance(tree, Operation):
        return tree.one, tree.two
    return (tree.argument,) if isinstance(tree, Call) else (tree,)


def _number(given: float, words: str) -> Number:
    try:
        number = float(given)
    except OverflowError:
        number = np.inf
    if not np.isfinite(number):
        raise InvalidParameters(f"{words} is no finite number")
    return Number(number)


def _folded(tree: Tree, words: str) -> Number:
    """Return a part without u and v as the number it is."""
    nothing = np.zeros(1)
    with np.errstate(all="ignore"):
        found = float(tree.series(nothing, nothing)[0, 0])
    return _number(found, words)


def _words(node: ast.expr, text: str) -> str:
    said = ast.get_source_segment(text, node) or text
    return repr(said if len(said) <= 40 else f"{said[:37]}...")


def _refusal(node: ast.expr, words: str) -> str:
    known = ", ".join(sorted(taylor.FUNCTIONS))
    if isinstance(node, ast.Call):
        return f"{words} is no function of one value that is known here; there are {known}"
    if isinstance(node, ast.Name):
        return f"{words} is unknown; there are u, v, pi and e"
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitXor):
        return f"write ** for a power, not ^, in {words}"
    return f"{words} has no place in an expression of numbers, u, v, pi, e, + - * / ** and brackets"
