"""Whatever is wrong with a file, a person gets one sentence, and never a traceback."""

from __future__ import annotations

import random
from contextlib import suppress
from pathlib import Path

import pytest

from foldmill import UnreadableFile
from foldmill.errors import FoldmillError, InvalidInput
from foldmill.exchange.limits import Limits
from foldmill.exchange.options import Options, named
from foldmill_fabricate.importing import read_pattern

SAMPLES = Path(__file__).parents[2] / "samples"
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
FRAME = '<rect width="100" height="100" fill="none" stroke="black"/>'


def svg(body: str, frame: str = FRAME, head: str = HEAD) -> bytes:
    return f"{head}{frame}{body}</svg>".encode()


def path(data: str, style: str = 'stroke="red"') -> bytes:
    return svg(f'<path d="{data}" {style}/>')


def dxf(*entities: str) -> bytes:
    rows = ["0", "SECTION", "2", "ENTITIES", *" ".join(entities).split(), "0", "ENDSEC", "0", "EOF"]
    return "\n".join(rows).encode()


def line(a: tuple[float, float], b: tuple[float, float], colour: int) -> str:
    return f"0 LINE 8 0 62 {colour} 10 {a[0]} 20 {a[1]} 30 0 11 {b[0]} 21 {b[1]} 31 0"


BOX = [((0, 0), (9, 0)), ((9, 0), (9, 9)), ((9, 9), (0, 9)), ((0, 9), (0, 0))]
SQUARE = [line(a, b, 7) for a, b in BOX]
FOLD = '{"frame_unit": "mm", "vertices_coords": [[0,0],[9,0],[0,9]], "edges_vertices": %s, %s}'
LAUGHS = (
    '<!DOCTYPE svg [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;">]>'
    "<svg><text>&c;</text></svg>"
)
OUTSIDE = '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg><text>&a;</text></svg>'

