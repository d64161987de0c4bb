"""Where results of the command go, and the options that all commands have."""
from __future__ import annotations

import csv
import json
import math
import os
import pathlib
import re
import time
from collections.abc import Callable, Iterable
from typing import Any

from . import __version__
from ._optional import need
from ._progress import INTERRUPTS
from ._structs import FatigueResult
from .enums import Status
from .errors import Usage, status_text
from .exit_status import STOPPED
from .fatigue import StringFatigue
from .language import ENGLISH, Foreign, Language, phrase
from .running import INCOMPLETE
from .scene import Scene, saves
from .scene.units import UnitError, parse
from .sim import Sim
from .unit_choice import NAMES
from .unit_systems import SI, Units

RPM = 2.0 * math.pi / 60.0
_FORMULA = re.compile(r"[=+\-@\t\r\n]")  # the first character of a cell that a spreadsheet computes
_AMOUNT = re.compile(r"[-+][0-9.]+(?:[eE][-+]?[0-9]+)?(?: ?[A-Za-z%][A-Za-z0-9/^ %]*)?")


class CommandOutput:
    """The folder of the results and the lines on the terminal."""

    def __init__(self, folder: str | None, file: str, scene: Scene, command: str, quiet: bool, units: Units = SI,
                 language: Language = ENGLISH) -> None:
        self.folder = pathlib.Path(folder) if folder is not None else None
        self.quiet, self.scene, self.units, self.language = quiet, scene, units, language
        self.started = time.perf_counter()
        self.meter: Any = None             # of the progress, which lines of text go before
        self.interrupted = False
        self.summary: dict[str, Any] = {"command": command, "scene": os.path.basename(file), "title": scene.title,
                                        "drillmbd": __version__, "units": units.name,  # of texts, tables and pictures
                                        "units_of_numbers": "si", "warnings": [], "notes": [], "files": []}
        if self.folder is not None:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.path("scene.toml").write_text(saves(scene), encoding="utf-8")

    def path(self, name: str) -> pathlib.Path:
        """A file in the folder; it is named in the summary."""
        assert self.folder is not None
        if name not in self.summary["files"]:
            self.summary["files"].append(name)
        return self.folder / name

    def say(self, text: str) -> None:
        """A line on the terminal."""
        if not self.quiet:
            if self.meter is not None:
                self.meter.clear()
            print(self.language(text))

    def warn(self, text: str) -> None:
        """Something about the scene, the same in each command."""
        if text not in self.summary["warnings"]:
            self.summary["warnings"].append(text)
            self.say(phrase("note: {text}", text=text))

    def stopped(self, text: str) -> None:
        """A note that Ctrl-C ended the command, by which its exit status is 130."""
        self.interrupted, INTERRUPTS.pending = True, False
        self.note_text(text)

    def note(self, status: int, of: str, message: str = "") -> None:
        """Notes the text of a status above 0. message: of the library, which states the reason of NOTE_INCOMPLETE."""
        if status == Status.NOTE_INCOMPLETE and message:
            self.note_text(self.units.sentence(message))
        elif status > 0:
            self.note_text(self.units.sentence(phrase("{analysis}: {reason}", analysis=of,
                                                      reason=Foreign(status_text(status)))))

    def note_text(self, text: str) -> None:
        """A note."""
        self.summary["notes"].append(text)
        self.say(phrase("note: {text}", text=text))

    def table(self, name: str, heads: list[str], rows: Iterable[Iterable[Any]]) -> None:
        """A CSV file. Heads and rows are in SI; they are written in the units of the output."""
        if self.folder is not None:
            with open(self.path(name), "w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow([no_formula(self.units.head(head)) for head in heads])
                factors = [self.units.factor_of(head) for head in heads]
                writer.writerows([[repr(float(one) * factor) if isinstance(one, float) else no_formula(one)
                                   for one, factor in zip(row, factors)]
                                  for row in rows])

    def picture(self, name: str, draw: Callable[[Any], Any]) -> None:
        """A picture by a function of drillmbd.plots, where matplotlib is there."""
        if self.folder is None:
            return
        try:
            need("matplotlib").use("Agg")
            from . import plots
            figure = draw(plots)
        except ImportError as error:
            self.summary["notes"].append(f"no {name}: {error}")
            return
        figure.savefig(self.path(name), dpi=110)
        need("matplotlib.pyplot").close(figure)

    def finish(self, status: int = 0) -> int:
        """Writes the summary; returns the exit status: that which is given, or 130 after Ctrl-C."""
        status = STOPPED if self.interrupted else status
        self.write_summary(status)
        if self.folder is not None:
            self.say(phrase("{count} files in {folder}", count=len(self.summary["files"]), folder=str(self.folder)))
        return status

    def write_summary(self, status: int) -> None:
        """Everything that was found, with the exit status and the time since the command began."""
        self.summary.update(status=status, elapsed_s=time.perf_counter() - self.started)
        if self.folder is not None:
            self.path("summary.json").write_text(json.dumps(finite(self.summary), indent=1) + "\n", encoding="utf-8")


def no_formula(cell: Any) -> Any:
    """A cell of a CSV file. Spreadsheets compute a text that begins with = + - @ or a control character; an apostrophe
    before it makes it text.
    A number with its unit, as "-5 mm", is no formula."""
    return f"'{cell}" if isinstance(cell, str) and _FORMULA.match(cell) and not _AMOUNT.fullmatch(cell) else cell


def note_bounces(sim: Any, out: CommandOutput) -> None:
    """One note for a run in which contacts opened before ten steps had passed."""
    bounces = sim.statistics().bounces
    out.summary["run"]["bounces"] = bounces
    if bounces:
        out.note_text(
            phrase("run: {bounces} contacts with the wall, stops or springs opened within fewer than ten steps after "
                   "they"
                   " closed; the steps do not resolve these bounces, so speeds after them are uncertain; run again "
                   "with half"
                   " the step and compare", bounces=bounces))


def note_steps(notes: dict[Status, str], out: CommandOutput) -> None:
    """A note for each reason for which a run lacks rows, or its steps are less accurate than the tolerances."""
    for status in INCOMPLETE:
        if status in notes:
            out.note_text(out.units.sentence(phrase("{analysis}: {reason}", analysis="run",
                                                    reason=Foreign(notes[status]))))


def key_of(name: str, unit: str) -> str:
    """The key of summary.json: the name with its unit, as "hook_load_N" or "surge_density_kg_m3"."""
    return name if unit in ("", "-") else f"{name}_{unit.replace('/', '_').replace(' ', '_')}"


def finite(value: Any) -> Any:
    """The value as JSON has it: no NaN, no infinity."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(one) for key, one in value.items()}
    return [finite(one) for one in value] if isinstance(value, (list, tuple)) else value


def record(struct: Any) -> dict[str, Any]:
    """A struct as plain Python for the summary."""
    return {key: value for key, value in struct.describe(every=True).items()
            if isinstance(value, (int, float, list, str))
            and not (isinstance(value, list) and value and not isinstance(value[0], (int, float)))}


def percent(share: float) -> str:
    """Two digits, 770 % of 7.71."""
    return f"{float(f'{100.0 * share:.2g}'):g} %"


def file_name(name: str) -> str:
    from .scene.save import clean_name
    return clean_name(name)


# ---- Options ---------------------------------------------------------------------------------------------------------
def units_of(options: Any, scene: Scene) -> Units:
    """The units of the output, of the command line or of the scene. Raises UnknownUnit for outputs without an
    equivalent."""
    units = Units(options.units or NAMES[scene.results.get("units", 0)])
    if options.command in ("run", "report"):
        for unit in scene.output_units:
            units.unit(unit)
    return units


def quantity(text: str, unit: str, option: str) -> float:
    """An option of the command line as a number in its unit."""
    try:
        return float(parse(text, unit))
    except UnitError as error:
        raise Usage(f"{option} {text!r}: {error}") from None


def friction_option(options: Any) -> dict[str, Any]:
    """--friction of the command line as an option of torque and drag; none: that of the wall."""
    if options.friction is None:
        return {}
    if not options.friction >= 0.0:
        raise Usage(f"--friction {options.friction:g}, must be >= 0")
    return {"friction": options.friction}


# ---- Fatigue of a run ------------------------------------------------------------------------------------------------
def count_fatigue(scene: Scene, sim: Sim) -> dict[str, StringFatigue]:
    """Counters of each string where the scene has [fatigue]; levels of stress up to twice the largest known limit."""
    if "fatigue" not in scene.analyses:
        return {}
    return {name: sim.string_fatigue(scene.names[name], pipes, **scene.effective("fatigue"))
            for name, pipes in scene.pipes.items()}


def report_fatigue(counters: dict[str, StringFatigue], out: CommandOutput) -> dict[str, FatigueResult]:
    """The worst pipe of each string."""
    worst = {}
    for name, one in counters.items():
        found, index = one.results, one.worst
        worst[name] = found[index]
        out.summary.setdefault("fatigue", {})[name] = {
            "damage": found[index].damage, "life_s": found[index].life, "pipe": one.pipes[index],
            "largest_range_Pa": found[index].largest_range, "time_s": found[index].time}
        out.say(phrase("{string}: damage {damage:.3g} in {time:.4g} s at pipe {pipe}, largest range {range}",
                       string=name, damage=found[index].damage,
                          time=found[index].time, pipe=one.pipes[index],
                       range=out.units.text(found[index].largest_range / 1e6, "MPa")))
        if len(one.pipes) < one.count:
            out.note_text(phrase("fatigue of {string}: cycles are counted in {counted} of its {pipes} pipes, spread "
                                 "evenly",
                                 string=name, counted=len(one.pipes), pipes=one.count))
        clipped = sum(result.clipped for result in found)
        if clipped:
            out.note_text(phrase("fatigue of {string}: {clipped} stresses were beyond stress_range and count too "
                                 "little", string=name,
                                    clipped=clipped))
        heads = ["pipe", "damage [-]", "cycles [-]", "largest range [Pa]", "lowest [Pa]", "highest [Pa]", "life [s]"]
        out.table(f"fatigue_{file_name(name)}.csv", heads, (
            [pipe, one.damage, one.cycles, one.largest_range, one.lowest, one.highest, one.life]
            for pipe, one in zip(one.pipes, found)))
        out.picture(f"fatigue_{file_name(name)}.png", lambda plots: plots.fatigue(one, f"{name}: fatigue of the run",
                                                                                  out.units))
    return worst
