"""A scene as the live page takes it: the calls that describe its model with the fields of their structs by name, the
inputs that a reader moves, and the outputs that are drawn with their limits."""
from __future__ import annotations

import hashlib
import json
import math
from ctypes import Array
from typing import Any

from . import enums
from ._record import Record, _is_pointer
from ._structs import DriveDef, Id, Place, SimOptions, StaticOptions
from .errors import Usage
from .language import phrase
from .live_strings import strings_of
from .model import _DEFINITIONS, Model, remake
from .scene import Scene
from .scene.largest import bounded
from .scene.segments import by_numbers

Call = tuple[str, tuple[Any, ...]]
#: Calls of a description that a record holds; others are functions of Python.
CALLS = {"add_wall", "add_string", "add_body", "add_bit", "add_stabiliser", "add_joint", "add_coupling", "add_drive",
         "add_load", "add_spring", "add_stuck",
         "add_input", "add_event", "add_pipes", "add_time_function", "add_hole_sections", "set_environment", "set_name",
         "compile"}
#: Arrays that their structs point to: field, the field with its length, numbers in a row.
ARRAYS = {"add_time_function": (("table_time", "table_count", 1), ("table_value", "table_count", 1)),
          "add_wall": (("survey", "survey_count", 3),),
          "add_spring": (("table_elongation", "table_count", 1), ("table_force", "table_count", 1))}
RPM = 30.0 / math.pi
#: Factor and unit that the page shows, by the unit in SI.
SHOWN = {"rad/s": (RPM, "rpm"), "m/s": (1e3, "mm/s"), "N": (1e-3, "kN"), "N m": (1e-3, "kN m"), "m3/s": (6e4, "l/min"),
         "-": (1.0, ""),
         "kg/m3": (1.0, "kg/m³")}
#: [unit of the set point/s] of prescribed motions: how fast a slider's value is reached. A rig turns up in seconds, not
#: at once.
RATE = {enums.X: 0.05, enums.RX: 10.0}
USUAL = {enums.X: 0.05, enums.RX: 25.0, "bit load": 20e3}  #: upper bound where the scene describes nothing else than 0


# ---- Inputs ----------------------------------------------------------------------------------------------------------
class Described:
    """The parts of a model by their ids."""

    def __init__(self, model: Model) -> None:
        ids = iter(model.ids)
        self.parts: dict[int, Call] = {}
        for name, arguments in model.calls:
            if name.startswith("add_") and name != "add_hole_sections":
                self.parts.setdefault(next(ids).index, (name, arguments))  # pipes give the id of their string again

    def drives(self) -> list[tuple[int, DriveDef]]:
        """Index of the id, and definition."""
        return [(index, DriveDef(**arguments[0])) for index, (call, arguments) in self.parts.items()
                if call == "add_drive"]

    def range_of(self, time_function: Id) -> tuple[float, float]:
        """Least and largest sum of the values that the segments of a time function name."""
        low = high = 0.0
        known = [segments for call, segments in self.parts.values() if call == "add_time_function"]
        for one in bounded(self.parts[time_function.index][1], known) if time_function else ():
            kind, h0, h1 = one.get("kind", 0), one.get("h0", 0.0), one.get("h1", 0.0)
            values = [value for _, value in one.get("table", ())] or (
                [h0] if kind == enums.SEGMENT_CONSTANT else [h0 - abs(h1), h0 + abs(h1)]
                if kind == enums.SEGMENT_HARMONIC else [h0, h1])
            if by_numbers(one):
                low, high = low + min(values), high + max(values)
        return low, high


def _bounds(low: float, high: float, usual: float) -> tuple[float, float]:
    """Twice as far as the scene goes, from 0."""
    found = min(0.0, 2.0 * low), max(0.0, 2.0 * high)
    return found if found[1] > found[0] else (0.0, usual)


