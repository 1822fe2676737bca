"""A sheet as its record says: what is certain, in doubt and left is told apart by everybody."""

from __future__ import annotations

import re
from collections import Counter
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from fabricate.bench import small_plan
from fabricate.half_made import KNIFE, LASER, ONE_TOOL, PENS, job_of
from matplotlib.image import imread

from foldmill_fabricate.as_cut import Kind, as_cut
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.pictures.as_cut import LOOKS, as_cut_picture
from foldmill_fabricate.pictures.as_cut_svg import as_cut_svg
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, SheetRecord, State
from foldmill_fabricate.remaking import Standing, accounts, read_spoken, remake
from foldmill_fabricate.remaking.strokes import owners
from foldmill_fabricate.sending import Job
from foldmill_fabricate.sheet import flipped

PIXELS = tuple[int, int, int]
OVERCUT = 1.0
"""mm that a closed stroke may go on beyond its start, and a blade turns round it"""
BLUE, ORANGE = (0x10, 0x2A, 0x80), (0xF0, 0xA0, 0x30)


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return job_of(tmp_path_factory.mktemp("job"), small_plan(PENS))


@pytest.fixture(scope="module")
def plan(job: Job) -> Plan:
    return job.plan


def picture(job: Job, front: Entry | None, reverse: Entry | None) -> bytes:
    return as_cut_picture(job.plan, job.programs, sheet(job.plan, front, reverse))


def sheet(plan: Plan, *runs: Entry | None) -> SheetRecord:
    records = tuple(
        Record(
            "ABCD",
            number,
            Program(part.name, part.face, part.sha256, len(owners(plan, part))),
            State.INTERRUPTED if run else State.READY,
            *(0, 0, 0.0, ""),
            (run,) if run else (),
        )
        for number, (part, run) in enumerate(zip(plan.programs, runs, strict=True))
    )
    return SheetRecord("ABCD", plan.digest, plan.title, "", "", "", records)


def spots(png: bytes, colour: PIXELS) -> np.ndarray:
    """Return where a drawing has this colour, (row, column) as shares; its legend left out."""
    image = np.round(imread(BytesIO(png))[..., :3] * 255).astype(int)
    rows = int(0.88 * len(image))
    found: np.ndarray = np.argwhere((image[:rows] == colour).all(axis=-1)) / image.shape[:2]
    return found


def greys(png: bytes) -> np.ndarray:
    """Return the columns, as shares, of grey spots on the sheets: dots, and their soft edges."""
    image = np.round(imread(BytesIO(png))[..., :3] * 255).astype(int)
    rows = image[int(0.2 * len(image)) : int(0.8 * len(image))]
    is_grey = (np.ptp(rows, axis=-1) == 0) & (rows[..., 0] > 0x68) & (rows[..., 0] < 0xE8)
    columns: np.ndarray = np.argwhere(is_grey)[:, 1] / image.shape[1]
    return columns


