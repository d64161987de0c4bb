"""A map: the study of a scene for all combinations of some of its values, with the same random numbers in each, so that
differences between cells are those of the values."""
from __future__ import annotations

import argparse
import itertools
import math
import re
import tomllib
from dataclasses import dataclass, field
from typing import Any

from .._optional import need
from ..results import CommandOutput
from ..errors import Error, Usage
from ..exit_status import FAILED, STOPPED, line_of
from ..runner import carry_out
from ..scene import CannotSave, SceneError
from ..scene.failure import KINDS
from ..scene.override_keys import refuse_wrong
from ..scene.overrides import by_number
from .results import ANY, StudyResults, StudySettings
from .auto import Auto
from .demands import Demand, amount
from .draw import CannotDraw
from .estimates import Estimate
from .sample import SceneSample
from .study import Lock, StudyError

MOST_CELLS = 400
FLAT = 0.01         #: relative change of demands below which a key is said to change none
MOST_LINES = 12     #: pairs of neighbours that are stated on the terminal
SIGNIFICANT = 0.05  #: chance below which a difference counts as shown


@dataclass
class Cell:
    """One combination."""
    values: dict[str, Any]
    message: str = ""                                       #: why it has no result
    estimates: dict[str, Estimate] = field(default_factory=dict)
    demands: dict[str, Demand] = field(default_factory=dict)
    #: samples with margins, by number: any failure, or that of --failure
    failing: dict[int, bool] = field(default_factory=dict)
    dimension: int = 0

    @property
    def words(self) -> str:
        """The values."""
        return ", ".join(f"{key} = {value}" for key, value in self.values.items())


def _varied(texts: list[str], content: dict[str, Any]) -> list[tuple[str, list[Any]]]:
    """Keys and values. content: of the scene file, for keys with names."""
    from ..sweep import keys_of, varied
    try:
        found = [varied(text) for text in texts]
        keys = [one for key, _ in found for one in keys_of(key)]
        refuse_wrong(keys, content)
    except ValueError as error:
        raise Usage(f"--vary {error}") from None
    settings = [one for one in keys if re.fullmatch(r"variability\.\w+", one)]
    if settings:
        raise Usage(f"--vary {settings[0]}: is a setting of the study, which all cells have in common; change it in "
                    "the scene or by an option of the command")
    count = math.prod(len(values) for _, values in found)
    if count > MOST_CELLS:
        raise Usage(f"--vary asks for {count} cells, must be <= {MOST_CELLS}")
    return found


def _plain(key: str) -> str:
    """A key without the number 0 of tables and without those of pipes, as fields along a string write all pipes."""
    return re.sub(r"\.pipes\[\d+\]", ".pipes", key).replace("[0]", "")


