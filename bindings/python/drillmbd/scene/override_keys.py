"""Checks the keys of --vary before any case is computed: each must exist in the scene format, name a value, and lie in
tables that the scene has."""
from __future__ import annotations

import copy
import difflib
from collections.abc import Iterable
from typing import Any

from .keys import TABLES
from .overrides import apply, by_number, key_of_path, path_of_key
from .problems import Problems

MOST_SUGGESTIONS = 3


def refuse_wrong(keys: list[str], content: dict[str, Any] | None) -> None:
    """Raises ValueError for the first key that is wrong. content: of the scene file; None where it cannot be read, so
    that only the format is checked."""
    from .schema import schema
    whole = schema()
    for key in keys:
        _refuse_unknown(key, whole)
    if content is not None:
        _refuse_absent(keys, content)


def _refuse_absent(keys: list[str], content: dict[str, Any]) -> None:
    """Items of arrays that the scene does not have, or has twice, and keys that are given twice."""
    numbered = [by_number(key, content, typed=True) for key in keys]
    changed, problems = copy.deepcopy(content), Problems({})
    for key, plain in zip(keys, numbered):
        apply(changed, {plain: None}, problems)
        if problems.found:
            raise ValueError(f"{key!r}: {problems.found[0]}")
    single = [plain.replace("[0]", "") for plain in numbered]  # one table counts as an array of one
    for key, plain in zip(keys, single):
        if single.count(plain) > 1:
            raise ValueError(f"{key!r}: is given {single.count(plain)} times; give each key once")


# ---- The scene format ------------------------------------------------------------------------------------------------
def _objects(schema: dict[str, Any]) -> list[dict[str, Any]]:
    """The tables that a schema permits, in arrays too."""
    if "oneOf" in schema:
        return [found for one in schema["oneOf"] for found in _objects(one)]
    if schema.get("type") == "array":
        return _objects(schema["items"])
    return [schema] if schema.get("type") == "object" else []


def _keys_of(schema: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {key: one for found in _objects(schema) for key, one in found.get("properties", {}).items()}


def _is_table(schema: dict[str, Any]) -> bool:
    """Whether only tables with known keys are permitted: a place may be a name or a table."""
    return bool(_keys_of(schema)) and all(_objects(one) for one in schema.get("oneOf", [schema]))


def _refuse_unknown(key: str, whole: dict[str, Any]) -> None:
    path, schema = path_of_key(key), whole
    for number, part in enumerate(path):
        if not isinstance(part, str):
            continue
        table, known = key_of_path(path[:number]), _keys_of(schema)
        if part not in known:
            raise ValueError(f"{key!r}: {_unknown(part, table, known, whole)}{_listed(path[:number])}")
        schema = known[part]
    if _is_table(schema):
        raise ValueError(f"{key!r}: is a table; give one of its keys: "
                         f"{_some(f'{key}.{one}' for one in _keys_of(schema))}{_listed(path)}")


def _unknown(word: str, table: str, known: dict[str, Any], whole: dict[str, Any]) -> str:
    """The fault of a word in a table, and the nearest keys: in this table, or the same word in other ones."""
    if table and not known:
        return f"{table} has no keys that --vary can set"
    head = f"{table} has no key {word}" if table else f"a scene has no table {word}"
    near = difflib.get_close_matches(word, known, MOST_SUGGESTIONS)
    found = [f"{table}.{one}" if table else one for one in near] or _same_word(word, whole)
    if found:
        return f"{head}; did you mean {' or '.join(found)}?"
    return f"{head}; possible are {', '.join(sorted(known))}"


def _same_word(word: str, whole: dict[str, Any]) -> list[str]:
    """Keys of the format that end with a word, those with the shortest path first."""
    level = [(key, one) for key, one in _keys_of(whole).items()]
    found: list[str] = []
    while level and len(found) < MOST_SUGGESTIONS:
        found += [key for key, _ in level if key.rpartition(".")[2] == word]
        level = [(f"{table}.{key}", one) for table, schema in level for key, one in _keys_of(schema).items()]
    return found[:MOST_SUGGESTIONS]


def _some(keys: Iterable[str]) -> str:
    listed = sorted(keys)
    return ", ".join(listed[:MOST_SUGGESTIONS]) + (" ..." if len(listed) > MOST_SUGGESTIONS else "")


def _listed(path: tuple[Any, ...]) -> str:
    """The command that lists the keys of a table."""
    table = ".".join(part for part in path if isinstance(part, str))
    return f" (drillmbd keys {table} lists them)" if table in TABLES else "" if table else " (drillmbd keys lists them)"
