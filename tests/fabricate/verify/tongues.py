"""Jobs in HP-GL told again in GP-GL and G-code: a second writer, that mends nothing.

The machine stays what it was but for its language, so that every way of spoiling a job in HP-GL
can be tried in the other languages.
"""

from __future__ import annotations

import hashlib
import re

from fabricate.verify.square_job import Job

from foldmill_fabricate.machines import Gcode, Machine
from foldmill_fabricate.passes import Plan, ProgramFile

TONGUES = {"gp-gl": "gp-gl", "z": "gcode", "beam": "gcode"}
"""Ways of telling a job, and their languages."""
SUFFIXES = {"gp-gl": ".gpgl", "z": ".nc", "beam": ".nc"}
_PAIR = re.compile(r"(-?\d+),(-?\d+)")


def machine(of: Machine, tongue: str) -> Machine:
    """Return a machine that differs in nothing but its language."""
    gcode = Gcode.model_validate({"lowers": "beam" if tongue == "beam" else "z"})
    tools = of.tools.model_copy(update={"force_unit": 1.0, "speed_unit": 10.0})
    changes = {"language": TONGUES[tongue], "gcode": gcode, "tools": tools}
    return of.model_copy(update=changes)


def told(job: Job, tongue: str) -> Job:
    """Return the job told in another tongue; a program that was edited stays edited."""
    plan = job.plan.model_copy(update={"machine": machine(job.plan.machine, tongue)})
    programs = {
        renamed(name, tongue): told_again(plan, data, tongue) for name, data in job.programs.items()
    }
    files = tuple(_recorded(file, job, programs, tongue) for file in plan.programs)
    return Job(plan.model_copy(update={"programs": files}), job.pattern, programs)


def renamed(name: str, tongue: str) -> str:
    return name.replace(".hpgl", SUFFIXES[tongue])


def _recorded(file: ProgramFile, job: Job, programs: dict[str, bytes], tongue: str) -> ProgramFile:
    name = renamed(file.name, tongue)
    data = job.programs.get(file.name, b"")
    is_own = hashlib.sha256(data).hexdigest() == file.sha256
    digest = hashlib.sha256(programs.get(name, b"")).hexdigest() if is_own else file.sha256
    return file.model_copy(update={"name": name, "sha256": digest})


def told_again(plan: Plan, program: bytes, tongue: str) -> bytes:
    found = re.findall(r"([A-Z]{2})([^;]*);", program.decode())
    return (_gpgl if tongue == "gp-gl" else _gcode)(plan, found, tongue).encode()


def _gpgl(plan: Plan, instructions: list[tuple[str, str]], _: str) -> str:
    tools, units = plan.machine.tools, plan.machine.axes.units_per_mm
    offset = tools.blade_offset if tools.trails and tools.firmware_offset else 0
    words: list[str] = []
    for name, text in instructions:
        here = [",".join(words[-1][1:].split(",")[-2:])] if words and words[-1][0] == "D" else []
        words += {
            "SP": [f"J{text}", f"FC{offset * units:.0f}"] if text != "0" else ["H"],
            "VS": [f"!{text}"],
            "FS": [f"FX{text}"],
            "PU": [f"M{place}" for place in ([text] if text else here)],
            "PD": [f"D{text}"],
        }.get(name, [])
    return "".join(word + "\x03" for word in words)


def _gcode(plan: Plan, instructions: list[tuple[str, str]], tongue: str) -> str:
    """A force stands for a depth, or for how the beam is switched on."""
    score, cut = plan.material.score, plan.material.cut
    off = "M5" if tongue == "beam" else "G0 Z5"
    on, feed, down = "", "", False
    lines = ["G90 (absolute)", "G21 ; mm", off]
    for name, text in instructions:
        pairs = [(int(x) / 40, int(y) / 40) for x, y in _PAIR.findall(text)]
        if name in {"PU", "SP"} and down:
            lines.append(off)
            down = False
        if name == "SP" and text != "0":
            lines.append(f"T{text}")
        elif name == "VS":
            feed = f"F{int(text) * 600}"
        elif name == "FS":
            depth = score.exposure if float(text) == score.force else cut.exposure
            beam = "M4 S1000" if float(text) == score.force else "M3 S1000"
            on = beam if tongue == "beam" else f"G1 Z{-depth} F300"
        elif name == "PU":
            lines += [f"G0 X{x:.3f} Y{y:.3f}" for x, y in pairs]
        elif name == "PD":
            lines += [] if down else [on]
            down = True
            lines += [f"G1 X{x:.3f} Y{y:.3f} {feed}" for x, y in pairs]
    return "\n".join([*lines, "M2"]) + "\n"
