from __future__ import annotations

import csv as csv_reader
import gc
import io
import sys
from collections.abc import Mapping
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from math import cos, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill import Design, Fold, FoldmillError, Outcome, Outcomes
from foldmill.axisymmetric.points import LinePoint
from foldmill.batch import Column
from foldmill.configurations import one_by_one, with_values
from foldmill.errors import BrokenBatch
from foldmill_fabricate.errors import EngineFailed
from foldmill_fabricate.explore import Local, Range, csv, explore, summary
from foldmill_fabricate.explore.chunk import FAULT, Task, compute
from foldmill_fabricate.explore.grid import grid
from foldmill_fabricate.explore.store import Store, key
from foldmill_plugins import rotational
from foldmill_plugins.rotational import RotationalParams
from foldmill_plugins.six_crease import DESIGN as TUBE

BOWL = replace(rotational.DESIGN, batch=None)
"""A family whose rows are generated and checked one by one."""
SERIAL = Local(1)
RUGBY = TUBE.preset("rugby")
UPRIGHT = RotationalParams(
    n=8,
    points={
        i: LinePoint(a=a, gamma=gamma)
        for i, (a, gamma) in enumerate(
            [(110, None), (110 / cos(pi / 8), None), (172.48, -108.2), (200, None)], start=1
        )
    },
)
"""Its point 2 stands square over point 1, so that rows about it are generated one by one."""


def ranges(*texts: str) -> list[Range]:
    return [Range.read(text) for text in texts]


def test_each_row_is_what_generating_and_checking_it_says() -> None:
    asked = ranges("beta=300:360:12", "L=10:30:4")
    sweep = explore(TUBE, RUGBY, asked, SERIAL)
    columns = {
        "beta": np.repeat(asked[0].values, len(asked[1].values)),
        "L": np.tile(asked[1].values, len(asked[0].values)),
    }
    alone = one_by_one(TUBE, RUGBY, columns)
    assert np.array_equal(sweep.outcomes.codes, alone.codes)
    assert np.array_equal(sweep.outcomes.at, alone.at)
    for name, column in alone.figures.items():
        np.testing.assert_allclose(sweep.outcomes.figures[name], column, atol=1e-6)
    assert sum(sweep.counts.values()) == len(sweep) == 36
    assert np.array_equal(sweep.labels > 0, sweep.outcomes.codes == Outcome.FREE)


def test_processes_of_this_machine_give_the_bytes_that_one_gives() -> None:
    asked = ranges("phi=60:100:5", "points.4.a=95,100")
    base = BOWL.preset("bowl-n8")
    assert csv(explore(BOWL, base, asked, Local(2))) == csv(explore(BOWL, base, asked, SERIAL))


def test_the_table_says_of_each_row_what_the_sweep_knows() -> None:
    sweep = explore(TUBE, RUGBY, ranges("beta=300:360:12", "L=10:30:4"), SERIAL)
    lines = list(csv_reader.DictReader(io.StringIO(csv(sweep).decode())))
    assert [int(line["row"]) for line in lines] == list(range(len(sweep)))
    assert [int(line["region"]) for line in lines] == sweep.labels.tolist()
    for row, line in enumerate(lines):
        assert {name: float(line[name]) for name in ("beta", "L")} == sweep.grid.values(row)
        height = sweep.outcomes.figures["height_mm"][row]
        assert line["height_mm"] == ("" if np.isnan(height) else repr(float(height)))
        at = int(sweep.outcomes.at[row])
        assert (line["outcome"] == "no-candidate") == (line["point"] != "")
        assert line["point"] == ("" if at < 0 else str(at))


