"""The job sheet, read back from its PDF by a reader of a dozen lines, and from its words."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import zlib
from itertools import combinations
from pathlib import Path

import hand_made
import numpy as np
import pytest

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate import jobsheet
from foldmill_fabricate.jobsheet import flip_drawing, words
from foldmill_fabricate.jobsheet.creases import groups
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures import canvas
from foldmill_plugins.tuck import DESIGN

MM = 72 / 25.4
PLAN = hand_made.plan()
STOOL = DESIGN.run(DESIGN.preset("stool-n8"))
SHEET = jobsheet.write(PLAN, STOOL)


def streams(pdf: bytes) -> list[str]:
    """Return the page contents of a PDF, in order."""
    raw = re.findall(rb"/FlateDecode.*?stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL)
    # A checksum may end with a byte that looks like the line end after it.
    texts = [zlib.decompressobj().decompress(each).decode("latin-1") for each in raw]
    return [text for text in texts if " Tf" in text]


def level_lines(content: str) -> list[tuple[float, float, float]]:
    """Return x0, x1, y of the level straight lines of a page, points."""
    pairs = re.findall(r"([\d.]+) ([\d.]+) m\n([\d.]+) ([\d.]+) l\n", content)
    lines = [tuple(map(float, pair)) for pair in pairs]
    return [(x0, x1, y0) for x0, y0, x1, y1 in lines if y0 == y1]


def said(pdf: bytes, folder: Path) -> str:
    pdftotext = shutil.which("pdftotext")
    if pdftotext is None:
        pytest.skip("pdftotext is not installed")
    (folder / "s.pdf").write_bytes(pdf)
    command = [pdftotext, "-layout", "s.pdf", "-"]
    read = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return re.sub(r"\s+", " ", read.stdout)


def test_the_sheet_has_four_pages_of_a4() -> None:
    boxes = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", SHEET)
    assert len(boxes) == 4
    for width, height in boxes:
        assert (float(width), float(height)) == pytest.approx((210 * MM, 297 * MM), abs=0.01)


def test_the_check_bar_is_100_mm_on_paper() -> None:
    inside = [line for line in level_lines(streams(SHEET)[0]) if line[2] > 5 * MM]
    bar = min(inside, key=lambda line: line[2])
    assert (bar[1] - bar[0]) / MM == pytest.approx(100, abs=0.005)


def test_the_sheet_is_the_same_in_another_process() -> None:
    code = (
        "import hashlib, hand_made as h\n"
        "from foldmill_fabricate import jobsheet\n"
        "print(hashlib.sha256(jobsheet.write(h.plan(), h.fold())).hexdigest())"
    )
    paths = os.pathsep.join([str(Path(hand_made.__file__).parent), *sys.path])
    environment = {**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": "5"}
    command = [sys.executable, "-W", "ignore", "-c", code]
    other = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    here = jobsheet.write(PLAN, hand_made.fold())
    assert other.stdout.strip() == hashlib.sha256(here).hexdigest()
    assert b"CreationDate" not in here


@pytest.mark.parametrize(
    "phrase",
    [
        "untested",
        "Pattern 0123456789ab",
        "1 FRONT through-cut 1 0.95 mm 300 gf 8 cm/s 6 1-front-holes.hpgl",
        "3 REVERSE half-cut 1 0.4 mm 240 gf 12 cm/s 2 3-reverse-score.hpgl",
        "turn the sheet over left-right as drawn below",
        "presses with 300 gf at most; cutting 0.75 mm through takes about 500 gf",
        "The 16 creases that close to 180° are single scores for now",
        "Do both passes in one session: the sheet moves by 0.01 mm/°C over 100 mm",
        "100 mm: measure it",
        "Hand-made strip, pattern 0123456789ab: page 4 of 4",
        "A mountain 108.2° × 16",
        "overfold where there is room, hold each fold",
    ],
)
def test_the_sheet_says(phrase: str, tmp_path: Path) -> None:
    assert phrase in said(SHEET, tmp_path)


def test_a_strong_and_tested_combination_is_not_warned_of() -> None:
    strong = hand_made.machine("generic-hpgl-pens", verified=True)
    tested = PLAN.material.model_copy(update={"tested": True})
    plan = hand_made.plan(strong).model_copy(update={"material": tested})
    assert words.warnings(plan, hand_made.fold().pattern) == []
    assert len(words.warnings(PLAN, STOOL.pattern)) == 3


def test_holes_are_told_as_they_lie_after_the_flip_and_on_the_machine() -> None:
    assert words.hole_rows(PLAN)[0] == ("1", "12.00, 11.00", "88.00, 11.00", "98.00, 21.00")
    over = hand_made.plan(kind="end-over-end")
    assert words.hole_rows(over)[0] == ("1", "12.00, 11.00", "12.00, 69.00", "22.00, 79.00")
    assert "holes 1 and 4 are 90.91 mm apart" in words.farthest_holes(PLAN)


@pytest.mark.parametrize(
    ("kind", "place", "stays"),
    [("left-right", "upper right", "bottom"), ("end-over-end", "lower left", "left")],
)
def test_the_witness_mark_is_where_the_flip_takes_it(kind: str, place: str, stays: str) -> None:
    plan = hand_made.plan(kind=kind)
    assert flip_drawing.where_mark_is(plan) == place
    assert f"the {stays} edge stays where it is" in flip_drawing.instruction(plan)
    assert place in flip_drawing.instruction(plan)


def test_gates_are_told_before_the_set_up_they_stand_before() -> None:
    gates = [gate for _, gate in words.setup_rows(PLAN)]
    assert gates[0].startswith("load the sheet, front up, lower left corner at x 10, y 10 mm")
    assert "stand out 0.4 mm" in gates[1]
    assert gates[2].startswith("turn the sheet over left-right")
    pens = hand_made.plan(hand_made.machine("generic-hpgl-pens"))
    assert [row[-1] for row, _ in words.setup_rows(pens)] == ["front.hpgl"] * 2 + [
        "reverse.hpgl"
    ] * 2


def test_every_crease_is_in_one_group_and_groups_fold_alike() -> None:
    found, pattern = groups(STOOL.pattern), STOOL.pattern
    listed = np.sort(np.concatenate([group.edges for group in found]))
    folds = np.isin(pattern.assignments, (Assignment.M, Assignment.V))
    assert listed.tolist() == np.flatnonzero(folds).tolist()
    for group in found:
        assert np.ptp(pattern.fold_angles[group.edges]) < 0.05
        assert set(pattern.assignments[group.edges].tolist()) == {group.assignment}
    assert [group.letter for group in found] == list("ABCDEFGHIJKLM")


def test_a_turned_and_shifted_pattern_has_the_same_groups() -> None:
    pattern, turn = STOOL.pattern, np.array([[0.8, 0.6], [-0.6, 0.8]])
    moved = CreasePattern(
        pattern.vertices @ turn + (300, -70),
        pattern.edges,
        pattern.assignments,
        pattern.fold_angles,
        pattern.faces,
    )
    for one, two in zip(groups(pattern), groups(moved), strict=True):
        assert one.edges.tolist() == two.edges.tolist()


def test_what_planning_found_is_told_once_per_kind() -> None:
    several = [
        Finding("short-crease", Severity.WARNING, f"crease {k}", "It is short.", "Fold it by hand.")
        for k in (3, 7, 9)
    ]
    quiet = Finding("unverified-machine", Severity.INFO, "x", "Not verified.")
    plan: Plan = PLAN.model_copy(update={"findings": (*several, quiet)})
    (only,) = words.findings(plan)
    assert only.startswith("crease 3: It is short.")
    assert "2 more" in only


def test_a_job_without_holes_says_what_to_do_instead(tmp_path: Path) -> None:
    plain = PLAN.model_copy(update={"holes": ()})
    text = said(jobsheet.write(plain, hand_made.fold()), tmp_path)
    assert "No registration holes: lay the sheet" in text


def test_a_job_on_one_face_speaks_of_no_second_pass(tmp_path: Path) -> None:
    single = PLAN.model_copy(update={"passes": PLAN.passes[1:], "holes": ()})
    text = said(jobsheet.write(single, hand_made.fold()), tmp_path)
    assert "the sheet is not turned over" in text
    assert "both passes" not in text
    assert "registration holes" not in text.lower()


@pytest.mark.parametrize("after", [False, True])
def test_no_words_of_the_flip_lie_upon_each_other(after: bool) -> None:
    with canvas.own_style():
        figure = canvas.figure(170, 84)
        axes = canvas.flat_axes(figure, (0.02 + 0.49 * after, 0.02, 0.47, 0.96))
        flip_drawing.draw(axes, PLAN, after=after)
        figure.draw_without_rendering()
        boxes = {text.get_text(): text.get_window_extent() for text in axes.texts}
    assert {"1", "2", "3", "4"} < set(boxes)
    for (one, a), (two, b) in combinations(boxes.items(), 2):
        assert not a.overlaps(b), (one, two)
