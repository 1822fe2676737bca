"""The contract finds a batch that says something else than generate and check."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from foldmill import Design, Outcome, Outcomes
from foldmill.agreement import faults
from foldmill.batch import Column
from foldmill.configurations import one_by_one
from foldmill.testing import design_checks
from foldmill_plugins.rotational import DESIGN as BOWL
from foldmill_plugins.tuck import DESIGN as STOOL

Columns = Mapping[str, Column]
PLAIN: Design[Any] = replace(BOWL, batch=None, presets={})


def honest(base: Any, columns: Columns) -> Outcomes:
    return one_by_one(PLAIN, base, columns)


def hopeful(base: Any, columns: Columns) -> Outcomes:
    true = honest(base, columns)
    return replace(true, codes=np.full_like(true.codes, Outcome.FREE))


def too_tall(base: Any, columns: Columns) -> Outcomes:
    true = honest(base, columns)
    return replace(true, figures={**true.figures, "height_mm": true.figures["height_mm"] + 1e-6})


def pointing(base: Any, columns: Columns) -> Outcomes:
    true = honest(base, columns)
    return replace(true, at=true.at + 4)


def short(base: Any, columns: Columns) -> Outcomes:
    return honest(base, {name: column[1:] for name, column in columns.items()})


def careless(base: Any, columns: Columns) -> Outcomes:
    return honest(
        base, {name: each for name, each in columns.items() if name != "no-such-parameter"}
    )


@pytest.mark.parametrize(
    ("batch", "said"),
    [
        (hopeful, r"With .* = .* the batch says FREE, generate and check say (REFUSED|PENETRATES)"),
        (too_tall, r"the batch says height_mm = [0-9.]+, generate says [0-9.]+\.$"),
        (pointing, "the batch names point 3, generate names point -1"),
        (short, r"it returns outcomes of shape \(3,\) for 4 rows"),
        (careless, "It takes a column of a parameter that does not exist"),
    ],
)
def test_a_batch_that_errs_is_found(batch: Callable[..., Outcomes], said: str) -> None:
    (check,) = (each for each in design_checks(replace(PLAIN, batch=batch)) if "batch" in each.name)
    assert check.name == "batch-agrees[defaults]"
    with pytest.raises(AssertionError, match=said):
        check()


def test_an_honest_batch_has_no_faults() -> None:
    assert not list(faults(replace(PLAIN, batch=honest), PLAIN.params(), "any"))


def test_the_sample_holds_forms_that_fold_and_values_that_are_refused() -> None:
    seen: list[int] = []

    def watching(base: Any, columns: Columns) -> Outcomes:
        found = honest(base, columns)
        seen.extend(found.codes.tolist())
        return found

    assert not list(faults(replace(PLAIN, batch=watching), PLAIN.params(), "defaults"))
    assert {Outcome.FREE, Outcome.REFUSED} <= set(seen)


def test_a_design_without_a_batch_has_no_such_check() -> None:
    assert STOOL.batch is None
    assert not [check for check in design_checks(STOOL) if "batch" in check.name]
