"""One self-contained page about a scene: what a crew has to know first, then figures to turn and to play, then what was
assumed. plotly.js is embedded, packed; the page needs no network."""
from __future__ import annotations

import base64
import gzip
import html
import json
import math
import platform
from typing import Any

from . import __version__, _structs, enums
from ._optional import need
from .analysis import OPERATIONS, operation_name
from .answers import RPM, Output, count_fatigue, finite, tell_fatigue
from .errors import Error, Usage
from .fatigue import StringFatigue
from .plots import COLOURS
from .profile import Profile, values_of
from .scene import Scene
from .sim import Sim

FRAMES, POINTS, DEPTHS = 60, 300, 40
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


# ---- What is asked ---------------------------------------------------------------------------------------------------
class Study:
    """Everything that the page shows, asked once."""

    def __init__(self, scene: Scene, output: Output) -> None:
        self.scene, self.output = scene, output
        self.string, self.pipes = next(iter(scene.pipes.items()))
        self.part = scene.names[self.string]
        self.limits = scene.limits
        self.operations: dict[str, Profile] = {}
        self.cards: list[tuple[str, str, str]] = []    # title, number, judgement
        self.figures: list[tuple[str, str, dict[str, Any]]] = []  # title, text, plotly
        self.check = ""
        self.hash = ""

    def ask(self) -> None:
        """All questions in the order of the page."""
        self._operations()
        self._torque_drag()
        self._speeds()
        self._buckling()
        self._run()
        with self.scene.new_sim() as sim:
            self.check = sim.check_text()

    def _static(self, sim: Sim, **slip: float) -> None:
        values: dict[str, Any] = self.scene.fields_of("static")
        values.update({"slip_axial": 0.0, "slip_rotation": 0.0, **slip})
        try:
            status = sim.static(**values).status
        except Error as error:
            if error.status != enums.ERR_NO_CONVERGENCE:
                raise
            values["load_steps"] = 10  # friction around a string lets it climb
            status = sim.static(**values).status
            self.output.note_text("static, " + ", ".join(slip) + ": found in ten load steps")
        self.output.note(status, "static, " + (", ".join(slip) or "without friction"))

    def _operations(self) -> None:
        speed = abs(self.scene.analyses.get("static", {}).get("slip_axial", 0.0)) or 0.01
        for name, slip in (("pushed in", {"slip_axial": speed}), ("pulled out", {"slip_axial": -speed}),
                           ("turned", {"slip_rotation": 10.0})):
            with self.scene.new_sim() as sim:
                try:
                    self._static(sim, **slip)
                except Error as error:
                    self.output.note_text(f"{name}: no answer. {error.message}")
                    continue
                self.operations[name] = sim.profile(self.part, self.pipes)
        for title, name, unit, limit in (("Push to feed it in", "pushed in", "N", "push"),
                                         ("Pull to draw it out", "pulled out", "N", "pull"),
                                         ("Torque to turn it", "turned", "N m", "torque")):
            self._card(title, self._at_rig(name), unit, limit)
        stresses = [highest for found in self.operations.values() for highest in [_largest(found["von_mises"])]
                    if highest is not None]
        stress = max(stresses) if stresses else None
        self._card("Highest stress in these", stress, "Pa", "yield_stress")
        self.output.summary["operations"] = {name: {"axial_force_at_rig_N": found.axial_force[0],
                                                    "torque_at_rig_N_m": found.torque[0]}
                                             for name, found in self.operations.items()}
        self.output.summary["highest_stress_Pa"] = stress
        self.figures.append(("Axial force by operation", "At rest with friction as if it moved that way, without rock on "
                             "the bit. Tension is positive.", self._along("axial_force", 1e-3, "axial force [kN]", "push")))
        self.figures.append(("Torque by operation", "", self._along("torque", 1.0, "torque [N m]", "torque")))

    def _torque_drag(self) -> None:
        """Hook load and torque by depth while the hole is drilled: the soft string."""
        with self.scene.new_sim() as sim:
            try:
                last = sim.torque_drag([enums.OPERATION_ROTATE], string=self.part).rows[0][0].depth
                first = last - float(values_of(sim, self.part, [enums.PROFILE_DISTANCE], count=2)[1, 0])
                depths = [first + (last - first) * (i + 1) / DEPTHS for i in range(DEPTHS)]
                found = sim.torque_drag(depths=depths, string=self.part)
            except Error as error:
                self.output.note_text(f"torque and drag: no answer. {error.message}")
                return
        names = [operation_name(kind) for kind in OPERATIONS]
        for title, field, factor, label, limits in (
                ("Hook load by depth of the bit", "hook_load", 1e-3, "hook load [kN], > 0: the rig pulls", ("pull", "push")),
                ("Torque by depth of the bit", "torque", 1.0, "torque at the rig [N m]", ("torque",))):
            data = [line([factor * value for value in found.column(field, number)], depths, name, number)
                    for number, name in enumerate(names)]
            shapes = self._limit_lines({limit: -factor if limit == "push" else factor for limit in limits}, data)
            self.figures.append((title, "Soft string, steady motion, no load on the bit; dashed: the rig's limits.", {
                "data": data, "layout": {"xaxis": {"title": {"text": label}}, "shapes": shapes, "yaxis": {
                    "title": {"text": "measured depth of the bit [m]"}, "autorange": "reversed"}}}))
        self.output.summary["torque_drag"] = {name: {"hook_load_N": finite(row.hook_load), "torque_N_m": finite(row.torque)}
                                              for name, row in zip(names, found.rows[-1])}

    def _limit_lines(self, limits: dict[str, float], data: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """Upright lines at limits of the rig, each times its factor; those far off would hide the curves."""
        largest = max([abs(one) for curve in data for one in curve["x"]], default=0.0)
        values = [factor * self.limits[limit] for limit, factor in limits.items() if limit in self.limits]
        return [{"type": "line", "x0": value, "x1": value, "yref": "paper", "y0": 0, "y1": 1,
                 "line": {"color": "#D55E00", "dash": "dash"}} for value in values if abs(value) < 2.0 * largest]

    def _at_rig(self, name: str) -> float | None:
        """Push, pull or torque that an operation takes at the rig; None where there is no answer."""
        found = self.operations.get(name)
        if found is None:
            return None
        axial = float(found.axial_force[0])
        return {"pushed in": -axial, "pulled out": axial}.get(name, abs(float(found.torque[0])))

    def _card(self, title: str, value: float | None, unit: str, limit: str) -> None:
        allowed = self.limits.get(limit)
        if value is None:
            self.cards.append((title, "no answer", "see the warnings"))
            return
        text = f"of {shown(allowed, unit)} allowed" if allowed else "no limit in the scene"
        judged = "bad" if allowed and value > allowed else "good" if allowed else ""
        self.cards.append((title, shown(float(value), unit), text + (" EXCEEDED" if judged == "bad" else "")))

    def _depth(self, found: Profile) -> Any:
        return found.depth if found.depth.max() > 0.0 else found.along

    def _along(self, name: str, factor: float, label: str, limit: str) -> dict[str, Any]:
        data = [line(factor * values, self._depth(found), operation, number)
                for number, (operation, found) in enumerate(self.operations.items())
                for values in [getattr(found, name) if limit == "push" else abs(found.torque)]]
        shapes = self._limit_lines({limit: -factor if limit == "push" else factor}, data)
        return {"data": data, "layout": {"xaxis": {"title": {"text": label}}, "shapes": shapes, "yaxis": {
            "title": {"text": "measured depth [m]"}, "autorange": "reversed"}}}

    def _speeds(self) -> None:
        if "speeds" not in self.scene.analyses:
            self.cards.append(("Speeds to keep away from", "not asked", "the scene has no [speeds]"))
            return
        values, settings = self.scene.fields_of("speeds"), self.scene.analyses["speeds"]
        with self.scene.new_sim() as sim:
            self._static(sim)
            bands, severity = sim.speeds(self.scene.orders(), self.scene.outputs("speeds"),
                                         [one["limit"] for one in settings["output"]], **values)
        used: Any = _structs.SpeedsOptions(**values)
        grid = [(used.speed_low + (used.speed_high - used.speed_low) * i / (used.points - 1)) / RPM
                for i in range(used.points)]
        told = ", ".join(f"{band.low / RPM:.0f} .. {band.high / RPM:.0f}" for band in bands[:4])
        self.cards.append(("Speeds to keep away from", f"{told} rpm" if bands else "none",
                           f"between {grid[0]:.0f} and {grid[-1]:.0f} rpm, severity up to {max(severity):.3g}"))
        shapes = [{"type": "rect", "x0": band.low / RPM, "x1": band.high / RPM, "yref": "paper", "y0": 0, "y1": 1,
                   "fillcolor": "#E69F00", "opacity": 0.35, "line": {"width": 0}} for band in bands]
        self.output.summary["speeds_rpm"] = [[band.low / RPM, band.high / RPM] for band in bands]
        self.figures.append(("Safe speeds", "Severity 1 is the limit of an amplitude; shaded speeds are to be avoided.", {
            "data": [line(grid, severity, "severity", 0)], "layout": {"shapes": shapes, "xaxis": {"title": {
                "text": "rotary speed [rpm]"}}, "yaxis": {"title": {"text": "severity [-]"}, "type": "log"}}}))

    def _buckling(self) -> None:
        if "buckling" not in self.scene.analyses:
            self.cards.append(("Buckling", "not asked", "the scene has no [buckling]"))
            return
        with self.scene.new_sim() as sim:
            self._static(sim)
            with sim.buckling(**self.scene.fields_of("buckling")) as found:
                self.output.note(found.status, "buckling")
                lowest = f"{found.factors[0]:.4g}" if found.factors else "none found"
                confirmed = found.info.confirmed > 0
        self.output.summary["buckling_factor"] = None if lowest == "none found" else float(lowest)
        self.cards.append(("Lowest buckling factor", lowest, "confirmed" if confirmed else "extrapolated"))

    # ---- In time ----------------------------------------------------------------------------------------------------
    def _run(self) -> None:
        with self.scene.new_sim() as sim:
            if self.scene.run.get("static", 0) or "end" not in self.scene.run:
                self._static(sim, **{key: value for key, value in self.scene.fields_of("static").items()
                                     if key.startswith("slip")})
            shapes, times = [self._shape(sim)], [sim.time]
            if "end" in self.scene.run:
                counters = count_fatigue(self.scene, sim)
                self._frames(sim, shapes, times, list(counters.values()))
                self._fatigue(counters)
            self.hash = f"{sim.hash():016x}"
        self.figures.insert(0, ("The string in its hole", "Displacement across the hole is drawn larger so that the hole "
                                "can be seen; the button draws it to scale. Drag to turn, play or slide through the run.",
                                picture_in_space(self.scene, shapes, times)))

    def _fatigue(self, counters: dict[str, StringFatigue]) -> None:
        if not counters:
            self.cards.append(("Fatigue", "not asked", "the scene has no [fatigue]"))
            return
        found, counter = tell_fatigue(counters, self.output)[self.string], counters[self.string]
        pipe = counter.pipes[counter.worst]
        if math.isfinite(found.life):
            self.cards.append(("Fatigue", f"{found.life / 3600.0:.3g} h", f"of this run until pipe {pipe} reaches its S-N curve"
                               + (", within this run: EXCEEDED" if found.damage > 1.0 else "")))
        else:
            self.cards.append(("Fatigue", "no damage", f"by this run; largest range {shown(found.largest_range, 'Pa')}, pipe {pipe}"))
        self.figures.append(("Fatigue along the string", "Damage of this run by the S-N curve of the scene; 1 is its end.", {
            "data": [line(counter.pipes, [one.damage for one in counter.results], "damage", 0)], "layout": {"xaxis": {"title": {
                "text": "pipe, counted from the rig end"}}, "yaxis": {"title": {"text": "damage [-]"}, "exponentformat": "power"}}}))
        ranges, cycles = counter.counter.histogram(counter.worst)
        known = [(1e-6 * stress, count) for stress, count in zip(ranges, cycles) if count > 0.0]
        self.figures.append((f"Cycles of stress at pipe {pipe}", "Rainflow counting of the run; cycles that did not close count half.", {
            "data": [{"type": "bar", "x": rounded([one for one, _ in known]), "y": rounded([one for _, one in known]),
                      "marker": {"color": COLOURS[1]}}], "layout": {"xaxis": {"title": {"text": "stress range [MPa]"}}, "yaxis": {
                          "title": {"text": "cycles [-]"}, "type": "log"}}}))

    def _frames(self, sim: Sim, shapes: list[Any], times: list[float], counters: list[Any]) -> None:
        end, step = self.scene.run["end"], self.scene.run.get("step")
        interval = max(self.scene.output.get("interval", 0.0), end / 4000.0)
        recorder = sim.recorder([(place, quantity, name) for name, place, quantity in self.scene.channels],
                                int(end / interval) + 3, interval) if self.scene.channels else None
        every = max(1, round(end / FRAMES / step)) * step if step else end / FRAMES
        try:
            while end - sim.time > (1e-6 * step if step else 0.0):
                sim.run(min(end, sim.time + every), step, recorder, counters=counters)
                shapes.append(self._shape(sim))
                times.append(sim.time)
        except KeyboardInterrupt:
            self.output.note_text(f"the run was stopped by Ctrl-C at {sim.time:g} s of {end:g} s")
        self.output.summary["run"] = {"time_s": sim.time, "steps": sim.statistics().steps}
        if recorder is not None and len(recorder):
            table = recorder.table
            for number, name in enumerate(recorder.columns[1:]):
                self.figures.append((name.split(" [")[0], "In the run.", {
                    "data": [line(table[:, 0], table[:, 1 + number], name, 0)],
                    "layout": {"xaxis": {"title": {"text": "time [s]"}}, "yaxis": {"title": {"text": name}}}}))

    def _shape(self, sim: Sim) -> tuple[Any, Any]:
        found = sim.profile(self.part, self.pipes, 1)
        keep = slice(None, None, max(1, len(found.along) // POINTS))
        return found.position[keep], found.displacement[keep]


def _largest(values: Any) -> float | None:
    known = [float(one) for one in values if not math.isnan(one)]
    return max(known) if known else None


# ---- Figures ---------------------------------------------------------------------------------------------------------
def rounded(values: Any) -> list[float]:
    """Six digits are enough to draw."""
    return [float(f"{float(value):.6g}") for value in values]


def line(x: Any, y: Any, name: str, number: int) -> dict[str, Any]:
    """A curve of a figure."""
    return {"type": "scatter", "mode": "lines", "x": rounded(x), "y": rounded(y), "name": name,
            "line": {"color": COLOURS[(1 + number) % len(COLOURS)], "dash": DASHES[number % len(DASHES)], "width": 2}}


def picture_in_space(scene: Scene, shapes: list[Any], times: list[float]) -> dict[str, Any]:
    """The string over time, its displacement across the hole exaggerated or to scale, in a tube that is the hole."""
    numpy = need("numpy")
    axis = shapes[0][0] - shapes[0][1]
    tangent = numpy.gradient(axis, axis=0)
    tangent = tangent / numpy.maximum(numpy.linalg.norm(tangent, axis=1, keepdims=True), 1e-300)
    length = float(numpy.linalg.norm(numpy.diff(axis, axis=0), axis=1).sum())
    radius = _hole_radius(scene)
    across = max([float(numpy.abs(moved).max()) for _, moved in shapes[:1]] + [1e-6])
    factor = max(1.0, float(f"{length / 30.0 / (radius or across):.1g}"))

    def drawn(shape: Any, scale: float) -> Any:
        along = (shape[1] * tangent).sum(axis=1, keepdims=True) * tangent
        return axis + along + scale * (shape[1] - along)

    def trace(points: Any, **more: Any) -> dict[str, Any]:
        return {"type": "scatter3d", "mode": "lines", "x": rounded(points[:, 0]), "y": rounded(points[:, 1]),
                "z": rounded(points[:, 2]), **more}

    data = [trace(drawn(shapes[0], factor), name=f"string, across {factor:g} times", line={"color": "#0072B2", "width": 6}),
            trace(drawn(shapes[0], 1.0), name="string, to scale", line={"color": "#000000", "width": 4}, visible=False),
            trace(axis, name="axis of the hole", line={"color": "#D55E00", "width": 2, "dash": "dash"})]
    if radius:
        data.append(_tube(axis, tangent, factor * radius, f"hole, {factor:g} times"))
    frames = [{"name": f"{time:.4g}", "traces": [0, 1], "data": [
        {key: values for key, values in trace(drawn(shape, scale)).items() if key in "xyz" or key == "type"}
        for scale in (factor, 1.0)]} for shape, time in zip(shapes, times)] if len(shapes) > 1 else []
    layout: dict[str, Any] = {"scene": {"aspectmode": "data", "camera": {
        "eye": {"x": -0.2, "y": -2.2, "z": 1.0}}, **{f"{name}axis": {"title": {"text": f"{name} [m]"}}
                                                                for name in "xyz"}}, "height": 560, "showlegend": True}
    tube = len(data) - 3
    layout["updatemenus"] = [_buttons([("drawn larger", "restyle", [{"visible": [True, False, True] + [True] * tube}]),
                                       ("to scale", "restyle", [{"visible": [False, True, True] + [False] * tube}])], 0.0)]
    if frames:
        playing = {"frame": {"duration": 100}, "fromcurrent": True}
        layout["updatemenus"].append(_buttons([("play", "animate", [None, playing]),
                                               ("stop", "animate", [[None], {"mode": "immediate"}])], 0.5))
        at_once = {"mode": "immediate", "frame": {"duration": 0}}
        layout["sliders"] = [{"currentvalue": {"prefix": "time [s]: "}, "steps": [
            {"label": one["name"], "method": "animate", "args": [[one["name"]], at_once]} for one in frames]}]
    return {"data": data, "layout": layout, "frames": frames}


def _buttons(buttons: list[tuple[str, str, list[Any]]], x: float) -> dict[str, Any]:
    return {"type": "buttons", "direction": "left", "x": x, "xanchor": "left", "y": 1.12,
            "buttons": [{"label": label, "method": method, "args": args} for label, method, args in buttons]}


def _hole_radius(scene: Scene) -> float:
    wall = next((arguments[0] for name, arguments in scene.model.calls if name == "add_wall"), None)
    return 0.0 if wall is None else float(wall.get("diameter", _structs.WallDef().diameter)) / 2.0


def _tube(axis: Any, tangent: Any, radius: float, name: str) -> dict[str, Any]:
    """A surface of rings around the axis."""
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


# ---- The page --------------------------------------------------------------------------------------------------------
def shown(value: float, unit: str) -> str:
    """A number as one reads it."""
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= factor:
            return f"{value / factor:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"


STYLE = """body{font:16px/1.45 sans-serif;max-width:1100px;margin:0 auto;padding:1em;color:#111}h1{font-size:1.5em}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(230px,1fr));gap:10px}
.card{border:2px solid #555;padding:10px}
.card b{display:block;font-size:1.5em}.bad{border:4px solid #000;background:#fbe3d0}.figure{min-height:420px}
table{border-collapse:collapse}td,th{border:1px solid #999;padding:2px 8px;text-align:left}pre{overflow:auto;font-size:12px}
@media print{.figure{break-inside:avoid}body{max-width:none}}"""

SCRIPT = """const problems=document.getElementById("problems");let failed=0;
function trouble(text){failed+=1;problems.textContent+=text+"\\n";problems.dataset.count=failed}
window.addEventListener("error",e=>trouble(e.message));
window.addEventListener("unhandledrejection",e=>trouble(String(e.reason)));
async function unpacked(id){const bytes=Uint8Array.from(atob(document.getElementById(id).textContent),c=>c.charCodeAt(0));
return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text()}
(async()=>{const script=document.createElement("script");
script.textContent=await unpacked("plotly");document.head.append(script);
const figures=JSON.parse(document.getElementById("figures").textContent);
const common={margin:{l:70,r:20,t:40,b:50},font:{size:14},legend:{orientation:"h",y:-0.25}};let drawn=0;
for(let i=0;i<figures.length;i++){const f=figures[i];
try{await Plotly.newPlot("figure"+i,f.data,{...common,...f.layout},{responsive:true,displaylogo:false});
if(f.frames)await Plotly.addFrames("figure"+i,f.frames);drawn+=1}catch(e){trouble(String(e))}}
document.body.dataset.drawn=drawn})();"""


def page(study: Study) -> str:
    """The HTML of the page."""
    plotly = need("plotly.offline").get_plotlyjs()
    packed = base64.b64encode(gzip.compress(plotly.encode(), 9, mtime=0)).decode()
    figures = json.dumps(finite([figure for _, _, figure in study.figures]), separators=(",", ":")).replace("</", "<\\/")
    escape = html.escape
    cards = "".join(f'<div class="card{" bad" if "EXCEEDED" in text else ""}">{escape(title)}<b>{escape(number)}</b>'
                    f"{escape(text)}</div>" for title, number, text in study.cards)
    drawn = "".join(f'<h2>{escape(title)}</h2><p>{escape(text)}</p><div class="figure" id="figure{number}"></div>'
                    for number, (title, text, _) in enumerate(study.figures))
    notes = "".join(f"<li>{escape(note)}</li>" for note in study.output.summary["notes"]) or "<li>none</li>"
    facts = "".join(f"<tr><th>{escape(key)}</th><td>{escape(value)}</td></tr>" for key, value in assumptions(study))
    title = escape(study.scene.title or "A scene")
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
            f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body><h1>{title}</h1>'
            f'<p>String: {escape(study.string)}</p><div class="cards">{cards}</div><h2>Warnings</h2>'
            f'<ul>{notes}</ul>{drawn}<h2>What was assumed</h2>'
            f'<table>{facts}</table><h2>Model check</h2><pre>{escape(study.check)}</pre>'
            f'<pre id="problems" data-count="0"></pre><script type="text/plain" id="plotly">{packed}</script>'
            f'<script type="application/json" id="figures">{figures}</script><script>{SCRIPT}</script></body></html>')


def assumptions(study: Study) -> list[tuple[str, str]]:
    """The basis of the answers."""
    scene, info = study.scene, study.scene.model.info()
    calls = scene.model.calls
    wall: Any = _structs.WallDef(**next((arguments[0] for name, arguments in calls if name == "add_wall"), {}))
    holed = any(name == "add_wall" for name, _ in calls)
    sections = any(name == "add_hole_sections" for name, _ in calls)
    features = next((arguments[0].get("features") for name, arguments in calls if name == "compile"), None)
    left_out = [] if features is None else [one.name for one in enums.Feature
                                            if one.name and not one & features and one & (one - 1) == 0]
    found = [("pipes, elements, degrees of freedom", f"{info.pipes}, {info.elements}, {info.degrees_of_freedom}"),
             ("mass, length", f"{info.mass:.4g} kg, {info.length:.4g} m")]
    if holed:
        found.append(("wall", f"diameter {1e3 * wall.diameter:g} mm, stiffness {wall.stiffness:g} per metre, friction "
                              f"{wall.mu_static:g} at rest and {wall.mu_dynamic:g} sliding, "
                              + ("other values in its sections" if sections else "the same along the hole")))
    found += [("left out", ", ".join(str(one).lower() for one in left_out) or "nothing that the scene describes"),
              ("not in this page", "connections, rock on the bit in the static operations, other depths"),
              ("library", f"{__version__}, hash of the last state {study.hash}"), ("Python", platform.python_version())]
    return found


def report(scene: Scene, output: Output, options: Any) -> int:
    """The page, in the folder of the answer."""
    if output.folder is None:
        raise Usage("report needs --output FOLDER")
    if not scene.pipes:
        raise Usage("report is about a string, the scene has none")
    need("plotly.offline")
    study = Study(scene, output)
    study.ask()
    for title, number, text in study.cards:
        output.say(f"{title}: {number} ({text})")
    output.path("report.html").write_text(page(study), encoding="utf-8")
    output.summary["hash"] = study.hash
    return output.finish()
