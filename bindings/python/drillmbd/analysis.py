"""Analyses of a scene about a state: statics, buckling, paths, model check, modes, responses, speeds to avoid,
torque and drag."""
from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Sequence
from ctypes import byref, c_double, c_size_t, c_uint32, c_void_p, pointer
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import Keep, as_id, as_place, mirrors, path_of, struct, written
from ._library import lib as _lib
from ._parts import Parts, index_of, is_closed
from ._optional import need, numpy
from ._progress import Teller
from ._structs import (PATH_FN, STRUCTS, BucklingInfo, BucklingOptions, CheckReport, Hydraulics, Id, Excitation, Mode,
                       ModeShape, ModesInfo,
                       ModesOptions, Operation, Order, PathOptions, PathPoint, PathReport, Place, ResponseOptions,
                       SpeedBand,
                       SpeedsOptions, StaticOptions, StaticReport, TorqueDragOptions, TorqueDragRow)
from ._values import real, reals, refuse_type, refuse_value, whole
from .enums import COMBINED, FRAME_WORLD, MEASURED_HOOK_LOAD, MEASURED_TORQUE, OperationKind
from .errors import Error, check
from .frames import Columns, SpeedBands, by_field
from .outputs import output_text, outputs_of

if TYPE_CHECKING:
    from ._typed import AnalysisCalls
    from .sim import Sim
else:
    AnalysisCalls = object


