from __future__ import annotations

import csv as csv_reader
import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from foldmill import Design, Fold, FoldmillError, Outcome, Outcomes
from foldmill.batch import Column
from foldmill.configurations import one_by_one, with_values
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


def lethal(params: RotationalParams) -> Fold:
    """End its process from outside, as an operating system without memory does."""
    import os

    if params.phi == 80:
        os.kill(os.getpid(), 9)
    return BOWL.generate(params)


def test_a_process_that_is_killed_ends_the_sweep_with_a_sentence_and_keeps_what_is_done(
    tmp_path: Path,
) -> None:
    asked = ranges("phi=30:110:1")
    deadly = replace(BOWL, generate=lethal)
    base = BOWL.preset("bowl-n8")
    with pytest.raises(EngineFailed, match="was ended from outside"):
        explore(deadly, base, asked, Local(2), resume=tmp_path)
    again = explore(BOWL, base, asked, SERIAL, resume=tmp_path)
    assert csv(again) == csv(explore(BOWL, base, asked, SERIAL))


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


def test_a_chunk_that_is_not_whole_is_computed_again(tmp_path: Path) -> None:
    asked, base = ranges("phi=60:100:1"), BOWL.preset("bowl-n8")
    sweep = explore(BOWL, base, asked, SERIAL, resume=tmp_path)
    files = sorted(tmp_path.rglob("*.npz"))
    assert len(files) == 3
    files[0].write_bytes(files[0].read_bytes()[:100])
    files[1].write_bytes(b"")
    assert csv(explore(BOWL, base, asked, SERIAL, resume=tmp_path)) == csv(sweep)


def test_another_sweep_has_another_key() -> None:
    base = BOWL.preset("bowl-n8")
    tasks = [
        Task(BOWL, base, grid(BOWL, base, ranges("phi=60:100:1"))),
        Task(BOWL, base, grid(BOWL, base, ranges("phi=60:100:2"))),
        Task(BOWL, BOWL.preset("crown-n6"), grid(BOWL, base, ranges("phi=60:100:1"))),
        Task(replace(BOWL, version="2"), base, grid(BOWL, base, ranges("phi=60:100:1"))),
    ]
    assert len({key(task) for task in tasks}) == 4
