"""Targets given by three expressions in u and v: the language, its slopes, what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from waterbomb_targets import BALL, ROUND

from foldmill import ImpossibleGeometry, InvalidParameters
from foldmill_fabricate.cli.parameters import gather
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.expression import DEEPEST, LONGEST, parsed, value
from foldmill_plugins.waterbomb.expression_surface import ExpressionSurface
from foldmill_plugins.waterbomb.surfaces import TABLE
from foldmill_plugins.waterbomb.taylor import FUNCTIONS

TUBE = {"x": "cos(u)", "y": "sin(u)", "z": "v", **ROUND}
RING = {"x": "(3+cos(v))*cos(u)", "y": "(3+cos(v))*sin(u)", "z": "sin(v)", **ROUND}


def surface(**values: Any) -> ExpressionSurface:
    return ExpressionSurface.model_validate(values)


def run(n_u: int, n_v: int, **values: Any) -> Any:
    return DESIGN.run({"surface": {"kind": "expression", **values}, "n_u": n_u, "n_v": n_v})


LEAVES = st.sampled_from(["u", "v", "pi", "e", "2", "0.5", "1e-1"])
SMOOTH = ("sin", "cos", "atan", "sinh", "cosh", "tanh", "asinh", "exp")


def _joined(parts: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    pairs = st.tuples(parts, st.sampled_from("+-*"), parts).map(lambda p: f"({p[0]}{p[1]}{p[2]})")
    calls = st.tuples(st.sampled_from(SMOOTH), parts).map(lambda p: f"{p[0]}({p[1]})")
    return st.one_of(pairs, calls, parts.map(lambda p: f"-{p}"), parts.map(lambda p: f"({p})**2"))


EXPRESSIONS = st.recursive(LEAVES, _joined, max_leaves=6)
NAMES = {name: getattr(mpmath, name) for name in FUNCTIONS if name != "abs"}
NAMES |= {"pi": mpmath.pi, "e": mpmath.e, "abs": abs}


def slow(text: str, u: float, v: float) -> list[float]:
    """Differentiate by differences of 50 digits, with Python's own reading of the words."""

    def f(a: Any, b: Any) -> Any:
        return mpmath.mpf(1) * eval(text, {"__builtins__": {}}, {**NAMES, "u": a, "v": b})

    orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
    with mpmath.workdps(50):
        return [float(f(u, v) if not any(n) else mpmath.diff(f, (u, v), n)) for n in orders]


def agrees(text: str, u: float, v: float) -> bool:
    with np.errstate(all="ignore"):
        fast = parsed(text).series(np.array([u]), np.array([v]))[:, 0]
    exact = np.array(slow(text, u, v))
    size = max(1.0, np.abs(exact).max())
    return bool(np.abs(fast - exact).max() < 1e-9 * size) or size > 1e12


@settings(max_examples=60, deadline=None, derandomize=True)
@given(EXPRESSIONS)
def test_values_and_slopes_of_any_expression_are_exact(text: str) -> None:
    assert agrees(text, 0.37, -0.61)


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_slopes_of_each_function_are_exact(name: str) -> None:
    inner = "1.2 + u*v + u**2" if name in {"acosh", "log", "sqrt"} else "0.3 + u*v/4 - v"
    assert agrees(f"{name}({inner})", 0.2, 0.4)


@pytest.mark.parametrize(
    "text", ["u/v", "u**-2/(1+v)", "(1+u)**v", "2**(u*v)", "u**0.5*v", "+u - -v", "u**v**2"]
)
def test_quotients_and_powers_are_read_as_mathematics_has_them(text: str) -> None:
    assert agrees(text, 0.7, 0.9)


