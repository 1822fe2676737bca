"""PDF drawings, read back by poppler's programs and, for their structure, by pikepdf."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import hand_made
import numpy as np
import pikepdf
import poppler
import pytest
from numpy.typing import NDArray
from PIL import Image

from foldmill import installed
from foldmill_fabricate import hooks
from foldmill_fabricate.errors import CannotWrite
from foldmill_fabricate.formats import pdf, svg
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.profiles import Layers, Style, find
from foldmill_fabricate.sheet import flipped

if TYPE_CHECKING:
    from conftest import Golden

PLAN, FOLD = hand_made.plan(), hand_made.fold()
PDF = pdf.write(PLAN, FOLD)
Floats = NDArray[np.float64]
STEP = 0.025
"""mm: one unit of a plotter."""


def planned(plan: Plan, view: str) -> list[Floats]:
    """Return what a view must show, by the plan alone."""
    return [
        flipped(stroke.points, plan.flip) if view == "reverse" else np.array(stroke.points)
        for work in plan.passes
        if view in ("master", work.face.value)
        for setup in work.setups
        for operation in setup.operations
        for stroke in operation.strokes
    ]


def layers(content: bytes) -> dict[str, tuple[str, str]]:
    """Return group and type of ISO 19593-1 by the name of the layer."""
    with pikepdf.open(BytesIO(content)) as read:
        found = {}
        for group in read.Root.OCProperties.OCGs:
            meta = group.GTS_Metadata
            kind = str(meta.get("/GTS_ProcStepsType", ""))
            found[str(group.Name)] = (str(meta.GTS_ProcStepsGroup), kind)
        return found


def spots(content: bytes, page: int = 0) -> dict[str, set[str]]:
    """Return, by layer, the spot colours that its lines are stroked in: from the operators."""
    with pikepdf.open(BytesIO(content)) as read:
        resources = read.pages[page].Resources
        found: dict[str, set[str]] = {}
        inside = ""
        for one in pikepdf.parse_content_stream(read.pages[page]):
            operands, operator = list(one.operands), str(one.operator)
            if operator == "BDC":
                inside = str(resources.Properties[str(operands[1])].Name)
            if operator == "CS":
                kind, name, *_ = resources.ColorSpace[str(operands[0])]
                assert kind == "/Separation"
                found.setdefault(inside, set()).add(str(name))
        return found


@pytest.mark.parametrize("view", ["front", "reverse", "master"])
def test_a_page_is_as_large_as_the_sheet_and_every_stroke_is_where_it_is_planned(
    view: str, tmp_path: Path
) -> None:
    content = PDF[f"{view}.pdf"]
    (size,) = poppler.page_sizes(content, tmp_path)
    assert size == pytest.approx((100, 80), abs=STEP)
    drawn = [line for _, line in poppler.lines(content, tmp_path)]
    wanted = planned(PLAN, view)
    assert len(drawn) == len(wanted) + 4  # the anchors
    for line in wanted:
        near = [np.abs(other - line).max() for other in drawn if len(other) == len(line)]
        assert min(near) < STEP
    every = np.vstack(drawn)
    assert every.min(axis=0) == pytest.approx((0, 0), abs=STEP)
    assert every.max(axis=0) == pytest.approx((100, 80), abs=STEP)


def test_layers_say_which_step_of_the_work_their_lines_are_for() -> None:
    structural, legend = "/Structural", ("/Legend", "")
    assert layers(PDF["master.pdf"]) == {
        "REG": (structural, "/Drilling"),
        "SCORE_FRONT": (structural, "/PartialCutting"),
        "SCORE_BACK": (structural, "/ReversePartialCutting"),
        "CUT_INNER": (structural, "/Cutting"),
        "CUT_OUTER": (structural, "/Cutting"),
        "ANCHOR": legend,
        "NOTE": legend,
    }
    assert "SCORE_BACK" not in layers(PDF["front.pdf"])


@pytest.mark.parametrize("profile", ["foldmill", "cut-contour", "artioscad"])
def test_every_layer_is_drawn_in_a_spot_colour_of_its_name(profile: str) -> None:
    content = pdf.write(PLAN, FOLD, Style(find(profile)))["master.pdf"]
    found = spots(content)
    assert found == {name: {f"/{name}"} for name in layers(content)}
    wanted = {getattr(find(profile).layers, key).name for key in ("cut_inner", "score_back")}
    assert wanted <= set(found)


def test_creases_pressed_or_perforated_and_an_outline_that_is_snapped_are_called_so() -> None:
    assert pdf.STEPS["crease_back"] == "ReverseCreasing"
    assert pdf.STEPS["perforation"] == "Perforating"
    steps = set(pdf.STEPS.values())
    assert steps <= {
        *("Cutting", "PartialCutting", "ReversePartialCutting", "Creasing", "ReverseCreasing"),
        *("Perforating", "Drilling"),
    }
    cut = PLAN.material.cut.model_copy(update={"kind": "score-and-snap"})
    snapped = PLAN.model_copy(update={"material": PLAN.material.model_copy(update={"cut": cut})})
    assert layers(pdf.write(snapped, FOLD)["master.pdf"])["CUT_OUTER"][1] == "/PartialCutting"


def test_each_layer_has_its_own_colour_on_screen(tmp_path: Path) -> None:
    drawn = poppler.lines(PDF["master.pdf"], tmp_path)
    colours = {colour for colour, _ in drawn}
    assert len(colours) == 6  # holes, two scores, inner cut, outline, anchors


def test_words_are_set_anew_and_never_mirrored(tmp_path: Path) -> None:
    for view, said in (("front", "FRONT"), ("reverse", "REVERSE")):
        assert f"{said}, this face up" in poppler.text(PDF[f"{view}.pdf"], tmp_path)
    assert "SCORE_BACK #ff8000" in poppler.text(PDF["legend.pdf"], tmp_path)


def test_a_sheet_longer_than_a_page_of_a_pdf_is_refused_with_what_to_do() -> None:
    sheet = PLAN.sheet.model_copy(update={"width": 6000.0})
    with pytest.raises(CannotWrite, match=r"5080 mm.*pdf-a3"):
        pdf.write(PLAN.model_copy(update={"sheet": sheet}), FOLD)


def test_the_letters_are_in_the_file_and_fit_the_sheet(tmp_path: Path) -> None:
    fonts = poppler.run(["pdffonts", "x.pdf"], PDF["reverse.pdf"], tmp_path).splitlines()[2:]
    assert len(fonts) == 1
    assert re.search(r"Type 3 +Custom +yes", fonts[0])
    boxes = poppler.run(["pdftotext", "-bbox", "x.pdf", "-"], PDF["reverse.pdf"], tmp_path)
    ends = [float(x) for x in re.findall(r'xMax="([\d.]+)"', boxes)]
    assert 30 * poppler.MM < max(ends) < 100 * poppler.MM


def test_a_capital_is_as_high_as_the_note_says(tmp_path: Path) -> None:
    wide = PLAN.model_copy(update={"title": "H"})
    content = pdf.write(wide, FOLD)["front.pdf"]
    command = ["pdftocairo", "-png", "-singlefile", "-r", "508", "x.pdf", "x"]
    poppler.run(command, content, tmp_path)
    with Image.open(tmp_path / "x.png") as image:
        dark = np.asarray(image.convert("L")) < 220
    x, y = (round(20 * mm) for mm in (8.0, 80.0 - 2.0))  # 20 dots are a mm
    letter = dark[y - 100 : y + 20, x : x + 56]
    rows = np.flatnonzero(letter.any(axis=1))
    assert np.ptp(rows) / 20 == pytest.approx(3.5, abs=0.15)


def test_letters_that_the_font_does_not_have_do_no_harm(tmp_path: Path) -> None:
    other = PLAN.model_copy(update={"title": r"折り紙 (a\b) × ½"})
    said = poppler.text(pdf.write(other, FOLD)["front.pdf"], tmp_path)
    assert r"??? (a\b) × ½: FRONT" in said


def test_plan_offers_pdf_on_one_page_and_over_paper() -> None:
    offered = installed().of(hooks.FORMATS)
    assert {"pdf", "pdf-a4", "pdf-a3"} <= set(offered)
    for slug in ("pdf", "pdf-a4", "pdf-a3"):
        assert offered[slug].drawn is not None
    assert set(offered["pdf-a3"].write(PLAN, FOLD)) == {
        *("front-a3.pdf", "reverse-a3.pdf", "master-a3.pdf")
    }


def test_the_pdf_shows_what_the_svg_shows(tmp_path: Path) -> None:
    paths = svg.write(PLAN, FOLD)["master.svg"].count(b"<path")
    assert len(poppler.lines(PDF["master.pdf"], tmp_path)) == paths
    assert {work.face for work in PLAN.passes} == set(Face)


@pytest.mark.parametrize("name", ["front.pdf", "master.pdf"])
def test_the_file_is_as_it_was(name: str, golden: Golden) -> None:
    golden.check(f"hand-made/{name}.txt", plain(PDF[name]))


def plain(content: bytes) -> bytes:
    """Return a PDF's objects and operators as text, nothing packed."""
    out = BytesIO()
    with pikepdf.open(BytesIO(content)) as read:
        unpacked = pikepdf.StreamDecodeLevel.generalized
        read.save(
            out, qdf=True, static_id=True, compress_streams=False, stream_decode_level=unpacked
        )
    return out.getvalue().decode("latin-1").encode()


def test_bytes_are_the_same_in_another_process() -> None:
    code = (
        "import hashlib, hand_made as h\n"
        "from foldmill_fabricate.formats import pdf\n"
        "files = {**pdf.write(h.plan(), h.fold()), **pdf.TILED['a4'](h.plan(), h.fold())}\n"
        "print(hashlib.sha256(b''.join(files.values())).hexdigest())"
    )
    files = {**PDF, **pdf.TILED["a4"](PLAN, FOLD)}
    here = hashlib.sha256(b"".join(files.values())).hexdigest()
    paths = os.pathsep.join([str(Path(hand_made.__file__).parent), *sys.path])
    environment = {**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": "7"}
    command = [sys.executable, "-c", code]
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.strip() == here
    assert b"Date" not in PDF["front.pdf"]


def test_the_page_about_paper_names_the_steps_that_are_written() -> None:
    page = (Path(__file__).parents[3] / "docs" / "paper.md").read_text(encoding="utf-8")
    table = re.findall(r"^\| (\w+) \| (\w+) \|$", page, re.MULTILINE)
    assert dict(table) == {"lines": "type", **pdf.STEPS}
    assert set(pdf.STEPS) | {"note", "anchor"} == set(Layers.model_fields)
