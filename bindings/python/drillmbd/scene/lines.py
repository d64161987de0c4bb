"""On which line of a TOML text a key stands. tomllib reads the text and tells no lines."""
from __future__ import annotations

import re
from typing import Any

Path = tuple[Any, ...]  # keys, and numbers of tables in arrays

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*'))*)\s*=""")


def _keys(dotted: str) -> list[str]:
    return [(part[1:-1] if part[0] in "\"'" else part) for part in
            re.findall(r'''[A-Za-z0-9_-]+|"[^"]*"|'[^']*\'''', dotted)]


def _depth_after(line: str, depth: int, quote: str) -> tuple[int, str]:
    """Open brackets and the open quote (three signs) at the end of a line."""
    i = 0
    while i < len(line):
        if quote:
            end = line.find(quote, i)
            if end < 0:
                return depth, quote if len(quote) == 3 else ""
            i, quote = end + len(quote), ""
            continue
        sign = line[i]
        if sign == "#":
            break
        if sign in "\"'":
            quote = sign * 3 if line.startswith(sign * 3, i) else sign
            i += len(quote)
            continue
        depth += (sign in "[{") - (sign in "]}")
        i += 1
    return max(depth, 0), quote if len(quote) == 3 else ""


def find_lines(text: str) -> dict[Path, int]:
    """{path: line from 1}. Keys in inline tables have the line of what they stand in."""
    found: dict[Path, int] = {(): 1}
    counts: dict[Path, int] = {}
    table: Path = ()
    depth, quote = 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        if depth == 0 and not quote:
            header, key = _HEADER.match(line), _KEY.match(line)
            if header:
                table = _table(_keys(header.group(2)), header.group(1) == "[[", counts)
                found.setdefault(table, number)
                continue
            if key:
                found.setdefault(table + tuple(_keys(key.group(1))), number)
                line = line[key.end():]
        depth, quote = _depth_after(line, depth, quote)
    return found


def _table(keys: list[str], is_array: bool, counts: dict[Path, int]) -> Path:
    path: Path = ()
    for i, key in enumerate(keys):
        path += (key,)
        if is_array and i == len(keys) - 1:
            counts[path] = counts.get(path, 0) + 1
            for below in [other for other in counts if other[:len(path)] == path and len(other) > len(path)]:
                del counts[below]
        if path in counts:
            path += (counts[path] - 1,)
    return path


def line_of(found: dict[Path, int], path: Path) -> int:
    """The line of the path or of the first thing in it, as [[bitt]] for "bitt"; else of the closest thing it stands in."""
    while path and path not in found:
        inside = [line for other, line in found.items() if other[:len(path)] == path]
        if inside:
            return min(inside)
        path = path[:-1]
    return found.get(path, 1)
