"""The report: every analysis of a scene, the largest demand of each kind against its limit, and figures. Made into a
page by report_page."""
from __future__ import annotations

import datetime
import math
from collections.abc import Callable
from typing import Any

from . import __version__, enums, commands
from ._optional import need
from ._progress import INTERRUPTS
from ._structs import FatigueResult
from .results import CommandOutput, count_fatigue, finite, note_bounces, note_steps, report_fatigue
from .enums import Status
from .errors import Error, Usage
from .fatigue import StringFatigue
from .language import Foreign, Phrase, joined, phrase
from .operating import Operating, has_rock_law, operating, operations_of, polar_moduli
from .plots import COLOURS, words_of
from .profile import Profile, ends_of_elements, extremes_of, values_of
from .commands import columns_of
from .report_basis import Row, assumptions, headline, limits_at_the_rig
from .report_figures import Figure, InSpace, in_space, line, picture_in_space, rounded, value_axis
from .report_hole import HoleView, hole_view
from .report_linear import Speeds, buckling_tile, speeds, speeds_figure, speeds_tile
from .report_frames import Frames
from .report_live import packed_page
from .report_page import page
from .report_probability import Probability, read_probability
from .rig_torque import balanced
from .run_state import MOST_BYTES, Kept, KeptFatigue, KeptRecorder, RunState, stop_requested
from .scene import Scene, words
from .sim import Sim
from .unit_systems import Units
from .verdict import NEAR, NEAR_SHARE, NO_LIMIT, NOT_ASSESSED, NOT_COMPUTED, OK, OVER, Demand, Tile, duration, shown

FRAMES, STRESSES, POINTS, DEPTHS = 60, 2000, 300, 40
REACHED = 1e-3  #: of the load on the bit, less in a run
#: Operations in the order of OPERATIONS, with the names of the library.
OPERATION_NAMES = (phrase("pick-up"), phrase("slack-off"), phrase("rotate"), phrase("drill"), phrase("slide"),
                   phrase("back-ream"))


