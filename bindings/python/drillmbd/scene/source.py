"""The text that a scene was read from: its values as they were written, and its comments by the keys beside which they
stand."""
from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from . import units
from .lines import Path, scan

MISSING = object()
#: Keys that stand for others, which a saved file has in their place.
REPLACED = ("catalogue", "pipe", "rig", "survey_file", "motor")
#: Keys that a saved file has under another name.
RENAMED = {"survey_file": "survey"}
_QUANTITY = re.compile(r"([-+]?[\d.]+(?:e[-+]?\d+)?) (.+)")


@dataclass
class Comment:
    """Lines of comment, beginning with #."""
    path: Path        #: of the key or table
    text: str
    beside: bool      #: at the end of its line; else on lines of its own before it


class Source:
    """A scene file as text. `paths`: where the file describes each part, by (kind, name)."""

    def __init__(self, paths: dict[tuple[str, str], Path]) -> None:
        self.paths = paths
        self.content: dict[str, Any] = {}
        self.comments: list[Comment] = []
        self.first: list[str] = []

    def read(self, text: str) -> None:
        """Takes values and comments from the text of the file."""
        self.content = tomllib.loads(text)
        self.comments, self.first = _comments(text)

    def value(self, path: Path | None) -> Any:
        """The value of a key as it is written, MISSING where it is not. One table counts as an array of one."""
        found: Any = self.content
        if path is None:
            return MISSING
        for part in path:
            if isinstance(part, int):
                found = (found[part] if isinstance(found, list) and part < len(found) else
                         found if isinstance(found, dict) and part == 0 else MISSING)
            else:
                found = found.get(part, MISSING) if isinstance(found, dict) else MISSING
        return found

    def order(self, path: Path | None) -> dict[str, int]:
        """The keys of a table with their places in it."""
        table = self.value(path)
        return {key: number for number, key in enumerate(table)} if isinstance(table, dict) else {}

    def spelling(self, path: Path | None, value: Any) -> Any:
        """The text of the file for a value in SI, where it means exactly that; else the value."""
        written = self.value(path)
        return written if written is not MISSING and means(written, value) else value


def means(written: Any, value: Any) -> bool:
    """Whether a value of a file is, to the bit, one that would be saved."""
    if isinstance(written, list) and isinstance(value, (list, tuple)):
        return len(written) == len(value) and all(means(a, b) for a, b in zip(written, value))
    if isinstance(written, dict) and isinstance(value, dict):
        return written.keys() == value.keys() and all(means(one, value[key]) for key, one in written.items())
    if isinstance(written, bool) or isinstance(value, bool):
        return isinstance(value, (bool, int)) and int(written) == int(value) if isinstance(written, bool) else False
    if isinstance(value, (int, float)):
        return _is(written, "-", float(value))
    quantity = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if quantity and written != value:
        return _is(written, quantity[2], float(quantity[1]))
    return bool(written == value)


def _is(written: Any, unit: str, value: float) -> bool:
    try:
        return units.parse(written, unit) == value
    except units.UnitError:
        return False


# ---- Comments --------------------------------------------------------------------------------------------------------
def _comments(text: str) -> tuple[list[Comment], list[str]]:
    """All comments, and the block before the first key."""
    found: list[Comment] = []
    first: list[str] = []
    waiting: list[str] = []
    begun = False
    for path, comment, starts in scan(text):
        if starts and not begun:
            begun, first, waiting = True, waiting, []
        if starts and waiting:
            found.append(Comment(path, "\n".join(waiting), False))
            waiting = []
        if comment and starts:
            found.append(Comment(path, comment, True))
        elif comment and path:                      # within an array of several lines
            found.append(Comment(path, comment, False))
        elif comment:
            waiting.append(comment)
    if waiting:
        found.append(Comment((), "\n".join(waiting), True))   # after the last key
    return found, first


def replaced(content: Any, path: Path = ()) -> Iterable[Comment]:
    """A comment for each key that other keys replace in a saved file."""
    if isinstance(content, list):
        for number, one in enumerate(content):
            yield from replaced(one, path + (number,))
    elif isinstance(content, dict):
        for key, one in content.items():
            if key in REPLACED and isinstance(one, str):
                yield Comment(path + (key,), f'# written out here: {key} = "{one}"', False)
            yield from replaced(one, path + (key,))


def decorated(lines: list[tuple[str, Path | None]], source: Source) -> list[str]:
    """The lines of a saved file, each with the path that it has in the source, with the comments of the source beside
    them. A comment of a key that is not saved stands before its table; one of a table that is not saved before the
    first line of the part that is in it; else at the top."""
    places: dict[Path, int] = {}
    for number, (_, path) in enumerate(lines):
        if path is not None:
            places.setdefault(path, number)
    before: dict[int, list[str]] = {}
    beside: dict[int, str] = {}
    top, end = list(source.first), list[str]()
    for one in [*replaced(source.content), *source.comments]:
        if not one.path:
            end.append(one.text)
            continue
        at, exact = _place(one.path, places)
        if at is None:
            top.append(one.text)
        elif one.beside and exact and at not in beside:
            beside[at] = one.text
        else:
            before.setdefault(at, []).append(one.text)
    found = top + [""] * bool(top)
    for number, (line, _) in enumerate(lines):
        blank = [""] if line.startswith("\n") else []
        text = line.removeprefix("\n")
        if number in beside:
            head, _, rest = text.partition("\n")    # of a survey the first line
            text = f"{head}  {beside[number]}" + ("\n" + rest if rest else "")
        found += [*blank, *before.get(number, []), text]
    return found + end


# ---- Places in the saved file ----------------------------------------------------------------------------------------
def _place(path: Path, places: dict[Path, int]) -> tuple[int | None, bool]:
    """The number of the line for a path, and whether it is that of the path itself."""
    if path and path[-1] in RENAMED:
        path = path[:-1] + (RENAMED[path[-1]],)
    plain = _without_zero(path)
    for known, number in places.items():
        if _without_zero(known) == plain:
            return number, True
    inside = [number for known, number in places.items() if _without_zero(known)[:len(plain)] == plain]
    if inside:
        return min(inside), False
    return _place_above(path, places)


def _place_above(path: Path, places: dict[Path, int]) -> tuple[int | None, bool]:
    while len(path) > 1:
        path = path[:-1]
        plain = _without_zero(path)
        found = next((number for known, number in places.items() if _without_zero(known) == plain), None)
        if found is not None:
            return found, False
    return None, False


def _without_zero(path: Path) -> Path:
    """One table and an array of one are the same."""
    return tuple(part for part in path if part != 0 or not isinstance(part, int))
