"""Rotary speeds run in time: whether the torque oscillates or the lateral acceleration is large, beside the verdict of
the linear analysis."""
from __future__ import annotations

import concurrent.futures
import math
import multiprocessing
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from . import _structs, enums, remade, rotating
from ._keep import station
from ._optional import need
from .results import RPM, CommandOutput
from .errors import Error
from .scene import Scene

if TYPE_CHECKING:
    from .critical_speeds import Found

MOST_SPEEDS, PROCESSES, PLACES = 100, 2, 20
OSCILLATING = (enums.SEGMENT_HARMONIC, enums.SEGMENT_PERIODIC, enums.SEGMENT_PER_REVOLUTION)  #: kinds of segments
RAMP = 2.0              #: [s] of rotation and feed, and then of the loads on bits
WINDOW = 4.0            #: [s] that is assessed, at least
REVOLUTIONS = 3         #: in it, at least
PERIODS = 3             #: of the slowest torsional vibration, fixed at the rig, in it and before it, at least
SWING = 0.5             #: [-] half the range of the torque over its mean, above which it swings
#: [-] of the torque of a torsional wave with the rotary speed, below which a mean does not count: a range that is
#: smaller hardly changes the speed of any pipe
OF_WAVE = 0.01
#: [m/s2] root mean square of lateral acceleration above which the string leaves the wall by itself
GRAVITY = 9.81
STEADY, TORQUE, LATERAL, FAILED = "steady", "torque oscillates", "lateral acceleration", "run failed"
NO_DRIVE = ("check in time: not assessed, because no drive turns the string at a speed; give a drive with component = "
            "\"rx\"")


@dataclass
class Course:
    """Scene and times of the run of one speed."""
    scene: Scene
    speed: float          #: [rad/s]
    settle: float         #: [s] before the window
    end: float            #: [s]
    step: float | None    #: [s]
    drive: Any            #: its id
    least: float          #: [N m] least mean with which the range of the torque is compared


@dataclass
class Result:
    """Of one speed."""
    speed: float                    #: [rad/s]
    torque: float = math.nan        #: [N m] mean at the rig
    swing: float = math.nan         #: [-] half the range of the torque over its mean, or over Course.least
    acceleration: float = math.nan  #: [m/s2] largest root mean square of lateral acceleration along the string
    error: str = ""

    @property
    def verdict(self) -> str:
        """In words."""
        if self.error:
            return FAILED
        found = [word for word, over in ((TORQUE, self.swing > SWING), (LATERAL, self.acceleration > GRAVITY)) if over]
        return " and ".join(found) or STEADY


# ---- One speed -------------------------------------------------------------------------------------------------------
def ramp(begin: float, value: float) -> list[dict[str, Any]]:
    """Terms that lead from 0 to a value within RAMP."""
    return [{"kind": enums.SEGMENT_STEP5, "x0": begin, "x1": begin + RAMP, "h0": 0.0, "h1": value}]


def _ramps(scene: Scene, speed: float, turning: int) -> dict[int, list[dict[str, Any]]]:
    """Segments that replace those of the rotation, the feed and the loads of bits, by the number of the time
    function."""
    time_functions = remade.time_functions_of(scene)
    segments = {one: ramp(RAMP, rotating.extreme(time_functions, one)) for one in rotating.loads_of_bits(scene)
                if rotating.extreme(time_functions, one)}
    feed = rotating.drive_at_speed(scene, enums.X)
    if feed is not None and rotating.extreme(time_functions, feed):
        segments[feed] = ramp(0.0, rotating.extreme(time_functions, feed))
    segments[turning] = ramp(0.0, speed)
    return segments


def at_speed(scene: Scene, speed: float, turning: int) -> Scene:
    """The scene started within RAMP to the rotation and its feed, and then loaded; its other time functions are as
    described."""
    # which other processes do not need
    return replace(remade.with_time_functions(scene, _ramps(scene, speed, turning)), progress=None, changed=None)


def oscillation_left_out(scene: Scene, turning: int) -> bool:
    """Whether a time function that ramps replace oscillates."""
    time_functions = remade.time_functions_of(scene)
    return any(one.get("kind") in OSCILLATING for number in _ramps(scene, 0.0, turning)
               for one in time_functions[number])


def places_of(scene: Scene) -> list[Any]:
    """Ends of pipes, spread evenly along each string."""
    found = []
    for name, pipes in scene.pipes.items():
        for pipe in sorted({round((i + 1) * pipes / PLACES) - 1 for i in range(PLACES)} - {-1}):
            found.append(station(scene.names[name], pipe, 1.0))
    return found


def run(course: Course) -> Result:
    """Runs one speed and measures its window."""
    scene = remade.rebound(course.scene)
    try:
        with scene.new_sim() as sim:
            return _measured(course, scene, sim)
    except (Error, ArithmeticError) as error:
        return Result(course.speed, error=str(error))


