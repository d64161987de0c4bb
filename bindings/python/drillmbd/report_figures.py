"""Figures of the report as plotly reads them."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Dict, Tuple

from . import _structs
from ._optional import need
from .language import Phrase, phrase
from .plots import COLOURS
from .scene import Scene
from .unit_systems import Units

Figure = Tuple[str, str, Dict[str, Any]]  # title, text, plotly
WIDEST, HIGHEST, SHORT = 3.0, 1.7, 0.15  #: of the box in space, in the units of the eye
NOISE = 1e-9             #: of a value in the unit of its figure: smaller ones are rounding errors
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


def rounded(values: Any) -> list[float]:
    """Six digits are enough to draw."""
    return [float(f"{float(value):.6g}") for value in values]


def value_axis(title: str, *rows: Any) -> dict[str, Any]:
    """An axis of values; rounding errors about 0 are drawn as 0."""
    largest = max((abs(float(one)) for row in rows for one in row if math.isfinite(one)), default=0.0)
    return {"title": {"text": title}, **({"range": [-1, 1]} if largest < NOISE else {})}


def line(x: Any, y: Any, name: str, number: int) -> dict[str, Any]:
    """A curve of a figure."""
    return {"type": "scatter", "mode": "lines", "x": rounded(x), "y": rounded(y), "name": name,
            "line": {"color": COLOURS[(1 + number) % len(COLOURS)], "dash": DASHES[number % len(DASHES)], "width": 2}}


@dataclass
class InSpace:
    """The string in its hole, in the units of the output: axis of the hole, and shapes of the string as (position,
    displacement)."""
    axis: Any
    tangent: Any
    shapes: list[tuple[Any, Any]]
    radius: float   #: of the hole, 0 without one
    factor: float   #: by which displacements across the hole are drawn larger

    def drawn(self, shape: int, factor: float) -> Any:
        """A shape of the string with its displacement across the hole `factor` times larger."""
        moved = self.shapes[shape][1]
        along = (moved * self.tangent).sum(axis=1, keepdims=True) * self.tangent
        return self.axis + along + factor * (moved - along)


def in_space(scene: Scene, shapes: list[Any], units: Units) -> InSpace:
    """The factor makes the hole a thirtieth of its length wide."""
    numpy = need("numpy")
    length_unit = units.factor("m")
    shapes = [(length_unit * position, length_unit * moved) for position, moved in shapes]
    axis = shapes[0][0] - shapes[0][1]
    tangent = numpy.gradient(axis, axis=0)
    tangent = tangent / numpy.maximum(numpy.linalg.norm(tangent, axis=1, keepdims=True), 1e-300)
    length = float(numpy.linalg.norm(numpy.diff(axis, axis=0), axis=1).sum())
    radius = length_unit * _hole_radius(scene)
    across = max([float(numpy.abs(moved).max()) for _, moved in shapes[:1]] + [1e-6 * length_unit])
    return InSpace(axis, tangent, shapes, radius, max(1.0, float(f"{length / 30.0 / (radius or across):.1g}")))


def picture_in_space(space: InSpace, times: list[float], units: Units) -> dict[str, Any]:
    """The string over time, its displacement across the hole exaggerated or to scale, in a tube that is the hole."""
    factor, axis = space.factor, space.axis

    def trace(points: Any, **more: Any) -> dict[str, Any]:
        return {"type": "scatter3d", "mode": "lines", "x": rounded(points[:, 0]), "y": rounded(points[:, 1]),
                "z": rounded(points[:, 2]), **more}

    data = [trace(space.drawn(0, factor), name=phrase("string, across {factor:g} times", factor=factor),
                  line={"color": "#0072B2", "width": 6}),
            trace(space.drawn(0, 1.0), name=phrase("string, to scale"), line={"color": "#000000", "width": 4},
                  visible=False),
            trace(axis, name=phrase("axis of the hole"), line={"color": "#D55E00", "width": 2, "dash": "dash"})]
    if space.radius:
        data.append(_tube(axis, space.tangent, factor * space.radius, phrase("hole, {factor:g} times", factor=factor)))
    frames = [{"name": f"{time:.4g}", "traces": [0, 1], "data": [
        {key: values for key, values in trace(space.drawn(number, scale)).items() if key in "xyz" or key == "type"}
        for scale in (factor, 1.0)]} for number, time in enumerate(times)] if len(times) > 1 else []
    axes = {"x": phrase("north [{unit}]", unit=units.unit("m")), "y": phrase("west [{unit}]", unit=units.unit("m")),
            "z": phrase("height [{unit}]", unit=units.unit("m"))}
    layout: dict[str, Any] = {"scene": {"camera": {"eye": _eye(axis)}, **_box(space, axes)}, "height": 560,
                              "showlegend": True,
                              "margin": {"l": 0, "r": 0, "t": 50, "b": 20}, "legend": {"y": -0.32, "yanchor": "top"}}
    tube = len(data) - 3
    layout["updatemenus"] = [_buttons([(phrase("drawn larger"), "restyle",
                                        [{"visible": [True, False, True] + [True] * tube}]),
                                       (phrase("to scale"), "restyle",
                                        [{"visible": [False, True, True] + [False] * tube}])], 0.0)]
    if frames:
        playing = {"frame": {"duration": 100}, "fromcurrent": True}
        layout["updatemenus"].append(_buttons([(phrase("play"), "animate", [None, playing]),
                                               (phrase("stop"), "animate", [[None], {"mode": "immediate"}])], 0.62))
        at_once = {"mode": "immediate", "frame": {"duration": 0}}
        layout["sliders"] = [{"currentvalue": {"prefix": phrase("time [s]: ")}, "x": 0.02, "len": 0.96, "steps": [
            {"label": one["name"], "method": "animate", "args": [[one["name"]], at_once]} for one in frames]}]
    return {"data": data, "layout": layout, "frames": frames}


def _box(space: InSpace, titles: dict[str, Phrase]) -> dict[str, Any]:
    """Axes to one scale around string and hole, as large as the picture shows them from the eye."""
    everything = need("numpy").concatenate([space.axis, *(space.drawn(number, space.factor)
                                                          for number in range(len(space.shapes)))])
    room = 1.1 * space.factor * space.radius
    low, high = everything.min(axis=0) - room, everything.max(axis=0) + room
    size = [max(float(one), 1e-3 * float(max(high - low))) for one in high - low]
    scale = min(WIDEST / max(size[:2]), HIGHEST / size[2])
    axes = {f"{name}axis": {"title": {"text": title, "font": {"size": 12}}, "tickfont": {"size": 11},
                            "nticks": 6 if size[i] > SHORT * max(size) else 2,
                            "range": rounded([low[i], low[i] + size[i]])}
            for i, (name, title) in enumerate(titles.items())}
    return {"aspectmode": "manual", "aspectratio": {name: scale * one for name, one in zip("xyz", size)}, **axes}


def _eye(axis: Any) -> dict[str, float]:
    """From the right of the hole, seen from its collar, and a little above, so that it lies across the picture."""
    north, west = (float(axis[-1][i] - axis[0][i]) for i in (0, 1))
    away = math.hypot(north, west)
    north, west = (north / away, west / away) if away > 0.0 else (1.0, 0.0)
    return {"x": 2.2 * west - 0.2 * north, "y": -2.2 * north - 0.2 * west, "z": 1.0}


def _buttons(buttons: list[tuple[Phrase, str, list[Any]]], x: float) -> dict[str, Any]:
    return {"type": "buttons", "direction": "left", "x": x, "xanchor": "left", "y": 1.12,
            "buttons": [{"label": label, "method": method, "args": args} for label, method, args in buttons]}


def _hole_radius(scene: Scene) -> float:
    wall = next((arguments[0] for name, arguments in scene.model.calls if name == "add_wall"), None)
    return 0.0 if wall is None else float(wall.get("diameter", _structs.WallDef().diameter)) / 2.0


def _tube(axis: Any, tangent: Any, radius: float, name: str) -> dict[str, Any]:
    """A surface of circles around the axis."""
    numpy = need("numpy")
    some = slice(None, None, max(1, len(axis) // 80))
    axis, tangent = axis[some], tangent[some]
    up = numpy.where(numpy.abs(tangent[:, 2:3]) < 0.9, numpy.array([[0.0, 0.0, 1.0]]), numpy.array([[0.0, 1.0, 0.0]]))
    side = numpy.cross(tangent, up)
    side = side / numpy.linalg.norm(side, axis=1, keepdims=True)
    other = numpy.cross(tangent, side)
    angle = numpy.linspace(0.0, 2.0 * math.pi, 17)
    rings = axis[:, None, :] + radius * (numpy.cos(angle)[None, :, None] * side[:, None, :]
                                         + numpy.sin(angle)[None, :, None] * other[:, None, :])
    return {"type": "surface", **{key: [rounded(row) for row in rings[:, :, i]] for i, key in enumerate("xyz")},
            "opacity": 0.18, "showscale": False, "hoverinfo": "skip", "name": name,
            "colorscale": [[0, "#8a8a8a"], [1, "#8a8a8a"]]}
