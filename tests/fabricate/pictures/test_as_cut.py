"""A sheet as its record says: what is certain, in doubt and left is told apart by everybody."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from fabricate.bench import small_plan
from fabricate.half_made import PENS, job_of
from matplotlib.image import imread

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures.as_cut import CERTAIN, DOUBTFUL, LEFT, LOOKS, as_cut_picture
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, SheetRecord, State
from foldmill_fabricate.remaking import Standing, accounts, lying, read_spoken, remake
from foldmill_fabricate.remaking.strokes import owners
from foldmill_fabricate.sheet import flipped

PIXELS = tuple[int, int, int]
BLUE, ORANGE = (0x10, 0x2A, 0x80), (0xF0, 0xA0, 0x30)


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Plan:
    return job_of(tmp_path_factory.mktemp("job"), small_plan(PENS)).plan


def sheet(plan: Plan, front: Entry | None, reverse: Entry | None) -> SheetRecord:
    records = tuple(
        Record(
            "ABCD",
            number,
            Program(part.name, part.face, part.sha256, len(owners(plan, part))),
            State.INTERRUPTED if run else State.READY,
            *(0, 0, 0.0, ""),
            (run,) if run else (),
        )
        for number, (part, run) in enumerate(zip(plan.programs, (front, reverse), strict=True))
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


def test_each_kind_is_drawn_on_the_face_where_it_is(plan: Plan) -> None:
    png = as_cut_picture(plan, sheet(plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2)))
    blue, orange = (spots(png, colour) for colour in (BLUE, ORANGE))
    assert (blue[:, 1] < 0.5).any()
    assert (blue[:, 1] > 0.5).any()
    assert orange[:, 1].min() > 0.5
    grey = greys(png)
    assert (grey > 0.5).sum() > 500 + (grey < 0.5).sum()  # both have the blank's frame


def test_the_reverse_is_drawn_as_one_looks_at_it(plan: Plan) -> None:
    """A stroke in doubt on the sheet's one side lies on the other side once it is turned over."""
    record = sheet(plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    (doubt,) = [one for one in accounts(plan, record) if one.standing is Standing.DOUBTFUL]
    points = np.asarray(doubt.stroke.points)
    seen = flipped(points, plan.flip)[:, 0].mean() - plan.sheet.width / 2
    orange = spots(as_cut_picture(plan, record), ORANGE)[:, 1]
    assert abs(seen) > 10
    blank = 0.5 + 0.5 * 0.47  # its middle in the right half of the picture
    assert np.sign(orange.mean() - blank) == np.sign(seen)


def test_the_three_kinds_differ_without_colour() -> None:
    looks = {kind: LOOKS[kind] for kind in (CERTAIN, DOUBTFUL, LEFT)}
    assert len({tuple(style for _, _, style in look) for look in looks.values()}) == 3
    widest = {kind: max(width for _, width, _ in look) for kind, look in looks.items()}
    assert widest[DOUBTFUL] > 2.5 * widest[CERTAIN] > 4 * widest[LEFT]


def test_a_sheet_that_goes_on_with_another_shows_what_lay_there(plan: Plan) -> None:
    before = sheet(plan, Entry(1, 0, 0, 9, 9), Entry(1, 0, 0, 3, 2))
    rest = remake(plan, before, [read_spoken("missing")])
    assert {one.standing for one in lying(plan, before)} == {*Standing} - {Standing.HALF}
    reverse = plan.programs[1].model_copy(update={"setups": (1,)})
    rest = rest.model_copy(update={"programs": (reverse,)})
    program = Program(reverse.name, "reverse", "", len(owners(rest, reverse)))
    record = Record("EFGH", 0, program, State.READY, 0, 0, 0.0, "", ())
    after = SheetRecord("EFGH", rest.digest, "", "", "", "", (record,))
    shown = lying(rest, after)
    standings = [one.standing for one in shown]
    assert len(shown) == len(accounts(plan, before))
    assert standings.count(Standing.CERTAIN) == 9 + 2
    assert standings.count(Standing.LEFT) == 5
    assert not len(spots(as_cut_picture(rest, after), ORANGE))


def test_the_same_record_gives_the_same_bytes_and_another_jobs_is_refused(plan: Plan) -> None:
    record = sheet(plan, Entry(1, 0, 0, 4, 2), None)
    assert as_cut_picture(plan, record) == as_cut_picture(plan, record)
    other = plan.model_copy(update={"title": "Another"})
    with pytest.raises(CannotPlan, match="begun from another plan"):
        as_cut_picture(other, record)
