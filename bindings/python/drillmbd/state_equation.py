"""The state equation of a scene for integrators, optimisers and model exchange of others."""
from __future__ import annotations

from collections.abc import Sequence
from ctypes import byref, c_double, c_uint32, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import mirrors
from ._library import lib as _lib

if TYPE_CHECKING:
    from .sim import Sim


class StateEquation(Handle):
    """y' = f(t, y) of the scene of a sim, in independent coordinates: n positions from an origin, which is the pose of
    the sim when this is made, then n body-frame velocities. The instance is a function for solve_ivp of scipy:

        equation = sim.state_equation()
        solved = solve_ivp(equation, (equation.time, 1.0), equation.y)

    Made by Sim.state_equation, which raises Error for a scene with a memory. The sim is left as it is."""
    _kind = "state_equation"

    @mirrors("dmb_state_equation_create")
    def __init__(self, sim: Sim) -> None:
        self._of, self._handle = sim, c_void_p()
        sim._check(_lib.dmb_state_equation_create(sim._handle, byref(self._handle)))
        self._read_origin()

    def _read_origin(self) -> None:
        length, time = 2 * _lib.dmb_state_equation_count(self._handle), c_double()
        state = (c_double * length)()
        self._sure(_lib.dmb_state_equation_origin(self._handle, byref(time), state))
        #: [s] and y of the origin
        self.time, self.y = time.value, list(state)

    @property
    @mirrors("dmb_state_equation_rows")
    def rows(self) -> list[int]:
        """Row of each of the n coordinates, as of Sim.row."""
        rows = (c_uint32 * (len(self.y) // 2))()
        self._sure(_lib.dmb_state_equation_rows(self._handle, rows))
        return list(rows)

    def _numbers(self, y: Sequence[float]) -> Any:
        if len(y) != len(self.y):
            raise ValueError(f"y has {len(y)} numbers, must be {len(self.y)}: positions, then velocities")
        return (c_double * len(self.y))(*y)

    @mirrors("dmb_state_equation_rate")
    def __call__(self, time: float, y: Sequence[float]) -> list[float]:
        """f(time, y)"""
        numbers = self._numbers(y)
        self._sure(_lib.dmb_state_equation_rate(self._handle, time, numbers, numbers))
        return list(numbers)

    @mirrors("dmb_state_equation_begin")
    def begin(self, time: float, y: Sequence[float]) -> list[float]:
        """Moves the origin to that state, where parts turn far; returns its y."""
        self._sure(_lib.dmb_state_equation_begin(self._handle, time, self._numbers(y)))
        self._read_origin()
        return self.y

    @mirrors("dmb_state_equation_sim")
    def at(self, time: float, y: Sequence[float]) -> Sim:
        """A sim in that state, for queries alone: accelerations, reactions of joints, outputs. It is there until the
        next call on this, which it follows."""
        from .sim import SimAt
        self(time, y)
        return SimAt(self._of, _lib.dmb_state_equation_sim(self._handle), self)


__all__ = ["StateEquation"]
