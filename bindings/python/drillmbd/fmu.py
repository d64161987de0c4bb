"""Co-simulation units (FMI 2.0 and 3.0) of scenes, for the programs that import such units.

    from drillmbd import fmu, scene
    fmu.export(scene.load("rig.toml"), "rig.fmu")

[[input]] of the scene become inputs (set points, factors of loads, bit load) and tunable parameters (gains, limits,
friction, mud, damping), [[output]] outputs, [[event]] the number of occurrences of each. The run begins as that of
the command: at rest in the static state by the parameters where [run] static says so; inputs act from then on. [run]
step is the length of steps within a communication step; without it, and in scenes with events, the library chooses
them. The unit holds the library itself and runs without Python."""
from __future__ import annotations

import ctypes
import hashlib
import math
import io
import os
import pathlib
import platform
import re
import struct
import sys
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

from . import _library, enums
from ._structs import CompileOptions, Place, SimOptions, StaticOptions
from .errors import Error
from .outputs import output_unit
from .scene import Scene
from .scene.fields import drive_unit

BINARY = "drillmbd_fmu"
INPUTS, OUTPUTS, EVENTS = 100000, 200000, 300000  # value references, as bindings/fmi/unit.h says
CONTROLLED = (enums.TARGET_SET_POINT, enums.TARGET_LOAD_FACTOR, enums.TARGET_BIT_LOAD)  # the others are parameters

# Outputs of poses and speeds: an input changes forces and accelerations at once, but these by the coming step only.
OF_THE_STATE = frozenset((
    enums.OUTPUT_POSITION_X, enums.OUTPUT_POSITION_Y, enums.OUTPUT_POSITION_Z, enums.OUTPUT_VELOCITY_X,
    enums.OUTPUT_VELOCITY_Y, enums.OUTPUT_VELOCITY_Z, enums.OUTPUT_SPIN, enums.OUTPUT_ROTATION,
    enums.OUTPUT_KINETIC_ENERGY, enums.OUTPUT_BIT_SPEED, enums.OUTPUT_BIT_DEPTH, enums.OUTPUT_ROTARY_SPEED,
    enums.OUTPUT_FEED_SPEED, enums.OUTPUT_STRETCH, enums.OUTPUT_WIND_UP, enums.OUTPUT_BIT_ADVANCE,
    enums.OUTPUT_CONTACT_GAP, enums.OUTPUT_CONTACTS_DEEPEST, enums.OUTPUT_ENERGY_KINETIC,
    enums.OUTPUT_SPRING_LENGTH, enums.OUTPUT_SPRING_ELONGATION, enums.OUTPUT_SPRING_SPEED,
    *range(enums.OUTPUT_MOMENTUM_X, enums.OUTPUT_CENTRE_Z + 1),
    *range(enums.OUTPUT_JOINT_POSITION, enums.OUTPUT_JOINT_POSITION + 6),
    *range(enums.OUTPUT_JOINT_SPEED, enums.OUTPUT_JOINT_SPEED + 6),
    *range(enums.OUTPUT_WORLD_VELOCITY, enums.OUTPUT_WORLD_VELOCITY + 6),
    *range(enums.OUTPUT_BODY_VELOCITY, enums.OUTPUT_BODY_VELOCITY + 6)))


class CannotExport(ValueError):
    """A scene that cannot become a unit, or a unit without its binary: cause and remedy."""


# ---- The scene as bytes: bindings/fmi/scene_format.h -----------------------------------------------------------------
MAGIC, FORMAT, HEADER, TOKEN, HAS_STATIC = b"DMBSCENE", 3, 32, 48, 1


def _is_pointer(kind: Any) -> bool:
    return isinstance(kind, type) and (issubclass(kind, (ctypes._Pointer, ctypes.c_void_p)) or hasattr(kind, "_flags_"))


def _options(name: str, options: Any) -> bytes:
    """All fields that are numbers, in the order of their struct."""
    numbers = []
    for field, kind in type(options)._fields_:
        if _is_pointer(kind):
            if getattr(options, field):
                raise CannotExport(f"unit refused: {name}, {field} points to data that a unit cannot contain; leave it "
                                   "out")
        elif field not in ("struct_size", "reserved"):
            numbers.append(float(getattr(options, field)))
    return struct.pack(f"<I{len(numbers)}d", len(numbers), *numbers)


