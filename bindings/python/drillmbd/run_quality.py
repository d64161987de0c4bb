"""Quality of a run in time: the energy error of its first and last tenth, and the last part again with half the
step."""
from __future__ import annotations

import math
from typing import Any

from . import station
from ._optional import need
from .results import CommandOutput, percent
from .enums import Status
from .errors import Usage
from .language import Foreign
from .scene import Scene
from .scene.warned import of_model
from .sim import Sim

PART, LEAST_STEPS = 0.1, 20   #: of the run that is verified; it has as many steps at least
NOTABLE = 0.05                #: difference of largest values, of the larger one, above which a note is made
#: energy error of the last tenth over that of the first, and over the energy, above which a note is made
GROWS, SMALL = 10.0, 1e-4
LARGE = 0.05                  #: energy error over the energy, above which the run is said to be unreliable
MOST_NUMBERS = 50_000_000
#: error of the rate of slow whirl over (W h)^2, W the speed of rotation and h the step (physics_rotor_on_joint)
SLOW_WHIRL = 0.69
TURN_NOTABLE = 0.12           #: [rad] W h above which a note is made: an error of 1 %
SAMPLES = 50                  #: of the rotation of the strings in a run


class FirstTenth:
    """Takes the energy balance at the end of the first tenth of a run."""

    def __init__(self, sim: Sim, begin: float, end: float) -> None:
        self.sim, self.until = sim, begin + 0.1 * (end - begin)
        self.start = sim.energy().balance
        self.balance: float | None = None   #: [J] change of the balance

    def take(self) -> int:
        """Once, at the first step that ends there or later."""
        if self.balance is None and self.sim.time >= self.until:
            self.balance = self.sim.energy().balance - self.start
        return Status.OK

    def due(self) -> float:
        """[s] when it takes the balance"""
        return self.until if self.balance is None else math.inf

    def keep(self) -> dict[str, Any]:
        """For a run that is stopped."""
        return {"until": self.until, "start": self.start, "balance": self.balance}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Of a run that continues."""
        self.until, self.start, self.balance = kept["until"], kept["start"], kept["balance"]


class TurnAStep:
    """The largest rotation of each string in a step, with which the error of slow whirl and precession grows. Steps
    that follow an error and strings that move along their axis only have none."""

    def __init__(self, scene: Scene, sim: Sim, end: float, step: float) -> None:
        info = scene.model.info()
        bends = info.degrees_of_freedom > 2 * info.nodes
        step = min(step, end - sim.time)
        self.sim, self.step, self.interval = sim, step, max(step, (end - sim.time) / SAMPLES)
        self.places = {name: station(scene.names[name], pipes - 1, 1.0)
                       for name, pipes in scene.pipes.items()} if bends else {}
        self.most = dict.fromkeys(self.places, 0.0)   #: [rad/s]
        self.time, self.turns = sim.time, self._turns()

    def _turns(self) -> dict[str, float]:
        return {name: self.sim.rotation(place) for name, place in self.places.items()}

    def take(self) -> int:
        """The mean speed of rotation since the last sample, as often as samples are due."""
        passed = self.sim.time - self.time
        if passed >= self.interval * (1.0 - 1e-6):
            now = self._turns()
            for name, turn in now.items():
                self.most[name] = max(self.most[name], abs(turn - self.turns[name]) / passed)
            self.time, self.turns = self.sim.time, now
        return Status.OK

    def due(self) -> float:
        """[s] of the next sample"""
        return self.time + self.interval * (1.0 - 1e-6)

    def keep(self) -> dict[str, Any]:
        """For a run that is stopped."""
        return {"interval": self.interval, "most": self.most, "time": self.time, "turns": self.turns}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Of a run that continues."""
        self.interval, self.most, self.time, self.turns = kept["interval"], kept["most"], kept["time"], kept["turns"]

    def report(self, out: CommandOutput) -> None:
        """A note for each string that turns by more than the bound."""
        for name, speed in self.most.items():
            turn = speed * self.step
            if turn > TURN_NOTABLE:
                out.note_text(f"{name} turns by {turn:.2g} rad a step: rates of its slow whirl and precession are off "
                              "by up to "
                                 f"{percent(min(1.0, SLOW_WHIRL * turn * turn))}; a step of "
                                 f"{1e3 * TURN_NOTABLE / speed:.2g} ms gives 1 %. "
                                 "Rotation about a fixed axis is not affected")