class Map:
    """All cells of one command."""

    def __init__(self, sample: SceneSample, options: argparse.Namespace, question: str, output: CommandOutput) -> None:
        self.sample, self.options, self.question, self.output = sample, options, question, output
        self.content = tomllib.loads(sample.text)
        self.vary = _varied(options.vary, self.content)
        self._refuse_lost()
        self.cells: list[Cell] = []

    def _refuse_lost(self) -> None:
        """Keys that each sample writes again: the values of --vary would be lost."""
        from ..sweep import keys_of
        varies = self.sample.draw.varies
        parts = [("scatter", i, one)
                 for i, one in enumerate(varies.scatters)] + [("field", i, one) for i, one in enumerate(varies.fields)]
        written = {_plain(key): (table, i, one.name) for table, i, one in parts if not one.relative for key in one.keys}
        for text, _ in self.vary:
            for key in keys_of(text):
                plain = _plain(by_number(key, self.content))
                if plain in written:
                    table, i, name = written[plain]
                    raise Usage(f"--vary {key}: each sample has a value of its own, of {name}, so that these would be "
                                "lost; vary a parameter of the "
                                f"distribution, as variability.{table}[{i}].mean, or make it relative = true")

    def compute(self) -> int:
        """All cells, then the map; returns the exit status: 1 where a cell has no result."""
        # a second master is refused here, not by each cell
        status, lock = 0, Lock(self.output.folder / "map", "--output folder") if self.output.folder else None
        try:
            for number, values in enumerate(itertools.product(*(listed for _, listed in self.vary)), 1):
                self.cells.append(self._cell(number, dict(zip((key for key, _ in self.vary), values))))
        except KeyboardInterrupt:
            self.output.stopped(f"stopped by Ctrl-C after {len(self.cells)} cells"
                                + ("; the same command continues from there" if self.output.folder else ""))
        finally:
            if lock is not None:
                lock.release()
        if any(one.message for one in self.cells) or not self.cells:
            status = FAILED
        if len({one.dimension for one in self.cells if not one.message}) > 1:
            self.output.note_text("the cells have different numbers of random numbers, because fields or processes "
                                  "have other lengths: they are not common")
        self._write()
        return self.output.finish(status)

    def _cell(self, number: int, values: dict[str, Any]) -> Cell:
        from ..sweep import settings_of
        cell, file = Cell(values), self.options.scene
        whole, folder = self.sample, self.output.folder
        sample = SceneSample(whole.text, whole.name, whole.folder, whole.own,
                             {**whole.overrides, **settings_of(values)}, whole.given_question)
        try:
            study_settings = StudySettings(sample, self.options)
            output = CommandOutput(str(folder / f"{number:05d}") if folder else None, file, sample.draw.scene,
                                   "probability", True)
            made = Auto(study_settings, output) if self.question == "auto" else StudyResults(study_settings, output)
            status = carry_out(sample.draw.scene, output, self.options, lambda *_: made.compute())
            if status == STOPPED:
                raise KeyboardInterrupt
            cell.estimates, cell.demands, cell.dimension = made.estimates, made.demands, sample.dimension
            cell.failing = made.failing
            cell.message = "" if status == 0 else "no sample has a margin"
            for text in output.summary["warnings"] + output.summary["notes"]:
                if text not in self.output.summary["warnings"] and not text.startswith("sample "):
                    self.output.warn(text)
        except (CannotDraw, StudyError, SceneError, CannotSave, Error, ArithmeticError) as error:
            cell.message = str(error) if isinstance(error, (CannotDraw, StudyError)) else line_of(error)
        self._say(number, cell)
        return cell

    def _say(self, number: int, cell: Cell) -> None:
        one = cell.estimates.get(self.options.failure or ANY)
        text = cell.message or (f"{self.options.failure or ANY} {one.probability:.4g} ({one.low:.4g} .. {one.high:.4g})"
                                if one else "no estimate")
        text += "".join(f", P{demand.worst.percent} of {name} "
                        f"{amount(demand.worst.value, KINDS[demand.failure.kind].unit)}"
                        for name, demand in cell.demands.items())
        self.output.say(f"cell {number}: {cell.words}: {text}")

    # ---- The map -----------------------------------------------------------------------------------------------------
    def _write(self) -> None:
        keys = [key for key, _ in self.vary]
        first = next((one for one in self.cells if not one.message), None)
        names, demands = list(first.estimates) if first else [], list(first.demands) if first else []
        heads = [*keys, *(head for name in names for head in (f"probability of {name}", f"low of {name}",
                                                              f"high of {name}")),
                 *(f"P{percent} demand of {name} [{KINDS[first.demands[name].failure.kind].unit}]" for name in demands
                   for percent in (5, 50, 95) if first),
                 *(f"P95 demand of {name}: {end}" for name in demands for end in ("low", "high")),
                 *(f"share of the limit at P95 of {name} [-]" for name in demands),
                 "fails only here", "fails only in the first cell", "chance of so unequal counts", "message"]
        rows = [[*one.values.values(), *self._numbers(one, names, demands), *self._against(first, one), one.message]
                for one in self.cells]
        self.output.table("map.csv", heads, rows)
        self.output.summary["cells"] = [{"values": {key: str(value) for key, value in one.values.items()},
                                         "message": one.message,
                                         "estimates": {name: vars(estimate)
                                                       for name, estimate in one.estimates.items()},
                                         "demands": {name: demand.record() for name, demand in one.demands.items()}}
                                        for one in self.cells]
        self._pairs()
        self._flat()
        wide = [one for one in self.vary if len(one[1]) > 1] or self.vary[:1]
        if first and len(wide) <= 2:
            self.output.picture("map.png", lambda plots: plots.probability_map(wide, self._grid(),
                                                                               self.options.failure or ANY))

    def _grid(self) -> list[Any]:
        """Probability and interval of each cell in order; None where there is no result."""
        name = self.options.failure or ANY
        found = [(one.estimates[name].probability, one.estimates[name].low, one.estimates[name].high)
                 if name in one.estimates else None for one in self.cells]
        return found + [None] * (math.prod(len(values) for _, values in self.vary) - len(found))

    @staticmethod
    def _numbers(cell: Cell, names: list[str], demands: list[str]) -> list[Any]:
        def of(name: str) -> list[float]:
            one = cell.estimates.get(name)
            return [one.probability, one.low, one.high] if one else [math.nan] * 3
        known = [cell.demands.get(name) for name in demands]
        return [*(number for name in names for number in of(name)),
                *(one.percentiles[i].value if one else math.nan for one in known for i in range(3)),
                *(end for one in known for end in ((one.percentiles[-1].low, one.percentiles[-1].high) if one
                                                   else (math.nan, math.nan))),
                *(one.percentiles[-1].share if one else math.nan for one in known)]

    def _against(self, first: Cell | None, cell: Cell) -> list[Any]:
        """Samples that fail here and not in the first cell, the other way round, and the chance of so unequal
        counts."""
        found = paired(first, cell) if first is not None and self.question != "auto" else None
        return ["", "", ""] if found is None else [found.more, found.fewer, found.chance]

    # ---- Neighbours --------------------------------------------------------------------------------------------------
    def _pairs(self) -> None:
        """Pairs of cells that differ by one step of one key, as a table and, where they are few, as lines."""
        if self.question == "auto":
            self.output.note_text("pairs of cells are not compared, because the question auto runs other samples in "
                                  "each cell; ask --question run")
            return
        found = [(key, a, b, one) for key, a, b in self._neighbours() if (one := paired(a, b)) is not None]
        rows = [[key, a.values[key], b.values[key], *(value for other, value in a.values.items() if other != key),
                 one.samples, one.more, one.fewer,
                 one.chance, one.word] for key, a, b, one in found]
        if not rows:
            return
        self.output.table("pairs.csv",
                          ["key", "from", "to", *(f"other value {i + 1}" for i in range(len(self.vary) - 1)), "samples",
                           "fail only after",
                           "fail only before", "chance of so unequal counts", "probability"], rows)
        self.output.summary["pairs"] = [{"key": key, "from": a.values, "to": b.values, **vars(one),
                                         "probability": one.word} for key, a, b, one in found]
        for key, a, b, one in found if len(found) <= MOST_LINES else []:
            others = ", ".join(f"{other} = {value}" for other, value in a.values.items() if other != key
                               and len(dict(self.vary)[other]) > 1)
            self.output.say(f"{key} from {a.values[key]} to {b.values[key]}" + (f", at {others}" if others else "")
                            + f": {one.more} more fail and {one.fewer} "
                            f"fewer of the same {one.samples} samples, {one.words}")

    def _flat(self) -> None:
        """A note of keys that change no demand: the question may leave out their effect."""
        most: dict[str, float] = {}
        for key, a, b in self._neighbours():
            if not a.message and not b.message and (a.demands or b.demands):
                most[key] = max(most.get(key, 0.0), *(_change(a.demands.get(name), b.demands.get(name))
                                                      for name in a.demands.keys() | b.demands.keys()))
        for key, change in most.items():
            if change < FLAT:
                left_out = "; this question leaves out dynamics, on which speed and feed act: ask --question run or " \
                    "auto" if self.question in ("torque-drag", "static") else ""
                self.output.note_text(f"{key} changes no percentile of a demand by more than {100.0 * change:.2g} "
                                      f"%{left_out}")

    def _neighbours(self) -> list[tuple[str, Cell, Cell]]:
        by_index = dict(zip(itertools.product(*(range(len(values)) for _, values in self.vary)), self.cells))
        found = []
        for d, (key, _) in enumerate(self.vary):
            for index, cell in by_index.items():
                other = by_index.get((*index[:d], index[d] + 1, *index[d + 1:]))
                if other is not None:
                    found.append((key, cell, other))
        return found


