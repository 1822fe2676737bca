"""Whatever is wrong on a coupon is found and named before it is cut."""

from __future__ import annotations

import pytest
from coupons import coupon, declared
from fabricate.verify.corrupt_coupons import CORRUPTIONS

from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.verify import verify


@pytest.mark.long
@pytest.mark.parametrize("name", CORRUPTIONS)
def test_a_corrupted_coupon_is_named(name: str) -> None:
    change, code = CORRUPTIONS[name]
    fold, plan = coupon()
    wrong = change(plan)
    assert wrong != plan
    found = verify(wrong, fold.pattern, hpgl.write(wrong, fold))
    codes = [finding.code for finding in found.findings if finding.severity == "error"]
    assert code in codes, [str(finding) for finding in found.findings]


def test_a_fold_that_poses_as_a_coupon_is_refused() -> None:
    """A coupon's plan without its section is judged as a fold's: nothing on it belongs to one."""
    fold, plan = coupon()
    bare = plan.model_copy(update={"coupon": None})
    found = verify(bare, fold.pattern, hpgl.write(bare, fold))
    assert "no-such-line" in {finding.code for finding in found.findings}


def test_rows_of_cuts_that_stand_above_each_others_figures_are_an_error() -> None:
    fold, plan = coupon("paper-80-120", "generic-hpgl-pens", "perforation")
    [k] = [n for n, ladder in enumerate(declared(plan).ladders) if ladder.kind == "gap"]
    ladder = declared(plan).ladders[k]
    first, *rest = ladder.rungs
    swapped = [first.model_copy(update={"at": rest[-1].at}), *rest[:-1]]
    swapped.append(rest[-1].model_copy(update={"at": first.at}))
    ladders = list(declared(plan).ladders)
    ladders[k] = ladder.model_copy(update={"rungs": tuple(swapped)})
    wrong = plan.model_copy(
        update={"coupon": declared(plan).model_copy(update={"ladders": tuple(ladders)})}
    )
    programs = hpgl.write(plan, fold)
    assert verify(plan, fold.pattern, programs).ok
    assert not verify(wrong, fold.pattern, programs).ok
