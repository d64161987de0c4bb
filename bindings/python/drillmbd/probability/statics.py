"""Static states of a sample: the stiff string pushed in, pulled out and rotated, with the largest load of the bit, as
friction is then."""
from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from .. import enums
from ..errors import Error
from ..model import remake
from ..operating import operating, polar_moduli
from ..remade import number_of, time_functions_of
from ..scene import Scene
from ..scene.largest import largest_of
from ..sim import Sim

#: [m/s, rad/s] where the scene gives none; friction depends on their direction
USUAL_SPEED, USUAL_ROTATION = 0.01, 10.0


@dataclass(frozen=True)
class State:
    """One of them."""
    name: str
    scene: Scene                 #: with the loads of the state at time 0
    slip: dict[str, float]
    #: by string and kind of failure: the part of the demand by the torque of the bit, which the state does not contain
    torque: dict[tuple[str, str], float]


def _loaded(scene: Scene) -> Scene:
    """The scene with the time functions of bit loads at their largest from the beginning."""
    numbers = {number_of(arguments[0]["load"]) for name, arguments in scene.model.calls if name == "add_bit"
               and arguments[0].get("load")}
    calls, number, changed, time_functions = [], -1, False, time_functions_of(scene)
    for name, arguments in scene.model.calls:
        number += name == "add_time_function"
        if name == "add_time_function" and number in numbers:
            largest = largest_of(arguments, time_functions)
            if largest is not None:
                arguments, changed = ({"h0": largest},), True
        calls.append((name, arguments))
    if not changed:
        return scene
    model = remake(type(scene.model), calls)
    return replace(scene, model=model, names={key: model.own(part) for key, part in scene.names.items()},
                   failures=[replace(one, parts={key: model.own(part) for key, part in one.parts.items()})
                             for one in scene.failures],
                   outputs=[(name, model.own(place), quantity) for name, place, quantity in scene.outputs])


def _torques(scene: Scene) -> dict[tuple[str, str], float]:
    """[N m, Pa] Of each string the torque of its own bit; of one without a load on a bit the largest of all bits, which
    joints may pass on to it. Stresses: von Mises of sums <= sum."""
    plans = [operating(scene, number) for number in range(len(scene.pipes))]
    largest = max((plan.torque_on_bit for plan in plans), default=0.0)
    found = {}
    for number, (name, plan) in enumerate(zip(scene.pipes, plans)):
        torque = largest if plan.weight_on_bit is None else plan.torque_on_bit
        stress = math.sqrt(3.0) * torque / min(polar_moduli(scene, number), default=math.inf)
        found.update({(name, "rig-torque"): torque, (name, "connection-torque"): torque, (name, "stress"): stress})
    return found


def states(scene: Scene) -> list[State]:
    """Of a scene; without a drive of rotation only pushed in and pulled out."""
    plan, given = operating(scene), scene.analyses.get("static", {})
    speed = abs(given.get("slip_axial", 0.0)) or plan.feed or USUAL_SPEED
    rotation = abs(given.get("slip_rotation", 0.0)) or plan.rotation or USUAL_ROTATION
    loaded = _loaded(scene)
    found = [State("pushed in", loaded, {"slip_axial": speed}, {}), State("pulled out", scene, {"slip_axial": -speed},
                                                                          {})]
    if any(name == "add_drive" and arguments[0].get("component") == enums.RX for name, arguments in scene.model.calls):
        found.append(State("rotated", loaded, {"slip_rotation": rotation}, _torques(scene)))
    return found


@contextlib.contextmanager
def at_rest(state: State) -> Iterator[Sim]:
    """A sim in that state; in ten load steps where one does not converge, as with friction around a string, which
    climbs."""
    values: dict[str, Any] = {**state.scene.fields_of("static"), "slip_axial": 0.0, "slip_rotation": 0.0, **state.slip}
    with state.scene.new_sim() as sim:
        try:
            sim.static(**values)
        except Error as error:
            if error.status != enums.ERR_NO_CONVERGENCE:
                raise
            values["load_steps"] = 10
            sim.static(**values)
        yield sim
