"""[[sub]] of a scene file: a body in the middle of a string, and the section of pipes that continues the string after
it.
A model has them as the parts that they are made of, and so has a file that is written from it."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .._structs import BodyDef, JointDef, StringDef
from ..errors import Error
from .fields import DEFINITIONS, Field, fields_of
from .lines import Path

if TYPE_CHECKING:
    from .load import Loader

# The tables of a sub, each with the kind of its part, in the order of their numbers.
TABLES = {"body": "body", "before": "joint", "after": "joint", "section": "string"}
# These follow from the string that the sub continues.
PLACED = {"body": ("position", "rotation", "velocity", "attach", "string"), "joint": ("place_a", "place_b", "match")}


def known_fields(table: str) -> dict[str, Field]:
    """The keys of one of the tables of a sub."""
    kind = TABLES[table]
    found = {key: field for key, field in fields_of(DEFINITIONS[kind]).items()
             if key not in (*PLACED.get(kind, ()), "name")}
    return {key: field for key, field in found.items() if kind != "string" or key == "end_free"}


def own_fields() -> dict[str, Field]:
    """The keys of a sub itself."""
    found = fields_of(DEFINITIONS["sub"])
    return {key: found[key] for key in ("string", "length")}


class Subs:
    """The subs of a file: their names first, then into the model."""

    def __init__(self, loader: Loader) -> None:
        self.loader = loader
        self.found = loader.parts("sub")

    def offset(self, kind: str) -> int:
        """Parts of that kind that come before those of the file's own tables."""
        return len(self.found) * sum(kind == one for one in TABLES.values()) * (kind != "string")

    def names(self) -> list[tuple[str, str, Path, Any]]:
        """Kind, name by number, path and table of every part."""
        strings, made = len(self.loader.parts("string")), []
        for number, (path, table) in enumerate(self.found):
            first = {"body": number, "before": 2 * number, "after": 2 * number + 1, "section": strings + number}
            for key, kind in TABLES.items():
                made.append((kind, f"{kind}-{first[key]}", path + (key,), table.get(key, {})))
        return made

    def describe(self) -> None:
        named = iter(self.names())
        for path, table in self.found:
            self._sub(path, table, {key: next(named)[1] for key in TABLES})

    def _sub(self, path: Path, table: dict[str, Any], names: dict[str, str]) -> None:
        loader, before = self.loader, len(self.loader.problems.found)
        values = loader.read(path, table, own_fields(), tuple(TABLES))
        parts = {}
        for key in TABLES:
            given = loader.table(path + (key,))
            parts[key] = loader.read(path + (key,), given, known_fields(key), ("name", "pipes") if key == "section"
                                     else ("name",))
            loader.own_name(path + (key,), given, parts[key])
            names[key] = str(given.get("name") or names[key])
        made = None
        if len(loader.problems.found) == before:
            made = self._add(path, values, parts)
        for key, kind in TABLES.items():
            loader.put(names[key], kind, getattr(made, key, None))
        loader.pipes_of(path + ("section",), names["section"], loader.table(path + ("section",)), made and made.section)

    def _add(self, path: Path, values: dict[str, Any], parts: dict[str, dict[str, Any]]) -> Any:
        try:
            return self.loader.model.add_sub(
                values.get("string"), values.get("length", 0.0), body=BodyDef(**parts["body"]),
                before=JointDef(**parts["before"]), after=JointDef(**parts["after"]),
                section=StringDef(**parts["section"]))
        except (Error, ValueError) as error:
            name = getattr(error, "field", None) or ""
            where = next((path + (key, name) for key in TABLES if name in parts[key]), path)
            self.loader.problems.add(where, None, getattr(error, "message", str(error)))
        return None