def _settings(scene: Scene) -> bytes:
    """Options of compile, sim and static state, the length of steps, and the outputs."""
    compiled: dict[str, Any] = next((arguments[0] for name, arguments in scene.model.calls if name == "compile"), {})
    found = [_options("compile", CompileOptions(**compiled)), _options("sim", SimOptions(**scene.sim)),
             _options("static", StaticOptions(**scene.fields_of("static"))),
             struct.pack("<dI", _step(scene), len(scene.outputs))]
    for _, place, quantity in scene.outputs:
        at = Place() if place is None else place
        found.append(struct.pack("<IIdi", at.part.index, at.pipe, at.fraction, quantity))
    return b"".join(found)


def _step(scene: Scene) -> float:
    """[s] of steps within a communication step; 0: chosen by the library."""
    return 0.0 if scene.model.events() else float(scene.run.get("step", 0.0))


def scene_bytes(scene: Scene) -> tuple[bytes, str]:
    """The file resources/scene.bin and the token of the unit, which is computed from its content."""
    try:
        record = scene.model.record()
    except Error as error:
        raise CannotExport(f"unit refused: {error}") from error
    flags = HAS_STATIC if scene.run.get("static", 0) else 0
    body = struct.pack("<I", len(record)) + record + _settings(scene)
    digest = hashlib.sha256(struct.pack("<I", flags) + body).hexdigest()
    token = "{" + "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32])) + "}"
    named = token.encode().ljust(TOKEN, b"\0") + body
    return struct.pack("<8sIIQII", MAGIC, FORMAT, flags, HEADER + len(named), zlib.crc32(named), 0) + named, token


# ---- Variables -------------------------------------------------------------------------------------------------------
@dataclass
class Variable:
    """A variable of the unit."""
    name: str
    reference: int       #: value reference
    causality: str       #: independent, parameter, input, output
    variability: str     #: continuous, fixed, tunable, discrete
    unit: str = ""       #: as "rad/s"
    start: float | None = None
    low: float | None = None
    high: float | None = None
    about: str = ""
    integer: bool = False
    of_state: bool = False  #: an output that no input changes at a communication point


def _described(scene: Scene) -> dict[int, tuple[str, tuple[Any, ...]]]:
    """The calls that describe parts, by the index of the part's id."""
    ids = iter(scene.model.ids)
    return {next(ids).index: (name, arguments) for name, arguments in scene.model.calls
            if name.startswith("add_") and name != "add_hole_sections"}


def _drives(scene: Scene) -> dict[int, dict[str, Any]]:
    """The drives as they were described, by the index of their ids."""
    return {index: arguments[0] for index, (name, arguments) in _described(scene).items() if name == "add_drive"}


def _refuse_changing(scene: Scene) -> None:
    """Refuses an input that replaces a time function that changes. In a unit, an input that the importer does not set
    keeps its start value (FMI 3.0, 2.4.7); the unit would follow the time function instead, and the two importers'
    results would differ silently."""
    parts = _described(scene)
    for name, arguments in parts.values():
        given = arguments[0] if name == "add_input" else {}
        target = given.get("target", enums.TARGET_SET_POINT)
        if name != "add_input" or target not in CONTROLLED or not math.isnan(given.get("initial", math.nan)):
            continue
        part = parts[given["part"].index]
        function = part[1][0].get("load" if part[0] == "add_bit" else "time_function")
        segments = parts[function.index][1] if function else ()
        if any(one.get("kind", enums.SEGMENT_CONSTANT) != enums.SEGMENT_CONSTANT or one.get("table")
               or one.get("function") for one in segments):
            raise CannotExport(f"unit refused: input {given['name']} replaces a time function that changes, but an "
                               "input of a unit has its start "
                               "value until it is set; give the [[input]] an initial value, or its part a constant "
                               "time function")


def _output_unit(quantity: int, place: Place | None, drives: dict[int, dict[str, Any]]) -> str:
    """The unit of an output; that of a drive depends on its component. Empty where it is not one unit."""
    unit = output_unit(quantity)
    drive = drives.get(place.part.index) if place is not None else None
    if " or " in unit and drive is not None:
        return unit.split(" or ")[1 if drive.get("component", 0) >= enums.RX else 0]
    if unit.startswith("unit of"):
        return drive_unit(drive.get("kind", 0), drive.get("component", 0)) if drive is not None else ""
    return "" if " or " in unit else unit


def _bound(value: float) -> float | None:
    return None if abs(value) >= 1e30 else value


def _inputs(scene: Scene, sim: Any) -> Iterator[Variable]:
    for number, (name, info) in enumerate(scene.model.inputs().items()):
        given = info.target in CONTROLLED
        unit = info.unit.decode()
        jumps = f"; goes there by at most {info.rate_limit:g} {unit} a second" if info.rate_limit else ""
        about = f"{_target_name(info.target)}{jumps}"
        yield Variable(name, INPUTS + number, "input" if given else "parameter",
                       "continuous" if given else "tunable", unit, sim.inputs[name],
                       _bound(info.low), _bound(info.high), about)