class Analyses(AnalysisCalls):
    """The analyses of a Sim."""
    _handle: c_void_p
    _scene: Keep
    _teller: Teller

    def _check(self, status: int) -> int:
        raise NotImplementedError

    def _long(self, function: Any, *arguments: Any) -> int:
        return self._teller.long_call(self._handle, function, *arguments)

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_analysis_static")
        def static(self, options: StaticOptions | None = None, **fields: Any) -> StaticReport:
            """Puts the sim at rest in equilibrium; returns the report."""
            options, report = struct(StaticOptions, options, fields), StaticReport()
            report.status = self._check(self._long(_lib.dmb_analysis_static, byref(options), byref(report)))
            return report

        @mirrors("dmb_analysis_buckling")
        def buckling(self, options: BucklingOptions | None = None, **fields: Any) -> Buckling:
            """Critical factors and shapes about the present static state."""
            return Buckling(self, struct(BucklingOptions, options, fields))

        @mirrors("dmb_analysis_path")
        def path(self, visit: Callable[[Sim, PathPoint], Any] | None = None, options: PathOptions | None = None,
                 **fields: Any) -> PathReport:
            """Follows the path of equilibrium from here; returns the report. visit(at, point) is called at each point
            with a sim that is there and may be queried until it returns; True stops the path."""
            from .sim import SimAt
            options, report = struct(PathOptions, options, fields), PathReport()
            raised: list[BaseException] = []

            def call(_context: Any, handle: Any, point: Any) -> int:
                at = SimAt(self, handle)
                try:
                    assert visit is not None
                    return 1 if visit(at, PathPoint.from_buffer_copy(point.contents)) else 0
                except BaseException as error:  # must not unwind through C
                    raised.append(error)
                    return 1
                finally:
                    at.close()

            if visit is not None:
                options.callback = PATH_FN(call)
            status = self._long(_lib.dmb_analysis_path, byref(options), byref(report))
            if raised:
                raise raised[0]
            report.status = self._check(status)
            return report

    @mirrors("dmb_analysis_check")
    def check(self) -> CheckReport:
        """Parts, joints, degrees of freedom, redundant equations and the number of warnings: the model check."""
        report = CheckReport()
        status = self._long(_lib.dmb_analysis_check, byref(report))
        report.status = self._check(status)
        return report

    @mirrors("dmb_analysis_check_text")
    def check_text(self) -> str:
        """The model check as a sheet of text, redundant equations and warnings by name."""
        size = c_size_t()
        self._check(_lib.dmb_analysis_check_text(self._handle, None, 0, byref(size)))
        text = ctypes.create_string_buffer(size.value)
        self._check(_lib.dmb_analysis_check_text(self._handle, text, size.value, None))
        return text.value.decode()

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_analysis_response")
        def response(self, excitations: Sequence[Excitation], outputs: Sequence[Any],
                     options: ResponseOptions | None = None,
                     frequencies: Any = None, **fields: Any) -> Response:
            """Frequency response from every Excitation to every output about the present state, at `frequencies` [Hz]
            or on the grid that the ResponseOptions describe."""
            options = struct(ResponseOptions, options, fields)
            if frequencies is not None:
                frequencies = reals(frequencies, "response", "frequencies", unit="Hz")
                options.frequencies, options.points = (c_double * len(frequencies))(*frequencies), len(frequencies)
            given, requested, handle = (row_of(Excitation, excitations, "excitations"),
                                        outputs_of(outputs, self._parts, "response"), c_void_p())
            status = self._check(self._long(_lib.dmb_analysis_response, byref(options), given, len(excitations),
                                            requested, len(outputs), byref(handle)))
            return Response(handle, [one.amplitude for one in given],
                            [output_text(one, self._handle) for one in requested], status)

        @mirrors("dmb_analysis_stepped_sine")
        def stepped_sine(self, frequency: float, outputs: Sequence[Any], options: Any = None,
                         **fields: Any) -> tuple[Any, Any]:
            """Runs on until the Fourier amplitudes at frequency [Hz] have settled. Returns a list for each output, mean
            and then the complex harmonics, and the report, whose status may be NOTE_STOPPED."""
            options = struct(STRUCTS["dmb_stepped_sine_options"], options, fields)
            report: Any = STRUCTS["dmb_stepped_sine_report"]()
            requested, width = outputs_of(outputs, self._parts, "stepped sine"), 1 + options.harmonics
            frequency = real(frequency, "stepped sine", "frequency", "Hz")
            values = (c_double * (2 * width * len(outputs)))()
            report.status = self._check(self._long(_lib.dmb_analysis_stepped_sine, frequency, byref(options), requested,
                                                   len(outputs), values, byref(report)))
            found = [complex(values[2 * i], values[2 * i + 1]) for i in range(width * len(outputs))]
            return [[found[i * width].real] + found[i * width + 1:(i + 1) * width] for i in range(len(outputs))], report

        sine = stepped_sine  # its name before

        @mirrors("dmb_analysis_modes")
        def modes(self, options: ModesOptions | None = None, **fields: Any) -> Modes:
            """Natural frequencies and modes about the present state, as the ModesOptions say: a Modes, a sequence of
            Mode."""
            options, handle = struct(ModesOptions, options, fields), c_void_p()
            status = self._check(self._long(_lib.dmb_analysis_modes, byref(options), byref(handle)))
            return Modes(handle, self, status)

        @mirrors("dmb_analysis_speeds")
        def speeds(self, orders: Sequence[Order], outputs: Sequence[Any], limits: Sequence[float], room: int = 64,
                   options: SpeedsOptions | None = None, **fields: Any) -> tuple[SpeedBands, list[float]]:
            """Bands of rotary speed [rad/s] to avoid, at most `room` of them, and the severity at the speeds of the
            grid: each
            Order excites, and limits are the amplitudes allowed of the outputs. `status` and `report` of the bands
            state where the result lacks excitation, damping or range (NOTE_INCOMPLETE)."""
            options = struct(SpeedsOptions, options, fields)
            room = whole(room, "speeds", "room", 1, 2 ** 20)
            allowed = (c_double * len(outputs))(*reals(limits, "speeds", "limits", len(outputs)))
            shakes, requested = row_of(Order, orders, "orders"), outputs_of(outputs, self._parts, "speeds")
            bands, count = (SpeedBand * room)(*[SpeedBand() for _ in range(room)]), c_uint32(room)
            severity = (c_double * options.points)()
            found = SpeedBands()
            options.report = pointer(found.report)
            found.status = self._check(self._long(_lib.dmb_analysis_speeds, byref(options), shakes, len(orders),
                                                  requested, allowed, len(outputs), bands, byref(count), severity))
            options.report = None
            found.extend(list(bands)[:count.value])
            width = (options.speed_high - options.speed_low) / max(options.points - 1, 1)
            found.speeds, found.severity = [options.speed_low + i * width
                                            for i in range(options.points)], list(severity)
            return found, found.severity

        @mirrors("dmb_analysis_torque_drag")
        def torque_drag(self, operations: Any = None, depths: Sequence[float] | None = None,
                        options: TorqueDragOptions | None = None, **fields: Any) -> TorqueDrag:
            """Hook load and torque of the rig by depth [m] and operation: Operation structs, or OPERATION_... for usual
            ones; all of these where none are given. depths: of the far end; one, as described, where none are given."""
            options = struct(TorqueDragOptions, options, fields)
            requested = [as_operation(one) for one in (OPERATIONS if operations is None else operations)]
            if not requested:
                refuse_value("torque and drag", "operations", operations, "be one at least")
            if depths is not None:
                below = reals(depths, "torque and drag", "depths", unit="m")
                options.depth_count = len(below)
                options.depths = (c_double * len(below))(*below)
            count = max(1, options.depth_count) * len(requested)
            rows = (TorqueDragRow * count).from_buffer_copy(bytes(TorqueDragRow.blank()) * count)
            status = self._check(self._long(_lib.dmb_analysis_torque_drag, byref(options),
                                            (Operation * len(requested))(*requested),
                                            len(requested), rows))
            options.depths = None
            width = len(requested)
            return TorqueDrag(requested, [list(rows[i:i + width]) for i in range(0, count, width)], status)

        @mirrors("dmb_analysis_torque_drag_profile")
        def torque_drag_profile(self, operation: Operation | int, stations: int = 101,
                                options: TorqueDragOptions | None = None, **fields: Any) -> Columns:
            """One operation along the string, at stations spread evenly from the rig end: depth [m], effective axial
            force [N], torque [N m], wall force per metre [N/m], as lists by name."""
            options = struct(TorqueDragOptions, options, fields)
            given, stations = (as_operation(operation), whole(stations, "torque and drag profile", "stations", 2,
                                                              2 ** 20))
            values = [(c_double * stations)() for _ in range(4)]
            self._check(_lib.dmb_analysis_torque_drag_profile(self._handle, byref(options), byref(given), stations,
                                                              *values))
            found = Columns(zip(("depth", "axial_force", "torque", "wall_force"), (list(one) for one in values)))
            found.units = dict(zip(found, ("m", "N", "N m", "N/m")))
            return found

    @mirrors("dmb_analysis_hydraulics")
    def hydraulics(self, depth: float, trip_speed: float = 0.0) -> Hydraulics:
        """Pressures [Pa] of the mud with the string's far end at a measured depth [m], equivalent circulating density
        [kg/m3], surge and swab of the closed string that moves at a trip speed [m/s]."""
        found: Hydraulics = Hydraulics.blank()
        self._check(_lib.dmb_analysis_hydraulics(self._handle, real(depth, "hydraulics", "depth", unit="m"),
                                                 real(trip_speed, "hydraulics", "trip_speed", unit="m/s"),
                                                 byref(found)))
        return found

    if not TYPE_CHECKING:  # their signatures for type checkers: _typed.py
        @mirrors("dmb_analysis_friction_factor")
        def friction_factor(self, operation: Operation | int, hook_load: float | None = None,
                            torque: float | None = None,
                            options: TorqueDragOptions | None = None, **fields: Any) -> float:
            """The friction coefficient [-] that explains a hook load [N] or a torque [N m] measured at the rig."""
            if (hook_load is None) == (torque is None):
                raise ValueError("give hook_load or torque, one of them")
            options = struct(TorqueDragOptions, options, fields)
            given, found = as_operation(operation), c_double()
            measured = MEASURED_HOOK_LOAD if torque is None else MEASURED_TORQUE
            self._check(_lib.dmb_analysis_friction_factor(self._handle, byref(options), byref(given), measured,
                                                          real(hook_load if torque is None else torque,
                                                               "friction factor",
                                                               "measured value", "N or N m"), byref(found)))
            return found.value