def with_inputs(scene: Scene) -> list[Call]:
    """The calls of the model, with an input for each set point of a drive along or about the hole, load of a bit, stuck
    place, and the friction of the wall, where the scene has none."""
    parts = Described(scene.model)
    taken = {(info.target, info.part.index) for info in scene.model.inputs().values()}
    names = set(scene.model.inputs())
    more: list[Call] = []

    def add(name: str, **fields: Any) -> None:
        wanted, number = name, 2
        while name in names:
            name, number = f"{wanted} {number}", number + 1
        names.add(name)
        more.append(("add_input", ({"name": name, **fields},)))

    for index, (call, arguments) in parts.parts.items():
        part = Id(index, scene.model.ids[0].generation)
        if call == "add_drive":
            drive = DriveDef(**arguments[0])
            if drive.component in RATE and (enums.TARGET_SET_POINT, index) not in taken:
                _drive_input(add, parts, drive, part)
        elif call == "add_bit" and arguments[0].get("load") and (enums.TARGET_BIT_LOAD, index) not in taken:
            low, high = _bounds(*parts.range_of(arguments[0]["load"]), USUAL["bit load"])
            add("bit load", target=enums.TARGET_BIT_LOAD, part=part, low=low, high=high)
        elif call == "add_stuck" and (enums.TARGET_STUCK, index) not in taken:
            add("stuck", target=enums.TARGET_STUCK, part=part, low=0.0, high=1.0)
    if (any(call == "add_wall" for call, _ in parts.parts.values()) and not any(target == enums.TARGET_FRICTION
                                                                                for target, _ in taken)):
        add("friction", target=enums.TARGET_FRICTION, low=0.0, high=3.0)
    calls = list(scene.model.calls)
    at = next(number for number, (name, _) in enumerate(calls) if name == "compile")
    return calls[:at] + more + calls[at:]


def _drive_input(add: Any, parts: Described, drive: Any, part: Id) -> None:
    word = "rotation" if drive.component == enums.RX else "feed"
    if drive.kind == enums.DRIVE_LOAD:
        usual = 3e3 if drive.component == enums.RX else 40e3
        low, high = _bounds(*parts.range_of(drive.time_function), usual)
        add("torque" if drive.component == enums.RX else "thrust", part=part, low=low, high=high)
        return
    low, high = _bounds(*parts.range_of(drive.time_function), USUAL[drive.component])
    if drive.component == enums.X and low < 0.0:  # a rig that pulls can push, too
        high = max(high, -low)
    rate = {"rate_limit": RATE[drive.component]} if drive.kind == enums.DRIVE_MOTION else {}
    add(word, part=part, low=low, high=high, **rate)


TARGETS: dict[int, tuple[float, float]] = {enums.TARGET_FRICTION: (0.0, 3.0), enums.TARGET_FLUID_DENSITY: (0.0, 2000.0),
                                           enums.TARGET_STUCK: (0.0, 1.0),
           enums.TARGET_LOAD_FACTOR: (0.0, 2.0), enums.TARGET_BIT_LOAD: (0.0, 20e3),
                                           enums.TARGET_FLOW_RATE: (0.0, 0.02)}


TITLES = {"rotation": phrase("Rotation"), "feed": phrase("Feed"), "torque": phrase("Torque"),
          "thrust": phrase("Thrust"), "bit load": phrase("Bit load"),
          "friction": phrase("Friction of the wall"), "stuck": phrase("Stuck (1), free (0)")}


def title_of(name: str) -> str:
    """Of a slider, by the name of its input; of those that have a number because there are several, with it."""
    word, _, number = name.rpartition(" ")
    if number.isdecimal() and word in TITLES:
        return phrase("{title} no. {number}", title=TITLES[word], number=number)
    return TITLES.get(name, name[:1].upper() + name[1:])


def _controls(model: Model) -> list[dict[str, Any]]:
    """A slider for each input."""
    found = []
    for name, info in model.inputs().items():
        unit = info.unit.decode()
        factor, word = SHOWN.get(unit, (1.0, unit))
        low, high = TARGETS.get(info.target, (-100.0, 100.0))
        low, high = (low if info.low <= -1e29 else info.low), (high if info.high >= 1e29 else info.high)
        if info.target in (enums.TARGET_FRICTION, enums.TARGET_LOAD_FACTOR):
            word = phrase("times")
        found.append({"name": name, "title": title_of(name), "unit": word, "factor": factor, "low": low * factor,
                      "high": high * factor,
                      "whole": info.target == enums.TARGET_STUCK})
    return found