def test_whole_powers_have_their_slopes_at_zero_too() -> None:
    zero = np.zeros(1)
    assert parsed("u**2 + v**3 + u*v").series(zero, zero)[:, 0].tolist() == [0, 0, 0, 2, 1, 0]
    assert parsed("u**1 + v**0").series(zero, zero)[:, 0].tolist() == [1, 1, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('__import__("os").system("ls")', "no function of one value"),
        ("u.real", "'u.real' has no place"),
        ("(lambda: u)()", "no function of one value"),
        ("lambda: u", "no place"),
        ("u if v else 1", "no place"),
        ("u[0]", "no place"),
        ("[u]", "no place"),
        ("u < v", "no place"),
        ("u and v", "no place"),
        ("not u", "no place"),
        ("~u", "no place"),
        ("u % v", "no place"),
        ("u // v", "no place"),
        ("'u'", "no place"),
        ("True", "no place"),
        ("None", "no place"),
        ("1j", "no place"),
        ("f'{u}'", "no place"),
        ("(a := u)", "no place"),
        ("u^2", "write \\*\\* for a power"),
        ("w + 1", "'w' is unknown"),
        ("sin", "'sin' is unknown"),
        ("sin()", "no function of one value"),
        ("sin(u, v)", "no function of one value"),
        ("sin(x=u)", "no function of one value"),
        ("sin(*u)", "no place"),
        ("eval(u)", "no function of one value"),
        ("9**9**9**9", "no finite number"),
        ("10**400", "no finite number"),
        (f"1{'0' * 400}", "no finite number"),
        ("log(0)*u", "'log\\(0\\)' is no finite number"),
        ("1/0", "no finite number"),
        ("u +", "no expression"),
        ("u; v", "no expression"),
        ("u = 1", "no expression"),
        ("", "no expression"),
        ("\0", "no expression"),
        ("(" * 240 + "u" + ")" * 240, "no expression"),
        ("u" + "+u" * LONGEST, f"at most {LONGEST} characters"),
        ("-" * (DEEPEST + 1) + "u", f"more than {DEEPEST} operations"),
        ("u" + "+u" * (DEEPEST + 1), f"more than {DEEPEST} operations"),
    ],
)
def test_what_is_no_formula_is_refused_with_the_words_in_question(text: str, said: str) -> None:
    with pytest.raises(InvalidParameters, match=said):
        parsed(text)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.text(alphabet="uvpie0123456789.+-*/() sincoqrtlgx_[]'\",:=^%&|<>~@!\\\n", max_size=40))
def test_no_text_at_all_does_anything_but_be_read_or_refused(text: str) -> None:
    try:
        tree = parsed(text)
    except InvalidParameters:
        return
    with np.errstate(all="ignore"):
        assert tree.series(np.array([0.5]), np.array([0.25])).shape == (6, 1)


def test_a_range_is_a_number_that_may_be_written_as_a_formula() -> None:
    assert value("-pi/2.2") == pytest.approx(-np.pi / 2.2)
    assert surface(u_start=0, u_end=2.5).span("u") == (0.0, 2.5)
    with pytest.raises(InvalidParameters, match="u and v mean nothing"):
        value("2*u")


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"u_start": 1, "u_end": 1}, "u_end must be more than u_start"),
        ({"v_start": 1, "v_end": -1}, "v_end must be more than v_start"),
        ({"u_end": float("inf")}, "surface.u_end: 'inf' is unknown"),
        ({"u_end": float("nan")}, "surface.u_end: 'nan' is unknown"),
        ({"x": True}, "surface.x must be text"),
        ({"x": None}, "surface.x must be text"),
        ({"w": "u"}, "no surface.w to set; there are kind, x, y, z"),
        ({"kind": "teapot"}, "surface.kind must be one of .*'expression'.*, not 'teapot'"),
    ],
)
def test_values_without_sense_are_refused_by_their_name(values: Any, said: str) -> None:
    with pytest.raises(InvalidParameters, match=said):
        DESIGN.validate({"surface": {"kind": "expression", **values}})


def test_a_surface_needs_its_kind() -> None:
    with pytest.raises(InvalidParameters, match=r"surface\.kind is missing"):
        DESIGN.validate({"surface": {"x": "u"}})


HALF = {"v_start": "-pi/2", "v_end": "pi/2"}


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"x": "1", "y": "2", "z": "3"}, "is a single point"),
        ({"x": "u", "y": "2*u", "z": "u**2"}, "is a curve, not a surface"),
        ({"x": "u+v", "y": "(u+v)**2", "z": "1"}, "is a curve, not a surface"),
        ({**BALL, **HALF}, r"At u = 0, v = -1\.5708 the target shrinks to a point"),
        ({**BALL, "v_start": 0, "v_end": "pi/2"}, r"v = 1\.5708 the target shrinks"),
        ({"x": "v*cos(u)", "y": "v*sin(u)", "z": "v", **ROUND}, "v = 0 .*shrinks to a point"),
        ({"x": "u**3", "y": "v", "z": "0*u"}, "u = 0, v = -1 .*shrinks"),
        ({"x": "log(u)"}, "At u = -1, v = -1 the target's x .* no finite number"),
        ({"z": "sqrt(u - v)"}, "At u = -1, v = -1 the target's z .* no finite number"),
        ({"y": "1/(v - 0.3)"}, "v = 0.3 the target's y .* no finite number"),
        ({"x": "exp(800*u)"}, "the target's x .* no finite number"),
        ({**TUBE, "u_end": "6"}, "does not close along u"),
        ({**TUBE, "v_closes": True}, "does not close along v"),
        ({"u_closes": True}, "does not close along u"),
    ],
)
def test_what_is_no_surface_there_is_refused_before_solving_with_its_place(
    values: dict[str, Any], said: str
) -> None:
    with pytest.raises(ImpossibleGeometry, match=said):
        run(6, 4, **values)


