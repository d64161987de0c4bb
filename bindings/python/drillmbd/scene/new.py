"""A commented scene from a few values, as `drillmbd new` writes it: a drainage hole or a well."""
from __future__ import annotations

import math
from typing import Any

from ..new_options import OPTIONS
from . import units

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
outer_diameter = "{rod}"
inner_diameter = "{bore}"
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

# [limits]                     # of your rig and pipes, so that commands compare with them
# torque = "4 kN m"
# push = "100 kN"
# pull = "100 kN"
# yield_stress = "550 MPa"

[run]
end = "8 s"
step = "2 ms"
static = true

[output]
interval = "20 ms"
"""


def text(kind: str, given: dict[str, str]) -> str:
    """The scene. given: values with units, in place of the defaults. Raises ValueError that names the option."""
    values: dict[str, Any] = {}
    numbers: dict[str, float] = {}
    for name, (unit, default, about) in OPTIONS[kind].items():
        values[name] = given.get(name) or default
        try:
            numbers[name] = units.parse(_with_unit(values[name], name), unit)
        except units.UnitError as error:
            raise ValueError(f"--{name.replace('_', '-')} {values[name]}: {error}") from error
        values[name] = _with_unit(values[name], name).replace('"', " in").strip()
    if numbers["rod"] >= numbers["hole"] or numbers["bore"] >= numbers["rod"]:
        raise ValueError(f"--rod {values['rod']} must lie between --bore {values['bore']} and --hole {values['hole']}")
    count = math.floor(numbers["length"] / numbers["rod_length"] + 1e-9)
    if not 1 <= count <= 2 ** 20:
        raise ValueError(f"--length {values['length']} must be at least one --rod-length, {values['rod_length']}")
    title = f"{'drainage hole' if kind == 'drainage' else 'well'} of {values['length']}"
    return _SCENE.format(title=title, kind=kind, count=count, **values)


def _with_unit(value: str, name: str) -> str:
    """"--length 200 --dip 5 --rod 73" is in metres, degrees and millimetres, as mines speak."""
    usual = {"length": "m", "rod_length": "m", "dip": "deg", "hole": "mm", "rod": "mm", "bore": "mm", "bit_load": "kN", "speed": "rpm", "feed": "mm/s",
             "mud": "kg/m3"}
    try:
        float(value)
    except ValueError:
        return value
    return f"{value} {usual[name]}"
