"""A scene at one rotation and load on the bit: its time functions replaced, and the state about which a rotating string
is linearised."""
from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _structs, enums
from .errors import Error
from .language import Foreign, phrase
from .operating import operating
from .remade import number_of, time_functions_of, with_time_functions
from .rig_torque import balanced
from .scene import Scene
from .scene.largest import bounded, largest_of
from .unit_systems import Units

if TYPE_CHECKING:
    from .sim import Sim

RPM = 2.0 * math.pi / 60.0
#: Forces that the linear state may leave out of balance, over those that balance in it. The static state of the round
#: string balances by itself; what is left are its eccentric masses, which turn, and are the excitation.
UNBALANCED = 1.0
#: change of coefficients, over the forces of a result, that counts as none: a rotor that is not round is unstable in
#: about half of that of the speed, less than the margin of bands
NEGLIGIBLE = 0.02


# ---- Time functions --------------------------------------------------------------------------------------------------
def drive_at_speed(scene: Scene, component: int) -> int | None:
    """The number of the time function of the first drive that moves a component at a speed."""
    for name, arguments in scene.model.calls:
        if name == "add_drive":
            given = arguments[0]
            if (given.get("component", enums.X) == component
                and given.get("kind", enums.DRIVE_MOTION) != enums.DRIVE_LOAD
                    and given.get("time_function")):
                return number_of(given["time_function"])
    return None


def loads_of_bits(scene: Scene) -> list[int]:
    """The numbers of the time functions of loads on bits."""
    return [number_of(arguments[0]["load"]) for name, arguments in scene.model.calls if name == "add_bit"
            and arguments[0].get("load")]


def extreme(time_functions: list[Any], number: int) -> float:
    """The value of largest magnitude of the time function of a number, with its sign; 0 where a function of the caller
    gives it."""
    segments = bounded(time_functions[number], time_functions)
    size = largest_of(segments)
    if not size:
        return 0.0
    values = [float(value) for segment in segments for value in (*(one for _, one in segment.get("table", ())),
                                                                 segment.get("h0", 0.0), segment.get("h1", 0.0))]
    return math.copysign(size, max(values, key=abs))


# ---- Linear state ----------------------------------------------------------------------------------------------------
@dataclass
class Linear:
    """State and options of a linear analysis."""
    scene: Scene                                            #: with the loads on the bits of the state
    static: dict[str, Any]                                  #: options of its static state
    options: dict[str, Any] = field(default_factory=dict)   #: of response and speeds
    rotation: float = 0.0                                   #: [rad/s] 0: at rest
    weight_on_bit: float = 0.0                              #: [N]
    #: [N m] of the drive at the rig, where it gives a torque: what friction takes
    torque: float | None = None
    #: at rest in the place of a sliding state, which has no solution
    refused: bool = False

    def words(self, units: Units) -> str:
        """A sentence about the state."""
        if not self.rotation:
            return "linear about the string at rest" + ("" if self.options.get("friction", 1)
                                                        else ", friction of the wall left out")
        load = f" with {units.scaled(self.weight_on_bit, 'N')} on the bit" if self.weight_on_bit else ""
        torque = (f", turned by {units.text(self.torque, 'N m')}, which friction takes" if self.torque is not None
                  else "")
        return ("linear about the string that slides on the wall at "
                f"{units.text(self.rotation / RPM, 'rpm')}{load}{torque}")

    def numbers(self) -> dict[str, float | None]:
        """For the summary."""
        return {"rotation_rpm": self.rotation / RPM, "weight_on_bit_N": self.weight_on_bit, "torque_N_m": self.torque}


def neglected(status: int, message: str) -> str:
    """The sentence of the library about effects that a response leaves out; "" where they are NEGLIGIBLE."""
    found = re.search(r"response: .*", message) if status == enums.NOTE_INCOMPLETE else None
    change = re.search(r"coefficients change by (\S+) of the forces", message)
    if found is None or change is not None and float(change[1]) <= NEGLIGIBLE:
        return ""
    return found[0]


def options_of(scene: Scene, analysis: str) -> dict[str, Any]:
    """The options of response or speeds that the state decides, and those that the scene gives. Rotation: of the
    scene's spin, of its drive, or of the slip in [static]; speeds of a scene without any take the middle of their
    range."""
    given = scene.fields_of(analysis)
    number = drive_at_speed(scene, enums.RX)
    described = extreme(time_functions_of(scene), number) if number is not None else 0.0
    usual: Any = _structs.SpeedsOptions(**{key: given[key] for key in ("speed_low", "speed_high") if key in given})
    middle = 0.5 * (usual.speed_low + usual.speed_high) if analysis == "speeds" else 0.0
    rotation = float(given.get("spin", described or scene.fields_of("static").get("slip_rotation", 0.0) or middle))
    state: dict[str, Any] = {"spin": rotation, "friction": 1, "equilibrium_tolerance": UNBALANCED} if rotation else {}
    if rotation and analysis == "response":
        state["axes"] = int(enums.RESPONSE_AXES_AT_REST)
    return {**state, **given}


def sliding(scene: Scene, analysis: str) -> Linear | None:
    """The state of a string that turns steadily and slides on the wall (eq:sliding.state): friction carries it up the
    wall, gravity holds it there, and small motions change direction and size of the friction. None where nothing
    turns."""
    options = options_of(scene, analysis)
    rotation = float(options.get("spin", 0.0))
    if not rotation:
        return None
    time_functions = time_functions_of(scene)
    loads = {one: [{"h0": extreme(time_functions, one)}] for one in loads_of_bits(scene)
             if extreme(time_functions, one)}
    static = {**scene.fields_of("static"), "slip_rotation": rotation}
    turned, torque = balanced(with_time_functions(scene, loads) if loads else scene, static)
    return Linear(turned, static, options, rotation, operating(scene).weight_on_bit or 0.0 if loads else 0.0, torque)


def at_rest(scene: Scene, analysis: str, refused: bool) -> Linear:
    """The state of a string that does not turn. refused: instead of a sliding state, without friction in any case."""
    static = {key: value for key, value in scene.fields_of("static").items()
              if key not in ("slip_axial", "slip_rotation")}
    options = scene.fields_of(analysis)
    if refused:
        options.update(spin=0.0, friction=0)
        options.pop("equilibrium_tolerance", None)
        if analysis == "response":
            options["axes"] = int(enums.RESPONSE_AXES_AT_REST)
    return Linear(scene, static, options, refused=refused)


def linear(scene: Scene, analysis: str, settle: Callable[[Sim, Linear], Any], compute: Callable[[Sim, Linear], Any],
           note: Callable[[str], Any]) -> tuple[Linear, Any]:
    """The result of a linear analysis about the sliding string where one turns, else at rest; and the state. A sliding
    state that is refused is replaced by the state at rest, and the reason is noted. settle: computes the static state;
    compute: computes the result."""
    found = sliding(scene, analysis)
    if found is not None:
        try:
            return found, _computed(found, settle, compute)
        except Error as error:
            note(phrase("{analysis}: the state of the string that slides at {rpm:.4g} rpm is refused ({reason}); the "
                        "state at rest without "
                        "friction takes its place", analysis=phrase("speeds") if analysis == "speeds"
                        else phrase("response"),
                        rpm=found.rotation / RPM, reason=Foreign(error.message)))
    rest = at_rest(scene, analysis, found is not None)
    return rest, _computed(rest, settle, compute)


def _computed(found: Linear, settle: Callable[[Sim, Linear], Any], compute: Callable[[Sim, Linear], Any]) -> Any:
    with found.scene.new_sim() as sim:
        settle(sim, found)
        return compute(sim, found)
