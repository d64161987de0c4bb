"""Quantities with units as people write them: "63.5 mm", "120 rpm", "90 deg". pint knows the units; angles count as a
dimension where a frequency could be taken for a rotary speed. Decimal numbers keep "63.5 mm" the double next to 0.0635."""
from __future__ import annotations

import functools
import math
import re
from decimal import Decimal
from typing import Any

from .._optional import need

_NUMBER = re.compile(r"\s*([-+]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$", re.S)


class UnitError(ValueError):
    """A text that is no quantity, or one of another kind."""


@functools.lru_cache(maxsize=1)
def _registry() -> Any:
    registry = need("pint").UnitRegistry(non_int_type=Decimal)
    registry.define("rev = revolution")
    registry.define("percent = 0.01 = pct")
    return registry


def _prepared(unit: str) -> str:
    """'kg m2' as pint takes it."""
    unit = unit.replace("%", "percent").replace("°", "deg")
    unit = re.sub(r"(?<=[A-Za-z])(?=\d)", "^", unit)
    return re.sub(r"(?<=[\w)])\s+(?=[A-Za-z(])", "*", unit.strip())


@functools.lru_cache(maxsize=1000)
def factor_and_kind(unit: str) -> tuple[Decimal, tuple[tuple[str, float], ...], float]:
    """The factor to SI, the dimensions without angles, and the exponent of the angle. Raises UnitError."""
    if unit in ("", "-"):
        return Decimal(1), (), 0.0
    try:
        base = _registry().Quantity(Decimal(1), _registry().parse_units(_prepared(unit))).to_base_units()
        powers = {name: float(power) for name, power in base._units.items()}
        dimensions = {name: float(power) for name, power in base.dimensionality.items()}
    except ImportError:
        raise
    except Exception as error:  # pint and its parser raise many kinds
        raise UnitError(f"'{unit}' is not a known unit") from error
    angle = powers.pop("radian", 0.0)
    kind = tuple(sorted((name, power) for name, power in dimensions.items() if power))
    return Decimal(base.magnitude), kind, angle


def fits(unit: str, wanted: str) -> bool:
    """Whether a unit is of the kind of the wanted one. 1 rad counts as 1, but Hz is not rad/s, nor rpm Hz, nor is a bare
    number an angle."""
    _, kind, angle = factor_and_kind(unit)
    _, wanted_kind, wanted_angle = factor_and_kind(wanted)
    if kind != wanted_kind:
        return False
    frequency = wanted_kind == (("[time]", -1.0),)
    return angle == wanted_angle if frequency or (wanted_kind == () and wanted_angle) else True


def parse(value: Any, wanted: str) -> float:
    """The value in SI of a text like "63.5 mm", or of a number where the wanted unit is none or the number is 0.
    `wanted` may be alternatives, comma between. Raises UnitError that says what is wanted."""
    options = [one.strip() for one in wanted.split(",")] if wanted else ["-"]
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise UnitError(f"must be {_wanted(options)}")
    if not isinstance(value, str):
        if "-" not in options and value != 0:
            raise UnitError(f"must have a unit: {_wanted(options)}")
        return float(value)
    match = _NUMBER.match(value)
    if match is None:
        raise UnitError(f"must be {_wanted(options)}")
    number, unit = Decimal(match.group(1).replace("_", "")), match.group(2)
    if not any(fits(unit, option) for option in options):
        hint = ""
        if any(option in ("rad/s", "Hz") for option in options) and factor_and_kind(unit)[1] == (("[time]", -1.0),):
            hint = "; a frequency in Hz is no rotary speed in rpm or rad/s"
        raise UnitError((f"has the unit '{unit}'" if unit else "has no unit") + f", must be {_wanted(options)}{hint}")
    found = float(number * factor_and_kind(unit)[0])
    if not math.isfinite(found):
        raise UnitError("must be finite")
    return found


def _wanted(options: list[str]) -> str:
    examples = {"-": "a number", "m": "a length, as \"63.5 mm\"", "rad/s": "a rotary speed, as \"120 rpm\"",
                "rad": "an angle, as \"90 deg\"", "s": "a time, as \"10 ms\"", "N": "a force, as \"2 kN\"",
                "m/s": "a speed, as \"10 mm/s\"", "kg": "a mass, as \"5 kg\"", "Hz": "a frequency, as \"5 Hz\""}
    return " or ".join(dict.fromkeys(examples.get(one, f"a quantity in {one}") for one in options))


def text(value: float, unit: str) -> Any:
    """A value in SI as it is written: a number without unit, or a text with the unit's own name."""
    number = int(value) if isinstance(value, int) else float(value)
    return number if unit in ("", "-") else f"{number!r} {unit}"
