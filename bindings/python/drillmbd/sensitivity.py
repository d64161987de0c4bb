"""Sensitivities: how the state and any output change with chosen parameters, along a run."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_double, c_uint32, c_uint64, c_void_p
from typing import TYPE_CHECKING, Any

from ._handle import Handle
from ._keep import mirrors
from ._library import lib as _lib
from ._structs import Parameter, StepReport
from .outputs import outputs_of

if TYPE_CHECKING:
    from .model import Model
    from .sim import Sim


class Sensitivity(Handle):
    """Derivatives of a sim by parameters, each given as (low, high, step): two sims of the scene with the parameter
    `step` lower and higher, at the same time. Move the sim by step() and advance() of this, not by its own; made by
    Sim.sensitivity, or from a function that describes the scene by sensitivity_of."""
    _kind = "sensitivity"

    @mirrors("dmb_sensitivity_create")
    def __init__(self, sim: Sim, parameters: Mapping[str, tuple[Sim, Sim, float]], one_sided: bool = False) -> None:
        self.sim, self.names, self._handle = sim, list(parameters), c_void_p()
        given = (Parameter * len(parameters))()
        for number, (name, (low, high, step)) in enumerate(parameters.items()):
            given[number] = Parameter(step=step, one_sided=int(one_sided), name=name.encode()[:23],
                                      low=low._handle, high=high._handle)
        sim._check(_lib.dmb_sensitivity_create(sim._handle, given, len(parameters), byref(self._handle)))

    @mirrors("dmb_sensitivity_step")
    def step(self, duration: float) -> StepReport:
        """Advances sim and derivatives by duration [s]; returns the report, whose status may be a note."""
        report: StepReport = StepReport.blank()
        report.status = self.sim._check(_lib.dmb_sensitivity_step(self._handle, duration, byref(report)))
        return report

    @mirrors("dmb_sensitivity_advance")
    def advance(self, time: float) -> StepReport:
        """Advances sim and derivatives to time [s] with steps of the sim's choice."""
        report: StepReport = StepReport.blank()
        report.status = self.sim._check(_lib.dmb_sensitivity_advance(self._handle, time, byref(report)))
        return report

    @mirrors("dmb_sensitivity_outputs")
    def outputs(self, outputs: Sequence[Any]) -> tuple[list[float], list[list[float]]]:
        """Values of outputs, pairs (place, "bit_speed"), and of each its derivatives by the parameters in their order
        [unit of the output over that of the parameter]."""
        requested = outputs_of(outputs, self.sim._parts, "sensitivity")
        count = len(self.names)
        values, derivatives = (c_double * len(outputs))(), (c_double * (len(outputs) * count))()
        self.sim._check(_lib.dmb_sensitivity_outputs(self._handle, requested, len(outputs), values, derivatives))
        return list(values), [list(derivatives[i * count:(i + 1) * count]) for i in range(len(outputs))]

    @mirrors("dmb_sensitivity_rows")
    def rows(self, parameter: int | str) -> tuple[list[float], list[float]]:
        """Derivatives of body-frame pose [m, rad] and velocity [m/s, rad/s] in all rows by a parameter."""
        number, count = self._number(parameter), c_uint32()
        self.sim._check(_lib.dmb_sensitivity_rows(self._handle, number, None, None, byref(count)))
        pose, velocity = (c_double * count.value)(), (c_double * count.value)()
        self.sim._check(_lib.dmb_sensitivity_rows(self._handle, number, pose, velocity, byref(count)))
        return list(pose), list(velocity)

    def _asdict(self) -> dict[str, dict[str, Any]]:
        """Derivatives of poses and velocities in all rows, and the number of kinks, by the names of the parameters."""
        found = {}
        for name in self.names:
            pose, velocity = self.rows(name)
            found[name] = {"pose": pose, "velocity": velocity, "kinks": self.kinks(name)}
        return found

    @mirrors("dmb_sensitivity_kinks")
    def kinks(self, parameter: int | str) -> int:
        """Steps so far in which the parameter was not smooth."""
        kinks = c_uint64()
        self.sim._check(_lib.dmb_sensitivity_kinks(self._handle, self._number(parameter), byref(kinks)))
        return kinks.value

    def _number(self, parameter: int | str) -> int:
        return self.names.index(parameter) if isinstance(parameter, str) else parameter


def sensitivity_of(describe: Callable[..., Model], values: Mapping[str, float],
                   steps: Mapping[str, float] | None = None, prepare: Callable[[Sim], Any] | None = None,
                   one_sided: bool = False, **options: Any) -> Sensitivity:
    """A Sensitivity (its sim is .sim) of the scene that describe(**values) compiles, by each of the values; steps: how
    far to go aside, 1e-5 of the value by default; prepare(sim): done with each sim before (static, set_drive);
    options: of the sims."""
    def sim_at(**at: float) -> Sim:
        sim = describe(**at).sim(**options)
        if prepare is not None:
            prepare(sim)
        return sim

    parameters = {}
    for name, value in values.items():
        step = (steps or {}).get(name, 1e-5 * abs(value))
        sides = [sim_at(**{**values, name: value + sign * step}) for sign in (-1.0, 1.0)]
        parameters[name] = (sides[0], sides[1], step)
    return Sensitivity(sim_at(**values), parameters, one_sided)
