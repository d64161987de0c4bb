"""Verdicts on demands and limits: a tile of the report, a line of the command."""
from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

from .language import joined, phrase
from .unit_systems import SI, Units

OK, NEAR, OVER = phrase("OK"), phrase("NEAR LIMIT"), phrase("OVER")
NO_LIMIT, NOT_ASSESSED, NOT_COMPUTED = phrase("NO LIMIT GIVEN"), phrase("NOT ASSESSED"), phrase("NOT COMPUTED")
WORST_FIRST = (OVER, NEAR, NOT_COMPUTED, NOT_ASSESSED, NO_LIMIT, OK)
NEAR_SHARE = 0.8  #: of a limit


def duration(seconds: float) -> str:
    """A fatigue life in words: hours, years from ten of them on."""
    hours, years = seconds / 3600.0, seconds / (365.25 * 86400.0)
    if years > 1000.0:
        return phrase("more than 1000 years")
    if years >= 10.0:
        return phrase("{years:.0f} years", years=years)
    return f"{hours:.0f} h" if hours >= 100.0 else f"{hours:.3g} h"


def shown(value: float, unit: str, units: Units = SI) -> str:
    """A number in three digits with a prefix; in four in other units than SI."""
    return units.scaled(value, unit, ".3g" if units.name == "si" else ".4g", "kMG")


def worst(verdicts: Iterable[str]) -> str:
    """The one that allows least."""
    return min(verdicts, key=WORST_FIRST.index)


@dataclass
class Tile:
    """One result: its name, the value, its explanation, the verdict."""
    title: str
    value: str
    text: str
    verdict: str

    def line(self) -> str:
        """The tile in one line."""
        return phrase("{title}: {value}, {verdict} ({text})", title=self.title, value=self.value, verdict=self.verdict,
                      text=self.text)

    def __str__(self) -> str:
        return self.line()


@dataclass
class Demand:
    """A quantity with a limit, from several analyses: the largest decides."""
    title: str
    unit: str
    limit: float | None
    found: list[tuple[float, str]] = field(default_factory=list)  #: value, analysis
    failed: list[str] = field(default_factory=list)               #: analyses without a result, loads that none has
    units: Units = SI                                             #: of the texts
    key: str = ""                                                 #: of [limits]

    def add(self, value: float, source: str) -> None:
        """The result of one analysis; a negative one, as the thrust of a string that hangs, demands nothing. NaN counts
        as an analysis without a result, so that the verdict is not OK."""
        if math.isnan(value):
            self.failed.append(phrase("{source}: no value", source=source))
        else:
            self.found.append((max(0.0, value), source))

    @property
    def value(self) -> float | None:
        return max(self.found)[0] if self.found else None

    @property
    def share(self) -> float | None:
        """Of the limit; None without a value or a limit."""
        return self.value / self.limit if self.value is not None and self.limit else None

    def tile(self) -> Tile:
        """Value, limit and share, and which analysis gave the largest value. With a failed analysis, or a load that no
        analysis has, the verdict is never OK."""
        if not self.found:
            reasons: str = joined("; ", self.failed) if self.failed else phrase("no analysis gave a value")
            return Tile(self.title, phrase("not computed"), reasons, NOT_COMPUTED)
        value, source = max(self.found)
        text: str = phrase("largest of {count} analyses: {source}", count=len(self.found),
                           source=source) if len(self.found) > 1 else source
        if self.failed:
            text = phrase("{text}; without {reasons}", text=text, reasons=joined("; ", self.failed))
        share = self.share
        if share is None or self.limit is None:
            if self.key:
                text = phrase("{text}; for a verdict give {key} in [limits]", text=text, key=self.key)
            return Tile(self.title, shown(value, self.unit, self.units), text, NO_LIMIT)
        verdict = OVER if share > 1.0 else NEAR if share > NEAR_SHARE else NOT_ASSESSED if self.failed else OK
        return Tile(self.title, shown(value, self.unit, self.units), phrase("{share:.0f} % of {limit}; {text}",
                                                                            share=100.0 * share, limit=shown(
            self.limit, self.unit, self.units), text=text), verdict)
