"""The search finds forms that measure what was asked, fold freely, and are nobody's preset."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import BytesIO, StringIO

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from foldmill import Fold
from foldmill.check import check
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.explore.search import Outcome, Request, Target, contents, search
from foldmill_fabricate.explore.search.fit import Room, require_place
from foldmill_plugins import six_crease, tuck
from foldmill_plugins.rotational import DESIGN

SHEET = Room(300, 300, 1)
BOWL = Request(
    (Target.read("height=80"), Target.read("width=150±2%")), SHEET, 4.5, results=3, evaluations=250
)


@pytest.fixture(scope="module")
def found() -> Outcome:
    return search(DESIGN, BOWL)


def test_a_bowl_of_a_given_height_and_width_is_found(found: Outcome) -> None:
    assert not found.results[0].missed
    form = found.results[0].fold.folded
    assert form is not None
    x, y, z = np.ptp(form.vertices, axis=0)
    assert z == pytest.approx(80, abs=0.8)
    assert max(x, y) == pytest.approx(150, abs=3)


def test_every_form_folds_freely_on_the_sheet(found: Outcome) -> None:
    for each in found.results:
        assert not check(each.fold).has_errors
        require_place(each.fold.pattern.vertices, SHEET)
        assert each.fold.pattern.edge_lengths.min() >= 4.5


def test_no_form_is_another_or_a_preset(found: Outcome) -> None:
    folds = [each.fold for each in found.results] + [DESIGN.run(p) for p in DESIGN.presets.values()]
    for k, one in enumerate(folds[: len(found.results)]):
        for other in folds[k + 1 :]:
            if one.pattern.vertices.shape == other.pattern.vertices.shape:
                gaps = np.linalg.norm(one.pattern.vertices - other.pattern.vertices, axis=1)
                heights = _heights(one) - _heights(other)
                assert np.sort(np.maximum(gaps, np.abs(heights)))[-3] > 0.005 * one.pattern.size


def _heights(fold: Fold) -> NDArray[np.float64]:
    assert fold.folded is not None
    z: NDArray[np.float64] = fold.folded.vertices[:, 2] - fold.folded.vertices[:, 2].min()
    return z


def test_the_best_comes_first(found: Outcome) -> None:
    missed = [len(each.missed) > 0 for each in found.results]
    assert missed == sorted(missed)


def test_the_files_hold_what_was_found(found: Outcome) -> None:
    files = contents(found, BOWL, "rotational")
    ranks = range(1, len(found.results) + 1)
    assert set(files) == {f"{k}.fold" for k in ranks} | {
        "results.csv",
        "results.json",
        "results.png",
    }
    rows = list(csv.DictReader(StringIO(files["results.csv"].decode())))
    for row, rank in zip(rows, ranks, strict=True):
        read = fold_file.read(files[f"{rank}.fold"].decode())
        assert read.folded is not None
        height = float(np.ptp(read.folded.vertices[:, 2]))
        assert float(row["height_mm"]) == pytest.approx(height, abs=1e-3)
    picture = np.asarray(Image.open(BytesIO(files["results.png"])).convert("L"))
    assert (picture < 128).mean() > 0.01


def test_the_same_seed_finds_the_same_on_one_core_and_on_two() -> None:
    few = replace(BOWL, presets=("bowl-n8",), results=1, evaluations=60, seed=3)
    one, two = (search(DESIGN, few, jobs=jobs) for jobs in (1, 2))
    assert contents(one, few, "rotational") == contents(two, few, "rotational")


def test_another_seed_finds_other_forms() -> None:
    few = replace(BOWL, presets=("bowl-n8",), results=1, evaluations=60)
    one, two = (search(DESIGN, replace(few, seed=seed)) for seed in (3, 4))
    assert one.results[0].params != two.results[0].params


def test_a_search_that_runs_out_of_time_says_so(found: Outcome) -> None:
    few = Request(BOWL.targets, SHEET, 4.5, results=1, evaluations=60)
    stopped = search(DESIGN, few, seconds=1e-9)
    assert stopped.stopped
    assert not found.stopped
    assert stopped.evaluations < found.evaluations


def test_a_stool_of_another_size_is_found_from_the_one_there_is() -> None:
    wanted = Request(
        (Target.read("height=170±2%"), Target.read("seat=210±2%")),
        Room(560, 560, 1),
        4.5,
        presets=("stool-n8",),
        results=1,
        evaluations=150,
    )
    best = search(tuck.DESIGN, wanted).results[0]
    assert not best.missed
    assert best.fold.meta["tucks"]


def test_what_no_sheet_allows_is_missed_and_the_nearest_is_handed_back() -> None:
    tall = Request(
        (Target.read("height=200"),),
        Room(210, 210, 1),
        4.5,
        results=1,
        evaluations=60,
        presets=("ball",),
    )
    best = search(six_crease.DESIGN, tall).results[0]
    assert [target.name for target in best.missed] == ["height"]
    assert best.figures["height"] < 198
    assert best.figures["sheet_x"] <= 210
