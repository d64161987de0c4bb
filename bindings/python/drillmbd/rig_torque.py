"""The torque at the rig that keeps a string turning whose drive gives a torque, not a speed: a steady rotation needs as
much as friction takes from it (eq:sliding.state), independent of the time function of the drive."""
from __future__ import annotations

from typing import Any, cast

from . import enums
from ._structs import DriveId
from .errors import Error
from .remade import Calls, number_of, with_calls, with_time_functions
from .scene import Scene

#: Fields of a drive that say which motion it holds; the others shape its torque.
HOLDING = ("component", "part", "time_function", "name")


def torque_drive(scene: Scene) -> int | None:
    """The number of the only drive that turns the scene, if it gives a torque by a time function; else None."""
    drives = [arguments[0] for name, arguments in scene.model.calls if name == "add_drive"]
    turning = [number for number, one in enumerate(drives) if one.get("component", enums.X) == enums.RX]
    if len(turning) != 1 or drives[turning[0]].get("kind", enums.DRIVE_MOTION) != enums.DRIVE_LOAD:
        return None
    return turning[0] if drives[turning[0]].get("time_function") else None


def _is_part(value: Any, kind: int) -> bool:
    return hasattr(value, "index") and hasattr(value, "generation") and bool(value) and value.index >> 24 == kind


def _changed(scene: Scene, drive: int, change: Any) -> Calls:
    """The calls with the fields of one drive changed, without a value that an input sets there."""
    calls: Calls = []
    number = -1
    for name, arguments in scene.model.calls:
        number += name == "add_drive"
        if name == "add_drive" and number == drive:
            arguments = (change(arguments[0]),)
        if name == "add_input" and _is_part(arguments[0].get("part"),
                                            enums.PART_DRIVE) and number_of(arguments[0]["part"]) == drive:
            continue
        calls.append((name, arguments))
    return calls


def needed(scene: Scene, drive: int, static: dict[str, Any]) -> float:
    """[N m] The torque of the drive in the static state `static`, if it held the angle. Raises Error where there is no
    such state."""
    holding = with_time_functions(with_calls(scene, _changed(scene, drive,
                                                             lambda fields: {key: fields[key]
                                                                             for key in HOLDING if key in fields})),
                              {number_of(_fields(scene, drive)["time_function"]): [{"h0": 0.0}]})
    with holding.new_sim() as sim:
        sim.static(**static)
        return float(sim.drive(next(cast(DriveId, one) for one in holding.model.ids if _is_part(one, enums.PART_DRIVE)
                                    and number_of(one) == drive)).force)


def _fields(scene: Scene, drive: int) -> Any:
    return [arguments[0] for name, arguments in scene.model.calls if name == "add_drive"][drive]


def balanced(scene: Scene, static: dict[str, Any]) -> tuple[Scene, float | None]:
    """The scene whose drive gives the torque of the steady rotation of `static` (slip_rotation), and that torque [N m].
    The scene itself and
    None where the rotation is prescribed, nothing turns it, or the held string has no such state either."""
    drive = torque_drive(scene)
    if drive is None or not static.get("slip_rotation", 0.0):
        return scene, None
    try:
        torque = needed(scene, drive, static)
    except Error:
        return scene, None
    bare = with_calls(scene, _changed(scene, drive, dict))
    return with_time_functions(bare, {number_of(_fields(scene, drive)["time_function"]): [{"h0": torque}]}), torque
