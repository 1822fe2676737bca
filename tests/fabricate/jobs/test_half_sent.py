"""A machine that cannot drop half an instruction is not given the next one's bytes to end it by."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from fabricate.jobs.workshop import PATIENCE, Workshop, workshop

from foldmill_fabricate.jobs import Kind, Submission

pytestmark = pytest.mark.long

HALF = "Half an instruction may lie in the machine"


def loading(shop: Workshop) -> str:
    """Return the text of the question to load a sheet, once it is asked."""
    end = time.monotonic() + PATIENCE
    while not (found := [one.text for one in shop.at.questions() if one.kind is Kind.LOAD]):
        assert time.monotonic() < end, shop.log()
        time.sleep(0.02)
    return found[0]


def killed_after(shop: Workshop, count: int) -> None:
    """Let the service be killed when so many more bytes have reached the machine."""
    shop.left = count
    shop.attend(lambda: shop.is_dead)
    shop.rest()
    shop.cut_off = False


def test_who_loads_a_sheet_again_is_told_that_a_test_cut_was_broken_off(tmp_path: Path) -> None:
    with workshop(tmp_path, blind=True) as shop:
        shop.eager = True
        shop.start()
        assert HALF not in loading(shop)
        killed_after(shop, 40)
        assert not shop.at.store.ledger.sheet(shop.at.job(shop.job).sheets[-1]).is_begun
        shop.start()
        told = loading(shop)
        assert told.startswith(HALF)
        assert "switch the machine off and on before you answer.\nLoad a" in told


def test_who_loads_the_next_sheet_is_told_once_that_the_one_before_was_broken_off(
    tmp_path: Path,
) -> None:
    with workshop(tmp_path, blind=True) as shop:
        shop.start()
        killed_after(shop, 400)
        first = shop.at.job(shop.job)
        shop.at.cancel(shop.job)
        shop.job = shop.at.submit(Submission(plan=first.plan, plotter="bench")).id
        shop.start()
        assert loading(shop).startswith(HALF)
        ledger = shop.at.store.ledger
        shop.attend(lambda: any(ledger.sheet(one).is_begun for one in shop.at.job(shop.job).sheets))
        assert not [one for one in shop.at.questions() if HALF in one.text]