def test_a_place_without_value_beyond_the_range_is_met_only_by_a_rim_outside() -> None:
    values = {"x": "u", "y": "v", "z": "sqrt(v)*v**2/4", "v_start": 0, "v_end": 1}
    asked = {"surface": {"kind": "expression", **values}, "n_u": 6, "n_v": 4, "start": "uniform"}
    with pytest.raises(ImpossibleGeometry, match="v = 0 the target's z"):
        DESIGN.run(asked)
    asked["surface"] = {"kind": "expression", **values, "z": "v**2.5/4", "v_start": 0.01}
    assert DESIGN.run(asked).meta["status"]["verdicts"] == ["ok"]
    with pytest.raises(ImpossibleGeometry, match=r"v = -0\.05.* the target's z"):
        DESIGN.run({**asked, "rim": "outside"})


@pytest.mark.parametrize("kind", ["sphere", "torus", "catenoid"])
def test_a_surface_of_the_table_written_as_expressions_is_the_same(kind: str) -> None:
    table = {
        "sphere": {**BALL, "v_start": "-pi/2.2", "v_end": "pi/2.2"},
        "torus": {**RING, "v_start": "-pi", "v_end": "pi", "v_closes": True},
        "catenoid": {
            "x": "cosh(v/2.5)*cos(u)",
            "y": "cosh(v/2.5)*sin(u)",
            "z": "v",
            **ROUND,
            "v_start": "-pi",
            "v_end": "pi",
        },
    }
    one, two = surface(**table[kind]).surface(), TABLE[kind]
    assert (one.is_revolution, one.is_v_periodic) == (True, two.is_v_periodic)
    assert one.is_outward
    asked = {"n_u": 12, "n_v": 6}
    mine = DESIGN.run({"surface": {"kind": "expression", **table[kind]}, **asked})
    theirs = DESIGN.run({"surface": {"kind": kind}, **asked})
    assert mine.meta["distance"]["mean"] == pytest.approx(theirs.meta["distance"]["mean"], rel=1e-9)
    assert np.ptp(mine.pattern.vertices, axis=0) == pytest.approx(
        np.ptp(theirs.pattern.vertices, axis=0), rel=1e-9
    )
    assert mine.symmetry is not None


def test_what_only_looks_like_a_revolution_is_not_taken_for_one() -> None:
    for values in (
        {**TUBE, "x": "1.1*cos(u)"},
        {**TUBE, "z": "v + 0.1*sin(u)"},
        {**TUBE, "x": "cos(u+v)", "y": "sin(u+v)"},
        {**TUBE, "u_end": "4*pi"},
        {**TUBE, "x": "2+cos(u)"},
    ):
        assert not surface(**values).surface().is_revolution


def test_pits_go_to_the_inner_side_whichever_way_the_target_is_written() -> None:
    for one, other in (("sin(u)", "v"), ("-sin(u)", "v"), ("sin(u)", "-v")):
        fold = run(8, 4, **{**TUBE, "y": one, "z": other})
        centres = np.flatnonzero(np.bincount(fold.pattern.faces.ravel()) == 6)
        radius = np.hypot(*fold.folded.vertices[:, :2].T)
        assert radius[centres].min() < 0.95 * radius.max()
        assert fold.meta["status"]["verdicts"] == ["ok"]


def test_a_target_comes_from_the_command_line_or_from_a_file(tmp_path: Path) -> None:
    words = ["--surface.kind", "expression", "--surface.x", "cos(u)", "--surface.y=sin(u)"]
    words += ["--surface.z", "v", "--surface.u_start", "0", "--surface.u_end", "2*pi"]
    words += ["--surface.u_closes", "true", "--n_u", "9"]
    said = gather(DESIGN, None, None, words)
    file = tmp_path / "tube.toml"
    file.write_text(
        'n_u = 9\n[surface]\nkind = "expression"\nx = "cos(u)"\ny = "sin(u)"\nz = "v"\n'
        'u_start = 0\nu_end = "2*pi"\nu_closes = true\n'
    )
    assert gather(DESIGN, None, file, []) == said
    again: Any = gather(DESIGN, "elbow", None, ["--surface.kind", "vase"])
    assert again.surface.kind == "vase"


@pytest.mark.parametrize(
    "name", ["helicoid", "monkey-saddle", "egg-crate", "twisted-tube", "elbow"]
)
def test_surfaces_of_our_own_fold_without_fault_and_near_to_their_target(name: str) -> None:
    meta = DESIGN.run(DESIGN.presets[name]).meta
    assert meta["status"]["verdicts"] == ["ok"]
    assert meta["convergence"]["iterations"] <= 10
    assert meta["status"]["e_total_deg"] <= 1e-10
    assert meta["distance"]["mean"] < 0.013
