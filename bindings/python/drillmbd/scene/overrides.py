"""Values of a scene file that are replaced before it is read: "hole.mu_dynamic", "string[0].pipes[1].length",
"time_function[feed].segment.h1"."""
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .lines import Path
from .problems import Problems, dotted, meant

NO_TABLE = "the scene has no such table; describe it in the scene file"
_KEY = re.compile(r"[A-Za-z_][\w-]*(?:\.[A-Za-z_][\w-]*|\[[^][]+\])*")


@dataclass(frozen=True)
class Named:
    """An item of an array of tables by its name."""
    name: str


def path_of_key(key: str) -> Path:
    """("string", 0, "pipes", 1, "length"); items by name as Named. Raises ValueError where the text is no key."""
    if not _KEY.fullmatch(key) or key.endswith("]"):
        brackets = "; a table whose name has brackets is given by its number" if "[" in key else ""
        raise ValueError(f"{key!r} is no key; write it as hole.diameter, string[0].pipes[1].length or "
                         f"time_function[NAME].segment.h1{brackets}")
    parts = re.findall(r"\[([^][]+)\]|([\w-]+)", key)
    return tuple((int(item) if re.fullmatch("[0-9]+", item) else Named(item)) if item else word for item, word in parts)


def key_of_path(path: Path) -> str:
    """The text of path_of_key."""
    return "".join(f"[{part}]" if isinstance(part, int) else f"[{part.name}]" if isinstance(part, Named) else f".{part}"
                   for part in path)[1:]


def by_number(key: str, content: dict[str, Any], typed: bool = False) -> str:
    """The key with the numbers of the items that it names. typed: by a user, so that a number must not be the name of
    another item. Raises
    ValueError where there is no such name, with those that there are, or several."""
    found: list[Any] = []
    holder: Any = content
    for part in path_of_key(key):
        if isinstance(part, Named):
            part = _number(key, part.name, key_of_path(tuple(found)), holder)
        elif isinstance(part, int) and typed and (doubt := _other(part, key_of_path(tuple(found)), holder)):
            raise ValueError(f"{key!r}: {doubt}; give that table a name that is not a number")
        found.append(part)
        if isinstance(holder, list) and isinstance(part, str):  # one table counts as an array of one
            holder = holder[0] if len(holder) == 1 else None
        if isinstance(part, int):
            holder = [holder] if isinstance(holder, dict) else holder
            holder = holder[part] if isinstance(holder, list) and part < len(holder) else None
        else:
            holder = holder.get(part) if isinstance(holder, dict) else None
    return key_of_path(tuple(found))


def _names(table: str, holder: Any) -> list[Any]:
    """Of the items of an array of tables; None of an item without one. A failure without a name has that of its
    kind."""
    items = [holder] if isinstance(holder, dict) else holder if isinstance(holder, list) else []
    return [one.get("name", one.get("kind") if table == "failure" else None) if isinstance(one, dict) else None
            for one in items]


def _other(number: int, table: str, holder: Any) -> str:
    """The item, other than that with the number, whose name is the number; "" without one."""
    names = _names(table, holder)
    other = names.index(str(number)) if str(number) in names else number
    return f"[{number}] is the number of a table, and {table}[{other}] is named {number}" if other != number else ""


def _number(key: str, name: str, table: str, holder: Any) -> int:
    """The number of the item of an array of tables that has a name."""
    names = _names(table, holder)
    if names.count(name) == 1:
        return names.index(name)
    if name in names:
        raise ValueError(f"{key!r}: {names.count(name)} tables [[{table}]] are named {name}; write the number, as "
                         f"{table}[{names.index(name)}]")
    known = [one for one in names if isinstance(one, str)]
    there = (meant(name, known) if known else
             f"; none has a name: write the number, as {table}[0]" if names else f"; the scene has no [[{table}]]")
    raise ValueError(f"{key!r}: no [[{table}]] is named {name}{there}")


def _step(holder: Any, part: Any, after: Any, path: Path, problems: Problems) -> Any:
    """The table or array one part further along a path; None, and a problem, without one. after: the part that follows.
    A number counts the tables that there are: it makes none."""
    if isinstance(part, int):
        items = [holder] if isinstance(holder, dict) else holder if isinstance(holder, list) else []
        if part < len(items):
            return items[part]
        problems.add(path, None, f"the scene has {len(items)} such table{'s' * (len(items) > 1)}, numbered from 0"
                     if holder else NO_TABLE)
        return None
    holder = _only(holder)
    if not isinstance(holder, dict):
        problems.add(path, None, _no_keys(path))
        return None
    if part not in holder and isinstance(after, int):
        problems.add((*path, after), None, NO_TABLE)
        return None
    return holder.setdefault(part, {})


def _only(holder: Any) -> Any:
    """The table of an array of one, which counts as that table."""
    return holder[0] if isinstance(holder, list) and len(holder) == 1 else holder


def _no_keys(path: Path) -> str:
    return f"{dotted(path[:-1])} holds no keys; name one of its items by [0], [1] ..."


def apply(content: dict[str, Any], changes: Mapping[str, Any], problems: Problems) -> None:
    """Puts the values where the keys say; tables that are not there yet are made, numbered items are not. None
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
            holder = _step(holder, part, path[number + 1], path[:number + 1], problems)
            if holder is None:
                break
        holder = _only(holder)
        if isinstance(holder, dict) and value is None:
            holder.pop(path[-1], None)
        elif isinstance(holder, dict):
            holder[path[-1]] = value
        elif holder is not None:
            problems.add(path, None, _no_keys(path))
