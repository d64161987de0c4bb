"""A run: step, advance, query, snapshot."""
from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_double, c_size_t, c_uint32, c_uint64, c_void_p
from typing import TYPE_CHECKING, Any

from . import analysis
from ._handle import Handle
from ._keep import Keep, as_id, as_place, mirrors, path_of, struct, written
from ._library import lib as _lib
from ._parts import closed, index_of, is_closed
from ._progress import INTERRUPTS, Teller
from ._structs import (STRUCTS, BitState, Output, Contact, DriveState, Energy, FatigueOptions, FlowState, HolePoint, Id,
                       Excitation, JointState,
                       Momentum, Motion, Place, Pose, Section, SimOptions, SpringState, StateSpaceOptions, Statistics,
                       StuckState,
                       StepReport, WindowOptions)
from ._structs import BitId, DriveId, EventReport, JointId, SpringId, StringId, StuckId
from ._values import real, reals, refuse_type, refuse_value, whole
from .outputs import output_of
from .enums import FRAME_WORLD, OK
from .errors import Error, check, in_python
from .inputs import InputLog, Inputs
from .recorder import ProfileRecorder, Recorder
from .running import Bar, Lengths, Loop, Progress, Taker, own_takers, warn_of

if TYPE_CHECKING:
    from .model import Model
    from .fatigue import Fatigue, StringFatigue
    from .sensitivity import Sensitivity
    from .state_equation import StateEquation
    from .profile import Extremes, Profile
    from .state_space import Arrays, StateSpace
    from .window import Window

_advance_to_event = _lib.dmb_sim_advance_to_event
_steps_to_event = _lib.dmb_sim_steps_to_event
_step, _steps, _advance, _set_status = _lib.dmb_sim_step, _lib.dmb_sim_steps, _lib.dmb_sim_advance, object.__setattr__


def _word(function: Any) -> str:
    """ "pose" of dmb_query_pose, "recorder take" of dmb_recorder_take"""
    return str(function.__name__).replace("dmb_query_", "").replace("dmb_", "").replace("_", " ")


def _offset(offset: Any) -> Any:
    return (c_double * 3)(*reals(offset, "place", "offset", 3, "m"))


