"""A run in time: the calls that it is divided into, its progress, and the bar that shows it."""
from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import IO, Any, Protocol

from ._optional import need
from ._values import refuse_type, refuse_value
from .enums import NOTE_FULL


class Taker(Protocol):
    """Takes a sample after each step: Fatigue, StringFatigue, Window."""

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
    status: int = 0   #: NOTE_FULL where the recorder had no room for a row, else OK

    def copy(self) -> Progress:
        """Another with the same values."""
        return replace(self)

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

    def target(self, number: int) -> float:
        """[s] where call `number` ends, from 1."""
        return self.end if number == self.count else self.begin + (self.end - self.begin) * number / self.count


class Bar:
    """A progress function that shows a bar on the terminal: by tqdm where it is there, else a line of its own. It shows
    nothing where nobody looks."""

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
    """A sample of each; a recorder that is full warns once in a run."""
    for one in takers:
        if one.take() == NOTE_FULL and at.status != NOTE_FULL:
            at.status = NOTE_FULL
            warnings.warn("the recorder of a run is full: later rows are lost; give it more capacity, or an interval",
                          RuntimeWarning, stacklevel=3)