MALFORMED: dict[str, tuple[str, bytes, str]] = {
    # curves that would be missing without a word
    "an ellipse nowhere": (
        "x.dxf",
        dxf(*SQUARE, "0 ELLIPSE 8 0 62 1 10 nan 20 1 11 1 21 0 40 1 41 0 42 6"),
        "coordinates of an entity ELLIPSE",
    ),
    "an arc beyond all numbers": (
        "x.dxf",
        dxf(*SQUARE, "0 ARC 8 0 62 1 10 1 20 1 40 1e300 50 0 51 90"),
        "coordinates of an entity ARC",
    ),
    # XML
    "an empty file": ("x.svg", b"", "is empty"),
    "spaces only": ("x.svg", b" \n ", "is empty"),
    "a picture by another name": ("x.svg", b"\x89PNG\r\n\x1a\n", "picture of pixels"),
    "an open element": ("x.svg", b"<svg><g>", "no element found at line 1"),
    "crossed elements": ("x.svg", b"<svg><g></svg></g>", "mismatched tag"),
    "two roots": ("x.svg", b"<svg/><svg/>", "junk after document element"),
    "laughs by the billion": ("x.svg", LAUGHS.encode(), "declarations of its own"),
    "an entity from outside": ("x.svg", OUTSIDE.encode(), "declarations of its own"),
    "an unknown encoding": ("x.svg", b'<?xml version="1.0" encoding="klingon"?><svg/>', "unknown"),
    "bytes that are no text": ("x.svg", b"<svg>\xff\xfe\xff</svg>", "not well-formed"),
    "a web page": ("x.svg", b"<html><body/></html>", "this one with <html>"),
    "depth without end": ("x.svg", b"<svg>" + b"<g>" * 9999, "more than 200 deep"),
    # SVG
    "no line": ("x.svg", svg("", ""), "no lines"),
    "no stroke": ("x.svg", svg("", '<rect width="9" height="9"/>'), "no lines"),
    "a path that breaks off": ("x.svg", path("M 0 0 L 100"), "breaks off at 'its end'"),
    "a path of words": ("x.svg", path("M 0 0 L ten ten"), "breaks off at 'ten ten'"),
    "a path from nowhere": ("x.svg", path("10 10 L 0 0"), "breaks off at '10 10"),
    "a path to nan": ("x.svg", path("M 0 0 L nan 0"), "breaks off at 'nan 0'"),
    "a path to infinity": ("x.svg", path("M 0 0 L 1e999 0"), "beyond a billion"),
    "an ellipse whose rim is beyond all numbers": (
        "x.svg",
        svg('<ellipse rx="1e308" ry="1e308" cx="1e308" stroke="red"/>'),
        "within a billion",
    ),
    "an arc with a flag of 2": ("x.svg", path("M 0 0 A 5 5 0 2 1 9 9"), "breaks off"),
    "an unknown transform": (
        "x.svg",
        svg('<g transform="wobble(3)"><path d="M0 0L9 9" stroke="red"/></g>'),
        "The transform 'wobble(3)'",
    ),
    "a matrix of five": ("x.svg", svg('<g transform="matrix(1 0 0 1 0)"/>'), "The transform"),
    "a rotation by words": ("x.svg", svg('<g transform="rotate(left)"/>'), "what is no number"),
    "odd points": (
        "x.svg",
        svg('<polyline points="0 0 5" stroke="red"/>'),
        "odd count of numbers",
    ),
    "a share of a page": ("x.svg", svg('<line x2="50%" stroke="red"/>'), "is in %"),
    "a length of words": ("x.svg", svg('<circle r="big" stroke="red"/>'), "is no length"),
    "clones": ("x.svg", svg('<use href="#a"/>'), "sets in 'a' (<use>), which is not in it"),
    "an unknown colour": ("x.svg", path("M0 0L100 100", 'stroke="orange"'), "--as '#ffa500=M'"),
    "a painted stroke": ("x.svg", path("M0 0L100 100", 'stroke="url(#a)"'), "--as"),
    "a line that ends inside": ("x.svg", path("M0 0L50 60"), "--loose drop"),
    "an open outline": (
        "x.svg",
        svg("", '<path d="M0 0H90V90H10" stroke="black"/>'),
        "the outline is open",
    ),
    "a sheet and another": (
        "x.svg",
        svg('<rect x="200" width="50" height="50" stroke="black"/>'),
        "2 groups that do not touch",
    ),
    "an ornament that floats": (
        "x.svg",
        svg('<rect x="20" y="20" width="5" height="5" stroke="red"/>'),
        "2 groups that do not touch",
    ),
    "two folds in one place": (
        "x.svg",
        svg('<path d="M0 0L100 100" stroke="red"/><path d="M100 100L0 0" stroke="blue"/>'),
        "lie upon each other at (50, 50) mm",
    ),
    "a part that hangs by a point": (
        "x.svg",
        svg('<path d="M0 0L-20 -20L-30 -10Z" stroke="black"/>'),
        "2 parts that hang on each other by points or lines only",
    ),
    "a page of nothing": (
        "x.svg",
        svg("", '<path d="M0 0L1e-4 0L0 1e-4Z" stroke="black"/>'),
        "0.0001 mm wide",
    ),
    # DXF
    "words for a drawing": ("x.dxf", b"hello", "it has no section"),
    "a binary drawing": ("x.dxf", b"AutoCAD Binary DXF\r\n\x1a\x00\x00", "breaks off after 0"),
    "a PDF": ("x.svg", b"%PDF-1.7", "This is a PDF"),
    "a DWG": ("x.dxf", b"AC1027", "Save it as DXF"),
    "a compressed drawing": ("x.svgz", b"\x1f\x8b\x08", "plain SVG"),
    "an archive": ("x", b"PK\x03\x04", "Unpack it"),
    "a binary drawing of nothing": ("x.dxf", b"AutoCAD Binary DXF\r\n\x1a\x00", "no section"),
    "a drawing without lines": ("x.dxf", dxf(), "no lines"),
    "a line in space": (
        "x.dxf",
        dxf(*SQUARE, "0 LINE 8 0 62 1 10 0 20 0 30 0 11 9 21 9 31 5"),
        "not flat: its heights differ by 5",
    ),
    "a line of no known colour": ("x.dxf", dxf(*SQUARE, line((0, 0), (9, 9), 30)), "--as '#ff7f00"),
    # FOLD
    "no JSON": ("x.fold", b"{", "This is no JSON"),
    "a list": ("x.fold", b"[1, 2]", "A FOLD file is a JSON object"),
    "not a number": ("x.fold", b'{"vertices_coords": [[NaN, 0]]}', "NaN is no number"),
    "brackets without end": ("x.fold", b'{"a":' + b"[" * 99999, "nested too deeply"),
    "frames that are none": ("x.fold", b'{"file_frames": 3}', "file_frames must be a list"),
    "a letter of nobody": (
        "x.fold",
        (FOLD % ("[[0,1],[1,2],[2,0]]", '"edges_assignment": ["B","B","X"]')).encode(),
        "The assignment of edge 2 is 'X'",
    ),
    "an edge to nowhere": (
        "x.fold",
        (FOLD % ("[[0,1],[1,7]]", '"edges_assignment": ["B","B"]')).encode(),
        "names the vertex 7",
    ),
    # CP and OPX
    "a line of four words": ("x.cp", b"1 0 0 5\n", "Line 1 must be a type"),
    "a place that is none": ("x.cp", b"1 0 0 nan 5\n", "line 1 are not all numbers"),
    "a bean of another kind": ("x.opx", b"<beans/>", "begins with <java>, this one with <beans>"),
    # what no suffix tells
    "a song": ("x.mp3", b"ID3\x04", "no crease pattern that can be read"),
}


