"""The stool, from parameters to both faces as a plotter cut them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import shapely
from stools import ONE_TOOL, PENS, machine, material, stool, stool_plan

from foldmill import Assignment
from foldmill_fabricate import folder
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.operators import SimulatedOperator
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.sheet import placed

if TYPE_CHECKING:
    from conftest import Golden


@pytest.fixture(scope="module", params=[ONE_TOOL, PENS])
def cut(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Cut:
    path = tmp_path_factory.mktemp("job")
    folder.write(stool(), stool_plan(request.param), path, ["svg", "dxf", "hpgl"])
    url = f"sim://{request.param}?machine={request.param}&buffer=255"
    sent = list(send_job(open_job(path), url, SimulatedOperator(url)))
    return Cut(stool_plan(request.param), url, [each.delivery.status for each in sent])


class Cut:
    """A job, and what the simulator drew of it."""

    def __init__(self, plan: Plan, url: str, statuses: list[str]) -> None:
        self.plan, self.statuses = plan, statuses
        self.simulator = devices.behind(url)

    def lines(self, face: Face) -> shapely.Geometry:
        """Everything drawn on a face, brought back to the sheet by hand."""
        drawn = []
        for stroke in self.simulator.sheet.strokes[face]:
            xy = stroke.millimetres(self.plan.machine.axes) - (
                self.plan.sheet.dx,
                self.plan.sheet.dy,
            )
            if face is Face.REVERSE:
                xy[:, 0] = self.plan.sheet.width - xy[:, 0]
            drawn.append(xy)
        return shapely.union_all(shapely.linestrings(np.vstack(drawn), indices=_owners(drawn)))

    def planned(self, face: Face) -> shapely.Geometry:
        strokes = [
            np.array(stroke.points)
            for work in self.plan.passes
            if work.face is face
            for setup in work.setups
            for operation in setup.operations
            for stroke in operation.strokes
        ]
        return shapely.union_all(shapely.linestrings(np.vstack(strokes), indices=_owners(strokes)))


def _owners(paths: list[np.ndarray]) -> np.ndarray:
    return np.repeat(np.arange(len(paths)), [len(path) for path in paths])


def test_every_program_is_executed_without_an_overrun(cut: Cut) -> None:
    assert set(cut.statuses) == {"executed"}
    assert cut.simulator.device.traffic.overruns == 0


@pytest.mark.parametrize("face", list(Face))
def test_what_was_cut_on_each_face_is_the_plan_within_a_plotter_step(cut: Cut, face: Face) -> None:
    drawn, planned = cut.lines(face), cut.planned(face)
    assert shapely.hausdorff_distance(drawn, planned, densify=0.5) <= 0.025
    assert shapely.hausdorff_distance(planned, drawn, densify=0.5) <= 0.025


def test_each_fold_crease_is_scored_on_exactly_one_face(cut: Cut) -> None:
    pattern = stool().pattern
    spots = placed(pattern.vertices, cut.plan.placement)
    front, reverse = cut.lines(Face.FRONT), cut.lines(Face.REVERSE)
    for (a, b), code in zip(pattern.edges, pattern.assignments, strict=True):
        third = shapely.LineString(
            [spots[a] * 0.6 + spots[b] * 0.4, spots[a] * 0.4 + spots[b] * 0.6]
        )
        on_front = front.buffer(0.03).contains(third)
        on_reverse = reverse.buffer(0.03).contains(third)
        if code in {Assignment.M, Assignment.V}:
            assert (on_front, on_reverse) == (code == Assignment.M, code == Assignment.V)
        elif code == Assignment.F:
            assert not on_front
            assert not on_reverse


def test_the_same_job_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        plan = make(stool(), material(), machine())
        folder.write(stool(), plan, tmp_path / name, ["svg", "dxf", "hpgl"])
    names = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "two").iterdir())
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_a_new_plan_leaves_no_file_of_the_old_one(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("kept")
    folder.write(stool(), stool_plan(ONE_TOOL), tmp_path, ["dxf", "hpgl"])
    folder.write(stool(), stool_plan(PENS), tmp_path, ["hpgl"])
    assert {path.name for path in tmp_path.iterdir()} == {
        *("front.hpgl", "reverse.hpgl", "job-sheet.pdf", "mine.txt", "pattern.fold", "plan.json"),
    }


@pytest.mark.parametrize("slug", [ONE_TOOL, PENS])
def test_the_stools_programs_are_as_they_were(slug: str, golden: Golden) -> None:
    for name, program in hpgl.write(stool_plan(slug), stool()).items():
        golden.check(f"stool-n8/{slug}/{name}", program)
