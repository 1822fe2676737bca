"""SVG and DXF cutting drawings: one size, one position, one line per stroke, in every reader."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import hand_made
import pytest
import readers
from ezdxf import bbox, options  # type: ignore[attr-defined]
from ezdxf.document import Drawing
from ezdxf.filemanagement import readfile

from foldmill import installed
from foldmill_fabricate import hooks
from foldmill_fabricate.formats import dxf, svg
from foldmill_fabricate.formats.drawing import drawings
from foldmill_fabricate.passes import Face
from foldmill_fabricate.profiles import Style, find

if TYPE_CHECKING:
    from conftest import Golden

PLAN, FOLD = hand_made.plan(), hand_made.fold()
OLD = Style(find(), "R12")
SVG, DXF, R12 = svg.write(PLAN, FOLD), dxf.write(PLAN, FOLD), dxf.write(PLAN, FOLD, OLD)
VIEWS = ("front", "reverse", "master")
SILENT = {"NOTE", "ANCHOR"}
Box = tuple[float, float, float, float]


def read_dxf(content: bytes, folder: Path) -> Drawing:
    (folder / "x.dxf").write_bytes(content)
    return readfile(folder / "x.dxf")


def dxf_box(document: Drawing, *, worked: bool) -> Box:
    lines = [
        entity
        for entity in document.modelspace()
        if entity.dxftype() != "TEXT" and ((entity.dxf.layer not in SILENT) or not worked)
    ]
    low, high = bbox.extents(lines).extmin, bbox.extents(lines).extmax
    return low.x, low.y, high.x, high.y


def svg_lines(content: bytes, *, worked: bool) -> list[list[tuple[float, float]]]:
    """Read the lines of a drawing back to y upward; no library of ours."""
    root, found = ElementTree.fromstring(content), []
    height = float(root.attrib["viewBox"].split()[3])
    for group in root:
        label = next((v for k, v in group.attrib.items() if k.endswith("label")), "ANCHOR")
        for path in group if label.split()[0] not in SILENT or not worked else ():
            pairs = re.findall(r"(-?[\d.]+),(-?[\d.]+)", path.attrib.get("d", ""))
            found.append([(float(x), height - float(y)) for x, y in pairs])
    return [line for line in found if line]


def svg_box(content: bytes, *, worked: bool) -> Box:
    xs, ys = zip(*(xy for line in svg_lines(content, worked=worked) for xy in line), strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def plan_box(view: str) -> Box:
    if view != "reverse":
        boxes = [hand_made.plan_extent(PLAN, face) for face in Face]
        chosen = boxes[:1] if view == "front" else boxes
        x0, y0, x1, y1 = zip(*chosen, strict=True)
        return min(x0), min(y0), max(x1), max(y1)
    left, low, right, high = hand_made.plan_extent(PLAN, Face.REVERSE)
    return hand_made.WIDTH - right, low, hand_made.WIDTH - left, high


def test_foldmill_offers_its_formats_through_its_own_hook() -> None:
    offered = installed().of(hooks.FORMATS)
    assert {"svg", "dxf", "hpgl"} <= set(offered)
    assert offered["svg"].write(PLAN, FOLD) == SVG


@pytest.mark.parametrize("view", VIEWS)
def test_drawings_are_as_they_were(view: str, golden: Golden) -> None:
    golden.check(f"hand-made/{view}.svg", SVG[f"{view}.svg"])
    golden.check(f"hand-made/{view}.dxf", DXF[f"{view}.dxf"])
    golden.check(f"hand-made/r12/{view}.dxf", R12[f"{view}.dxf"])


def test_the_legend_is_as_it_was(golden: Golden) -> None:
    golden.check("hand-made/legend.svg", SVG["legend.svg"])


@pytest.mark.parametrize("view", VIEWS)
def test_svg_dxf_and_plan_have_one_extent_in_mm(view: str, tmp_path: Path) -> None:
    expected = pytest.approx(plan_box(view), abs=1e-3)
    assert svg_box(SVG[f"{view}.svg"], worked=True) == expected
    assert dxf_box(read_dxf(DXF[f"{view}.dxf"], tmp_path), worked=True) == expected
    assert dxf_box(read_dxf(R12[f"{view}.dxf"], tmp_path), worked=True) == expected


@pytest.mark.parametrize("view", VIEWS)
def test_anchors_give_both_faces_the_blanks_own_box(view: str, tmp_path: Path) -> None:
    blank = pytest.approx((0, 0, hand_made.WIDTH, hand_made.HEIGHT), abs=1e-3)
    assert svg_box(SVG[f"{view}.svg"], worked=False) == blank
    assert dxf_box(read_dxf(DXF[f"{view}.dxf"], tmp_path), worked=False) == blank


@pytest.mark.parametrize("view", VIEWS)
def test_an_svg_states_its_size_in_mm_and_needs_no_transform(view: str) -> None:
    content = SVG[f"{view}.svg"]
    root = ElementTree.fromstring(content)
    assert (root.attrib["width"], root.attrib["height"]) == ("100mm", "80mm")
    assert root.attrib["viewBox"] == "0 0 100 80"
    assert b"transform" not in content
    assert b"dash" not in content


def test_layer_labels_name_role_pen_speed_and_force_in_order_of_work() -> None:
    labels = re.findall(rb'inkscape:label="([^"]*)"', SVG["master.svg"])
    assert labels == [
        b"REG Pen 1 Speed 8 Force 300",
        b"SCORE_FRONT Pen 2 Speed 12 Force 240",
        b"SCORE_BACK Pen 2 Speed 12 Force 240",
        b"CUT_INNER Pen 4 Speed 8 Force 300",
        b"CUT_OUTER Pen 4 Speed 8 Force 300",
        b"ANCHOR Pen 5",
        b"NOTE Pen 5",
    ]


def test_pens_are_the_machines_own_where_it_selects_tools() -> None:
    pens = hand_made.plan(hand_made.machine("generic-hpgl-pens"))
    assert b'"REG Pen 4 Speed' in svg.write(pens, FOLD)["front.svg"]


@pytest.mark.parametrize("view", VIEWS)
def test_every_stroke_is_drawn_once_however_often_it_is_repeated(view: str, tmp_path: Path) -> None:
    drawn = svg_lines(SVG[f"{view}.svg"], worked=True)
    segments = [frozenset(pair) for line in drawn for pair in pairwise(line)]
    assert len(segments) == len(set(segments))
    space = read_dxf(DXF[f"{view}.dxf"], tmp_path).modelspace()
    worked = [entity for entity in space if entity.dxf.layer not in SILENT]
    assert len(worked) == len(drawn) == {"front": 6, "reverse": 4, "master": 10}[view]


@pytest.mark.parametrize("files", [DXF, R12], ids=["R2000", "R12"])
@pytest.mark.parametrize("view", VIEWS)
def test_ezdxf_finds_no_error(files: dict[str, bytes], view: str, tmp_path: Path) -> None:
    assert not read_dxf(files[f"{view}.dxf"], tmp_path).audit().has_errors


def test_a_dxf_says_it_is_in_mm(tmp_path: Path) -> None:
    document = read_dxf(DXF["front.dxf"], tmp_path)
    assert document.dxfversion == "AC1015"
    assert (document.header["$INSUNITS"], document.header["$MEASUREMENT"]) == (4, 1)
    assert read_dxf(R12["front.dxf"], tmp_path).dxfversion == "AC1009"


def test_dxf_lines_carry_role_layer_and_colour_and_cuts_are_closed(tmp_path: Path) -> None:
    space = read_dxf(DXF["master.dxf"], tmp_path).modelspace()
    kinds = {(e.dxf.layer, e.dxf.color, e.dxftype()) for e in space if e.dxf.layer not in SILENT}
    assert kinds == {
        ("REG", 10, "LWPOLYLINE"),
        ("SCORE_FRONT", 4, "LINE"),
        ("SCORE_FRONT", 4, "LWPOLYLINE"),  # the witness mark
        ("SCORE_BACK", 9, "LINE"),
        ("CUT_INNER", 1, "LWPOLYLINE"),
        ("CUT_OUTER", 1, "LWPOLYLINE"),
    }
    closed = space.query('LWPOLYLINE[layer=="REG" | layer=="CUT_INNER"]')
    assert [entity.dxf.flags for entity in closed] == [1] * 5
    assert {e.dxf.layer for e in space.query("TEXT")} == {"NOTE"}


def test_words_are_set_anew_and_never_mirrored(tmp_path: Path) -> None:
    for view, word in (("front", "FRONT"), ("reverse", "REVERSE")):
        (text,) = read_dxf(DXF[f"{view}.dxf"], tmp_path).modelspace().query("TEXT")
        assert f"{word}, this face up" in text.dxf.text
        assert text.dxf.get("width", 1) > 0
        assert not text.dxf.get("text_generation_flag", 0)
        assert f"{word}, this face up".encode() in SVG[f"{view}.svg"]


def test_a_job_on_one_face_has_no_drawing_of_the_other() -> None:
    single = PLAN.model_copy(update={"passes": PLAN.passes[1:]})
    assert [view.name for view in drawings(single)] == ["reverse", "master"]


def test_bytes_are_the_same_a_second_later_and_the_option_is_given_back() -> None:
    before = options.write_fixed_meta_data_for_testing
    time.sleep(1.1)
    assert dxf.write(PLAN, FOLD) == DXF
    assert svg.write(PLAN, FOLD) == SVG
    assert options.write_fixed_meta_data_for_testing is before is False


@pytest.mark.parametrize("seed", ["1", "2"])
def test_bytes_are_the_same_in_another_process(seed: str) -> None:
    code = (
        "import hashlib, hand_made as h\n"
        "from foldmill_fabricate.formats import dxf, svg\n"
        "files = {**dxf.write(h.plan(), h.fold()), **svg.write(h.plan(), h.fold())}\n"
        "print(hashlib.sha256(b''.join(files.values())).hexdigest())"
    )
    here = hashlib.sha256(b"".join([*DXF.values(), *SVG.values()])).hexdigest()
    folder = str(Path(hand_made.__file__).parent)
    paths = os.pathsep.join([folder, *sys.path])
    environment = {**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": seed}
    command = [sys.executable, "-c", code]
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.strip() == here


@pytest.mark.parametrize("view", VIEWS)
def test_librecad_opens_the_drawing(view: str, tmp_path: Path) -> None:
    assert readers.librecad_pdf(DXF[f"{view}.dxf"], tmp_path).startswith(b"%PDF")
