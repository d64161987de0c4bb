"""Rotary speeds to avoid: bands of the linear analysis, over the range of diameters and friction of the scene, and
speeds run in time."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from . import _structs, enums, no_response, rotating, speed_check, speed_range
from ._structs import Output, Place
from .results import RPM, CommandOutput
from .errors import Usage
from .language import Foreign, Phrase, phrase
from .operating import operating
from .rotating import Linear
from .scene import Scene
from .sim import Sim
from .unit_systems import SI, Units

#: Displacements across a string along x.
LATERAL = (enums.OUTPUT_DISPLACEMENT_Y, enums.OUTPUT_DISPLACEMENT_Z,
           *(base + component for base in (enums.OUTPUT_VIBRATION, enums.OUTPUT_VIBRATION_BODY)
             for component in (enums.Y, enums.Z)))
LINEAR = phrase("The analysis is linear: it does not cover contacts that open or strike, nor stick-slip.")


@dataclass
class Found:
    """Bands and severity of one scene."""
    bands: Any
    severity: list[float]
    grid: list[float]        #: [rad/s]
    threshold: float
    state: Linear
    silent: Phrase | None = None   #: why nothing moves the outputs
    unmoved: list[int] = field(default_factory=list)   #: numbers of outputs that nothing moves, where another moves
    neglects: str = ""       #: sentence about effects that the linear analysis leaves out

    @property
    def whole(self) -> bool:
        """True if all outputs and orders were assessed about the state of the scene: a speed that no band has is free
        of critical ones."""
        return self.silent is None and not self.partial and not self.state.refused

    @property
    def partial(self) -> bool:
        """True if an order or an output has no response, or the analysis neglects something: no speed is free of
        critical ones then."""
        return bool(self.unmoved or self.bands.report.silent_orders or self.neglects)


def analyse(scene: Scene, settle: Any, note: Any) -> Found:
    """Bands about the sliding string. A scene without rotation: about the string that turns at the middle of the
    range."""
    settings, values = scene.analyses["speeds"], scene.fields_of("speeds")
    used: Any = _structs.SpeedsOptions(**values)
    limits = [one["limit"] for one in settings["output"]]

    def compute(sim: Sim, state: Linear) -> Any:
        given = state.scene.orders(), state.scene.response_outputs("speeds"), limits
        bands, severity = sim.speeds(*given, **state.options)
        if bands.report.bands > len(bands):  # a speed of a band that is left out would be free
            bands, severity = sim.speeds(*given, room=bands.report.bands, **state.options)
        neglects = rotating.neglected(bands.status, sim.message)
        return bands, severity, neglects, no_response.of_speeds(sim, state.scene, state.options)

    state, (bands, severity, neglects, reasons) = rotating.linear(scene, "speeds", settle, compute, note)
    grid = [used.speed_low + (used.speed_high - used.speed_low) * i / (used.points - 1) for i in range(used.points)]
    silent = no_response.of_all(reasons)
    unmoved = [] if silent else [number for number, reason in enumerate(reasons) if reason is not None]
    return Found(bands, severity, grid, used.threshold, state, silent, unmoved, Foreign(neglects) if neglects else "")


def speeds(scene: Scene, out: CommandOutput, options: Any) -> int:
    """Critical rotary speeds."""
    from .commands import settled
    if options.check and not 2 <= options.check <= speed_check.MOST_SPEEDS:
        raise Usage(f"--check {options.check} is outside 2 .. {speed_check.MOST_SPEEDS}")
    found = analyse(scene, lambda sim, state: settled(state.scene, sim, out, state.static), out.note_text)
    settings = scene.analyses["speeds"]
    names, limits, places = (scene.output_names("speeds"), [one["limit"] for one in settings["output"]],
                             scene.response_outputs("speeds"))
    out.say(found.state.words(out.units))
    for band in found.bands:
        out.say(f"avoid {band.low / RPM:.0f} .. {band.high / RPM:.0f} rpm: {out.units.head(names[band.output])}, "
                   f"{band.severity:.3g} times its limit at {band.speed / RPM:.0f} rpm, order "
                   f"{settings['order'][band.order]['order']:g}"
                   + touches(scene, places[band.output], band.severity * limits[band.output], out.units))
    low, high = found.grid[0] / RPM, found.grid[-1] / RPM
    rotation = (operating(scene).rotation or 0.0) / RPM
    if rotation and not low * (1.0 - 1e-9) <= rotation <= high * (1.0 + 1e-9):
        out.note_text(f"the rotation of {rotation:.4g} rpm is outside the range of [speeds], {low:.4g} .. {high:.4g} "
                      "rpm, and is not assessed; widen speed_low or speed_high")
    excited = found.silent is None
    if not excited:
        out.say(f"speeds: not assessed, because {found.silent}")
    elif found.state.refused:
        out.say("speeds of the string that turns: not assessed, because its sliding state is refused; run speeds "
                "--check. "
                   f"Of the string at rest the amplitudes are at most {max(found.severity):.3g} times their limits "
                   f"between {low:.0f} and {high:.0f} rpm")
    elif not found.bands and found.bands.report.silent_orders:
        out.say(f"speeds: not assessed, because {int(found.bands.report.silent_orders)} of the "
                f"{len(settings['order'])} orders move no output; the "
                   f"others have amplitudes of at most {max(found.severity):.3g} times their limits between {low:.0f} "
                   f"and {high:.0f} rpm")
    elif not found.bands and found.unmoved:
        out.say("speeds: not assessed for all outputs; of the others the amplitudes are at most "
                f"{max(found.severity):.3g} times their limits between "
                   f"{low:.0f} and {high:.0f} rpm")
    elif not found.bands and found.neglects:
        out.say("speeds: not assessed, because the linear analysis leaves out effects of the rotation; without them "
                f"the amplitudes are at most {max(found.severity):.3g} times their limits between {low:.0f} and "
                f"{high:.0f} rpm")
    elif not found.bands:
        out.say(f"no critical speed between {low:.0f} and {high:.0f} rpm: the amplitudes are at most "
                f"{max(found.severity):.3g} times their limits")
    if found.neglects:
        out.note_text(out.units.sentence(found.neglects))
    for number in found.unmoved:
        out.say(f"{out.units.head(names[number])}: not assessed, because {no_response.NO_RESPONSE}")
    out.say(LINEAR)
    for note in left_out(found.bands.report) if excited else []:
        out.note_text(note)
    out.summary["speeds_assessed"] = found.whole
    out.summary["linear_state"] = found.state.numbers()
    out.summary["speeds"] = [{"low_rpm": band.low / RPM, "high_rpm": band.high / RPM, "worst_rpm": band.speed / RPM,
                                 "severity": band.severity, "output": names[band.output]} for band in found.bands]
    ranges = speed_range.bands_over_range(scene, out, found) if excited else []
    out.table("speeds.csv", ["speed [rpm]", "severity [-]"], [(w / RPM, s) for w, s in zip(found.grid, found.severity)])
    out.picture("speeds.png", lambda plots: plots.severity(found.grid, found.severity, found.bands, found.threshold,
                                                           scene.title, ranges))
    if options.check:
        speed_check.check(scene, out, found, options.check)
    return out.finish()


def left_out(report: Any) -> list[str]:
    """Parts that the analysis leaves out, by its report."""
    remarks: list[str] = []
    if report.silent_orders:
        remarks.append(phrase("Critical speeds: {silent} of the orders move no output at any speed",
                              silent=int(report.silent_orders)))
    if report.undamped:
        remarks.append(phrase("Critical speeds: nothing damps the string, so amplitudes at resonances have no meaning"))
    if report.truncated:
        remarks.append(phrase("Critical speeds: a band continues beyond the range of [speeds]"))
    return remarks


# ---- Beyond the linear range -----------------------------------------------------------------------------------------
def touches(scene: Scene, place: Output, amplitude: float, units: Units = SI) -> str:
    """A warning if a lateral amplitude [m] at the place of an output exceeds the radial clearance there."""
    clearance = clearance_at(scene, place.place) if place.quantity in LATERAL else None
    if clearance is None or amplitude <= clearance:
        return ""
    return (f"; the amplitude of {units.text(1e3 * amplitude, 'mm', '.3g')} exceeds the radial clearance of "
            f"{units.text(1e3 * clearance, 'mm', '.3g')}: the string touches the wall, beyond the range of the linear "
            "analysis")


def _diameter_at(arguments: tuple[Any, ...], fraction: float) -> float:
    """[m] Outer diameter of a pipe of a call, of its tool joint at its far end."""
    pipe: Any = _structs.PipeDef(**{key: value for key, value in arguments[1].items() if key in
                                    ("length", "outer_diameter", "joint_length", "joint_outer_diameter")})
    in_joint = pipe.joint_length > 0.0 and fraction * pipe.length >= pipe.length - pipe.joint_length
    return float(in_joint and pipe.joint_outer_diameter or pipe.outer_diameter)


def clearance_at(scene: Scene, place: Place) -> float | None:
    """[m] Radial clearance of the pipe or tool joint at a place of a string; None without hole or pipe."""
    first, before = 0, 0.0  # before: diameter of the tool joint that ends where the pipe begins
    if not any(name == "add_wall" for name, _ in scene.model.calls):
        return None
    for name, arguments in scene.model.calls:
        if name != "add_pipes" or arguments[1].get("string", place.part) != place.part:
            continue
        if first <= place.pipe < first + arguments[0]:
            with scene.new_sim() as sim:
                depth = sim.pose(place).depth
            if place.pipe > first:
                before = _diameter_at(arguments, 1.0)
            outer = max(_diameter_at(arguments, place.fraction), before if place.fraction == 0.0 else 0.0)
            return 0.5 * (float(scene.model.hole(depth).diameter) - outer)
        before = _diameter_at(arguments, 1.0)
        first += arguments[0]
    return None