def _change(a: Demand | None, b: Demand | None) -> float:
    """Largest relative difference of the percentiles of a demand, or of its limit; 1 where a cell has none, or its
    samples have limits of their own."""
    if a is None or b is None or a.limit_varies or b.limit_varies:
        return 1.0
    values = [(one.value, other.value)
              for one, other in zip(a.percentiles, b.percentiles)] + [(a.failure.limit, b.failure.limit)]
    return max(0.0 if x == y else min(1.0, abs(x - y) / max(abs(x), abs(y))) if math.isfinite(x) and math.isfinite(y)
               else 1.0 for x, y in values)


@dataclass(frozen=True)
class Pair:
    """Two cells with the same samples."""
    samples: int    #: with all margins in both
    more: int       #: fail in the second only
    fewer: int      #: fail in the first only
    chance: float   #: of so unequal counts if both were as likely (McNemar 1947, exact)

    @property
    def words(self) -> str:
        """The effect, the difference of the probabilities and the test."""
        if not self.samples:
            return self.word
        return (f"{(self.more - self.fewer) / self.samples:+.3g}: {self.word} (exact McNemar test, p = "
                f"{self.chance:.2g})")

    @property
    def word(self) -> str:
        """The effect on the probability."""
        if self.more + self.fewer == 0:
            return "no sample differs" if self.samples else "not assessed, because no sample has all margins in both"
        if self.chance > SIGNIFICANT:
            return "a difference is not shown"
        return "the probability rises" if self.more > self.fewer else "the probability falls"