# ---- Traces ----------------------------------------------------------------------------------------------------------
def _limit(value: float, text: str) -> dict[str, Any]:
    return {"value": value / 1e3, "text": text}


def _traces(scene: Scene, parts: Described, generation: int) -> list[dict[str, Any]]:
    """Torque, thrust, speed of the bit, contact: in the units of the rig, with the limits of [limits]."""
    drives: dict[int, Id] = {}  # of rig ends and bodies, the first of each component
    for index, drive in parts.drives():
        if parts.parts.get(drive.part.index, ("",))[0] != "add_joint":
            drives.setdefault(drive.component, Id(index, generation))
    string = next((Id(index, generation) for index, (call, _) in parts.parts.items()
                   if call in ("add_string", "add_pipes")), None)
    limits = scene.limits

    def line(quantity: int, part: Id | None = None) -> dict[str, Any]:
        return {"quantity": int(quantity), "place": plain(Place(part) if part else Place())}

    def rig(component: int, of_string: int) -> dict[str, Any] | None:
        if component in drives:
            return line(enums.OUTPUT_DRIVE_FORCE, drives[component])
        return line(of_string, string) if string else None
    torque, thrust = rig(enums.RX, enums.OUTPUT_RIG_TORQUE), rig(enums.X, enums.OUTPUT_RIG_FORCE)
    found = []
    if torque:
        found.append({"title": phrase("Torque at the rig"), "unit": "kN m", "factor": 1e-3, "least": 0.1,
                      "lines": [torque],
                      "limits": [_limit(sign * limits["torque"],
                                        phrase("limit {value:g} kN m", value=limits["torque"] / 1e3))
                                 for sign in (1.0, -1.0) if "torque" in limits]})
    if thrust:
        found.append({"title": phrase("Thrust at the rig"), "unit": "kN", "factor": 1e-3 if enums.X in drives
                      else -1e-3, "least": 1.0, "lines": [thrust], "limits": [
            *([_limit(limits["push"], phrase("push limit {value:g} kN", value=limits["push"] / 1e3))]
              if "push" in limits else []),
            *([_limit(-limits["pull"], phrase("pull limit {value:g} kN", value=limits["pull"] / 1e3))]
              if "pull" in limits else [])]})
    if string:
        found.append({"title": phrase("Bit speed (dashed: rig)"), "unit": "rpm", "factor": RPM, "least": 10.0,
                      "limits": [],
                      "lines": [line(enums.OUTPUT_BIT_SPEED, string), line(enums.OUTPUT_ROTARY_SPEED, string)]})
    if any(call == "add_wall" for call, _ in parts.parts.values()):
        found.append({"title": phrase("Contact, whole string"), "unit": "kN", "factor": 1e-3, "least": 1.0,
                      "limits": [], "lines": [line(enums.OUTPUT_CONTACTS_NORMAL_FORCE)]})
    return found