def _measured(course: Course, scene: Scene, sim: Any) -> Result:
    numpy = need("numpy")
    places = places_of(scene)
    outputs: list[tuple[Any, int]] = [(scene.model.own(course.drive), enums.OUTPUT_DRIVE_FORCE)]
    outputs += [(place, enums.OUTPUT_BODY_ACCELERATION + axis) for place in places for axis in (enums.Y, enums.Z)]
    sim.static(**scene.fields_of("static"))
    sim.run_noting(course.settle, course.step)
    step = course.step or 1e-3
    recorder = sim.recorder(outputs, int((course.end - course.settle) / step + 3), 0.0 if course.step else step)
    sim.run_noting(course.end, course.step, recorder)
    table = numpy.array(recorder.table)
    torque, lateral = table[:, 1], table[:, 2:].reshape(len(table), len(places), 2)
    mean = float(torque.mean())
    size = numpy.sqrt((lateral ** 2).sum(axis=2).mean(axis=0))
    return Result(course.speed, mean, float(torque.max() - torque.min()) / 2.0 / max(abs(mean), course.least),
                  float(size.max()))


# ---- All speeds ------------------------------------------------------------------------------------------------------
def check(scene: Scene, out: CommandOutput, found: Found, count: int) -> None:
    """Runs speeds of the range of [speeds] in time, prints and writes them beside the linear verdict."""
    turning = rotating.drive_at_speed(scene, enums.RX)
    if turning is None:
        out.say(NO_DRIVE)
        out.summary["speeds_check"] = None
        return
    if oscillation_left_out(scene, turning):
        out.note_text("check in time: the rotation, feed or load on the bit of the scene oscillates, and the runs "
                      "leave that out; describe it by the key "
                      "excitation of the drive to include it")
    courses = _courses(scene, found, count, turning)
    longest = max(one.end for one in courses)
    out.say(f"check in time: {len(courses)} speeds of {courses[-1].end:.3g} to {longest:.3g} s each, in {PROCESSES} "
            "processes; rotation and feed are "
               f"started within {RAMP:g} s, loads on bits within {RAMP:g} s more; the last "
               f"{courses[-1].end - courses[-1].settle:.3g} to "
               f"{max(one.end - one.settle for one in courses):.3g} s are evaluated")
    started = time.perf_counter()
    results = []
    for one in _run_all(courses):
        results.append(one)
        out.say(_line(one, _linear(found, one.speed), out))
    elapsed = time.perf_counter() - started
    out.say(f"limits: torque oscillates where half its range exceeds {SWING:g} of its mean, or of {OF_WAVE:g} of the "
            "torque of a torsional wave with the rotary speed if the mean is smaller; lateral acceleration where "
            "its root mean square, the largest "
               f"of {len(places_of(scene))} places, exceeds {out.units.text(GRAVITY, 'm/s2', '.3g')}, with which "
               "weight no longer holds the string on the "
               f"wall. {elapsed:.0f} s by the clock")
    _report(results, found, out, elapsed)


def _courses(scene: Scene, found: Found, count: int, turning: int) -> list[Course]:
    """Speeds spread evenly over the range; the rotation of the scene takes the place of the nearest one."""
    low, high = found.grid[0], found.grid[-1]
    speeds = [low + (high - low) * i / (count - 1) for i in range(count)]
    own = abs(rotating.extreme(remade.time_functions_of(scene), turning))
    if low <= own <= high:
        speeds[min(range(count), key=lambda i: abs(speeds[i] - own))] = own
    slowest = slowest_period(scene)
    settle = 2.0 * RAMP + max(1.0, PERIODS * slowest)
    drive = next(part for part, (name, arguments) in zip(scene.model.ids, _parts(scene)) if name == "add_drive"
                 and arguments[0].get("time_function")
                 and remade.number_of(arguments[0]["time_function"]) == turning)
    return [Course(at_speed(scene, speed, turning), speed, settle,
                   settle + max(WINDOW, PERIODS * slowest, REVOLUTIONS * 2.0 * math.pi / speed), scene.run.get("step"),
                   drive, OF_WAVE * wave_torque(scene, speed)) for speed in speeds]


def _parts(scene: Scene) -> Iterator[tuple[str, tuple[Any, ...]]]:
    """Calls that made a part each, in the order of the model's ids."""
    return (call for call in scene.model.calls if call[0].startswith("add_") and call[0] != "add_hole_sections")


@dataclass
class _Shaft:
    """A string in torsion, of the section of its first pipes."""
    stiffness: float     #: [N m2] G J
    inertia: float       #: [kg m] rho J
    length: float = 0.0  #: [m]


