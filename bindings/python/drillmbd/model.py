"""A scene: describe, compile. The description is kept, so a model copies, compares and pickles."""
from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_double, c_size_t, c_uint32, c_void_p, create_string_buffer, pointer
from typing import TYPE_CHECKING, Any, cast

from ._handle import Handle
from ._keep import Keep, as_id, mirrors, path_of, struct, written
from ._library import lib as _lib
from ._parts import Parts, closed, is_closed
from ._record import Record
from ._structs import (BitDef, BodyDef, Output, CompileOptions, ConstraintDef, CouplingDef, DriveDef, EnvironmentDef,
                       EventDef, ForceDef, HolePoint, HoleSection, Id, InputDef, InputInfo, JointDef, LoadDef, ModelInfo,
                       ModelOptions, Motor, PipeDef, Place, StabiliserDef, SimOptions, SpringDef, StringDef, StuckDef, Sub,
                       SubDef, Segment, TimeFunctionId, WallDef)
from ._values import real, refuse_type, refuse_value, whole
from .enums import ERR_ORDER, FRICTION_CALLBACK, NAME_SIZE, SEGMENT_STEP5, PartKind, Status
from .errors import Error, check, in_python, last_message, status_text

if TYPE_CHECKING:
    from ._typed import ModelCalls
    from .sim import Sim
else:
    ModelCalls = object