def row_of(cls: Any, given: Any, field: str) -> Any:
    """The C array of the structs."""
    if isinstance(given, cls):
        refuse_type("call", field, given, f"be a list of {cls.__name__}, [{cls.__name__}(...)]")
    given = list(given)
    for i, one in enumerate(given):
        if not isinstance(one, cls):
            refuse_type("call", f"{field}[{i}]", one, f"be an {cls.__name__}")
    return (cls * len(given))(*given)


# ---- Torque and drag -------------------------------------------------------------------------------------------------
OPERATIONS = list(OperationKind)


def as_operation(one: Any) -> Operation:
    """The Operation; OPERATION_... or a name as "pick-up" selects the usual one."""
    return one if isinstance(one, Operation) else usual_operation(one)


def usual_operation(kind: int | str, **fields: Any) -> Operation:
    """The Operation OPERATION_..., or of a name as "pick-up", at usual speeds, with further fields such as
    weight_on_bit
    [N]."""
    operation = Operation()
    if isinstance(kind, str):
        names = [operation_name(one) for one in OPERATIONS]
        if kind not in names:
            refuse_value("operation", "kind", kind, f"be one of {' '.join(names)}")
        kind = names.index(kind)
    check(_lib.dmb_operation_usual(whole(kind, "operation", "kind", 0, len(OPERATIONS) - 1), byref(operation)))
    for name, value in fields.items():
        setattr(operation, name, value)
    return operation


