"""The commands of `drillmbd` that compute results of a scene, one function each."""
from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from . import rotating, station
from ._optional import need
from ._progress import INTERRUPTS
from .results import CommandOutput, count_fatigue, file_name, note_bounces, note_steps, record, report_fatigue
from .enums import Status
from .errors import Usage
from .language import Phrase
from .no_response import NOTHING_EXCITES, of_response
from .profile import span
from .scene import Scene, words
from .scene.units import UnitError, parse
from .run_quality import FirstTenth, LastPart, TurnAStep, bent_elements, energy_error
from .run_state import Kept, KeptFatigue, KeptRecorder, RunState, stop_requested
from .running import Bar
from .sim import Sim
from .unit_systems import Units

MOST_ROWS = 50_000_000
MOST_STEPS = 1e12
LOOK = 0.2  #: [s] by the clock between two looks for Ctrl-C in a run


def check(scene: Scene, out: CommandOutput, options: Any) -> int:
    """The parts of the scene."""
    with scene.new_sim() as sim:
        out.note(sim.status, "start")
        report, text = sim.check(), out.units.sentence(sim.check_text())
        understood = [out.units.sentence(one) for one in words.describe(scene, sim.momentum().mass)]
    out.summary.update(model=record(scene.model.info()), check=record(report), understood=understood,
                       left_out=words.trivial(scene))
    notes = out.summary["warnings"]
    if notes:
        text = text.replace("  warnings: none",
                            f"  warnings of the model: none; notes on the scene: {len(notes)}, above")
    text = "\n".join(["the scene:", *(f"  {one}" for one in understood), text.rstrip("\n")])
    out.say(text)
    if out.folder is not None:
        out.path("check.txt").write_text("".join(f"note: {one}\n" for one in notes) + text + "\n", encoding="utf-8")
    return out.finish()


def to_rest(scene: Scene, sim: Sim, out: CommandOutput, linear: bool = False) -> None:
    """The static state that [static] describes. Natural frequencies are those about an equilibrium without assumed
    slip."""
    values = scene.fields_of("static")
    if linear and (values.pop("slip_axial", 0.0), values.pop("slip_rotation", 0.0)) != (0.0, 0.0):
        out.note_text("the static state is taken without the slip of [static]: friction that it assumes is gone when "
                         "the string vibrates")
    settled(scene, sim, out, values)


def settled(scene: Scene, sim: Sim, out: CommandOutput, values: dict[str, Any]) -> None:
    """The static state by these options, its report and its notes."""
    report = sim.static(**values)
    out.note(report.status, "static", sim.message)
    out.summary["static"] = {**record(report), "status_name": Status(report.status).name}
    out.say(f"static state: {report.iterations} iterations, residual {report.residual:.1e}, "
               f"displacement up to {out.units.text(1e3 * report.lateral_move, 'mm')}")
    if report.free_spins:
        out.say(f"free rotation: nothing resists the rotation of {report.free_spins} "
                   f"{'string' if report.free_spins == 1 else 'strings'} about the axis; the starting angle is kept")


def profiles(scene: Scene, sim: Sim, out: CommandOutput, word: str) -> None:
    """Each string's profile as table and picture."""
    units = out.units
    for name, pipes in scene.pipes.items():
        found = sim.profile(scene.names[name], pipes)
        per_contact = found.contact_force.sum()
        axial, torque, bending = (span(one) for one in (found.axial_force, found.torque, found.bending_moment))
        forces = "rigid pipes, which have no section forces"
        if not math.isnan(axial[0]):
            forces = (f"axial force {units.number(axial[0], 'N')} .. {units.text(axial[1], 'N')}, torque up to "
                      f"{units.text(max(-torque[0], torque[1]), 'N m')}, bending up to "
                      f"{units.text(bending[1], 'N m')}")
        out.say(f"{name}: {forces}, on the wall {units.text(per_contact, 'N')}")
        out.summary.setdefault("strings", {})[name] = {
            "axial_force_N": list(axial), "torque_N_m": list(torque), "bending_moment_N_m": bending[1],
            "wall_force_N": float(per_contact)}
        if out.folder is not None:
            heads = ["along [m]", "depth [m]", "x [m]", "y [m]", "z [m]", "axial force [N]", "torque [N m]",
                     "bending moment [N m]"]
            rows = zip(found.along, found.depth, *found.position.T, found.axial_force, found.torque,
                       found.bending_moment)
            out.table(f"{word}_{file_name(name)}.csv", heads, ([float(one) for one in row] for row in rows))
            out.picture(f"{word}_{file_name(name)}.png", lambda plots: plots.profile(found, f"{name}: {word}", units))
            out.picture(f"{word}_{file_name(name)}_shape.png", lambda plots: plots.string(found, None, name, units))


