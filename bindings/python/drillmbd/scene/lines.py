"""On which line of a TOML text a key stands. tomllib reads the text and gives no lines."""
from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

Path = tuple[Any, ...]  # keys, and numbers of tables in arrays

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*'))*)\s*=""")


def _keys(dotted: str) -> list[str]:
    return [(part[1:-1] if part[0] in "\"'" else part) for part in
            re.findall(r'''[A-Za-z0-9_-]+|"[^"]*"|'[^']*\'''', dotted)]


def _depth_after(line: str, depth: int, quote: str) -> tuple[int, str, str]:
    """Open brackets and the open quote (three signs) at the end of a line, and its comment."""
    i, comment = 0, ""
    while i < len(line):
        if quote:
            end = line.find(quote, i)
            if end < 0:
                return depth, quote if len(quote) == 3 else "", ""
            i, quote = end + len(quote), ""
            continue
        sign = line[i]
        if sign == "#":
            comment = line[i:].rstrip()
            break
        if sign in "\"'":
            quote = sign * 3 if line.startswith(sign * 3, i) else sign
            i += len(quote)
            continue
        depth += (sign in "[{") - (sign in "]}")
        i += 1
    return max(depth, 0), quote if len(quote) == 3 else "", comment


def scan(text: str) -> Iterator[tuple[Path, str, bool]]:
    """For each line the path of the key or table that begins or continues in it, its comment ("" if it has none), and
    whether the key or table begins there. Keys in inline tables count as the key that holds them."""
    counts: dict[Path, int] = {}
    table: Path = ()
    key: Path = ()
    depth, quote = 0, ""
    for line in text.splitlines():
        begins = False
        rest = line
        if depth == 0 and not quote:
            header, found = _HEADER.match(line), _KEY.match(line)
            key = ()
            if header:
                table = key = _table(_keys(header.group(2)), header.group(1) == "[[", counts)
                yield key, header.group(3) or "", True
                continue
            if found:
                key, begins, rest = table + tuple(_keys(found.group(1))), True, line[found.end():]
        depth, quote, comment = _depth_after(rest, depth, quote)
        yield key, comment, begins


def find_lines(text: str) -> dict[Path, int]:
    """{path: line from 1}. Keys in inline tables have the line of the key that holds them."""
    found: dict[Path, int] = {(): 1}
    for number, (path, _, begins) in enumerate(scan(text), 1):
        if begins:
            found.setdefault(path, number)
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
    """The line of the path or of the first thing in it, as [[bitt]] for "bitt"; else of the closest thing it stands
    in."""
    while path and path not in found:
        inside = [line for other, line in found.items() if other[:len(path)] == path]
        if inside:
            return min(inside)
        path = path[:-1]
    return found.get(path, 1)