def operation_name(kind: int) -> str:
    """ "pick-up", "slack-off", ..."""
    return (_lib.dmb_operation_name(whole(kind, "operation", "kind", 0, len(OPERATIONS) - 1)) or b"").decode()


class TorqueDrag:
    """rows[i][k] is the TorqueDragRow of depth i and operation k."""

    def __init__(self, operations: list[Operation], rows: list[list[TorqueDragRow]], status: int) -> None:
        self.operations, self.rows, self.status = operations, rows, status

    def column(self, field: str, operation: int = 0) -> list[float]:
        """A field of the rows of one operation, depth by depth."""
        return [getattr(row[operation], field) for row in self.rows]

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of all rows by name, with the number of the operation."""
        numbers = [k for rows in self.rows for k in range(len(rows))]
        return {"operation": numbers, **by_field(TorqueDragRow, (row for rows in self.rows for row in rows))}

    def frame(self) -> Any:
        """All rows as a pandas frame with units in the names of its columns."""
        names = [name for name in TorqueDragRow.field_docs if name not in ("struct_size", "reserved")]
        heads = [f"{name.replace('_', ' ')} [{TorqueDragRow.field_docs[name][0] or '-'}]" for name in names]
        return need("pandas").DataFrame(
            [[k, *(getattr(row, name) for name in names)] for rows in self.rows for k, row in enumerate(rows)],
            columns=["operation", *heads])


# ---- Frequency response ----------------------------------------------------------------------------------------------
class Response(Handle):
    """Transfer functions that Sim.response has found. `shape`: numbers of frequencies, excitations and outputs;
    `amplitudes`: of the excitations, as they were given; `status`: NOTE_INCOMPLETE where it neglects effects;
    `names` of the outputs with their units, "vibration_z of
    string main pipe 3 at 0.5 [m]"."""
    _kind = "response"

    def __init__(self, handle: c_void_p, amplitudes: list[float], names: list[str], status: int = 0) -> None:
        self._handle, self.amplitudes, self.names, self.status = handle, amplitudes, names, status
        shape = (c_uint32 * 3)()
        check(_lib.dmb_response_dimensions(handle, shape))
        self.shape = tuple(shape)  # points, excitations, outputs

    @property
    def frequencies(self) -> Any:
        """[Hz] ascending: a numpy array, or a list; shape (points)."""
        values = (c_double * self.shape[0])()
        self._sure(_lib.dmb_response_frequencies(self._handle, values))
        return numpy.array(values) if numpy is not None else list(values)

    def transfer(self, excitation: int = COMBINED, output: int = 0) -> Any:
        """The output per unit of the excitation, or for all excitations with their amplitudes and phases (COMBINED):
        complex numbers, one for each frequency; shape (points)."""
        values = (c_double * (2 * self.shape[0]))()
        if excitation != COMBINED:
            excitation = index_of("response", "excitation", excitation, self.shape[1])
        output = index_of("response", "output", output, self.shape[2])
        self._sure(_lib.dmb_response_transfer(self._handle, excitation, output, values))
        if numpy is not None:
            return numpy.array(values).view(complex)
        return [complex(values[2 * i], values[2 * i + 1]) for i in range(self.shape[0])]

    def _asdict(self) -> dict[str, Any]:
        """Frequencies [Hz], and the combined outputs by number, complex."""
        return {"frequency": self.frequencies, **{f"output {i}": self.transfer(COMBINED, i)
                                                  for i in range(self.shape[2])}}

    def frame(self, names: Sequence[str] | None = None) -> Any:
        """The combined outputs as a pandas frame of complex numbers over the frequency; names of the outputs with their
        units."""
        names = names or self.names
        columns = {"frequency [Hz]": self.frequencies}
        columns.update((name, self.transfer(COMBINED, i)) for i, name in enumerate(names))
        return need("pandas").DataFrame(columns)

    @mirrors("dmb_response_write_csv")
    def write_csv(self, path: Any, sim: Sim | None = None) -> None:
        """Writes amplitudes and phases as CSV; sim: for names of parts in its heads, which are numbers without."""
        written(path, self._handle, _lib.dmb_response_write_csv(self._handle, sim and sim._handle, path_of(path)))