def test_parquet_says_the_same_as_csv() -> None:
    pytest.importorskip("pyarrow")
    from pyarrow import parquet as reader

    from foldmill_fabricate.explore import parquet

    sweep = explore(TUBE, RUGBY, ranges("beta=300:360:12", "L=10:30:4"), SERIAL)
    content = parquet(sweep)
    assert content == parquet(sweep)
    read = reader.read_table(io.BytesIO(content))
    lines = list(csv_reader.DictReader(io.StringIO(csv(sweep).decode())))
    assert read.column_names == list(lines[0])
    for name in read.column_names:
        told = read.column(name).to_pylist()
        if name == "outcome":
            assert told == [line[name] for line in lines]
        else:
            assert told == [float(line[name]) if line[name] else None for line in lines]


def test_a_form_that_is_free_all_round_the_start_of_an_angle_is_one_region() -> None:
    ball = with_values(TUBE, TUBE.preset("ball"), {"L": 60.0})
    sweep = explore(TUBE, ball, ranges("beta=0:356:4"), SERIAL)
    number = sweep.labels[0]
    assert number == sweep.labels[-1] > 0
    assert sweep.joined == (True,)
    low, high = sweep.regions[number - 1].ranges["beta"]
    assert 180 < low < 356
    assert high >= 360


def test_an_angle_that_ends_at_its_bounds_does_not_go_round() -> None:
    sweep = explore(BOWL, BOWL.preset("bowl-n8"), ranges("phi=0:350:10"), SERIAL)
    assert sweep.joined == (False,)
    assert sweep.counts["refused"] == 17


def test_a_pick_is_the_fold_of_its_row_and_a_row_without_form_is_told_by_its_values() -> None:
    sweep = explore(TUBE, RUGBY, ranges("beta=0:350:10"), SERIAL)
    fold = sweep.fold(sweep.regions[0].centre)
    beta = sweep.grid.values(sweep.regions[0].centre)["beta"]
    assert fold.meta["design"]["params"]["beta"] == beta
    lost = int(np.flatnonzero(sweep.outcomes.codes == Outcome.NO_CANDIDATE)[0])
    told = rf"Row {lost} \(beta = {lost * 10} deg\) has no form: Point \d"
    with pytest.raises(FoldmillError, match=told):
        sweep.fold(lost)
    with pytest.raises(FoldmillError, match="There is no row 36: the rows are 0 to 35"):
        sweep.fold(36)


def brittle(params: RotationalParams) -> Fold:
    """Break down at one angle, as a family with a fault in it does."""
    if params.phi == 80:
        return [][0]
    return BOWL.generate(params)


def test_a_row_that_breaks_its_family_is_told_and_no_other_row_is_lost() -> None:
    broken = replace(BOWL, generate=brittle)
    asked = ranges("phi=60:100:2.5")
    told = explore(broken, BOWL.preset("bowl-n8"), asked, Local(2))
    sound = explore(BOWL, BOWL.preset("bowl-n8"), asked, SERIAL)
    at = asked[0].values.index(80)
    assert list(told.faults) == [at]
    assert "IndexError" in told.faults[at]
    assert told.outcomes.codes[at] == FAULT
    others = np.arange(len(told)) != at
    assert np.array_equal(told.outcomes.codes[others], sound.outcomes.codes[others])
    assert summary(told)["faults"][0]["at"] == "phi = 80 deg"
    assert told.counts["fault"] == 1


def brittle_batch(base: RotationalParams, columns: Mapping[str, Column]) -> Outcomes:
    if (columns["phi"] == 80).any():
        raise ZeroDivisionError("80")
    return one_by_one(BOWL, base, columns)


def test_a_batch_that_breaks_down_at_one_row_gives_all_the_others() -> None:
    broken = replace(BOWL, batch=brittle_batch)
    sweep = explore(broken, BOWL.preset("bowl-n8"), ranges("phi=60:100:2.5"), SERIAL)
    assert list(sweep.faults) == [8]
    assert sweep.counts["fault"] == 1
    assert sweep.outcomes.figures["height_mm"][8] != sweep.outcomes.figures["height_mm"][8]


