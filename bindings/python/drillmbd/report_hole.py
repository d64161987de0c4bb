"""Plan and section of the hole to scale, with the force of the string on the wall, as SVG.

Frame of the world: x north, y west, z up. Both views have the horizontal distance a along the azimuth A of the line
from the collar to the end of the hole: a = n cos A + e sin A with n = x, e = -y; the plan has the distance to the right
of it, -n sin A + e cos A, downward; the section has the height."""
from __future__ import annotations

import html
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ._optional import need
from .language import Language, phrase
from .scene import Scene
from .unit_systems import Units

#: Width and colour of the line by the class of contact force: none, then four equal classes. The colours grow darker
#: with the force.
CLASSES = ((1.5, "#9a9a9a"), (3.5, "#f0b429"), (5.5, "#d9662b"), (7.5, "#9b2226"), (10.0, "#2b0a1e"))
POINTS = 200
LARGEST_HEIGHT = 0.62    #: of both views together, over the width of the picture
LABEL = 9.0              #: width of a label over its size
FLAT = 0.005             #: of the length: a hole with less horizontal extent is drawn along the azimuth of its collar

Place = tuple[float, float]


def nice(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is no larger."""
    power = 10.0 ** math.floor(math.log10(value))
    return power * max(one for one in (1.0, 2.0, 5.0) if one * power <= value * (1.0 + 1e-9))


def nice_above(value: float) -> float:
    """The smallest of 1, 2, 5 times a power of ten that is no smaller."""
    power = 10.0 ** math.floor(math.log10(value))
    return power * min(one for one in (1.0, 2.0, 5.0, 10.0) if one * power >= value * (1.0 - 1e-9))


@dataclass
class HoleView:
    """The course of the hole and the string in it, in the units of the output."""
    depths: list[float]                      #: measured, of the course
    course: list[tuple[float, float, float]]  #: a, right, up, from the collar
    dips: list[float]                        #: [deg] there
    azimuth: float                           #: [rad] of the views
    string: list[tuple[float, float, float]]  #: the same of the middles of the pipes
    force: list[float]                       #: contact force per length of each pipe
    length_unit: str
    force_unit: str

    @property
    def step(self) -> float:
        """Width of a class of the contact force."""
        largest = max(self.force, default=0.0)
        return nice_above(largest / (len(CLASSES) - 1)) if largest > 0.0 else 1.0

    def class_of(self, force: float) -> int:
        """0: no contact."""
        return 0 if force <= 0.0 else min(len(CLASSES) - 1, 1 + int(force / self.step))


def contacts(found: Any) -> tuple[list[int], list[float]]:
    """Stations at the middles of the pipes of a profile of two stations a pipe, and the larger force of its ends and
    middle."""
    normal = [0.0 if math.isnan(one) else float(one) for one in found["normal_force"]]
    middles = list(range(1, len(normal) - 1, 2))
    return middles, [max(normal[i - 1:i + 2]) for i in middles]


def hole_view(scene: Scene, found: Any, units: Units) -> HoleView | None:
    """None without a hole. found: a profile with two stations a pipe."""
    wall = next((arguments[0] for name, arguments in scene.model.calls if name == "add_wall"), None)
    if wall is None:
        return None
    stations = wall.get("stations") or []
    begin = float(stations[0][0]) if stations else 0.0
    end = max(float(stations[-1][0]) if stations else 0.0, float(found.depth.max()))
    depths = [begin + (end - begin) * i / POINTS for i in range(POINTS + 1)]
    points = [scene.model.hole(depth) for depth in depths]
    middles, force = contacts(found)
    collar = points[0].position
    moves = [[point.position[i] - collar[i] for i in range(3)] for point in points]
    azimuth = azimuth_of(moves[-1], end - begin, points[0].azimuth)
    length, per_length = units.factor("m"), units.factor("N/m")
    pipes = [[float(found.position[i][k]) - collar[k] for k in range(3)] for i in middles]
    return HoleView([length * depth for depth in depths], [turned(one, azimuth, length) for one in moves],
                    [math.degrees(point.inclination) - 90.0 for point in points], azimuth,
                    [turned(one, azimuth, length) for one in pipes],
                    [per_length * one for one in force], units.unit("m"), units.unit("N/m"))


def azimuth_of(end: Sequence[float], length: float, collar: float) -> float:
    """[rad] of the line from the collar to the end (x, y, z); that of the collar where the hole is upright."""
    upright = math.hypot(end[0], end[1]) < FLAT * length
    return collar if upright else math.atan2(-end[1], end[0])


def turned(move: Sequence[float], azimuth: float, factor: float) -> tuple[float, float, float]:
    """Distance along the azimuth, to the right of it and upward."""
    north, east = move[0], -move[1]
    return (factor * (north * math.cos(azimuth) + east * math.sin(azimuth)),
            factor * (east * math.cos(azimuth) - north * math.sin(azimuth)),
            factor * move[2])


# ---- Drawing ---------------------------------------------------------------------------------------------------------
def _line(points: Sequence[Place], colour: str, width: float, more: str = "") -> str:
    text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{text}" fill="none" stroke="{colour}" stroke-width="{width:g}" {more}/>'


def _text(x: float, y: float, text: str, anchor: str = "start", size: float = 0.0, more: str = "") -> str:
    large = f' font-size="{size:g}"' if size else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{large} {more}>{html.escape(text)}</text>'


class Drawing:
    """One picture of a given width in pixels; `to` writes phrases in the language of the page."""

    def __init__(self, view: HoleView, width: float, to: Language) -> None:
        self.view, self.width, self.to = view, width, to
        self.size = 13.0 if width > 500.0 else 12.0
        self.margin = 3.2 * self.size
        self.parts: list[str] = []
        along = [one[0] for one in view.course]
        self.low, extent = min(along), max(max(along) - min(along), 1e-9)
        heights = sum(max(values) - min(values) for values in ([one[k] for one in view.course] for k in (1, 2)))
        self.scale = min((width - 2.0 * self.margin) / extent, LARGEST_HEIGHT * width / max(heights, 1e-9))
        self.left = 0.5 * (width - self.scale * extent)

    def svg(self) -> str:
        """Title, plan, section, scale and legend from top to bottom."""
        size = self.size
        below = self._view(1, 1.4 * size, self.to(phrase("Plan: seen from above, along the azimuth {azimuth:.0f}°",
                                                         azimuth=math.degrees(self.view.azimuth) % 360.0)),
                           self._plan_marks)
        below = self._view(2, below + 2.2 * size, self.to(phrase("Section: seen from the side, to the same scale")),
                           self._section_marks)
        below = self._scale_bar(below + 2.0 * size)
        below = self._legend(below + 2.6 * size)
        about = html.escape(self.to(phrase("Plan and section of the hole to scale, with the contact force of the "
                                           "string")), quote=True)
        return (f'<svg viewBox="0 0 {self.width:g} {below:.0f}" width="{self.width:g}" role="img" aria-label="{about}" '
                f'font-size="{size:g}" fill="#111">'
                + "".join(self.parts) + "</svg>")

    def _view(self, component: int, top: float, title: str, marks: Callable[[Callable[[Any], Place], float, float],
                                                                            None]) -> float:
        """One view below `top`; returns its lower edge."""
        size = self.size
        sign = 1.0 if component == 1 else -1.0
        across = [sign * one[component] for one in self.view.course]
        upper = top + 3.4 * size
        lower = upper + self.scale * (max(across) - min(across))

        def at(point: Any) -> Place:
            return (self.left + self.scale * (point[0] - self.low),
                    upper + self.scale * (sign * point[component] - min(across)))

        self.parts.append(_text(0.5 * size, top, title, more='font-weight="bold"'))
        course = [at(one) for one in self.view.course]
        x, y = course[0]
        level = [(self.left, y), (max(max(one[0] for one in course), self.left + 6.0 * size), y)]
        self.parts.append(_line(level, "#777", 1.0, 'stroke-dasharray="2 4"'))
        self.parts.append(_line(course, "#e2e2e2", 13.0, 'stroke-linecap="round"'))
        self._string([at(one) for one in self.view.string])
        self._depths(at, component)
        self.parts.append(f'<rect x="{x - 0.4 * size:.1f}" y="{y - 0.4 * size:.1f}" width="{0.8 * size:g}" '
                          f'height="{0.8 * size:g}" fill="#fff" '
                          'stroke="#000" stroke-width="2"/>')
        self.parts.append(f'<circle cx="{course[-1][0]:.1f}" cy="{course[-1][1]:.1f}" r="{0.4 * size:g}" fill="#000"/>')
        marks(at, upper, lower)
        return lower + (2.6 if component == 2 or self.width > 500.0 else 4.0) * size

    def _string(self, places: list[Place]) -> None:
        """Each pipe from half-way to its neighbour before to half-way to the one behind, by the class of its force;
        equal ones as one line."""
        classes = [self.view.class_of(force) for force in self.view.force]
        first = 0
        for i in range(1, len(places) + 1):
            if i < len(places) and classes[i] == classes[first]:
                continue
            before = places[first] if first == 0 else _between(places[first - 1], places[first])
            behind = places[i - 1] if i == len(places) else _between(places[i - 1], places[i])
            width, colour = CLASSES[classes[first]]
            self.parts.append(_line([before, *places[first:i], behind], colour, width))
            first = i

    def _depths(self, at: Callable[[Any], Place], component: int) -> None:
        """Ticks at round measured depths, those of the section with numbers."""
        depths, size = self.view.depths, self.size
        length = depths[-1] - depths[0]
        step = nice_above(max(length * 5.0 * size / max(self.scale * length, 1e-9), length / 12.0))
        number = math.floor(depths[0] / step) + 1
        while number * step < depths[-1] - 0.25 * step:
            i = min(int((number * step - depths[0]) / length * POINTS), POINTS - 1)
            share = (number * step - depths[i]) / (depths[i + 1] - depths[i])
            (x, y), (x0, y0), (x1, y1) = (at([a + share * (b - a)
                                              for a, b in zip(self.view.course[i], self.view.course[i + 1])]),
                                          at(self.view.course[i]), at(self.view.course[i + 1]))
            across = max(math.hypot(x1 - x0, y1 - y0), 1e-9)
            nx, ny = 8.0 * (y1 - y0) / across, -8.0 * (x1 - x0) / across
            if (nx, ny) != (0.0, 0.0) and across > 1e-6:
                self.parts.append(_line([(x - nx, y - ny), (x + nx, y + ny)], "#111", 1.0))
            if component == 2:
                text = f"{number * step:g} {self.view.length_unit}"
                upright = abs(ny) < abs(nx)
                self.parts.append(_text(x - 1.0 * size, y + 0.35 * size, text, "end") if upright
                                  else _text(x, y + 1.9 * size, text, "middle"))
            number += 1

    def _plan_marks(self, at: Callable[[Any], Place], upper: float, lower: float) -> None:
        size, view = self.size, self.view
        (x, y), (end_x, end_y) = at(view.course[0]), at(view.course[-1])
        above, end_above = self._above(at)
        self.parts.append(_text(x, y - above, self.to(phrase("collar"))))
        if abs(end_x - x) > 8.0 * size:
            self.parts.append(_text(end_x, end_y - end_above,
                                    self.to(phrase("end, {depth:.5g} {unit}", depth=view.depths[-1],
                                                   unit=view.length_unit)),
                                    "end"))
        self._north(self.width - 2.2 * size, 2.3 * size if self.width > 500.0 else lower + 2.4 * size)

    def _section_marks(self, at: Callable[[Any], Place], upper: float, lower: float) -> None:
        size, view = self.size, self.view
        (x, y), (end_x, end_y) = at(view.course[0]), at(view.course[-1])
        begin = self.to(phrase("collar, dip {dip:+.1f}°", dip=view.dips[0]))
        end = self.to(phrase("end, dip {dip:+.1f}°", dip=view.dips[-1]))
        upright = abs(end_x - x) < 12.0 * size
        above, end_above = (0.5 * size, -0.4 * size) if upright else self._above(at)
        self.parts.append(_text(x + (1.2 * size if upright else 0.0), y - above, begin))
        self.parts.append(_text(end_x + 1.2 * size, end_y - end_above, end) if upright
                          else _text(end_x, end_y - end_above, end, "end"))

    def _above(self, at: Callable[[Any], Place]) -> tuple[float, float]:
        """Height of the labels above collar and end, so that the hole, which may rise behind them, does not cross
        them."""
        course, room = [at(one) for one in self.view.course], LABEL * self.size
        begin, end = course[0], course[-1]
        highest = min([y for x, y in course if x <= begin[0] + room], default=begin[1])
        last = min([y for x, y in course if x >= end[0] - room], default=end[1])
        return self.size + max(0.0, begin[1] - highest), self.size + max(0.0, end[1] - last)

    def _north(self, x: float, y: float) -> None:
        """The arrow to the north: along the views by cos A, to the left of them (upward) by sin A."""
        size, azimuth = self.size, self.view.azimuth
        dx, dy = math.cos(azimuth), -math.sin(azimuth)
        length = 0.9 * size
        tip, tail = (x + length * dx, y + length * dy), (x - length * dx, y - length * dy)
        head = [(tip[0] - 0.5 * size * dx - 0.35 * size * s * dy, tip[1] - 0.5 * size * dy + 0.35 * size * s * dx)
                for s in (1.0, -1.0)]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in (tip, *head))
        self.parts.append(_line([tail, tip], "#000", 1.6) + f'<polygon points="{points}" fill="#000"/>')
        self.parts.append(_text(tip[0] + 0.75 * size * dx, tip[1] + 0.75 * size * dy + 0.35 * size,
                                self.to(phrase("N")), "middle",
                                more='font-weight="bold"'))

    def _scale_bar(self, top: float) -> float:
        size, unit = self.size, self.view.length_unit
        length = nice(0.3 * (self.width - 2.0 * self.margin) / self.scale)
        x, end = self.margin, self.margin + self.scale * length
        self.parts.append(_line([(x, top - 4.0), (x, top), (end, top), (end, top - 4.0)], "#000", 2.0))
        self.parts.append(_text(end + 0.7 * size, top + 0.1 * size,
                                self.to(phrase("{length:g} {unit}, the same along and across", length=length,
                                               unit=unit))))
        return top

    def _legend(self, top: float) -> float:
        """Classes of the contact force, those that occur and those below them."""
        size, view = self.size, self.view
        self.parts.append(_text(0.5 * size, top, self.to(phrase("Contact force on the wall [{unit}]",
                                                                unit=view.force_unit)), more='font-weight="bold"'))
        most = max([view.class_of(force) for force in view.force], default=0)
        x, y = 0.5 * size, top + 1.6 * size
        for number in range(most + 1):
            width, colour = CLASSES[number]
            text = self.to(phrase("none")) if number == 0 else f"{(number - 1) * view.step:g} – {number * view.step:g}"
            room = (3.6 + 0.62 * len(text)) * size + (size if number == 0 else 0.0)
            if x + room > self.width:
                x, y = 0.5 * size, y + 1.6 * size
            self.parts.append(_line([(x, y - 0.35 * size), (x + 2.2 * size, y - 0.35 * size)], colour,
                                    width) + _text(x + 2.7 * size, y, text))
            x += room
        return y + 0.8 * size


def _between(a: Place, b: Place) -> Place:
    return (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))


# ---- The still picture -----------------------------------------------------------------------------------------------
def still(axis: Any, string: Any, radius: float, factor: float, to: Language) -> str:
    """An isometric drawing of the string in its hole, displacements and the radius of the hole `factor` times larger
    across: in place of the view in space where nothing can be turned."""
    numpy = need("numpy")
    ends = axis[-1] - axis[0]
    heading = math.atan2(ends[1], ends[0]) if math.hypot(ends[0], ends[1]) > FLAT * numpy.linalg.norm(ends) else 0.0
    turn = numpy.array([[math.cos(heading), math.sin(heading), 0.0], [-math.sin(heading), math.cos(heading), 0.0],
                        [0.0, 0.0, 1.0]])
    # rows: along, left, up; columns: right, down
    flat = numpy.array([[math.cos(math.pi / 6.0), -0.5], [-math.cos(math.pi / 6.0), -0.5], [0.0, -1.0]])
    project = turn.T @ flat
    tangent = numpy.gradient(axis, axis=0)
    tangent /= numpy.maximum(numpy.linalg.norm(tangent, axis=1, keepdims=True), 1e-300)
    rings = [ring(axis[i], tangent[i], factor * radius)
             for i in numpy.linspace(0, len(axis) - 1, 25).astype(int)] if radius else []
    everything = numpy.concatenate([axis, string, *rings]) @ project
    low, extent = everything.min(axis=0), numpy.maximum(everything.max(axis=0) - everything.min(axis=0), 1e-9)
    scale = min(660.0 / extent[0], 420.0 / extent[1])

    def drawn(points: Any) -> list[Place]:
        return [(20.0 + float(x), 20.0 + float(y)) for x, y in scale * (points @ project - low)]

    parts = [_line(drawn(one), "#999", 0.8) for one in rings]
    parts += [_line(drawn(axis), "#555", 1.0, 'stroke-dasharray="6 4"'), _line(drawn(string), "#000", 2.5)]
    width, height = 40.0 + scale * extent[0], 40.0 + scale * extent[1]
    parts += _triad(turn, flat, 60.0, 50.0 if project[0][1] * ends[0] < 0.0 or ends[2] > 0.0 else height - 60.0, to)
    text = to(phrase("circles: wall of the hole, {factor:g} times; line: string; dashed: axis of the hole",
                     factor=factor))
    return (f'<svg viewBox="0 0 {max(width, 560.0):.0f} {height + 24.0:.0f}" width="{max(width, 560.0):.0f}" '
            'role="img" font-size="13" fill="#111">'
            + "".join(parts) + _text(10.0, height + 12.0, text) + "</svg>")


def _triad(turn: Any, flat: Any, x: float, y: float, to: Language) -> list[str]:
    """North, west and up as arrows from one point."""
    parts = []
    for name, (dx, dy) in zip((phrase("N"), phrase("W"), phrase("up")), 28.0 * (turn.T @ flat)):
        parts += [_line([(x, y), (x + dx, y + dy)], "#000", 1.2), _text(x + 1.4 * dx, y + 1.4 * dy + 4.0, to(name),
                                                                        "middle", 11.0)]
    return parts


def ring(centre: Any, tangent: Any, radius: float) -> Any:
    """Points of a circle across the tangent."""
    numpy = need("numpy")
    up = numpy.array([0.0, 0.0, 1.0]) if abs(tangent[2]) < 0.9 else numpy.array([1.0, 0.0, 0.0])
    side = numpy.cross(tangent, up)
    side /= numpy.linalg.norm(side)
    other = numpy.cross(tangent, side)
    angle = numpy.linspace(0.0, 2.0 * math.pi, 33)[:, None]
    return centre + radius * (numpy.cos(angle) * side + numpy.sin(angle) * other)