class Shaped(Handle):
    """A result with a shape at each place."""
    _parts: Parts

    def _place_status(self, place: Place, status: int) -> int:
        """The status of a query of a place, or an Error with the reason why the place is wrong."""
        if status < 0 and not is_closed(self._handle, status):
            raise Error(status, self._parts.why(status, "shape", (place,)))
        return self._sure(status)


# ---- Buckling --------------------------------------------------------------------------------------------------------
class Buckling(Shaped):
    """Critical factors, rising, and their shapes. status is NOTE_STOPPED where fewer were found than requested,
    NOTE_EXTRAPOLATED where info.confirmed is less than their number."""
    _kind = "buckling"

    def __init__(self, sim: Any, options: BucklingOptions) -> None:
        self._handle = c_void_p()
        self._scene, self._parts = sim._scene, sim._parts  # the model's callbacks
        self.status = sim._check(sim._long(_lib.dmb_analysis_buckling, byref(options), byref(self._handle)))
        self.info = BucklingInfo()
        self._sure(_lib.dmb_buckling_get_info(self._handle, byref(self.info)))
        value = c_double()
        self.factors: list[float] = []
        for mode in range(_lib.dmb_buckling_count(self._handle)):
            self._sure(_lib.dmb_buckling_factor(self._handle, mode, byref(value)))
            self.factors.append(value.value)

    def _asdict(self) -> dict[str, list[Any]]:
        """The factors, rising, and whether each is confirmed."""
        return {"factor": list(self.factors), "confirmed": [i < self.info.confirmed for i in range(len(self.factors))]}

    @mirrors("dmb_buckling_shape")
    def shape(self, mode: int, place: Place | Id) -> list[float]:
        """[m, rad] displacement and rotation of a section, world frame; six numbers"""
        values, place = (c_double * 6)(), as_place(place, self._parts)
        mode = index_of("buckling", "mode", mode, len(self.factors))
        self._place_status(place, _lib.dmb_buckling_shape(self._handle, mode, place, values))
        return list(values)

    def shapes(self, mode: int, places: Sequence[Place]) -> Any:
        """[m, rad] the same at many places: shape (places, 6), a numpy array or lists."""
        return _array([self.shape(mode, place) for place in places])


