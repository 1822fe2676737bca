"""A GRBL machine: ok means taken, not done; holds, resets and alarms are as its manual says."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.simulator.grbl import BANNER
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
Told = Callable[..., bytes]
KNIFE, LASER = "grbl-drag-knife", "grbl-laser"


@pytest.fixture
def knife(machine: Make, told: Told) -> Simulator:
    """A drag knife that has said hello."""
    simulator = Simulator(machine(KNIFE))
    assert told(simulator, b"", 1.0) == BANNER.encode()
    return simulator


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        (b"", b"ok"),
        (b"(nothing) ; at all", b"ok"),
        (b"G21 G90", b"ok"),
        (b"g1x10y10f600", b"ok"),
        (b"G1X5", b"error:22"),
        (b"X", b"error:2"),
        (b"12", b"error:1"),
        (b"G0X1X2", b"error:25"),
        (b"G0G1X2", b"error:21"),
        (b"G2X1Y1I1", b"error:20"),
        (b"G0.5", b"error:20"),
        (b"M3.5", b"error:23"),
        (b"G4", b"error:28"),
        (b"G0X1P2", b"error:36"),
        (b"$7=9", b"error:3"),
        (b"$H", b"error:5"),
        (b"$X", b"ok"),
        (b"$32=1", b"ok"),
        (b"G0" + b" X1.0" + b"0" * 90, b"error:11"),
    ],
)
def test_each_line_has_its_answer(line: bytes, answer: bytes, knife: Simulator, told: Told) -> None:
    assert told(knife, line + b"\n").split(b"\r\n") == [answer, b""]


def test_strokes_are_where_the_knife_is_in_the_sheet(knife: Simulator, told: Told) -> None:
    program = (
        b"G21G90\nG0Z5\nG0X10Y10\nG1Z-1F300\nG1X20F600\nY20\nG0Z5\nG91\nG20\nG0X1\nG1Z-1\nY1\n"
    )
    assert told(knife, program + b"G0Z1\n", 60.0) == b"ok\r\n" * 13
    knife.rest()
    front = knife.sheet.strokes[Face.FRONT]
    inch = round(25.4 * 80)
    assert front[0].points == ((800, 800), (1600, 800), (1600, 1600))
    assert front[1].points == ((1600 + inch, 1600), (1600 + inch, 1600 + inch))
    assert front[0].speed == 10.0
    assert front[0].setting == "Z-1"


def test_a_laser_marks_with_its_beam_on_and_not_on_g0(machine: Make) -> None:
    simulator = Simulator(machine(LASER))
    simulator.write(b"G21G90\nG0X10\nM4S0\nG1X20F600S800\nX30\nG0X40\nG1X50\nS0X60\nM5\nG1X70\n")
    simulator.rest()
    strokes = [(each.points, each.setting) for each in simulator.sheet.strokes[Face.FRONT]]
    assert strokes == [(((800, 0), (1600, 0), (2400, 0)), "S800"), (((3200, 0), (4000, 0)), "S800")]


def test_a_move_on_the_last_line_is_made_as_it_was_asked_for(knife: Simulator, told: Told) -> None:
    assert told(knife, b"G0X5\nX10M2\n", 5.0) == b"ok\r\nok\r\n"
    assert b"MPos:10.000" in told(knife, b"?")


def test_ok_means_taken_until_the_planner_is_full(knife: Simulator, told: Told) -> None:
    lines = b"".join(b"G1X%dF60\n" % (n + 1) for n in range(20))  # a second each
    assert told(knife, lines, 0.5).count(b"ok") == 15
    assert told(knife, b"", 1.0).count(b"ok") == 1
    knife.rest()
    assert knife.read().count(b"ok") == 4


def test_the_ok_of_a_dwell_says_that_all_before_it_is_done(knife: Simulator, told: Told) -> None:
    assert told(knife, b"G1X3F60\nG4P0\nG1X4\n", 2.9) == b"ok\r\n"
    assert told(knife, b"", 0.2) == b"ok\r\nok\r\n"


def test_the_receive_buffer_holds_128_bytes_and_loses_the_rest(knife: Simulator) -> None:
    knife.write(b"G4P100\n" + b"G1X1F60\n" * 20)
    knife.clock.sleep(5)
    knife.advance()
    assert knife.device.traffic.fullest == 128
    assert knife.device.traffic.overruns == 160 - 128


def test_the_status_is_answered_at_once_and_tells_where_the_tool_is(
    knife: Simulator, told: Told
) -> None:
    assert told(knife, b"?") == b"<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n"
    told(knife, b"$10=3\nG1X10F600\n", 0.52)
    status = told(knife, b"?", 0.01)
    assert status.startswith(b"<Run|MPos:")
    assert status.endswith(b",0.000,0.000|Bf:14,128|FS:600,0>\r\n")
    assert 3 < float(status[10:].split(b",")[0]) < 7


def test_a_hold_stops_within_the_line_and_a_cycle_start_goes_on(
    knife: Simulator, told: Told
) -> None:
    told(knife, b"G1Z-1F6000\nG1X10F60\n", 5.0)
    assert told(knife, b"!?", 0.01).startswith(b"<Hold:1|MPos:")
    status = told(knife, b"?", 5.0)
    assert status.startswith(b"<Hold:0|MPos:")
    stands = float(status[13:].split(b",")[0])
    assert 4 < stands < 6
    assert knife.sheet.seen(Face.FRONT)[-1].points[-1][0] == round(stands * 80)
    assert told(knife, b"~?", 0.01).startswith(b"<Run|")
    knife.clock.sleep(30)
    knife.advance()
    assert knife.sheet.seen(Face.FRONT)[-1].points == ((0, 0), (800, 0))


def test_a_reset_after_a_hold_keeps_the_position_and_one_in_motion_is_an_alarm(
    knife: Simulator, told: Told
) -> None:
    told(knife, b"G1X10F60\nX20\n", 5.0)
    told(knife, b"!", 1.0)
    assert told(knife, b"\x18") == BANNER.encode()
    assert told(knife, b"?").startswith(b"<Idle|MPos:4.")
    told(knife, b"G1X0F60\n", 1.0)
    said = told(knife, b"\x18")
    assert said == b"ALARM:3\r\n" + BANNER.encode() + b"[MSG:'$H'|'$X' to unlock]\r\n"
    assert told(knife, b"G0X1\n") == b"error:9\r\n"
    assert told(knife, b"$X\nG0X1\n") == b"ok\r\nok\r\n"


def test_a_target_beyond_the_travel_locks_the_machine_until_a_reset(
    knife: Simulator, told: Told
) -> None:
    assert told(knife, b"G0X5\nG0X900\nG0X6\n") == b"ok\r\nALARM:2\r\n[MSG:Reset to continue]\r\n"
    assert told(knife, b"G0X7\n") == b""
    assert told(knife, b"\x18").startswith(BANNER.encode())
    assert b"<Idle|MPos:5.000,0.000" in told(knife, b"$X\n?")


def test_the_modes_and_settings_are_told(knife: Simulator, told: Told) -> None:
    told(knife, b"G20G91F100\n")
    assert told(knife, b"$G\n") == b"[GC:G0 G54 G17 G20 G91 G94 M5 M9 T0 F2540 S0]\r\nok\r\n"
    assert b"$130=620.000\r\n" in told(knife, b"$$\n")
