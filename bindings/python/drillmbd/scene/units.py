"""Quantities with units as people write them: "63.5 mm", "120 rpm", "90 deg", '9 5/8"', "20 klb". Angles count as a
dimension where a frequency could be taken for a rotary speed. Decimal numbers keep "63.5 mm" the double next to
0.0635."""
from __future__ import annotations

import difflib
import functools
import math
import re
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from . import number_text
from .unit_names import GRAVITY, NOTHING, USUAL, Unit, tables
from .unit_text import UnknownUnit, meanings, plain

_PER_MINUTE = ("1/min", "/min", "min-1", "min^-1", "1/分", "/分", "1/minute")


class UnitError(ValueError):
    """A text that is no quantity, or one of another kind."""


@dataclass(frozen=True)
class Reading:
    """A value with the assumption that was made."""
    value: float       #: SI
    remark: str = ""   #: an assumption that the reader should see


def factor_and_kind(unit: str) -> tuple[Decimal, tuple[float, ...], float]:
    """The factor to SI, the powers of m, kg and s, and that of the angle. Raises UnitError."""
    found = NOTHING if unit in ("", "-") else _meanings(unit)[0][1]
    return found.factor, found.powers[:3], found.powers[3]


def _meanings(unit: str) -> tuple[tuple[bool, Unit, str], ...]:
    try:
        return meanings(unit)
    except UnknownUnit as error:
        raise UnitError(f"'{error.args[0]}' {error.args[1]}" if error.args[1].startswith("is")
                        else error.args[1]) from error


@functools.lru_cache(maxsize=200)
def _wanted_unit(wanted: str) -> Unit:
    return NOTHING if wanted in ("", "-") else _meanings(wanted)[0][1]


def _fits(unit: Unit, wanted: Unit) -> bool:
    """Whether a unit is of the kind of the wanted one. 1 rad counts as 1, but Hz is not rad/s, nor rpm Hz, nor is a
    bare number an angle."""
    if unit.powers[:3] != wanted.powers[:3]:
        return False
    frequency = wanted.powers[:3] == (0.0, 0.0, -1.0)
    angle = wanted.powers[:3] == (0.0, 0.0, 0.0) and wanted.powers[3] != 0.0
    return unit.powers[3] == wanted.powers[3] if frequency or angle else True


def _by_weight(unit: Unit, wanted: Unit) -> int:
    """1: a mass where a force is wanted, -1: the other way round, by the standard gravity; else 0."""
    if (unit.powers[1] != 1.0 or wanted.powers[1] != 1.0 or unit.powers[0] == unit.powers[2] == 0.0 == wanted.powers[0]
        == wanted.powers[2]):
        return 0
    for sign in (1, -1):
        if (unit.powers[0] + sign, unit.powers[2] - 2 * sign) == (wanted.powers[0], wanted.powers[2]):
            return sign
    return 0


def fits(unit: str, wanted: str) -> bool:
    """Whether a unit as written is of the kind of the wanted one."""
    try:
        return bool(_chosen(unit, (wanted,)))
    except UnitError:
        return False


def other_than(unit: str, wanted: str) -> bool:
    """Whether a text is a unit, and another one than the wanted one: mm or s where values are in m."""
    try:
        known = unit == "-" or bool(_meanings(unit))
    except UnitError:
        return False
    return known and not (fits(unit, wanted) and factor(unit, wanted) == factor(wanted, wanted))


@functools.lru_cache(maxsize=2000)
def _chosen(unit: str, options: tuple[str, ...]) -> tuple[Decimal, str] | None:
    """Factor and remark for a unit as written, by the wanted kind; None where it is of another kind. Raises
    UnitError."""
    if unit in ("", "-"):
        return (Decimal(1), "") if "-" in options else None
    wanted = [_wanted_unit(option) for option in options]
    if "rad/s" in options and "Hz" not in options and plain(unit).replace(" ", "").casefold() in _PER_MINUTE:
        return _meanings("rev/min")[0][1].factor, "is taken as revolutions per minute"
    found = _meanings(unit)
    for own in (True, False):
        factors = {one.factor: name for as_written, one, name in found if as_written is own
                   and any(_fits(one, to) for to in wanted)}
        if len(factors) == 1:
            return next(iter(factors)), ""
        if factors:
            raise UnitError(f"has the unit '{unit}', which may be {' or '.join(factors.values())}")
    for own in (True, False):
        for as_written, one, name in found:
            sign = next((by for by in (_by_weight(one, to) for to in wanted) if by), 0)
            if as_written is own and sign:
                return one.factor * (GRAVITY if sign > 0 else 1 / GRAVITY), _weight_remark(unit, sign, options)
    return None


def _weight_remark(unit: str, sign: int, options: tuple[str, ...]) -> str:
    if sign > 0:
        return f"has '{unit}', a unit of mass: its weight is taken"
    return f"has '{unit}', a unit of weight: the mass of that weight is taken"


def interpret(value: Any, wanted: str) -> Reading:
    """The value in SI of a text like "63.5 mm", or of a number where the wanted unit is none or the number is 0, with
    the assumption. `wanted` may be alternatives, comma between. Raises UnitError that states the wanted unit."""
    options = tuple(one.strip() for one in wanted.split(",")) if wanted else ("-",)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise UnitError(f"must be {_wanted(options)}")
    if not isinstance(value, str):
        if "-" not in options and value != 0:
            raise UnitError(f"must have a unit: {_wanted(options)}")
        return Reading(scaled(Decimal(value), Decimal(1)) if isinstance(value, int) else value)
    return _of_text(value, options)