class Study:
    """Content of the page. An analysis that fails becomes a tile with its reason; the others continue."""

    def __init__(self, scene: Scene, out: CommandOutput, probability: Probability | None = None) -> None:
        self.scene, self.out, self.title, self.units = scene, out, scene.title, out.units
        self.string, self.pipes = next(iter(scene.pipes.items()))
        self.part, self.limits = scene.names[self.string], scene.limits
        self.stations = ends_of_elements(scene.model.calls, self.part)
        self.plan: Operating = operating(scene, 0)  # of the first string
        self.operations: dict[str, Profile] = {}
        self.demands = {key: Demand(title, unit, self.limits.get(key), units=self.units, key=key)
                        for key, title, unit in (
            ("push", phrase("Thrust at the rig"), "N"), ("pull", phrase("Pull at the rig"), "N"),
            ("torque", phrase("Torque at the rig"), "N m"),
            ("yield_stress", phrase("Von Mises stress"), "Pa"))}
        self.soft: list[str] = []                    # analyses that have the torque of the bit
        self.tiles: list[Tile] = []
        self.figures: list[Figure] = []
        self.probability = probability
        self.speeds: Speeds | None = None
        self.rows: list[Row] = []                    # limits at the rig
        self.hole: HoleView | None = None
        self.space: InSpace | None = None            # as at the end of the run
        self.state: RunState | None = None           # of the complete run
        self.check, self.hash = "", ""
        self.live = ""                               # packed page that runs the scene
        self.headline: str = headline(self.string, self.plan, self.units)
        self.understood: list[str] = []
        self.made: str = phrase("Made on {date} by drillmbd {version} from {file}",
                                date=f"{datetime.date.today():%Y-%m-%d}", version=__version__,
                           file=out.summary["scene"])

    def compute(self) -> None:
        """All analyses in the order of the page."""
        everything = tuple(self.demands)
        self._attempt(phrase("soft string"), everything[:3], self._torque_drag)
        self._attempt(phrase("stiff string"), everything, self._operations)
        self._attempt(phrase("run in time"), everything, self._run)
        self._bit_torque()
        self._missing_loads()
        self._other_strings()
        self.tiles[:0] = [demand.tile() for demand in self.demands.values()]
        self._attempt(phrase("Critical speeds"), (), self._speeds)
        if "buckling" in self.scene.analyses:
            self._attempt(phrase("Buckling, nonlinear"), (), self._buckling)
        self.rows = limits_at_the_rig(self.demands, self.tiles, self.speeds, self.plan, self.units)
        with self.scene.new_sim() as sim:
            self.check = sim.check_text()
            self.understood = [self.units.sentence(one) for one in words.describe(self.scene, sim.momentum().mass)]
        if self.probability is not None:
            self.tiles += self.probability.tiles(self.units)
            self.figures += self.probability.figures()
        self.out.summary["verdicts"] = [vars(tile) for tile in self.tiles]

    def _bit_torque(self) -> None:
        """Stiff string and run lack a torque of the bit that is estimated. The von Mises stress is a norm of the
        stresses, so that theirs and that of the torque, sqrt(3) T r/J in the weakest pipe, bound the stress of both
        together."""
        if not self.plan.estimated:
            return
        more = math.sqrt(3.0) * self.plan.torque_on_bit / min(polar_moduli(self.scene), default=math.inf)
        demand = self.demands["yield_stress"]
        stress = shown(more, "Pa", self.units)
        demand.found = [(value, source) if source in self.soft else
                        (value + more, phrase("{source}, and {stress} by the estimated torque of the bit",
                                              source=source, stress=stress))
                        for value, source in demand.found]

    def _other_strings(self) -> None:
        """Analyses of one string see the first one only; fatigue is counted in all of them."""
        others = joined(", ", [name for name in self.scene.pipes if name != self.string])
        if others:
            for demand in self.demands.values():
                demand.failed.append(phrase("other strings ({strings}), which the analyses of one string leave out",
                                            strings=others))
            for tile in self.tiles:
                if tile.verdict == OK and tile.title != phrase("Fatigue"):
                    tile.verdict, tile.text = (NOT_ASSESSED, phrase("of string {string} only; {text}",
                                                                    string=self.string, text=tile.text))

    def _missing_loads(self) -> None:
        """Loads of drilling that no analysis has: without them no verdict on thrust, torque and stress is OK."""
        ran, cuts = "end" in self.scene.run, has_rock_law(self.scene)
        if cuts and not ran:
            for key in ("push", "torque", "yield_stress"):
                self.demands[key].failed.append(phrase("the load and torque of the bit, which the rock law gives in a "
                                                       "run only"))
        elif not self.plan.weight_on_bit and not cuts:
            for key in ("push", "torque", "yield_stress"):
                self.demands[key].failed.append(phrase("the load on the bit, which the scene does not give"))
        elif not self.plan.estimated and not cuts:
            for key in ("torque", "yield_stress"):
                self.demands[key].failed.append(phrase("the torque of the bit, which is not estimated without its "
                                                       "diameter"))
        elif not math.isfinite(self._yield_strength()) and not ran:
            self.demands["yield_stress"].failed.append(phrase("the load on the bit, because the scene has no [run] "
                                                              "end"))
        elif not math.isfinite(self._yield_strength()) and not self._run_is_loaded():
            self.demands["yield_stress"].failed.append(phrase("the load on the bit, which the run of {end:g} s does "
                                                              "not reach", end=self.scene.run["end"]))

    def _run_is_loaded(self) -> bool:
        """Whether the load on the bit is at its largest before the run ends."""
        within = operating(self.scene, 0, self.scene.run["end"]).weight_on_bit or 0.0
        return within >= (1.0 - REACHED) * (self.plan.weight_on_bit or 0.0)

    def _attempt(self, what: Phrase, demands: tuple[str, ...], analysis: Callable[[], None]) -> None:
        try:
            analysis()
        except (Error, ArithmeticError) as error:
            reason = self.units.sentence(_reason(error))
            self.out.note_text(phrase("{analysis}: not computed. {reason}", analysis=what, reason=reason))
            for key in demands:
                self.demands[key].failed.append(phrase("{analysis}: {reason}", analysis=what, reason=reason))
            if not demands:
                self.tiles.append(Tile(what, phrase("not computed"), reason, NOT_COMPUTED))

    # ---- Statics ----------------------------------------------------------------------------------------------------
    def _static(self, sim: Sim, **slip: float) -> int:
        values: dict[str, Any] = self.scene.fields_of("static")
        values.update({"slip_axial": 0.0, "slip_rotation": 0.0, **slip})
        try:
            status = sim.static(**values).status
        except Error as error:
            if error.status != enums.ERR_NO_CONVERGENCE:
                raise
            values["load_steps"] = 10  # friction around a string lets it climb
            status = sim.static(**values).status
            self.out.note_text(phrase("static state: found in ten load steps"))
        self.out.note(status, phrase("static state"), Foreign(sim.message, self.out.units))
        return int(status)

    def _operations(self) -> None:
        speed = abs(self.scene.analyses.get("static", {}).get("slip_axial", 0.0)) or self.plan.feed or 0.01
        rotation = self.plan.rotation or 10.0
        for name, key, slip in ((phrase("pushed in"), "push", {"slip_axial": speed}),
                                (phrase("pulled out"), "pull", {"slip_axial": -speed}),
                                (phrase("rotated"), "torque", {"slip_rotation": rotation})):
            self._attempt(phrase("stiff string, {operation}", operation=name), (key, "yield_stress"),
                          lambda name=name, key=key, slip=slip: self._operation(name, key, slip))  # type: ignore[misc]
        self.out.summary["operations"] = {name: {"axial_force_at_rig_N": found.axial_force[0],
                                                    "torque_at_rig_N_m": found.torque[0]}
                                             for name, found in self.operations.items()}
        if not self.operations:
            return
        self.figures.append((phrase("Axial force by operation"),
                             phrase("Stiff string at rest, with friction as if it moved that way, with the loads of "
                                    "time 0 s. Tension is positive."), self._along("axial_force", "push")))
        self.figures.append((phrase("Torque by operation"),
                             phrase("Stiff string at rest, with friction as if it moved that way, with the loads of "
                                    "time 0 s."), self._along("torque", "torque")))

    def _operation(self, name: Phrase, key: str, slip: dict[str, float]) -> None:
        scene, _ = balanced(self.scene, {**self.scene.fields_of("static"), **slip})
        with scene.new_sim() as sim:
            status = self._static(sim, **slip)
            found = self.operations[name] = sim.profile(scene.names[self.string], self.pipes)
            within = self._stress(sim)
        axial = float(found.axial_force[0])
        at_rig = {"push": -axial, "pull": axial, "torque": abs(float(found.torque[0]))}[key]
        source = phrase("stiff string, {operation}, loads of time 0 s", operation=name)
        self.demands[key].add(at_rig, source)
        if status == Status.NOTE_UNSTABLE:
            for demand in (key, "yield_stress"):
                self.demands[demand].failed.append(phrase("{source}: an unstable state, which the string leaves",
                                                          source=source))
        stress = _largest([*found["von_mises"], within])
        if any(math.isnan(one) for one in found["von_mises"]) and math.isnan(self._yield_strength()):
            self.demands["yield_stress"].failed.append(phrase("{source}: rigid pipes, which have no stress",
                                                              source=source))
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
        load = phrase("{load} on the bit", load=units.text((plan.weight_on_bit or 0.0) / 1e3, "kN"))
        self._soft_demands(found.rows)
        self._confinement(found.rows[-1])
        for title, field, factor, label, limits in (
                (phrase("Hook load by depth of the bit"), "hook_load", _force(units),
                 phrase("hook load [{unit}], < 0: the rig thrusts", unit=units.unit("kN")),
                 ("pull", "push")),
                (phrase("Torque by depth of the bit"), "torque", units.factor("N m"),
                 phrase("torque at the rig [{unit}]", unit=units.unit("N m")),
                 ("torque",))):
            data = [line([factor * value for value in found.column(field, number)],
                         [units.factor("m") * depth for depth in depths], name, number)
                    for number, name in enumerate(OPERATION_NAMES)]
            shapes = self._limit_lines({limit: -factor if limit == "push" else factor for limit in limits}, data)
            self.figures.append((title,
                                 phrase("Soft string in steady motion, {load} while drilling and sliding; dashed: "
                                        "limits of the rig.", load=load), {
                "data": data, "layout": {"xaxis": value_axis(label, *(one["x"] for one in data)), "shapes": shapes,
                                         "yaxis": {
                    "title": {"text": phrase("measured depth of the bit [{unit}]", unit=units.unit("m"))},
                    "autorange": "reversed"}}}))
        self.out.summary["torque_drag"] = {name: {"hook_load_N": finite(row.hook_load),
                                                  "torque_N_m": finite(row.torque)}
                                              for name, row in zip(OPERATION_NAMES, found.rows[-1])}

    def _soft_demands(self, table: Any) -> None:
        """The largest loads of each operation at all depths: a load on the bit that the weight of the string carries
        at the end is thrust of the rig where the string is short."""
        strength = self._yield_strength()
        for number, name in enumerate(OPERATION_NAMES):
            rows = [rows[number] for rows in table]
            locked = [row for row in rows if row.locked]
            if locked:
                for key in ("push", "torque", "yield_stress"):
                    self.demands[key].failed.append(phrase("{source}: the string locks up, no thrust moves the bit",
                                                           source=self._soft_source(name, locked[-1], rows[-1])))
            self._soft_demand("push", [(-row.hook_load, row) for row in rows if row.hook_load < 0.0], name, rows[-1])
            self._soft_demand("pull", [(row.hook_load, row) for row in rows if row.hook_load > 0.0], name, rows[-1])
            self._soft_demand("torque", [(row.torque, row) for row in rows if not row.locked], name, rows[-1])
            if not math.isnan(strength):
                self._soft_demand("yield_stress", [(strength * row.yield_share, row) for row in rows if not row.locked],
                                  name, rows[-1])

    def _soft_demand(self, key: str, values: list[tuple[float, Any]], name: Phrase, last: Any) -> None:
        """The largest value of an operation, that of the last depth where it is the same."""
        if values:
            largest, row = max(reversed(values), key=lambda one: math.inf if math.isnan(one[0]) else one[0])
            source = self._soft_source(name, row, last)
            self.demands[key].add(largest, source)
            self.soft.append(source)

    def _soft_source(self, name: Phrase, row: Any, last: Any) -> Phrase:
        return phrase("soft string, {operation}", operation=name) if row is last else \
            phrase("soft string, {operation}, bit at {depth}", operation=name, depth=self.units.text(row.depth, "m"))

    def _yield_strength(self) -> float:
        """[Pa] of all pipes; NaN where they differ or one has none: then no stress follows from the share."""
        given = {pipes.get("yield_strength", 0.0) for name, arguments in self.scene.model.calls if name == "add_pipes"
                 for pipes in arguments[1:2]}
        return float(min(given)) if len(given) == 1 and min(given) > 0.0 else math.nan

    def _confinement(self, rows: Any) -> None:
        """Largest share of the buckling loads of a pipe confined by its hole, in all operations."""
        title = phrase("Buckling in the hole")
        free = [(row.helical_share, row.sinusoidal_share, row.buckled_at, number) for number, row in enumerate(rows)
                if not row.locked]
        if len(free) < len(rows):
            locked = joined(", ", [name for name, row in zip(OPERATION_NAMES, rows) if row.locked])
            self.tiles.append(Tile(title, phrase("locks up"), phrase("no thrust at the rig moves the bit: {operations}",
                                                                     operations=locked), OVER))
        elif not all(math.isfinite(share) for share, *_ in free):
            self.tiles.append(Tile(title, phrase("not assessed"),
                                   phrase("the shares of the buckling loads are not defined for this string"),
                                   NOT_ASSESSED))
        else:
            helical, _, depth, number = max(free)
            sinusoidal = max(share for _, share, *_ in free)
            if not self.plan.weight_on_bit:
                verdict, text = NOT_ASSESSED, phrase("the scene gives no bit load")
            else:
                verdict = OVER if helical > 1.0 else NEAR if helical > NEAR_SHARE or sinusoidal > 1.0 else OK
                text = phrase("{operation}, at {depth}; {share:.3g} % of the sinusoidal buckling load",
                              operation=OPERATION_NAMES[number],
                              depth=self.units.text(depth, "m"), share=100.0 * sinusoidal)
            self.tiles.append(Tile(title, phrase("{share:.3g} % of the helical buckling load", share=100.0 * helical),
                                   text, verdict))

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
        factor, label = ((_force(units), phrase("axial force [{unit}]", unit=units.unit("kN"))) if limit == "push" else
                         (units.factor("N m"), phrase("torque [{unit}]", unit=units.unit("N m"))))
        data = [line(factor * values, self._depth(found), operation, number)
                for number, (operation, found) in enumerate(self.operations.items())
                for values in [getattr(found, name) if limit == "push" else abs(found.torque)]]
        shapes = self._limit_lines({limit: -factor if limit == "push" else factor}, data)
        return {"data": data, "layout": {"xaxis": value_axis(label, *(one["x"] for one in data)), "shapes": shapes,
                                         "yaxis": {
            "title": {"text": phrase("measured depth [{unit}]", unit=units.unit("m"))}, "autorange": "reversed"}}}

    # ---- Linear analyses --------------------------------------------------------------------------------------------
    def _speeds(self) -> None:
        if "speeds" not in self.scene.analyses:
            self.tiles.append(Tile(phrase("Critical speeds"), phrase("not assessed"),
                                   phrase("the scene has no [speeds] table"), NOT_ASSESSED))
            return
        self.speeds = found = speeds(self.scene, self.out.note_text)
        for note in found.notes():
            self.out.note_text(note)
        self.out.summary["speeds_rpm"] = [[band.low * 30.0 / math.pi, band.high * 30.0 / math.pi]
                                          for band in found.bands]
        self.tiles.append(speeds_tile(found, self.plan))
        if found.assessed:
            self.figures.append(speeds_figure(found))

    def _buckling(self) -> None:
        self.tiles.append(buckling_tile(self.scene, self._static, self.out))

    # ---- In time ----------------------------------------------------------------------------------------------------
    def _run(self) -> None:
        with self.scene.new_sim() as sim:
            if self.scene.run.get("static", 0) or "end" not in self.scene.run:
                self._static(sim, **{key: value for key, value in self.scene.fields_of("static").items()
                                     if key.startswith("slip")})
            self.hole = hole_view(self.scene, sim.profile(self.part, self.pipes), self.units)
            course = Frames([self._shape(sim)], [sim.time])
            self.figures.insert(0, (phrase("The string in its hole"),
                                    phrase("Displacement across the hole is enlarged so that the hole can be seen; the "
                                           "button draws it to scale. Drag to rotate, play or slide through the run."),
                                    {}))
            try:
                if "end" in self.scene.run:
                    self._in_time(sim, course)
                else:
                    self.tiles.append(Tile(phrase("Run in time"), phrase("not assessed"),
                                           phrase("the scene has no [run] end"), NOT_ASSESSED))
            finally:
                self.hash = f"{sim.hash():016x}"
                self.space = in_space(self.scene, course.shapes, self.units)
                self.figures[0] = (*self.figures[0][:2], picture_in_space(self.space, course.times, self.units))

    def _in_time(self, sim: Sim, course: Frames) -> None:
        counters = count_fatigue(self.scene, sim)
        course.watch(sim, [(self.part, "hook_load"), (self.part, "rotation_torque")], lambda: self._stress(sim),
                     self.scene.run["end"] / STRESSES)
        try:
            self._frames(sim, course, counters)
        finally:
            if sim.statistics().steps:
                load, torque = course.extremes()
                source = phrase("run of {time:.4g} s", time=sim.time)
                self.demands["push"].add(-load[0], source)
                self.demands["pull"].add(load[1], source)
                self.demands["yield_stress"].found += [(stress,
                                                        phrase("run, at {time:.3g} s (largest of {moments} moments)",
                                                               time=time, moments=len(course.stresses)))
                                                       for stress, time in sorted(course.stresses)[-1:]]
                self.demands["torque"].add(max(abs(torque[0]), abs(torque[1])), source)
        if self.scene.sim.get("energy_ledger", 1):
            self.out.summary["energy_error"] = sim.energy().error
        self._fatigue(counters)

    def _fatigue(self, counters: dict[str, StringFatigue]) -> None:
        title = phrase("Fatigue")
        if not counters:
            self.tiles.append(Tile(title, phrase("not assessed"), phrase("the scene has no [fatigue] table"),
                                   NOT_ASSESSED))
            return
        worst = report_fatigue(counters, self.out)
        string = max(worst, key=lambda one: (worst[one].damage, worst[one].largest_range))
        counter = counters[string]
        pipe = counter.pipes[counter.worst]
        missed = any(len(each.pipes) < each.count or any(one.clipped for one in each.results)
                     for each in counters.values())
        self.tiles.append(self._fatigue_tile(worst[string], pipe, missed))
        if len(counters) > 1:
            self.tiles[-1].text = phrase("string {string}: {text}", string=string, text=self.tiles[-1].text)
        self.figures.append((phrase("Fatigue along the string"),
                             phrase("Damage of this run by the S-N curve of the scene; 1 is its end."), {
            "data": [line(counter.pipes, [one.damage for one in counter.results], phrase("damage"), 0)],
            "layout": {"xaxis": {"title": {
                                 "text": phrase("pipe, counted from 0 at the rig end")}},
                       "yaxis": {"title": {"text": phrase("damage [-]")}, "exponentformat": "power"}}}))
        ranges, cycles = counter.histogram()
        known = [(1e-6 * self.units.factor("MPa") * stress, count) for stress, count in zip(ranges, cycles)
                 if count > 0.0]
        self.figures.append((phrase("Cycles of stress at pipe {pipe}", pipe=pipe),
                             phrase("Rainflow counting of the run; cycles that did not close count half."), {
            "data": [{"type": "bar", "x": rounded([one for one, _ in known]), "y": rounded([one for _, one in known]),
                      "marker": {"color": COLOURS[1]}}], "layout": {
                          "xaxis": {"title": {"text": phrase("stress range [{unit}]", unit=self.units.unit("MPa"))}},
                          "yaxis": {"title": {"text": phrase("cycles [-]")}, "rangemode": "tozero"}}}))

    def _fatigue_tile(self, found: FatigueResult, pipe: int, missed: bool) -> Tile:
        """Of the worst pipe. missed: not all pipes are counted, or cycles are beyond the range. A run that was stopped
        shows no part of the cycles of its rest."""
        title = phrase("Fatigue")
        if found.largest_range <= 0.0:
            return Tile(title, phrase("not assessed"), phrase("no stress cycle in this run"), NOT_ASSESSED)
        if math.isfinite(found.life):
            return Tile(title, duration(found.life), phrase(
                "life if this run is repeated, until pipe {pipe}, counted from 0 at the rig, reaches its S-N curve",
                pipe=pipe), OVER if found.damage > 1.0 else NO_LIMIT)
        text = phrase("in this run; largest range {range}, pipe {pipe}",
                      range=shown(found.largest_range, "Pa", self.units), pipe=pipe)
        return Tile(title, phrase("no damage"), text, NOT_ASSESSED if missed or self.out.interrupted else OK)

    def _frames(self, sim: Sim, course: Frames, counters: dict[str, StringFatigue]) -> None:
        end, step = self.scene.run["end"], self.scene.run.get("step")
        interval = max(self.scene.results.get("interval", 0.0), end / 4000.0)
        recorder = sim.recorder([(place, quantity, name) for name, place, quantity in self.scene.outputs],
                                int(end / interval) + 3, interval) if self.scene.outputs else None
        state = RunState(self.scene, sim, self.out, [end, step])
        parts: dict[str, Kept] = {"frames": course, **{f"fatigue of {name}": KeptFatigue(one)
                                                       for name, one in counters.items()}}
        state.take_up(parts if recorder is None else {**parts, "recorder": KeptRecorder(recorder)})
        every = max(1, round(end / FRAMES / step)) * step if step else end / FRAMES
        begin, stopped, notes = course.times[0], False, dict[Status, str]()

        def at_end() -> bool:
            return not end - sim.time > (1e-6 * step if step else 0.0)

        try:
            with INTERRUPTS.held():
                while not at_end() and not INTERRUPTS.pending:
                    done = len(course.times) - 1
                    at = sim.run_noting(min(end, begin + (done + 1) * every), step, recorder,
                                        lambda _: stop_requested(state, dict), commands.LOOK,
                                        [course, *counters.values()], begin + done * every)
                    notes.update(at.notes)
                    if not INTERRUPTS.pending or at_end():
                        self._shape_of(sim, course)
                stopped = INTERRUPTS.pending = INTERRUPTS.pending and not at_end()
        except KeyboardInterrupt:
            stopped = True
        if stopped:
            state.stopped(end, {})
            for demand in self.demands.values():
                demand.failed.append(phrase("the end of the run, which was stopped at {time:g} s of {end:g} s",
                                            time=sim.time, end=end))
        else:
            state.keep({}, MOST_BYTES)  # until the page is made
            self.state = state
        self.out.summary["run"] = {"time_s": sim.time, "steps": sim.statistics().steps}
        note_bounces(sim, self.out)
        note_steps(notes, self.out)
        if recorder is not None and len(recorder):
            table = recorder.table
            for number, head in enumerate(columns_of(self.scene, recorder, self.units)[1:]):
                name, factor = self.units.head(head), self.units.factor_of(head)
                self.figures.append((words_of(name), phrase("In the run."), {
                    "data": [line(table[:, 0], factor * table[:, 1 + number], name, 0)],
                    "layout": {"xaxis": {"title": {"text": phrase("time [s]")}},
                               "yaxis": value_axis(name, factor * table[:, 1 + number])}}))

    def _shape_of(self, sim: Sim, course: Frames) -> None:
        """One more frame, with the stress there."""
        course.shapes.append(self._shape(sim))
        course.times.append(sim.time)
        course.take_stress()

    def _stress(self, sim: Sim) -> float:
        """[Pa] The largest along the string."""
        return extremes_of(sim, self.part, [enums.PROFILE_VON_MISES], self.stations)[0].maximum

    def _shape(self, sim: Sim) -> tuple[Any, Any]:
        found = sim.profile(self.part, self.pipes, 1)
        keep = slice(None, None, max(1, len(found.along) // POINTS))
        return found.position[keep], found.displacement[keep]

    def assumptions(self) -> list[tuple[str, str]]:
        """The basis of the results."""
        return assumptions(self.scene, self.units, self.hash)


def _reason(error: Exception) -> str:
    """The sentence of an analysis without a result."""
    said = error.message if isinstance(error, Error) else error.args[0] if error.args else ""
    return said if isinstance(said, Phrase) else Foreign(said)


def _force(units: Units) -> float:
    """Factor from N to the unit of figures of forces."""
    return 1e-3 * units.factor("kN")


def _largest(values: Any) -> float | None:
    known = [float(one) for one in values if not math.isnan(one)]
    return max(known) if known else None


def report(scene: Scene, out: CommandOutput, options: Any) -> int:
    """The page, in the folder of the results."""
    if out.folder is None:
        raise Usage("report needs --output FOLDER")
    if not scene.pipes:
        raise Usage("report is about a string, the scene has none")
    need("plotly.offline")
    study = Study(scene, out, read_probability(options.probability, scene) if options.probability else None)
    study.compute()
    if options.live:
        study.live, refused = packed_page(scene, options.scene, out.language)
        if refused:
            study.tiles.append(refused)
            out.summary["verdicts"].append(vars(refused))
    for tile in study.tiles:
        out.say(tile.line())
    out.path("report.html").write_text(page(study), encoding="utf-8")
    out.summary["hash"] = study.hash
    if study.state is not None and not out.interrupted:
        study.state.done()
    return out.finish()
