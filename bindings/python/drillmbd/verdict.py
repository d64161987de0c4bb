"""Verdicts on demands and limits: a tile of the report, a line of the command."""
from __future__ import annotations

from dataclasses import dataclass, field

from .unit_systems import SI, Units

OK, NEAR, OVER = "OK", "NEAR LIMIT", "OVER"
NO_LIMIT, NOT_ASSESSED, NOT_COMPUTED = "NO LIMIT GIVEN", "NOT ASSESSED", "NOT COMPUTED"
NEAR_SHARE = 0.8  #: of a limit


def shown(value: float, unit: str, units: Units = SI) -> str:
    """A number in three digits with a prefix; in four in other units than SI."""
    return units.scaled(value, unit, ".3g" if units.name == "si" else ".4g", "kMG")


@dataclass
class Tile:
    """One answer: what was asked, the value, its explanation, the verdict."""
    title: str
    value: str
    text: str
    verdict: str

    def __str__(self) -> str:
        return f"{self.title}: {self.value}, {self.verdict} ({self.text})"


@dataclass
class Demand:
    """A quantity with a limit, from several analyses: the largest decides."""
    title: str
    unit: str
    limit: float | None
    found: list[tuple[float, str]] = field(default_factory=list)  #: value, analysis
    failed: list[str] = field(default_factory=list)               #: reasons of analyses without a result
    units: Units = SI                                             #: of the texts

    def add(self, value: float, source: str) -> None:
        """The result of one analysis; a negative one, as the thrust of a string that hangs, demands nothing."""
        if value == value:
            self.found.append((max(value, 0.0), source))

    @property
    def value(self) -> float | None:
        return max(self.found)[0] if self.found else None

    def tile(self) -> Tile:
        """Value, limit and share, and which analysis gave the largest value. With a failed analysis the verdict is never OK."""
        if not self.found:
            return Tile(self.title, "not computed", "; ".join(self.failed) or "no analysis gave a value", NOT_COMPUTED)
        value, source = max(self.found)
        text = f"largest of {len(self.found)} analyses: {source}" if len(self.found) > 1 else source
        if self.failed:
            text += "; without " + "; ".join(self.failed)
        if not self.limit:
            return Tile(self.title, shown(value, self.unit, self.units), text, NO_LIMIT)
        share = value / self.limit
        verdict = OVER if share > 1.0 else NEAR if share > NEAR_SHARE else NOT_ASSESSED if self.failed else OK
        return Tile(self.title, shown(value, self.unit, self.units), f"{100.0 * share:.0f} % of {shown(self.limit, self.unit, self.units)}; {text}", verdict)
