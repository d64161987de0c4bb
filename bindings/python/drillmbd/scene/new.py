"""A commented scene from a few values, as `drillmbd new` writes it: a drainage hole or a well."""
from __future__ import annotations

import json
import math
import os
import pathlib
from typing import Any

from ..new_options import OPTIONS
from . import catalogue, survey, units
from .problems import Problems

_SCENE = """# {title}. Written by: drillmbd new {kind}
# Check it with: drillmbd check FILE. Keys with unit, default and meaning: drillmbd keys
title = "{title}"

[environment]
fluid_density = "{mud}"

[hole]
diameter = "{hole}"
{course}
mu_static = 0.35               # friction against the wall, an assumption: fit it to measured loads
mu_dynamic = 0.30

[[time_function]]
name = "feed"
segment = {{kind = "step5", x0 = "0 s", x1 = "2 s", h1 = "{feed}"}}

[[time_function]]
name = "rotation"
segment = {{kind = "step5", x0 = "0 s", x1 = "2 s", h1 = "{speed}"}}

[[time_function]]
name = "bit load"
segment = {{table = [["0 s", "0 N"], ["2 s", "0 N"], ["4 s", "{bit_load}"]]}}

[[string]]
name = "rods"

[[string.pipes]]
count = {count}
length = "{rod_length}"
{pipes}
eccentricity = "0.5 mm"        # an assumption: without it rotation excites no lateral vibration
angle_spread = "180 deg"
damping_time = "0.1 ms"        # material damping, an assumption
# Tool joints: joint_length, joint_outer_diameter, joint_inner_diameter

[[bit]]
name = "bit"
load = "bit load"
mass = "10 kg"
diameter = "{hole}"

[[drive]]
name = "feed drive"
component = "x"
time_function = "feed"

[[drive]]
name = "rotation drive"
component = "rx"
time_function = "rotation"

{limits}

[run]
end = "8 s"
step = "2 ms"
static = true

[results]
interval = "20 ms"

[[output]]                     # columns of run.csv; names of quantities: drillmbd schema, or include/drillmbd/ask.h
name = "torque at the rig [N m]"
quantity = "drive-force"
place = "rotation drive"

[[output]]
name = "thrust at the rig [N]"
quantity = "drive-force"
place = "feed drive"

# Speeds to avoid: eccentric pipes excite the string once a revolution; the amplitude in the middle of the string may be {clearance}.
[speeds]
[[speeds.order]]
[[speeds.output]]
name = "middle of the string"
quantity = "vibration-z"
place = {{part = "rods", pipe = {middle}, fraction = 0.5}}
limit = "{clearance}"
"""  # noqa: E501

#: Scatter and limits to begin with. Friction in water-based mud is 0.25 .. 0.40 (Johancsik, Friesen and Dawson 1984,
#: doi:10.2118/11380-PA).
_VARIABILITY = """[variability]
question = "torque-drag"       # or "static", "run", "auto": see drillmbd probability --help
samples = 10000
seed = 1

[[variability.scatter]]
name = "friction of the wall"
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true                # factors of the values above
distribution = "lognormal"
mean = 1
deviation = "12 %"             # 0.25 to 0.40 about 0.33 are two deviations to either side: typical of water-based mud (Johancsik et al. 1984)

[[variability.scatter]]
name = "diameter of the hole"
key = "hole.diameter"
relative = true
distribution = "triangular"    # an assumption: coal breaks out; replace it by a calliper log
low = 1
mode = 1.02
high = 1.15

[[variability.process]]
name = "load of the rock"
time_function = "bit load"
distribution = "gamma"
mean = 1
deviation = "20 %"             # an assumption: replace it by records of the feed pressure
correlation_time = "0.5 s"

[[failure]]
kind = "rig-torque"
limit = "4 kN m"               # of your rig; left out: [limits] torque

[[failure]]
kind = "rig-push"
limit = "100 kN"               # of your rig; left out: [limits] push

[[failure]]
kind = "rig-pull"
limit = "100 kN"               # of your rig; left out: [limits] pull

[[failure]]
kind = "stress"
strength = "550 MPa"           # of your pipes; left out: [limits] yield_stress

[[failure]]
kind = "helical-buckling"      # limit 1: the load at which the string becomes a helix
"""  # noqa: E501
_COMMENTED = (
    "\n# How often does it fail? Take the # before the lines below away, put in your own values, and run: "
    "drillmbd probability FILE\n"
    + "".join(f"# {line}".rstrip() + "\n" for line in _VARIABILITY.splitlines()))

_STRAIGHT = """# A surveyed hole instead of dip and azimuth: survey_file = "survey.csv", with heads "depth [m], dip [deg], azimuth [deg]"
# (dip from the horizontal, up positive; or inclination from the downward vertical; azimuth clockwise from north).
dip = "{dip}"
azimuth = "0 deg\""""  # noqa: E501

_LIMITS = """# [limits]                     # of your rig and pipes, so that commands compare with them
# torque = "4 kN m"
# push = "100 kN"
# pull = "100 kN"
# yield_stress = "550 MPa\""""


