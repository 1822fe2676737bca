"""The built-in families keep the contract that any plugin keeps."""

from __future__ import annotations

import pytest

from foldmill.testing import Check, design_checks
from foldmill_plugins import rotational, six_crease, tuck, waterbomb


@pytest.mark.parametrize("check", design_checks(rotational.DESIGN), ids=str)
def test_rotational(check: Check) -> None:
    check()


@pytest.mark.parametrize("check", design_checks(tuck.DESIGN), ids=str)
def test_tuck(check: Check) -> None:
    check()


@pytest.mark.parametrize("check", design_checks(six_crease.DESIGN), ids=str)
def test_six_crease(check: Check) -> None:
    check()


@pytest.mark.long
@pytest.mark.parametrize("check", design_checks(waterbomb.DESIGN), ids=str)
def test_waterbomb(check: Check) -> None:
    check()
