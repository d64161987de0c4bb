"""Units of the output: SI, field units (oil wells) or mine units. Everything that is computed is in SI; a writer asks
here for the number and the name of the unit, both by the unit that the output has in SI."""
from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from .errors import Usage
from .language import Foreign, Listed, Phrase
from .scene.units import factor_and_kind
from .unit_choice import NAMES

#: Unit in SI, in field units, in mine units; where there are two, the second one is for values of 1000 and more of the
#: first one.
TABLE: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "m": (("ft",), ("m",)), "mm": (("in",), ("mm",)), "m/s": (("ft/s",), ("m/s",)), "mm/s": (("ft/h",), ("mm/s",)),
    "m/s2": (("ft/s2",), ("m/s2",)),
    "N": (("lbf", "klbf"), ("kN",)), "kN": (("klbf",), ("kN",)), "N m": (("ft-lbf", "kft-lbf"), ("N m", "kN m")),
    "kN m": (("kft-lbf",), ("kN m",)),
    "N/m": (("lbf/ft",), ("kN/m",)), "N/m2": (("lbf/ft2",), ("kN/m2",)),
    "Pa": (("psi",), ("MPa",)), "MPa": (("psi",), ("MPa",)), "GPa": (("psi",), ("GPa",)), "kPa": (("psi",), ("kPa",)),
    "kg": (("lbm",), ("kg",)), "kg/m": (("lb/ft",), ("kg/m",)), "kg/m3": (("ppg",), ("kg/m3",)),
    "t": (("lbm",), ("t",)),
    "kg m/s": (("lbm ft/s",), ("kg m/s",)), "kg m2/s": (("lbm ft2/s",), ("kg m2/s",)),
    "J": (("ft-lbf",), ("kJ",)), "kJ": (("ft-lbf",), ("kJ",)), "W": (("hp",), ("kW",)), "kW": (("hp",), ("kW",)),
    "m3/s": (("gpm",), ("l/min",)),
    "rad": (("deg",), ("deg",)), "rad/s": (("rpm",), ("rpm",)), "rad/s2": (("deg/s2",), ("deg/s2",)),
    "rad/m": (("deg/100 ft",), ("deg/30 m",)), "deg/30 m": (("deg/100 ft",), ("deg/30 m",)),
    **{unit: ((unit,), (unit,)) for unit in ("-", "", "s", "ms", "Hz", "h", "rpm", "deg", "%")}}

_HEAD = re.compile(r"\[([^\[\]]*)\]\s*$")
_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"
_IN_TEXT = re.compile(rf"(?<![\w./-])({_NUMBER})((?:\s*(?:\.\.|to|and|x)\s*{_NUMBER})*) "
                      rf"({'|'.join(sorted((re.escape(unit) for unit in TABLE if unit not in ('', '-', '%')), key=len, reverse=True))})"  # noqa: E501
                      r"(?![\w/^(-]|\s?m\b)")


class UnknownUnit(Usage):
    """A quantity without an equivalent in the system."""


@functools.lru_cache(maxsize=300)
def _ratio(unit: str, other: str) -> float:
    return 1.0 if unit == other else float(factor_and_kind(unit)[0] / factor_and_kind(other)[0])


@dataclass(frozen=True)
class Units:
    """A system of units. All arguments `si` are units as the output has them in SI: "N", "kN", "mm"."""
    name: str = "si"

    def _units(self, si: str) -> tuple[str, ...]:
        if self.name == "si":
            return (si,)
        if si not in TABLE:
            raise UnknownUnit(f"the unit {si!r} has no equivalent in {self.name} units; give --units si")
        return TABLE[si][NAMES.index(self.name) - 1]

    def unit(self, si: str) -> str:
        """The name of the unit."""
        return self._units(si)[0]

    def factor(self, si: str) -> float:
        """The number in this system over that in the unit `si`."""
        return _ratio(si, self.unit(si))

    def head(self, text: str) -> str:
        """The head of a column or an axis with its unit, which is written at the end: "depth [m]" as "depth [ft]", "[N
        or N m]" as
        "[lbf or ft-lbf]"."""
        return text if self.name == "si" else \
            _HEAD.sub(lambda found: f"[{' or '.join(map(self.unit, found[1].split(' or ')))}]", text)

    def factor_of(self, head: str) -> float:
        """The factor of a column by its head; 1 without a unit, and with two, where each row has its own factor."""
        found = None if self.name == "si" else _HEAD.search(head)
        return self.factor(found[1]) if found and " or " not in found[1] else 1.0

    def number(self, value: float, si: str, form: str = ".4g") -> str:
        """A number without its unit. Outside SI no exponent where it can be avoided."""
        value = float(value)
        text = f"{value * self.factor(si):{form}}"
        return text if self.name == "si" or "e+" not in text or not abs(value) < 1e12 else \
            f"{value * self.factor(si):.0f}"

    def text(self, value: float, si: str, form: str = ".4g") -> str:
        """A number with its unit."""
        return f"{self.number(value, si, form)} {self.unit(si)}"

    def scaled(self, value: float, si: str, form: str = ".4g", prefixes: str = "k") -> str:
        """A number with the larger unit if it is large; in SI with one of the prefixes."""
        if self.name != "si":
            units = self._units(si)
            factor, unit = self.axis(si, [value]) if len(units) > 1 else (self.factor(si), units[0])
            return f"{self.number(value, si, form) if unit == units[0] else format(value * factor, form)} {unit}"
        for size, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
            if abs(value) >= size and prefix in prefixes:
                return f"{value / size:{form}} {prefix}{si}"
        return f"{value:{form}} {si}"

    def axis(self, si: str, *rows: Iterable[Any]) -> tuple[float, str]:
        """Factor and unit of an axis that shows rows of values: the larger unit where they reach 1000 of the smaller
        one."""
        units = (si, "k" + si) if self.name == "si" else self._units(si)
        factors = [_ratio(si, unit) for unit in units] if self.name != "si" else [1.0, 1e-3]
        largest = max((abs(float(value)) for row in rows for value in row if value == value and abs(value) < math.inf),
                      default=0.0)
        large = len(units) > 1 and largest * factors[0] >= 1e3
        return factors[large], units[large]

    def sentence(self, text: str) -> str:
        """A sentence of the library, in which numbers are followed by their SI units. Text in quotes stays as it was
        written."""
        def converted(found: re.Match[str]) -> str:
            unit = found[3]
            if self.unit(unit) == unit:
                return found[0]
            rest = re.sub(_NUMBER, lambda one: self.number(float(one[0]), unit, ".5g"), found[2])
            return f"{self.number(float(found[1]), unit, '.5g')}{rest} {self.unit(unit)}"
        if self.name == "si":
            return text
        if isinstance(text, Phrase):
            return Phrase(text.template, text.values, self)
        if isinstance(text, Listed):
            return Listed(text.separator, [self.sentence(part) for part in text.parts])
        if isinstance(text, Foreign):
            return Foreign(text.original, self)
        return "".join(part if i % 2 else _IN_TEXT.sub(converted, part)
                       for i, part in enumerate(re.split(r'("[^"]*")', text)))


SI = Units()