def _target_name(target: int) -> str:
    names = {value: name for name, value in vars(enums).items()
             if name.startswith("TARGET_") and isinstance(value, int)}
    return names.get(target, "TARGET_").replace("TARGET_", "").lower().replace("_", " ")


def variables(scene: Scene) -> list[Variable]:
    """The variables of the unit, in the order of its description."""
    drives = _drives(scene)
    _refuse_changing(scene)
    found = [Variable("time", 0, "independent", "continuous", "s"),
             Variable("step", 1, "parameter", "fixed", "s", _step(scene), 0.0, None,
                      "length of steps within a communication step; 0: chosen by the library to its tolerances")]
    with scene.new_sim() as sim:
        found += _inputs(scene, sim)
        for number, (name, place, quantity) in enumerate(scene.outputs):
            sim.output(quantity, place)  # raises where it does not exist
            found.append(Variable(re.sub(r"\s*\[[^\]]*\]\s*$", "", name), OUTPUTS + number, "output", "continuous",
                                  _output_unit(quantity, place, drives), about=_output_about(quantity),
                                  of_state=quantity in OF_THE_STATE))
    for number, name in enumerate(scene.model.events()):
        found.append(Variable(f"{name}, times", EVENTS + number, "output", "discrete",
                              about="number of occurrences of this event", integer=True, of_state=True))
    _check_names(found)
    return found


def _output_about(quantity: int) -> str:
    from .outputs import output_name
    return f"output {output_name(quantity)}"


def _check_names(found: list[Variable]) -> None:
    seen: set[str] = set()
    for one in found:
        if not one.name or one.name in seen or re.search(r"[\x00-\x1f]", one.name):
            raise CannotExport(f"unit refused: the name {one.name!r} of a variable, must be of its own, not empty, "
                               "without control characters; rename the [[output]], [[input]] or [[event]]")
        seen.add(one.name)


# ---- Units -----------------------------------------------------------------------------------------------------------
_BASE: dict[str, dict[str, int]] = {
    "m": {"m": 1}, "s": {"s": 1}, "kg": {"kg": 1}, "rad": {"rad": 1}, "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3},
    "Pa": {"kg": 1, "m": -1, "s": -2}, "1": {}, "-": {}}


def base_exponents(unit: str) -> dict[str, int]:
    """Exponents of kg, m, s, rad of a unit as "kg m2/s": factors after / divide."""
    found: dict[str, int] = {}
    for sign, part in zip((1, -1), unit.split("/")):
        for word in part.split():
            match = re.fullmatch(r"([A-Za-z1-]+?)(\d?)", word)
            if match is None or match[1] not in _BASE:
                raise CannotExport(f"unit refused: unit {unit!r} of a variable is not known to the exporter; "
                                   "leave the variable out")
            for name, power in _BASE[match[1]].items():
                found[name] = found.get(name, 0) + sign * power * int(match[2] or 1)
    return {name: power for name, power in found.items() if power}


# ---- modelDescription.xml --------------------------------------------------------------------------------------------
Attributes = dict[str, str]


def _number(value: float) -> str:
    return repr(float(value))


def _variable_attributes(one: Variable) -> Attributes:
    found = {"unit": one.unit} if one.unit and one.unit != "-" else {}
    found.update({key: _number(value) for key, value in (("min", one.low), ("max", one.high), ("start", one.start))
                  if value is not None})
    return found


def _common_attributes(one: Variable) -> Attributes:
    found = {"name": one.name, "valueReference": str(one.reference), "causality": one.causality,
             "variability": one.variability}
    if one.about:
        found["description"] = one.about
    if one.causality == "parameter":
        found["initial"] = "exact"
    if one.causality == "output":
        found["initial"] = "calculated"
    return found


def _variables3(parent: Any, found: list[Variable]) -> None:
    for one in found:
        ElementTree.SubElement(parent, "Int32" if one.integer else "Float64",
                               {**_common_attributes(one), **_variable_attributes(one)})


def _variables2(parent: Any, found: list[Variable]) -> None:
    for one in found:
        variable = ElementTree.SubElement(parent, "ScalarVariable", _common_attributes(one))
        ElementTree.SubElement(variable, "Integer" if one.integer else "Real", _variable_attributes(one))


def _known(one: Variable, at_start: bool) -> Attributes:
    """Dependencies of an output: without the attribute it depends on all known variables. At the start all goes into
    the state, but counts of events are 0."""
    return {"dependencies": ""} if (one.integer if at_start else one.of_state) else {}