class Sim(Handle, analysis.Analyses):
    """All that changes. One thread at a time; the library does not hold Python's lock while it runs. In the main thread
    Ctrl-C ends advance and the analyses: KeyboardInterrupt, with the sim whole."""
    _kind = "sim"

    def __init__(self, model: Model, options: SimOptions | None = None,
                 log: Callable[[int, str], None] | None = None, **fields: Any) -> None:
        self._handle = c_void_p()
        self._keep = Keep()  # its own log
        self._inputs, self._events = model.inputs(), model.events()
        self._log: InputLog | None = None
        self._scene, self._parts = model._keep, model._parts  # callbacks live as long as the last sim
        self._teller = Teller()
        options = struct(SimOptions, options, fields)
        if log is not None:
            options.log = self._keep.log(log)
        status = _lib.dmb_sim_create(model._handle, byref(options), byref(self._handle))
        if is_closed(model._handle, status):
            raise closed("model")
        message = _lib.dmb_model_message(model._handle)
        self._keep.check(OK, b"")
        self.status = self._scene.check(status, message)

    def __repr__(self) -> str:
        if not self._handle:
            return "<Sim, closed>"
        return f"<Sim of {sum(self._parts.pipes.values())} pipes at {self.time:g} s, {self.statistics().steps} steps>"

    def __reduce__(self) -> Any:
        raise TypeError("a Sim does not pickle: pickle its model and sim.snapshot(), which a sim of that model "
                        "restores")

    @property
    def message(self) -> str:
        """The message of the last failing or noteworthy call on this sim."""
        return in_python(_lib.dmb_sim_message(self._handle).decode())

    @property
    def time(self) -> float:
        """[s] of the last accepted state"""
        if not self._handle:
            raise closed("sim")
        return float(_lib.dmb_sim_time(self._handle))

    @property
    @mirrors("dmb_sim_set_progress")
    def on_progress(self) -> Callable[[float], Any] | None:
        """function(fraction): called with 0 .. 1 at bounded intervals of step, advance and analyses. It ends the call
        by returning True (ERR_CANCELLED; advance returns NOTE_CANCELLED) or by raising, which comes out of the call.
        None: no callback (default)."""
        return self._teller.function

    @on_progress.setter
    def on_progress(self, function: Callable[[float], Any] | None) -> None:
        check(self._teller.set(self._handle, function))

    @property
    @mirrors("dmb_sim_set_on_step")
    def on_step(self) -> Callable[[float], Any] | None:
        """function(time): called after each accepted step of step, steps, steps_to_event, advance, advance_to_event
        and run; it may query and record the sim. It ends the call by returning True (NOTE_STOPPED before its end) or by
        raising, which comes out of the call. None: no callback (default)."""
        return self._teller.on_step

    @on_step.setter
    def on_step(self, function: Callable[[float], Any] | None) -> None:
        check(self._teller.set_on_step(self._handle, function))

    def _check(self, status: int) -> int:
        try:
            self._teller.rethrow()  # what the progress function raised
        except BaseException:
            self._scene.forget()
            raise
        if is_closed(self._handle, status):
            raise closed("sim")
        return self._scene.check(status, _lib.dmb_sim_message(self._handle) if status < 0 else b"")

    # ---- Running ----------------------------------------------------------------------------------------------------
    @mirrors("dmb_sim_step")
    def step(self, duration: float) -> StepReport:
        """Advances by duration [s]; returns the report, whose status may be a note."""
        report: StepReport = StepReport.blank()
        try:
            if self._scene.references:  # Python's handler would raise where C has called, and be lost there
                status = self._teller.long_call(self._handle, _step, real(duration, "step", "duration", "s"),
                                                byref(report))
            else:
                status = _step(self._handle, duration, byref(report))
        except ctypes.ArgumentError:
            status = _step(self._handle, real(duration, "step", "duration", "s"), byref(report))
        _set_status(report, "status", self._check(status))
        return report

    @mirrors("dmb_sim_steps")
    def steps(self, duration: float, count: int) -> StepReport:
        """Advances by `count` equal steps of `duration` [s]; returns the report of all, whose status may be a note."""
        report: StepReport = StepReport.blank()
        arguments = real(duration, "steps", "duration", "s"), whole(count, "steps", "count"), None, byref(report)
        if self._scene.references and not INTERRUPTS.holding:  # as in step
            status = self._teller.long_call(self._handle, _steps, *arguments)
        else:
            status = _steps(self._handle, *arguments)
        _set_status(report, "status", self._check(status))
        return report

    @mirrors("dmb_sim_advance")
    def advance(self, time: float) -> StepReport:
        """Advances to time [s] with steps of its own choice."""
        report: StepReport = StepReport.blank()
        time = real(time, "advance", "time", "s")
        _set_status(report, "status", self._check(self._teller.long_call(self._handle, _advance, time, byref(report))))
        return report

    @mirrors("dmb_sim_advance_to_event")
    def advance_to_event(self, time: float) -> list[str]:
        """Advances to the first event before time [s]: the names of the events there, at sim.time. None: [], and
        the sim is at `time`, or where its max_steps or the progress function ended it."""
        report: EventReport = EventReport.blank()
        self._check(self._teller.long_call(self._handle, _advance_to_event, real(time, "advance", "time", "s"),
                                           byref(report), None))
        return [name for i, name in enumerate(self._events) if report.events >> i & 1]

    @mirrors("dmb_sim_steps_to_event")
    def steps_to_event(self, duration: float, count: int) -> tuple[list[str], float]:
        """Advances by equal steps of `duration` [s], at most `count`, and ends after the step with the first event: the
        names of the events in it and the time [s] of the crossing, interpolated within the step. None: [], nan."""
        report: EventReport = EventReport.blank()
        self._check(self._teller.long_call(self._handle, _steps_to_event, real(duration, "steps", "duration", "s"),
                                           whole(count, "steps", "count"), None, byref(report), None))
        return [name for i, name in enumerate(self._events) if report.events >> i & 1], report.crossing

    def run(self, end: float, step: float | None = None, recorder: Recorder | None = None,
            progress: Callable[[Progress], Any] | bool | None = None, every: float = 0.2,
            counters: Sequence[Taker] = (), begin: float | None = None) -> Progress:
        """Runs to time `end` [s]: with equal steps of `step` [s] (a last one shorter where they do not fit; a millionth
        of a step counts as none), or with steps of the library's choice, which then end at each hundredth of the run.
        The recorder takes a row after each step, and so do counters: objects with a take(), as fatigue and windows.
        progress(Progress) is called each `every` seconds by the clock and at the end; True, if it is returned, stops
        the run there; True shows a bar on the terminal. Ctrl-C raises KeyboardInterrupt: the sim stays whole and can
        continue, and the recorder has all rows so far. The result has the notes of all steps; a full recorder, and
        steps above their tolerance, are a RuntimeWarning too. begin: of a run
        that continues from a snapshot, the time [s] where it began, by which its calls are divided; left out: now."""
        at = self.run_noting(end, step, recorder, progress, every, counters, begin)
        warn_of(at)
        return at

    def run_noting(self, end: float, step: float | None = None, recorder: Recorder | None = None,
                   progress: Callable[[Progress], Any] | bool | None = None, every: float = 0.2,
                   counters: Sequence[Taker] = (), begin: float | None = None) -> Progress:
        """As run, without warnings: the notes are in the result alone."""
        end = real(end, "run", "end", "s")
        begin = self.time if begin is None else real(begin, "run", "begin", "s")
        lengths = Lengths(begin, end, None if step is None else real(step, "run", "step", "s"))
        takers = own_takers(self, recorder, counters)
        if progress is not None and progress is not True and not callable(progress):
            refuse_type("run", "progress", progress, "be a function of a Progress, or True for a bar")
        bar = Bar(begin, end) if progress is True else None
        if recorder is not None and len(recorder) == 0:
            recorder.take()
        try:
            return Loop(self, lengths, takers, bar if bar is not None else progress if callable(progress) else None,
                        every).go()
        finally:
            if bar is not None:
                bar.close()

    @mirrors("dmb_sim_set_drive")
    def set_drive(self, drive: DriveId | str, value: float | None) -> None:
        """The drive's time function is the constant value [its unit] from now on; None: its time function again."""
        setting = float("nan") if value is None else real(value, "drive", "value")
        if value is not None and not math.isfinite(setting):
            refuse_value("drive", "value", setting, "be finite, or None for its time function")
        self._check(_lib.dmb_sim_set_drive(self._handle, as_id(drive, self._parts, "drive"), setting))

    @property
    def inputs(self) -> Inputs:
        """The values of the model's inputs, by name: sim.inputs["rotation"] = 12.0; units in sim.inputs.info."""
        return Inputs(self)

    @mirrors("dmb_sim_set_joint")
    def set_joint(self, joint: JointId | str, state: int) -> int:
        """The joint is JOINT_ACTIVE, JOINT_LOCKED or JOINT_OPEN from now on; returns the status, NOTE_PROJECTED if
        speeds changed."""
        return self._check(_lib.dmb_sim_set_joint(self._handle, as_id(joint, self._parts, "joint"),
                                                  whole(state, "joint", "state", 0, 2)))

    @mirrors("dmb_sim_transfer_state")
    def transfer_state(self, other: Sim) -> int:
        """Continues from the state of `other`, a sim of another model: pipes may have come or gone at the rig end."""
        if not isinstance(other, Sim):
            refuse_type("state transfer", "other", other, "be a Sim")
        return self._check(_lib.dmb_sim_transfer_state(self._handle, other._handle))

    carry_over = transfer_state  # its name before

    @mirrors("dmb_sim_snapshot")
    def snapshot(self) -> bytes:
        """All that changes, as bytes; a copy."""
        size = c_size_t()
        self._check(_lib.dmb_sim_snapshot_size(self._handle, byref(size)))
        block = ctypes.create_string_buffer(size.value)
        self._check(_lib.dmb_sim_snapshot(self._handle, block, size.value))
        return block.raw

    @mirrors("dmb_sim_restore")
    def restore(self, snapshot: Any) -> None:
        """Goes back, or on, to a snapshot of a sim of the same model and options."""
        if isinstance(snapshot, (str, int)) or not hasattr(snapshot, "__len__"):
            refuse_type("snapshot", "snapshot", snapshot, "be bytes of Sim.snapshot")
        snapshot = bytes(snapshot)
        self._check(_lib.dmb_sim_restore(self._handle, snapshot, len(snapshot)))

    @mirrors("dmb_sim_hash")
    def hash(self) -> int:
        """A number that is equal for equal states."""
        found = c_uint64()
        self._check(_lib.dmb_sim_hash(self._handle, byref(found)))
        return found.value

    # ---- Queries ----------------------------------------------------------------------------------------------------
    def _query(self, function: Any, result: Any, *arguments: Any) -> Any:
        status = function(self._handle, *arguments, byref(result))
        if status < 0:
            self._told(status, function, *arguments)
        _set_status(result, "status", status)
        return result

    def _told(self, status: int, function: Any, *arguments: Any) -> int:
        """The status, or an Error for a part or place that does not fit: queries have no message of their own."""
        if is_closed(self._handle, status):
            raise closed("sim")
        if status < 0:
            raise Error(status, self._parts.why(status, _word(function), arguments))
        return status

    def _query_number(self, function: Any, *arguments: Any) -> float:
        value = c_double()
        self._told(function(self._handle, *arguments, byref(value)), function, *arguments)
        return value.value

    def pose(self, place: Place | Id | str) -> Pose:
        """Position [m], rotation matrix, displacement [m] and measured depth [m] of a place."""
        result: Pose = self._query(_lib.dmb_query_pose, Pose.blank(), as_place(place, self._parts))
        return result

    def motion(self, place: Place | Id | str, frame: int = FRAME_WORLD) -> Motion:
        """Velocity [m/s, rad/s] and acceleration [m/s2, rad/s2] of a place, each six numbers, in `frame`."""
        result: Motion = self._query(_lib.dmb_query_motion, Motion(frame=frame), as_place(place, self._parts))
        return result

    def pose_at(self, place: Place | Id | str, offset: Sequence[float]) -> Pose:
        """The pose of a point `offset` [m] away from a place, in its axes."""
        result: Pose = self._query(_lib.dmb_query_pose_at, Pose.blank(), as_place(place, self._parts), _offset(offset))
        return result

    def motion_at(self, place: Place | Id | str, offset: Sequence[float], frame: int = FRAME_WORLD) -> Motion:
        """The motion of a point `offset` [m] away from a place, in its axes."""
        result: Motion = self._query(_lib.dmb_query_motion_at, Motion(frame=frame), as_place(place, self._parts),
                                     _offset(offset))
        return result

    def rotation(self, place: Place | Id | str) -> float:
        """[rad] about the pipe's own axis since time 0, revolutions counted"""
        return self._query_number(_lib.dmb_query_rotation, as_place(place, self._parts))

    @mirrors("dmb_query_section")
    def section(self, place: Place | Id | str) -> Section:
        """Forces [N, N m] and strains of a section, six numbers each."""
        result: Section = self._query(_lib.dmb_query_section, Section.blank(), as_place(place, self._parts))
        return result

    def contact(self, number: int) -> Contact:
        """Gap [m], forces [N] and slip [m/s] at contact point number `number`, of info().contact_points."""
        number = index_of("contact", "number", number, self._parts.sites)
        result: Contact = self._query(_lib.dmb_query_contact, Contact.blank(), number)
        return result

    def contact_total(self) -> Any:
        """Sums over all contact points: closed ones, normal force [N], friction [N], deepest penetration [m]."""
        return self._query(_lib.dmb_query_contact_total, STRUCTS["dmb_contact_total"]())


    @mirrors("dmb_query_hole_now")
    def hole(self, depth: float) -> HolePoint:
        """The hole at a measured depth [m] as its cutters have left it up to now."""
        point: HolePoint = HolePoint.blank()
        depth = real(depth, "hole", "depth", "m")
        if not math.isfinite(depth):
            refuse_value("hole", "depth", depth, "be finite")
        self._check(_lib.dmb_query_hole_now(self._handle, depth, byref(point)))
        return point

    def kinetic_energy(self, part: Id | str, pipe: int = 0) -> float:
        """[J] of one pipe of a string, or of a body"""
        return self._query_number(_lib.dmb_query_kinetic_energy, as_id(part, self._parts),
                                  whole(pipe, "kinetic energy", "pipe"))

    @mirrors("dmb_query_energy")
    def energy(self) -> Energy:
        """The energy ledger [J]."""
        result: Energy = self._query(_lib.dmb_query_energy, Energy.blank())
        return result

    def momentum(self) -> Momentum:
        """Linear [kg m/s] and angular [kg m2/s] momentum, mass [kg] and its centre [m]."""
        result: Momentum = self._query(_lib.dmb_query_momentum, Momentum.blank())
        return result

    def drive(self, drive: DriveId | str) -> DriveState:
        """Target, position, speed, force, power [W] and work [J] of a drive."""
        result: DriveState = self._query(_lib.dmb_query_drive, DriveState.blank(), as_id(drive, self._parts, "drive"))
        return result

    def reaction(self, part: Id | str) -> list[float]:
        """[N, N m] of support and motion drives on the rig end of a string or a body, body frame, six numbers"""
        values, part = (c_double * 6)(), as_id(part, self._parts)
        self._told(_lib.dmb_query_reaction(self._handle, part, values), _lib.dmb_query_reaction, part)
        return list(values)

    def joint(self, joint: JointId | str, frame: int = FRAME_WORLD) -> JointState:
        """Coordinates, rates, reaction [N, N m] and action of a joint, six numbers each."""
        result: JointState = self._query(_lib.dmb_query_joint, JointState(frame=frame),
                                         as_id(joint, self._parts, "joint"))
        return result

    def multipliers(self, part: Id | str) -> list[float]:
        """[N, N m per unit of its value] of a joint, coupling, constraint or joint drive, one for each row"""
        values, count, part = (c_double * 6)(), c_uint32(), as_id(part, self._parts)
        self._told(_lib.dmb_query_multipliers(self._handle, part, values, byref(count)), _lib.dmb_query_multipliers,
                   part)
        return list(values)[:count.value]

    def spring(self, spring: SpringId | str) -> SpringState:
        """Length, elongation [m], force [N], its shares and energy [J] of a spring."""
        result: SpringState = self._query(_lib.dmb_query_spring, SpringState.blank(),
                                          as_id(spring, self._parts, "spring"))
        return result

    def stuck(self, stuck: StuckId | str) -> StuckState:
        """Whether a place is stuck; offset, force that holds it, share of the release load."""
        result: StuckState = self._query(_lib.dmb_query_stuck, StuckState.blank(), as_id(stuck, self._parts, "stuck"))
        return result

    def flow(self) -> FlowState:
        """Pressures [Pa] of the mud that flows, its drag and thrust [N], stretch by pressure [m]."""
        result: FlowState = self._query(_lib.dmb_query_flow, FlowState.blank())
        return result

    def bit(self, bit: BitId | str) -> BitState:
        """Advance [m], depth of cut [m], weight [N] and torque [N m] of a bit."""
        result: BitState = self._query(_lib.dmb_query_bit, BitState.blank(), as_id(bit, self._parts, "bit"))
        return result

    def statistics(self) -> Statistics:
        """Steps, iterations and memory so far."""
        result: Statistics = self._query(_lib.dmb_query_statistics, Statistics.blank())
        return result

    # ---- Tables and files -------------------------------------------------------------------------------------------
    def recorder(self, outputs: Sequence[Any], capacity: int, interval: float = 0.0,
                 window: Window | None = None) -> Recorder:
        """A Recorder of `capacity` rows, one each `interval` [s] or (0) for each take(); window for outputs of one."""
        return Recorder(self, outputs, capacity, interval, window)

    @mirrors("dmb_query_output")
    def output(self, quantity: Any, place: Any = None) -> float:
        """The value of an output by its name or number at a place, or of a part; None: the first string, or none. Place
        and quantity may stand in the order of a recorder's pair too: output(place, "bit_speed")."""
        if isinstance(quantity, (Place, Id)):
            quantity, place = place, quantity
        requested, value = (quantity if isinstance(quantity, Output) else output_of((place, quantity), self._parts),
                            c_double())
        self._check(_lib.dmb_output_check(self._handle, byref(requested), 1))
        self._told(_lib.dmb_query_output(self._handle, byref(requested), byref(value)), _lib.dmb_query_output)
        return value.value

    @mirrors("dmb_window_create")
    def window(self, outputs: Sequence[Any], length: float = 0.0, slots: int = 100,
               levels: Sequence[float] | None = None) -> Window:
        """A Window over the last `length` [s] (0: all) of outputs, pairs (place, "bit_speed")."""
        from .window import Window
        return Window(self, outputs, WindowOptions(length=length, slots=slots), levels)

    def sensitivity(self, parameters: Mapping[str, tuple[Sim, Sim, float]], one_sided: bool = False) -> Sensitivity:
        """A Sensitivity of this sim by parameters {"friction": (low, high, step)}."""
        from .sensitivity import Sensitivity
        return Sensitivity(self, parameters, one_sided)

    def state_equation(self) -> StateEquation:
        """y' = f(t, y) of the scene from the present state on, for integrators of others: a StateEquation."""
        from .state_equation import StateEquation
        return StateEquation(self)

    def profile_recorder(self, quantities: Sequence[int], stations: int | Sequence[float], capacity: int,
                         interval: float = 0.0, string: StringId | str | None = None) -> ProfileRecorder:
        """A ProfileRecorder of `capacity` rows of quantities PROFILE_... at stations of a string."""
        return ProfileRecorder(self, quantities, stations, capacity, interval, string)

    def profile(self, string: StringId | str | None = None, pipes: int | None = None, per_pipe: int = 2) -> Profile:
        """A string (None: the first) from end to end as arrays: poses, forces and contact at `per_pipe` stations of
        each of its pipes and at its rig end. pipes: their number; left out: as described."""
        from .profile import profile
        requested = self._parts.first_string() if string is None else as_id(string, self._parts, "string")
        return profile(self, requested, self._parts.pipes.get(requested.index, 0) if pipes is None else pipes, per_pipe)

    @mirrors("dmb_query_profile_extremes")
    def profile_extremes(self, quantities: Sequence[int], string: StringId | str | None = None,
                         pipes: int | None = None, per_pipe: int = 2) -> dict[int, Extremes]:
        """Least and largest value of each quantity PROFILE_... over the stations of `profile`, and their distances."""
        from .profile import extremes_of
        requested = self._parts.first_string() if string is None else as_id(string, self._parts, "string")
        count = self._parts.pipes.get(requested.index, 0) if pipes is None else pipes
        return dict(zip(quantities, extremes_of(self, requested, quantities, count=count * per_pipe + 1)))

    @mirrors("dmb_analysis_state_space")
    def state_space(self, inputs: Sequence[Excitation] = (), outputs: Sequence[Any] = (),
                    options: StateSpaceOptions | None = None, modes: analysis.Modes | None = None,
                    mode_list: Sequence[int] | None = None, **fields: Any) -> StateSpace:
        """The linearised scene from every Input to every Output as A, B, C, D; with modes reduced to these, or to those
        of mode_list."""
        from .state_space import StateSpace
        return StateSpace(self, inputs, outputs, struct(StateSpaceOptions, options, fields), modes, mode_list)

    @property
    def arrays(self) -> Arrays:
        """The state as numpy arrays, and the map from places to rows."""
        from .state_space import Arrays
        return Arrays(self)

    @mirrors("dmb_fatigue_create")
    def fatigue(self, places: Sequence[Any], options: FatigueOptions | None = None, **fields: Any) -> Fatigue:
        """A Fatigue of places on flexible pipes; curve_stress [Pa] and slope of the S-N curve must be given."""
        from .fatigue import Fatigue
        return Fatigue(self, places, struct(FatigueOptions, options, fields))

    def string_fatigue(self, string: StringId | str, pipes: int | None = None, **fields: Any) -> StringFatigue:
        """A StringFatigue of the pipes of a string; fields as of fatigue."""
        from .fatigue import StringFatigue
        requested = as_id(string, self._parts, "string")
        count = self._parts.pipes.get(requested.index, 0) if pipes is None else pipes
        return StringFatigue(self, requested, count, **fields)

    @mirrors("dmb_write_vtk_strings")
    def write_vtk(self, path: Any, per_element: int = 8) -> None:
        """Writes the strings as lines with fields for ParaView."""
        written(path, self._handle, _lib.dmb_write_vtk_strings(self._handle,
                                                               whole(per_element, "strings", "per_element", 1),
                                                               path_of(path)))


class SimAt(Sim):
    """A sim that the library lends to a callback, or that `owner` owns."""

    def __init__(self, of: Sim, handle: Any, owner: Any = None) -> None:
        self._handle, self._keep, self._scene, self._parts = c_void_p(handle), of._keep, of._scene, of._parts
        self._teller, self._owner = of._teller, owner

    def close(self) -> None:
        """Nothing is destroyed: it is not ours."""
        self._handle = None  # type: ignore[assignment]


__all__ = ["Progress", "Sim", "as_place"]