def holes(scene: Scene, sim: Sim, out: CommandOutput) -> None:
    """The hole as far as the strings lie in it, for ParaView."""
    if out.folder is None or not any(name == "add_wall" for name, _ in scene.model.calls):
        return
    ends = [sim.pose(station(scene.names[name], pipe, fraction)).depth
            for name, pipes in scene.pipes.items() for pipe, fraction in ((0, 0.0), (pipes - 1, 1.0))]
    if ends and max(ends) > min(ends):
        scene.model.write_vtk_hole(out.path("hole.vtp"), max(0.0, min(ends)), max(ends),
                                   max((max(ends) - min(ends)) / 500.0, 0.1))


def static(scene: Scene, out: CommandOutput, options: Any) -> int:
    """The static state."""
    with scene.new_sim() as sim:
        out.note(sim.status, "start")
        to_rest(scene, sim, out)
        profiles(scene, sim, out, "static")
        bent_elements(sim, out, "static state")
        if out.folder is not None:
            sim.write_vtk(out.path("static.vtp"))
        holes(scene, sim, out)
        out.summary["hash"] = f"{sim.hash():016x}"
    return out.finish()


def _time(text: str | None, known: float | None, what: str) -> float | None:
    if text is None:
        return known
    try:
        found = parse(text, "s")
    except UnitError as error:
        raise Usage(f"--{what} {text}: {error}") from error
    if not found > 0.0:
        raise Usage(f"--{what} {text}: must be > 0 s")
    return found


def run(scene: Scene, out: CommandOutput, options: Any) -> int:
    """The scene in time. After Ctrl-C the same command continues from the state in its folder."""
    end = _time(options.until, scene.run.get("end"), "until")
    step = _time(options.step, scene.run.get("step"), "step")
    if end is None:
        raise Usage(f"{options.scene} has no [run] end; give it, or --until TIME")
    rows, interval = _rows(scene, end, step)
    with scene.new_sim() as sim:
        out.note(sim.status, "start")
        state = RunState(scene, sim, out, [end, step, bool(options.verify)])
        if scene.run.get("static", 0) and not state.begun:
            to_rest(scene, sim, out)
        recorder = sim.recorder([(place, quantity, name) for name, place, quantity in scene.outputs], rows, interval
                                ) if scene.outputs else None
        counters = count_fatigue(scene, sim)
        last = LastPart(scene, sim, end, step) if options.verify else None
        first = FirstTenth(sim, sim.time, end) if scene.sim.get("energy_ledger", 1) else None
        turning = TurnAStep(scene, sim, end, step) if step else None
        quality = {name: one for name, one in (("last", last), ("first", first), ("turning", turning))
                   if one is not None}
        parts: dict[str, Kept] = {**quality, **{f"fatigue of {name}": KeptFatigue(one)
                                                for name, one in counters.items()}}
        if recorder is not None:
            parts["recorder"] = KeptRecorder(recorder)
        course = Course(scene, sim, out, state, end, step)
        course.take_up(parts)
        stopped = course.go(recorder, [*counters.values(), *quality.values()])
        report_fatigue(counters, out)
        if first is not None and sim.statistics().steps:
            energy_error(sim, out, first, not stopped)
        if turning is not None:
            turning.report(out)
        bent_elements(sim, out, "end of the run")
        _run_results(scene, sim, out, recorder)
        if last is not None and not stopped:
            last.verify(out)
        if not stopped:
            state.done()
    return out.finish()


