"""Ways in which good programs in GP-GL and G-code go wrong, done to the bytes."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from functools import cache

from fabricate.verify import knife_job
from fabricate.verify.square_job import Job

from foldmill_fabricate import shelf
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify.planned import program_files
from foldmill_fabricate.writers import writer

CUTTER, KNIFE, LASER = "silhouette-like", "grbl-drag-knife", "grbl-laser"
Spoil = Callable[[Job], Job]
_STROKE = {
    CUTTER: re.compile(r"M[\d,]+\x03(?:D[\d,]+\x03)+"),
    KNIFE: re.compile(r"G0X.*\nG1Z.*\n(?:G1X.*\n)+G0Z.*\n"),
    LASER: re.compile(r"G0X.*\nM[34].*\n(?:G1X.*\n)+M5\n"),
}
"""From where the tool comes to a stroke until it is up again."""


@cache
def job(slug: str) -> Job:
    """Return a job of a square that is proved, its programs on record."""
    used, fold = shelf.machine(slug), knife_job.fold()
    plan = make(fold, shelf.material("pp-0.75"), used, blank=(260.0, 240.0))
    offered = writer(used)
    assert offered is not None
    found = Job(plan, fold.pattern, dict(offered.write(plan, fold)))
    for name, data in found.programs.items():
        found = _with(found, name, data)
    return found


def _with(good: Job, name: str, data: bytes) -> Job:
    """Put a program in the place of one, on record as if it had been written so."""
    files = tuple(
        each.model_copy(update={"sha256": hashlib.sha256(data).hexdigest()})
        if each.name == name
        else each
        for each in program_files(good.plan)
    )
    plan = good.plan.model_copy(update={"programs": files})
    return Job(plan, good.pattern, {**good.programs, name: data})


def _reworded(good: Job, pattern: str, new: str, count: int = 0, which: str = "") -> Job:
    """Write other words in the last program whose name has a word."""
    name = next(each for each in sorted(good.programs, reverse=True) if which in each)
    text = good.programs[name].decode()
    changed = re.sub(pattern, new, text, count=count)
    assert changed != text
    return _with(good, name, changed.encode())


def _stroke(good: Job, change: Callable[[str], str]) -> Job:
    """Change the last stroke of the first program that scores."""
    name = next(each for each in sorted(good.programs) if "cut" not in each and "hole" not in each)
    text = good.programs[name].decode()
    last = list(_STROKE[good.plan.machine.slug].finditer(text))[-1]
    return _with(good, name, (text[: last.start()] + change(last[0]) + text[last.end() :]).encode())


def a_stroke_is_missing(good: Job) -> Job:
    return _stroke(good, lambda _: "")


def a_stroke_is_drawn_once_more(good: Job) -> Job:
    return _stroke(good, lambda own: own + own)


def a_stroke_is_moved_by_a_tenth_of_a_mm(good: Job) -> Job:
    return _stroke(good, lambda own: _moved(own, good))


def _moved(text: str, good: Job) -> str:
    if good.plan.machine.language == "gcode":
        return re.sub(r"X([\d.]+)", lambda x: f"X{float(x[1]) + 0.1:.4f}", text)
    return re.sub(r"([MD,])(\d+)(?=,\d+(?:[,\x03]))", lambda x: _step(x), text)


def _step(found: re.Match[str]) -> str:
    return f"{found[1]}{int(found[2]) + 2}"


def a_program_is_edited(good: Job) -> Job:
    name = max(good.programs)
    return Job(good.plan, good.pattern, {**good.programs, name: good.programs[name] + b" "})


def the_axes_are_exchanged(good: Job) -> Job:
    return _reworded(good, r"(\d+),(\d+)", r"\2,\1", which="score")


def the_other_condition_is_taken(good: Job) -> Job:
    return _reworded(good, r"J1", "J2")


def the_force_is_half(good: Job) -> Job:
    return _reworded(good, r"FX33", "FX16")


def the_speed_is_five_times(good: Job) -> Job:
    return _reworded(good, r"!1", "!5")


def the_blades_offset_is_left_out(good: Job) -> Job:
    return _reworded(good, r"FC18", "FC0")


def a_point_is_behind_the_rollers(good: Job) -> Job:
    return _stroke(good, lambda own: re.sub(r"D\d+", "D61000", own, count=1))


def the_knife_is_set_too_deep(good: Job) -> Job:
    return _reworded(good, r"Z-0\.4", "Z-0.9", which="score")


def the_knife_stays_in_the_sheet_on_the_way(good: Job) -> Job:
    return _reworded(good, r"G0Z5\nG0X", "G0X", which="score")


def the_feed_is_a_tenth(good: Job) -> Job:
    return _reworded(good, r"F7200", "F720", which="score")


def the_lead_in_is_left_out(good: Job) -> Job:
    return _reworded(good, _STROKE[KNIFE].pattern, "", count=1, which="score")


def everything_is_in_inches(good: Job) -> Job:
    return _reworded(good, "G21", "G20", count=1)


def distances_are_counted_on(good: Job) -> Job:
    return _reworded(good, "G90", "G91", count=1)


def the_beam_stays_on_on_the_way(good: Job) -> Job:
    return _reworded(good, r"M5\nG0X", "G0X", count=3)


def the_beam_is_too_weak(good: Job) -> Job:
    return _reworded(good, r"M4S1000", "M4S300")


def the_beam_burns_on_where_the_head_is_slow(good: Job) -> Job:
    return _reworded(good, r"M4S", "M3S")


EVERYWHERE: dict[Spoil, str] = {
    a_stroke_is_missing: "missing-stroke",
    a_program_is_edited: "edited",
}
CUTTERS: dict[Spoil, str] = {
    **EVERYWHERE,
    a_stroke_is_drawn_once_more: "repeats",
    a_stroke_is_moved_by_a_tenth_of_a_mm: "moved",
    the_axes_are_exchanged: "displaced",
    the_other_condition_is_taken: "wrong-tool",
    the_force_is_half: "wrong-force",
    the_speed_is_five_times: "wrong-speed",
    the_blades_offset_is_left_out: "wrong-blade-offset",
    a_point_is_behind_the_rollers: "outside-range",
}
KNIVES: dict[Spoil, str] = {
    **EVERYWHERE,
    the_knife_is_set_too_deep: "wrong-depth",
    the_knife_stays_in_the_sheet_on_the_way: "extra-line",
    the_feed_is_a_tenth: "wrong-speed",
    the_lead_in_is_left_out: "lead-in-missing",
    distances_are_counted_on: "outside-range",
}
LASERS: dict[Spoil, str] = {
    **EVERYWHERE,
    a_stroke_is_drawn_once_more: "repeats",
    a_stroke_is_moved_by_a_tenth_of_a_mm: "moved",
    the_beam_stays_on_on_the_way: "extra-line",
    everything_is_in_inches: "outside-range",
    the_beam_is_too_weak: "wrong-power",
    the_beam_burns_on_where_the_head_is_slow: "wrong-beam",
}
