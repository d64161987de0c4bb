"""Pictures of what one looks at, by matplotlib: depth downward, units on the axes, colours that greyscale and colour
blindness leave apart, legends beside the curves. Each function returns the figure; save it by figure.savefig(path)."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ._optional import need

if TYPE_CHECKING:
    from .analysis import Modes, Response
    from .analysis import TorqueDrag
    from .fatigue import StringFatigue
    from .profile import Profile
    from .recorder import Recorder

# Okabe and Ito's palette from dark to light, with lines that differ too.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
LINES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)))
_STYLE = {"axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.spines.top": False,
          "axes.spines.right": False, "axes.axisbelow": True, "legend.frameon": False, "axes.formatter.useoffset": False}


def _axes(rows: int, columns: int, size: tuple[float, float], **more: Any) -> tuple[Any, Any]:
    """A figure that needs no window."""
    plot = need("matplotlib.pyplot")
    with plot.rc_context(_STYLE):
        return plot.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained", **more)  # type: ignore


SINGLE: dict[str, Any] = {"color": COLOURS[1], "linestyle": "-"}


def _style(number: int) -> dict[str, Any]:
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": LINES[number % len(LINES)]}


def _legend(axes: Any) -> None:
    if len(axes.get_lines()) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def profile(found: Profile, title: str = "") -> Any:
    """Axial force, torque, bending moment and wall force over measured depth (or along the string), depth downward."""
    has_hole = bool(found.depth.max() > 0.0)
    down = found.depth if has_hole else found.along
    figure, ((axial, torque, bending, wall),) = _axes(1, 4, (13, 6), sharey=True)
    for axes, values, label in ((axial, found.axial_force / 1e3, "axial force [kN]\n(tension > 0)"),
                                (torque, found.torque / 1e3, "torque [kN m]"),
                                (bending, found.bending_moment / 1e3, "bending moment [kN m]")):
        axes.plot(values, down, **SINGLE)
        axes.axvline(0.0, color="#999999", linewidth=0.8)
        axes.set_xlabel(label)
    if len(found.contact_depth):
        wall.barh(found.contact_depth, found.contact_force / 1e3, color=COLOURS[2],
                  height=0.6 * max(float(down.max()), 1e-9) / len(found.contact_depth))
    wall.set_xlabel("force on the wall [kN]\nper site")
    axial.set_ylabel("measured depth [m]" if has_hole else "along the string [m]")
    axial.invert_yaxis()
    figure.suptitle(title)
    return figure


def string(found: Profile, hole_diameter: float | None = None, title: str = "") -> Any:
    """The string in its hole: seen from the side and from above to one scale, and how far it lies off its described axis."""
    figure, ((side,), (above,), (off,)) = _axes(3, 1, (11, 9))
    x, y, z = found.position.T
    side.plot(x, z, **SINGLE)
    side.set(xlabel="x [m]", ylabel="height z [m]", title="from the side")
    above.plot(x, y, **SINGLE)
    above.set(xlabel="x [m]", ylabel="y [m]", title="from above")
    for axes in (side, above):
        axes.set_aspect("equal", adjustable="datalim")
    for i, axis in enumerate("yz"):
        off.plot(found.along, 1e3 * found.displacement[:, 1 + i], label=f"along {axis}", **_style(i))
    if hole_diameter is not None:
        off.plot([], [], " ", label=f"hole {1e3 * hole_diameter:g} mm")
    off.set(xlabel="along the string [m]", ylabel="displacement [mm]", title="sideways, exaggerated")
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
            axes.plot(table[:, 0], table[:, 1 + i], label=columns[1 + i].split(" [")[0], linewidth=1.0, **_style(number))
        axes.set_ylabel(f"[{unit}]" if len(shown) > 1 else columns[1 + shown[0]])
        _legend(axes)
    grid[-1][0].set_xlabel("time [s]")
    figure.suptitle(title)
    return figure


def recording(recorder: Recorder, title: str = "") -> Any:
    """The columns of a recorder over time."""
    return history(recorder.table, recorder.columns, title)


def _unit(name: str) -> str:
    return name[name.rindex("[") + 1:name.rindex("]")] if "[" in name else "-"


def response(found: Response, names: Sequence[str] | None = None, title: str = "") -> Any:
    """Amplitudes and phases of the combined outputs over frequency. names: of the outputs, with their units."""
    numpy = need("numpy")
    figure, ((size,), (phase,)) = _axes(2, 1, (11, 7), sharex=True)
    for i in range(found.shape[2]):
        values = found.transfer(output=i)
        size.plot(found.frequencies, numpy.abs(values), label=names[i] if names else f"output {i}", **_style(i))
        phase.plot(found.frequencies, numpy.angle(values, deg=True), **_style(i))
    size.set(yscale="log", ylabel="amplitude [unit of the output]" if not names or len(names) > 1 else names[0])
    phase.set(xlabel="frequency [Hz]", ylabel="phase [deg]", yticks=range(-180, 181, 90))
    _legend(size)
    figure.suptitle(title)
    return figure


def shapes(found: Modes, places: Sequence[Any], along: Any, count: int = 6, title: str = "") -> Any:
    """The lowest modes that are not rigid-body motions: displacement along, across and twist over the string [m]."""
    numpy = need("numpy")
    elastic = [i for i in range(len(found)) if not found[i].rigid][:count]
    figure, grid = _axes(max(1, len(elastic)), 1, (11, 1.9 * max(1, len(elastic))), sharex=True)
    for (axes,), index in zip(grid, elastic):
        values = found.shapes(index, places)
        turned = values * numpy.exp(-1j * numpy.angle(values.ravel()[numpy.abs(values).argmax()]))
        parts = ((turned[:, 0].real, "x"), (turned[:, 1].real, "y"), (turned[:, 2].real, "z"))
        scale = max(float(numpy.abs(turned[:, :3]).max()), 1e-300)
        for number, (part, name) in enumerate(parts):
            axes.plot(along, part / scale, label=name, **_style(number))
        axes.set(ylabel=f"{found[index].frequency:.3g} Hz\n[-]")
    _legend(grid[0][0])
    grid[-1][0].set_xlabel("along the string [m]")
    figure.suptitle(title)
    return figure


def torque_drag(found: TorqueDrag, names: Sequence[str], title: str = "") -> Any:
    """Hook load and torque at the rig over the depth of the far end, depth downward, a line for each operation."""
    figure, ((load, torque),) = _axes(1, 2, (11, 6), sharey=True)
    for number, name in enumerate(names):
        depth = found.column("depth", number)
        load.plot([value / 1e3 for value in found.column("hook_load", number)], depth, label=name, **_style(number))
        torque.plot([value / 1e3 for value in found.column("torque", number)], depth, label=name, **_style(number))
    load.axvline(0.0, color="#999999", linewidth=0.8)
    load.set(xlabel="hook load [kN]\n(> 0: the rig pulls)", ylabel="measured depth of the bit [m]")
    torque.set_xlabel("torque at the rig [kN m]")
    load.invert_yaxis()
    _legend(torque)
    figure.suptitle(title)
    return figure


def severity(speeds: Sequence[float], values: Sequence[float], bands: Sequence[Any], threshold: float = 1.0,
             title: str = "") -> Any:
    """Severity over rotary speed [rad/s], the bands to avoid shaded and named in rpm."""
    figure, ((axes,),) = _axes(1, 1, (11, 4.5))
    rpm = [30.0 * speed / math.pi for speed in speeds]
    axes.plot(rpm, values, **SINGLE)
    axes.axhline(threshold, **_style(0), linewidth=1.0)
    for band in bands:
        low, high = 30.0 * band.low / math.pi, 30.0 * band.high / math.pi
        axes.axvspan(low, high, facecolor="#E69F00", alpha=0.35, hatch="//", edgecolor="#D55E00", linewidth=0.0)
        axes.annotate(f"{low:.0f} .. {high:.0f}", (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"),
                      xytext=(0, 3), textcoords="offset points", ha="center", fontsize=8, rotation=40)
    axes.set(xlabel="rotary speed [rpm]", ylabel="severity [-]", yscale="log" if max(values) > 0.0 else "linear")
    figure.suptitle(title)
    return figure


def buckling(shape: Any, along: Any, factor: float, title: str = "") -> Any:
    """A buckling shape, shape (n, 6), over the string [m]."""
    figure, ((axes,),) = _axes(1, 1, (11, 4))
    for number, name in enumerate("xyz"):
        axes.plot(along, shape[:, number], label=name, **_style(number))
    axes.set(xlabel="along the string [m]", ylabel="shape [m], largest 1", title=f"critical factor {factor:.4g}")
    _legend(axes)
    figure.suptitle(title)
    return figure


def fatigue(found: StringFatigue, title: str = "") -> Any:
    """Damage along a string, and the cycles by stress range at its worst pipe."""
    figure, ((damage, cycles),) = _axes(1, 2, (11, 4.5))
    damage.plot(found.pipes, [one.damage for one in found.results], **SINGLE)
    damage.set(xlabel="pipe, counted from the rig end", ylabel="damage of this run [-]")
    ranges, counts = found.counter.histogram(found.worst)
    known = [(stress / 1e6, count) for stress, count in zip(ranges, counts) if count > 0.0]
    width = 1e-6 * (ranges[1] - ranges[0])
    cycles.bar([one for one, _ in known], [one for _, one in known], width=width, color=COLOURS[1])
    cycles.set(xlabel="stress range [MPa]", ylabel=f"cycles at pipe {found.pipes[found.worst]}", yscale="log" if known else "linear")
    figure.suptitle(title)
    return figure
