"""Drawings in HP-GL as programs write them, as nobody should, and as somebody may on purpose."""

from __future__ import annotations

import random
from itertools import islice

from foldmill_fabricate.foreign import limits

MOVES = ["IN;", "DF;", "SP#;", "PU#,#;", "PD#,#;", "PD#,#,#,#;", "PA#,#;", "PR#,#;", "PU;", "PD;"]
CURVES = ["CI#;", "CI#,#;", "AA#,#,#;", "AR#,#,#,#;", "IP#,#,#,#;", "SC#,#,#,#;", "SC;"]
OTHERS = ["SP;", "IP;", "VS#;", "FS#;", "LT;", "LT#;", "LBab\x03", "RO90;", "PE<=;", "OA;"]
STRAY = ["\x1b.(", "\x00", ",", ";", "#", "-", "."]
WORDS = MOVES + CURVES + OTHERS + STRAY
_ODD = ["nan", "inf", "-inf", "1e9", "--1", "0x10", "1" * 40, "-.", "9" * 12, "1_0"]


def babble(rng: random.Random) -> str:
    """Return instructions in no order, some of them refused."""
    pool = MOVES + CURVES if rng.random() < 0.5 else WORDS
    return "".join(rng.choice(pool) for _ in range(rng.choice([3, 10, 60, 400])))


def sound(rng: random.Random) -> str:
    """Return a drawing as a program writes it."""
    ways = ["PD#,#;", "PD#,#,#,#;", "PD;PA#,#;", "PD;PR#,#;PA;", "PD;AR#,#,90;", "CI#;", "PD;LT;"]
    strokes = (f"PU;SP{rng.randint(1, 4)};PU#,#;{rng.choice(ways)}PU;" for _ in range(30))
    return "".join(islice(strokes, rng.choice([1, 5, 30])))


def written(rng: random.Random) -> bytes:
    """Return a drawing, sound or not, perhaps with some bytes spoiled, now and then a bomb."""
    text = "IN;SP1;" + (sound if rng.random() < 0.6 else babble)(rng) + "PU;"
    largest = rng.choice([10, 4000, 4000, 30_000, 10**9])
    out = [str(rng.randint(-largest, largest)) if each == "#" else each for each in text]
    data = "".join(out).encode("latin-1")
    for _ in range(rng.choice([0, 0, 1, 5])):
        at = rng.randrange(len(data))
        data = data[:at] + bytes([rng.randrange(256)]) + data[at + rng.randrange(3) :]
    if rng.random() < 0.01:
        data *= rng.choice([50, 2_000])
    return data[: limits.BYTES + 9]


def tidy(rng: random.Random) -> bytes:
    """Return a drawing that can be made: small crosses and rings, none upon another."""
    places = rng.sample(range(400), rng.randint(1, 25))
    kinds = ["PU{x},{y};PD{u},{v};", "PU{x},{y};CI80;", "PU{x},{y};PD{u},{y},{u},{v},{x},{y};"]
    strokes = [
        f"PU;SP{rng.randint(1, 4)};" + rng.choice(kinds).format(x=x, y=y, u=x + 200, v=y + 150)
        for x, y in ((place % 20 * 600, place // 20 * 600) for place in places)
    ]
    return ("IN;" + "".join(strokes) + "PU;SP0;").encode()


def bomb(rng: random.Random) -> bytes:
    """Return a small file that would become large, or a large one that says little."""
    big = rng.choice([100] * 40 + [1_000, 30_000, 250_000])
    return rng.choice(
        [
            b"IN;SP1;" + b"CI400,0.01;" * 50,
            b"IN;IP0,0,1,1;SC0,1000000000,0,1000000000;SP1;CI999999999;",
            b"IN;IP0,0,1000000,1000000;SC0,1,0,1;SP1;" + b"CI0.5;" * (big // 50),
            b"IN;SP1;PD" + b"0,0,1,1," * big + b"9,9;",
            b"IN;SP1;" + b"PU0,0;PD400,400;" * big,
            b"IN;SP1;" + b"PU;PD;" * big,
            b";" * 8 * big,
            b"PD" + b" " * 8 * big + b"9,9;",
            b"LB" + b"x" * 8 * big,
            b"IN;SP1;PU0,0;PD" + b"9" * 8 * big + b",0;",
            b"".join(
                b"PU%d,0;PD%d,9000;PU0,%d;PD9000,%d;" % (k, k, k, k) for k in range(0, 9000, 9)
            ),
        ]
    )


def odd(rng: random.Random) -> bytes:
    """Return a drawing with numbers that are none."""
    places = [str(rng.randint(0, 9000)) for _ in range(8)]
    places[rng.randrange(8)] = rng.choice(_ODD)
    return f"IN;SP1;PU{places[0]},{places[1]};PD{','.join(places[2:])};PU;".encode()
