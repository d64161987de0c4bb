"""Values of a scene file that are replaced before it is read: "hole.mu_dynamic", "string[0].pipes[1].length", "time_function[feed].segment.h1"."""
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .lines import Path
from .problems import Problems, dotted, meant

_KEY = re.compile(r"[A-Za-z_][\w-]*(?:\.[A-Za-z_][\w-]*|\[[^][]+\])*")


@dataclass(frozen=True)
class Named:
    """An item of an array of tables by its name."""
    name: str


def path_of_key(key: str) -> Path:
    """("string", 0, "pipes", 1, "length"); items by name as Named. Raises ValueError where the text is no key."""
    if not _KEY.fullmatch(key) or key.endswith("]"):
        raise ValueError(f"{key!r} is no key; write it as hole.diameter, string[0].pipes[1].length or time_function[NAME].segment.h1")
    parts = re.findall(r"\[([^][]+)\]|([\w-]+)", key)
    return tuple((int(item) if re.fullmatch("[0-9]+", item) else Named(item)) if item else word for item, word in parts)


def key_of_path(path: Path) -> str:
    """The text of path_of_key."""
    return "".join(f"[{part}]" if isinstance(part, int) else f"[{part.name}]" if isinstance(part, Named) else f".{part}" for part in path)[1:]


def by_number(key: str, content: dict[str, Any]) -> str:
    """The key with the numbers of the items that it names. Raises ValueError where there is no such name, with those that there are."""
    found: list[Any] = []
    holder: Any = content
    for part in path_of_key(key):
        if isinstance(part, Named):
            part = _number(key, part.name, key_of_path(tuple(found)), holder)
        found.append(part)
        if isinstance(holder, list) and isinstance(part, str):  # one table counts as an array of one
            holder = holder[0] if len(holder) == 1 else None
        if isinstance(part, int):
            holder = [holder] if isinstance(holder, dict) else holder
            holder = holder[part] if isinstance(holder, list) and part < len(holder) else None
        else:
            holder = holder.get(part) if isinstance(holder, dict) else None
    return key_of_path(tuple(found))


def _number(key: str, name: str, table: str, holder: Any) -> int:
    """The number of the item of an array of tables that has a name."""
    items = [holder] if isinstance(holder, dict) else holder if isinstance(holder, list) else []
    names = [one.get("name") if isinstance(one, dict) else None for one in items]
    if name in names:
        return names.index(name)
    known = [one for one in names if isinstance(one, str)]
    there = meant(name, known) if known else f"; none has a name: give it one, or write its number, as {table}[0]"
    raise ValueError(f"{key!r}: no [[{table}]] is named {name}{there}")


def _step(holder: Any, part: Any, path: Path, problems: Problems) -> Any:
    if isinstance(part, int):
        if isinstance(holder, dict):  # one table counts as an array of one
            holder = [holder]
        if isinstance(holder, list) and part < len(holder):
            return holder[part]
    elif isinstance(holder, dict):
        return holder.setdefault(part, {})
    problems.add(path, None, "the scene has no such table")
    return None


def apply(content: dict[str, Any], changes: Mapping[str, Any], problems: Problems) -> None:
    """Puts the values where the keys say; tables that are not there yet are made, items of arrays are not. None
    takes a key out."""
    for key, value in changes.items():
        path = path_of_key(key)
        try:
            if any(isinstance(part, Named) for part in path):
                path = path_of_key(by_number(key, content))
        except ValueError as error:
            problems.add((key,), None, str(error))
            continue
        holder: Any = content
        for number, part in enumerate(path[:-1]):
            holder = _step(holder, part, path[:number + 1], problems)
            if holder is None:
                break
        if isinstance(holder, list) and len(holder) == 1:
            holder = holder[0]
        if isinstance(holder, dict) and value is None:
            holder.pop(path[-1], None)
        elif isinstance(holder, dict):
            holder[path[-1]] = value
        elif holder is not None:
            problems.add(path, None, f"{dotted(path[:-1])} holds no keys; name one of its items by [0], [1] ...")
