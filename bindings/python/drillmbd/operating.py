"""The operation that a scene describes: rotation, feed and load on the bit, as its time functions give them."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from . import _structs, enums
from .analysis import OPERATIONS, usual_operation
from .scene import Scene
from .scene.largest import largest_of, range_of

#: Torque of the bit over a third of its diameter times its load, where the scene has no rock law (the bit-specific
#: coefficient of sliding friction of Pessier and Fear 1992); between roller-cone and drag bits.
BIT_FRICTION = 0.5


@dataclass
class Operating:
    """Largest values, of the rotation its magnitude; None where the scene does not give them as numbers."""
    rotation: float | None = None       #: [rad/s] of the rotation drive
    feed: float | None = None           #: [m/s] of the feed drive, into the hole
    weight_on_bit: float | None = None  #: [N]
    torque_on_bit: float = 0.0          #: [N m] estimated from the load and diameter of the bit
    estimated: bool = False             #: torque_on_bit is an estimate
    cuts: bool = False                  #: a rock law adds load and torque of the bit in a run


def operating(scene: Scene, string: int | None = None, end: float = math.inf) -> Operating:
    """Of the first drives along and about x, and the first bit. string: the number of a string, of whose drives and bit
    it is then; drives of joints and bodies may turn any string. end: [s] up to which the load on the bit counts."""
    time_functions: list[Any] = [segments for name, segments in scene.model.calls if name == "add_time_function"]
    found = Operating()
    for name, arguments in scene.model.calls:
        fields = arguments[0] if arguments and isinstance(arguments[0], dict) else {}
        if string is not None and not _is_of(fields.get("string" if name == "add_bit" else "part"), string):
            continue
        if name == "add_drive" and fields.get("kind", enums.DRIVE_MOTION) != enums.DRIVE_LOAD:
            value = _value(time_functions, fields.get("time_function"))
            if fields.get("component", enums.X) == enums.RX and found.rotation is None:
                found.rotation = value
            elif fields.get("component", enums.X) == enums.X and found.feed is None:
                found.feed = _ahead(time_functions, fields.get("time_function"))
        if name == "add_bit" and found.weight_on_bit is None:
            found.weight_on_bit = _ahead(time_functions, fields.get("load"), end)
            found.cuts = _law(fields) != enums.ROCK_NONE
            _estimate(found, fields)
    return found


def _is_of(part: Any, string: int) -> bool:
    """Whether a drive or bit with this part belongs to a string; without one to the first."""
    if not part:
        return string == 0
    return bool(part.index >> 24 != enums.PART_STRING or part.index & 0xFFFFFF == string)


def _value(time_functions: list[Any], part: Any) -> float | None:
    """Of a time function by its id, whose low 24 bits are its number."""
    return largest_of(time_functions[part.index & 0xFFFFFF], time_functions) if part else None


def _ahead(time_functions: list[Any], part: Any, end: float = math.inf) -> float | None:
    """The largest value > 0 of a time function, else 0: a feed into the hole, a load against it."""
    found = range_of(time_functions[part.index & 0xFFFFFF], time_functions, end) if part else None
    return None if found is None else max(0.0, found[1])


def operations_of(plan: Operating) -> list[_structs.Operation]:
    """The usual operations, in the order of OPERATIONS, with the rotation, feed and load on the bit of the plan."""
    found = [usual_operation(kind) for kind in OPERATIONS]
    for kind in (enums.OPERATION_DRILL, enums.OPERATION_SLIDE):
        found[kind].weight_on_bit = plan.weight_on_bit or 0.0
    found[enums.OPERATION_DRILL].torque_on_bit = plan.torque_on_bit
    for kind in (enums.OPERATION_DRILL, enums.OPERATION_ROTATE):
        found[kind].rotary_speed = plan.rotation or found[kind].rotary_speed
    found[enums.OPERATION_DRILL].axial_speed = plan.feed or found[enums.OPERATION_DRILL].axial_speed
    return found


def with_weight(scene: Scene, plan: Operating, weight: float, string: int) -> Operating:
    """The plan of a string, by its number, with another weight on the bit [N], and the torque that belongs to it by the
    same estimate."""
    bit: dict[str, Any] = next((arguments[0] for name, arguments in scene.model.calls if name == "add_bit"
                                and _is_of(arguments[0].get("string"), string)), {})
    found = Operating(plan.rotation, plan.feed, weight)
    _estimate(found, bit)
    return found


def has_rock_law(scene: Scene) -> bool:
    """Whether a bit cuts rock: its load and torque come from the run."""
    return any(name == "add_bit" and _law(arguments[0]) != enums.ROCK_NONE for name, arguments in scene.model.calls)


def polar_moduli(scene: Scene, string: int | None = None) -> list[float]:
    """[m3] J/r of the bodies of all pipes, or of those of the string of a number, torque over shear stress at the outer
    surface."""
    found = []
    for name, arguments in scene.model.calls:
        if name == "add_pipes" and (string is None or _is_of(arguments[1].get("string"), string)):
            pipe: Any = _structs.PipeDef(**{key: value for key, value in arguments[1].items()
                                            if key in ("outer_diameter", "inner_diameter")})
            found.append(math.pi / 16.0 * (pipe.outer_diameter ** 4 - pipe.inner_diameter ** 4) / pipe.outer_diameter)
    return found


def _law(bit: dict[str, Any]) -> Any:
    return bit.get("rock_law", enums.ROCK_NONE)


def _estimate(found: Operating, bit: dict[str, Any]) -> None:
    diameter = float(bit.get("diameter", _structs.BitDef().diameter))
    if found.weight_on_bit and _law(bit) == enums.ROCK_NONE and 0.0 < diameter < math.inf:
        found.torque_on_bit = BIT_FRICTION * found.weight_on_bit * diameter / 3.0
        found.estimated = True
