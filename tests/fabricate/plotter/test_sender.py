"""A delivery ends in what is known: executed, not confirmed, a fault, or a stopped machine."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import VirtualClock
from foldmill_fabricate.plotter.errors import NoAnswer, PlotterError, ProgramRefused, Stopped
from foldmill_fabricate.plotter.handshakes import hp
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Progress, Status, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.wish import Wish
from foldmill_fabricate.plotter.witness import QUESTION

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]

SQUARE = b"IN;DF;PA;\nSP1;\nVS10;\nPU400,400;\nPD8400,400,8400,8400,400,8400,400,400;\nPU;\nSP0;\n"
LONG = b"IN;SP1;VS10;PU0,0;" + b"".join(
    b"PU%d,0;PD%d,4000;PD%d,0;" % (x, x, x) for x in range(0, 20000, 100)
)
"""200 strokes of 2 × 100 mm: 2.4 s each."""


class Lossy:
    """A port that loses one instruction, which no real one should."""

    def __init__(self, port: Any, lost: bytes) -> None:
        self.__dict__.update(port=port, lost=lost)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.port, name)

    def write(self, data: bytes) -> int:
        return len(data) if data.startswith(self.lost) else int(self.port.write(data))


def test_a_program_is_executed_when_the_machine_has_said_so(machine: Make, plugged: Plug) -> None:
    simulator, seen = Simulator(machine()), list[Progress]()
    with open_port(plugged(simulator), machine()) as port:
        delivery = send(SQUARE, port, machine(), progress=seen.append)
    assert delivery.status is Status.EXECUTED
    assert (delivery.position, delivery.error, delivery.fault) == ((400, 400), 0, "")
    assert delivery.bytes == len(SQUARE)
    assert delivery.seconds > 800 / 100
    assert simulator.device.idle
    assert len(simulator.sheet.strokes[Face.FRONT]) == 1
    assert seen[-1] == Progress(len(SQUARE), len(SQUARE), 9, 9)
    assert [each.bytes for each in seen] == sorted(each.bytes for each in seen)


def test_both_faces_are_drawn_one_after_the_other(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine())
    url = plugged(simulator)
    for turned in (True, False):
        with open_port(url, machine()) as port:
            assert send(SQUARE, port, machine()).status is Status.EXECUTED
            if turned:
                simulator.flip()
    assert simulator.sheet.strokes[Face.FRONT] == simulator.sheet.strokes[Face.REVERSE]
    assert simulator.device.carriage.tally.second_in == 0


@pytest.mark.parametrize("handshake", ["none", "xon-xoff"])
def test_a_machine_that_does_not_answer_ends_as_sent_not_confirmed(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    mute = machine(handshake=handshake, answers=False)
    simulator = Simulator(mute)
    with open_port(plugged(simulator), mute) as port:
        delivery = send(SQUARE, port, mute)
    simulator.advance()
    assert delivery.status is Status.UNCONFIRMED
    assert bytes(simulator.device.traffic.received) == SQUARE
    assert simulator.device.idle


@pytest.mark.parametrize(
    ("handshake", "reports", "status", "words"),
    [
        ("esc-b", False, Status.EXECUTED, "has reported no byte lost"),
        ("enq-ack", False, Status.EXECUTED, "has reported no byte lost"),
        ("dtr", True, Status.EXECUTED, "has reported no byte lost"),
        ("dtr", False, Status.ENDED, "this machine does not say: look at the sheet"),
        ("xon-xoff", False, Status.ENDED, "this machine does not say: look at the sheet"),
    ],
)
def test_executed_is_said_only_where_the_machine_would_have_told_of_a_lost_byte(
    handshake: str, reports: bool, status: Status, words: str, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake, reports_losses=reports)
    with open_port(plugged(Simulator(cutter)), cutter) as port:
        delivery = send(SQUARE, port, cutter)
    assert delivery.status is status
    assert words in delivery.proved


@pytest.mark.parametrize("handshake", ["esc-b", "enq-ack"])
def test_a_lever_that_is_raised_stops_the_delivery_with_a_sentence(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake)
    simulator = Simulator(cutter, faults=parse("lever@3strokes"))
    with open_port(plugged(simulator), cutter) as port:
        with pytest.raises(PlotterError, match=r"lever|not confirmed|not acknowledged"):
            send(LONG, port, cutter)
        assert port.clock.now() < 60


def test_silence_at_the_end_is_not_taken_for_success(machine: Make, plugged: Plug) -> None:
    dying = machine(handshake="xon-xoff")
    simulator = Simulator(dying, faults=parse(f"silence@{len(SQUARE) + 2 * len(QUESTION) - 1}"))
    with open_port(plugged(simulator), dying) as port:
        delivery = send(SQUARE, port, dying)
    assert delivery.status is Status.UNCONFIRMED
    assert delivery.seconds < 120


def test_what_the_machine_calls_an_error_is_a_fault(machine: Make, plugged: Plug) -> None:
    with open_port(plugged(Simulator(machine())), machine()) as port:
        delivery = send(b"IN;SP1;PD500,-1;PU;", port, machine())
    assert delivery.status is Status.FAULT
    assert (delivery.error, delivery.fault) == (
        3,
        "The machine reports error 3: a parameter out of range.",
    )


def test_a_tool_that_stands_elsewhere_is_a_fault(machine: Make, plugged: Plug) -> None:
    with open_port(plugged(Simulator(machine())), machine()) as port:
        delivery = send(b"IN;PU40,40;PU90,90;", Lossy(port, b"PU90"), machine())
    assert delivery.status is Status.FAULT
    assert delivery.fault == "The tool stands at 40, 40 steps, but the program ends at 90, 90."


@pytest.mark.parametrize("dead_after", [0, 2, 300, 2500])
def test_a_machine_gone_silent_ends_with_a_sentence_by_a_deadline(
    dead_after: int, machine: Make, plugged: Plug
) -> None:
    simulator = Simulator(machine(), faults=parse(f"silence@{dead_after}"))
    with open_port(plugged(simulator), machine()) as port:
        with pytest.raises(NoAnswer, match=r"does not answer at 9600|stopped answering after"):
            send(LONG, port, machine())
        assert port.clock.now() < 400  # of 480 s that the whole would take


def test_a_machine_that_stands_still_is_given_up(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine(), faults=parse("slow@0x10000"))
    with open_port(plugged(simulator), machine()) as port:
        with pytest.raises(NoAnswer, match=r"not got beyond instruction \d+ of"):
            send(LONG, port, machine())
        assert port.clock.now() < 60


def test_a_machine_that_holds_the_line_for_ever_is_given_up(machine: Make, plugged: Plug) -> None:
    held = machine(handshake="xon-xoff", buffer=128)
    simulator = Simulator(held)
    simulator.pause()
    with open_port(plugged(simulator), held) as port:
        with pytest.raises(NoAnswer, match=r"(held the line|not confirmed).*by hand"):
            send(LONG, port, held)
        assert port.clock.now() < 120


def test_a_machine_that_somebody_has_paused_is_waited_for(machine: Make, plugged: Plug) -> None:
    class Lunch(VirtualClock):
        def sleep_until(self, moment: float) -> None:
            super().sleep_until(moment)
            if self.now() > 1800 and simulator.device.paused:
                simulator.resume()

    simulator = Simulator(machine(), clock=Lunch())
    with open_port(plugged(simulator), machine()) as port:

        def pause(progress: Progress) -> None:
            if progress.instructions == 40:
                simulator.pause()

        delivery = send(LONG[: LONG.index(b"PU3000")], port, machine(), progress=pause)
    assert delivery.status is Status.EXECUTED
    assert delivery.seconds > 1800


def interrupted(port: Any, machine: Machine, at: int, error: BaseException) -> None:
    def interrupt(progress: Progress) -> None:
        if progress.instructions == at:
            raise error

    send(LONG, port, machine, progress=interrupt)


def test_ctrl_c_drops_what_waits_and_lifts_the_tool_without_moving_or_in(
    machine: Make, plugged: Plug
) -> None:
    simulator = Simulator(machine())
    with open_port(plugged(simulator), machine()) as port:
        with pytest.raises(Stopped, match="told to drop what it has and to lift its tool"):
            interrupted(port, machine(), 30, KeyboardInterrupt())
        stopped = port.clock.now()
        simulator.rest()
        assert port.clock.now() - stopped < 3
    received = bytes(simulator.device.traffic.received)
    assert received.endswith(b"\x1b.KPU;")
    assert received.count(b"IN") == 1
    assert not simulator.device.carriage.down
    assert simulator.device.carriage.error == 0


@pytest.mark.parametrize("forget", [b"\x1b.K", b";"])
def test_it_is_esc_k_that_stops_what_the_machine_holds(
    forget: bytes, machine: Make, plugged: Plug, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulator = Simulator(machine())
    short = b"IN;SP1;VS10;" + b"".join(b"PU%d,0;PD%d,400;" % (x, x) for x in range(0, 9000, 40))
    with open_port(plugged(simulator), machine()) as port:
        monkeypatch.setattr(hp, "_FORGET", forget)

        def stop(progress: Progress) -> None:
            if progress.instructions == 90:
                raise KeyboardInterrupt

        with pytest.raises(Stopped):
            send(short, port, machine(), progress=stop)
        cut = len(simulator.sheet.seen(Face.FRONT))
        port.clock.sleep(60)
        simulator.advance()
    more = len(simulator.sheet.strokes[Face.FRONT]) - cut
    assert (more == 0) is (forget == b"\x1b.K")


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff", "none"])
def test_a_person_pauses_where_the_tool_is_up_and_goes_on(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    cutter, wish = machine(handshake=handshake), Wish()
    seen: list[bool] = []

    class Lunch(VirtualClock):
        def sleep_until(self, moment: float) -> None:
            super().sleep_until(moment)
            if self.now() > 600 and wish.paused:
                seen.append(simulator.device.carriage.down)
                wish.go_on()

    simulator = Simulator(cutter, clock=Lunch())
    with open_port(plugged(simulator), cutter) as port:

        def pause(progress: Progress) -> None:
            if progress.instructions == 40:
                wish.pause()

        program = LONG[: LONG.index(b"PU3000")]
        delivery = send(program, port, cutter, progress=pause, wish=wish)
    assert seen == [False]
    assert delivery.status.is_done
    assert delivery.seconds > 600


@pytest.mark.parametrize("handshake", ["none", "xon-xoff"])
def test_a_machine_without_a_discard_command_gets_nothing_after_half_an_instruction(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    simple = machine(handshake=handshake)
    simulator = Simulator(simple)
    with open_port(plugged(simulator), simple) as port:
        with pytest.raises(Stopped, match="Stop the machine by hand"):
            interrupted(port, simple, 2, KeyboardInterrupt())
        port.clock.sleep(60)
        simulator.advance()
    received = bytes(simulator.device.traffic.received)
    assert LONG.startswith(received)
    assert not received.endswith(b";")


def test_any_other_exception_stops_the_machine_as_well(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine())
    with open_port(plugged(simulator), machine()) as port:
        with pytest.raises(SystemExit) as caught:
            interrupted(port, machine(), 9, SystemExit(15))
        simulator.rest()
    assert "told to drop" in caught.value.__notes__[0]
    assert bytes(simulator.device.traffic.received).endswith(b"\x1b.KPU;")


def test_a_port_that_fails_is_reported_in_words(machine: Make, plugged: Plug) -> None:
    with open_port(plugged(Simulator(machine())), machine()) as port:

        def unplug(progress: Progress) -> None:
            port.close()

        with pytest.raises(PlotterError, match=r"The port failed: .*Stop the machine by hand"):
            send(LONG, port, machine(), progress=unplug)


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff", "none"])
def test_no_more_than_three_seconds_or_one_stroke_are_in_flight(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    roomy = machine(buffer=1 << 20, handshake=handshake, baud=115200)
    simulator, waiting = Simulator(roomy), []
    with open_port(plugged(simulator), roomy) as port:

        def look(_: Progress) -> None:
            simulator.advance()
            unsent = simulator.queued + simulator.line.sending
            waiting.append(simulator.device.size - simulator.device.free + unsent)

        assert send(LONG, port, roomy, progress=look).status.is_done
    two_strokes = 2 * len(b"PU19900,0;PD19900,4000;PD19900,0;")
    assert len(b"PD19900,0;") < max(waiting) <= two_strokes


def test_a_profile_that_contradicts_itself_is_refused(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine())
    with open_port(plugged(simulator), machine()) as port, pytest.raises(ProgramRefused):
        send(SQUARE, port, machine(answers=False))
    assert not simulator.device.traffic.received


def test_nothing_is_sent_of_a_program_that_is_refused(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine())
    with open_port(plugged(simulator), machine()) as port, pytest.raises(ProgramRefused):
        send(b"IN;PU1,1;OA;", port, machine())
    assert not simulator.device.traffic.received


def test_the_buffer_is_what_the_machine_says_not_what_its_profile_believes(
    machine: Make, plugged: Plug
) -> None:
    simulator = Simulator(machine(buffer=255))
    with open_port(plugged(simulator), machine(buffer=4096)) as port:
        delivery = send(LONG, port, machine(buffer=4096))
    assert delivery.status is Status.EXECUTED
    assert simulator.device.traffic.overruns == 0
