"""All faults of a scene file, each with its line."""
from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from .lines import Path, line_of


@dataclass
class Problem:
    """One thing that is wrong."""
    line: int       #: in the file, from 1
    key: str        #: "hole.diameter", "string[0].pipes[1].length"
    value: Any      #: as written; None where a whole table is meant
    text: str       #: what is wrong, with bound and advice

    @property
    def place(self) -> str:
        """Key and value."""
        return self.key + ("" if self.value is None else f" = {_shown(self.value)}")

    def __str__(self) -> str:
        return f"{self.place}: {self.text}"


def _shown(value: Any) -> str:
    text = f'"{value}"' if isinstance(value, str) else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


class SceneError(Exception):
    """A scene file that is refused. `problems` are all that were found, by line."""

    def __init__(self, file: str, problems: list[Problem]) -> None:
        self.file, self.problems = file, sorted(problems, key=lambda one: one.line)
        super().__init__("\n".join(f"{file}:{one.line}: {one}" for one in self.problems))

    def __reduce__(self) -> Any:
        return type(self), (self.file, self.problems)


class Problems:
    """Collects them."""

    def __init__(self, lines: dict[Path, int]) -> None:
        self.lines, self.found = lines, list[Problem]()
        self.remarks = list[Problem]()  # what was assumed, or looks wrong

    def remark(self, path: Path, value: Any, text: str) -> None:
        """A note about a value that is accepted; nothing where the text is empty."""
        if text and not any(one.key == dotted(path) and one.text == text for one in self.remarks):
            self.remarks.append(Problem(line_of(self.lines, path), dotted(path), value, text))

    def refused_below(self, path: Path) -> set[str]:
        """Keys of a table whose values were refused."""
        start = dotted(path) + "."
        return {re.split(r"[.\[]", one.key[len(start):])[0] for one in self.found if one.key.startswith(start)}

    def add(self, path: Path, value: Any, text: str) -> None:
        """One more, at a path of keys and numbers."""
        if not any(one.key == dotted(path) and one.text == text for one in self.found):
            self.found.append(Problem(line_of(self.lines, path), dotted(path), value, text))

    def unknown(self, path: Path, known: Iterable[str]) -> None:
        """A key that does not exist."""
        self.add(path, None, f"unknown key{meant(str(path[-1]), known)}")


def dotted(path: Path) -> str:
    """("string", 0, "pipes", 1) as "string[0].pipes[1]"."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else ("." if text else "") + str(part)
    return text or "the file"


def meant(word: str, known: Iterable[str]) -> str:
    """A suggestion for a misspelt word, or the possible words."""
    known = sorted(set(known))
    close = difflib.get_close_matches(word, known, 1, 0.6)
    if close:
        return f"; did you mean {close[0]}?"
    return f"; possible are {', '.join(known)}" if known else ""