def paired(a: Cell, b: Cell) -> Pair | None:
    """Of two cells; None where their samples are not the same."""
    if a.message or b.message or a.dimension != b.dimension:
        return None
    both = a.failing.keys() & b.failing.keys()
    more, fewer = (sum(x.failing[n] and not y.failing[n] for n in both) for x, y in ((b, a), (a, b)))
    chance = float(need("scipy.stats").binomtest(more, more + fewer, 0.5).pvalue) if more + fewer else 1.0
    return Pair(len(both), more, fewer, chance)


def probability_map(sample: SceneSample, options: argparse.Namespace) -> int:
    """The map that --vary asks for; returns the exit status."""
    if options.engine == "mpi":
        raise Usage("--vary has one study after the other, and --engine mpi one: choose another --engine")
    if options.indices or (options.method or sample.draw.varies.method) == "subset":
        raise Usage("--vary maps probabilities of plain samples: leave --indices and --method subset out")
    question = options.question or sample.draw.scene.variability.question  # type: ignore[union-attr]
    output = CommandOutput(options.output, options.scene, sample.draw.scene, "probability", options.quiet)
    output.started = options.started
    output.summary.update(question=question, vary=options.vary)
    made = Map(sample, options, question, output)
    return carry_out(sample.draw.scene, output, options, lambda *_: made.compute())

