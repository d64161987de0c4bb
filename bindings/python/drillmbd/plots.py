"""Pictures of results, by matplotlib: depth downward, units on the axes, colours that greyscale and colour
blindness leave apart, legends beside the curves. Each function returns the figure; save it by figure.savefig(path)."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ._optional import need
from .profile import Profile, span
from .unit_systems import SI, Units

if TYPE_CHECKING:
    from .analysis import Modes, Response
    from .analysis import TorqueDrag
    from .fatigue import StringFatigue
    from .recorder import ProfileRecorder, Recorder

# Okabe and Ito's palette from dark to light, with lines that differ too.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
LINES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
_STYLE = {"axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.spines.top": False,
          "axes.spines.right": False, "axes.axisbelow": True, "legend.frameon": False,
          "axes.formatter.useoffset": False}


def _axes(rows: int, columns: int, size: tuple[float, float], **more: Any) -> tuple[Any, Any]:
    """A figure that needs no window."""
    plot = need("matplotlib.pyplot")
    with plot.rc_context(_STYLE):
        return plot.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained", **more)  # type: ignore


SINGLE: dict[str, Any] = {"color": COLOURS[1], "linestyle": "-"}


def _style(number: int) -> dict[str, Any]:
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": LINES[number % len(LINES)]}


def _legend(axes: Any) -> None:
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


#: A profile shows at least this share of the largest force, and of its moment by a lever of the order of a pipe's
#: radius: below it, rounding and residuals would fill the axis.
LEAST_SHARE, LEVER = 0.01, 0.05
#: Turning points of a curve above which a band of its least and largest values is drawn in its place; turning points in
#: an interval of the band, and the least and largest number of intervals.
MOST_TURNS, TURNS, BANDS = 250, 4, (100, 500)


def _at_least(axes: Any, half: float) -> None:
    """Widens an axis that shows nothing but values below `half`."""
    low, high = axes.get_xlim()
    if half > 0.0 and max(abs(low), abs(high)) < half:
        axes.set_xlim(-half, half)


def _log(axes: Any, which: str = "y") -> None:
    """A logarithmic axis of a decade at least, with labels between the powers of ten where few of these are in
    sight."""
    getattr(axes, f"set_{which}scale")("log")
    axis = getattr(axes, f"{which}axis")
    low, high = getattr(axes, f"get_{which}lim")()
    if 0.0 < high < 10.0 * low:
        middle = math.sqrt(low * high)
        getattr(axes, f"set_{which}lim")(middle / math.sqrt(10.0), middle * math.sqrt(10.0))
    axis.set_minor_formatter(need("matplotlib.ticker").LogFormatterSciNotation(minor_thresholds=(2.0, 0.5)))


def _curve(axes: Any, time: Any, values: Any, name: str, number: int) -> None:
    """A curve over time; one that oscillates too often for a line is drawn as its mean in a band of its least and
    largest values."""
    numpy = need("numpy")
    steps = numpy.sign(numpy.diff(values))
    turns = int((steps[1:] * steps[:-1] < 0.0).sum())
    bands = max(BANDS[0], min(BANDS[1], turns // TURNS))
    if turns <= MOST_TURNS or len(values) < 3 * bands:
        axes.plot(time, values, label=name, linewidth=1.0, **_style(number))
        return
    edges = numpy.linspace(0, len(values), bands + 1).astype(int)
    count = numpy.diff(edges)
    middle = numpy.add.reduceat(time, edges[:-1]) / count
    axes.fill_between(middle, numpy.minimum.reduceat(values, edges[:-1]), numpy.maximum.reduceat(values, edges[:-1]),
                      alpha=0.3, linewidth=0.0,
                      color=COLOURS[number % len(COLOURS)], label=f"{name}: least to largest")
    axes.plot(middle, numpy.add.reduceat(values, edges[:-1]) / count, label=f"{name}: mean", linewidth=1.0,
              **_style(number))


def profile(found: Profile, title: str = "", units: Units = SI) -> Any:
    """Axial force, torque, bending moment and wall force over measured depth (or along the string), depth downward."""
    has_hole = bool(found.depth.max() > 0.0)
    down = found.depth if has_hole else found.along
    figure, ((axial, torque, bending, wall),) = _axes(1, 4, (13, 6), sharey=True)
    length = units.factor("m")
    down = length * down
    largest = max((abs(one) for one in span(found.axial_force) if one == one), default=0.0)
    least = LEAST_SHARE * max(float(found.contact_force.sum()), largest)
    for axes, values, si, label in ((axial, found.axial_force, "N", "axial force [{}]\n(tension > 0)"),
                                    (torque, found.torque, "N m", "torque [{}]"),
                                    (bending, found.bending_moment, "N m", "bending moment [{}]")):
        factor, unit = units.axis(si, values)
        axes.plot(factor * values, down, **SINGLE)
        axes.axvline(0.0, color="#999999", linewidth=0.8)
        _at_least(axes, factor * least * (1.0 if si == "N" else LEVER))
        axes.set_xlabel(label.format(unit))
    factor, unit = units.axis("N", found.contact_force)
    if len(found.contact_depth):
        wall.hlines(length * found.contact_depth, 0.0, factor * found.contact_force, color=COLOURS[2],
                    linewidth=max(0.7, min(4.0, 200.0 / len(found.contact_depth))))
        wall.set_xlim(left=0.0)
    wall.set_xlabel(f"force on the wall [{unit}]\nper contact point")
    axial.set_ylabel(units.head("measured depth [m]" if has_hole else "along the string [m]"))
    axial.invert_yaxis()
    figure.suptitle(title)
    return figure


def string(found: Profile, hole_diameter: float | None = None, title: str = "", units: Units = SI) -> Any:
    """The string in its hole: seen from the side and from above to one scale, and how far it lies off its described
    axis."""
    figure, ((side,), (above,), (off,)) = _axes(3, 1, (11, 9))
    x, y, z = units.factor("m") * found.position.T
    side.plot(x, z, **SINGLE)
    side.set(xlabel=units.head("x [m]"), ylabel=units.head("height z [m]"), title="from the side")
    above.plot(x, y, **SINGLE)
    above.set(xlabel=units.head("x [m]"), ylabel=units.head("y [m]"), title="from above")
    for axes in (side, above):
        axes.set_aspect("equal", adjustable="datalim")
    for i, axis in enumerate("yz"):
        off.plot(units.factor("m") * found.along, 1e3 * units.factor("mm") * found.displacement[:, 1 + i],
                 label=f"along {axis}", **_style(i))
    if hole_diameter is not None:
        off.plot([], [], " ", label=f"hole {units.text(1e3 * hole_diameter, 'mm', 'g')}")
    off.set(xlabel=units.head("along the string [m]"), ylabel=units.head("displacement [mm]"),
            title="sideways, exaggerated")
    _legend(off)
    figure.suptitle(title)
    return figure


def history(table: Any, columns: Sequence[str], title: str = "") -> Any:
    """Columns over time, those of one unit in one panel. `table`: shape (rows, columns), its first column time [s]."""
    units = [_unit(name) for name in columns[1:]]
    panels = list(dict.fromkeys(units))
    figure, grid = _axes(max(1, len(panels)), 1, (11, 2.6 * max(1, len(panels))), sharex=True)
    for (axes,), unit in zip(grid, panels):
        shown = [i for i, one in enumerate(units) if one == unit]
        for number, i in enumerate(shown):
            _curve(axes, table[:, 0], table[:, 1 + i], words_of(columns[1 + i]), number)
        axes.set_ylabel(f"[{unit}]" if len(shown) > 1 else columns[1 + shown[0]])
        _legend(axes)
    grid[-1][0].set_xlabel("time [s]")
    figure.suptitle(title)
    return figure


def recording(recorder: Recorder, title: str = "") -> Any:
    """The columns of a recorder over time."""
    return history(recorder.table, recorder.columns, title)


def words_of(name: str) -> str:
    """The head of a column without its unit; names of parts may have brackets too."""
    return name.rpartition(" [")[0] or name


def _unit(name: str) -> str:
    return name[name.rindex("[") + 1:name.rindex("]")] if "[" in name else "-"


def response(found: Response, names: Sequence[str] | None = None, title: str = "", units: Units = SI) -> Any:
    """Amplitudes and phases of the combined outputs over frequency. names: of the outputs, with their units."""
    numpy = need("numpy")
    figure, ((size,), (phase,)) = _axes(2, 1, (11, 7), sharex=True)
    for i in range(found.shape[2]):
        values = found.transfer(output=i)
        name, factor = (units.head(names[i]), units.factor_of(names[i])) if names else (f"output {i}", 1.0)
        size.plot(found.frequencies, factor * numpy.abs(values), label=name, **_style(i))
        angle = numpy.angle(values, deg=True)
        phase.plot(found.frequencies, numpy.where(numpy.abs(numpy.diff(angle, append=angle[-1:])) > 180.0, numpy.nan,
                                                  angle),
                   **_style(i))  # a phase that comes back at the other side draws no line across
    _log(size)
    size.set(ylabel="amplitude [unit of the output]" if not names or len(names) > 1 else units.head(names[0]))
    phase.set(xlabel="frequency [Hz]", ylabel="phase [deg]", yticks=range(-180, 181, 90))
    _legend(size)
    figure.suptitle(title)
    return figure


def shapes(found: Modes, places: Sequence[Any], along: Any, count: int = 6, title: str = "") -> Any:
    """The lowest modes that are not rigid-body motions, over the string [m]: displacement along x, across y and z, the
    largest 1, and the rotation about x, the largest of all rotations 1."""
    numpy = need("numpy")
    elastic = [i for i in range(len(found)) if not found[i].rigid][:count]
    figure, grid = _axes(max(1, len(elastic)), 1, (11, 1.9 * max(1, len(elastic))), sharex=True)
    for (axes,), index in zip(grid, elastic):
        values = found.shapes(index, places)
        turned = (values * numpy.exp(-1j * numpy.angle(values.ravel()[numpy.abs(values).argmax()]))).real
        swing = max(float(numpy.abs(turned[:, 3:]).max()), 1e-300)  # [rad]
        scale = max(float(numpy.abs(turned[:, :3]).max()), 1e-3 * swing)  # [m] twist alone moves nothing by rounding
        for number, (part, name) in enumerate(((turned[:, 0] / scale, "x"), (turned[:, 1] / scale, "y"),
                                               (turned[:, 2] / scale, "z"), (turned[:, 3] / swing, "twist"))):
            axes.plot(along, part, label=name, **_style(number))
        axes.set(ylabel=f"{found[index].frequency:.3g} Hz\n[-]", ylim=(-1.1, 1.1))
    _legend(grid[0][0])
    grid[-1][0].set_xlabel("along the string [m]")
    figure.suptitle(title)
    return figure


def torque_drag(found: TorqueDrag, names: Sequence[str], title: str = "", block_weight: float = 0.0,
                units: Units = SI) -> Any:
    """Hook load and torque at the rig over the depth of the far end, depth downward, a line for each operation.
    block_weight [N]: added to the hook loads."""
    figure, ((load, torque),) = _axes(1, 2, (11, 6), sharey=True)
    length = units.factor("m")
    for axes, field, si, label in ((load, "hook_load", "N", "hook load [{}]\n(> 0: the rig pulls)"),
                                   (torque, "torque", "N m", "torque at the rig [{}]")):
        more = block_weight if field == "hook_load" else 0.0
        columns = [[value + more for value in found.column(field, number)] for number in range(len(names))]
        factor, unit = units.axis(si, *columns)
        for number, (name, column) in enumerate(zip(names, columns)):
            axes.plot([factor * value for value in column], [length * depth for depth in found.column("depth", number)],
                      label=name, **_style(number))
        axes.set_xlabel(label.format(unit))
    load.axvline(0.0, color="#999999", linewidth=0.8)
    load.set_ylabel(units.head("measured depth of the bit [m]"))
    load.invert_yaxis()
    _legend(torque)
    figure.suptitle(title)
    return figure


def broomstick(depths: Sequence[float], loads: dict[tuple[str, str], Sequence[float]],
               torques: dict[str, Sequence[float]],
               title: str = "", measured: dict[str, Any] | None = None, units: Units = SI) -> Any:
    """Hook load [N] over the depth [m] of the bit, depth downward: a curve for each operation (colour) and friction
    (kind of line; "friction
    0.3"); beside it the torque [N m] while rotating. measured: (depths, values) by "pick-up", ..., "torque", drawn as
    points."""
    figure, ((load, torque),) = _axes(1, 2, (13, 7), sharey=True)
    depths = [units.factor("m") * depth for depth in depths]
    measured = {word: ([units.factor("m") * depth for depth in places], values)
                for word, (places, values) in (measured or {}).items()}
    words, frictions = list(dict.fromkeys(word for word, _ in loads)), list(torques)
    factor, unit = units.axis("N", *loads.values(),
                              *(values for word, (_, values) in measured.items() if word != "torque"))
    for (word, friction), column in loads.items():
        load.plot([factor * value for value in column], depths, label=f"{word}, {friction}", linewidth=1.2,
                  color=COLOURS[words.index(word)], linestyle=LINES[frictions.index(friction) % len(LINES)])
    for number, word in enumerate(words):
        if word in measured:
            load.plot([factor * value for value in measured[word][1]], measured[word][0], "osD"[number], markersize=4,
                      fillstyle="none",
                      color=COLOURS[number], label=f"{word}, measured")
    load.axvline(0.0, color="#999999", linewidth=0.8)
    load.set(xlabel=f"hook load [{unit}]\n(< 0: the rig thrusts)", ylabel=units.head("measured depth of the bit [m]"))
    factor, unit = units.axis("N m", *torques.values(),
                              *(values for word, (_, values) in measured.items() if word == "torque"))
    for number, (friction, column) in enumerate(torques.items()):
        torque.plot([factor * value for value in column], depths, label=f"rotate, {friction}", linewidth=1.2,
                    color=COLOURS[2], linestyle=LINES[number % len(LINES)])
    if "torque" in measured:
        torque.plot([factor * value for value in measured["torque"][1]], measured["torque"][0], "D", markersize=4,
                    fillstyle="none",
                    color=COLOURS[2], label="rotate, measured")
    torque.set_xlabel(f"torque at the rig [{unit}]")
    load.invert_yaxis()
    for axes in (load, torque):
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2 if axes is torque else 3, fontsize=8)
    figure.suptitle(title)
    return figure


def severity(speeds: Sequence[float], values: Sequence[float], bands: Sequence[Any], threshold: float = 1.0,
             title: str = "", ranges: Sequence[tuple[float, float]] = ()) -> Any:
    """Severity over rotary speed [rad/s], the bands to avoid shaded and named in rpm; ranges [rad/s]: bands over a
    range of the scene, lightly."""
    figure, ((axes,),) = _axes(1, 1, (11, 4.5))
    rpm = [30.0 * speed / math.pi for speed in speeds]
    axes.plot(rpm, values, label="amplitude over limit", **SINGLE)
    axes.axhline(threshold, **_style(2), linewidth=1.0, label="limit")
    for number, (low, high) in enumerate(ranges):
        axes.axvspan(30.0 * low / math.pi, 30.0 * high / math.pi, facecolor="#56B4E9", alpha=0.25, linewidth=0.0,
                     label="over the range of the scene" if number == 0 else None)
    for band in bands:
        low, high = 30.0 * band.low / math.pi, 30.0 * band.high / math.pi
        axes.axvspan(low, high, facecolor="#E69F00", alpha=0.35, hatch="//", edgecolor="#D55E00", linewidth=0.0)
        axes.annotate(f"{low:.0f} .. {high:.0f}", (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"),
                      xytext=(0, 3), textcoords="offset points", ha="center", fontsize=8, rotation=40)
    axes.set(xlabel="rotary speed [rpm]", ylabel="amplitude over limit [-]")
    if max(values) > 0.0:
        _log(axes)
    _legend(axes)
    figure.suptitle(title)
    return figure


def speeds_in_time(rows: Sequence[Any], bands: Sequence[Any], limits: tuple[float, float], title: str = "",
                   units: Units = SI) -> Any:
    """Torque with its range, its relative oscillation and the lateral acceleration by rotary speed [rpm]. rows: speed,
    linear verdict, verdict in time, torque [N m], oscillation [-], acceleration [m/s2]; bands of the linear analysis
    are shaded, limits are of oscillation and acceleration."""
    figure, ((torque,), (oscillation,), (lateral,)) = _axes(3, 1, (11, 8), sharex=True)
    known = [row for row in rows if row[3] == row[3]]
    rpm = [row[0] for row in known]
    factor, unit = units.axis("N m", [row[3] for row in known])
    torque.errorbar(rpm, [factor * row[3] for row in known], [factor * abs(row[3]) * row[4] for row in known], fmt="o",
                    capsize=4,
                    color=COLOURS[1], markersize=4)
    torque.set_ylabel(f"torque at the rig [{unit}],\nmean and range")
    acceleration = units.factor("m/s2")
    for axes, values, limit, label in ((oscillation, [row[4] for row in known], limits[0], "torque oscillation [-]"), (
            lateral, [acceleration * row[5] for row in known], acceleration * limits[1],
            units.head("lateral acceleration [m/s2]"))):
        axes.plot(rpm, values, marker="o", markersize=4, label="in time", **SINGLE)
        axes.axhline(limit, **_style(2), linewidth=1.0, label="limit")
        axes.set(ylabel=label, yscale="log" if values and min(values) > 0.0 else "linear")
        _legend(axes)
    for axes in (torque, oscillation, lateral):
        for number, band in enumerate(bands):
            axes.axvspan(30.0 * band.low / math.pi, 30.0 * band.high / math.pi, facecolor="#E69F00", alpha=0.35,
                         hatch="//", edgecolor="#D55E00",
                         linewidth=0.0, label="avoid, linear" if number == 0 and axes is oscillation else None)
    _legend(oscillation)
    lateral.set_xlabel("rotary speed [rpm]")
    figure.suptitle(title)
    return figure


def rods(rows: Sequence[Any], limits: dict[str, float], title: str = "", units: Units = SI) -> Any:
    """Thrust, pull and torque by the number of rods in the hole, with the limits of the rig and of the joints. rows: of
    drillmbd.rod_by_rod."""
    figure, grid = _axes(3, 1, (11, 8), sharex=True)
    numbers = [row.rods for row in rows]
    for (axes,), (key, word, unit) in zip(grid, (("push", "thrust", "N"), ("pull", "pull", "N"),
                                                 ("torque", "torque", "N m"))):
        values = [row.loads[key].value for row in rows]
        lines = {name: limits[one] for one, name in ((key, "limit of the rig"),
                                                     *((("make_up", "make-up torque"),) if key == "torque" else ()))
                 if one in limits}
        factor, head = units.axis(unit, values, lines.values())
        axes.plot(numbers, [factor * one if math.isfinite(one) else math.nan for one in values], marker=".", label=word,
                  **SINGLE)
        for number, (name, limit) in enumerate(lines.items()):
            axes.axhline(factor * limit, **_style(2 + number), linewidth=1.0, label=name)
        locked = [number for number, one in zip(numbers, values) if math.isinf(one)]
        if locked:
            axes.axvspan(locked[0], numbers[-1], color="#D55E00", alpha=0.2, label="locks up")
        axes.set_ylabel(f"{word} [{head}]")
        _legend(axes)
    grid[-1][0].set_xlabel("rods in the hole")
    figure.suptitle(title)
    return figure


def buckling(shape: Any, along: Any, factor: float, title: str = "", units: Units = SI) -> Any:
    """A buckling shape, shape (n, 6), over the string [m]."""
    figure, ((axes,),) = _axes(1, 1, (11, 4))
    for number, name in enumerate("xyz"):
        axes.plot(along, units.factor("m") * shape[:, number], label=name, **_style(number))
    axes.set(xlabel="along the string [m]", ylabel="shape [m], largest 1" if units.name == "si"
             else units.head("shape [m]"),
             title=f"critical factor {factor:.4g}")
    _legend(axes)
    figure.suptitle(title)
    return figure


def fatigue(found: StringFatigue, title: str = "", units: Units = SI) -> Any:
    """Damage along a string, and the cycles by stress range at its worst pipe."""
    figure, ((damage, cycles),) = _axes(1, 2, (11, 4.5))
    damage.plot(found.pipes, [one.damage for one in found.results], **SINGLE)
    damage.set(xlabel="pipe, counted from the rig end", ylabel="damage of this run [-]")
    ranges, counts = found.histogram()
    factor = units.factor("Pa") if units.name != "si" else 1e-6
    known = [(factor * stress, count) for stress, count in zip(ranges, counts) if count > 0.0]
    width = factor * (ranges[1] - ranges[0])
    cycles.bar([one for one, _ in known], [one for _, one in known], width=width, color=COLOURS[1])
    cycles.set(xlabel=units.head("stress range [MPa]"), ylabel=f"cycles at pipe {found.pipes[found.worst]}")
    if known:
        _log(cycles)
    figure.suptitle(title)
    return figure


def causes(found: Response, names: Sequence[str], output: int = 0, label: str = "amplitude", title: str = "") -> Any:
    """The causes that excite one output: its amplitude over frequency by each input with the input's own amplitude, and
    by all together. names: of the inputs; label: of the output, with its unit."""
    numpy = need("numpy")
    figure, ((axes,),) = _axes(1, 1, (11, 6))
    together = numpy.abs(found.transfer(output=output))
    axes.loglog(found.frequencies, together, color="#6b7280", linewidth=2.6, alpha=0.55, label="all together")
    for number, name in enumerate(names):
        axes.loglog(found.frequencies, found.amplitudes[number] * numpy.abs(found.transfer(number, output)), label=name,
                    **_style(number))
    axes.set(xlabel="frequency [Hz]", ylabel=label)
    _log(axes)
    _legend(axes)
    figure.suptitle(title)
    return figure


def frequencies(found: Modes, title: str = "") -> Any:
    """All natural frequencies by their number, axial, torsional and lateral ones apart by the largest motion."""
    figure, ((axes,),) = _axes(1, 1, (9, 5))
    elastic = [(number, mode.frequency, max(range(3), key=list(mode.share).__getitem__))
               for number, mode in enumerate(found)
               if not mode.rigid]
    for kind, name in enumerate(("along", "around", "across")):
        shown = [(number, frequency) for number, frequency, most in elastic if most == kind]
        axes.plot([one for one, _ in shown], [one for _, one in shown], "os^"[kind], color=COLOURS[1 + kind],
                  markersize=4,
                  label=name)
    axes.set(xlabel="mode [-]", ylabel="natural frequency [Hz]")
    if elastic:
        _log(axes)
    _legend(axes)
    figure.suptitle(title)
    return figure


def study(values: Sequence[float], columns: dict[str, Sequence[float]], parameter: str, title: str = "",
          log: bool = False) -> Any:
    """Columns that depend on one parameter, by name with unit, as "first bending [Hz]", those of one unit in one panel.
    parameter: its name with unit; log: both axes logarithmic, for frequencies against lengths."""
    panels = list(dict.fromkeys(_unit(name) for name in columns))
    figure, grid = _axes(max(1, len(panels)), 1, (10, 3.0 * max(1, len(panels))), sharex=True)
    for (axes,), unit in zip(grid, panels):
        shown = [name for name in columns if _unit(name) == unit]
        for number, name in enumerate(shown):
            axes.plot(values, columns[name], marker="o", markersize=4, label=words_of(name), **_style(number))
        axes.set_ylabel(f"[{unit}]" if len(shown) > 1 else shown[0])
        if log:
            _log(axes, "x")
            _log(axes)
        _legend(axes)
    grid[-1][0].set_xlabel(parameter)
    figure.suptitle(title)
    return figure


def demands(found: Sequence[Any]) -> Any:
    """Histograms of the demands of a study (drillmbd.probability.demands), with percentiles 5 and 95 and the limit."""
    from .scene.failure import KINDS
    figure, all_axes = _axes(len(found), 1, (7.0, 2.2 * len(found)))
    for axes, one in zip(all_axes[:, 0], found):
        axes.stairs(one.counts, one.edges, fill=True, color=COLOURS[5])
        for point in (one.percentiles[0], one.percentiles[-1]):
            axes.axvline(point.value, color=COLOURS[1], linestyle=":", label=f"P{point.percent}")
        axes.axvline(one.failure.limit, color=COLOURS[2], linestyle="--", label="limit")
        axes.set_xlabel(f"{one.failure.name} [{KINDS[one.failure.kind].unit}]")
        axes.set_ylabel("samples [-]")
        _legend(axes)
    return figure


def probability_map(vary: Sequence[tuple[str, Sequence[Any]]], cells: Sequence[tuple[float, float, float] | None],
                    name: str) -> Any:
    """Failure probability over one or two parameters: in each cell the probability and its interval in percent; empty
    where there is none."""
    numpy = need("numpy")
    rows, columns = (vary[0], vary[1]) if len(vary) == 2 else (("", [""]), vary[0])
    figure, all_axes = _axes(1, 1, (2.5 + 1.4 * len(columns[1]), 1.8 + 0.9 * len(rows[1])))
    axes = all_axes[0, 0]
    values = numpy.array([math.nan if one is None else one[0] for one in cells]).reshape(len(rows[1]), len(columns[1]))
    image = axes.imshow(100.0 * values, cmap="cividis", vmin=0.0,
                        vmax=max(1.0, 100.0 * float(numpy.nanmax(values, initial=0.0))), aspect="auto")
    for i, one in enumerate(cells):
        if one is not None:
            axes.text(i % len(columns[1]), i // len(columns[1]),
                      f"{100 * one[0]:.3g} %\n{100 * one[1]:.2g} .. {100 * one[2]:.2g} %", ha="center",
                      va="center", bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.5},
                      fontsize=8)
    axes.grid(False)
    axes.set_xticks(range(len(columns[1])), [str(one) for one in columns[1]])
    axes.set_yticks(range(len(rows[1])), [str(one) for one in rows[1]])
    axes.set_xlabel(columns[0])
    axes.set_ylabel(rows[0])
    figure.colorbar(image, label=f"probability of {name} [%]")
    return figure


def spectrum(table: Any, columns: Sequence[str], title: str = "") -> Any:
    """Amplitudes of the columns by frequency, of rows at equal times: discrete Fourier transform under a Hann window,
    without the mean. `table`: shape (rows, columns), its first column time [s]."""
    numpy = need("numpy")
    table = numpy.asarray(table, dtype=float)
    spacing = numpy.diff(table[:, 0])
    if len(spacing) < 2 or spacing.max() - spacing.min() > 1e-3 * spacing.mean():
        raise ValueError("a spectrum needs 3 rows or more at equal times: record with an interval, or step equally")
    window = numpy.hanning(len(table))
    frequency = numpy.fft.rfftfreq(len(table), spacing.mean())
    figure, grid = _axes(len(columns) - 1, 1, (11, 2.6 * (len(columns) - 1)), sharex=True)
    for number, (axes,) in enumerate(grid):
        values = table[:, 1 + number] - table[:, 1 + number].mean()
        size = 2.0 * numpy.abs(numpy.fft.rfft(values * window)) / window.sum()
        axes.plot(frequency[1:], size[1:], linewidth=1.0, **SINGLE)
        axes.set(ylabel=columns[1 + number])
        if size[1:].max() > 0.0:
            _log(axes)
    grid[-1][0].set_xlabel("frequency [Hz]")
    figure.suptitle(title)
    return figure


def orbit(y: Any, z: Any, clearance: float | None = None, title: str = "") -> Any:
    """The orbit of a point of the string across the hole, seen along it: displacements y, z [m], shape (n), and the
    circle that `clearance` [m] leaves, half the difference of the diameters of hole and pipe."""
    numpy = need("numpy")
    figure, ((axes,),) = _axes(1, 1, (6.5, 6))
    axes.plot(1e3 * numpy.asarray(y), 1e3 * numpy.asarray(z), linewidth=0.9, label="way", **SINGLE)
    axes.plot(1e3 * float(y[-1]), 1e3 * float(z[-1]), "o", color=COLOURS[2], label="end")
    if clearance is not None:
        angle = numpy.linspace(0.0, 2.0 * math.pi, 181)
        axes.plot(1e3 * clearance * numpy.cos(angle), 1e3 * clearance * numpy.sin(angle), color="#999999",
                  linewidth=1.0,
                  label=f"free way {1e3 * clearance:.3g} mm")
    axes.set(xlabel="y [mm]", ylabel="z, up [mm]")
    axes.set_aspect("equal", adjustable="datalim")
    _legend(axes)
    figure.suptitle(title)
    return figure


def over_time(recorder: ProfileRecorder, quantity: int = 0, title: str = "") -> Any:
    """One quantity of a ProfileRecorder along the string over time, as a map; quantity: its number among the
    recorder's."""
    values = recorder.values[:, :, quantity]
    figure, ((axes,),) = _axes(1, 1, (11, 5))
    picture = axes.pcolormesh(recorder.time, recorder.along, values.T, cmap="cividis", shading="nearest")
    figure.colorbar(picture, ax=axes, label=recorder.columns[quantity])
    axes.set(xlabel="time [s]", ylabel="along the string [m]")
    axes.grid(visible=False)
    axes.invert_yaxis()
    figure.suptitle(title)
    return figure