class LastPart:
    """Takes the state at the beginning of the last part of a run, and all outputs after each step from there on."""

    def __init__(self, scene: Scene, sim: Sim, end: float, step: float | None) -> None:
        if not step:
            raise Usage("--verify needs a given step: give [run] step or --step")
        if not scene.outputs:
            raise Usage("--verify compares the outputs of the scene, which has none; add a [[output]]")
        self.scene, self.sim, self.end, self.step = scene, sim, end, step
        self.length = min(end - sim.time, max(PART * (end - sim.time), LEAST_STEPS * step))
        self.begin = end - self.length
        self.rows = int(self.length / step + 3)
        if 2 * self.rows * (1 + len(scene.outputs)) > MOST_NUMBERS:
            raise Usage(f"--verify: {2 * self.rows} rows of {1 + len(scene.outputs)} numbers are more than "
                        f"{MOST_NUMBERS}; give a longer step")
        self.state: bytes | None = None
        self.recorder = self._recorder(self.rows)
        if self.length == end - sim.time:
            self.take()

    def _recorder(self, rows: int) -> Any:
        return self.sim.recorder([(place, quantity, name) for name, place, quantity in self.scene.outputs], rows, 0.0)

    def take(self) -> int:
        """A row, and the state with the first one."""
        if self.sim.time < self.begin - 1e-6 * self.step:
            return Status.OK
        if self.state is None:
            self.state, self.begin = self.sim.snapshot(), self.sim.time
        return int(self.recorder.take())

    def due(self) -> float:
        """[s] of its first row; then of each step"""
        return self.begin - 1e-6 * self.step if self.state is None else -math.inf

    def keep(self) -> dict[str, Any]:
        """For a run that is stopped."""
        return {"begin": self.begin, "rows": need("numpy").array(self.recorder.table), "state": self.state or b""}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Of a run that continues."""
        self.begin, self.state = kept["begin"], kept["state"] or None
        self.recorder.take_up(kept["rows"])

    def verify(self, out: CommandOutput) -> None:
        """Runs the part again with half the step, and compares the largest magnitude of each output. The sim is at the
        end of the run before and after."""
        assert self.state is not None
        self.sim.restore(self.state)
        again = self._recorder(2 * self.rows + 3)
        self.sim.run_noting(self.end, 0.5 * self.step, again)
        out.say(f"verification: from {self.begin:g} s to {self.end:g} s again with half the step, "
                f"{500.0 * self.step:g} ms; largest magnitudes:")
        outputs: dict[str, Any] = {}
        changed: list[str] = []
        unknown: list[str] = []
        units = out.units
        heads = self.recorder.columns if units.name == "si" else ["", *self.scene.output_heads()]
        for column, name in enumerate(self.recorder.columns[1:], 1):
            first, second = (float(abs(one.table[:, column]).max()) for one in (self.recorder, again))
            larger = math.nan if math.isnan(first + second) else max(first, second)
            change = 0.0 if larger == 0.0 else (second - first) / larger
            outputs[name] = {"step": first, "half_step": second, "change": change}
            head, factor = heads[column], units.factor_of(heads[column])
            out.say(f"  {units.head(head)}: {first * factor:.5g}, with half the step {second * factor:.5g} "
                    f"({100.0 * change:+.2g} %)")
            if math.isnan(change):
                unknown.append(name)
            elif abs(change) > NOTABLE:
                changed.append(name)
        out.summary["verification"] = {"begin_s": self.begin, "end_s": self.end, "half_step_s": 0.5 * self.step,
                                       "outputs": outputs}
        if changed:
            out.note_text(f"verification: half the step changes the largest values of {', '.join(changed)} by more "
                          f"than {100.0 * NOTABLE:g} %; run "
                             "with a shorter step and compare again")
        if unknown:
            out.note_text(f"verification: {', '.join(unknown)} cannot be compared, because values are not numbers")


def bent_elements(sim: Sim, out: CommandOutput, state: str) -> None:
    """A note if elements that were described straight are bent by more than 0.01 rad in this state, which the mass of a
    straight element does not follow: the warning of the model check, for the state that was reached instead of the
    first one."""
    for text in of_model(sim):
        if "with the mass of a straight one" in text:
            out.note_text(Foreign(f"{state}: {text}"))


def energy_error(sim: Sim, out: CommandOutput, first: FirstTenth, complete: bool) -> None:
    """The error at the end, and its parts in the first and the last tenth of a run that is complete."""
    energy = sim.energy()
    out.summary.update(energy_error=energy.error, energy_error_growth=energy.growth)
    text = f"energy error {energy.error:.1e} of the largest energy supplied, dissipated, exchanged or present"
    if not abs(energy.error) <= LARGE:  # also NaN
        out.note_text("the energy error is larger than 5 % of the energies of the run: its results are not reliable; "
                      "run with a tenth of the step and compare")
    if complete and first.balance is not None and energy.scale > 0.0:
        begin = abs(first.balance) / energy.scale
        out.summary["energy_error_first_tenth"] = begin
        text += f"; its change in the first tenth of the run {begin:.1e}, in the last tenth {abs(energy.growth):.1e}"
        if abs(energy.growth) > max(SMALL, GROWS * begin):
            out.note_text("the energy error grows faster at the end of the run than at its beginning: the steps do not "
                          "resolve the motion there; "
                             "run with half the step and compare")
    else:
        text += f", of which {energy.growth:.1e} in the last tenth of the run"
    out.say(text)
