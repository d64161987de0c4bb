"""One question asked of a scene for all combinations of some of its values, and the numbers of the answers in one table."""
from __future__ import annotations

import csv
import itertools
import pathlib
import re
from collections.abc import Callable, Iterable
from typing import Any

from .answers import Output, units_of
from .errors import Error
from .questions import QUESTIONS
from .scene import CannotSave, Scene, SceneError
from .scene.changes import path_of_key

_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")
_NOT_NUMBERS = ("command", "scene", "title", "drillmbd", "files", "status", "torque_drag_by_depth", "broomstick")
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
    n = int(count)
    if n < 2:
        raise ValueError(f"{text!r}: COUNT = {n}, must be >= 2")
    a, b = float(first.group(1)), float(last.group(1))
    numbers = [float(f"{a + (b - a) * i / (n - 1):.12g}") for i in range(n)]  # 0.35, not 0.35000000000000003
    return [f"{number!r} {first.group(2)}" if first.group(2) else number for number in numbers]


def varied(text: str) -> tuple[str, list[Any]]:
    """KEY=V1,V2,... or KEY=LOW:HIGH:COUNT as the key and its values. Raises ValueError."""
    key, found, values = text.partition("=")
    if not found or not values.strip():
        raise ValueError(f"{text!r}: write KEY=V1,V2 or KEY=LOW:HIGH:COUNT")
    path_of_key(key.strip())
    listed = _between(values) if values.count(":") == 2 else [value_of(one) for one in values.split(",")]
    return key.strip(), listed


# ---- Answers ---------------------------------------------------------------------------------------------------------
def numbers_of(summary: Any, name: str = "") -> dict[str, float]:
    """Every number of a summary by its dotted name; of long lists the first items."""
    if isinstance(summary, bool) or isinstance(summary, (int, float)):
        return {name: float(summary)}
    if isinstance(summary, dict):
        items: Iterable[tuple[str, Any]] = ((f"{name}.{key}" if name else str(key), value) for key, value in summary.items()
                                            if name or key not in _NOT_NUMBERS)
    elif isinstance(summary, list):
        items = ((f"{name}[{i}]", value) for i, value in enumerate(summary[:MOST_ITEMS]))
    else:
        return {}
    return {key: value for text, one in items for key, value in numbers_of(one, text).items()}


class Sweep:
    """The cases of a sweep and what came of them."""

    def __init__(self, question: str, keys: list[str], folder: pathlib.Path | None, quiet: bool) -> None:
        self.question, self.keys, self.folder, self.quiet = question, keys, folder, quiet
        self.rows: list[dict[str, Any]] = []
        self.failed = 0

    def say(self, text: str) -> None:
        """A line on the terminal."""
        if not self.quiet:
            print(text)

    def case(self, values: tuple[Any, ...], load: Callable[[dict[str, Any]], Scene], file: str, options: Any) -> None:
        """One more case; what fails is counted and told in its row."""
        changes = dict(zip(self.keys, values))
        number = len(self.rows) + 1
        row: dict[str, Any] = {"case": number, **changes, "status": "ok", "message": ""}
        try:
            scene = load(changes)
            output = Output(str(self.folder / f"{number:05d}") if self.folder else None, file, scene, self.question, True,
                            units_of(options, scene))
            QUESTIONS[self.question](scene, output, options)
            row.update(numbers_of(output.summary))
            row["message"] = "; ".join(output.summary["notes"])
        except (Error, ArithmeticError, SceneError, CannotSave) as error:
            self.failed += 1
            row.update(status="failed", message=str(error))
        self.rows.append(row)
        told = ", ".join(f"{key} = {value:.10g}" if isinstance(value, float) else f"{key} = {value}" for key, value in changes.items())
        self.say(f"case {number}: {told}: {row['status']}" + (f": {row['message']}" if row["message"] else ""))

    def write(self, path: pathlib.Path) -> None:
        """All rows as CSV, a column for every number that any of them has."""
        heads = list(dict.fromkeys(key for row in self.rows for key in row))
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, heads, restval="", lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.rows)


def sweep(question: str, vary: list[tuple[str, list[Any]]], load: Callable[[dict[str, Any]], Scene], file: str,
          options: Any, folder: str | None, quiet: bool) -> int:
    """Runs the command for all combinations; returns the exit status: 1 if a case failed. Ctrl-C keeps the finished cases."""
    target = pathlib.Path(folder) if folder is not None else None
    if target is not None:
        target.mkdir(parents=True, exist_ok=True)
    found = Sweep(question, [key for key, _ in vary], target, quiet)
    try:
        for values in itertools.product(*(listed for _, listed in vary)):
            found.case(values, load, file, options)
    finally:
        if target is not None and found.rows:
            found.write(target / "sweep.csv")
    found.say(f"{len(found.rows)} cases, {found.failed} failed" + (f"; {target / 'sweep.csv'}" if target is not None else ""))
    return 1 if found.failed or not found.rows else 0
