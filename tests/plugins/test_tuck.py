"""Tucks: the blank beside a free point is folded away, or refused in a sentence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from domes import DOME

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import strip
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import DESIGN, blanks, corners

STOOL = DESIGN.preset("stool-n8").model_dump(mode="json")
FORMS = pytest.mark.parametrize("values", [STOOL, STOOL | {"tucks": []}, DOME])


def changed(tucks: list[dict[str, Any]] | None = None, **points: Any) -> dict[str, Any]:
    """Return the stool with other tucks (none: automatic) and other points ``p4=…``."""
    replaced = {name[1:]: point for name, point in points.items()}
    return STOOL | {"tucks": tucks or [], "points": STOOL["points"] | replaced}


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices


def tips(fold: Fold, t: float) -> np.ndarray:
    """Return the vertices at the tips of the tucks: t from the centre."""
    return np.flatnonzero(np.abs(np.hypot(*fold.pattern.vertices.T) - t) < 1e-5)


@FORMS
def test_every_tip_is_as_far_from_its_neighbours_as_in_the_pattern(values: dict[str, Any]) -> None:
    fold = DESIGN.run(values)
    for tuck in fold.meta["tucks"]:
        at = tips(fold, tuck["t"])
        assert len(at) == values["n"]
        creases = np.isin(fold.pattern.edges, at).any(axis=1)
        assert creases.sum() == 4 * values["n"]
        ends = space(fold)[fold.pattern.edges[creases]]
        lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        assert lengths == pytest.approx(fold.pattern.edge_lengths[creases], abs=1e-11)


@FORMS
def test_the_filled_sheet_is_one_disc_that_passes_through_nothing(values: dict[str, Any]) -> None:
    fold = DESIGN.run(values)
    pattern = fold.pattern
    assert len(pattern.vertices) - len(pattern.edges) + len(pattern.faces) == 1
    assert [len(loop) for loop in pattern.outline()] == [2 * values["n"]]
    assert len(penetrations(space(fold), pattern.edges, pattern.faces)) == 0
    assert "U" not in pattern.letters()


@FORMS
def test_the_form_maps_to_itself_when_turned_by_one_wedge(values: dict[str, Any]) -> None:
    fold, angle = DESIGN.run(values), 2 * np.pi / values["n"]
    cos, sin = np.cos(angle), np.sin(angle)
    points = space(fold)
    turned = points @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    gaps = np.linalg.norm(turned[:, None] - points[None], axis=2)
    assert gaps.min(axis=1).max() < 1e-10


def seams(fold: Fold) -> list[tuple[int, int, int]]:
    """Return (A, p, t) for every crease A-t that folds to ±180 and a neighbour p of both."""
    pattern = fold.pattern
    shut = np.flatnonzero(np.abs(pattern.fold_angles) == 180)
    degree = np.bincount(pattern.edges.ravel())
    out = []
    for edge in shut:
        a, t = pattern.edges[edge]
        a, t = (a, t) if degree[t] == 4 else (t, a)
        for face in pattern.faces[pattern.edge_faces[edge]]:
            (p,) = set(face.tolist()) - {int(a), int(t)}
            out.append((int(a), p, int(t)))
    return out


def face_beyond(fold: Fold, a: int, p: int, t: int) -> int:
    """Return the face on the other side of a-p from t."""
    pattern = fold.pattern
    at = [sorted(edge) == sorted((a, p)) for edge in pattern.edges.tolist()].index(True)
    left, right = pattern.edge_faces[at]
    return int(right) if t in pattern.faces[left] else int(left)


def unit(vector: np.ndarray) -> np.ndarray:
    out: np.ndarray = vector / np.linalg.norm(vector)
    return out


def normal(fold: Fold, face: int) -> np.ndarray:
    a, b, c = space(fold)[fold.pattern.faces[face]]
    return unit(np.cross(b - a, c - a))


def angle_of(fold: Fold, a: int, b: int) -> float:
    at = [sorted(edge) == sorted((a, b)) for edge in fold.pattern.edges.tolist()].index(True)
    return float(fold.pattern.fold_angles[at])


@FORMS
def test_the_three_creases_of_a_seam_turn_by_what_the_surface_turns(values: dict[str, Any]) -> None:
    fold = DESIGN.run(values)
    for a, p, t in seams(fold):
        (twin,) = {q for b, q, s in seams(fold) if (b, s) == (a, t)} - {p}
        along = unit(space(fold)[p] - space(fold)[a])
        one = normal(fold, face_beyond(fold, a, p, t))
        two = normal(fold, face_beyond(fold, a, twin, t))
        surface = np.degrees(np.arctan2(np.linalg.norm(np.cross(one, two)), one @ two))
        total = angle_of(fold, a, p) + angle_of(fold, a, twin) + angle_of(fold, a, t)
        assert abs(total) == pytest.approx(surface, abs=1e-9)
        # Which of the two faces lies left of a→p decides in which sense the surface turns.
        corners = fold.pattern.faces[face_beyond(fold, a, p, t)].tolist()
        left = corners[(corners.index(a) + 1) % 3] == p
        turn = np.cross(one, two) @ along * (1 if left else -1)
        assert np.sign(total) == -np.sign(turn)


@FORMS
def test_a_tuck_said_to_lie_inside_points_behind_the_front(values: dict[str, Any]) -> None:
    fold = DESIGN.run(values)
    points = space(fold)
    lies = {round(tuck["t"], 4): tuck["lies"] for tuck in fold.meta["tucks"]}
    for a, p, t in seams(fold):
        along = unit(points[p] - points[a])
        face = face_beyond(fold, a, p, t)
        (third,) = set(fold.pattern.faces[face].tolist()) - {a, p}
        (twin,) = {q for b, q, s in seams(fold) if (b, s) == (a, t)} - {p}
        other = face_beyond(fold, a, twin, t)
        (fourth,) = set(fold.pattern.faces[other].tolist()) - {a, twin}

        def across(k: int, along: np.ndarray = along, a: int = a) -> np.ndarray:
            step = points[k] - points[a]
            return unit(step - (step @ along) * along)

        front, into = normal(fold, face), across(third)

        def turn(
            k: int, front: np.ndarray = front, into: np.ndarray = into, see: Any = across
        ) -> float:
            """Angle from one face of the seam backwards, round the seam, to a point."""
            spot = see(k)
            return float(np.arctan2(-spot @ front, spot @ into)) % (2 * np.pi)

        inside = turn(t) < turn(fourth)
        t_flat = round(float(np.hypot(*fold.pattern.vertices[t])), 4)
        assert lies[t_flat] == ("inside" if inside else "outside")


def test_an_automatic_tuck_lies_in_the_middle_of_its_longest_free_run() -> None:
    values = changed()
    chosen = DESIGN.run(values).meta["tucks"][0]["t"]
    free = []
    for t in np.linspace(123, 236.5, 60):
        try:
            DESIGN.run(changed([{"point": 4, "t": float(t)}]))
        except ImpossibleGeometry:
            continue
        free.append(float(t))
    assert free[0] < chosen < free[-1]
    assert chosen == pytest.approx((free[0] + free[-1]) / 2, abs=5)


def test_tucks_may_lean_either_way() -> None:
    one, other = (DESIGN.run(changed([{"point": 4, "t": 189.2, "side": side}])) for side in (1, -1))
    assert one.pattern.letters().count("V") == other.pattern.letters().count("V")
    mirror = space(other) * [1, -1, 1]
    gaps = np.linalg.norm(mirror[:, None] - space(one)[None], axis=2)
    assert gaps.min(axis=1).max() < 1e-10
    assert np.linalg.norm(space(one)[tips(one, 189.2)] - space(other)[tips(other, 189.2)]) > 1


def test_a_stool_upside_down_is_the_same_stool() -> None:
    def upside_down(point: dict[str, Any]) -> dict[str, Any]:
        if "r" in point:
            return {"r": point["r"], "z": -point["z"]}
        gamma = point["gamma"]
        flipped = None if gamma is None else -gamma
        return {"a": point["a"], "branch": -point["branch"], "gamma": flipped}

    points = {name: upside_down(point) for name, point in STOOL["points"].items()}
    up, down = DESIGN.run(STOOL), DESIGN.run(STOOL | {"points": points})
    assert np.abs(space(down) - space(up) * [1, 1, -1]).max() < 1e-11
    assert down.pattern.letters() == up.pattern.letters()
    assert down.meta["tucks"] == up.meta["tucks"]


def test_without_a_free_point_it_is_a_plain_rotational_form() -> None:
    points = {i: {"a": a} for i, a in enumerate((40, 62, 92, 118), start=1)}
    fold = DESIGN.run({"n": 8, "phi": 80, "points": points})
    assert fold.meta["tucks"] == []
    assert fold.symmetry is not None
    assert len(fold.pattern.vertices) == 1 + 4 * 8


def test_wherever_the_gap_is_wide_enough_some_corner_reaches_all_three_points() -> None:
    rng, found = np.random.default_rng(4), 0
    for _ in range(400):
        r, z = rng.uniform(60, 120), rng.uniform(-120, -40)
        params = DESIGN.validate(changed(p4={"r": r, "z": z}))
        try:
            solved = strip.solve(params.n, params.phi, dict(params.points))
            (blank,) = blanks.find(solved)
        except (ImpossibleGeometry, InvalidParameters):
            continue
        middle = corners.place(blank, np.full((1, 1), 0.5), np.ones((1, 1)), [None])
        assert middle.exists[0]
        flat, tip = middle.t[0, 0] * blank.along, middle.spots[0, 0]
        for i in (2, 4, 6):
            wanted = np.linalg.norm(solved.flat[i] - flat)
            assert np.linalg.norm(solved.spatial[i] - tip) == pytest.approx(wanted, abs=1e-9)
        found += 1
    assert found > 50


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"n": "eight"}, "n must be a whole number"),
        (changed(p4={"r": 90}), r"points\.4\.z is missing"),
        (changed(p1={"r": 110, "z": 0}), "Point 1 lies on its line"),
        (changed(p8={"a": 300}), r"points: the points must be numbered 1, 2, 3"),
        (changed([{"point": 4}, {"point": 4}]), "Two tucks name the same point"),
        (changed([{"point": 5}]), "There is no blank beside point 5, so it needs no tuck"),
        (changed([{"point": 4, "t": -3}]), r"tucks\.0\.t must be more than 0"),
    ],
)
def test_parameters_that_contradict_each_other_are_refused(
    values: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InvalidParameters, match=sentence):
        DESIGN.run(values)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (changed(p4={"r": 44.9, "z": -15.9}), r"gap beside point 4 is too short: .*0\.82 mm too"),
        (
            changed([{"point": 4, "t": 125}]),
            r"penetrates the form at t = 125 mm; between 131\.\d* and 236\.\d* mm it is free",
        ),
        (
            changed(
                [{"point": 4, "t": 200}],
                p4={"r": 96.2, "z": -64},
                p5={"a": 297.2},
                p6={"a": 273.1, "branch": -1},
            ),
            "penetrates the form at t = 200 mm; no other t is free either, so move point 4",
        ),
    ],
)
def test_a_blank_that_cannot_be_tucked_is_refused(values: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ImpossibleGeometry, match=sentence):
        DESIGN.run(values)