def text(kind: str, given: dict[str, str], folder: str = ".") -> str:
    """The scene. given: values with units, in place of the defaults, names of a catalogue for "rods" and "rig", and a
    file for "survey", which a scene in the folder names. Raises ValueError that names the option."""
    values: dict[str, Any] = {}
    numbers: dict[str, float] = {}
    typed, given = given, _with_rods(kind, given)
    survey_lines, survey_length = _surveyed(given, folder)
    for name, (unit, default, about) in OPTIONS[kind].items():
        default = survey_length if name == "length" and survey_length else default
        values[name] = given.get(name) or default
        try:
            numbers[name] = units.parse(_with_unit(values[name], name), unit)
        except units.UnitError as error:
            raise ValueError(f"--{name.replace('_', '-')} {values[name]}: {error}") from error
        values[name] = _with_unit(values[name], name).replace('"', " in").strip()
    values["course"] = survey_lines or _STRAIGHT.format(dip=values["dip"])
    values.update(_named(given, typed, values, numbers))
    if abs(numbers["dip"]) > 0.5 * math.pi * (1.0 + 1e-12):
        raise ValueError(f"--dip {values['dip']} must be within -90 deg .. 90 deg, from the horizontal, up positive")
    if numbers["rod"] >= numbers["hole"] or not 0.0 <= numbers["bore"] < numbers["rod"]:
        raise ValueError(f"--{'rods' if given.get('rods') else 'rod'} {values['rod']} must lie between --bore "
                         f"{values['bore']} and --hole {values['hole']}")
    count = math.floor(numbers["length"] / numbers["rod_length"] + 1e-9)
    if not 1 <= count <= 2 ** 20:
        raise ValueError(f"--length {values['length']} must be 1 to {2 ** 20} times --rod-length, "
                         f"{values['rod_length']}")
    values["middle"] = count // 2
    values["clearance"] = f"{0.5e3 * (numbers['hole'] - numbers['rod']):.3g} mm"
    title = f"{'drainage hole' if kind == 'drainage' else 'well'} of {values['length']}"
    return _SCENE.format(title=title, kind=kind, count=count, **values) + _COMMENTED


def _with_rods(kind: str, given: dict[str, str]) -> dict[str, str]:
    """Rods given by their outer diameter alone have the wall of the usual ones, which the scene calls an assumption."""
    rods = given.get("rods", "")
    try:
        units.parse(_with_unit(rods, "rod"), "m")
        given = {**{key: value for key, value in given.items() if key != "rods"}, "rod": rods}
    except units.UnitError:
        pass
    if "rod" not in given or "bore" in given or "rods" in given:
        return given
    usual, bore = (units.parse(OPTIONS[kind][name][1], "m") for name in ("rod", "bore"))
    try:
        outer = units.parse(_with_unit(given["rod"], "rod"), "m")
    except units.UnitError:
        return given  # refused with all the values
    return {**given, "bore": f"{1e3 * (outer - usual + bore):.4g} mm"}


def _surveyed(given: dict[str, str], folder: str) -> tuple[str, str]:
    """The lines of the hole's course, and its length; nothing without a survey."""
    if not given.get("survey"):
        return "", ""
    name = given["survey"]
    if given.get("dip"):
        raise ValueError(f"--dip {given['dip']} must be left out with --survey, which gives the course of the hole")
    problems = Problems({})
    rows = survey.from_file(problems, ("survey",), name, pathlib.Path(), None)
    if rows is None:
        raise ValueError("\n".join(f"--survey {name}: {one.text}" for one in problems.found))
    notes = "".join(f"# {one.text}\n" for one in problems.remarks)
    lines = f"# {len(rows)} stations from {rows[0][0]:g} m to {rows[-1][0]:g} m\n{notes}"
    return (lines + f"survey_file = {json.dumps(os.path.relpath(name, folder), ensure_ascii=False)}",
            f"{rows[-1][0]:g} m")


def _named(given: dict[str, str], typed: dict[str, str], values: dict[str, Any],
           numbers: dict[str, float]) -> dict[str, str]:
    """The lines of pipes and limits. numbers: diameters of rods by name are put there."""
    lines = {"pipes": f'outer_diameter = "{values["rod"]}"\ninner_diameter = "{values["bore"]}"        # the wall is '
                      'an assumption'
             if "bore" not in typed else f'outer_diameter = "{values["rod"]}"\ninner_diameter = "{values["bore"]}"',
             "limits": _LIMITS}
    if given.get("rods"):
        found = _found("rods", given["rods"])
        for name, key in (("rod", "outer_diameter"), ("bore", "inner_diameter")):
            values[name], numbers[name] = found.values[key], units.parse(found.values[key], "m")
        lines["pipes"] = f"# {found.text()}\npipe = {json.dumps(given['rods'], ensure_ascii=False)}"
    if given.get("rig"):
        lines["limits"] = (f"[limits]\n# {_found('rig', given['rig']).text()}\nrig = "
                           f"{json.dumps(given['rig'], ensure_ascii=False)}")
    return lines


def _found(option: str, name: str) -> catalogue.Found:
    known = catalogue.Catalogue()
    try:
        return known.rig(name) if option == "rig" else known.pipe(name)
    except catalogue.CatalogueError as error:
        raise ValueError(f"--{option} {name}: {error}") from None


def _with_unit(value: str, name: str) -> str:
    """"--length 200 --dip 5 --rod 73" is in metres, degrees and millimetres, as mines speak."""
    usual = {"length": "m", "rod_length": "m", "dip": "deg", "hole": "mm", "rod": "mm", "bore": "mm", "bit_load": "kN",
             "speed": "rpm", "feed": "mm/s",
             "mud": "kg/m3"}
    try:
        float(value)
    except ValueError:
        return value
    return f"{value} {usual[name]}"