@pytest.mark.parametrize("what", MALFORMED)
def test_a_malformed_file_is_refused_with_a_sentence(what: str) -> None:
    name, content, said = MALFORMED[what]
    with pytest.raises(UnreadableFile) as refused:
        read_pattern(content, name=name)
    sentence = str(refused.value)
    assert sentence.startswith(f"{name}: ")
    assert said in sentence
    assert sentence.endswith(".")
    assert "\n" not in sentence


@pytest.mark.parametrize("name", ["os_crane-opacity-angles.svg", "ff_pinwheel.opx"])
def test_a_file_that_breaks_off_or_is_garbled_is_read_or_refused(name: str) -> None:
    content = (SAMPLES / name).read_bytes()
    chance = random.Random(name)
    for _ in range(30):
        at = chance.randrange(len(content))
        garbled = bytearray(content)
        garbled[at : at + chance.randrange(9)] = chance.randbytes(chance.randrange(9))
        for each in (content[:at], bytes(garbled)):
            with suppress(FoldmillError):  # anything else is a traceback
                read_pattern(each, name=name)


def test_a_garbled_drawing_of_lines_is_read_or_refused() -> None:
    content = dxf(*SQUARE, line((0, 0), (9, 9), 1))
    chance = random.Random(1)
    for _ in range(15):
        at = chance.randrange(len(content))
        garbled = content[:at] + chance.randbytes(3) + content[at + chance.randrange(9) :]
        with suppress(FoldmillError):
            read_pattern(garbled, name="x.dxf")


def nested_blocks(depth: int, each: int) -> bytes:
    """Return a DXF of a block that holds a block that holds a block, each several times."""
    from io import StringIO

    from ezdxf.filemanagement import new

    document = new("R2000")
    inner = document.blocks.new("B0")
    inner.add_line((0, 0), (1, 1))
    for k in range(1, depth):
        block = document.blocks.new(f"B{k}")
        for n in range(each):
            block.add_blockref(f"B{k - 1}", (n, 0))
    document.modelspace().add_blockref(f"B{depth - 1}", (0, 0))
    out = StringIO()
    document.write(out)
    return out.getvalue().encode()


SMALL = Limits(size=20_000, lines=50, elements=100, depth=10)
TOO_LARGE: dict[str, tuple[str, bytes, str]] = {
    "bytes": ("x.svg", b"<svg>" + b" " * 30_000, "has 0.0 MB; at most"),
    "lines of CP": ("x.cp", b"1 0 0 1 1\n" * 60, "more than 50 lines"),
    "pieces of a path": ("x.svg", path("M0 0" + "h1" * 60), "more than 50 pieces"),
    "elements": ("x.svg", svg("<g/>" * 200), "more than 100 elements"),
    "depth": ("x.svg", svg("<g>" * 20 + "</g>" * 20), "more than 10 deep"),
    "entities": ("x.dxf", dxf(*[line((0, k), (1, k), 1) for k in range(200)]), "100 elements"),
    "edges": (
        "x.fold",
        (FOLD % ("[" + "[0,1]," * 60 + "[0,1]]", '"a:b": 1')).encode(),
        "more than 50 lines",
    ),
}


@pytest.mark.parametrize("what", TOO_LARGE)
def test_a_file_above_a_bound_is_refused(what: str) -> None:
    name, content, said = TOO_LARGE[what]
    with pytest.raises(UnreadableFile, match=said):
        read_pattern(content, name=name, limits=SMALL)


def test_blocks_within_blocks_are_counted_before_they_are_set_in() -> None:
    with pytest.raises(UnreadableFile, match="more than 500,000 elements"):
        read_pattern(nested_blocks(9, 20), name="x.dxf")  # 20⁸ lines


def test_a_file_larger_than_the_bound_is_not_even_read(tmp_path: Path) -> None:
    big = tmp_path / "big.fold"
    with big.open("wb") as file:
        file.truncate(10**12)  # a terabyte, of which the disk holds nothing
    with pytest.raises(UnreadableFile, match="at most 64 MB are read"):
        read_pattern(big)


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"scale": 0.0}, "--scale must be a positive number"),
        ({"width": float("nan")}, "--width must be a positive number"),
        ({"gap": -1.0}, "--gap must be a positive number"),
        ({"unit": "ell"}, "--unit: there is no 'ell'"),
        ({"side": "left"}, "--side: there is no 'left'"),
        ({"by": "shape"}, "--by: there is no 'shape'"),
        ({"width": 5.0, "unit": "mm"}, "--width says it all"),
        ({"named": {"red": "Q"}}, "--as red: there is no 'Q'"),
    ],
)
def test_an_option_that_means_nothing_is_refused_by_name(
    said: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InvalidInput, match=sentence):
        Options(**said)  # type: ignore[arg-type]


def test_as_takes_a_name_and_a_letter() -> None:
    assert named(["#ff8800=m", "my=layer=V", "other=SKIP"]) == {
        "#ff8800": "M",
        "my=layer": "V",
        "other": "skip",
    }
    for wrong in ("red", "=M"):
        with pytest.raises(InvalidInput, match="--as takes a colour or layer"):
            named([wrong])