# ---- Modes -----------------------------------------------------------------------------------------------------------
class Modes(Shaped):
    """Modes that Sim.modes has found, by rising frequency: modes[0].frequency, len(modes). status is NOTE_INCOMPLETE
    where fewer than requested were found."""
    _kind = "modes"

    def __init__(self, handle: c_void_p, sim: Any, status: int = 0) -> None:
        self._handle, self._scene, self._parts, self.status = handle, sim._scene, sim._parts, status
        self.info = ModesInfo()
        check(_lib.dmb_modes_get_info(handle, byref(self.info)))

    def __len__(self) -> int:
        return self.info.count

    def __getitem__(self, index: int) -> Mode:
        index = whole(index, "modes", "index", -2 ** 31, 2 ** 31)
        if not -len(self) <= index < len(self):
            raise IndexError(f"mode {index} of {len(self)}")
        mode, index = Mode(), index % len(self)
        self._sure(_lib.dmb_modes_get(self._handle, index, byref(mode)))
        return mode

    def __iter__(self) -> Iterator[Mode]:
        return (self[index] for index in range(len(self)))

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of all modes by name."""
        return by_field(Mode, self)

    @property
    def frequencies(self) -> Any:
        """[Hz] of all modes: shape (modes), a numpy array or a list."""
        return _array([mode.frequency for mode in self])

    @mirrors("dmb_modes_shape")
    def shape(self, index: int, place: Place | Id, frame: int = FRAME_WORLD) -> ModeShape:
        """Displacement and rotation at a place [m, rad], real and imaginary part: re, im"""
        shape, place = ModeShape(frame=frame), as_place(place, self._parts)
        index = index_of("modes", "index", index, len(self))
        self._place_status(place, _lib.dmb_modes_shape(self._handle, index, place, byref(shape)))
        return shape

    def shapes(self, index: int, places: Sequence[Place], frame: int = FRAME_WORLD) -> Any:
        """[m, rad] complex displacement and rotation at many places: shape (places, 6), a numpy array or lists."""
        found = [self.shape(index, place, frame) for place in places]
        return _array([[complex(re, im) for re, im in zip(one.re, one.im)] for one in found])

    @mirrors("dmb_modes_part")
    def part(self, index: int, part: Id, pipe: int = 0xFFFFFFFF) -> tuple[float, float]:
        """[J] kinetic and strain energy of a mode in a pipe of a string, in a whole string, or (pipe 0) in a body"""
        kinetic, strain = c_double(), c_double()
        index = index_of("modes", "index", index, len(self))
        self._sure(_lib.dmb_modes_part(self._handle, index, as_id(part, self._parts), pipe, byref(kinetic),
                                       byref(strain)))
        return kinetic.value, strain.value

    def frame(self) -> Any:
        """A pandas frame, one row for each mode: frequency, damping and shares of motion."""
        rows = [(mode.frequency, mode.damping, bool(mode.rigid), *mode.share, *mode.effective_mass) for mode in self]
        columns = ["frequency [Hz]", "damping [-]", "rigid", "share axial [-]", "share torsional [-]",
                   "share lateral [-]",
                   "effective mass x [kg]", "effective mass y [kg]", "effective mass z [kg]"]
        return need("pandas").DataFrame(rows, columns=columns)

    @mirrors("dmb_write_vtk_mode")
    def write_vtk(self, index: int, path: Any, scale: float = 1.0, phase: float = 0.0, per_element: int = 8) -> None:
        """A frame of the mode's animation."""
        index = index_of("modes", "index", index, len(self))
        written(path, self._handle, _lib.dmb_write_vtk_mode(
            self._handle, index, real(scale, "mode", "scale"), real(phase, "mode", "phase"),
            whole(per_element, "mode", "per_element", 1), path_of(path)))


def _array(values: Any) -> Any:
    return numpy.array(values) if numpy is not None else values
