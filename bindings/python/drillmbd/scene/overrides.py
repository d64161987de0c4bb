"""Values of a scene file that are replaced before it is read: "hole.mu_dynamic", "string[0].pipes[1].length"."""
from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from .lines import Path
from .problems import Problems, dotted

_KEY = re.compile(r"[A-Za-z_][\w-]*(?:\.[A-Za-z_][\w-]*|\[\d+\])*")


def path_of_key(key: str) -> Path:
    """("string", 0, "pipes", 1, "length"). Raises ValueError where the text is no key."""
    if not _KEY.fullmatch(key) or key.endswith("]"):
        raise ValueError(f"{key!r} is no key; write it as hole.diameter or string[0].pipes[1].length")
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[\w-]+", key))


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
