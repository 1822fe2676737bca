"""How far the reverse may land beside the front, cause by cause."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from fabricate.plan.test_make import square
from stools import machine, material

from foldmill.finding import Severity
from foldmill_fabricate.passes import Budget, Plan
from foldmill_fabricate.plan import budget, make


@cache
def plan(
    kind: str = "holes",
    temperatures: tuple[float, float] | None = None,
    slug: str = "generic-hpgl-600",
    side: float = 340.0,
) -> Plan:
    """A square, its creases from the middle to the middles of its sides, on 500 × 500 mm."""
    return make(
        square("MVMV", side),
        material(),
        machine(slug),
        register=kind,  # type: ignore[arg-type]
        temperatures=temperatures,
    )


def shares(made: Plan) -> dict[str, float]:
    assert made.budget is not None
    return {share.name: share.error for share in made.budget.shares}


def reckoned(made: Plan) -> Budget:
    assert made.budget is not None
    return made.budget


def test_sums_are_those_of_the_shares_and_the_limit_is_half_the_sheet() -> None:
    found = reckoned(plan())
    errors = np.array([share.error for share in found.shares])
    assert found.likely == pytest.approx(np.linalg.norm(errors))
    assert found.worst == pytest.approx(errors.sum())
    assert found.limit == 0.375
    assert len(errors) == 5


def test_polypropylene_that_warms_by_five_degrees_grows_away_from_the_middle_of_its_holes() -> None:
    """The farthest scored point is the end of a crease, 180 mm from there, for the holes' middle
    is 10 mm below the sheet's: 140e-6 × 5 × 180 = 0.126 mm.
    """
    made = plan(temperatures=(20.0, 25.0))
    middle = np.mean([(hole.x, hole.y) for hole in made.holes], axis=0)
    ends = np.array([(250, 80), (250, 420), (80, 250), (420, 250)])
    reach = np.hypot(*(ends - middle).T).max()
    assert shares(made)["temperature"] == pytest.approx(140e-6 * 5 * reach)
    assert shares(made)["temperature"] == pytest.approx(0.126, abs=0.001)
    assert shares(plan(temperatures=(25.0, 20.0))) == shares(made)
    assert shares(plan()) == pytest.approx(shares(made))  # five degrees are what is assumed


def test_two_passes_at_one_temperature_owe_nothing_to_it() -> None:
    assert shares(plan(temperatures=(21.0, 21.0)))["temperature"] == 0


def test_against_edges_everything_grows_from_the_corner_that_is_held() -> None:
    made = plan("edge", (20.0, 25.0))
    assert shares(made)["temperature"] == pytest.approx(140e-6 * 5 * np.hypot(420, 250))
    assert shares(made)["flip"] == 1.0


def test_the_share_of_the_flip_is_what_reading_errors_of_the_holes_do_to_a_fit() -> None:
    """By trial: holes are read with errors of 0.2 mm in each axis, the reverse is fitted to them,
    and the farthest scored point errs by that on the whole.
    """
    from foldmill_fabricate.marks import _rigid
    from foldmill_fabricate.sheet import turned

    made = plan()
    holes = np.array([(hole.x, hole.y) for hole in made.holes])
    ends = np.array([(250.0, 80), (250, 420), (80, 250), (420, 250)])
    far = ends[np.hypot(*(ends - holes.mean(axis=0)).T).argmax()]
    lot = np.random.default_rng(5)
    off = []
    for _ in range(1500):
        fit = _rigid(holes, holes + lot.normal(0, 0.2 / 2**0.5, holes.shape)).fit
        off.append(turned([far], fit.angle)[0] + (fit.dx, fit.dy) - far)
    away = np.sqrt((np.array(off) ** 2).sum(axis=1).mean())
    share = shares(made)["flip"]
    assert away <= share
    assert away == pytest.approx(share, rel=0.25)


def test_every_kind_is_dearer_than_the_one_that_holds_better() -> None:
    holes, edge, nothing = (shares(plan(kind))["flip"] for kind in ("holes", "edge", "none"))
    assert holes < edge < nothing


def findings(made: Plan) -> list[tuple[Severity, str]]:
    return [(f.severity, str(f)) for f in made.findings if f.code == "register-error"]


def test_a_likely_error_above_half_the_sheet_is_a_warning_with_figure_and_remedy() -> None:
    [(severity, told)] = findings(plan("edge"))
    assert severity is Severity.WARNING
    assert f"{reckoned(plan('edge')).likely:.2f} mm" in told
    assert "0.375 mm" in told
    assert "register by holes" in told


def test_one_that_is_above_it_only_at_worst_is_in_the_table_and_no_warning() -> None:
    assert reckoned(plan()).likely < 0.375 < reckoned(plan()).worst
    assert not findings(plan())


def test_heat_is_named_where_it_is_most_of_it() -> None:
    [(severity, told)] = findings(plan(temperatures=(15.0, 35.0)))
    assert severity is Severity.WARNING
    assert "temperature" in told.rsplit("Most comes", 1)[1]


def test_a_sheet_that_is_not_turned_over_has_no_budget() -> None:
    made = make(square("MMMM"), material(), machine())
    assert made.budget is None
    assert budget.reckon(made) is None
    assert made.registration.kind == "none"
