"""A run in time: the calls that it is divided into, its progress, and the bar that shows it."""
from __future__ import annotations

import math
import sys
import time as clock
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import IO, TYPE_CHECKING, Any, Protocol

from ._optional import need
from ._values import refuse_type, refuse_value
from .enums import NOTE_CANCELLED, NOTE_FULL, NOTE_STOPPED, NOTE_TOLERANCE, NOTE_WORK_LIMITED, Status

if TYPE_CHECKING:
    from .sim import Sim

#: [s] by the clock that one call of several steps lasts at most, about: so long Ctrl-C and progress functions wait
LONGEST = 0.05
#: notes of a run that lacks rows, or whose steps are less accurate than requested
INCOMPLETE = (NOTE_FULL, NOTE_WORK_LIMITED, NOTE_TOLERANCE)
ROUNDING = 1e-6  #: of a step, by which times of samples may be off


class Taker(Protocol):
    """Takes a sample after each step: Fatigue, StringFatigue, Window. One that has due() -> float, the time [s] of the
    sim before which take() does nothing, is called from that time on only, and steps before it are made in one call."""

    def take(self) -> int:
        """A sample; returns the status."""


@dataclass
class Progress:
    """Progress of Sim.run, for its progress function."""
    time: float       #: [s] of the sim
    end: float        #: [s] where the run ends
    steps: int        #: [-] accepted so far in this run
    elapsed: float    #: [s] by the clock since the run began
    begin: float = 0.0  #: [s] of the sim, where the run began
    status: int = 0   #: the largest of the notes, else OK
    notes: dict[Status, str] = field(default_factory=dict)  #: of steps and recorder so far, each with its last message

    def copy(self) -> Progress:
        """Another with the same values."""
        return replace(self, notes=dict(self.notes))

    def note(self, status: int, message: str) -> None:
        """Keeps a note of a call; a call that max_steps stopped continues."""
        if status > 0 and status != NOTE_STOPPED:
            self.notes[Status(status)] = message
            self.status = max(self.notes)

    @property
    def fraction(self) -> float:
        """[-] done, 0 .. 1"""
        return (self.time - self.begin) / (self.end - self.begin) if self.end > self.begin else 1.0

    @property
    def real_time_factor(self) -> float:
        """[-] simulated time over time by the clock"""
        return (self.time - self.begin) / self.elapsed if self.elapsed > 0.0 else 0.0


class Lengths:
    """The calls that a run is divided into: equal steps and a shorter last one, or hundredths."""

    def __init__(self, begin: float, end: float, step: float | None) -> None:
        self.begin, self.end, self.length, self.rest = begin, end, step, 0.0
        if not math.isfinite(end):
            refuse_value("run", "end", end, "be finite [s]")
        if end < begin - 1e-9 * max(1.0, abs(begin)):
            refuse_value("run", "end", end, f"be >= the time of the sim ({begin:g} s)")
        self.count = 100 if end > begin else 0
        if step is not None and not 0.0 < step < math.inf:
            refuse_value("run", "step", step, "be > 0 and finite [s]")
        if step:
            self.count = max(0, math.floor((end - begin) / step + 1e-6))
            rest = end - begin - self.count * step
            if rest > 1e-6 * step:
                self.rest, self.count = rest, self.count + 1

    def done(self, time: float) -> int:
        """The calls that a run which stands at `time` [s] has behind it."""
        if self.count == 0 or time <= self.begin:
            return 0
        passed = (time - self.begin) / (self.length or (self.end - self.begin) / self.count)
        return self.count if time >= self.end else min(self.count, math.floor(passed + 1e-6))

    def step(self, number: int) -> float:
        """[s] length of step `number`, from 1."""
        return self.rest if self.rest and number == self.count else self.length or 0.0

    def equal(self, number: int) -> int:
        """Steps of the same length from step `number` on."""
        return max(1, self.count - number + 1 - (1 if self.rest else 0))

    def target(self, number: int) -> float:
        """[s] where call `number` ends, from 1."""
        return self.end if number == self.count else self.begin + (self.end - self.begin) * number / self.count


class Bar:
    """A progress function that shows a bar on the terminal: by tqdm where it is there, else a line of its own. It shows
    nothing where no terminal is there."""

    def __init__(self, begin: float, end: float, stream: IO[str] | None = None) -> None:
        self.bar: Any = None
        self.stream = sys.stderr if stream is None else stream
        self.begin, self.done, self.end = begin, begin, end
        self.looked_at = self.stream.isatty()
        if self.looked_at:
            try:
                self.bar = need("tqdm").tqdm(total=end - begin, unit="s", unit_scale=False, file=self.stream,
                                             bar_format="{percentage:3.0f} %|{bar}| {n:.2f}/{total:.2f} s, left "
                                                        "{remaining}{postfix}")
            except ImportError:
                pass

    def __call__(self, at: Progress) -> None:
        if self.bar is not None:
            self.bar.set_postfix_str(f"{at.real_time_factor:.1f} times real time", refresh=False)
            self.bar.update(at.time - self.done)
        elif self.looked_at:
            filled = round(40 * at.fraction)
            self.stream.write(f"\r{100 * at.fraction:3.0f} %|{'#' * filled:40s}| {at.time - self.begin:.2f}/"
                              f"{self.end - self.begin:.2f} s, {at.real_time_factor:.1f} times real time ")
            self.stream.flush()
        self.done = at.time

    def close(self) -> None:
        """Leaves the line."""
        if self.bar is not None:
            self.bar.close()
        elif self.looked_at:
            self.stream.write("\n")


