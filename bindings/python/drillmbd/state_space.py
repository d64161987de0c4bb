"""The linearised scene as matrices: state space for control design, sparse M, C, K and J; the state as arrays."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import POINTER, byref, c_double, c_int32, c_uint32, c_uint64, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import as_id, as_place, mirrors
from ._library import lib as _lib
from ._optional import need
from ._structs import Excitation, Row, StateSpaceInfo, StateSpaceOptions
from .enums import (ARRAY_ACCELERATION, ARRAY_MULTIPLIER, ARRAY_POSITION, ARRAY_QUATERNION, ARRAY_RESIDUAL,
                    ARRAY_VELOCITY,
                    FRAME_WORLD, MATRIX_A, MATRIX_COORDINATES, MATRIX_DAMPING, MATRIX_JACOBIAN, MATRIX_MASS,
                    MATRIX_STIFFNESS, STATE_REDUCED)
from ._values import whole
from .outputs import outputs_of

if TYPE_CHECKING:
    from .analysis import Modes
    from .sim import Sim


class StateSpace(Handle):
    """x' = A x + B u, y = C x + D u about a state, as numpy arrays, and sparse matrices of scipy; made by
    Sim.state_space."""
    _kind = "state_space"

    def __init__(self, sim: Sim, inputs: Sequence[Excitation], outputs: Sequence[Any], options: StateSpaceOptions,
                 modes: Modes | None, mode_list: Sequence[int] | None) -> None:
        self._handle = c_void_p()
        if modes is not None:
            options.form, options.modes = STATE_REDUCED, modes._handle
            if mode_list is not None:
                options.mode_list, options.mode_count = (c_int32 * len(mode_list))(*mode_list), len(mode_list)
        given, requested = (Excitation * len(inputs))(*inputs), outputs_of(outputs, sim._parts, "state space")
        sim._check(sim._long(_lib.dmb_analysis_state_space, byref(options), given, len(inputs), requested, len(outputs),
                             byref(self._handle)))
        self.info: StateSpaceInfo = StateSpaceInfo.blank()
        self._sure(_lib.dmb_state_space_get_info(self._handle, byref(self.info)))

    def _dense(self, which: int, rows: int, columns: int) -> Any:
        values = need("numpy").zeros((rows, columns))
        self._sure(_lib.dmb_state_space_dense(self._handle, which, values.ctypes.data_as(POINTER(c_double))))
        return values

    @property
    def A(self) -> Any:
        """Shape (states, states): displacements and speeds of the coordinates, then the states of inputs"""
        return self._dense(MATRIX_A, self.info.states, self.info.states)

    @property
    def B(self) -> Any:
        """Shape (states, inputs)"""
        return self._dense(MATRIX_A + 1, self.info.states, self.info.inputs)

    @property
    def C(self) -> Any:
        """Shape (outputs, states)"""
        return self._dense(MATRIX_A + 2, self.info.outputs, self.info.states)

    @property
    def D(self) -> Any:
        """Shape (outputs, inputs)"""
        return self._dense(MATRIX_A + 3, self.info.outputs, self.info.inputs)

    @property
    def matrices(self) -> tuple[Any, Any, Any, Any]:
        """A, B, C, D, as scipy.signal.StateSpace(*space.matrices) takes them"""
        return self.A, self.B, self.C, self.D

    def _asdict(self) -> dict[str, Any]:
        """The matrices by name: A, B, C, D; of STATE_MATRICES, which has none of these, M, damping, K, J, R."""
        names = ("A", "B", "C", "D") if self.info.states else ("M", "damping", "K", "J", "R")
        return {name: getattr(self, name) for name in names}

    @property
    def shapes(self) -> Any:
        """Motions of the coordinates of A by rows, shape (coordinates, rows)"""
        values = need("numpy").zeros((self.info.coordinates, self.info.rows))
        self._sure(_lib.dmb_state_space_shapes(self._handle, values.ctypes.data_as(POINTER(c_double))))
        return values

    @mirrors("dmb_state_space_sparse")
    def sparse(self, which: int) -> Any:
        """One of MATRIX_MASS .. MATRIX_COORDINATES as scipy.sparse.csr_matrix."""
        numpy = need("numpy")
        count, info = c_uint64(), self.info
        self._sure(_lib.dmb_state_space_sparse(self._handle, which, None, None, None, byref(count)))
        rows, columns = (numpy.zeros(count.value, dtype=numpy.uint32) for _ in range(2))
        values = numpy.zeros(count.value)
        if count.value > 0:
            self._sure(_lib.dmb_state_space_sparse(self._handle, which, rows.ctypes.data_as(POINTER(c_uint32)),
                                              columns.ctypes.data_as(POINTER(c_uint32)),
                                              values.ctypes.data_as(POINTER(c_double)), byref(count)))
        height = info.constraint_rows if which == MATRIX_JACOBIAN else info.rows
        width = info.independent if which == MATRIX_COORDINATES else info.rows
        return need("scipy.sparse").csr_matrix((values, (rows, columns)), shape=(height, width))

    @property
    def M(self) -> Any:
        """Mass by all rows, sparse"""
        return self.sparse(MATRIX_MASS)

    @property
    def damping(self) -> Any:
        """Damping and gyroscopic terms by all rows, sparse"""
        return self.sparse(MATRIX_DAMPING)

    @property
    def K(self) -> Any:
        """Stiffness by all rows, sparse"""
        return self.sparse(MATRIX_STIFFNESS)

    @property
    def J(self) -> Any:
        """Jacobian of the equations that act, sparse"""
        return self.sparse(MATRIX_JACOBIAN)

    @property
    def R(self) -> Any:
        """Rows by independent coordinates, d = R z, sparse"""
        return self.sparse(MATRIX_COORDINATES)


class Arrays:
    """The state of a sim as numpy arrays, copies of now; Sim.arrays."""

    def __init__(self, sim: Sim) -> None:
        self._sim = sim

    @mirrors("dmb_analysis_array")
    def array(self, which: int) -> Any:
        """One of ARRAY_VELOCITY .. ARRAY_RESIDUAL."""
        count = c_uint64()
        self._sim._check(_lib.dmb_analysis_array(self._sim._handle, which, None, byref(count)))
        values = need("numpy").zeros(count.value)
        if count.value > 0:
            self._sim._check(_lib.dmb_analysis_array(self._sim._handle, which, values.ctypes.data_as(POINTER(c_double)),
                                                     byref(count)))
        return values

    @property
    def velocity(self) -> Any:
        """[m/s, rad/s] body-frame velocities of the nodes, shape (rows)"""
        return self.array(ARRAY_VELOCITY)

    @property
    def acceleration(self) -> Any:
        """[m/s2, rad/s2] rates of those, shape (rows)"""
        return self.array(ARRAY_ACCELERATION)

    @property
    def position(self) -> Any:
        """[m] of the nodes, world, shape (nodes, 3)"""
        return self.array(ARRAY_POSITION).reshape(-1, 3)

    @property
    def quaternion(self) -> Any:
        """[-] of the nodes, body to world, scalar first, shape (nodes, 4)"""
        return self.array(ARRAY_QUATERNION).reshape(-1, 4)

    @property
    def multiplier(self) -> Any:
        """[N, ...] of the rows of the Jacobian, shape (constraint rows)"""
        return self.array(ARRAY_MULTIPLIER)

    @property
    def residual(self) -> Any:
        """[N, N m] of the equations of motion without forces of constraint, shape (rows)"""
        return self.array(ARRAY_RESIDUAL)

    @mirrors("dmb_query_row")
    def row(self, row: int) -> Row:
        """The part or node that a row belongs to."""
        result: Row = Row.blank()
        self._sim._told(_lib.dmb_query_row(self._sim._handle, whole(row, "row", "row"), byref(result)),
                        _lib.dmb_query_row)
        return result

    @mirrors("dmb_analysis_place_rows")
    def place(self, place: Any, component: int, frame: int = FRAME_WORLD) -> dict[int, float]:
        """A small motion of a place: factors by row."""
        rows, values, count = (c_uint32 * 24)(), (c_double * 24)(), c_uint32()
        self._sim._check(_lib.dmb_analysis_place_rows(self._sim._handle, as_place(place), frame, component, rows,
                                                      values,
                                                      byref(count)))
        return {rows[i]: values[i] for i in range(count.value)}

    @mirrors("dmb_query_constraint_rows")
    def constraint(self, part: Any) -> range:
        """Rows of the Jacobian of a joint, coupling, constraint or joint drive."""
        first, count = c_uint32(), c_uint32()
        self._sim._told(_lib.dmb_query_constraint_rows(self._sim._handle, as_id(part), byref(first), byref(count)),
                        _lib.dmb_query_constraint_rows)
        return range(first.value, first.value + count.value)
