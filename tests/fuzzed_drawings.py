"""SVG and DXF that nobody should send: bombs, loops, numbers that are none, depth without end."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

Chance = random.Random
_SAMPLES = Path(__file__).parent / "samples"
_ODD = [
    "nan",
    "NaN",
    "inf",
    "-Infinity",
    "1e400",
    "-1e308",
    "1e-320",
    "1" * 400,
    "",
    "-",
    "0x1",
    "5%",
]
_COLOURS = [
    "red",
    "blue",
    "black",
    "#ff0000",
    "lime",
    "none",
    "url(#a)",
    "rgb(0,0,999)",
    "currentColor",
]
_HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
)
_FRAME = '<rect width="100" height="100" fill="none" stroke="black"/>'


def svg(chance: Chance) -> bytes:
    """Return an SVG file that is likely wrong."""
    return chance.choice(_SVG)(chance)


def dxf(chance: Chance) -> bytes:
    """Return a DXF file that is likely wrong."""
    return chance.choice(_DXF)(chance)


def spoiled(chance: Chance, content: bytes) -> bytes:
    """Return a file with some bytes changed, cut short or written twice."""
    found = bytearray(content)
    for _ in range(chance.randint(1, 12)):
        at = chance.randrange(len(found))
        kind = chance.randrange(4)
        if kind == 0:
            del found[at : at + chance.randrange(40)]
        elif kind == 1:
            found[at:at] = found[at : at + chance.randrange(200)]
        else:
            found[at] = chance.randrange(256)
        if not found:
            return b""
    return bytes(found[: chance.choice([len(found), len(found), chance.randrange(len(found) + 1)])])


def _drawn(body: str, head: str = _HEAD) -> bytes:
    return f"{head}{_FRAME}{body}</svg>".encode()


def _svg_spoiled(chance: Chance) -> bytes:
    names = ["os_simpleVertex.svg", "os_waterbomb.svg", "os_crane-opacity-angles.svg"]
    return spoiled(chance, (_SAMPLES / chance.choice(names)).read_bytes())


def _svg_entities(chance: Chance) -> bytes:
    width, depth = chance.choice([2, 10, 1000]), chance.choice([1, 3, 40])
    entities = "".join(
        f'<!ENTITY e{k} "{f"&e{k - 1};" * width}">' if k else '<!ENTITY e0 "ha">'
        for k in range(depth)
    )
    outside = '<!ENTITY % x SYSTEM "file:///etc/passwd"> %x;'
    kind = chance.choice([entities, outside, f'<!ENTITY e0 "{"x" * 100_000}">'])
    text = f"&e{depth - 1};" * chance.choice([1, 5000])
    return f"<!DOCTYPE svg [{kind}]>{_HEAD}<text>{text}</text></svg>".encode()


def _svg_nested(chance: Chance) -> bytes:
    depth = chance.choice([50, 190, 250, 20_000, 1_000_000])
    inner = '<line x2="100" y2="100" stroke="red"/>'
    closed = "</g>" * chance.choice([depth, 0])
    return _drawn("<g>" * depth + inner + closed)


def _svg_odd(chance: Chance) -> bytes:
    n = [str(chance.randint(0, 100)) for _ in range(8)]
    n[chance.randrange(8)] = chance.choice(_ODD)
    shapes = [
        f'<line x1="{n[0]}" y1="{n[1]}" x2="{n[2]}" y2="{n[3]}" stroke="red"/>',
        f'<path d="M{n[0]} {n[1]}C{n[2]} {n[3]} {n[4]} {n[5]} {n[6]} {n[7]}" stroke="red"/>',
        f'<path d="M{n[0]} {n[1]}A{n[2]} {n[3]} {n[4]} 1 0 {n[5]} {n[6]}" stroke="red"/>',
        f'<g transform="matrix({",".join(n[:6])})"><path d="M0 0L100 100" stroke="red"/></g>',
        f'<g transform="rotate({n[0]} {n[1]}) scale({n[2]})"><path d="M0 0L9 9" stroke="red"/></g>',
        f'<polyline points="{" ".join(n)}" stroke="red"/>',
        f'<ellipse rx="{n[0]}" ry="{n[1]}" cx="{n[2]}" stroke="red"/>',
    ]
    head = _HEAD.replace("0 0 100 100", " ".join(n[:4])) if chance.random() < 0.3 else _HEAD
    return _drawn(chance.choice(shapes), head)


def _svg_many(chance: Chance) -> bytes:
    count = chance.choice([900] * 40 + [20_000, 250_000])
    kinds = [
        '<line x2="9" y2="9" stroke="red"/>' * count,
        f'<path stroke="red" d="M0 0{"L9 9L0 9" * count}"/>',
        f'<path stroke="red" d="M0 0{"C1 90 90 1 99 99" * (count // 90)}"/>',
        '<circle r="1e9" stroke="red"/>' * (count // 99),
        f'<style>{".a{stroke:red}" * count}</style><path class="a" d="M0 0L100 100"/>',
        f'<path class="{"a " * count}" d="M0 0L100 100" stroke="red"/>',
    ]
    return _drawn(chance.choice(kinds))


def _svg_crossing(chance: Chance) -> bytes:
    count = chance.choice([5, 9, 9, 9, 20, 40])
    rows = []
    for _ in range(count):
        x, y, u, v = (chance.uniform(0, 100) for _ in range(4))
        colour = chance.choice(_COLOURS[:3])
        rows.append(f'<line x1="{x}" y1="{y}" x2="{u}" y2="{v}" stroke="{colour}"/>')
    return _drawn("".join(rows))


def _svg_strange(chance: Chance) -> bytes:
    doubled = "".join(
        f'<g id="a{k}"><use href="#a{k - 1}"/><use href="#a{k - 1}"/></g>' for k in range(1, 40)
    )
    style = f'stroke="{chance.choice(_COLOURS)}"'
    whole = _drawn(f'<path d="M0 0L100 100" {style}/>')
    return chance.choice(
        [
            _drawn(f'<path id="a0" d="M0 0L9 9" {style}/>{doubled}'),
            _drawn('<use id="a" href="#a"/>'),
            b"\x1f\x8b" + whole,
            whole.decode().encode("utf-16"),
            b'<?xml version="1.0" encoding="klingon"?>' + whole,
            b"\xef\xbb\xbf" + whole,
            whole.replace(b"<path", b'<image href="file:///etc/passwd"/><path'),
            whole.replace(b"100mm", b"1e9km"),
        ]
    )


def _section(*entities: str) -> bytes:
    rows = ["0", "SECTION", "2", "ENTITIES", *" ".join(entities).split(), "0", "ENDSEC", "0", "EOF"]
    return "\n".join(rows).encode()


def _line(x: object, y: object, u: object, v: object, colour: int = 7) -> str:
    return f"0 LINE 8 0 62 {colour} 10 {x} 20 {y} 30 0 11 {u} 21 {v} 31 0"


_BENT = "0 LWPOLYLINE 100 AcDbEntity 8 0 62 1 100 AcDbPolyline"
_SPLINE = "0 SPLINE 100 AcDbEntity 8 0 62 1 100 AcDbSpline"
_BOX = [_line(0, 0, 9, 0), _line(9, 0, 9, 9), _line(9, 9, 0, 9), _line(0, 9, 0, 0)]


def _dxf_spoiled(chance: Chance) -> bytes:
    whole = _section(*_BOX, _line(0, 0, 9, 9, 1), "0 ARC 8 0 62 5 10 4 20 4 40 2 50 0 51 90")
    return spoiled(chance, whole)


def _dxf_odd(chance: Chance) -> bytes:
    n = [str(chance.randint(0, 9)) for _ in range(6)]
    n[chance.randrange(6)] = chance.choice([each for each in _ODD if each])
    kinds = [
        _line(n[0], n[1], n[2], n[3], 1),
        f"0 ARC 8 0 62 1 10 {n[0]} 20 {n[1]} 40 {n[2]} 50 {n[3]} 51 {n[4]}",
        f"0 CIRCLE 8 0 62 1 10 {n[0]} 20 {n[1]} 40 {n[2]}",
        f"0 ELLIPSE 8 0 62 1 10 {n[0]} 20 {n[1]} 11 {n[2]} 21 {n[3]} 40 {n[4]} 41 0 42 {n[5]}",
        f"{_BENT} 90 2 70 1 10 {n[0]} 20 {n[1]} 42 {n[2]} 10 {n[3]} 20 {n[4]}",
        f"{_SPLINE} 70 8 71 {n[0]} 72 8 73 4 40 0 40 {n[1]} 10 {n[2]} 20 {n[3]} 10 9 20 9",
    ]
    return _section(*_BOX, chance.choice(kinds))


def _dxf_blocks(chance: Chance) -> bytes:
    """Return blocks within blocks, each several times, or within themselves."""
    depth, times = chance.choice([2, 20, 200]), chance.choice([1, 2, 30_000])
    rows = f"70 {times} 71 {times} 44 1 45 1"
    blocks = []
    for k in range(depth):
        below = chance.choice([k - 1, k - 1, k - 1, k]) if k else 0
        inner = f"0 INSERT 8 0 2 B{below} 10 0 20 0 {rows}" if k else _line(0, 0, 9, 9, 1)
        twice = inner if times > 2 else f"{inner} {inner}"
        blocks.append(f"0 BLOCK 8 0 2 B{k} 10 0 20 0 {twice} 0 ENDBLK 8 0")
    head = f"0 SECTION 2 BLOCKS {' '.join(blocks)} 0 ENDSEC".split()
    body = _section(*_BOX, f"0 INSERT 8 0 2 B{depth - 1} 10 0 20 0 {rows}")
    return "\n".join(head).encode() + b"\n" + body


def _dxf_many(chance: Chance) -> bytes:
    count = chance.choice([400] * 40 + [2_000, 20_000, 600_000])
    kinds = [
        "0\nLINE\n" * count,
        f"{_BENT} 90 {count} 70 0 {'10 1 20 2 10 3 20 4 ' * (count // 4)}",
        "0 CIRCLE 8 0 62 1 10 4 20 4 40 1e6 " * (count // 40),
        f"{_SPLINE} 71 3 73 {count} {'10 1 20 2 30 0 ' * (count // 9)}",
        "0 TEXT 8 0 1 " + "x" * count,
    ]
    return _section(*_BOX, chance.choice(kinds))


def _dxf_strange(chance: Chance) -> bytes:
    whole = _section(*_BOX, _line(0, 0, 9, 9, 1))
    head = b"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n%d\n9\n$ACADVER\n1\n%s\n0\nENDSEC\n"
    told = head % (
        chance.choice([-1, 0, 4, 99]),
        chance.choice([b"AC1009", b"AC1032", b"AC9999", b"x"]),
    )
    return chance.choice(
        [
            told + whole,
            b"AutoCAD Binary DXF\r\n\x1a\x00" + chance.randbytes(200),
            whole.replace(
                b"LINE", chance.choice([b"WIPEOUT", b"3DSOLID", b"HATCH", b"IMAGE", b"\xff"])
            ),
            whole.replace(b"\n", b"\r"),
            whole.replace(b"\n", b"\n\n"),
            whole.replace(b"0\nEOF", b""),
            b"0\nSECTION\n2\nENTITIES\n" + b"102\n{ACAD\n" * 5_000 + b"0\nENDSEC\n0\nEOF\n",
            b"0\nSECTION\n2\n" + chance.randbytes(300),
            b"999\n" + b"x" * 1_000_000 + b"\n" + whole,
        ]
    )


_SVG: list[Callable[[Chance], bytes]] = [
    _svg_spoiled,
    _svg_spoiled,
    _svg_entities,
    _svg_nested,
    _svg_odd,
    _svg_odd,
    _svg_many,
    _svg_crossing,
    _svg_strange,
]
_DXF: list[Callable[[Chance], bytes]] = [
    _dxf_spoiled,
    _dxf_spoiled,
    _dxf_odd,
    _dxf_odd,
    _dxf_blocks,
    _dxf_many,
    _dxf_strange,
]