def _structure3(parent: Any, found: list[Variable]) -> None:
    for tag in ("Output", "InitialUnknown"):
        for one in found:
            if one.causality == "output":
                ElementTree.SubElement(parent, tag, {"valueReference": str(one.reference),
                                                     **_known(one, tag == "InitialUnknown")})


def _structure2(parent: Any, found: list[Variable]) -> None:
    for tag in ("Outputs", "InitialUnknowns"):
        group = ElementTree.SubElement(parent, tag)
        for number, one in enumerate(found, 1):
            if one.causality == "output":
                ElementTree.SubElement(group, "Unknown", {"index": str(number),
                                                          **_known(one, tag == "InitialUnknowns")})


def _abilities(version: int, identifier: str, scene: Scene) -> Attributes:
    """Attributes of CoSimulation: capabilities of the unit."""
    found = {"modelIdentifier": identifier, "canHandleVariableCommunicationStepSize": "true"}
    if version == 2:
        return {**found, "canInterpolateInputs": "false", "canGetAndSetFMUstate": "true",
                "canSerializeFMUstate": "true", "providesDirectionalDerivative": "true",
                "canNotUseMemoryManagementFunctions": "true"}
    has_events = "true" if scene.model.events() else "false"
    return {**found, "canGetAndSetFMUState": "true", "canSerializeFMUState": "true",
            "providesDirectionalDerivatives": "true", "hasEventMode": has_events,
            "mightReturnEarlyFromDoStep": has_events}


def description(scene: Scene, version: int, identifier: str, token: str, found: list[Variable],
                source_files: list[str] | None = None) -> bytes:
    """The file modelDescription.xml."""
    root = ElementTree.Element("fmiModelDescription", {
        "fmiVersion": "3.0" if version == 3 else "2.0", "modelName": scene.title or identifier,
        "instantiationToken" if version == 3 else "guid": token, "generationTool": f"libdrillmbd {enums.__version__}",
        "variableNamingConvention": "flat"})
    unit = ElementTree.SubElement(root, "CoSimulation", _abilities(version, identifier, scene))
    if version == 2 and source_files:
        files = ElementTree.SubElement(unit, "SourceFiles")
        for name in source_files:
            ElementTree.SubElement(files, "File", {"name": name})
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name in sorted({one.unit for one in found if one.unit and one.unit != "-"}):
        entry = ElementTree.SubElement(definitions, "Unit", {"name": name})
        ElementTree.SubElement(entry, "BaseUnit", {key: str(power) for key, power in base_exponents(name).items()})
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in (("logStatusWarning", "notes and warnings of the library"),
                       ("logStatusError", "refused and failed calls")):
        ElementTree.SubElement(categories, "Category", {"name": name, "description": text})
    run = {"stopTime": scene.run.get("end"), "stepSize": scene.run.get("step")}
    ElementTree.SubElement(root, "DefaultExperiment",
                           {"startTime": "0.0", **{k: _number(v) for k, v in run.items() if v}})
    (_variables3 if version == 3 else _variables2)(ElementTree.SubElement(root, "ModelVariables"), found)
    (_structure3 if version == 3 else _structure2)(ElementTree.SubElement(root, "ModelStructure"), found)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


# ---- Source code -----------------------------------------------------------------------------------------------------
OPTIONS = "-ffp-contract=off -fno-math-errno"


def find_sources(folder: Any = None) -> pathlib.Path:
    """The folder of libdrillmbd's sources: the given one, or that which this package stands in."""
    tried = pathlib.Path(folder) if folder is not None else pathlib.Path(__file__).resolve().parents[3]
    if all((tried / name).is_dir() for name in ("lib", "include/drillmbd", "bindings/fmi")):
        return tried
    raise CannotExport(f"unit refused: {tried} does not hold the sources of libdrillmbd (lib, include, bindings/fmi); "
                       "name their folder, or leave the sources out")


def source_files(folder: pathlib.Path) -> dict[str, bytes]:
    """Sources and headers by their names below sources/."""
    found = {}
    for below, target, pattern in (("lib", "", "**/*.[ch]"), ("include", "", "drillmbd/*.h"),
                                   ("bindings/fmi", "fmi/", "*.[ch]")):
        for path in sorted((folder / below).glob(pattern)):
            if path.name != "scene_write.c":  # writes scenes
                found[target + path.relative_to(folder / below).as_posix()] = path.read_bytes()
    return found