def _rows(scene: Scene, end: float, step: float | None) -> tuple[int, float]:
    """Rows of the recorder, and the interval between them [s]."""
    interval = scene.results.get("interval", 0.0)
    if step and end / step > MOST_STEPS:
        raise Usage(f"{end / step:.3g} steps of {step:g} s to {end:g} s are more than {MOST_STEPS:g}: give a longer "
                    "step or an earlier end")
    rows = int(end / interval + 2) if interval else int(end / step + 3) if step else 1_000_000
    if rows * (1 + len(scene.outputs)) > MOST_ROWS:
        raise Usage(f"{float(rows):.4g} rows of {1 + len(scene.outputs)} numbers are more than {MOST_ROWS}: "
                    "give a longer [results] interval")
    return rows, interval


class Course:
    """A run to its end in stretches from one file for ParaView to the next."""

    def __init__(self, scene: Scene, sim: Sim, out: CommandOutput, state: RunState, end: float,
                 step: float | None) -> None:
        self.sim, self.out, self.state, self.end, self.step = sim, out, state, end, step
        every = scene.results.get("vtk_interval") if out.folder is not None else None
        # whole steps: files change no step
        self.every = max(1, round(every / step)) * step if every and step else every
        self.begin, self.frame, self.elapsed = sim.time, 0, 0.0
        self.notes: dict[Status, str] = {}

    def take_up(self, parts: dict[str, Kept]) -> None:
        """Continues from a stored state."""
        kept = self.state.take_up(parts)
        if kept:
            self.begin, self.frame, self.elapsed = kept["begin"], kept["frame"], kept["elapsed"]
            self.notes = {Status(int(status)): text for status, text in kept["notes"].items()}
            self.out.summary.update(kept["summary"])
            for frame in range(self.frame):
                self.out.path(f"string_{frame:04d}.vtp")

    def kept(self) -> dict[str, Any]:
        """For the state."""
        return {"begin": self.begin, "frame": self.frame, "elapsed": self.elapsed,
                "notes": {int(status): text for status, text in self.notes.items()},
                "summary": {key: self.out.summary[key] for key in ("static",) if key in self.out.summary}}

    def go(self, recorder: Any, counters: list[Any]) -> bool:
        """Runs to the end; True where Ctrl-C stopped it."""
        bar = None if self.out.quiet else Bar(self.begin, self.end)
        at, before, started = self.sim.time, self.elapsed, time.perf_counter()
        stopped = False
        self.sim.on_progress = None  # the bar shows it

        def shown(progress: Any) -> bool:
            self.elapsed = before + time.perf_counter() - started
            if bar is not None:
                bar(progress)
            return stop_requested(self.state, self.kept)

        try:
            with INTERRUPTS.held():
                while not self._at_end() and not INTERRUPTS.pending:
                    self._stretch(recorder, shown, counters)
                stopped = INTERRUPTS.pending and not self._at_end()
                INTERRUPTS.pending = stopped
        except KeyboardInterrupt:
            stopped = True
        self.elapsed = before + time.perf_counter() - started
        if bar is not None:
            bar.close()
        if stopped:
            self.state.stopped(self.end, self.kept())
        if self.every:
            self.sim.write_vtk(self.out.path(f"string_{self.frame:04d}.vtp"))
        self._report(at, time.perf_counter() - started, stopped)
        note_steps(self.notes, self.out)
        return stopped

    def _at_end(self) -> bool:
        return not self.end - self.sim.time > (1e-6 * self.step if self.step else 0.0)

    def _stretch(self, recorder: Any, shown: Any, counters: list[Any]) -> None:
        """To the next file, or to the end; a stretch that was stopped continues."""
        if not self.every:
            at = self.sim.run_noting(self.end, self.step, recorder, shown, LOOK, counters, self.begin)
            self.notes.update(at.notes)
            return
        if self.sim.time >= self.begin + self.frame * self.every - 1e-6 * (self.step or 0.0):
            self.sim.write_vtk(self.out.path(f"string_{self.frame:04d}.vtp"))
            self.frame += 1
        at = self.sim.run_noting(min(self.end, self.begin + self.frame * self.every), self.step, recorder, shown, LOOK,
                                 counters,
                                 self.begin + (self.frame - 1) * self.every)
        self.notes.update(at.notes)

    def _report(self, at: float, elapsed: float, stopped: bool) -> None:
        sim, factor = self.sim, (self.sim.time - self.begin) / self.elapsed if self.elapsed else None
        self.out.summary["run"] = {"time_s": sim.time, "end_s": self.end, "steps": sim.statistics().steps,
                                   "elapsed_s": self.elapsed,
                                      "real_time_factor": factor}
        self.out.say(f"{'stopped at' if stopped else 'ran to'} {sim.time:g} s in {sim.statistics().steps} steps"
                        + (f", {(sim.time - at) / elapsed:.1f} times real time" if elapsed else ""))


