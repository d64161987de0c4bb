"""Tiles and figures of the report that come from linear analyses: speeds to avoid, buckling."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from . import enums
from .results import RPM, CommandOutput
from .critical_speeds import LINEAR, analyse, left_out
from .enums import Status
from .language import Phrase, joined, phrase
from .no_response import NOTHING_EXCITES
from .operating import Operating
from .report_figures import Figure, line
from .scene import Scene
from .sim import Sim
from .verdict import NEAR, NEAR_SHARE, NOT_ASSESSED, OK, OVER, Tile

NEAR_BAND = 0.1  #: of the rotation: a critical band so near is "near"
SAME = 1e-3      #: of a speed: closer ones are equal
MOST_BANDS = 4      #: bands in a tile


@dataclass
class Speeds:
    """Bands of rotary speed to avoid and the largest severity, over a grid [rad/s]."""
    bands: Any
    severity: Sequence[float]
    grid: list[float]
    refused: bool = False  #: the sliding state has no solution, that at rest takes its place
    silent: Phrase | None = None  #: why nothing moves the outputs
    unmoved: Sequence[str] = ()   #: names of outputs that nothing moves, where another moves
    neglects: str = ""            #: sentence about effects that the analysis leaves out

    @property
    def assessed(self) -> bool:
        """False where nothing excites the outputs."""
        return self.silent is None and max(self.severity) > 0.0

    @property
    def partial(self) -> bool:
        """True if an order or an output has no response, the sliding state no solution, or the analysis leaves effects
        out: a speed in no band is not free of critical ones."""
        return bool(self.bands.report.silent_orders or self.unmoved or self.refused or self.neglects)

    def avoid(self) -> str:
        """The bands in words."""
        found = [self._band(band) for band in self.bands[:MOST_BANDS]]
        if len(self.bands) > MOST_BANDS:
            found.append(phrase("{count} more bands", count=len(self.bands) - MOST_BANDS))
        return joined(", ", found)

    def notes(self) -> list[str]:
        """Parts that the analysis leaves out."""
        return [*left_out(self.bands.report), *([self.neglects] if self.neglects else [])]

    def _band(self, band: Any) -> str:
        """A band that reaches an end of the range may continue beyond it."""
        low, high = band.low / RPM, band.high / RPM
        if band.high >= self.grid[-1] * (1.0 - SAME):
            return phrase("{low:.0f} rpm and more", low=low)
        at_low = band.low <= self.grid[0] * (1.0 + SAME)
        return (phrase("{high:.0f} rpm and less", high=high) if at_low else phrase("{low:.0f} to {high:.0f} rpm",
                                                                                   low=low, high=high))

    def allowed(self) -> list[tuple[float, float]]:
        """[rpm] The ranges that were assessed and are in no band, in whole revolutions inside."""
        found, begin = [], self.grid[0]
        for band in sorted(self.bands, key=lambda one: float(one.low)):
            if band.low > begin:
                found.append((begin, band.low))
            begin = max(begin, band.high)
        found.append((begin, self.grid[-1]))
        whole = [(math.ceil(low / RPM - 1e-6), math.floor(high / RPM + 1e-6)) for low, high in found]
        return [(low, high) for low, high in whole if high > low]


def speeds(scene: Scene, note: Callable[[str], object]) -> Speeds:
    """The speeds of [speeds], about the string that slides at the rotation of the scene."""
    found = analyse(scene, lambda sim, state: sim.static(**state.static), note)
    names = [one["name"] for one in scene.analyses["speeds"]["output"]]
    return Speeds(found.bands, found.severity, found.grid, found.state.refused, found.silent,
                  [names[number] for number in found.unmoved], found.neglects)


def speeds_tile(found: Speeds, plan: Operating) -> Tile:
    """The verdict on the rotation of the scene. Never OK without excitation, for a rotation outside the range, or with
    orders that excite nothing or outputs that nothing moves."""
    title = phrase("Critical speeds")
    if not found.assessed:
        return Tile(title, phrase("not assessed"), found.silent or NOTHING_EXCITES, NOT_ASSESSED)
    low, high = found.grid[0] / RPM, found.grid[-1] / RPM
    value = phrase("avoid {bands}", bands=found.avoid()) if found.bands else phrase("none found")
    text = phrase("assessed between {low:.0f} and {high:.0f} rpm, amplitudes at most {severity:.3g} times their "
                  "limits. {linear}", low=low, high=high,
                  severity=max(found.severity), linear=LINEAR)
    planned = plan.rotation
    if planned is None:
        return Tile(title, value, phrase("the scene gives no rotation to compare with; {text}", text=text),
                    NOT_ASSESSED)
    rpm = planned / RPM
    if not found.grid[0] <= planned <= found.grid[-1]:
        return Tile(title, value, phrase("the rotation of {rpm:.4g} rpm is outside the range of [speeds]; {text}",
                                         rpm=rpm, text=text), NOT_ASSESSED)
    inside = any(band.low <= planned <= band.high for band in found.bands)
    near = any(band.low * (1.0 - NEAR_BAND) <= planned <= band.high * (1.0 + NEAR_BAND) for band in found.bands)
    remarks = phrase("rotation {rpm:.4g} rpm; {text}", rpm=rpm, text=text)
    silent = int(found.bands.report.silent_orders)
    if silent:
        remarks = phrase("{silent} of the orders excite nothing; {text}", silent=silent, text=remarks)
    if found.unmoved:
        remarks = phrase("the excitation does not move {outputs}; {text}", outputs=joined(", ", found.unmoved),
                         text=remarks)
    if found.refused:
        remarks = phrase("the sliding state of the rotating string has no solution, the state at rest takes its place; "
                         "{text}", text=remarks)
    if found.neglects:
        remarks = phrase("the linear analysis leaves out effects of the rotation; {text}", text=remarks)
    return Tile(title, value, remarks, OVER if inside else NEAR if near else NOT_ASSESSED if found.partial else OK)


def speeds_figure(found: Speeds) -> Figure:
    """Severity over rotary speed, bands shaded."""
    shapes = [{"type": "rect", "x0": band.low / RPM, "x1": band.high / RPM, "yref": "paper", "y0": 0, "y1": 1,
               "fillcolor": "#E69F00", "opacity": 0.35, "line": {"width": 0}} for band in found.bands]
    return (phrase("Severity by rotary speed"),
            phrase("Severity 1 is the limit of an amplitude; shaded speeds are to be avoided. {linear}", linear=LINEAR),
            {
        "data": [line([one / RPM for one in found.grid], found.severity, phrase("amplitude over limit"), 0)],
        "layout": {
            "shapes": shapes, "xaxis": {"title": {"text": phrase("rotary speed [rpm]")}},
            "yaxis": {"title": {"text": phrase("amplitude over limit [-]")}, "type": "log"}}})


def buckling_tile(scene: Scene, to_rest: Callable[[Sim], Any], out: CommandOutput) -> Tile:
    """The lowest critical factor of [buckling]: the string becomes unstable at 1 + factor times the present loads.
    Never OK where none was found, it was not confirmed, or flutter could not be assessed."""
    values = scene.fields_of("buckling")
    with scene.new_sim() as sim:
        to_rest(sim)
        with sim.buckling(**values) as found:
            out.note(found.status, phrase("buckling"))
            factor = found.factors[0] if found.factors else None
            confirmed, seen = found.info.confirmed > 0, found.status != Status.NOTE_INCOMPLETE
            flutter = found.info.flutter_factor if found.info.flutter == enums.FLUTTER_FOUND else None
    out.summary["buckling_factor"] = factor
    title = phrase("Buckling, nonlinear")
    if flutter is not None and (factor is None or flutter < factor):
        return Tile(title, phrase("factor {factor:.4g}", factor=flutter),
                    phrase("vibrations grow by themselves (flutter) from this factor of the loads in [buckling] on"),
                    _share_verdict(flutter, values, True))
    if factor is None:
        return Tile(title, phrase("none found"), phrase("no critical factor within the searched range"), NOT_ASSESSED)
    text = (phrase("lowest critical factor of the loads in [buckling], on top of the present ones; confirmed on the "
                   "equilibrium path") if confirmed
            else
            phrase("lowest critical factor of the loads in [buckling], on top of the present ones; extrapolated, not "
                   "confirmed"))
    if not seen:
        text = phrase("{text}; flutter was not assessed", text=text)
    return Tile(title, phrase("factor {factor:.4g}", factor=factor), text,
                _share_verdict(factor, values, confirmed and seen))


def _share_verdict(factor: float, values: Any, assured: bool) -> str:
    """By the present loads over the critical ones, 1/(1 + factor). A drive has a factor with a unit, whose present
    force is no part of it."""
    part = values.get("part")
    if part and part.index >> 24 == enums.PART_DRIVE:
        return NOT_ASSESSED
    share = 1.0 / (1.0 + factor)
    return OVER if share >= 1.0 else NEAR if share > NEAR_SHARE else OK if assured else NOT_ASSESSED
