"""The report: every analysis of a scene, the largest demand of each kind against its limit, and figures. Made into a page by
report_page."""
from __future__ import annotations

import math
import platform
from collections.abc import Callable
from typing import Any

from . import __version__, _structs, enums
from ._optional import need
from .analysis import OPERATIONS, operation_name
from .answers import RPM, Output, count_fatigue, finite, note_bounces, tell_fatigue
from .errors import Error, Usage
from .fatigue import StringFatigue
from .operating import BIT_FRICTION, Operating, operating, operations_of
from .plots import COLOURS
from .profile import Profile, values_of
from .questions import LINEAR, NOTHING_EXCITES, columns_of
from .report_figures import line, picture_in_space, rounded
from .report_page import page
from .scene import Scene
from .sim import Sim
from .unit_systems import Units
from .verdict import NEAR, NEAR_SHARE, NO_LIMIT, NOT_ASSESSED, NOT_COMPUTED, OK, OVER, Demand, Tile, shown

FRAMES, POINTS, DEPTHS = 60, 300, 40
NAMES_OF = {"si": "SI", "field": "field units (ft, lbf, psi)", "mine": "mine units (m, kN, MPa)"}
NEAR_BAND = 0.1  #: of the rotation: a critical band so near is "near"


class Study:
    """Content of the page. An analysis that fails becomes a tile with its reason; the others go on."""

    def __init__(self, scene: Scene, output: Output) -> None:
        self.scene, self.output, self.title, self.units = scene, output, scene.title, output.units
        self.string, self.pipes = next(iter(scene.pipes.items()))
        self.part, self.limits = scene.names[self.string], scene.limits
        self.plan: Operating = operating(scene)
        self.operations: dict[str, Profile] = {}
        self.demands = {key: Demand(title, unit, self.limits.get(key), units=self.units) for key, title, unit in (
            ("push", "Thrust at the rig", "N"), ("pull", "Pull at the rig", "N"), ("torque", "Torque at the rig", "N m"),
            ("yield_stress", "Von Mises stress", "Pa"))}
        self.stresses: list[tuple[float, str]] = []  # [Pa] of moments of the run
        self.tiles: list[Tile] = []
        self.figures: list[tuple[str, str, dict[str, Any]]] = []  # title, text, plotly
        self.check, self.hash, self.headline = "", "", self._headline()

    def _headline(self) -> str:
        plan, units = self.plan, self.units
        known = [text for value, text in (
            (plan.rotation, f"rotation {units.text((plan.rotation or 0.0) / RPM, 'rpm')}"), (plan.feed, f"feed {units.text(1e3 * (plan.feed or 0.0), 'mm/s')}"),
            (plan.weight_on_bit, f"{units.text((plan.weight_on_bit or 0.0) / 1e3, 'kN')} on the bit")) if value]
        if plan.estimated:
            known.append(f"bit torque {units.text(plan.torque_on_bit, 'N m')}, estimated from the bit load with a coefficient of sliding friction "
                         f"of {BIT_FRICTION:g} (Pessier and Fear 1992)")
        return f"String {self.string}. " + ("Operation: " + ", ".join(known) if known else "The scene describes no operation") + "."

    def ask(self) -> None:
        """All analyses in the order of the page."""
        everything = tuple(self.demands)
        self._attempt("soft string", everything[:3], self._torque_drag)
        self._attempt("stiff string", everything, self._operations)
        self._attempt("run in time", everything, self._run)
        self.tiles[:0] = [demand.tile() for demand in self.demands.values()]
        self._attempt("Critical speeds", (), self._speeds)
        if "buckling" in self.scene.analyses:
            self._attempt("Buckling, nonlinear", (), self._buckling)
        with self.scene.new_sim() as sim:
            self.check = self.units.sentence(sim.check_text())
        self.output.summary["verdicts"] = [vars(tile) for tile in self.tiles]

    def _attempt(self, what: str, demands: tuple[str, ...], analysis: Callable[[], None]) -> None:
        try:
            analysis()
        except (Error, ArithmeticError) as error:
            reason = self.units.sentence(error.message if isinstance(error, Error) else str(error))
            self.output.note_text(f"{what}: not computed. {reason}")
            for key in demands:
                self.demands[key].failed.append(f"{what}: {reason}")
            if not demands:
                self.tiles.append(Tile(what, "not computed", reason, NOT_COMPUTED))

    # ---- Statics ----------------------------------------------------------------------------------------------------
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
        speed = abs(self.scene.analyses.get("static", {}).get("slip_axial", 0.0)) or self.plan.feed or 0.01
        rotation = self.plan.rotation or 10.0
        for name, key, slip in (("pushed in", "push", {"slip_axial": speed}), ("pulled out", "pull", {"slip_axial": -speed}),
                                ("rotated", "torque", {"slip_rotation": rotation})):
            self._attempt(f"stiff string, {name}", (key, "yield_stress"), lambda name=name, key=key, slip=slip:  # type: ignore[misc]
                          self._operation(name, key, slip))
        self.output.summary["operations"] = {name: {"axial_force_at_rig_N": found.axial_force[0],
                                                    "torque_at_rig_N_m": found.torque[0]}
                                             for name, found in self.operations.items()}
        if not self.operations:
            return
        self.figures.append(("Axial force by operation", "Stiff string at rest, with friction as if it moved that way, without bit "
                             "load. Tension is positive.", self._along("axial_force", "push")))
        self.figures.append(("Torque by operation", "", self._along("torque", "torque")))

    def _operation(self, name: str, key: str, slip: dict[str, float]) -> None:
        with self.scene.new_sim() as sim:
            self._static(sim, **slip)
            found = self.operations[name] = sim.profile(self.part, self.pipes)
        axial = float(found.axial_force[0])
        at_rig = {"push": -axial, "pull": axial, "torque": abs(float(found.torque[0]))}[key]
        source = f"stiff string, {name}, without bit load"
        self.demands[key].add(at_rig, source)
        stress = _largest(found["von_mises"])
        if stress is not None:
            self.demands["yield_stress"].add(stress, source)

    # ---- Torque and drag --------------------------------------------------------------------------------------------
    def _torque_drag(self) -> None:
        """Hook load and torque by depth while the hole is drilled, with the bit load and rotation of the scene."""
        plan, operations, units = self.plan, operations_of(self.plan), self.units
        with self.scene.new_sim() as sim:
            last = sim.torque_drag([enums.OPERATION_ROTATE], string=self.part).rows[0][0].depth
            first = last - float(values_of(sim, self.part, [enums.PROFILE_DISTANCE], count=2)[1, 0])
            depths = [first + (last - first) * (i + 1) / DEPTHS for i in range(DEPTHS)]
            found = sim.torque_drag(operations, depths=depths, string=self.part)
        names = [operation_name(kind) for kind in OPERATIONS]
        load = f"{units.text((plan.weight_on_bit or 0.0) / 1e3, 'kN')} on the bit while drilling and sliding"
        self._soft_demands(names, found.rows[-1])
        self._confinement(names, found.rows[-1])
        for title, field, factor, label, limits in (
                ("Hook load by depth of the bit", "hook_load", _force(units), f"hook load [{units.unit('kN')}], < 0: the rig thrusts", ("pull", "push")),
                ("Torque by depth of the bit", "torque", units.factor("N m"), units.head("torque at the rig [N m]"), ("torque",))):
            data = [line([factor * value for value in found.column(field, number)], [units.factor("m") * depth for depth in depths], name, number)
                    for number, name in enumerate(names)]
            shapes = self._limit_lines({limit: -factor if limit == "push" else factor for limit in limits}, data)
            self.figures.append((title, f"Soft string in steady motion, {load}; dashed: limits of the rig.", {
                "data": data, "layout": {"xaxis": {"title": {"text": label}}, "shapes": shapes, "yaxis": {
                    "title": {"text": units.head("measured depth of the bit [m]")}, "autorange": "reversed"}}}))
        self.output.summary["torque_drag"] = {name: {"hook_load_N": finite(row.hook_load), "torque_N_m": finite(row.torque)}
                                              for name, row in zip(names, found.rows[-1])}

    def _soft_demands(self, names: list[str], rows: Any) -> None:
        for name, row in zip(names, rows):
            source = f"soft string, {name}"
            if row.locked:
                self.demands["push"].failed.append(f"{source}: the string locks up, no thrust moves the bit")
                continue
            self.demands["pull" if row.hook_load > 0.0 else "push"].add(abs(row.hook_load), source)
            self.demands["torque"].add(row.torque, source)

    def _confinement(self, names: list[str], rows: Any) -> None:
        """Largest share of the buckling loads of a pipe confined by its hole, in all operations."""
        free = [(row.helical_share, row.sinusoidal_share, row.buckled_at, name) for name, row in zip(names, rows) if not row.locked]
        if len(free) < len(rows):
            locked = ", ".join(name for name, row in zip(names, rows) if row.locked)
            self.tiles.append(Tile("Buckling in the hole", "locks up", f"no thrust at the rig moves the bit: {locked}", OVER))
        elif not all(math.isfinite(share) for share, *_ in free):
            self.tiles.append(Tile("Buckling in the hole", "not assessed", "the shares of the buckling loads are not defined for this string",
                                   NOT_ASSESSED))
        else:
            helical, sinusoidal, depth, name = max(free)
            if self.plan.weight_on_bit is None:
                verdict, text = NOT_ASSESSED, "the scene gives no bit load"
            else:
                verdict = OVER if helical > 1.0 else NEAR if helical > NEAR_SHARE or sinusoidal > 1.0 else OK
                text = f"{name}, at {self.units.text(depth, 'm')}; {100.0 * sinusoidal:.3g} % of the sinusoidal buckling load"
            self.tiles.append(Tile("Buckling in the hole", f"{100.0 * helical:.3g} % of the helical buckling load", text, verdict))

    def _limit_lines(self, limits: dict[str, float], data: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """Upright lines at limits of the rig, each times its factor; those far off would hide the curves."""
        largest = max([abs(one) for curve in data for one in curve["x"] if math.isfinite(one)], default=0.0)
        values = [factor * self.limits[limit] for limit, factor in limits.items() if limit in self.limits]
        return [{"type": "line", "x0": value, "x1": value, "yref": "paper", "y0": 0, "y1": 1,
                 "line": {"color": "#D55E00", "dash": "dash"}} for value in values if abs(value) < 2.0 * largest]

    def _depth(self, found: Profile) -> Any:
        return self.units.factor("m") * (found.depth if found.depth.max() > 0.0 else found.along)

    def _along(self, name: str, limit: str) -> dict[str, Any]:
        units = self.units
        factor, label = ((_force(units), units.head("axial force [kN]")) if limit == "push" else (units.factor("N m"), units.head("torque [N m]")))
        data = [line(factor * values, self._depth(found), operation, number)
                for number, (operation, found) in enumerate(self.operations.items())
                for values in [getattr(found, name) if limit == "push" else abs(found.torque)]]
        shapes = self._limit_lines({limit: -factor if limit == "push" else factor}, data)
        return {"data": data, "layout": {"xaxis": {"title": {"text": label}}, "shapes": shapes, "yaxis": {
            "title": {"text": units.head("measured depth [m]")}, "autorange": "reversed"}}}

    # ---- Linear analyses --------------------------------------------------------------------------------------------
    def _speeds(self) -> None:
        title = "Critical speeds"
        if "speeds" not in self.scene.analyses:
            self.tiles.append(Tile(title, "not assessed", "the scene has no [speeds] table", NOT_ASSESSED))
            return
        values, settings = self.scene.fields_of("speeds"), self.scene.analyses["speeds"]
        with self.scene.new_sim() as sim:
            self._static(sim)
            bands, severity = sim.speeds(self.scene.orders(), self.scene.outputs("speeds"),
                                         [one["limit"] for one in settings["output"]], **values)
        used: Any = _structs.SpeedsOptions(**values)
        grid = [(used.speed_low + (used.speed_high - used.speed_low) * i / (used.points - 1)) / RPM
                for i in range(used.points)]
        self.output.summary["speeds_rpm"] = [[band.low / RPM, band.high / RPM] for band in bands]
        self.tiles.append(self._speeds_tile(title, bands, severity, grid))
        shapes = [{"type": "rect", "x0": band.low / RPM, "x1": band.high / RPM, "yref": "paper", "y0": 0, "y1": 1,
                   "fillcolor": "#E69F00", "opacity": 0.35, "line": {"width": 0}} for band in bands]
        if max(severity) > 0.0:
            self.figures.append(("Severity by rotary speed", "Severity 1 is the limit of an amplitude; shaded speeds are to be avoided. "
                                 + LINEAR, {"data": [line(grid, severity, "severity", 0)], "layout": {
                                     "shapes": shapes, "xaxis": {"title": {"text": "rotary speed [rpm]"}},
                                     "yaxis": {"title": {"text": "severity [-]"}, "type": "log"}}}))

    def _speeds_tile(self, title: str, bands: Any, severity: Any, grid: list[float]) -> Tile:
        if not max(severity) > 0.0:
            return Tile(title, "not assessed", NOTHING_EXCITES, NOT_ASSESSED)
        told = ", ".join(f"{band.low / RPM:.0f} to {band.high / RPM:.0f}" for band in bands[:4])
        value = f"avoid {told} rpm" if bands else "none found"
        text = f"between {grid[0]:.0f} and {grid[-1]:.0f} rpm, severity at most {max(severity):.3g}. {LINEAR}"
        planned = self.plan.rotation
        if planned is None:
            return Tile(title, value, "the scene gives no rotation to compare with; " + text, NOT_ASSESSED)
        rpm = planned / RPM
        if not grid[0] <= rpm <= grid[-1]:
            return Tile(title, value, f"the rotation of {rpm:.4g} rpm is outside the range of [speeds]; " + text, NOT_ASSESSED)
        inside = any(band.low <= planned <= band.high for band in bands)
        near = any(band.low * (1.0 - NEAR_BAND) <= planned <= band.high * (1.0 + NEAR_BAND) for band in bands)
        return Tile(title, value, f"rotation {rpm:.4g} rpm; " + text, OVER if inside else NEAR if near else OK)

    def _buckling(self) -> None:
        with self.scene.new_sim() as sim:
            self._static(sim)
            with sim.buckling(**self.scene.fields_of("buckling")) as found:
                self.output.note(found.status, "buckling")
                factor = found.factors[0] if found.factors else None
                confirmed = found.info.confirmed > 0
        self.output.summary["buckling_factor"] = factor
        if factor is None:
            tile = Tile("Buckling, nonlinear", "none found", "no critical factor within the searched range", NOT_ASSESSED)
        else:
            told = "confirmed on the equilibrium path" if confirmed else "extrapolated, not confirmed"
            tile = Tile("Buckling, nonlinear", f"factor {factor:.4g}", f"lowest critical factor of the loads in [buckling]; {told}",
                        OVER if factor < 1.0 else NEAR if factor < 1.0 / NEAR_SHARE else OK if confirmed else NOT_ASSESSED)
        self.tiles.append(tile)

    # ---- In time ----------------------------------------------------------------------------------------------------
    def _run(self) -> None:
        with self.scene.new_sim() as sim:
            if self.scene.run.get("static", 0) or "end" not in self.scene.run:
                self._static(sim, **{key: value for key, value in self.scene.fields_of("static").items()
                                     if key.startswith("slip")})
            shapes, times = [self._shape(sim)], [sim.time]
            self.figures.insert(0, ("The string in its hole", "Displacement across the hole is enlarged so that the hole can be seen; the "
                                    "button draws it to scale. Drag to rotate, play or slide through the run.", {}))
            try:
                if "end" in self.scene.run:
                    self._in_time(sim, shapes, times)
                else:
                    self.tiles.append(Tile("Run in time", "not assessed", "the scene has no [run] end", NOT_ASSESSED))
            finally:
                self.hash = f"{sim.hash():016x}"
                self.figures[0] = (*self.figures[0][:2], picture_in_space(self.scene, shapes, times, self.units))

    def _in_time(self, sim: Sim, shapes: list[Any], times: list[float]) -> None:
        counters = count_fatigue(self.scene, sim)
        window = sim.window([(self.part, "hook_load"), (self.part, "rotation_torque")])
        try:
            self._frames(sim, shapes, times, [window, *counters.values()])
        finally:
            if sim.statistics().steps:
                load, torque = window.result(0), window.result(1)
                source = f"run of {sim.time:.4g} s"
                self.demands["push"].add(-load.minimum, source)
                self.demands["pull"].add(load.maximum, source)
                self.demands["yield_stress"].found += [max(self.stresses)] if self.stresses else []
                self.demands["torque"].add(max(abs(torque.minimum), abs(torque.maximum)), source)
        if self.scene.sim.get("energy_ledger", 1):
            self.output.summary["energy_error"] = sim.energy().error
        self._fatigue(counters)

    def _fatigue(self, counters: dict[str, StringFatigue]) -> None:
        if not counters:
            self.tiles.append(Tile("Fatigue", "not assessed", "the scene has no [fatigue] table", NOT_ASSESSED))
            return
        found, counter = tell_fatigue(counters, self.output)[self.string], counters[self.string]
        pipe = counter.pipes[counter.worst]
        if found.largest_range <= 0.0:
            self.tiles.append(Tile("Fatigue", "not assessed", "no stress cycle in this run", NOT_ASSESSED))
        elif math.isfinite(found.life):
            self.tiles.append(Tile("Fatigue", f"{found.life / 3600.0:.3g} h", f"of this run until pipe {pipe} reaches its S-N curve",
                                   OVER if found.damage > 1.0 else NO_LIMIT))
        else:
            self.tiles.append(Tile("Fatigue", "no damage", f"in this run; largest range {shown(found.largest_range, 'Pa', self.units)}, pipe {pipe}", OK))
        self.figures.append(("Fatigue along the string", "Damage of this run by the S-N curve of the scene; 1 is its end.", {
            "data": [line(counter.pipes, [one.damage for one in counter.results], "damage", 0)], "layout": {"xaxis": {"title": {
                "text": "pipe, counted from the rig end"}}, "yaxis": {"title": {"text": "damage [-]"}, "exponentformat": "power"}}}))
        ranges, cycles = counter.counter.histogram(counter.worst)
        known = [(1e-6 * self.units.factor("MPa") * stress, count) for stress, count in zip(ranges, cycles) if count > 0.0]
        self.figures.append((f"Cycles of stress at pipe {pipe}", "Rainflow counting of the run; cycles that did not close count half.", {
            "data": [{"type": "bar", "x": rounded([one for one, _ in known]), "y": rounded([one for _, one in known]),
                      "marker": {"color": COLOURS[1]}}], "layout": {"xaxis": {"title": {"text": self.units.head("stress range [MPa]")}}, "yaxis": {
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
        note_bounces(sim, self.output)
        if recorder is not None and len(recorder):
            table = recorder.table
            for number, head in enumerate(columns_of(self.scene, recorder, self.units)[1:]):
                name, factor = self.units.head(head), self.units.factor_of(head)
                self.figures.append((name.split(" [")[0], "In the run.", {
                    "data": [line(table[:, 0], factor * table[:, 1 + number], name, 0)],
                    "layout": {"xaxis": {"title": {"text": "time [s]"}}, "yaxis": {"title": {"text": name}}}}))

    def _shape(self, sim: Sim) -> tuple[Any, Any]:
        found = sim.profile(self.part, self.pipes, 1)
        stress = _largest(found["von_mises"]) if sim.statistics().steps else None
        if stress is not None:
            self.stresses.append((stress, f"run, at {sim.time:.3g} s (largest of {FRAMES} moments)"))
        keep = slice(None, None, max(1, len(found.along) // POINTS))
        return found.position[keep], found.displacement[keep]

    # ---- Assumptions ------------------------------------------------------------------------------------------------
    def assumptions(self) -> list[tuple[str, str]]:
        """The basis of the answers."""
        scene, info = self.scene, self.scene.model.info()
        calls = scene.model.calls
        features = next((arguments[0].get("features") for name, arguments in calls if name == "compile"), None)
        left_out = [] if features is None else [one.name for one in enums.Feature
                                                if one.name and not one & features and one & (one - 1) == 0]
        found = [("pipes, elements, degrees of freedom", f"{info.pipes}, {info.elements}, {info.degrees_of_freedom}"),
                 ("mass, length", f"{self.units.text(info.mass, 'kg')}, {self.units.text(info.length, 'm')}"), *_wall(calls, self.units)]
        found += [("left out", ", ".join(str(one).lower() for one in left_out) or "nothing that the scene describes"),
                  ("not in this page", "connections, bit load in the stiff string, other friction factors"),
                  ("units", NAMES_OF[self.units.name]), ("library", f"{__version__}, hash of the last state {self.hash}"),
                  ("Python", platform.python_version())]
        return found


def _wall(calls: Any, units: Units) -> list[tuple[str, str]]:
    if not any(name == "add_wall" for name, _ in calls):
        return []
    wall: Any = _structs.WallDef(**next((arguments[0] for name, arguments in calls if name == "add_wall"), {}))
    sections = any(name == "add_hole_sections" for name, _ in calls)
    return [("wall", f"diameter {units.text(1e3 * wall.diameter, 'mm', 'g')}, {_stiffness(wall, units)}friction {wall.mu_static:g} at rest and "
             f"{wall.mu_dynamic:g} sliding, " + ("other values in its sections" if sections else "the same along the hole"))]


def _stiffness(wall: Any, units: Units) -> str:
    """Left out where its unit, N/m^(n+1), has no equivalent."""
    if units.name == "si":
        return f"stiffness {wall.stiffness:g} per metre, "
    return f"stiffness {units.text(wall.stiffness, 'N/m2')}, " if wall.exponent == 1.0 else ""


def _force(units: Units) -> float:
    """Factor from N to the unit of figures of forces."""
    return 1e-3 * units.factor("kN")


def _largest(values: Any) -> float | None:
    known = [float(one) for one in values if not math.isnan(one)]
    return max(known) if known else None


def report(scene: Scene, output: Output, options: Any) -> int:
    """The page, in the folder of the answer."""
    if output.folder is None:
        raise Usage("report needs --output FOLDER")
    if not scene.pipes:
        raise Usage("report is about a string, the scene has none")
    need("plotly.offline")
    study = Study(scene, output)
    study.ask()
    for tile in study.tiles:
        output.say(str(tile))
    output.path("report.html").write_text(page(study), encoding="utf-8")
    output.summary["hash"] = study.hash
    return output.finish()
