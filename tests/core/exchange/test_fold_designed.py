"""What a family says of its result travels with the file, and a check tells whose word it is."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from foldmill.check import check
from foldmill.exchange import read, write
from foldmill_plugins.rotational import DESIGN

SAID = {"verdict": "ok", "distance_mean": 0.0123, "iterations": 4, "is_round": True}


def test_what_was_said_when_a_fold_was_made_is_told_by_a_check_of_its_file() -> None:
    plain = DESIGN.run()
    fold = replace(plain, meta={**plain.meta, "designed": SAID})
    text = write(fold)
    again = read(text)
    assert again.meta["designed"] == SAID
    assert write(again) == text
    told = {k: v for k, v in check(again).figures.items() if k.startswith("designed_")}
    assert told == {f"designed_{name}": value for name, value in SAID.items()}
    assert told == {k: v for k, v in check(fold).figures.items() if k in told}


def test_a_family_that_says_nothing_writes_nothing() -> None:
    plain = DESIGN.run()
    assert "foldmill:designed" not in json.loads(write(plain))
    assert not [k for k in check(plain).figures if k.startswith("designed")]


@pytest.mark.parametrize("strange", [["ok"], "ok", 3, {"verdict": ["ok"]}, {"verdict": None}])
def test_what_no_family_says_is_kept_as_it_is_and_not_believed(strange: Any) -> None:
    data = {**json.loads(write(DESIGN.run())), "foldmill:designed": strange}
    fold = read(json.dumps(data))
    assert "designed" not in fold.meta
    assert not [k for k in check(fold).figures if k.startswith("designed")]
    assert json.loads(write(fold))["foldmill:designed"] == strange
