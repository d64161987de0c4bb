"""A commented scene from a few values, as `drillmbd new` writes it: a drainage hole or a well."""
from __future__ import annotations

import json
import math
from typing import Any

from ..new_options import OPTIONS
from . import catalogue, units

_SCENE = """# {title}. Written by: drillmbd new {kind}
# Check it with: drillmbd check FILE. Keys with unit, default and meaning: drillmbd keys
title = "{title}"

[environment]
fluid_density = "{mud}"

[hole]
diameter = "{hole}"
# A surveyed hole instead of dip and azimuth: survey_file = "survey.csv", with heads "depth [m], dip [deg], azimuth [deg]"
# (dip from the horizontal, up positive; or inclination from the downward vertical; azimuth clockwise from north).
dip = "{dip}"
azimuth = "0 deg"
mu_static = 0.35               # friction against the wall, an assumption: fit it to measured loads
mu_dynamic = 0.30

[[programme]]
name = "feed"
term = {{kind = "step5", x0 = "0 s", x1 = "2 s", h1 = "{feed}"}}

[[programme]]
name = "rotation"
term = {{kind = "step5", x0 = "0 s", x1 = "2 s", h1 = "{speed}"}}

[[programme]]
name = "bit load"
term = {{table = [["0 s", "0 N"], ["2 s", "0 N"], ["4 s", "{bit_load}"]]}}

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
programme = "feed"

[[drive]]
name = "rotation drive"
component = "rx"
programme = "rotation"

{limits}

[run]
end = "8 s"
step = "2 ms"
static = true

[output]
interval = "20 ms"
"""

_LIMITS = """# [limits]                     # of your rig and pipes, so that commands compare with them
# torque = "4 kN m"
# push = "100 kN"
# pull = "100 kN"
# yield_stress = "550 MPa\""""


def text(kind: str, given: dict[str, str]) -> str:
    """The scene. given: values with units, in place of the defaults, and names of a catalogue for "rods" and "rig". Raises ValueError
    that names the option."""
    values: dict[str, Any] = {}
    numbers: dict[str, float] = {}
    for name, (unit, default, about) in OPTIONS[kind].items():
        values[name] = given.get(name) or default
        try:
            numbers[name] = units.parse(_with_unit(values[name], name), unit)
        except units.UnitError as error:
            raise ValueError(f"--{name.replace('_', '-')} {values[name]}: {error}") from error
        values[name] = _with_unit(values[name], name).replace('"', " in").strip()
    values.update(_named(given, values, numbers))
    if numbers["rod"] >= numbers["hole"] or numbers["bore"] >= numbers["rod"]:
        raise ValueError(f"--{'rods' if given.get('rods') else 'rod'} {values['rod']} must lie between --bore {values['bore']} and --hole {values['hole']}")
    count = math.floor(numbers["length"] / numbers["rod_length"] + 1e-9)
    if not 1 <= count <= 2 ** 20:
        raise ValueError(f"--length {values['length']} must be at least one --rod-length, {values['rod_length']}")
    title = f"{'drainage hole' if kind == 'drainage' else 'well'} of {values['length']}"
    return _SCENE.format(title=title, kind=kind, count=count, **values)


def _named(given: dict[str, str], values: dict[str, Any], numbers: dict[str, float]) -> dict[str, str]:
    """The lines of pipes and limits. numbers: diameters of rods by name are put there."""
    lines = {"pipes": f'outer_diameter = "{values["rod"]}"\ninner_diameter = "{values["bore"]}"', "limits": _LIMITS}
    if given.get("rods"):
        found = _found("rods", given["rods"])
        for name, key in (("rod", "outer_diameter"), ("bore", "inner_diameter")):
            values[name], numbers[name] = found.values[key], units.parse(found.values[key], "m")
        lines["pipes"] = f"# {found.text()}\npipe = {json.dumps(given['rods'], ensure_ascii=False)}"
    if given.get("rig"):
        lines["limits"] = f"[limits]\n# {_found('rig', given['rig']).text()}\nrig = {json.dumps(given['rig'], ensure_ascii=False)}"
    return lines


def _found(option: str, name: str) -> catalogue.Found:
    known = catalogue.Catalogue()
    try:
        return known.rig(name) if option == "rig" else known.pipe(name)
    except catalogue.CatalogueError as error:
        raise ValueError(f"--{option} {name}: {error}") from None


def _with_unit(value: str, name: str) -> str:
    """"--length 200 --dip 5 --rod 73" is in metres, degrees and millimetres, as mines speak."""
    usual = {"length": "m", "rod_length": "m", "dip": "deg", "hole": "mm", "rod": "mm", "bore": "mm", "bit_load": "kN", "speed": "rpm", "feed": "mm/s",
             "mud": "kg/m3"}
    try:
        float(value)
    except ValueError:
        return value
    return f"{value} {usual[name]}"
