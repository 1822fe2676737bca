"""Quantities as presets write them: "0.75 mm", "10 cm/s", "240 gf". Read once, then plain numbers.

Presets are tables people edit, so the unit stands in the value; the models behind them hold one
fixed unit per field. The half dozen units of the trade do not pay for a unit library, whose import
alone takes longer than planning a sheet.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

_FACTORS: dict[str, dict[str, float]] = {
    "mm": {"mm": 1.0, "cm": 10.0, "um": 1e-3, "in": 25.4},
    "deg": {"deg": 1.0},
    "deg/s": {"deg/s": 1.0},
    "gf": {"gf": 1.0, "kgf": 1000.0, "N": 101.971621},
    "mm/s": {"mm/s": 1.0, "cm/s": 10.0},
    "mm/s2": {"mm/s2": 1.0, "m/s2": 1000.0},
    "s": {"s": 1.0, "ms": 1e-3},
    "steps/mm": {"steps/mm": 1.0, "steps/in": 1 / 25.4},
    "g/cm3": {"g/cm3": 1.0},
    "GPa": {"GPa": 1.0, "MPa": 1e-3},
    "1e-6/K": {"1e-6/K": 1.0},
    "°C": {"°C": 1.0},
}


def _reader(unit: str) -> Callable[[object], object]:
    factors = _FACTORS[unit]

    def read(value: object) -> object:
        if not isinstance(value, str):
            return value  # already in the field's own unit, as in a stored plan
        number, _, given = value.strip().partition(" ")
        if given not in factors:
            raise ValueError(f'write a number and a unit, such as "1 {unit}"; not {value!r}')
        try:
            return float(number) * factors[given]
        except ValueError:
            raise ValueError(f"{number!r} is no number") from None

    return read


def _unit(unit: str) -> tuple[BeforeValidator, Any]:
    return BeforeValidator(_reader(unit)), Field(
        allow_inf_nan=False, json_schema_extra={"x-unit": unit}
    )


Mm = Annotated[float, *_unit("mm")]
Deg = Annotated[float, *_unit("deg")]
DegPerSecond = Annotated[float, *_unit("deg/s")]
GramForce = Annotated[float, *_unit("gf")]
MmPerSecond = Annotated[float, *_unit("mm/s")]
MmPerSecond2 = Annotated[float, *_unit("mm/s2")]
Seconds = Annotated[float, *_unit("s")]
StepsPerMm = Annotated[float, *_unit("steps/mm")]
GramsPerCm3 = Annotated[float, *_unit("g/cm3")]
Gigapascal = Annotated[float, *_unit("GPa")]
PerMillionKelvin = Annotated[float, *_unit("1e-6/K")]
Celsius = Annotated[float, *_unit("°C")]
