"""Narrow facets, thin strips between cuts, short sides, and blades that hardly go through."""

from __future__ import annotations

import numpy as np
import pytest
import stools

from foldmill import CreasePattern, Fold
from foldmill.finding import Finding, Severity
from foldmill_fabricate import presets, shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, ScoreAndSnap
from foldmill_fabricate.pictures.places import places
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.narrow import width_of

MATERIALS = list(presets.shipped(Material, "foldmill_fabricate.materials"))


def strip(between: float) -> Fold:
    """A sheet of 120 × 80 mm with a mountain and a valley side by side in its middle."""
    x, y = 60 - between / 2, 60 + between / 2
    spots = [(0, 0), (x, 0), (y, 0), (120, 0), (120, 80), (y, 80), (x, 80), (0, 80)]
    lines = [(k, (k + 1) % 8) for k in range(8)]
    return Fold(CreasePattern.from_lines(spots, [*lines, (1, 6), (2, 5)], "BBBBBBBBMV"))


def slotted(gap: float) -> Fold:
    """A square of 90 mm with an inner cut that runs beside its right edge."""
    x = 90 - gap
    spots = [(0, 0), (90, 0), (90, 90), (0, 90), (x, 30), (x, 60)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (0, 4), (1, 4), (2, 5), (3, 5)]
    return Fold(CreasePattern.from_lines(spots, lines, "BBBBCFFFF"))


def found(fold: Fold, code: str, **changed: object) -> list[Finding]:
    material = changed.get("material", stools.material())
    machine = changed.get("machine", stools.machine())
    assert isinstance(material, Material)
    assert isinstance(machine, Machine)
    return [f for f in make(fold, material, machine).findings if f.code == code]


@pytest.mark.parametrize("between", [4.4, 4.6, 3.0])
def test_a_facet_narrower_than_the_material_folds_is_told_with_its_width(between: float) -> None:
    told = found(strip(between), "narrow-facet")
    assert len(told) == (between < 4.5)
    if told:
        assert f"It is {between:.2f} mm wide" in told[0].message
        assert places(told)[0].at == pytest.approx((250, 250))


def test_a_flap_is_judged_by_its_own_rule_and_not_as_a_facet() -> None:
    from fabricate.plan.test_shapes import strip as flapped

    codes = {finding.code for finding in make(flapped(3.0), stools.material(),
                                              stools.machine()).findings}  # fmt: skip
    assert "narrow-flap" in codes
    assert "narrow-facet" not in codes


@pytest.mark.parametrize("seed", range(6))
def test_the_width_of_points_is_the_least_over_all_directions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(0, 10, (3 + seed, 2))
    angles = np.radians(np.arange(0, 180, 0.02))
    spans = np.ptp(points @ np.array([np.cos(angles), np.sin(angles)]), axis=0)
    assert width_of(points) <= spans.min() + 1e-9
    assert width_of(points) == pytest.approx(spans.min(), abs=0.02)


@pytest.mark.parametrize("gap", [0.5, 0.74, 0.8])
def test_cuts_nearer_than_the_sheet_is_thick_leave_a_strip_that_tears(gap: float) -> None:
    told = found(slotted(gap), "thin-strip")
    assert bool(told) == (gap < 0.74)
    if told:
        assert f"a strip of {gap:.2f} mm" in told[0].message
        assert places(told)[0].at[0] == pytest.approx(295 - gap / 2)


def test_a_side_on_which_a_trailing_blade_cannot_come_round_is_told() -> None:
    cut_corner = [(0, 0), (79.6, 0), (80, 0.4), (80, 80), (0, 80)]
    fold = Fold(CreasePattern.from_lines(cut_corner, [(k, (k + 1) % 5) for k in range(5)], "BBBBB"))
    told = found(fold, "short-side")
    assert [finding.at for finding in told] == [pytest.approx((289.8, 210.2), abs=0.01)]
    assert "0.57 mm" in told[0].message
    assert not found(fold, "short-side", machine=shelf.machine("grbl-laser"))


def with_cut(**changed: object) -> Material:
    material = stools.material()
    return material.model_copy(update={"cut": material.cut.model_copy(update=changed)})


@pytest.mark.parametrize("exposure", [0.75, 0.79, 0.80, 0.95])
def test_a_blade_that_hardly_stands_out_further_than_the_sheet_is_thick(exposure: float) -> None:
    told = found(strip(20), "through-cut-shallow", material=with_cut(exposure=exposure))
    assert bool(told) == (exposure < 0.8)
    if told:
        assert f"{0.05 - (exposure - 0.75):.2f} mm standing" in told[0].message
        assert "0.85 mm or more" in told[0].remedy


def test_a_preset_that_does_not_use_the_force_there_is_is_told_so() -> None:
    strong = stools.machine(stools.PENS)
    [told] = found(strip(20), "force-low", material=with_cut(force=300.0), machine=strong)
    assert "needs 500 gf; this machine has 600 gf" in told.message
    assert not found(strip(20), "force-low", material=with_cut(force=300.0))
    assert not found(strip(20), "force-low", machine=strong)


@pytest.mark.parametrize("exposure", [0.40, 0.50, 0.58, 0.70])
def test_an_outline_that_is_to_snap_must_keep_its_web(exposure: float) -> None:
    material = stools.material()
    snap = next(cut for cut in material.cuts if isinstance(cut, ScoreAndSnap))
    chosen = material.model_copy(
        update={
            "cut": snap.model_copy(update={"exposure": exposure}),
            "other_cuts": (material.cut,),
        }
    )
    told = found(strip(20), "snap-web", material=chosen)
    assert bool(told) == (abs(0.75 - exposure - snap.web) > 0.05)


@pytest.mark.parametrize("material", MATERIALS, ids=lambda m: m.slug)
def test_shipped_processes_ask_for_the_force_they_need_and_go_through(material: Material) -> None:
    for process in (*material.scores, *material.cuts):
        assert process.force >= process.force_needed
        if process.kind in {"perforation", "through-cut"}:
            assert process.exposure - material.thickness >= 0.05
        if isinstance(process, ScoreAndSnap):
            assert material.thickness - process.exposure == pytest.approx(process.web)


def test_a_hole_at_the_end_of_an_inner_cut_takes_that_end_away() -> None:
    spots = [(0, 0), (90, 0), (90, 90), (0, 90), (30, 45), (60, 45)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (0, 4), (3, 4), (1, 5), (2, 5)]
    fold = Fold(CreasePattern.from_lines(spots, lines, "BBBBCMMVV"))
    plan = make(fold, stools.material(), stools.machine(), relief="all")
    assert len(plan.reliefs) == 2
    assert "relief-too-near" not in {finding.code for finding in plan.findings}


@pytest.mark.parametrize("exposure", [0.2, 0.36, 0.4, 0.46, 0.5, 0.55, 0.56, 0.8])
def test_the_blade_of_a_score_keeps_the_web_and_the_depth_that_the_preset_promises(
    exposure: float,
) -> None:
    material = stools.material()
    score = material.score.model_copy(update={"exposure": exposure})
    told = found(strip(20), "blade-depth", material=material.model_copy(update={"score": score}))
    assert bool(told) == (abs(exposure - 0.55 * 0.75) > 0.05)
    if told:
        severity = Severity.ERROR if 0.75 - exposure < score.web_min - 1e-9 else Severity.WARNING
        assert told[0].severity is severity
        assert f"leaves {max(0.0, 0.75 - exposure):.2f} mm of the sheet" in told[0].message
        assert "Set half-cut.exposure to 0.41 mm" in told[0].remedy