def _shafts(scene: Scene) -> list[_Shaft]:
    """Of all strings."""
    found: dict[Any, _Shaft] = {}
    for name, arguments in scene.model.calls:
        if name != "add_pipes":
            continue
        pipe = _structs.PipeDef(**{key: value for key, value in arguments[1].items() if key != "string"})
        string = arguments[1].get("string") and remade.number_of(arguments[1]["string"])
        polar = math.pi / 32.0 * (pipe.outer_diameter ** 4 - pipe.inner_diameter ** 4)
        shear = 0.5 * pipe.young_modulus / (1.0 + pipe.poisson_ratio)
        shaft = found.setdefault(string, _Shaft(pipe.section_stiffness[3] or shear * polar,
                                                pipe.section_inertia[0] or pipe.density * polar))
        shaft.length += arguments[0] * pipe.length
    return list(found.values())


def slowest_period(scene: Scene) -> float:
    """[s] 4 L/c of the slowest string, fixed at the rig and free at the bit, c = sqrt(G J/(rho J)) the speed of
    torsional waves."""
    return max((4.0 * one.length * math.sqrt(one.inertia / one.stiffness) for one in _shafts(scene)), default=0.0)


def wave_torque(scene: Scene, speed: float) -> float:
    """[N m] Of a torsional wave whose speed [rad/s] this is, sqrt(G J rho J) speed, in the weakest string."""
    return speed * min((math.sqrt(one.stiffness * one.inertia) for one in _shafts(scene)), default=0.0)


def _run_all(courses: list[Course]) -> Iterator[Result]:
    """In the order of the courses."""
    context = multiprocessing.get_context("fork" if "fork" in multiprocessing.get_all_start_methods() else None)
    pool = concurrent.futures.ProcessPoolExecutor(PROCESSES, mp_context=context)
    try:
        yield from pool.map(run, courses)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


# ---- Results ---------------------------------------------------------------------------------------------------------
def _linear(found: Found, speed: float) -> str:
    if found.silent is not None:
        return "not assessed"
    if any(band.low <= speed <= band.high for band in found.bands):
        return "avoid"
    return "free" if found.whole else "not assessed"


def _line(one: Result, linear: str, out: CommandOutput) -> str:
    head = f"  {one.speed / RPM:5.0f} rpm: linear {linear}; in time "
    if one.error:
        return f"{head}{FAILED}: {one.error}"
    units = out.units
    return (f"{head}{one.verdict}: torque {units.text(one.torque, 'N m')} +- {100.0 * one.swing:.0f} %, lateral "
            "acceleration "
            f"{units.text(one.acceleration, 'm/s2', '.3g')}")


def _report(results: list[Result], found: Found, out: CommandOutput, elapsed: float) -> None:
    rows = [(one.speed / RPM, _linear(found, one.speed), one.verdict, one.torque, one.swing, one.acceleration)
            for one in results]
    marked = [one for one in results if one.verdict not in (STEADY, FAILED)]
    failed = [one for one in results if one.error]
    free = [one for one in marked if _linear(found, one.speed) == "free"]
    if marked:
        speeds = ", ".join(f"{one.speed / RPM:.0f}" for one in marked)
        out.say(f"avoid in time: {speeds} rpm"
                + (f"; of these the linear analysis leaves {', '.join(f'{one.speed / RPM:.0f}' for one in free)} rpm "
                   "free"
                    if free else ""))
    elif not failed:
        out.say(f"in time none of the {len(results)} speeds oscillates; speeds between them were not run")
    if any(not one.error for one in results) and not any(one.acceleration for one in results if not one.error):
        out.note_text(f"check in time: {LATERAL} is not assessed, because no place of the string moves across its "
                      "axis: axial-torsional pipes do not, and "
                      "others only where something excites them")
    if failed:
        out.note_text(f"check in time: {len(failed)} of {len(results)} runs failed and are not assessed: " +
                         "; ".join(f"{one.speed / RPM:.0f} rpm: {one.error}" for one in failed))
    out.summary["speeds_check"] = {"limits": {"torque_oscillation": SWING, "acceleration_m_s2": GRAVITY},
                                   "elapsed_s": elapsed, "speeds": [
        {"speed_rpm": speed, "linear": linear, "time": verdict, "torque_N_m": torque, "torque_oscillation": swing,
         "acceleration_m_s2": acceleration}
        for speed, linear, verdict, torque, swing, acceleration in rows]}
    out.table("speeds_check.csv", ["speed [rpm]", "linear", "in time", "torque at the rig [N m]",
                                   "torque oscillation [-]",
                                      "lateral acceleration [m/s2]"], rows)
    out.picture("speeds_check.png", lambda plots: plots.speeds_in_time(rows, found.bands, (SWING, GRAVITY),
                                                                       out.scene.title, out.units))
