"""One command for all combinations of some values of a scene, and the numbers of the results in one table."""
from __future__ import annotations

import csv
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import time
import tomllib
from collections.abc import Callable, Iterable
from typing import Any

from . import __version__
from .results import CommandOutput, no_formula, units_of
from .errors import Error, Usage
from .exit_status import FAILED, STOPPED, line_of
from .probability.study import code
from .commands import COMMANDS
from .runner import carry_out
from .scene import CannotSave, Scene, SceneError, saves
from .scene.override_keys import refuse_wrong
from .scene.overrides import path_of_key

_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")
_KEY_AND_VALUES = re.compile(r"((?:[^=\[]|\[[^\]]*\])*)=(.*)", re.DOTALL)  # names in brackets may contain = and &
_AND = re.compile(r"&(?![^\[]*\])")
_NOT_NUMBERS = ("command", "scene", "title", "drillmbd", "files", "status", "torque_drag_by_depth", "broomstick",
                "elapsed_s", "identity")
MOST_CASES, MOST_ITEMS = 100_000, 32


# ---- What varies -----------------------------------------------------------------------------------------------------
def value_of(text: str) -> Any:
    """A whole number, a number, or the text, as TOML would have it."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text.strip()


def _between(text: str) -> list[Any]:
    """ "60 mm:80 mm:5" as five values from end to end."""
    low, high, count = text.split(":")
    first, last = _QUANTITY.match(low), _QUANTITY.match(high)
    if first is None or last is None or first.group(2) != last.group(2):
        raise ValueError(f"{text!r}: write LOW:HIGH:COUNT with the same unit twice, as 60 mm:80 mm:5")
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", count) or not 2 <= int(count) <= MOST_CASES:
        raise ValueError(f"{text!r}: COUNT = {count.strip()}, must be a whole number 2 .. {MOST_CASES}")
    n = int(count)
    a, b = float(first.group(1)), float(last.group(1))
    numbers = [float(f"{a + (b - a) * i / (n - 1):.12g}") for i in range(n)]  # 0.35, not 0.35000000000000003
    return [f"{number!r} {first.group(2)}" if first.group(2) else number for number in numbers]


def varied(text: str) -> tuple[str, list[Any]]:
    """KEY=V1,V2,... or KEY=LOW:HIGH:COUNT as the key and its values; "A & B=V1 & W1,V2 & W2" of keys that change
    together, "A & B=V1,V2" where they have the same values. Raises ValueError."""
    found = _KEY_AND_VALUES.fullmatch(text)
    if found is None or not found[2].strip():
        raise ValueError(f"{text!r}: write KEY=V1,V2 or KEY=LOW:HIGH:COUNT")
    key, values = found.groups()
    keys = keys_of(key)
    for one in keys:
        path_of_key(one)
    listed = _between(values) if values.count(":") == 2 else [value_of(one) for one in values.split(",")]
    for value in listed:
        if len(keys) > 1 and len(_parts(value)) not in (1, len(keys)):
            raise ValueError(f"{text!r}: {value!r} has {len(_parts(value))} values for {len(keys)} keys; write one for "
                             "all of them, or one each between &")
    return " & ".join(keys), listed


def refuse_wrong_keys(keys: list[str], file: str) -> None:
    """Refuses keys that are not of the scene format, and those of tables that the scene file does not have, before any
    case. Raises ValueError; faults of the file are those of each case."""
    try:
        content = tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8-sig"))
    except (OSError, ValueError):
        content = None
    refuse_wrong(keys, content)


def keys_of(text: str) -> list[str]:
    """The keys of "A & B"."""
    return [one.strip() for one in _AND.split(text)]


def _parts(value: Any) -> list[Any]:
    return [value_of(one) for one in value.split("&")] if isinstance(value, str) else [value]


def settings_of(varied_values: dict[str, Any]) -> dict[str, Any]:
    """Values by keys as they vary, "A & B" among them, as values by single keys."""
    found: dict[str, Any] = {}
    for text, value in varied_values.items():
        keys = keys_of(text)
        parts = _parts(value) if len(keys) > 1 else [value]
        found.update(zip(keys, parts if len(parts) == len(keys) else parts * len(keys)))
    return found


# ---- Results ---------------------------------------------------------------------------------------------------------
def numbers_of(summary: Any, name: str = "") -> dict[str, float]:
    """Every number of a summary by its dotted name; of long lists the first items."""
    if isinstance(summary, bool) or isinstance(summary, (int, float)):
        return {name: float(summary)}
    if isinstance(summary, dict):
        items: Iterable[tuple[str, Any]] = ((f"{name}.{key}" if name else str(key), value)
                                            for key, value in summary.items()
                                            if name or key not in _NOT_NUMBERS)
    elif isinstance(summary, list):
        items = ((f"{name}[{i}]", value) for i, value in enumerate(summary[:MOST_ITEMS]))
    else:
        return {}
    return {key: value for text, one in items for key, value in numbers_of(one, text).items()}


class Sweep:
    """The cases of a sweep and their results."""

    def __init__(self, command: str, keys: list[str], folder: pathlib.Path | None, quiet: bool, count: int,
                 more: list[str]) -> None:
        self.command, self.keys, self.folder, self.quiet, self.count, self.more = (command, keys, folder, quiet,
                                                                                   count, more)
        self.rows: list[dict[str, Any]] = []
        self.failed = self.kept = 0
        self.warnings: list[str] = []
        self.started = time.perf_counter()

    def say(self, text: str) -> None:
        """A line on the terminal."""
        if not self.quiet:
            print(text, flush=True)

    def case(self, values: tuple[Any, ...], load: Callable[[dict[str, Any]], Scene], file: str, options: Any) -> None:
        """One more case; a failure is counted and stated in its row."""
        overrides = dict(zip(self.keys, values))
        number = len(self.rows) + 1
        row: dict[str, Any] = {"case": number, **overrides, "status": "ok", "message": ""}
        about = ""
        try:
            scene = load(settings_of(overrides))
            summary = self._kept(number, scene)
            if summary is None:
                summary = self._computed(number, scene, file, options)
            else:
                about, self.kept = ", as computed before", self.kept + 1
                self._warn(summary["warnings"])
            self.rows.append(row)
            row.update(numbers_of(summary))
            row["message"] = "; ".join(summary["notes"])
        except (Error, ArithmeticError, SceneError, CannotSave, Usage) as error:
            self.failed += 1
            self.rows.append(row)
            row.update(status="failed", message=line_of(error))
        settings = ", ".join(f"{key} = {value:.10g}" if isinstance(value, float) else f"{key} = {value}"
                             for key, value in overrides.items())
        self.say(f"case {number} of {self.count}: {settings}: {row['status']}{about}"
                 + (f": {row['message']}" if row["message"] else ""))

    def _computed(self, number: int, scene: Scene, file: str, options: Any) -> dict[str, Any]:
        """The summary of a case that is computed now. Raises KeyboardInterrupt where Ctrl-C ended it."""
        out = CommandOutput(str(self.folder / f"{number:05d}") if self.folder else None, file, scene, self.command,
                            True, units_of(options, scene))
        out.summary["identity"] = self._identity(scene)
        try:
            carry_out(scene, out, options, COMMANDS[self.command])
        finally:
            self._warn(out.summary["warnings"])
        if out.interrupted:
            raise KeyboardInterrupt
        return out.summary

    def _identity(self, scene: Scene) -> str:
        """A number of all that the results depend on; "" where the scene cannot be written."""
        try:
            text = saves(scene, False)
        except CannotSave:
            return ""
        return hashlib.sha256(json.dumps([self.command, self.more, text, sorted(code().items())]).encode()).hexdigest()

    def _kept(self, number: int, scene: Scene) -> dict[str, Any] | None:
        """The summary of a case that an earlier sweep of the same folder completed."""
        if self.folder is None:
            return None
        try:
            found = json.loads((self.folder / f"{number:05d}" / "summary.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        same = (isinstance(found, dict) and found.get("status") == 0 and found.get("identity")
                and found["identity"] == self._identity(scene))
        return found if same else None

    def _warn(self, texts: list[str]) -> None:
        """Warnings of a scene that no case before it had."""
        for text in texts:
            if text not in self.warnings:
                self.warnings.append(text)
                self.say(f"note: {text}")

    def write(self, path: pathlib.Path) -> None:
        """All rows as CSV, a column for every number that any of them has."""
        heads = list(dict.fromkeys(key for row in self.rows for key in row))
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([no_formula(head) for head in heads])
            writer.writerows([[no_formula(row.get(head, "")) for head in heads] for row in self.rows])

    def finish(self, status: int, file: str) -> int:
        """Table and summary; returns the status."""
        if self.folder is not None:
            files = ["summary.json"]
            if self.rows:
                self.write(self.folder / "sweep.csv")
                files.append("sweep.csv")
            found = {"command": "sweep", "question": self.command, "scene": os.path.basename(file),
                     "drillmbd": __version__, "keys": self.keys,
                     "cases": self.count, "computed": len(self.rows) - self.kept, "kept": self.kept,
                     "failed": self.failed, "warnings": self.warnings,
                     "notes": [f"stopped by Ctrl-C after {len(self.rows)} of {self.count} cases"] if status == STOPPED
                     else [], "files": files,
                     "status": status, "elapsed_s": time.perf_counter() - self.started}
            (self.folder / "summary.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        self.say(f"{len(self.rows)} of {self.count} cases, {self.failed} failed" + (f"; {self.folder / 'sweep.csv'}"
                                                                                    if self.folder else ""))
        return status


def sweep(command: str, vary: list[tuple[str, list[Any]]], load: Callable[[dict[str, Any]], Scene], file: str,
          options: Any, folder: str | None, quiet: bool, more: list[str]) -> int:
    """Runs the command for all combinations; returns the exit status: 1 if a case failed. Ctrl-C keeps the finished
    cases. more: the options of the command as they are written."""
    target = pathlib.Path(folder) if folder is not None else None
    if target is not None:
        target.mkdir(parents=True, exist_ok=True)
    count = math.prod(len(listed) for _, listed in vary)
    found = Sweep(command, [key for key, _ in vary], target, quiet, count, more)
    status = STOPPED
    try:
        for values in itertools.product(*(listed for _, listed in vary)):
            found.case(values, load, file, options)
        status = FAILED if found.failed or not found.rows else 0
    except KeyboardInterrupt:
        found.say("stopped by Ctrl-C" + ("; the same command continues from here" if target is not None else ""))
    except BaseException:
        found.finish(FAILED, file)
        raise
    return found.finish(status, file)
