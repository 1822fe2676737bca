"""CFF2 drawings, judged by a reader of the test's own: records, types, sizes, nothing lost."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import hand_made
import numpy as np
import pytest
import stools
from fabricate.verify import knife_job
from hypothesis import given
from hypothesis import strategies as st

from foldmill import Assignment
from foldmill_fabricate.formats import cf2
from foldmill_fabricate.formats.drawing import drawings
from foldmill_fabricate.plan import make
from foldmill_fabricate.profiles import Profile, Style, find
from foldmill_fabricate.sheet import placed

if TYPE_CHECKING:
    from conftest import Golden

PLAN, FOLD = hand_made.plan(), hand_made.fold()
FILES = cf2.write(PLAN, FOLD)
Line = tuple[int, float, float, float, float]


def read(content: bytes) -> tuple[dict[str, str], list[Line]]:
    """Read a file strictly: its header by record, its lines with their types."""
    text = content.decode("ascii")
    assert text.endswith("\r\n")
    assert text.count("\r\n") == text.count("\n")
    records = text.split("\r\n")[:-1]
    assert records[:4] == ["$BOF", "V2", "ORDER", "END"]
    assert records[-2:] == ["END", "$EOF"]
    head: dict[str, str] = {}
    lines: list[Line] = []
    for record in records[4:-2]:
        name, *values = record.split(",")
        if name != "L":
            assert not lines, "the header comes first"
            head[name] = ",".join(values)
            continue
        weight, kind, aux, x, y, u, v, bridges, width = values
        assert (weight, aux, bridges, width) == ("2", "0", "0", "0")
        lines.append((int(kind), float(x), float(y), float(u), float(v)))
    assert list(head) == ["MAIN", "UM", "LL", "UR", "SCALE"]
    return head, lines


@pytest.mark.parametrize("face", ["front", "reverse"])
def test_every_line_is_there_once_with_its_type(face: str) -> None:
    head, lines = read(FILES[f"{face}.cf2"])
    assert (head["LL"], head["UR"], head["SCALE"]) == ("0,0", "100,80", "1,1")
    (view,) = [view for view in drawings(PLAN) if view.name == face]
    wanted = []
    for group in view.groups:
        kind = 2 if group.layer.name.startswith("SCORE") else 1
        for line in group.lines:
            wanted += [(kind, *a, *b) for a, b in pairwise(line.tolist())]
    assert np.array(lines) == pytest.approx(np.array(wanted), abs=5e-5)


def test_the_reverse_is_as_the_machine_sees_it_and_in_a_file_of_its_own() -> None:
    assert set(FILES) == {"front.cf2", "reverse.cf2"}
    _, lines = read(FILES["reverse.cf2"])
    (score,) = [line for line in lines if line[0] == 2]
    assert score[1:] == (40.0, 60.0, 40.0, 20.0)  # 100 - 60


def test_a_perforation_is_one_line_for_each_crease_and_reaches_over_all_its_dashes() -> None:
    fold = knife_job.fold()
    plan = make(fold, stools.material(), stools.machine("grbl-laser"), blank=(260.0, 240.0))
    _, lines = read(cf2.write(plan, fold)["reverse.cf2"])
    rows = np.array([line[1:] for line in lines if line[0] == 3]).reshape(-1, 2, 2)
    creases = fold.pattern.assignments != Assignment.B
    ends = placed(fold.pattern.vertices, plan.placement)[fold.pattern.edges[creases]]
    ends[:, :, 0] = 2 * plan.flip.axis - ends[:, :, 0]
    assert len(rows) == len(ends) == 4
    found = sorted(np.hypot(*(row[1] - row[0])) for row in rows)
    wanted = sorted(np.hypot(*(end[1] - end[0])) for end in ends)
    lands = np.array(wanted) - np.array(found)
    assert (lands > 0).all()
    assert (lands < 4.5).all()
    for row in rows:
        arms = ends - row[0]
        step = row[1] - row[0]
        off = np.abs(arms[..., 0] * step[1] - arms[..., 1] * step[0]).max(axis=1)
        assert off.min() / np.hypot(*step) < 1e-3


@given(
    st.lists(st.floats(0.5, 4), min_size=2, max_size=9),
    st.floats(0, 360),
    st.tuples(st.floats(0, 400), st.floats(0, 400)),
    st.randoms(use_true_random=False),
)
def test_dashes_in_any_order_and_direction_make_their_row(
    lengths: list[float], degrees: float, start: tuple[float, float], random: object
) -> None:
    along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    places, dashes = 0.0, []
    for length in lengths:
        dash = np.array(start) + np.outer([places, places + length], along)
        dashes.append(dash[:: random.choice((1, -1))])  # type: ignore[attr-defined]
        places += length + 1.0
    random.shuffle(dashes)  # type: ignore[attr-defined]
    (row,) = cf2.rows(dashes, 1.5)
    assert np.hypot(*(row[1] - row[0])) == pytest.approx(places - 1.0)
    assert len(cf2.rows(dashes, 0.5)) == len(dashes)


def test_types_are_the_profiles() -> None:
    layers = {"score_front": find().layers.score_front.model_copy(update={"cf2": 4})}
    changed = find().layers.model_copy(update=layers)
    profile: Profile = find().model_copy(update={"layers": changed})
    _, lines = read(cf2.write(PLAN, FOLD, Style(profile))["front.cf2"])
    assert {line[0] for line in lines} == {1, 4}


@pytest.mark.parametrize("name", FILES)
def test_drawings_are_as_they_were(name: str, golden: Golden) -> None:
    golden.check(f"hand-made/{name}", FILES[name])
