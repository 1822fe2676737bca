"""Files that nobody should send: broken, huge, nested, lying; the same ones for the same seed."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

from services import square

Chance = random.Random
Frame = dict[str, Any]


def fuzzed(seed: int) -> bytes:
    """Return the file of a seed."""
    chance = random.Random(seed)
    return chance.choice(_KINDS)(chance)


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
    count = chance.choice([60_000, 250_000])
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


def _foreign(chance: Chance) -> bytes:
    entities = "".join(f'<!ENTITY e{k} "&e{k - 1};&e{k - 1};">' for k in range(1, 40))
    bomb = f'<!DOCTYPE s [<!ENTITY e0 "ha">{entities}]><svg>&e39;</svg>'.encode()
    hpgl = b"IN;SP1;PU0,0;" + b"PD%d,%d;" % (chance.randrange(10**9), -5) * 50
    dxf = b"0\nSECTION\n2\nENTITIES\n" + b"0\nLINE\n10\nnan\n" * 20
    return chance.choice([bomb, hpgl, dxf, _text(square()).decode().encode("utf-16"), b"\xef\xbb"])


_KINDS: list[Callable[[Chance], bytes]] = [
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
    _foreign,
]