class Model(Handle, ModelCalls):
    """A scene. Describe it with the add_ functions, compile it once, then make any number of sims of it.

    `calls` is the description: pairs of the method's name and its arguments. copy.copy and pickle make a model by the
    same calls; its parts have ids of their own, which `own` finds. A log function is not taken along."""
    _kind = "model"

    def __init__(self, log: Callable[[int, str], None] | None = None) -> None:
        self._keep = Keep()
        self._handle = c_void_p()
        self.calls: list[tuple[str, tuple[Any, ...]]] = []
        self.ids: list[Id] = []  # given out so far, in the order of their calls
        self._parts, self._compiled = Parts(), False
        options = ModelOptions()
        if log is not None:
            options.log = self._keep.log(log)
        self._keep.check(_lib.dmb_model_create(byref(options), byref(self._handle)), b"")

    # ---- Life -------------------------------------------------------------------------------------------------------
    def __reduce__(self) -> Any:
        return remake, (type(self), self.calls)

    def __copy__(self) -> Model:
        return remake(type(self), self.calls)

    def __deepcopy__(self, memo: Any) -> Model:
        return remake(type(self), self.calls)

    def same_scene(self, other: Model) -> bool:
        """True where both have the same description: parts of a kind in the same order, kinds in any order."""
        def bare(model: Model) -> Any:
            found: dict[str, list[Any]] = {}
            for name, arguments in model.calls:
                if name in ("set_environment", "compile") and arguments == ({},):  # all at the defaults, as without the call
                    continue
                found.setdefault(name, []).append(map_ids(arguments, lambda part: (part.index, bool(part))))
            return found
        return bool(bare(self) == bare(other))

    def own(self, part: Any) -> Any:
        """The part (or place) of this model that `part` is in the model that this one was copied from."""
        generation = self.ids[0].generation if self.ids else 0
        return map_ids(part, lambda one: Id(one.index, generation) if one else Id())

    # ---- Calls ------------------------------------------------------------------------------------------------------
    @property
    def message(self) -> str:
        """The message of the last failing or noteworthy call on this model."""
        return in_python(_lib.dmb_model_message(self._handle).decode())

    def _check(self, status: int) -> int:
        if status >= 0:
            return self._keep.check(status, b"")
        if is_closed(self._handle, status):
            raise closed("model")
        if self._compiled:  # its message is that of the compilation
            raise Error(status, "model: state = compiled, must be one that is still described; add parts before compile()"
                        if status == ERR_ORDER else status_text(status))
        message = _lib.dmb_model_message(self._handle)
        _lib.dmb_model_clear_refused(self._handle)  # the exception says it; compile need not repeat it
        return self._keep.check(status, message)

    def _given(self, part: Id, pipes: int = 0) -> Id:
        self.ids.append(part)
        self._parts.add(part, pipes)
        return part

    def _note(self, name: str, *arguments: Any) -> None:
        self.calls.append((name, tuple(one.describe() if isinstance(one, Record) and not isinstance(one, Id) else one
                                       for one in arguments)))

    def _add(self, kind: str, cls: Any, given: Any, fields: dict[str, Any]) -> Id:
        part, definition = Id(), struct(cls, given, fields)
        self._check(getattr(_lib, "dmb_model_add_" + kind)(self._handle, byref(definition), byref(part)))
        self._note("add_" + kind, definition)
        return self._given(part)

    @mirrors("dmb_model_write")
    def record(self) -> bytes:
        """The scene record, which C programs read by dmb_model_read."""
        size = c_size_t()
        status = _lib.dmb_model_write(self._handle, None, 0, byref(size))
        found = create_string_buffer(size.value)
        if status >= 0:
            status = _lib.dmb_model_write(self._handle, found, size, byref(size))
        if is_closed(self._handle, status):
            raise closed("model")
        check(status, last_message() if status < 0 else b"")
        return found.raw

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_model_set_environment")
        def set_environment(self, definition: EnvironmentDef | None = None, **fields: Any) -> None:
            """Sets gravity [m/s2], fluid and damping, by an EnvironmentDef or its fields."""
            definition = struct(EnvironmentDef, definition, fields)
            self._check(_lib.dmb_model_set_environment(self._handle, byref(definition)))
            self._note("set_environment", definition)

    @mirrors("dmb_model_add_time_function")
    def add_time_function(self, *segments: Any) -> TimeFunctionId:
        """A time function of one or more segments. A number is a constant segment, a function of time a callback."""
        made = [self._segment(number, segment) for number, segment in enumerate(segments)]
        array, part = (Segment * len(segments))(*made), Id()
        self._check(_lib.dmb_model_add_time_function(self._handle, array, len(segments), byref(part)))
        self._note("add_time_function", *made)
        return cast(TimeFunctionId, self._given(part))

    @mirrors("dmb_model_add_ramp")
    def add_ramp(self, before: float, after: float, start: float = 0.0, end: float = 1.0) -> TimeFunctionId:
        """A time function that is `before` up to `start` [s], `after` from `end` on, and smooth between."""
        return self.add_time_function(Segment(kind=SEGMENT_STEP5, h0=before, h1=after, x0=start, x1=end))

    def _segment(self, number: int, segment: Any) -> Any:
        if callable(segment):
            segment = Segment(function=segment)
        elif not isinstance(segment, Segment):
            segment = Segment(h0=real(segment, f"segment {number} of a time function", "value"))
        if segment._function is not None:
            segment.callback = self._keep.time_function(segment._function, segment.provides)
        return segment

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        def add_wall(self, definition: WallDef | None = None, **fields: Any) -> Id:
            """Adds the hole, by a WallDef or its fields; returns its id. One hole a model. friction: a law of one's own, a
            function of a FrictionAt that returns force, derivatives by slip (2, 2) and by normal force; with
            friction_state_count > 0 also of the accepted state and the step [s], and the new state comes last."""
            function, accept = fields.pop("friction", None), fields.pop("friction_accept", None)
            if function is not None or accept is not None:
                definition = struct(WallDef, definition, fields)
                fields, states = {}, definition.friction_state_count
                if function is not None:
                    definition.friction_law, definition.friction_callback = FRICTION_CALLBACK, self._keep.friction(function, states)
                if accept is not None:
                    definition.friction_accept = self._keep.accept(accept, states)
            return self._add("wall", WallDef, definition, fields)

    @mirrors("dmb_model_add_hole_sections")
    def add_hole_sections(self, *sections: Any) -> None:
        """Sections of the hole below those there are, each a HoleSection or a dict of its fields."""
        made = [one if isinstance(one, HoleSection) else HoleSection(**one) for one in sections]
        array = (HoleSection * len(made))(*made)
        self._check(_lib.dmb_model_add_hole_sections(self._handle, array, len(made)))
        self._note("add_hole_sections", *made)

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_model_add_string")
        def add_string(self, definition: StringDef | None = None, **fields: Any) -> Id:
            """Adds a string without pipes, by a StringDef or its fields; returns its id."""
            return self._add("string", StringDef, definition, fields)

        @mirrors("dmb_model_add_pipes")
        def add_pipes(self, count: int = 1, definition: PipeDef | None = None, **fields: Any) -> Id:
            """Appends `count` equal pipes, by a PipeDef or its fields; returns the string they belong to."""
            string, definition = Id(), struct(PipeDef, definition, fields)
            count = whole(count, "pipes", "count")
            self._check(_lib.dmb_model_add_pipes(self._handle, byref(definition), count, byref(string)))
            self._note("add_pipes", count, definition)
            self._given(string, count)
            self._parts.add_end(string, definition.joint_length / definition.length)
            return string

        def add_body(self, definition: BodyDef | None = None, **fields: Any) -> Id:
            """Adds a rigid body, by a BodyDef or its fields; returns its id."""
            return self._add("body", BodyDef, definition, fields)

    @mirrors("dmb_model_place_at_end")
    def place_at_end(self, string: Id | None = None, length: float = 0.0, body: BodyDef | None = None,
               section: StringDef | None = None) -> None:
        """Fills poses and velocities of a body and the start of a section `length` [m] behind a string's end so far."""
        self._check(_lib.dmb_model_place_at_end(self._handle, string or Id(), length, body and byref(body), section and byref(section)))

    @mirrors("dmb_model_add_sub")
    def add_sub(self, string: Id | None = None, length: float = 0.0, body: BodyDef | None = None,
                before: JointDef | None = None, after: JointDef | None = None, section: StringDef | None = None) -> Sub:
        """Adds a body behind a string's end so far and a section `length` [m] further; ids: body, section, before, after."""
        body = BodyDef.from_buffer_copy(struct(BodyDef, body, {}))  # the caller's stay as they are
        section = StringDef.from_buffer_copy(struct(StringDef, section, {}))
        joints = [JointDef.from_buffer_copy(struct(JointDef, one, {})) for one in (before, after)]
        self.place_at_end(string, 0.0, body)
        self.place_at_end(string, length, None, section)
        made: Sub = Sub.blank()
        sub_definition = SubDef(length=length)
        sub_definition.string = string or Id()
        sub_definition.body, sub_definition.section = pointer(body), pointer(section)
        sub_definition.before, sub_definition.after = (pointer(one) for one in joints)
        self._check(_lib.dmb_model_add_sub(self._handle, byref(sub_definition), byref(made)))
        joints[0].place_a, joints[0].place_b = made.end, Place(made.body, 0, 0, 0.0)
        joints[1].place_a, joints[1].place_b = Place(made.body, 0, 0, 0.0), Place(made.section, 0, 0, 0.0)
        joints[1].origin_a[0] += length
        for joint in joints:
            joint.match = 1
        for kind, definition, part in (("body", body, made.body), ("string", section, made.section),
                                       ("joint", joints[0], made.before), ("joint", joints[1], made.after)):
            self._note("add_" + kind, definition)
            self._given(part)
        return made

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        def add_bit(self, definition: BitDef | None = None, **fields: Any) -> Id:
            """Adds a bit at the far end of a string, by a BitDef or its fields; returns its id."""
            return self._add("bit", BitDef, definition, fields)

        @mirrors("dmb_model_add_stabiliser")
        def add_stabiliser(self, definition: StabiliserDef | None = None, **fields: Any) -> Id:
            """Adds a stabiliser at any place of a string, by a StabiliserDef or its fields; returns its id."""
            return self._add("stabiliser", StabiliserDef, definition, fields)

        @mirrors("dmb_model_add_joint")
        def add_joint(self, definition: JointDef | None = None, **fields: Any) -> Id:
            """Adds a joint between place_a (None: the ground) and place_b, by a JointDef or its fields; returns its id."""
            return self._add("joint", JointDef, definition, fields)

        def add_coupling(self, definition: CouplingDef | None = None, **fields: Any) -> Id:
            """Adds a gear or screw between two joint coordinates, by a CouplingDef or its fields; returns its id."""
            return self._add("coupling", CouplingDef, definition, fields)

        def add_constraint(self, definition: ConstraintDef | None = None, **fields: Any) -> Id:
            """Adds a constraint on poses that a Python function says, by a ConstraintDef or its fields; returns its id."""
            definition = struct(ConstraintDef, definition, fields)
            if definition._function is not None:
                definition.callback = self._keep.constraint(definition._function, definition.row_count, definition.provides)
            return self._add("constraint", ConstraintDef, definition, {})

        def add_drive(self, definition: DriveDef | None = None, **fields: Any) -> Id:
            """Adds a drive of a component of motion, by a DriveDef or its fields; returns its id."""
            return self._add("drive", DriveDef, definition, fields)

        def add_load(self, definition: LoadDef | None = None, **fields: Any) -> Id:
            """Adds a force [N] and moment [N m] at a place, by a LoadDef or its fields; returns its id."""
            return self._add("load", LoadDef, definition, fields)

        @mirrors("dmb_model_add_input")
        def add_input(self, definition: InputDef | None = None, **fields: Any) -> Id:
            """Adds an input that sims set by Sim.inputs[name], by an InputDef or its fields; returns its id."""
            return self._add("input", InputDef, definition, fields)

        def add_spring(self, definition: SpringDef | None = None, **fields: Any) -> Id:
            """Adds a spring and damper between two points, by a SpringDef or its fields; `table` takes pairs (elongation [m],
            force [N]). Returns its id."""
            return self._add("spring", SpringDef, definition, fields)

        def add_stuck(self, definition: StuckDef | None = None, **fields: Any) -> Id:
            """Adds a place that can be stuck, by a StuckDef or its fields; returns its id."""
            return self._add("stuck", StuckDef, definition, fields)

        @mirrors("dmb_model_add_event")
        def add_event(self, definition: EventDef | None = None, **fields: Any) -> Id:
            """Adds an event that Sim.advance_to_event stops at, by an EventDef or its fields; returns its id."""
            return self._add("event", EventDef, definition, fields)

        def add_force(self, definition: ForceDef | None = None, **fields: Any) -> Id:
            """Adds a force that a Python function gives by poses, velocities and time, by a ForceDef or its fields. accept:
            a function of time, 0 and the state, called after each accepted step."""
            accept = fields.pop("accept", None)
            definition = struct(ForceDef, definition, fields)
            if accept is not None:
                definition.accept = self._keep.accept(accept, definition.state_count)
            if definition._function is not None:
                definition.callback = self._keep.force(definition._function, definition.provides, definition.state_count)
            return self._add("force", ForceDef, definition, {})

    @mirrors("dmb_model_set_name")
    def set_name(self, part: Id, name: str) -> None:
        """Gives a part a name, or none by ""; most have one by the field `name` of their definition."""
        self._check(_lib.dmb_model_set_name(self._handle, part, name.encode()))
        self._note("set_name", part, name)

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_model_compile")
        def compile(self, options: CompileOptions | None = None, **fields: Any) -> int:
            """Checks and freezes the scene; returns the status."""
            options = struct(CompileOptions, options, fields)
            status = self._check(_lib.dmb_model_compile(self._handle, byref(options)))
            self._parts.sites, self._compiled = self.info().contact_points, True
            for part in dict.fromkeys(self.ids):
                name = self.name_of(part)
                if name:
                    self._parts.names.setdefault(name, []).append(part)
            self._note("compile", options)
            return status

    @mirrors("dmb_model_clear_refused")
    def clear_refused(self) -> None:
        """Continues without the parts whose add_ raised an Error: compile refuses otherwise."""
        self._check(_lib.dmb_model_clear_refused(self._handle))

    def __repr__(self) -> str:
        if not self._handle:
            return "<Model, closed>"
        pipes = sum(arguments[0] for name, arguments in self.calls if name == "add_pipes")
        return f"<Model of {pipes} pipes, {'compiled' if self._compiled else 'described'}>"

    # ---- Queries ----------------------------------------------------------------------------------------------------
    @mirrors("dmb_model_get_info")
    def info(self) -> ModelInfo:
        """Counts, mass [kg], length [m] and memory of the compiled scene."""
        info = ModelInfo()
        info.status = self._check(_lib.dmb_model_get_info(self._handle, byref(info)))
        return info

    @mirrors("dmb_analysis_mesh")
    def mesh_errors(self, string: Id, pipes: int) -> list[float]:
        """Estimated discretisation error of each pipe of a string that lies on the wall: error of the bending stress over
        the yield strength. pipes: of the string, at least."""
        errors = (c_double * pipes)()
        self._check(_lib.dmb_analysis_mesh(self._handle, string, errors, pipes))
        return list(errors)

    @mirrors("dmb_model_find")
    def find(self, name: str, kind: int = PartKind.ANY) -> Any:
        """The part of that name, of a kind or of all; model["rotary head"] is the same. Raises KeyError where there is
        none, and where parts of several kinds have it and no kind is given."""
        part = Id()
        status = self._find(name, kind, part)
        if status == Status.ERR_ID:
            raise KeyError(f"no part is named {name!r}")
        if status == Status.ERR_VALUE:
            raise KeyError(f"parts of several kinds are named {name!r}: give the kind, find(name, PartKind.DRIVE)")
        self._check(status)
        return part

    def __getitem__(self, name: str) -> Any:
        return self.find(name)

    def _find(self, name: str, kind: int, part: Id) -> int:
        if not isinstance(name, str):
            refuse_type("model", "name", name, "be a text")
        status = int(_lib.dmb_model_find(self._handle, whole(kind, "model", "kind", 0), name.encode(), byref(part)))
        if is_closed(self._handle, status):
            raise closed("model")
        return status

    def __contains__(self, name: str) -> bool:
        return self._find(name, PartKind.ANY, Id()) != Status.ERR_ID

    @mirrors("dmb_model_find_pipes")
    def find_pipes(self, name: str) -> tuple[Id, range]:
        """The pipes that were added under that name: their string, and their numbers along it. Raises KeyError."""
        string, first, count = Id(), c_uint32(), c_uint32()
        if _lib.dmb_model_find_pipes(self._handle, name.encode(), byref(string), byref(first), byref(count)) < 0:
            raise KeyError(f"no pipes are named {name!r}")
        return string, range(first.value, first.value + count.value)

    @mirrors("dmb_model_get_name")
    def name_of(self, part: Id) -> str:
        """The name of a part, "" if it has none."""
        text = create_string_buffer(NAME_SIZE)
        self._keep.check(_lib.dmb_model_get_name(self._handle, part, text, NAME_SIZE), b"")
        return text.value.decode()

    def events(self) -> list[str]:
        """The names of the events, in the order of description."""
        found = []
        for index in range(_lib.dmb_model_event_count(self._handle)):
            event = EventDef()
            self._check(_lib.dmb_model_get_event(self._handle, index, byref(event)))
            found.append(event.name.decode())
        return found

    def inputs(self) -> dict[str, InputInfo]:
        """The inputs by name: unit, bounds and limits of each, in the order of description."""
        found: dict[str, InputInfo] = {}
        for index in range(_lib.dmb_model_input_count(self._handle)):
            info: InputInfo = InputInfo.blank()
            self._check(_lib.dmb_model_get_input(self._handle, index, byref(info)))
            found[info.name.decode()] = info
        return found

    @mirrors("dmb_query_hole")
    def hole(self, depth: float) -> HolePoint:
        """The hole's axis at a measured depth [m]."""
        point: HolePoint = HolePoint.blank()
        depth = real(depth, "hole", "depth", "m")
        if not abs(depth) < float("inf"):
            refuse_value("hole", "depth", depth, "be finite")
        self._check(_lib.dmb_query_hole(self._handle, depth, byref(point)))
        return point

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_sim_memory_size")
        def sim_memory_size(self, options: SimOptions | None = None, **fields: Any) -> int:
            """[byte] that one sim takes."""
            size, options = c_size_t(), struct(SimOptions, options, fields)
            self._check(_lib.dmb_sim_memory_size(self._handle, byref(options), byref(size)))
            return size.value

        def sim(self, options: SimOptions | None = None, log: Callable[[int, str], None] | None = None, **fields: Any) -> Sim:
            """A sim of the compiled scene at time 0, with the given SimOptions or fields of it."""
            from .sim import Sim
            return Sim(self, options, log, **fields)

    @mirrors("dmb_write_vtk_hole")
    def write_vtk_hole(self, path: Any, depth0: float, depth1: float, spacing: float = 1.0, around: int = 24) -> None:
        """Writes the hole from depth0 to depth1 [m] as a tube for ParaView."""
        if not depth0 < depth1 < float("inf"):
            refuse_value("hole", "depth1", depth1, f"be > depth0 ({depth0} m)")
        if not spacing > 0.0:
            refuse_value("hole", "spacing", spacing, "be > 0")
        written(path, self._handle, _lib.dmb_write_vtk_hole(self._handle, depth0, depth1, spacing,
                                                            whole(around, "hole", "around", 3, 10 ** 6), path_of(path)))