def parse(value: Any, wanted: str) -> float:
    """The value in SI, as interpret has it."""
    return interpret(value, wanted).value


def remark(value: Any, wanted: str) -> str:
    """The assumption that parse makes of a value; "" if it makes none."""
    try:
        return interpret(value, wanted).remark if isinstance(value, str) else ""
    except UnitError:
        return ""


@functools.lru_cache(maxsize=5000)
def _of_text(text: str, options: tuple[str, ...]) -> Reading:
    compound = _compound(text, options)
    if compound is not None:
        return Reading(compound)
    try:
        number, unit, diameter = number_text.split(text)
    except number_text.NoNumber as error:
        raise UnitError(str(error) or f"must be {_wanted(options)}") from error
    if diameter and "m" not in options:
        raise UnitError(f"is a diameter, must be {_wanted(options)}")
    assumed = f"is taken as {number} mm" if diameter and not unit else ""
    factor, about = _factor_of("mm" if assumed else unit, options)
    return Reading(scaled(number, factor), assumed or about)


def scaled(number: Decimal, by: Decimal) -> float:
    """Their product, the double next to it. Raises UnitError where there is none."""
    try:
        found = float(number * by)
    except ArithmeticError:
        found = math.inf
    if not math.isfinite(found):
        raise UnitError("must be finite")
    return found


def _factor_of(unit: str, options: tuple[str, ...]) -> tuple[Decimal, str]:
    try:
        chosen = _chosen(unit, options)
    except UnitError as error:
        raise UnitError(str(error) + (_neighbours(unit, options) if "is not a known unit" in str(error)
                                      else "")) from error
    if chosen is None:
        raise UnitError((f"has the unit '{unit}'" if unit else "has no unit") + f", must be {_wanted(options)}"
                        + _hint(unit, options))
    return chosen


def _compound(text: str, options: tuple[str, ...]) -> float | None:
    """30'6" and 12°30'15" are feet with inches and degrees with minutes and seconds."""
    text = plain(text).replace(" ", "")
    number = r"(\d+(?:\.\d+)?)"
    feet = re.fullmatch(rf"([-+]?){number}'{number}\"", text) if "m" in options else None
    if feet:
        return float((Decimal(feet[2]) * 12 + Decimal(feet[3])) * Decimal("0.0254") * (-1 if feet[1] == "-" else 1))
    angle = re.fullmatch(rf"([-+]?){number}°(?:{number}')(?:{number}\")?", text) if "rad" in options else None
    if angle:
        degrees = Decimal(angle[2]) + Decimal(angle[3]) / 60 + Decimal(angle[4] or 0) / 3600
        return float(degrees * _wanted_unit("deg").factor * (-1 if angle[1] == "-" else 1))
    return None


def factor(unit: str, wanted: str) -> Decimal:
    """The factor to SI of a unit by itself, as in a head of a table. Raises UnitError."""
    return _factor_of(unit, tuple(one.strip() for one in wanted.split(",")))[0]


# ---- Messages --------------------------------------------------------------------------------------------------------
def _hint(unit: str, options: tuple[str, ...]) -> str:
    if unit and any(option in ("rad/s", "Hz") for option in options) and factor_and_kind(unit)[1] == (0.0, 0.0, -1.0):
        return "; a frequency in Hz is no rotary speed in rpm or rad/s"
    return ""


def _usual(options: tuple[str, ...]) -> list[str]:
    return list(dict.fromkeys(name for option in options
                              for name in USUAL.get(option, () if option == "-" else (option,))))


def _neighbours(unit: str, options: tuple[str, ...]) -> str:
    """Units of the wanted kind that are spelled nearly so, or the usual ones."""
    wanted = [_wanted_unit(option) for option in options]
    known = {name.casefold(): one.factor for name, one in tables()[0].items() if any(_fits(one, to) for to in wanted)}
    names = {known[name]: name for name in reversed(known)}
    names.update({_wanted_unit(name).factor: name for name in reversed(_usual(options))})
    close = dict.fromkeys(names[known[name]] for name in difflib.get_close_matches(unit.casefold(), known, 3, 0.6))
    meant = f"; did you mean {' or '.join(list(close)[:2])}?" if close else ""
    usual = _usual(options)
    return meant + (f"{'' if meant else ';'} units of this quantity are {', '.join(usual)}" if usual
                    else "; must be a number without unit")


def _wanted(options: tuple[str, ...]) -> str:
    examples = {"-": "a number", "m": "a length, as \"63.5 mm\"", "rad/s": "a rotary speed, as \"120 rpm\"",
                "rad": "an angle, as \"90 deg\"", "s": "a time, as \"10 ms\"", "N": "a force, as \"2 kN\"",
                "m/s": "a speed, as \"10 mm/s\"", "kg": "a mass, as \"5 kg\"", "Hz": "a frequency, as \"5 Hz\"",
                "N m": "a torque, as \"3 kN m\"", "Pa": "a pressure or stress, as \"500 MPa\"",
                "kg/m3": "a density, as \"1200 kg/m3\"", "m3/s": "a flow, as \"500 l/min\"",
                "kg/m": "a mass per length, as \"20 kg/m\"",
                "rad/m": "a curvature, as \"3 deg/30 m\""}
    return " or ".join(dict.fromkeys(examples.get(one, f"a quantity in {one}") for one in options))


def text(value: float, unit: str) -> Any:
    """A value in SI as it is written: a number without unit, or a text with the unit's own name."""
    number = int(value) if isinstance(value, int) else float(value)
    return number if unit in ("", "-") else f"{number!r} {unit}"
