"""What must never be called well: hard targets, and input without sense, from the command line.

Each has its sentence and its exit code, and nothing is written unless it is forced.
"""

from __future__ import annotations

import json
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command import Run
from waterbomb_targets import BALL, HELICOID, NARROW, PLAIN, ROUND, flat

import foldmill
from foldmill.registry import load
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.build import Build

POINTS = [
    EntryPoint("waterbomb", "foldmill_plugins.waterbomb", "foldmill"),
    EntryPoint("fabricate", "foldmill_fabricate.builtin", "foldmill"),
]


class Typed:
    """Call ``foldmill design waterbomb`` in an empty folder."""

    def __init__(self, run: Run) -> None:
        self.run = run

    def __call__(self, *words: str) -> tuple[int, str]:
        told = self.run("design", "waterbomb", *words)
        assert "Traceback" not in told.err
        return told.code, told.out + told.err


@pytest.fixture
def typed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Typed:
    monkeypatch.chdir(tmp_path)
    registry = load(POINTS)
    monkeypatch.setattr(foldmill, "installed", lambda: registry)
    return Typed(Run(capsys, monkeypatch))


def words(**values: object) -> list[str]:
    """Return values as options; x, y, z and their ranges are those of an expression."""
    named = {
        name if name in DESIGN.params.model_fields or "." in name else f"surface.{name}": value
        for name, value in values.items()
    }
    return [word for name, value in named.items() for word in (f"--{name}", str(value))]


R = "(2 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))"
KLEIN = {
    "kind": "expression",
    "x": f"{R}*cos(u)",
    "y": f"{R}*sin(u)",
    "z": "sin(u/2)*sin(v) + cos(u/2)*sin(2*v)",
    "u_start": 0,
    "u_end": "2*pi",
    "v_start": 0,
    "v_end": "2*pi",
    "n_u": 40,
    "n_v": 12,
}
BUMP = {"kind": "expression", "x": "u", "y": "v", "z": "1.2*exp(-6*(u**2+v**2))"}
FLAT = {"kind": "expression", "x": "u", "y": "v", "z": "0"}


@pytest.mark.parametrize(
    ("values", "codes"),
    [
        (flat(NARROW), {"penetration"}),
        (flat(HELICOID), {"flat-overlap", "edges-cross", "outline"}),
        (KLEIN, {"penetration", "crease-sign"}),
        ({**KLEIN, **PLAIN}, {"penetration", "crease-sign"}),
        ({"kind": "torus", "n_u": 55, "n_v": 10, "depth": 0.2}, {"crease-sign"}),
    ],
)
def test_a_form_with_a_fault_is_written_only_by_force_and_then_marked(
    values: dict[str, Any], codes: set[str], typed: Typed
) -> None:
    code, said = typed(*words(**values), "-o", "form.fold")
    assert code == 1
    assert "nothing is written" in said
    assert list(Path().iterdir()) == []
    code, _ = typed(*words(**values), "-o", "form.fold", "--force")
    assert code == 1
    marked = json.loads(Path("form.fold").read_text())["foldmill:errors"]
    assert set(marked) == codes


