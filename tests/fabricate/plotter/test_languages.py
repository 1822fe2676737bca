"""G-code, GP-GL and paced HP-GL reach their machines whole, stop on a word, and are read alike."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate import shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError, Stopped
from foldmill_fabricate.plotter.handshakes.choice import prepared
from foldmill_fabricate.plotter.languages import made_ready
from foldmill_fabricate.plotter.ledger import Ledger, Program, Said, State, Word
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.sender import Progress, Status, send
from foldmill_fabricate.plotter.simulator.drawing import Step
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.trial import fine_lines

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]
KNIFE, SILHOUETTE = "grbl-drag-knife", "silhouette-like"
spots = st.tuples(st.integers(0, 300), st.integers(0, 300))
ways = st.lists(st.lists(spots, min_size=2, max_size=5, unique=True), min_size=1, max_size=6)


def drawn(simulator: Simulator) -> list[tuple[Step, ...]]:
    """What was cut, steps."""
    return [stroke.points for stroke in simulator.sheet.strokes[Face.FRONT]]


@pytest.mark.parametrize("slug", [KNIFE, SILHOUETTE])
def test_a_long_program_in_another_language_is_cut_whole_and_overruns_nothing(
    slug: str, machine: Make, programs: dict[str, bytes], plugged: Plug
) -> None:
    cutter = machine(slug, buffer=128)
    simulator = Simulator(cutter)
    with open_port(plugged(simulator), cutter) as port:
        delivery = send(programs[cutter.language], port, cutter)
    simulator.rest()
    scale = 80 if slug == KNIFE else 20
    low, high = (10, 110) if slug == KNIFE else (0, 100)
    far = [(x * scale, low * scale, high * scale) for x in range(10, 210, 2)]
    assert drawn(simulator) == [((x, a), (x, b), (x, a)) for x, a, b in far]
    assert simulator.device.traffic.overruns == 0
    assert simulator.device.carriage.tally.moving / delivery.seconds > 0.9
    wanted = Status.EXECUTED if slug == KNIFE else Status.UNCONFIRMED
    assert delivery.status is wanted


def test_a_paced_machine_gets_no_more_bytes_a_second_than_it_bears(
    machine: Make, plugged: Plug
) -> None:
    paced = machine(handshake="paced", bytes_per_second=100.0, acceleration=1e5, answers=False)
    simulator, program = Simulator(paced), fine_lines(3_000, 8)
    with open_port(plugged(simulator), paced) as port:
        delivery = send(program, port, paced)
    simulator.rest()
    assert delivery.status is Status.UNCONFIRMED
    assert delivery.seconds >= (len(program) - 240) / 100
    assert simulator.device.traffic.overruns == 0
    assert len(drawn(simulator)) == program.count(b"PU") - 1


def test_grbl_is_held_before_it_is_reset_so_that_its_place_is_not_lost(
    machine: Make, programs: dict[str, bytes], plugged: Plug
) -> None:
    knife = machine(KNIFE)
    simulator = Simulator(knife)

    def stop(progress: Progress) -> None:
        if progress.instructions == 30:
            raise KeyboardInterrupt

    with open_port(plugged(simulator), knife) as port:
        with pytest.raises(Stopped, match="told to hold, and to drop"):
            send(programs["gcode"], port, knife, progress=stop)
        stopped = len(drawn(simulator))
        simulator.rest()
    received = bytes(simulator.device.traffic.received)
    assert received.index(b"!") < received.rindex(b"\x18") < received.rindex(b"G0Z5")
    assert b"$X" not in received, "no alarm was to be lifted"
    assert len(drawn(simulator)) <= stopped + 1
    simulator.read()
    simulator.write(b"?")
    simulator.clock.sleep(1)
    assert simulator.read().startswith(b"<Idle|")


def test_a_lost_line_of_g_code_is_told_and_nothing_after_it_is_called_certain(
    machine: Make, programs: dict[str, bytes], plugged: Plug
) -> None:
    knife, book = machine(KNIFE), Strokes()
    sent = b"$I\n" + b"".join(
        part.data for part in prepared(made_ready(programs["gcode"], knife), knife).parts
    )
    lost = b"G1X40Y110F6000\n"
    simulator = Simulator(knife, faults=parse(f"overflow@{sent.index(lost)}programx{len(lost)}"))
    with (
        open_port(plugged(simulator), knife) as port,
        pytest.raises(PlotterError, match=r"took \d+ lines: something was lost on the line"),
    ):
        send(programs["gcode"], port, knife, book=book)
    simulator.rest()
    whole = drawn(simulator)[: book.acked]
    assert whole == [
        ((x, 800), (x, 8800), (x, 800)) for x in range(800, 800 + 160 * len(whole), 160)
    ]


class Strokes:
    """Keeps how many are certain."""

    acked = 0

    def advance(self, sent: int, acked: int) -> None:
        assert sent >= acked
        self.acked = max(self.acked, acked)


def test_the_ledger_knows_what_grbl_has_cut_and_the_rest_is_cut_on_a_persons_word(
    machine: Make, programs: dict[str, bytes], plugged: Plug, tmp_path: Path
) -> None:
    knife, ledger = machine(KNIFE), Ledger(tmp_path / "ledger.sqlite")
    simulator = Simulator(knife, faults=parse("stall@30.5strokes"))
    total = made_ready(programs["gcode"], knife).strokes
    part = Program("1-front-score.gcode", "front", "b" * 64, total)
    sheet = ledger.lay("a" * 64, [part], title="Stool", machine=KNIFE, material="pp-0.75").id
    run = ledger.claim(sheet, 0, "bench")
    with (
        open_port(plugged(simulator), knife) as port,
        pytest.raises(PlotterError, match="has not got on"),
    ):
        send(programs["gcode"], port, knife, book=run)
    run.end(State.INTERRUPTED, "it stood still")
    record = ledger.record(sheet, 0)
    cut = drawn(simulator)
    assert 0 < len(record.certain) <= len(cut) <= len(record.certain) + len(record.doubtful)
    assert len(record.doubtful) <= 3
    ledger.say(sheet, 0, Said(Word.GO_ON, stroke=30))
    again = Simulator(knife)
    run = ledger.claim(sheet, 0, "bench")
    with open_port(plugged(again), knife) as port:
        delivery = send(programs["gcode"], port, knife, start=Start(30), book=run)
    run.end(State.DONE)
    assert delivery.status is Status.EXECUTED
    assert len(drawn(again)) == total - 30
    assert ledger.record(sheet, 0).certain == tuple(range(total))
    ledger.close()


@given(ways)
def test_sender_and_machine_read_g_code_alike(cut: list[list[tuple[int, int]]]) -> None:
    lines = ["G21G90", "G0Z5"]
    for (x, y), *onward in cut:
        lines += [f"G0X{x}Y{y}", "G1Z-1F600", *(f"G1X{a}Y{b}F3000" for a, b in onward), "G0Z5"]
    agree("\n".join([*lines, ""]).encode(), shelf.machine(KNIFE))


@given(ways)
def test_sender_and_machine_read_gp_gl_alike(cut: list[list[tuple[int, int]]]) -> None:
    commands = ["J1", "!5", "FX10"]
    for (x, y), *onward in cut:
        commands += [f"M{x},{y}", "D" + ",".join(f"{a},{b}" for a, b in onward)]
    agree(
        "".join(each + "\x03" for each in [*commands, "M0,0"]).encode(), shelf.machine(SILHOUETTE)
    )


def agree(program: bytes, machine: Machine) -> None:
    """Both find the same strokes, the same end and, within a tenth, the same time."""
    roomy = machine.model_copy(
        update={"serial": machine.serial.model_copy(update={"buffer": 65536})}
    )
    job, simulator = made_ready(program, roomy), Simulator(roomy)
    simulator.clock.sleep(1)
    simulator.write(program)
    simulator.rest()
    assert len(drawn(simulator)) == job.strokes
    scale = machine.axes.units_per_mm if machine.language == "gcode" else 1
    assert job.end is not None
    assert simulator.device.carriage.at == tuple(round(each * scale) for each in job.end)
    moving = simulator.device.carriage.tally.moving
    assert job.seconds == pytest.approx(moving, rel=0.1, abs=0.2)