def build_description(identifier: str, names: list[str]) -> bytes:
    """The file sources/buildDescription.xml of FMI 3.0."""
    root = ElementTree.Element("fmiBuildDescription", {"fmiVersion": "3.0"})
    build = ElementTree.SubElement(root, "BuildConfiguration", {"modelIdentifier": identifier})
    files = ElementTree.SubElement(build, "SourceFileSet", {"language": "C11", "compilerOptions": OPTIONS})
    for name in names:
        ElementTree.SubElement(files, "SourceFile", {"name": name})
    ElementTree.SubElement(files, "PreprocessorDefinition", {"name": "DMB_STATIC"})
    ElementTree.SubElement(files, "IncludeDirectory", {"name": "."})
    for name in ("lapacke", "m"):
        ElementTree.SubElement(build, "Library", {"name": name, "external": "true"})
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


# ---- The archive -----------------------------------------------------------------------------------------------------
def platform_folder(version: int) -> str:
    """Where the binary for this machine stands in a unit, as "x86_64-linux" or "linux64"."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    system = {"linux": "linux", "darwin": "darwin", "win32": "windows"}.get(sys.platform, sys.platform)
    if version == 3 or machine != "x86_64":
        return f"{machine}-{system}"
    return {"linux": "linux64", "darwin": "darwin64", "windows": "win64"}.get(system, f"{machine}-{system}")


def find_binary() -> pathlib.Path:
    """The file that becomes the unit's binary: the one named by the environment variable DRILLMBD_FMU, or
    drillmbd_fmu.so beside the library or this package, or in the folder drillmbd beside the library."""
    own = os.environ.get("DRILLMBD_FMU")
    folders = [pathlib.Path(_library.find()).parent, _library.HERE,
               *map(pathlib.Path, (sys.prefix + "/lib", "/usr/local/lib"))]
    folders += [one / f"{platform.machine()}-linux-gnu" for one in folders[2:]]
    tried = [one / f"{BINARY}{end}" for folder in folders for one in (folder, folder / "drillmbd")
             for end in (".so", ".dylib", ".dll")]
    if own:
        tried = [pathlib.Path(own)]
    for path in tried:
        if path.is_file():
            return path
    raise CannotExport(f"unit refused: its binary {tried[0]} is not there; build or install libdrillmbd with "
                       "DMB_BUILD_FMU=ON, or set DRILLMBD_FMU to the file")


def _identifier(scene: Scene, path: pathlib.Path) -> str:
    """The unit's name as an identifier of C."""
    found = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    return found if re.match(r"[A-Za-z_]", found) else f"unit_{found}"


def export(scene: Scene, path: Any, version: int = 3, sources: Any = False) -> list[str]:
    """Writes the unit; returns notes. sources: True, or the folder of libdrillmbd's sources: they go into the unit
    too, to be compiled elsewhere (FMI 3.0: sources/buildDescription.xml says how). Raises CannotExport where the scene
    or this installation cannot give a unit, OSError where the file cannot be written."""
    if version not in (2, 3):
        raise CannotExport(f"unit refused: version {version} of FMI, must be 2 or 3")
    if not scene.outputs:
        raise CannotExport("unit refused: the scene has no outputs; "
                           "add a [[output]] for each number that is to be read")
    path = pathlib.Path(path)
    identifier = _identifier(scene, path)
    content, token = scene_bytes(scene)
    found = variables(scene)
    code = source_files(find_sources(None if sources is True else sources)) if sources else {}
    compiled = [name for name in code if name.endswith(".c")]
    files = {"modelDescription.xml": description(scene, version, identifier, token, found, compiled),
             "resources/scene.bin": content}
    files.update({f"sources/{name}": data for name, data in code.items()})
    if code and version == 3:
        files["sources/buildDescription.xml"] = build_description(identifier, compiled)
    binary = find_binary()
    files[f"binaries/{platform_folder(version)}/{identifier}{binary.suffix}"] = binary.read_bytes()
    _write(path, files)
    return _notes(scene)


def _notes(scene: Scene) -> list[str]:
    notes = []
    if not scene.model.inputs():
        notes.append("the scene has no [[input]]: the unit can be read but not steered")
    if scene.model.events() and scene.run.get("step"):
        notes.append("the scene has events, which are found by steps of the library's choice: "
                     "[run] step is ignored")
    return notes


def _write(path: pathlib.Path, files: dict[str, bytes]) -> None:
    """The archive, whole or not at all; the same bytes for the same scene."""
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    if path.exists() and not path.is_file():  # a device would be replaced
        raise CannotExport(f"unit refused: {path} is a folder or a device, must be a file")
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(memory.getvalue())
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