@pytest.mark.parametrize(
    ("values", "said"),
    [
        # Targets that are legal and never come out well.
        ({**BUMP, "n_u": 16, "n_v": 16}, "No developable form was found: after 40 steps"),
        ({**BUMP, "n_u": 16, "n_v": 16}, "4.06 times as deep as their cells are high"),
        ({**BUMP, "n_u": 16, "n_v": 16, "start": "uniform"}, "No developable form was found"),
        # How many bases.
        ({"kind": "cylinder", "n_u": 1}, "a cylinder that closes along u needs at least 2 bases"),
        ({**BALL, "v_start": -1, "v_end": 1, "n_u": 1}, "needs at least 2 bases there"),
        ({"n_u": 0}, "n_u must be more than 0"),
        ({"n_v": -3}, "n_v must be more than 0"),
        ({"n_v": 2.5}, "n_v must be a whole number"),
        ({"n_u": 400, "n_v": 400}, "· n_v = 160000 bases are more than 100000"),
        # The range.
        ({**FLAT, "u_start": 1, "u_end": 1}, "u_end must be more than u_start"),
        ({**FLAT, "v_start": 2, "v_end": 1}, "v_end must be more than v_start"),
        ({**FLAT, "u_end": "1e999"}, "surface.u_end"),
        ({**FLAT, "u_end": "Infinity"}, "surface.u_end: 'inf' is unknown"),
        ({**FLAT, "u_end": "NaN"}, "surface.u_end: 'nan' is unknown"),
        ({**FLAT, "u_end": "2*v"}, "u and v mean nothing"),
        # The base mesh.
        ({"depth": 0}, "depth: centres must be at least 0.05 cells deep"),
        ({"depth": 1e-6}, "depth: centres must be at least 0.05 cells deep"),
        ({**FLAT, "depth": 0}, "depth: centres must be at least 0.05 cells deep"),
        ({"slide": 0.5}, "the two mids of a base meet"),
        ({"slide": 0.7}, "the two mids of a base meet"),
        ({"depth": 1.5}, "depth must be at most 1"),
        ({"kind": "moebius", "start": "closed-form"}, "closed-form needs a surface of revolution"),
        ({"kind": "teapot"}, "surface"),
        # Poles, tips, curves, points.
        ({**BALL, "v_start": "-pi/2", "v_end": "pi/2"}, "v = -1.5708 the target shrinks"),
        ({**BALL, "v_start": 0, "v_end": "pi/2", "rim": "outside"}, "the target shrinks"),
        ({**BALL, "x": "v*cos(u)", "y": "v*sin(u)", "z": "v"}, "v = 0 the target shrinks"),
        ({**FLAT, "x": "1", "y": "1"}, "The target is a single point"),
        ({**FLAT, "x": "u", "y": "u"}, "The target is a curve, not a surface"),
        ({**FLAT, "x": "u+v", "y": "u+v", "z": "(u+v)**2"}, "The target is a curve"),
        # Places without a value.
        ({**FLAT, "z": "log(u)"}, "At u = -1, v = -1 the target's z or one of its slopes"),
        ({**FLAT, "z": "sqrt(1-u**2-v**2)"}, "the target's z or one of its slopes is no finite"),
        ({**FLAT, "z": "1/u"}, "At u = 0, v = -1 the target's z"),
        # Borders that do not meet.
        ({**FLAT, "u_closes": "true"}, "does not close along u: its ends are 2 of its units apart"),
        ({**FLAT, "v_closes": "true"}, "does not close along v"),
        ({**BALL, "v_start": -1, "v_end": 1, "u_end": 6.28}, "does not close along u"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence_and_writes_nothing_even_by_force(
    values: dict[str, Any], said: str, typed: Typed
) -> None:
    code, told = typed(*words(**values), "-o", "form.fold", "--force")
    assert code == 2
    assert said in told
    assert list(Path().iterdir()) == []


def test_a_closed_torus_has_one_redundant_row_and_still_comes_out_exactly() -> None:
    params = DESIGN.presets["torus"]
    build = Build(params)
    _, jacobian = build.stars.linearised(build.base)
    assert np.abs(np.asarray(jacobian.sum(axis=0))).max() < 1e-12
    fold = DESIGN.run(params)
    assert fold.folded is not None
    a, b = fold.pattern.edges.T
    flat = np.linalg.norm(fold.pattern.vertices[a] - fold.pattern.vertices[b], axis=1)
    space = np.linalg.norm(fold.folded.vertices[a] - fold.folded.vertices[b], axis=1)
    assert np.abs(flat / space - 1).max() < 1e-9
    assert fold.meta["status"]["verdicts"] == ["ok"]


def test_a_torus_with_an_odd_number_of_strips_is_left_open_and_comes_out_well(typed: Typed) -> None:
    ring = {"kind": "expression", "x": "(3+cos(v))*cos(u)", "y": "(3+cos(v))*sin(u)", **ROUND}
    ring |= {"z": "sin(v)", "v_start": "-pi", "v_end": "pi", "v_closes": "true"}
    code, _ = typed(*words(**ring, n_u=55, n_v=9), "-o", "form.fold")
    assert code == 0
    assert Path("form.fold").exists()


def test_bases_deeper_than_their_cells_are_high_are_warned_of(typed: Typed) -> None:
    narrow = {**FLAT, "v_start": 0, "v_end": 0.5, "z": "0.1*u**2", "n_u": 4, "n_v": 12}
    code, told = typed(*words(**narrow, depth=1), "-o", "form.fold")
    assert "times as deep as their cells are high" in told
    assert "passes through itself" in told
    assert code == 1
    assert not Path("form.fold").exists()


def test_a_flat_target_folds_as_deep_as_it_is_told() -> None:
    fold = DESIGN.run({"surface": {**FLAT}, "n_u": 5, "n_v": 5, "depth": 0.3})
    assert fold.meta["status"]["verdicts"] == ["ok"]
    angles = np.abs(fold.pattern.fold_angles)
    assert angles[angles > 0].min() > 15


@pytest.mark.parametrize(("n_u", "n_v", "inner"), [(1, 1, 1), (3, 1, 3)])
def test_very_few_bases_are_no_fault(n_u: int, n_v: int, inner: int) -> None:
    fold = DESIGN.run({"surface": {**FLAT, "z": "u*v/4"}, "n_u": n_u, "n_v": n_v})
    assert fold.meta["status"]["verdicts"] == ["ok"]
    uses = np.bincount(fold.pattern.faces.ravel())
    assert np.count_nonzero(uses == 6) == inner
