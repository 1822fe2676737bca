"""The simulated plotter keeps count of its bytes, obeys in order and answers in time."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
BYTE = 10 / 9600


def told(simulator: Simulator, data: bytes, seconds: float = 30.0) -> bytes:
    """What comes back within some seconds."""
    simulator.write(data)
    simulator.clock.sleep(seconds)
    return simulator.read()


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        (b"OI;", b"generic-hpgl-600\r"),
        (b"OF;", b"40,40\r"),
        (b"OH;", b"0,0,24000,32767\r"),
        (b"OW;", b"0,0,24000,32767\r"),
        (b"OP;", b"250,279,10250,7479\r"),
        (b"OO;", b"0,1,0,0,1,0,0,0\r"),
        (b"PU120,80;PD;OA;", b"120,80,1\r"),
        (b"PU120,80;OC;", b"120,80,0\r"),
        (b"OS;OS;", b"24\r16\r"),
        (b"OE;", b"0\r"),
        (b"OA;OE;", b"0,0,0\r0\r"),
        (b"\x1b.B", b"1024\r"),
        (b"\x1b.L", b"1024\r"),
        (b"\x1b.E", b"0\r"),
        (b"\x1b.O", b"8\r"),
        (b"\x1b.@:\x1b.H80;5;6:\x1b.M10;;;13:\x1b.R\x1b.E", b"0\r"),
        (b"\x1b.Q\x1b.E", b"11\r"),
        (b"\x1b.I8x\x1b.E", b"12\r"),
        (b"\x1b.I99999:\x1b.E", b"13\r"),
        (b"\x1b.M10;;;321:\x1b.E", b"13\r"),
        (b"\x1b.M" + b"1;" * 12 + b"1:\x1b.E", b"14\r"),
    ],
)
def test_a_question_is_answered_as_the_manual_says(
    question: bytes, answer: bytes, machine: Make
) -> None:
    assert told(Simulator(machine()), question) == answer


@pytest.mark.parametrize(
    ("wrong", "error"),
    [
        (b"XX1,2;", 1),
        (b"?;", 1),
        (b"PD10;", 2),
        (b"PD10,x;", 1),  # x begins an instruction that there is not
        (b"IN7;", 2),
        (b"SP1,2;", 2),
        (b"OA1;", 2),
        (b"PD-1,5;", 3),
        (b"PU5,32768;", 3),
        (b"PR-5,0;", 3),
        (b"VS0;", 3),
        (b"VS400;", 3),
        (b"FS-1;", 3),
        (b"SP100;", 3),
    ],
)
def test_a_wrong_instruction_is_an_error_and_moves_nothing(
    wrong: bytes, error: int, machine: Make
) -> None:
    simulator = Simulator(machine())
    assert told(simulator, wrong + b"OE;OE;OA;").split(b"\r")[:2] == [b"%d" % error, b"0"]
    assert simulator.device.carriage.at == (0, 0)


def test_half_a_pair_at_the_end_is_an_error_after_the_whole_ones_are_drawn(machine: Make) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"PD10,20,30;OE;OA;") == b"2\r10,20,1\r"


def test_what_a_profile_lacks_is_unknown_to_the_machine(machine: Make) -> None:
    base = machine()
    old = base.model_copy(update={"dialect": base.dialect.model_copy(update={"force": False})})
    assert told(Simulator(old), b"FS80;OE;") == b"1\r"


def test_device_control_inside_a_number_does_not_enter_the_buffer(machine: Make) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"PU10\x1b.B0,200;OA;") == b"1020\r100,200,0\r"
    assert simulator.device.traffic.split == 1


def test_the_buffer_takes_its_size_and_not_a_byte_more(machine: Make) -> None:
    simulator = Simulator(machine(buffer=255))
    simulator.pause()
    assert told(simulator, b"P" * 255 + b"\x1b.E") == b"0\r"
    assert told(simulator, b"\x1b.B") == b"0\r"
    assert told(simulator, b"PU" + b"\x1b.E") == b"16\r"
    assert simulator.device.traffic.overruns == 2
    assert simulator.device.traffic.fullest == 255


def test_the_buffer_empties_pair_by_pair_as_they_are_drawn(machine: Make) -> None:
    simulator = Simulator(machine(lift_time=0.0))
    simulator.write(b"VS1;PD0,400,0,800,0,1200;")  # 10 mm at 10 mm/s each
    free = []
    for _ in range(4):
        simulator.clock.sleep(0.9)
        simulator.advance()
        free.append(simulator.device.free)
    assert free == [1024 - len(b",0,800,0,1200;"), 1024 - len(b",0,1200;"), 1023, 1024]


def test_a_question_during_an_answer_is_lost_and_error_10(machine: Make) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"\x1b.B\x1b.B") == b"1024\r"
    assert told(simulator, b"\x1b.E") == b"10\r"


def test_bytes_come_and_go_at_the_baud_rate(machine: Make) -> None:
    simulator = Simulator(machine())
    simulator.write(b"\x1b.B")
    simulator.clock.sleep(3 * BYTE + 0.002 + 4.9 * BYTE)
    assert simulator.read() == b"1024"
    simulator.clock.sleep(0.2 * BYTE)
    assert simulator.read() == b"\r"


def test_a_drawing_takes_the_time_of_the_motion_model(machine: Make) -> None:
    simulator = Simulator(machine(lift_time=0.1, acceleration=2000.0, tool_time=2.0))
    began = simulator.clock.now()
    simulator.write(b"SP1;VS10;PD4000,0;PU;")
    simulator.rest()
    arrived = len(b"SP1;") * BYTE
    drawn = 100 / 100 + 100 / 2000
    assert simulator.clock.now() - began == pytest.approx(arrived + 2 + 0.1 + drawn + 0.1, abs=1e-9)


def test_a_faster_machine_does_the_same_in_less_time(machine: Make) -> None:
    seconds = []
    for speed_up in (1.0, 10.0):
        simulator = Simulator(machine(baud=115200), speed_up=speed_up)
        simulator.write(b"PD20000,0;PU;")
        simulator.rest()
        seconds.append(simulator.clock.now())
    assert seconds[0] / seconds[1] == pytest.approx(10, rel=0.05)


def test_esc_k_drops_what_waits_and_lets_the_motion_end(machine: Make) -> None:
    simulator = Simulator(machine())
    told(simulator, b"VS1;PD400,0,800,0;PD0,0;PU9,9;PD4", 0.5)
    assert told(simulator, b"\x1b.KOA;PU;") == b"400,0,1\r"
    assert not simulator.device.carriage.down


def test_esc_l_waits_until_the_buffer_is_empty_and_esc_j_forgets_it(machine: Make) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"VS1;PD400,0,800,0;\x1b.L", 1.0) == b""
    assert told(simulator, b"") == b"1024\r"
    assert told(simulator, b"PD400,0,0,0;\x1b.L\x1b.J") == b""


def test_a_plotter_that_is_switched_off_the_line_hears_only_its_call(machine: Make) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"\x1b.)PU50,50;\x1b.B") == b""
    assert told(simulator, b"\x1b.(OA;") == b"0,0,0\r"


def test_xoff_comes_with_room_left_and_xon_when_half_is_free(machine: Make) -> None:
    simulator = Simulator(machine(handshake="xon-xoff", buffer=256))
    simulator.honours_xoff = False  # to see the two bytes
    simulator.pause()
    assert told(simulator, b"PU1,1;" * 32) == b"\x13"
    assert simulator.device.free == 64
    simulator.resume()
    assert told(simulator, b"") == b"\x11"


def test_a_host_that_obeys_xoff_sends_only_what_its_chip_holds(machine: Make) -> None:
    simulator = Simulator(machine(handshake="xon-xoff", buffer=256))
    simulator.pause()
    assert told(simulator, b"PU1,1;" * 100) == b""
    assert 256 - 64 + 16 <= len(simulator.device.traffic.received) <= 256 - 64 + 18
    simulator.resume()
    simulator.rest()
    assert simulator.device.traffic.overruns == 0
    assert len(simulator.device.traffic.received) == 600


def test_esc_i_and_esc_n_switch_xon_xoff_on_and_esc_r_off(machine: Make) -> None:
    simulator = Simulator(machine(buffer=256))
    simulator.honours_xoff = False
    simulator.pause()
    told(simulator, b"\x1b.I81;;17:\x1b.N;19:")
    assert told(simulator, b"P" * 176) == b"\x13"
    other = Simulator(machine(buffer=256))
    other.honours_xoff = False
    other.pause()
    assert told(other, b"\x1b.I81;;17:\x1b.N;19:\x1b.R" + b"P" * 176) == b""


def test_a_second_in_is_counted_only_inside_a_job(machine: Make) -> None:
    simulator = Simulator(machine())
    told(simulator, b"IN;SP1;PD5,5;PU;SP0;IN;SP1;PD9,9;PU;SP0;")
    assert simulator.device.carriage.tally.second_in == 0
    told(simulator, b"SP1;PD5,5;PU;IN;PD9,9;PU;")
    assert simulator.device.carriage.tally.second_in == 1


def test_another_baud_rate_garbles_every_byte(machine: Make) -> None:
    simulator = Simulator(machine())
    simulator.baud = 19200
    assert told(simulator, b"\x1b.B") == b""
    assert simulator.device.traffic.errors[15] == 3


def test_a_dead_machine_neither_moves_nor_answers(machine: Make) -> None:
    simulator = Simulator(machine(), faults=parse("silence@9"))
    assert told(simulator, b"PU50,50;PU90,90;OA;\x1b.B") == b""
    assert simulator.device.carriage.at == (50, 50)
    with pytest.raises(PlotterError, match="silent"):
        simulator.flip()


FRAGMENTS = re.findall(
    r"\S+\s?", "IN; DF; PA; PR; PU; PD; SP1; VS9; FS80; OE; PG; PUPD XX; PD1; PD1,2,3; ; P 1,2 , -"
)
WORDS = st.lists(
    st.one_of(
        st.sampled_from([*FRAGMENTS, "LBa;b\x03", "\x1b.B"]),
        st.builds(
            lambda name, pairs: name + ",".join(f"{x},{y}" for x, y in pairs) + ";",
            st.sampled_from(["PU", "PD", "PA", "PR"]),
            st.lists(st.tuples(st.integers(-9, 99), st.integers(-9, 99)), min_size=1, max_size=9),
        ),
    ),
    max_size=30,
)


@given(WORDS, st.data())
def test_a_program_does_the_same_however_its_bytes_come_in(
    words: list[str], data: st.DataObject
) -> None:
    program = "".join([*words, ";PU;"]).encode()
    cuts = sorted(data.draw(st.lists(st.integers(0, len(program)), max_size=12)))
    outcomes = []
    for bounds in ([], cuts):
        base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
        serial = base.serial.model_copy(update={"buffer": 9999})
        simulator = Simulator(base.model_copy(update={"serial": serial}))
        for start, end in zip([0, *bounds], [*bounds, len(program)], strict=True):
            simulator.write(program[start:end])
            simulator.clock.sleep(5.0 * bool(bounds))
        simulator.rest()
        carriage = simulator.device.carriage
        tally = (carriage.tally.units, carriage.tally.errors, carriage.error)
        outcomes.append(
            (simulator.sheet.strokes[Face.FRONT], carriage.at, tally, simulator.device.free)
        )
    assert outcomes[0] == outcomes[1]