def nameless_batch(base: RotationalParams, columns: Mapping[str, Column]) -> Outcomes:
    found = one_by_one(BOWL, base, columns)
    return replace(found, codes=np.where(columns["phi"] == 80, 77, found.codes).astype(np.uint8))


@pytest.mark.parametrize("engine", [SERIAL, Local(2)])
def test_a_batch_whose_answers_mean_nothing_ends_the_sweep_with_a_sentence(engine: Local) -> None:
    broken = replace(BOWL, batch=nameless_batch)
    with pytest.raises(BrokenBatch, match=r"'rotational' is broken: it gives row \d the code 77"):
        explore(broken, BOWL.preset("bowl-n8"), ranges("phi=60:100:2.5"), engine)


def lethal(danger: Path, params: RotationalParams) -> Fold:
    """End its process from outside, as an operating system does while memory is scarce."""
    import os

    if params.phi == 80 and danger.exists():
        os.kill(os.getpid(), 9)
    return BOWL.generate(params)


def test_a_process_that_is_killed_ends_the_sweep_with_a_sentence_and_keeps_what_is_done(
    tmp_path: Path,
) -> None:
    asked, danger = ranges("phi=48:80:1"), tmp_path / "danger"
    danger.touch()

    def generate(params: RotationalParams) -> Fold:
        return lethal(danger, params)

    deadly, base, kept = replace(BOWL, generate=generate), BOWL.preset("bowl-n8"), tmp_path / "kept"
    with pytest.raises(EngineFailed, match="was ended from outside"):
        explore(deadly, base, asked, Local(2), resume=kept)
    danger.unlink()
    done: list[int] = []
    again = explore(
        deadly, base, asked, SERIAL, resume=kept, progress=lambda now, rows: done.append(now)
    )
    assert done[0] >= 16
    assert csv(again) == csv(explore(BOWL, base, asked, SERIAL))


def stop(done: int, _: int) -> None:
    """Break a sweep off, as Ctrl-C does, when its first chunk has come back."""
    if done:
        raise KeyboardInterrupt