def test_each_kind_is_drawn_on_the_face_where_it_is(job: Job) -> None:
    png = picture(job, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    blue, orange = (spots(png, colour) for colour in (BLUE, ORANGE))
    assert (blue[:, 1] < 0.5).any()
    assert (blue[:, 1] > 0.5).any()
    assert orange[:, 1].min() > 0.5
    grey = greys(png)
    assert (grey > 0.5).sum() > 500 + (grey < 0.5).sum()  # both have the blank's frame


def test_the_reverse_is_drawn_as_one_looks_at_it(job: Job, plan: Plan) -> None:
    """A stroke in doubt on the sheet's one side lies on the other side once it is turned over."""
    record = sheet(plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    (doubt,) = [one for one in accounts(plan, record) if one.standing is Standing.DOUBTFUL]
    points = np.asarray(doubt.stroke.points)
    seen = flipped(points, plan.flip)[:, 0].mean() - plan.sheet.width / 2
    orange = spots(as_cut_picture(plan, job.programs, record), ORANGE)[:, 1]
    assert abs(seen) > 10
    blank = 0.5 + 0.5 * 0.47  # its middle in the right half of the picture
    assert np.sign(orange.mean() - blank) == np.sign(seen)


def test_the_three_kinds_differ_without_colour() -> None:
    looks = {kind: LOOKS[kind] for kind in Kind}
    assert len({tuple(style for _, _, style in look) for look in looks.values()}) == 3
    widest = {kind: max(width for _, width, _ in look) for kind, look in looks.items()}
    assert widest[Kind.DOUBTFUL] > 2.5 * widest[Kind.CERTAIN] > 4 * widest[Kind.LEFT]


def test_a_sheet_that_goes_on_with_another_shows_what_lay_there(plan: Plan) -> None:
    was = sheet(plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    rest = remake(plan, was, [read_spoken("missing")])
    reverse = plan.programs[1].model_copy(update={"setups": (1,)})
    rest = rest.model_copy(update={"programs": (reverse,)})
    program = Program(reverse.name, "reverse", "", len(owners(rest, reverse)))
    record = Record("EFGH", 0, program, State.READY, 0, 0, 0.0, "", ())
    after = SheetRecord("EFGH", rest.digest, "", "", "", "", (record,))
    written = {reverse.name: hpgl.program(rest, [1])}
    shown = [line for face in as_cut(rest, written, after) for line in face.lines]
    assert Counter(line.kind for line in shown) == {Kind.CERTAIN: 9 + 2, Kind.LEFT: 5}
    assert not len(spots(as_cut_picture(rest, written, after), ORANGE))


@pytest.mark.parametrize("machine", [PENS, ONE_TOOL, KNIFE, LASER])
def test_what_the_programs_drew_is_what_the_plan_says_of_each_stroke(
    machine: str, tmp_path: Path
) -> None:
    """Two ways to one drawing: bytes read back, and strokes of the plan with their owners."""
    job = job_of(tmp_path, small_plan(machine))
    runs = [Entry(1, 0, 0, 3, 2)] * len(job.plan.programs)
    record = sheet(job.plan, *runs)
    allowed = job.plan.machine.tools.blade_offset + 2 / job.plan.machine.axes.units_per_mm
    ways = {face.face: face for face in as_cut(job.plan, job.programs, record)}
    found = accounts(job.plan, record)
    assert any(each.standing is Standing.DOUBTFUL for each in found)
    for each in found:
        points = np.asarray(each.stroke.points)
        seen = flipped(points, job.plan.flip) if each.face is Face.REVERSE else points
        part = job.plan.programs[each.program].name
        for number, standing in each.standings.items():
            (line,) = [
                line
                for line in ways[each.face].lines
                if (line.program, line.number) == (part, number + 1)
            ]
            assert line.kind.value == standing.value
            drawn, meant = shapely.LineString(line.points), shapely.LineString(seen)
            assert shapely.hausdorff_distance(drawn, meant) <= allowed + OVERCUT
            if machine != KNIFE:  # the holder goes back another way than there
                assert drawn.length <= meant.length + OVERCUT, "repeats are left out"


def test_an_svg_has_each_stroke_in_the_group_of_its_kind_and_names_what_is_in_doubt(
    job: Job,
) -> None:
    record = sheet(job.plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    front, reverse = as_cut(job.plan, job.programs, record)
    groups = dict(re.findall(r'<g id="(\w+)".*?>(.*?)</g>', as_cut_svg(reverse, "a & b").decode()))
    assert [*groups] == ["left", "certain", "doubtful"]
    drawn = {name: content.count("<path") for name, content in groups.items()}
    assert drawn == {kind.value: len(reverse.of(kind)) for kind in Kind}
    assert drawn["doubtful"] == 1
    assert f"<title>{job.plan.programs[1].name}: 3</title>" in groups["doubtful"]
    root = ElementTree.fromstring(as_cut_svg(front, "a & b"))
    assert root.findtext("{http://www.w3.org/2000/svg}title") == "a & b"
    assert root.attrib["width"] == f"{job.plan.sheet.width:g}mm"


def test_the_same_record_gives_the_same_bytes_and_another_jobs_is_refused(job: Job) -> None:
    assert picture(job, Entry(1, 0, 0, 4, 2), None) == picture(job, Entry(1, 0, 0, 4, 2), None)
    other = job.plan.model_copy(update={"title": "Another"})
    record = sheet(job.plan, Entry(1, 0, 0, 4, 2), None)
    with pytest.raises(CannotPlan, match="begun from another plan"):
        as_cut_picture(other, job.programs, record)


def test_programs_that_were_written_anew_are_told_from_those_that_were_begun(job: Job) -> None:
    name = job.plan.programs[0].name
    shorter = {**job.programs, name: b"IN;SP1;PU0,0;PD400,0;PU;SP0;"}
    with pytest.raises(CannotPlan, match="had 9 when sheet ABCD was begun"):
        as_cut(job.plan, shorter, sheet(job.plan, None, None))
