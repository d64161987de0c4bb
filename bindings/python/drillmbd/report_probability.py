"""The estimates of a study (drillmbd probability) in the report: probability, interval and margins of each failure."""
from __future__ import annotations

import csv
import json
import math
import os
import pathlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from .errors import Usage
from .language import Phrase, joined, phrase
from .report_figures import Figure, line
from .scene import Scene, saves
from .scene.failure import KINDS
from .unit_systems import Units
from .verdict import NO_LIMIT, NOT_COMPUTED, Tile, shown

ANY = "any failure"  #: as a study names it


@dataclass
class Outcome:
    """One failure of a study."""
    name: str
    estimate: dict[str, Any]       #: as summary.json has it
    unit: str = ""                 #: of limit and margins
    limit: float = math.nan
    margins: list[float] = field(default_factory=list)  #: of all samples that have one, rising
    question: str = "run"          #: of each sample
    demand: dict[str, Any] = field(default_factory=dict)  #: percentiles, as summary.json has them

    @property
    def title(self) -> Phrase:
        """Of tile and row."""
        return (phrase("Probability: any failure") if self.name == ANY else phrase("Probability: {failure}",
                                                                                   failure=self.name))

    @property
    def value(self) -> Phrase:
        """The probability; its upper bound where no sample failed, because such a study does not show 0."""
        if self.estimate["probability"] is None:
            return phrase("not computed")
        if not self.estimate["probability"] > 0.0:
            return phrase("at most {high}", high=percent(self.estimate["high"]))
        return phrase("{probability}", probability=percent(self.estimate["probability"]))

    @property
    def interval(self) -> Phrase:
        """With its confidence and the counts behind it."""
        one = self.estimate
        by = {"static": phrase("by the static state of each sample"),
              "torque-drag": phrase("by torque and drag of each sample, without dynamics"),
              "auto": phrase("by torque and drag of each sample, and runs of those near a limit and of a part of the "
                             "others")}.get(
                  self.question, phrase("by a run of each sample"))
        return phrase("{confidence:g} % interval {low} to {high}; {failures} of {samples} samples fail, {lost} have no "
                      "result; {by}", by=by,
                      low=percent(one["low"]), high=percent(one["high"]), confidence=100.0 * one["confidence"],
                      failures=one["failures"], samples=one["samples"], lost=one["lost"])

    def percentile_text(self, units: Units) -> str:
        """The demand that 95 of 100 samples do not pass, and its share of the limit; "" without one."""
        one = self.demand.get("percentiles", {}).get("P5" if self.demand.get("fails_below") else "P95")
        if not one or one.get("value") is None or one.get("share") is None:
            return ""
        value, share = amount(one["value"], self.unit, units), 100.0 * one["share"]
        if self.demand.get("limit_varies"):
            return phrase("in 95 of 100 samples the demand is {value} or less severe, {share:.3g} % of the limit of "
                          "the scene file, which varies",
                          value=value, share=share)
        return phrase("in 95 of 100 samples the demand is {value} or less severe, {share:.3g} % of the limit",
                      value=value, share=share)

    def margin_text(self, units: Units) -> str:
        """The median and the smallest margin, and the limit they are counted from; a negative margin is a failure."""
        if not self.margins:
            return phrase("margins: not kept by this study")
        middle, least = self.margins[len(self.margins) // 2], self.margins[0]
        if not math.isfinite(self.limit):
            return phrase("margin over its limit: median {median:.3g}, smallest {least:.3g}", median=middle,
                          least=least)
        limit, median, smallest = (amount(one, self.unit, units) for one in (self.limit, middle, least))
        if self.demand.get("limit_varies"):
            return phrase("limit {limit} in the scene file, which varies; margin: median {median}, smallest {least}",
                          limit=limit, median=median, least=smallest)
        return phrase("limit {limit}; margin: median {median}, smallest {least}", limit=limit, median=median,
                      least=smallest)


@dataclass
class Probability:
    """A study of the scene."""
    folder: str
    outcomes: list[Outcome]

    def tiles(self, units: Units) -> list[Tile]:
        """One for each failure. A scene gives no probability that may be, so that none is OK."""
        return [Tile(one.title, one.value, joined("; ", [text for text in (one.interval, one.margin_text(units),
                                                                           one.percentile_text(units)) if text]),
                     NOT_COMPUTED if one.estimate["probability"] is None else NO_LIMIT) for one in self.outcomes]

    def figures(self) -> list[Figure]:
        """The share of samples over margin by limit, of failures whose limit is not 0."""
        known = [one for one in self.outcomes if one.margins and one.limit]
        if not known:
            return []
        data = []
        for number, one in enumerate(known):
            scale = abs(one.limit) if math.isfinite(one.limit) else 1.0
            points = [(margin / scale, (i + 1) / len(one.margins)) for i, margin in enumerate(one.margins)
                      if math.isfinite(margin)]
            data.append(line([margin for margin, _ in points], [share for _, share in points],
                             phrase("any failure") if one.name == ANY else one.name, number))
        border = [{"type": "line", "x0": 0, "x1": 0, "yref": "paper", "y0": 0, "y1": 1,
                   "line": {"color": "#D55E00", "dash": "dash"}}]
        return [(phrase("Margins of the study"),
                 phrase("Share of samples whose margin is at most so large; left of the dashed line they fail. Study "
                        "in {folder}.",
                        folder=self.folder), {
            "data": data, "layout": {"shapes": border, "xaxis": {"title": {"text": phrase("margin over limit [-]")}},
                                     "yaxis": {"title": {"text": phrase("share of samples [-]")}}}})]


def amount(value: float, unit: str, units: Units) -> str:
    """A number with its unit, with a prefix where that is usual; the margin of a string that locks up is infinite."""
    if math.isinf(value):
        return "∞" if value > 0.0 else "-∞"
    if unit in ("N", "N m", "Pa"):
        return shown(value, unit, units)
    return f"{value:.3g}" if unit == "-" else units.text(value, unit, ".3g")


def percent(value: float | None) -> str:
    """ "1.2 %" """
    return "? %" if value is None else f"{100.0 * value:.3g} %"


def read_probability(folder: str, scene: Scene) -> Probability:
    """The study in the output folder of drillmbd probability. Raises Usage if it is none, or one of another scene."""
    place = pathlib.Path(folder)
    try:
        summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
        studied = (place / "scene.toml").read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise Usage(f"--probability {folder}: has no complete study: {error}; give the --output folder of drillmbd "
                    "probability") from error
    if summary.get("command") != "probability" or not summary.get("estimates"):
        raise Usage(f"--probability {folder}: has no estimates of drillmbd probability; give the --output folder of a "
                    "study of probabilities")
    now = saves(scene)
    if studied != now:
        first = next(((a, b) for a, b in zip([*studied.splitlines(), ""], [*now.splitlines(), ""]) if a != b), ("", ""))
        raise Usage(f"--probability {folder}: is a study of another scene; it has {first[0]!r} where this scene has "
                    f"{first[1]!r}; run drillmbd "
                    "probability again with this scene")
    question = summary.get("question", "run")
    # auto runs more of the samples near a limit
    margins = {} if question == "auto" else _margins(place / "samples.csv")
    limits = {one.name: (KINDS[one.kind].unit, one.limit) for one in scene.failures}
    scales = {name: abs(limit) or 1.0 for name, (_, limit) in limits.items()}
    outcomes, demands = [], summary.get("demands", {})
    for name, estimate in summary["estimates"].items():
        if name in limits:
            outcomes.append(Outcome(name, estimate, *limits[name], sorted(_known(margins.get(name, []))), question,
                                    demands.get(name, {})))
        else:
            each = [[margin / scales[one] for margin in margins[one]] for one in limits if one in margins]
            whole = sorted(_known(_least(row)
                                  for row in zip(*each))) if name == ANY and len(each) == len(limits) else []
            outcomes.append(Outcome(name, estimate, margins=whole, question=question))
    return Probability(os.path.basename(os.path.normpath(folder)), outcomes)


def _least(margins: Sequence[float]) -> float:
    """The smallest margin of a sample; NaN where one is not known."""
    return math.nan if any(math.isnan(one) for one in margins) else min(margins)


def _known(values: Iterable[float]) -> list[float]:
    return [one for one in values if not math.isnan(one)]


def _margins(path: pathlib.Path) -> dict[str, list[float]]:
    """Of each failure, sample by sample; empty where the study keeps none."""
    if not path.exists():
        return {}
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    prefix = "margin of "
    return {head[len(prefix):]: [float(row[i]) for row in rows[1:]] for i, head in enumerate(rows[0])
            if head.startswith(prefix)}