# ---- The record ------------------------------------------------------------------------------------------------------
def plain(value: Any, call: str = "") -> Any:
    """A struct as a dictionary of its fields, numbers that JSON lacks as texts."""
    if isinstance(value, float):
        return (value if math.isfinite(value) else "NaN" if math.isnan(value) else "Infinity" if value > 0
                else "-Infinity")
    if isinstance(value, bytes):
        return value.decode()
    if hasattr(value, "tolist"):  # a view of numpy
        return plain(value.tolist())
    if isinstance(value, (Array, list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, Id):  # stamps of models differ from run to run
        return {"index": value.index, "generation": int(bool(value))}
    if not isinstance(value, Record):
        return value
    found, arrays = {}, {name: (count, width) for name, count, width in ARRAYS.get(call, ())}
    for name, kind in value._fields_:
        if name == "struct_size" or name.rstrip("0123456789").endswith("reserved"):
            continue
        if name in arrays:
            length = getattr(value, arrays[name][0]) * arrays[name][1]
            if length:
                found[name] = [plain(one) for one in getattr(value, name)[:length]]
        elif not _is_pointer(kind):
            found[name] = plain(getattr(value, name))
    return found


def _recorded(calls: list[Call]) -> list[list[Any]]:
    """[call, structs, count] of each call."""
    found = []
    for name, given in calls:
        count, arguments = given[:1] if name == "add_pipes" else (), given[1:] if name == "add_pipes" else given
        if name not in CALLS:
            raise Usage(f"live page refused: the scene has a part made by {name}, a function of Python, which stays in "
                        "Python; leave the part out")
        if name == "set_name":
            found.append([name, [{"part": plain(arguments[0]), "name": arguments[1]}]])
            continue
        structs = []
        for one in arguments:
            made = one if isinstance(one, Record) else _DEFINITIONS[name](**one)
            structs.append(plain(made, name))
            function = one.get("function") if isinstance(one, dict) else None
            if function is not None:
                raise Usage("live page refused: a time function is a function of Python, which stays in Python; give "
                            "it as a table")
        found.append([name, structs, *count])
    return found


def model_of(scene: Scene, diameter: float | None = None) -> Model:
    """The model that the page makes: of the scene with inputs, and with another diameter of the hole [m]."""
    calls = with_inputs(scene)
    if diameter is not None:
        calls = [(name, tuple(_widened(name, one, diameter, _diameter(calls)) for one in arguments))
                 for name, arguments in calls]
    return remake(Model, calls)


def _widened(name: str, one: Any, to: float, before: float | None) -> Any:
    """The wall with this diameter; sections that have one of their own keep their ratio to it."""
    if name not in ("add_wall", "add_hole_sections") or not before:
        return one
    given = dict(one)
    if name == "add_wall":
        given["diameter"] = to
    elif given.get("diameter", -1.0) > 0.0:
        given["diameter"] *= to / before
    return given


def _diameter(calls: list[Call]) -> float | None:
    wall = next((arguments[0] for name, arguments in calls if name == "add_wall"), None)
    if wall is None:
        return None
    return float(_DEFINITIONS["add_wall"](**wall).diameter)


WIDTHS = {"add_pipes": ("outer_diameter", "joint_outer_diameter"), "add_bit": ("diameter",),
          "add_stabiliser": ("outer_diameter",),
          "add_body": ("contact_diameter",)}


def _widest(calls: list[Call]) -> float:
    """[m] of all that meets the wall."""
    return max((getattr(_DEFINITIONS[name](**arguments[-1]), key) for name, arguments in calls
                for key in WIDTHS.get(name, ())), default=0.0)


def record_of(scene: Scene, file: str) -> dict[str, Any]:
    """All that the page needs to run the scene."""
    calls = with_inputs(scene)
    model = remake(Model, calls)
    generation = scene.model.ids[0].generation if scene.model.ids else 0
    recorded, diameter, parts = _recorded(calls), _diameter(calls), Described(scene.model)
    if not any(scene.pipes.values()):
        raise Usage("live page refused: the scene has no string to draw; add [[string]] with [[string.pipes]]")
    first = next(index for index, (name, _) in parts.parts.items() if name in ("add_string", "add_pipes"))
    strings, with_bit = strings_of(scene, Id(first, generation))
    step = 0.0 if scene.model.events() else float(scene.run.get("step", 0.0))
    text = json.dumps(recorded, separators=(",", ":"), sort_keys=True)
    return {"title": scene.title or file, "file": file, "calls": recorded, "sim": plain(SimOptions(**scene.sim)),
            "static": plain(StaticOptions(**scene.fields_of("static"))) if scene.run.get("static", 0) else None,
            "step": step, "end": float(scene.run.get("end", 0.0)), "interval": max(step, 0.01), "diameter": diameter,
            "diameters": [max(0.7 * diameter, 1.002 * _widest(calls)), 1.6 * diameter] if diameter else None,
            "controls": _controls(model), "traces": _traces(scene, parts, generation),
            "strings": [{**one, "part": plain(Id(one["index"], generation))} for one in strings], "with_bit": with_bit,
            "checksum": hashlib.sha256(text.encode()).hexdigest()[:16]}