def _run_results(scene: Scene, sim: Sim, out: CommandOutput, recorder: Any) -> None:
    note_bounces(sim, out)
    if recorder is not None and len(recorder):
        table, units = recorder.table, out.units
        ranges = {name: [float(column.min()), float(column.max())]
                  for name, column in zip(recorder.columns[1:], table.T[1:])}
        out.summary["outputs"] = ranges
        heads = columns_of(scene, recorder, units)
        for head, (low, high) in zip(heads[1:], ranges.values()):
            out.say(f"{units.head(head)}: {low * units.factor_of(head):.5g} .. {high * units.factor_of(head):.5g}")
        out.table("run.csv", heads, table.tolist())
        out.picture("run.png", lambda plots: plots.history(table * [units.factor_of(head) for head in heads],
                                                           [units.head(head) for head in heads],
                                                              scene.title))
    profiles(scene, sim, out, "end")
    holes(scene, sim, out)
    out.summary["hash"] = f"{sim.hash():016x}"


def columns_of(scene: Scene, recorder: Any, units: Units) -> list[str]:
    """The heads of a recorder, with units in SI. In SI they are the names of the scene."""
    return list(recorder.columns) if units.name == "si" else ["time [s]", *scene.output_heads()]


def stations_of(scene: Scene) -> list[tuple[str, list[Any], list[float]]]:
    """Name, places and distances along each string."""
    return [(name, [station(scene.names[name], pipe, 1.0) for pipe in range(pipes)],
             [float(pipe + 1) for pipe in range(pipes)]) for name, pipes in scene.pipes.items()]