def motor_drive(definition: Motor | None = None, **fields: Any) -> tuple[DriveDef, float]:
    """A mud motor, by a Motor or its fields (stall_torque [N m] or pressure [Pa], displacement [m3], flow [m3/s]; or a table
    of pairs of speed [rad/s] and torque [N m]), as the drive of the joint that it stands in, and its no-load speed [rad/s],
    the constant value of the drive's time function."""
    drive, speed = DriveDef(), c_double()
    check(_lib.dmb_motor_drive(byref(struct(Motor, definition, fields)), byref(drive), byref(speed)))
    return drive, speed.value


# ---- Making a model again --------------------------------------------------------------------------------------------
_DEFINITIONS: dict[str, Any] = {
    "set_environment": EnvironmentDef, "add_wall": WallDef, "add_hole_sections": HoleSection, "add_string": StringDef, "add_pipes": PipeDef,
    "add_body": BodyDef, "add_bit": BitDef, "add_stabiliser": StabiliserDef, "add_joint": JointDef, "add_coupling": CouplingDef,
    "add_constraint": ConstraintDef, "add_drive": DriveDef, "add_load": LoadDef, "add_spring": SpringDef,
    "add_force": ForceDef, "add_stuck": StuckDef,
    "add_input": InputDef, "add_event": EventDef, "compile": CompileOptions,
    "add_time_function": Segment}


def map_ids(value: Any, change: Callable[[Id], Any]) -> Any:
    """The value with every id in it changed."""
    if isinstance(value, Id):
        return change(value)
    if isinstance(value, Place):
        part = change(value.part)
        return Place(part, value.pipe, 0, value.fraction) if isinstance(part, Id) else (part, value.pipe, value.fraction)
    if isinstance(value, Output):
        place = map_ids(value.place, change)
        return Output(place=place, quantity=value.quantity) if isinstance(place, Place) else (place, value.quantity)
    if isinstance(value, dict):
        return {key: map_ids(one, change) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(map_ids(one, change) for one in value)
    return value


def remake(cls: type[Model], calls: list[tuple[str, tuple[Any, ...]]]) -> Model:
    """A model by the calls that described another. Ids carry the number of a part and the stamp of its model."""
    model = cls()
    for name, arguments in calls:
        fields = [map_ids(one, lambda part: model.own(as_id(part))) for one in arguments]
        definitions = [_DEFINITIONS[name](**one) if isinstance(one, dict) else one for one in fields]
        getattr(model, name)(*definitions)
    return model
