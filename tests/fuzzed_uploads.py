"""Files that nobody should send: broken, huge, nested, lying; the same ones for the same seed."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import fuzzed_drawings
import fuzzed_hpgl
from services import square

Chance = random.Random
Frame = dict[str, Any]
HPGL = "hpgl"
_SAMPLES = Path(__file__).parent / "samples"


class Sent(NamedTuple):
    """A file, what it is said to be, and what is said beside it."""

    form: str
    """fold, svg, dxf, cp, opx or hpgl"""
    content: bytes
    words: dict[str, Any]


def sent(seed: int) -> Sent:
    """Return what is sent of a seed; one in twelve is something else than is said."""
    chance = random.Random(seed)
    form = chance.choices([*_FORMS], [weight for weight, _ in _FORMS.values()])[0]
    content = chance.choice(_FORMS[form][1])(chance)
    if chance.random() < 1 / 12:
        form = chance.choice([*_FORMS])
    return Sent(form, content, _words(chance, form, content))


def otherwise(seed: int) -> Sent:
    """Return the same file, said to be something else."""
    chance = random.Random(seed)
    form, content, _ = sent(seed)
    other = chance.choice([each for each in _FORMS if each != form])
    return Sent(other, content, _words(chance, other, content))


def _words(chance: Chance, form: str, content: bytes) -> dict[str, Any]:
    if form == HPGL:
        uses = ["score", "inner", "cut", "cut", "skip"]
        pens = [*map(int, dict.fromkeys(re.findall(rb"SP([1-9])", content)))] or [1]
        said = [f"{pen}={chance.choice(uses)}" for pen in pens if chance.random() < 0.97]
        blank = chance.choice([{}, {}, {"blank": [450.0, 400.0]}, {"blank": [2000.0, 0.5]}])
        machine = chance.choice(["generic-hpgl-600", "generic-hpgl-pens", "grbl-drag-knife"])
        return {"material": "pp-0.75", "machine": machine, "pen": said, **blank}
    sized: dict[str, Any] = chance.choice([{}, {"width": 100.0}, {"scale": 0.001}])
    mended: dict[str, Any] = chance.choice([{}, {}, {"planarise": True}, {"loose": "drop"}])
    return {**sized, **mended}


def _text(frame: Frame) -> bytes:
    return json.dumps(frame).encode()


def _flipped(chance: Chance) -> bytes:
    content = bytearray(_text(square()))
    for _ in range(chance.randint(1, 12)):
        content[chance.randrange(len(content))] = chance.randrange(256)
    return bytes(content)


def _cut(chance: Chance) -> bytes:
    content = _text(square())
    return content[: chance.randrange(len(content))]


def _noise(chance: Chance) -> bytes:
    return chance.randbytes(chance.randrange(2000))


def _nested(chance: Chance) -> bytes:
    depth = chance.choice([50, 2_000, 200_000])
    return b'{"vertices_coords":' + b"[" * depth + b"]" * depth + b"}"


def _odd_number(chance: Chance) -> bytes:
    odd = chance.choice(["NaN", "Infinity", "-Infinity", "1e400", "-1e308", "1" * 400, "1e-320"])
    return _text(square()).replace(b"100.0", odd.encode(), chance.randint(1, 4))


def _odd_value(chance: Chance) -> bytes:
    frame = square()
    key = chance.choice([*frame])
    odd: list[Any] = [
        None,
        True,
        -1,
        "",
        "x" * 10_000,
        [],
        {},
        [[]],
        [None],
        [[0, None]],
        [[0, 2**63]],
    ]
    frame[key] = chance.choice([*odd, [[0, -5]], [[0, 1, 2]], "\ud800", [[1e300, -1e300]] * 4])
    return _text(frame)


def _odd_place(chance: Chance) -> bytes:
    frame = square()
    edges = frame["edges_vertices"]
    edges[chance.randrange(len(edges))] = [chance.randint(-9, 9), chance.choice([0, 4, 2**31])]
    return _text(frame)


def _twice(chance: Chance) -> bytes:
    frame = square()
    for key in ("edges_vertices", "edges_assignment"):
        frame[key] = frame[key] * chance.randint(2, 5)
    return _text(frame)


def _many(chance: Chance) -> bytes:
    count = chance.choice([600] * 20 + [60_000, 250_000])
    frame = {"vertices_coords": [[k % 1000, k // 1000] for k in range(count)]}
    return _text({**frame, "edges_vertices": [[0, 1]]})


def _crossing(chance: Chance) -> bytes:
    count = chance.randint(10, 60)
    places = [[chance.uniform(0, 500), chance.uniform(0, 500)] for _ in range(2 * count)]
    edges = [[2 * k, 2 * k + 1] for k in range(count)]
    signs = [chance.choice("MVBFUCJ") for _ in edges]
    return _text({"vertices_coords": places, "edges_vertices": edges, "edges_assignment": signs})


def _circular(chance: Chance) -> bytes:
    frames = [
        {"frame_inherit": True, "frame_parent": chance.randint(-1, 4), "frame_classes": ["x"]}
        for _ in range(4)
    ]
    return _text({**square(), "file_frames": frames, "frame_parent": chance.randint(0, 4)})


def _spoiled(chance: Chance) -> bytes:
    names = ["ff_pinwheel.fold", "fold_box-layers.fold", "fold_diagonal-cp.fold"]
    return fuzzed_drawings.spoiled(chance, (_SAMPLES / chance.choice(names)).read_bytes())


def _strange(chance: Chance) -> bytes:
    text = _text(square()).decode()
    return chance.choice(
        [text.encode("utf-16"), b"\xef\xbb", b"", b"null", b"[" + text.encode() + b"]"]
    )


def _opx(chance: Chance) -> bytes:
    return fuzzed_drawings.spoiled(chance, (_SAMPLES / "ff_pinwheel.opx").read_bytes())


def _cp(chance: Chance) -> bytes:
    odd = ["1e999", "nan", "", "x", "9" * 40, str(chance.uniform(-400, 400))]
    rows = [
        f"{chance.randint(0, 5)} {chance.uniform(-200, 200)} {chance.choice(odd)} 0 {k}"
        for k in range(chance.choice([1, 9, 9, 20, 20, 20, 20] * 4 + [300_000]))
    ]
    return "\n".join(rows).encode()


_FOLD: list[Callable[[Chance], bytes]] = [
    _flipped,
    _cut,
    _noise,
    _nested,
    _odd_number,
    _odd_value,
    _odd_place,
    _twice,
    _many,
    _crossing,
    _circular,
    _spoiled,
    _strange,
]
_HPGL: list[Callable[[Chance], bytes]] = [
    *[fuzzed_hpgl.written] * 6,
    fuzzed_hpgl.tidy,
    fuzzed_hpgl.odd,
    fuzzed_hpgl.odd,
    fuzzed_hpgl.bomb,
]
_FORMS: dict[str, tuple[int, list[Callable[[Chance], bytes]]]] = {
    "fold": (6, _FOLD),
    "svg": (6, [fuzzed_drawings.svg]),
    "dxf": (6, [fuzzed_drawings.dxf]),
    HPGL: (6, _HPGL),
    "cp": (1, [_cp]),
    "opx": (1, [_opx]),
}
"""By what it is said to be: how often, and how it is made."""