def own_takers(sim: Any, recorder: Any, counters: Sequence[Taker]) -> list[Taker]:
    """Recorder and counters, which must be of this sim: of another they would take its state again and again."""
    takers = [*([] if recorder is None else [recorder]), *counters]
    for one in takers:
        if not hasattr(one, "take"):
            refuse_type("run", "recorder" if one is recorder else "counters", one, "have a take()")
        if getattr(one, "sim", sim) is not sim:
            refuse_value("run", "recorder" if one is recorder else "counters", one, "be of this sim")
    return takers


def take_all(takers: list[Taker], at: Progress) -> None:
    """A sample of each."""
    for one in takers:
        if one.take() == NOTE_FULL:
            at.note(NOTE_FULL, "the recorder is full: later rows are lost; give it more capacity, or an interval")


def warn_of(at: Progress) -> None:
    """A warning for each note of a run by which its results are incomplete or less accurate than the tolerances."""
    for status in INCOMPLETE:
        if status in at.notes:
            warnings.warn(f"run: {at.notes[status]}", RuntimeWarning, stacklevel=3)


def sample_due(interval: float, first: float, last: float) -> float:
    """[s] of the next row of a recorder: rows belong to whole multiples of the interval since the first one
    (dmb_sample_is_due)."""
    return first + (math.floor((last - first) / interval + ROUNDING) + 1) * interval


# ---- The loop --------------------------------------------------------------------------------------------------------
class Loop:
    """A run in time. Equal steps are made many in a call: up to the next sample, or until the call lasts LONGEST. The
    bits of the results do not depend on that."""

    def __init__(self, sim: Sim, lengths: Lengths, takers: list[Taker], tell: Callable[[Progress], Any] | None,
                 every: float) -> None:
        self.sim, self.lengths, self.takers, self.tell = sim, lengths, takers, tell
        self.every, self.longest = every, min(LONGEST, every) if tell else LONGEST
        self.most = 1  # steps in a call
        self.started = self.told = clock.monotonic()
        self.at = Progress(sim.time, lengths.end, 0, 0.0, lengths.begin)
        self.number = lengths.done(sim.time)

    def go(self) -> Progress:
        """To the end, or to where the progress function or that of accepted steps stops it."""
        while self.number < self.lengths.count:
            before, began = self.sim.time, clock.monotonic()
            try:
                going = self._call()
            except KeyboardInterrupt:
                if self.sim.time > before:  # the call was done when it came
                    self._take()
                raise
            if not going:
                break
            self._take()
            if self.sim._teller.ended or self._told(clock.monotonic(), began):
                break
        self.at.time, self.at.elapsed = self.sim.time, clock.monotonic() - self.started
        return self.at

    def _call(self) -> bool:
        """One call; False where the progress function of the sim ended it."""
        count = self._count() if self.lengths.length else 1
        self.number += count
        self.sim._teller.ended = False
        if not self.lengths.length:
            report = self._advance(self.lengths.target(self.number))
        elif count == 1:
            report = self.sim.step(self.lengths.step(self.number))
        else:
            report = self.sim.steps(self.lengths.length, count)
        self.made = count
        self.at.steps += report.steps
        if report.status:
            self.at.note(report.status, self.sim.message)
        if report.status == NOTE_STOPPED:  # max_steps of one call; go on
            self.number -= 1
        return bool(report.status != NOTE_CANCELLED)

    def _take(self) -> None:
        """A sample of each after a call of equal steps; of others they had one after each step."""
        if self.lengths.length:
            take_all(self.takers, self.at)

    def _advance(self, time: float) -> Any:
        """To a time [s] with steps of the library's choice, after each of which the takers have their turn."""
        usual = self.sim.on_step
        if not self.takers:
            return self.sim.advance(time)

        def accepted(now: float) -> bool:
            take_all(self.takers, self.at)
            return usual is not None and bool(usual(now))

        self.sim.on_step = accepted
        try:
            return self.sim.advance(time)
        finally:
            self.sim.on_step = usual

    def _count(self) -> int:
        """Steps of the next call: the last one of them is the first after which a taker has something to do."""
        most = min(self.most, self.lengths.equal(self.number + 1))
        step, time = self.lengths.length or 0.0, self.sim.time
        for one in self.takers if most > 1 else ():
            left = (one.due() - time) / step if hasattr(one, "due") else 0.0
            if left < most:
                most = max(1, math.ceil(max(left, 0.0) - ROUNDING))
        return most

    def _told(self, now: float, began: float) -> bool:
        """True where the progress function wants the run to end."""
        self.at.time, self.at.elapsed = self.sim.time, now - self.started
        one = max((now - began) / self.made, 1e-9)
        self.most = max(1, min(2 * self.most, int(self.longest / one)))
        if self.tell is None or not (now - self.told >= self.every or self.number == self.lengths.count):
            return False
        self.told = now
        return bool(self.tell(self.at.copy()))