def modes(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Natural frequencies."""
    values = scene.fields_of("modes")
    if options.count is not None:
        values["count"] = options.count
    with scene.new_sim() as sim:
        to_rest(scene, sim, out, linear=True)
        found = sim.modes(**values)
        if found.status == Status.NOTE_INCOMPLETE:  # modes are missing
            out.note(found.status, "modes", sim.message)
        heads = ["frequency [Hz]", "damping [-]", "rigid", "axial [-]", "torsional [-]", "lateral [-]"]
        rows = [(mode.frequency, mode.damping, mode.rigid, *mode.share) for mode in found]
        out.say("   ".join(heads))
        for row in rows:
            out.say(f"{row[0]:14.6g} {row[1]:13.4g} {row[2]:7d} {row[3]:11.3f} {row[4]:15.3f} {row[5]:13.3f}")
        out.table("modes.csv", heads, rows)
        out.summary["modes"] = {"frequency_Hz": [row[0] for row in rows], "damping": [row[1] for row in rows]}
        for name, places, along in stations_of(scene):
            out.picture(f"modes_{file_name(name)}.png",
                           lambda plots: along_pipes(plots.shapes(found, places, along, 6, "modes")))
        if out.folder is not None:
            for index in range(min(len(found), 12)):
                found.write_vtk(index, out.path(f"mode_{index:02d}.vtp"))
    return out.finish()


def along_pipes(figure: Any) -> Any:
    figure.axes[-1].set_xlabel("pipe, from the rig [-]")
    return figure


def response(scene: Scene, out: CommandOutput, options: Any) -> int:
    """The causes of vibration and their amplitudes."""
    numpy = need("numpy")
    state, found = rotating.linear(scene, "response", lambda sim, state: settled(state.scene, sim, out, state.static),
                                   _respond, out.note_text)
    found, reasons, neglects = found
    if neglects:
        out.note_text(out.units.sentence(neglects))
    with found:
        names, units = scene.output_names("response"), out.units
        if state.rotation:
            out.say(state.words(units))
        out.summary["linear_state"] = state.numbers()
        peaks: dict[str, dict[str, float | None]] = {}
        for index, name in enumerate(names):
            size = numpy.abs(found.transfer(output=index))
            at = int(size.argmax())
            if reasons[index] is not None:
                peaks[name] = {"amplitude": None, "frequency_Hz": None}
                out.say(f"{units.head(name)}: "
                        f"{'not assessed' if reasons[index] is NOTHING_EXCITES else 'no response'}, because "
                        f"{reasons[index]}")
                continue
            peaks[name] = {"amplitude": float(size[at]), "frequency_Hz": float(found.frequencies[at])}
            out.say(f"{units.head(name)}: largest {size[at] * units.factor_of(name):.4g} at "
                    f"{found.frequencies[at]:.4g} Hz")
        out.summary["response"] = peaks
        if out.folder is not None and units.name == "si":
            found.write_csv(out.path("response.csv"))
        elif out.folder is not None:
            _response_table(found, names, out)
        out.picture("response.png", lambda plots: plots.response(found, names, scene.title, units))
    return out.finish()


def _respond(sim: Sim, state: rotating.Linear) -> tuple[Any, list[Phrase | None], str]:
    """The response, for each output None, or why it does not move, and a sentence about effects that it neglects."""
    outputs = state.scene.response_outputs("response")
    found = sim.response(state.scene.excitations(), outputs, **state.options)
    neglects = rotating.neglected(found.status, sim.message)
    sizes = [abs(found.transfer(output=index)) for index in range(len(outputs))]
    return found, [of_response(sim, state.scene, state.scene.excitations(), one, state.options,
                               float(found.frequencies[int(size.argmax())]))
                   for one, size in zip(outputs, sizes)], neglects


def _response_table(found: Any, names: list[str], out: CommandOutput) -> None:
    """Amplitude and phase of each output for all inputs together; those for one input have units of the output over
    units of the input."""
    numpy = need("numpy")
    heads, columns = ["frequency [Hz]"], [found.frequencies]
    for index, name in enumerate(names):
        values = found.transfer(output=index)
        heads += [f"amplitude of {name}", f"phase of {name[:name.rindex(' [')]} [rad]"]
        columns += [numpy.abs(values), numpy.angle(values)]
    out.table("response.csv", heads, ([float(one) for one in row] for row in zip(*columns)))


def speeds(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Critical rotary speeds."""
    from .critical_speeds import speeds as command
    return command(scene, out, options)


def torque_drag(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Hook load and torque of the rig by depth and operation."""
    from .torque_drag import torque_drag as command
    return command(scene, out, options)


def buckle(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Critical factors, and thrusts that buckle a soft string."""
    from .buckle import buckle as command
    return command(scene, out, options)


def report(scene: Scene, out: CommandOutput, options: Any) -> int:
    """One page about it all."""
    from .report import report as command
    return command(scene, out, options)


def stuck(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Force and torque that arrive at a stuck far end."""
    from .stuck import stuck as command
    return command(scene, out, options)


def rod_by_rod(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Loads of the rig for each number of rods."""
    from .rod_by_rod import rod_by_rod as command
    return command(scene, out, options)


COMMANDS: dict[str, Callable[[Scene, CommandOutput, Any], int]] = {
    "report": report, "check": check, "static": static, "run": run, "modes": modes, "response": response,
    "speeds": speeds,
    "torque-drag": torque_drag, "buckle": buckle, "stuck": stuck, "rod-by-rod": rod_by_rod}