def test_what_was_done_when_a_sweep_is_broken_off_is_kept_and_it_is_said_where(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    asked, base = ranges("phi=30:75:1"), BOWL.preset("bowl-n8")
    said = rf"Broken off\. \d of 3 chunks were done; .* They are kept in {tmp_path}.*goes on there"
    with pytest.raises(KeyboardInterrupt, match=said):
        explore(BOWL, base, asked, Local(2), resume=tmp_path, progress=stop)
    gc.collect()
    assert not [str(each.message) for each in recwarn]
    told: list[int] = []
    explore(BOWL, base, asked, SERIAL, resume=tmp_path, progress=lambda done, _: told.append(done))
    assert told[0] >= 16


def counted(calls: list[int], design: Design[Any]) -> Design[Any]:
    def generate(params: Any) -> Fold:
        calls.append(1)
        return design.generate(params)

    return replace(design, generate=generate)


def test_a_sweep_goes_on_where_it_was_broken_off(tmp_path: Path) -> None:
    calls: list[int] = []
    asked, base = ranges("phi=60:100:1"), BOWL.preset("bowl-n8")
    design = counted(calls, BOWL)
    task = Task(design, base, grid(design, base, asked))
    assert task.chunks == 3
    Store(tmp_path, task).save(compute(task, 1))
    assert len(calls) == 16
    done: list[int] = []
    sweep = explore(
        design, base, asked, SERIAL, resume=tmp_path, progress=lambda now, rows: done.append(now)
    )
    assert len(calls) == 41
    assert done == [16, 32, 41]
    assert csv(sweep) == csv(explore(BOWL, base, asked, SERIAL))
    assert csv(explore(design, base, asked, SERIAL, resume=tmp_path)) == csv(sweep)
    assert len(calls) == 41


@pytest.mark.parametrize(
    ("base", "asked", "most"),
    [
        (BOWL.preset("bowl-n8"), ("phi=20:90:0.05", "n=4:12:1"), 1_000_000),
        (with_values(BOWL, BOWL.preset("bowl-n8"), {"slit": 1}), ("phi=20:90:0.05",), 16),
        (with_values(BOWL, UPRIGHT, {"phi": 60}), ("phi=20:90:0.01",), 16),
        (RUGBY, ("beta=0:359:1", "L=0:30:0.5"), 1_000_000),
        (with_values(TUBE, RUGBY, {"tab": 3}), ("beta=0:359:1", "L=0:30:0.5"), 64),
    ],
)
def test_what_a_batch_leaves_to_one_by_one_is_cut_as_small_as_without_a_batch(
    base: Any, asked: tuple[str, ...], most: int
) -> None:
    design = TUBE if isinstance(base, type(RUGBY)) else rotational.DESIGN
    task = Task(design, base, grid(design, base, ranges(*asked)))
    assert task.chunk_rows <= most
    assert task.is_short == (most > 1000)
    assert task.is_short or task.chunks > 80


def test_a_chunk_that_is_not_whole_is_computed_again(tmp_path: Path) -> None:
    asked, base = ranges("phi=60:100:1"), BOWL.preset("bowl-n8")
    sweep = explore(BOWL, base, asked, SERIAL, resume=tmp_path)
    files = sorted(file for file in tmp_path.rglob("*") if file.is_file())
    assert len(files) == 3
    files[0].write_bytes(files[0].read_bytes()[:100])
    files[1].write_bytes(b"")
    assert csv(explore(BOWL, base, asked, SERIAL, resume=tmp_path)) == csv(sweep)


def test_a_chunk_of_which_one_bit_has_flipped_is_not_believed(tmp_path: Path) -> None:
    asked, base = ranges("phi=60:75:1"), BOWL.preset("bowl-n8")
    task = Task(BOWL, base, grid(BOWL, base, asked))
    store, chunk = Store(tmp_path, task), compute(task, 0)
    store.save(chunk)
    (file,) = (file for file in tmp_path.rglob("*") if file.is_file())
    whole = file.read_bytes()
    rng = np.random.default_rng(4)
    for place in rng.integers(0, len(whole), 300).tolist():
        flipped = bytearray(whole)
        flipped[place] ^= 1 << int(rng.integers(8))
        file.write_bytes(flipped)
        assert store.load(0) is None
    file.write_bytes(whole)
    kept = store.load(0)
    assert kept is not None
    assert np.array_equal(kept.codes, chunk.codes)


def test_another_sweep_has_another_key() -> None:
    base = BOWL.preset("bowl-n8")
    tasks = [
        Task(BOWL, base, grid(BOWL, base, ranges("phi=60:100:1"))),
        Task(BOWL, base, grid(BOWL, base, ranges("phi=60:100:2"))),
        Task(BOWL, BOWL.preset("crown-n6"), grid(BOWL, base, ranges("phi=60:100:1"))),
        Task(replace(BOWL, version="2"), base, grid(BOWL, base, ranges("phi=60:100:1"))),
    ]
    assert len({key(task) for task in tasks}) == 4


def test_a_family_whose_code_has_changed_is_another_sweep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = "from foldmill_plugins.rotational import DESIGN, generate as old\n\n\n"
    code += "def generate(params):\n    return old(params)\n"
    home = tmp_path / "homemade.py"
    home.write_text(code)
    spec = spec_from_file_location("homemade", home)
    assert spec is not None
    assert spec.loader is not None
    made = module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "homemade", made)
    spec.loader.exec_module(made)
    base = BOWL.preset("bowl-n8")
    design = replace(BOWL, generate=made.generate)
    task = Task(design, base, grid(design, base, ranges("phi=60:100:1")))
    before = key(task)
    assert key(task) == before
    home.write_text(code.replace("old(params)", "old(params)  # and more"))
    assert key(task) != before
    home.write_text(code)
    assert key(task) == before
