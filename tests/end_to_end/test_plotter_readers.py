"""Inkscape, vpype and hpgl-buddy read the stool's programs and drawings as they are planned."""

from __future__ import annotations

import re
from pathlib import Path

import hand_made
import numpy as np
import pytest
import readers
from stools import ONE_TOOL, PENS, stool, stool_plan

from foldmill_fabricate.formats import dxf, hpgl, svg
from foldmill_fabricate.formats.drawing import drawings
from foldmill_fabricate.profiles import Style, find

PAGE = 297.0
"""mm. Inkscape's importers lay what they read on an upright A4 page, y downward."""
PROGRAMS = {
    f"{slug}/{name}": data
    for slug in (ONE_TOOL, PENS)
    for name, data in hpgl.write(stool_plan(slug), stool()).items()
}
STEP = 0.025
"""mm."""


def pens(program: bytes) -> dict[int, list[int]]:
    """Read the extent in steps of what each pen draws, by a plain reading of our dialect."""
    found: dict[int, list[tuple[int, int]]] = {}
    pen, at = 1, (0, 0)
    for word in program.decode().replace("\n", "").split(";"):
        numbers = [int(n) for n in re.findall(r"-?\d+", word)]
        if word.startswith("SP") and numbers:
            pen = numbers[0]
        places = list(zip(numbers[::2], numbers[1::2], strict=False))
        if word.startswith("PD"):
            found.setdefault(pen, []).extend([at, *places])
        if word[:2] in {"PU", "PD", "PA"} and places:
            at = places[-1]
    boxes = {number: np.array(places) for number, places in found.items()}
    return {k: [*box.min(axis=0).tolist(), *box.max(axis=0).tolist()] for k, box in boxes.items()}


def drawn(view: str) -> dict[str, readers.Layer]:
    """Return the layers of a view of the hand-made job as they are planned, mm, y upward."""
    (found,) = (each for each in drawings(hand_made.plan()) if each.name == view)
    layers = {}
    for group in found.groups:
        points = np.vstack(group.lines)
        box = (*points.min(axis=0).tolist(), *points.max(axis=0).tolist())
        layers[group.layer.name] = readers.Layer(len(group.lines), box)
    return layers


@pytest.mark.parametrize("name", PROGRAMS)
def test_inkscape_reads_every_pen_of_a_program_to_one_unit(name: str, tmp_path: Path) -> None:
    read = readers.inkscape("hpgl_input.py", PROGRAMS[name], "p.hpgl", tmp_path)
    layers = readers.inkscape_layers(read)
    wanted = pens(PROGRAMS[name])
    assert set(layers) == {f"Pen {number}" for number in wanted}
    for number, steps in wanted.items():
        left, top, right, low = layers[f"Pen {number}"].box
        found = (left, PAGE - low, right, PAGE - top)
        assert found == pytest.approx([each * STEP for each in steps], abs=STEP)


@pytest.mark.parametrize("view", ["front", "reverse", "master"])
@pytest.mark.parametrize("version", ["R2000", "R12"])
def test_inkscape_reads_every_layer_of_a_dxf_to_one_unit(
    view: str, version: str, tmp_path: Path
) -> None:
    style = Style(find(), version)  # type: ignore[arg-type]
    content = dxf.write(hand_made.plan(), hand_made.fold(), style)[f"{view}.dxf"]
    layers = readers.inkscape_layers(
        readers.inkscape("dxf_input.py", content, "d.dxf", tmp_path, "--scalemethod=manual")
    )
    wanted = drawn(view)
    assert set(layers) == {*wanted, "ANCHOR"}
    for name, planned in wanted.items():
        left, top, right, low = layers[name].box
        assert layers[name].paths == planned.paths
        found = (left, PAGE - low, right, PAGE - top)
        assert found == pytest.approx(planned.box, abs=STEP)


def test_inkscapes_own_plotter_takes_pen_speed_and_force_from_our_labels(tmp_path: Path) -> None:
    content = svg.write(hand_made.plan(), hand_made.fold())["master.svg"]
    options = ("--resolutionX=1016", "--resolutionY=1016", "--precut=false", "--overcut=0")
    plain = ("--autoAlign=false", "--toolOffset=0", "--center=false")
    said = readers.inkscape("hpgl_output.py", content, "s.svg", tmp_path, *options, *plain)
    settings = re.findall(r"SP(\d+);VS(\d+);FS(\d+);", said)
    worked = [tuple(map(int, row)) for row in settings[: len(drawn("master"))]]
    assert sorted(set(worked)) == [(1, 8, 300), (2, 12, 240), (4, 8, 300)]
    assert worked == sorted(worked, key=lambda row: row[0])


@pytest.mark.parametrize("view", ["front", "reverse"])
def test_vpype_numbers_layers_by_pen_and_reads_their_extent(view: str, tmp_path: Path) -> None:
    plan = hand_made.plan()
    content = svg.write(plan, hand_made.fold())[f"{view}.svg"]
    pen_of = {look.name: look.pen for look in vars(find().layers).values()}
    wanted: dict[int, list[readers.Layer]] = {}
    for name, planned in drawn(view).items():
        wanted.setdefault(pen_of[name], []).append(planned)
    layers = readers.vpype_layers(content, tmp_path)
    silent = layers.pop(pen_of["ANCHOR"])
    assert (silent[0], silent[1].paths) == ("ANCHOR Pen 5", 4)
    assert set(layers) == set(wanted)
    for number, planned_here in wanted.items():
        label, read = layers[number]
        assert re.fullmatch(rf"[A-Z_]+ Pen {number} Speed \d+ Force \d+", label)
        assert read.paths == sum(each.paths for each in planned_here)
        boxes = np.array([each.box for each in planned_here])
        left, top, right, low = read.box
        found = (left, plan.sheet.height - low, right, plan.sheet.height - top)
        extent = [*boxes[:, :2].min(axis=0).tolist(), *boxes[:, 2:].max(axis=0).tolist()]
        assert found == pytest.approx(extent, abs=STEP)


def test_hpgl_buddy_finds_no_error_in_any_program(tmp_path: Path) -> None:
    for data in PROGRAMS.values():
        code, warnings = readers.hpgl_buddy(data, tmp_path)
        assert code == 0
        # the plotters it knows have no force: FS is passed through unseen
        assert all(" FS: unknown mnemonic" in each for each in warnings), warnings


def test_hpgl_buddy_would_have_found_one(tmp_path: Path) -> None:
    broken = PROGRAMS[f"{ONE_TOOL}/2-front-score.hpgl"].replace(b"PU", b"PU7", 1)
    assert readers.hpgl_buddy(broken.replace(b"PU7;", b"PU7,7,7;", 1), tmp_path)[0] != 0
