"""No bytes crash a simulated machine, hang it, or leave it deaf."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import pytest
from soaking import Soak

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
SEED = 20261122
CHUNK, PIECE = 5_000, 250
"""Bytes between two proofs that the machine still lives; between two resets, for some bytes make it
deaf, as they should."""

MOVES = ["PU#,#;", "PD#,#,#,#;", "PA#,#;", "PR#,#;", "PD", "PU;", "PD#;", "#,", ";"]
OTHERS = [
    "IN;",
    "DF;",
    "SP#;",
    "VS#;",
    "FS#;",
    "PG;",
    "LBa#\x03",
    "OA;",
    "OE;",
    "OS;",
    "OI#",
    "XX#;",
]
CONTROL = [f"\x1b.{letter}" for letter in "BELOJKARU"] + [
    f"\x1b.{each}#;#;#:" for each in "@HIMNPST"
]
LINES = [
    "G1X#Y#F#",
    "G0X#Y#",
    "G1Z-#F#",
    "Y#",
    "G91",
    "G90",
    "G20",
    "G21",
    "M3S#",
    "M5",
    "F#",
    "S#",
]
DOLLARS = [
    "S#",
    "$X",
    "$$",
    "$G",
    "$#=#",
    "$20=0",
    "!~",
    "?",
    "(#",
    "X#X#",
    "M2",
    "G4P0.1",
    "G92X#",
]
GPGL = ["M#,#", "D#,#,#,#", "O#,#", "E#,#", "H", "J#", "!#", "FX#", "FC#", "FG", "TB71", "D#", "#"]
SENTENCES = {
    "hpgl": MOVES * 3 + OTHERS + CONTROL,
    "gcode": [f"{line}\n" for line in LINES * 2 + DOLLARS],
    "gp-gl": [f"{each}\x03" for each in GPGL * 4] + ["\x1b\x05", "\x1b\x04", "\x1b"],
}
ALIVE = {
    "generic-hpgl-600": (b"\x1b.(\x1b.R\x1b.J\x1b.K\x03;;", b"IN;OI;", b"generic-hpgl-600\r"),
    "hp-7550a": (b"\x1b.(\x1b.R\x1b.J\x1b.K\x03;;", b"IN;OI;", b"hp-7550a\r"),
    "grbl-drag-knife": (b"\x18", b"\n$X\n", b"ok\r\n"),
    "grbl-laser": (b"\x18", b"\n$X\n", b"ok\r\n"),
    "silhouette-like": (b"\x1b\x04\x03", b"FG\x03", b"silhouette-like V1.00\x03"),
}
"""What frees each machine of whatever it was given, a question, and the end of its answer."""


def number(chance: random.Random) -> str:
    """Return a number that is mostly fit for a coordinate, and now and then for nothing."""
    kind = chance.random()
    if kind < 0.9:
        return str(chance.randint(0, 500))
    if kind < 0.999:
        return f"{chance.uniform(-1e5, 1e5):.{chance.randint(0, 4)}f}"
    return str(chance.randint(0, 9)) * chance.randint(1, 2000)


def nonsense(seed: str, language: str, size: int) -> bytes:
    """Return bytes between sense and noise: sentences, one in eight of them with a flaw."""
    chance = random.Random(seed)
    made = bytearray()
    while len(made) < size:
        sentence = chance.choice(SENTENCES[language])
        text = bytearray(re.sub("#", lambda _: number(chance), sentence).encode("latin-1"))
        if chance.random() < 0.125:
            at = chance.randrange(len(text))
            text[at : at + chance.randint(0, 2)] = chance.randbytes(chance.randint(0, 3))
        made += text
    return bytes(made[:size])


def survives(simulator: Simulator, data: bytes) -> None:
    """Feed bytes as fast as the line carries them, then ask whether anybody is there."""
    frees, asks, answers = ALIVE[simulator.machine.slug]
    for start in range(0, len(data), PIECE):
        piece = data[start : start + PIECE]
        simulator.write(piece)
        simulator.clock.sleep(len(piece) * simulator.line.byte_time + 1)
        simulator.write(frees)
        simulator.clock.sleep(0.1)
        simulator.read()
    simulator.clock.sleep(600.0)
    simulator.read()
    simulator.write(asks)
    simulator.clock.sleep(30.0)
    said = simulator.read()
    assert said.endswith(answers), (said[-80:], simulator.status())


@pytest.mark.parametrize("slug", sorted(ALIVE))
def test_no_bytes_crash_or_hang_a_machine(slug: str, soak: Soak, machine: Make) -> None:
    cutter = machine(slug, baud=115200, buffer=1024 if "grbl" not in slug else 128)
    total = soak.size(sample=30_000, whole=2_000_000)
    executed = 0
    with soak.part(f"simulator-fuzz-{slug}", SEED, total, "bytes") as done:
        for start in range(done.before, total, CHUNK):
            simulator = Simulator(cutter)
            simulator.honours_xoff = False
            survives(simulator, nonsense(f"{SEED}/{slug}/{start}", cutter.language, CHUNK))
            tally = simulator.device.carriage.tally
            executed += tally.units - tally.errors
            done.reached(start + CHUNK)
    assert executed > (total - done.before) / 200  # it did not just refuse
