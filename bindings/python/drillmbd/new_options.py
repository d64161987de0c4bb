"""Options of `drillmbd new`: data alone, so that the command line can be read without the library."""
from __future__ import annotations

#: Options of the kinds: unit, default, meaning. The defaults are a plausible start, to be replaced by one's own values.
OPTIONS: dict[str, dict[str, tuple[str, str, str]]] = {
    "drainage": {"length": ("m", "200 m", "length of the hole"),
                 "dip": ("rad", "5 deg", "of the hole, from the horizontal, up positive"),
                 "hole": ("m", "94 mm", "diameter of the hole"), "rod": ("m", "73 mm", "outer diameter of the rods"),
                 "bore": ("m", "59 mm", "inner diameter of the rods"), "rod_length": ("m", "1.5 m", "length of a rod"),
                 "bit_load": ("N", "8 kN", "load of the bit"), "speed": ("rad/s", "120 rpm", "rotary speed"),
                 "feed": ("m/s", "10 mm/s", "rate of feed"),
                 "mud": ("kg/m3", "1000 kg/m3", "density of the flush")},
    "well": {"length": ("m", "1000 m", "length of the hole"),
             "dip": ("rad", "-90 deg", "of the hole, from the horizontal, up positive"),
             "hole": ("m", "8.5 in", "diameter of the hole"), "rod": ("m", "5 in", "outer diameter of the pipes"),
             "bore": ("m", "4.276 in", "inner diameter of the pipes"), "rod_length": ("m", "9.5 m", "length of a pipe"),
             "bit_load": ("N", "50 kN", "weight on bit"), "speed": ("rad/s", "90 rpm", "rotary speed"),
             "feed": ("m/s", "5 mm/s", "rate of penetration"),
             "mud": ("kg/m3", "1200 kg/m3", "density of the mud")}}
