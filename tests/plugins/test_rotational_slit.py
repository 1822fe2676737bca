"""Rotational forms with a slit, and the straps that close them, keep the contract of any design."""

from __future__ import annotations

from dataclasses import replace

import pytest

from foldmill.testing import Check, design_checks
from foldmill_plugins.rotational import DESIGN

SLIT = {name: preset.model_copy(update={"slit": True}) for name, preset in DESIGN.presets.items()}
STRAPS = {
    f"{name}-strap": preset.model_copy(update={"strap": 8.0}) for name, preset in SLIT.items()
}
CUT = replace(DESIGN, presets=SLIT | STRAPS)


@pytest.mark.parametrize(
    "check", [check for check in design_checks(CUT) if "[" in check.name], ids=str
)
def test_contract(check: Check) -> None:
    check()


@pytest.mark.parametrize("name", DESIGN.presets)
def test_a_slit_form_is_dragged_by_the_same_handles(name: str) -> None:
    whole, cut = DESIGN.run(DESIGN.presets[name]), DESIGN.run(SLIT[name])
    assert [handle.name for handle in cut.handles] == [handle.name for handle in whole.handles]
    for one, two in zip(whole.handles, cut.handles, strict=True):
        assert one.position == pytest.approx(two.position)
        dragged = two.drag(SLIT[name], two.position * 1.05)
        assert dragged.slit
        assert dragged.points == one.drag(DESIGN.presets[name], one.position * 1.05).points
