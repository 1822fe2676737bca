"""The simulator draws what it cut: on the face that is up, per tool, in true size."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fabricate.verify import knife_job

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.simulator.draw import draw, groups, png, svg
from foldmill_fabricate.plotter.simulator.drawing import Drawn
from foldmill_fabricate.plotter.simulator.legend import LEAD_IN, OTHERS, UNPLANNED
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
SVG = "{http://www.w3.org/2000/svg}"


def drawn(machine: Machine, program: bytes) -> Simulator:
    simulator = Simulator(machine)
    simulator.write(program)
    simulator.rest()
    return simulator


def test_a_stroke_keeps_its_tool_speed_force_and_points(machine: Make) -> None:
    simulator = drawn(machine(), b"IN;SP2;VS8;FS80;PU100,200;PD300,200,300,400;PD9,9;PU;SP0;")
    points = ((100, 200), (300, 200), (300, 400), (9, 9))
    assert simulator.sheet.strokes[Face.FRONT] == [Drawn(2, 80.0, 80.0, points)]


def test_other_force_or_tool_begins_another_stroke_where_the_tool_stands(machine: Make) -> None:
    simulator = drawn(machine(), b"SP1;FS80;PD10,0;FS200;PD20,0;SP2;PD30,0;PU;")
    strokes = simulator.sheet.strokes[Face.FRONT]
    assert [(each.tool, each.force, each.points) for each in strokes] == [
        (1, 80.0, ((0, 0), (10, 0))),
        (1, 200.0, ((10, 0), (20, 0))),
        (2, 200.0, ((20, 0), (30, 0))),
    ]


def test_a_tool_that_goes_down_and_up_leaves_a_dot(machine: Make) -> None:
    simulator = drawn(machine(), b"PU40,40;PD;PU;")
    assert [each.points for each in simulator.sheet.strokes[Face.FRONT]] == [((40, 40),)]


def test_a_plotter_that_selects_tools_draws_nothing_without_one(machine: Make) -> None:
    base = machine()
    tools = base.tools.model_copy(update={"change": "select"})
    simulator = drawn(base.model_copy(update={"tools": tools}), b"PD40,40;PU;SP2;PD50,50;PU;")
    assert [each.tool for each in simulator.sheet.strokes[Face.FRONT]] == [2]
    assert simulator.device.carriage.tally.without_tool == 2


def test_after_the_flip_the_strokes_are_on_the_reverse_and_then_on_a_new_sheet(
    machine: Make,
) -> None:
    simulator = drawn(machine(), b"PD40,40;PU;")
    simulator.flip()
    simulator.write(b"PD50,50;PU;PD60,60;PU;")
    simulator.new_sheet()
    simulator.write(b"PD70,70;PU;")
    simulator.rest()
    counts = [[len(sheet.strokes[face]) for face in Face] for sheet in simulator.sheets]
    assert counts == [[1, 2], [1, 0]]


def test_a_sheet_is_not_turned_with_the_tool_in_it(machine: Make) -> None:
    simulator = Simulator(machine())
    simulator.write(b"PD40,40;")
    with pytest.raises(PlotterError, match="tool down"):
        simulator.flip()
    assert simulator.sheet.up is Face.FRONT


def test_the_drawing_is_in_millimetres_with_y_up_and_a_group_per_setting(machine: Make) -> None:
    cutter = machine()
    simulator = drawn(cutter, b"SP1;VS8;PU400,800;PD1200,800;PU;SP2;PD1200,801;PU;")
    found = groups(simulator.sheet.strokes[Face.FRONT])
    root = ElementTree.fromstring(
        svg(found, cutter, "Front & <all>", dict.fromkeys(found, "#000000"))
    )
    assert root.get("width") == "600mm"
    assert root.get("viewBox") == "0 0 600 600"
    names = [group.findtext(f"{SVG}title") for group in root.findall(f"{SVG}g")]
    assert names == ["tool 1, 80 mm/s", "tool 2, 80 mm/s"]
    ways = [path.get("d") for path in root.findall(f"{SVG}g/{SVG}path")]
    assert ways == ["M10,580 30,580", "M30,580 30,579.975"]


def test_a_machine_that_swaps_its_axes_is_drawn_as_the_sheet_lies(machine: Make) -> None:
    base = machine()
    swapped = base.axes.model_copy(update={"swap": True})
    stroke = Drawn(1, 80.0, None, ((400, 800), (400, 1200)))
    np.testing.assert_array_equal(stroke.millimetres(swapped), [(20, 10), (30, 10)])
    np.testing.assert_array_equal(stroke.millimetres(base.axes), [(10, 20), (10, 30)])


def test_both_faces_are_written_and_the_same_strokes_give_the_same_bytes(
    machine: Make, tmp_path: Path
) -> None:
    cutter = machine()
    simulator = drawn(cutter, b"SP1;VS8;FS80;PU400,800;PD1200,800;PU;")
    paths = draw(simulator.sheet, cutter, tmp_path / "drawn")
    assert sorted(path.name for path in (tmp_path / "drawn").iterdir()) == sorted(
        path.name for path in paths
    )
    assert len(paths) == 4
    front = simulator.sheet.strokes[Face.FRONT]
    title = "Front, as generic-hpgl-600 saw it"
    own = {"tool 1, 80 mm/s, 80 gf": OTHERS[0]}
    assert paths[1].read_bytes() == png(groups(front), cutter, title, own)
    assert paths[1].read_bytes() != paths[3].read_bytes()
    assert list(groups(front)) == ["tool 1, 80 mm/s, 80 gf"]


def test_a_setting_has_one_colour_on_both_faces(machine: Make, tmp_path: Path) -> None:
    cutter = machine()
    simulator = drawn(cutter, b"SP1;VS8;PD1200,800;PU;VS4;PD9,9;PU;")
    simulator.flip()
    simulator.write(b"VS4;PD800,900;PU;")
    simulator.rest()
    front, _, reverse, _ = draw(simulator.sheet, cutter, tmp_path)
    one, other = (colours_in(path.read_bytes()) for path in (front, reverse))
    assert len(set(one.values())) == 2
    assert other == {"tool 1, 40 mm/s": one["tool 1, 40 mm/s"]}


def test_what_a_plan_makes_has_a_name_and_one_colour_on_both_faces(tmp_path: Path) -> None:
    job = knife_job.job(0.9)
    serial = job.plan.machine.serial.model_copy(update={"buffer": 10**6})
    simulator = Simulator(job.plan.machine.model_copy(update={"serial": serial}))
    for file in job.plan.programs:
        if file.face is not simulator.sheet.up:
            simulator.flip()
        simulator.write(job.programs[file.name])
        simulator.rest()
    simulator.write(b"PU20000,20000;PD20400,20000;PU;")
    simulator.rest()
    front, _, reverse, _ = draw(simulator.sheet, job.plan.machine, tmp_path, job.plan)
    one, other = (colours_in(path.read_bytes()) for path in (front, reverse))
    scores = f"scores, {job.plan.material.score.title}"
    outline = f"outline, {job.plan.material.cut.title}"
    assert set(one) == {LEAD_IN, "registration holes", "witness mark", scores}
    assert set(other) == {LEAD_IN, scores, outline, UNPLANNED}
    assert one[scores] == other[scores]
    assert one[LEAD_IN] == other[LEAD_IN]
    assert len({**one, **other}) == len({*one.values(), *other.values()})


def colours_in(drawing: bytes) -> dict[str, str]:
    """Return the colour of each group of an SVG, by its title."""
    found = ElementTree.fromstring(drawing).findall(f"{SVG}g")
    return {str(g.findtext(f"{SVG}title")): str(g.get("style")).split(":")[-1] for g in found}
