"""Friction coefficients of the sections of a hole (casing, open hole, ...) that fit measurements at several depths.

A load at one depth depends on all sections above it: the coefficients are found together by least squares (Gauss and
Newton), with the confidence of each from the scatter and the covariance of the fit, of Student's distribution."""
from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ._optional import need
from .results import CommandOutput, finite
from .measured import CONFIDENCE, KINDS, MOST_FRICTION, Series, label
from .scene import CannotSave, Scene, loads, saves
from .scene.units import parse
from .unit_systems import Units

STEPS, DIFFERENCE, TOLERANCE = 30, 1e-4, 1e-8
SINGULAR = 1e-6  #: ratio of singular values of the scaled Jacobian below which sections cannot be separated


@dataclass
class Section:
    """A part of the hole with a coefficient of its own."""
    name: str
    top: float            #: [m] measured depth
    keys: tuple[str, str]  #: of mu_static and mu_dynamic in the scene
    friction: float       #: [-] of the scene


@dataclass
class Found:
    """A fit, or the reason why there is none."""
    frictions: list[float]
    half_widths: list[float | None]
    scatter: float = math.nan   #: [N, N m] root mean square of the differences
    reason: str = ""


def sections_of(text: str) -> list[Section]:
    """The wall above the first section, and each section; none of holes without sections or with values in lines
    between them."""
    hole = tomllib.loads(text).get("hole", {})
    parts = hole.get("section", [])
    if not parts or any(one.get("shape", "step") not in ("step", 0) for one in parts):
        return []
    usual = float(hole["mu_dynamic"])
    found = [Section("above the first section", -math.inf, ("hole.mu_static", "hole.mu_dynamic"), usual)]
    for number, one in enumerate(parts):
        own = float(one.get("mu_dynamic", -1.0))
        found.append(Section(str(one.get("name") or f"section {number + 1}"), parse(one["depth"], "m"),
                             (f"hole.section[{number}].mu_static", f"hole.section[{number}].mu_dynamic"),
                             own if own >= 0.0 else usual))
    return found


class Model:
    """The soft string in a hole with given coefficients of its sections."""

    def __init__(self, text: str, sections: list[Section], string: str, series: Series, operation: Any,
                 block_weight: float) -> None:
        self.text, self.sections, self.string, self.series = text, sections, string, series
        self.operation, self.block_weight = operation, block_weight

    def at(self, frictions: list[float]) -> list[float]:
        """[N, N m] Computed values, NaN where the string locks up."""
        changes = {key: value for one, value in zip(self.sections, frictions) for key in one.keys}
        scene = loads(self.text, changes=changes)
        with scene.new_sim() as sim:
            rows = sim.torque_drag([self.operation], self.series.depths, string=scene.names[self.string]).rows
        if self.series.word == "torque":
            return [float(row[0].torque) for row in rows]
        return [float(row[0].hook_load) + self.block_weight for row in rows]


def fit(at: Callable[[list[float]], list[float]], values: list[float], start: list[float]) -> Found:
    """Least squares; the reason where the measurements do not determine all coefficients."""
    np = need("numpy")
    frictions = list(start)
    if len(values) <= len(start):
        return Found(frictions, [], reason=f"{len(values)} measurements are not more than {len(start)} coefficients")
    for _ in range(STEPS):
        here = at(frictions)
        if not all(map(math.isfinite, here)):
            frictions = [0.8 * one for one in frictions]  # the string locks up
            continue
        slopes = np.array([[(b - a) / DIFFERENCE
                            for a, b in zip(here, at([*frictions[:k], one + DIFFERENCE, *frictions[k + 1:]]))]
                           for k, one in enumerate(frictions)]).T
        sizes = np.linalg.svd(slopes, compute_uv=False) if np.isfinite(slopes).all() else np.zeros(1)
        if not sizes[-1] > SINGULAR * sizes[0]:
            return Found(frictions, [],
                         reason="the measurements do not separate the sections; more depths within each of them would")
        rest = np.array(values) - np.array(here)
        change = np.linalg.lstsq(slopes, rest, rcond=None)[0]
        new = [min(MOST_FRICTION, max(0.0, one + float(min(0.5, max(-0.5, step)))))
               for one, step in zip(frictions, change)]
        moved = max(abs(a - b) for a, b in zip(new, frictions))
        frictions = new
        if moved <= TOLERANCE:
            break
    else:
        return Found(frictions, [], reason="the fit does not converge; examine the block weight, the sign and the unit")
    outside = [one for one, step in zip(frictions, change) if (one <= 0.0 and step < -TOLERANCE)
               or (one >= MOST_FRICTION and step > TOLERANCE)]
    if outside:
        return Found(frictions, [],
                     reason="no coefficients between 0 and 10 fit best; examine the block weight, the sign and the "
                            "unit")
    free = len(values) - len(frictions)
    variance = float(rest @ rest) / free
    quantile = float(need("scipy.stats").t.isf(0.5 * (1.0 - CONFIDENCE), free))
    spread = np.linalg.inv(slopes.T @ slopes)
    return Found(frictions, [quantile * math.sqrt(variance * float(spread[k, k])) for k in range(len(frictions))],
                 math.sqrt(float(rest @ rest) / len(values)))


def compare(scene: Scene, name: str, out: CommandOutput, series: dict[str, Series], operations: list[Any],
            block_weight: float) -> None:
    """A line for each series that reaches into more than one section."""
    try:
        text = saves(scene, False)
    except CannotSave:
        return
    sections = sections_of(text)
    results: dict[str, Any] = {}
    for word, one in series.items():
        reached = [part for part in sections if part.top < max(one.depths)]
        if word == "rotate" or len(reached) < 2:
            continue
        model = Model(text, reached, name, one, operations[KINDS[word]], block_weight)
        found = fit(model.at, one.values, [part.friction for part in reached])
        results[word] = {"reason": found.reason or None, "scatter": finite(found.scatter), "sections": [
            {"name": part.name, "from_m": part.top if math.isfinite(part.top) else None,
             "friction": None if found.reason else found.frictions[k], "half_width_95": None if found.reason
             else found.half_widths[k]}
            for k, part in enumerate(reached)]}
        out.say(f"{name}, measured {label(word)} by section: {_text(reached, found, out.units)}")
    if results:
        out.summary.setdefault("measured_by_section", {})[name] = results


def _text(sections: list[Section], found: Found, units: Units) -> str:
    if found.reason:
        return f"friction not assessed, because {found.reason}"
    parts = []
    for section, friction, half in zip(sections, found.frictions, found.half_widths):
        where = section.name if not math.isfinite(section.top) else \
            f"{section.name} from {units.text(section.top, 'm')}"
        parts.append(f"{where} friction {friction:.4g} (95 % confidence {max(0.0, friction - (half or 0.0)):.3g} .. "
                     f"{friction + (half or 0.0):.3g})")
    return ", ".join(parts)
