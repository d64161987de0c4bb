"""Strings as the live page draws them: stations, radii of the pipes, and which string continues which."""
from __future__ import annotations

from typing import Any

from ._record import Record
from ._structs import BitDef, Id, JointDef, PipeDef
from .scene import Scene

MOST_STATIONS = 300  #: of all strings together
Call = tuple[str, tuple[Any, ...]]


def _made(cls: Any, given: Any) -> Any:
    return given if isinstance(given, Record) else cls(**given)


def _runs(calls: list[Call], first: int) -> dict[int, list[dict[str, float]]]:
    """Runs of equal pipes of each string, by the index of its id: where they end along it [m], and their radius [m]."""
    found: dict[int, list[dict[str, float]]] = {}
    for name, given in calls:
        if name == "add_pipes":
            pipe = _made(PipeDef, given[1])
            runs = found.setdefault(pipe.string.index if pipe.string else first, [])
            end = (runs[-1]["end"] if runs else 0.0) + given[0] * pipe.length
            runs.append({"end": end, "radius": 0.5 * pipe.outer_diameter})
    return found


def _joined(calls: list[Call], pipes: dict[int, int]) -> set[tuple[int, int]]:
    """Pairs of strings of which the second begins at the far end of the first: by a joint, or by a body with a joint to
    each. pipes: number of pipes by the index of a string."""
    ends: dict[int, set[int]] = {}    # strings that end at a part
    begins: dict[int, set[int]] = {}  # strings that begin at a part
    for name, arguments in calls:
        if name != "add_joint":
            continue
        joint = _made(JointDef, arguments[0])
        for place, other in ((joint.place_a, joint.place_b), (joint.place_b, joint.place_a)):
            index = place.part.index
            if not place.part or index not in pipes:
                continue
            if place.pipe == 0 and place.fraction == 0.0:
                begins.setdefault(other.part.index, set()).add(index)
            elif place.pipe == pipes[index] - 1 and place.fraction == 1.0:
                ends.setdefault(other.part.index, set()).add(index)
    bodies = {(a, b) for part in ends if part not in pipes for a in ends[part] for b in begins.get(part, ())}
    return bodies | {(a, b) for b in ends if b in pipes for a in ends[b] if b in begins.get(a, ())}


def _in_order(pipes: dict[int, int], joined: set[tuple[int, int]]) -> list[tuple[int, int | None]]:
    """Each string behind the one that it continues: its index, and the place of that one in this list."""
    found: list[tuple[int, int | None]] = []
    left = list(pipes)
    while left:
        placed = [index for index, _ in found]
        # of a ring of strings any
        index = next((one for one in left if all(b != one or a in placed for a, b in joined)), left[0])
        before = [number for number, one in enumerate(placed) if (one, index) in joined]
        found.append((index, before[0] if before else None))
        left.remove(index)
    return found


def strings_of(scene: Scene, first: Id) -> tuple[list[dict[str, Any]], int]:
    """Strings with pipes, each behind the one that it continues; and the number of that with the bit, or of the last
    one."""
    calls = list(scene.model.calls)
    counts = {scene.names[name].index: count for name, count in scene.pipes.items() if count}
    runs, joined, total = _runs(calls, first.index), _joined(calls, counts), sum(counts.values())
    found: list[dict[str, Any]] = []
    for index, before in _in_order(counts, joined):
        found.append({"index": index,
                      "stations": max(2, min(MOST_STATIONS * counts[index] // total, 2 * counts[index]) + 1),
                      "radii": runs[index], "length": runs[index][-1]["end"], "continues": before})
    bits = [_made(BitDef, arguments[0] if arguments else {}).string for name, arguments in calls if name == "add_bit"]
    wanted = bits[0].index if bits and bits[0] else first.index if bits else found[-1]["index"] if found else 0
    return found, next((number for number, one in enumerate(found) if one["index"] == wanted), len(found) - 1)
