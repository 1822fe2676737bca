"""What a program must have set when a line is drawn, derived once more from plan and profile."""

from __future__ import annotations

from collections.abc import Iterator

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan, SetUp
from foldmill_fabricate.verify.interpreter import Run

_SAME = 1e-3
"""What two settings may differ by that are the same: programs spell them with few decimals."""
_UNITS = {"depth": " mm", "blade offset": " steps", "power": " of S", "beam": " (3: M3, 4: M4)"}


def speed_unit(machine: Machine) -> float:
    """Return what one unit of speed in a program is worth, mm/s."""
    return {"hpgl": 10.0, "gcode": 1 / 60}.get(machine.language, machine.tools.speed_unit)


def force_unit(machine: Machine) -> float:
    """Return what one unit of force in a program is worth, gf."""
    return 1.0 if machine.language == "hpgl" else machine.tools.force_unit


def as_near(value: float | None, wanted: float, unit: float) -> bool:
    """Tell whether a setting is as near to what is wanted as whole units, at least one, can be."""
    return value is not None and abs(value - max(wanted, unit)) <= unit / 2 + 1e-9


def wrong(plan: Plan, run: Run, setup: SetUp) -> Iterator[tuple[str, str]]:
    """Yield code and sentence of each setting of a run that is not its set-up's."""
    machine, dialect = plan.machine, plan.machine.dialect
    if (run.tool or 0) != setup.tool:
        yield "wrong-tool", f"It uses tool {run.tool}, not {setup.tool}"
    if dialect.speed and not as_near(run.speed, setup.speed, speed_unit(machine)):
        yield "wrong-speed", f"The speed is {_said(run.speed)} mm/s, not {setup.speed:g}"
    forced = dialect.force and machine.language != "gcode"
    if forced and not as_near(run.force, setup.force, force_unit(machine)):
        yield "wrong-force", f"The force is {_said(run.force)} gf, not {setup.force:g}"
    given = dict(run.settings)
    for name, value in _others(plan, setup):
        is_so = name in given and abs(given[name] - value) <= _SAME
        if not is_so:
            told = f"{given[name]:g}{_UNITS[name]}" if name in given else "not set"
            text = f"The {name} is {told}, not {value:g}{_UNITS[name]}"
            yield f"wrong-{name.replace(' ', '-')}", text


def _said(value: float | None) -> str:
    return "an unknown number of" if value is None else f"{value:g}"


def _others(plan: Plan, setup: SetUp) -> Iterator[tuple[str, float]]:
    """Yield what else a program of this language sets."""
    machine, gcode = plan.machine, plan.machine.gcode
    if machine.language == "gp-gl":
        yield "blade offset", _blade_offset(plan, setup)
    elif machine.language == "gcode" and gcode.lowers == "beam":
        scores = setup.process == "score"
        yield "beam", 4.0 if scores else 3.0
        yield "power", gcode.score_power if scores else gcode.cut_power
    elif machine.language == "gcode":
        yield "depth", setup.exposure if setup.exposure > 0 else gcode.press


def _blade_offset(plan: Plan, setup: SetUp) -> float:
    """Return the steps from axis to tip that the machine itself makes up for."""
    tools = plan.machine.tools
    kind = (plan.material.score if setup.process == "score" else plan.material.cut).kind
    if kind in {"stylus", "pen"} or not tools.trails or not tools.firmware_offset:
        return 0.0
    return float(int(tools.blade_offset * plan.machine.axes.units_per_mm + 0.5))
