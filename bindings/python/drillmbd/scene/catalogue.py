"""Drill pipe, rods, collars and rigs by name: `pipe = "5 in 19.50 S135"` in [[string.pipes]], `rig = "..."` in
[limits]. The names stand in catalogue.toml, with sources, and in a file of the user's own that `catalogue = "own.toml"`
names. Keys of the scene file come first."""
from __future__ import annotations

import difflib
import functools
import pathlib
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from . import units
from .settings import LIMITS
from .fields import DEFINITIONS, fields_of
from .lines import Path
from .problems import Problems, meant
from .read_file import TooLarge, limited
from .unit_text import plain

MOST_BYTES = 20_000_000

SHIPPED = pathlib.Path(__file__).with_name("catalogue.toml")
KINDS = ("pipe", "collar", "grade", "class", "rig")
#: Numbers that are listed and go to no key of the scene file, with their units.
ABOUT = {"plain_end_mass": "kg/m", "tensile_strength": "Pa", "speed": "rad/s"}
Key = tuple[Any, ...]  # of a name: its words, and its numbers whatever their spelling


class CatalogueError(ValueError):
    """A catalogue that cannot be read, or a name that is in none."""


@dataclass(frozen=True)
class Entry:
    """One name of a catalogue."""
    kind: str                #: one of KINDS
    name: str
    values: dict[str, Any]   #: key of the scene file or of ABOUT: as written, with unit
    source: str


@dataclass
class Found:
    """The keys of the scene file that a name represents, and a sentence about it."""
    values: dict[str, Any]
    about: str
    source: str = ""
    #: keys that the name does not give: the consequence if the file does not give them either
    lacks: dict[str, str] = field(default_factory=dict)

    def text(self, given: Iterable[str] = ()) -> str:
        """The sentence for a scene file that gives these keys itself."""
        own = [key for key in self.values if key in given]
        parts = [self.about, *(text for key, text in self.lacks.items() if key not in given),
                 *([f"the scene file's own {', '.join(own)} holds instead"] if own else []),
                 *([f"source: {self.source}"] if self.source else [])]
        return "; ".join(parts)


def _known(kind: str) -> dict[str, str]:
    """Units of the numbers of an entry."""
    pipes = {key: one.unit for key, one in fields_of(DEFINITIONS["pipes"]).items() if one.kind == "quantity"
             and not one.count}
    own = {"pipe": pipes, "collar": pipes, "grade": {"yield_strength": "Pa"}, "class": {"remaining_wall": "-"},
           "rig": {key: LIMITS[key].unit for key in ("torque", "push", "pull")}}
    return {**own[kind], **ABOUT}


# ---- Names -----------------------------------------------------------------------------------------------------------
_NUMBER = r"\d+(?:[.,]\d+)?"
_WORDS = re.compile(rf"(\d+)[\s-]+(\d+)/(\d+)|(\d+)/(\d+)|({_NUMBER})|([^\W\d_]+)")
# words without a meaning in these names
_BESIDE = {"in", "inch", "inches", "lb", "lbs", "ft", "ppf", "drill", "pipe", "rod", "rods"}


@functools.lru_cache(maxsize=2000)
def key_of(name: str) -> Key:
    """ "4-1/2in 16.6 S-135" and "4.5 in 16.60 lb/ft S135" have one key."""
    spaced = re.sub("([½¼¾⅛⅜⅝⅞])", r" \1 ", name).replace("×", " x ").replace("*", " x ")
    text = re.sub("[φΦϕøØ⌀∅]", " phi ", plain(spaced)).casefold().replace("⁄", "/")
    found: list[Any] = []
    for whole, top, bottom, above, below, number, word in _WORDS.findall(text):
        if top or above:
            found.append(int(whole or 0) + int(top or above) / max(int(bottom or below), 1))
        elif number:
            found.append(float(number.replace(",", ".")))
        else:
            found.append(word)
    return tuple(found) if "phi" in found else tuple(one for one in found if one not in _BESIDE)


# ---- Files -----------------------------------------------------------------------------------------------------------
def _sources(text: Any, known: dict[str, Any], file: str) -> str:
    """Keys of [source] with commas between, or a text of its own."""
    if not isinstance(text, str):
        return f"{file}, no source given"
    keys = [one.strip() for one in text.split(",")]
    return "; ".join(str(known[key]) for key in keys) if all(key in known for key in keys) else text


def _entry(kind: str, table: Any, sources: dict[str, Any], file: str) -> Entry:
    name = table.get("name") if isinstance(table, dict) else None
    if not isinstance(name, str) or not key_of(name):
        raise CatalogueError(f"{file}: a [[{kind}]] without a name; give it one, as name = \"phi 73 x 7\"")
    known, values = _known(kind), {}
    for key, value in table.items():
        if key in ("name", "source"):
            continue
        if key not in known:
            raise CatalogueError(f"{file}: {name}: unknown key {key}{meant(key, known)}")
        try:
            units.parse(value, known[key])
        except units.UnitError as error:
            raise CatalogueError(f"{file}: {name}: {key} = {value}: {error}") from error
        values[key] = value
    return Entry(kind, name, values, _sources(table.get("source"), sources, file))


def _read(path: pathlib.Path) -> tuple[list[Entry], list[tuple[str, str]]]:
    """Entries of a file, and the beginnings of names that are known to have no figures, with the reason."""
    import tomllib
    try:
        content = tomllib.loads(limited(path, MOST_BYTES).decode("utf-8-sig"))
    except TooLarge as error:
        raise CatalogueError(f"{path}: {error}") from error
    except OSError as error:
        raise CatalogueError(f"{path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise CatalogueError(f"{path.name}: must be text in UTF-8") from error
    except (ValueError, RecursionError) as error:
        raise CatalogueError(f"{path.name}: is no TOML: {error}") from error
    for key in content:
        if key not in (*KINDS, "source", "missing"):
            raise CatalogueError(f"{path.name}: unknown table {key}{meant(key, (*KINDS, 'source', 'missing'))}")
    sources, found = content.get("source", {}), []
    for kind in KINDS:
        tables = content.get(kind, [])
        found += [_entry(kind, table, sources if isinstance(sources, dict) else {}, path.name) for table in
                  (tables if isinstance(tables, list) else [tables])]
    missing = [one for one in content.get("missing", []) if isinstance(one, dict)]
    return found, [(str(one["begins"]), str(one.get("text", ""))) for one in missing if one.get("begins")]


@functools.lru_cache(maxsize=None)
def _shipped() -> tuple[list[Entry], list[tuple[str, str]]]:
    return _read(SHIPPED)


class Catalogue:
    """The shipped names and those of files of the user's own, which come first."""

    def __init__(self, files: Iterable[pathlib.Path] = ()) -> None:
        own = [_read(path) for path in files]
        self.missing = [one for _, missing in [*own, _shipped()] for one in missing]
        self.entries: dict[tuple[str, Key], Entry] = {}
        for entries, _ in [_shipped(), *own]:
            self.entries.update({(one.kind, key_of(one.name)): one for one in entries})

    def of(self, *kinds: str) -> list[Entry]:
        """The entries of these kinds."""
        return [one for one in self.entries.values() if one.kind in kinds]

    # ---- Rigs --------------------------------------------------------------------------------------------------------
    def rig(self, name: str) -> Found:
        """Torque, push and pull of a rig. Raises CatalogueError."""
        entry = self.entries.get(("rig", key_of(name)))
        if entry is None:
            reason = next((f"; {text}" for begins, text in self.missing
                           if name.strip().casefold().startswith(begins.casefold())), None)
            raise CatalogueError(f"is in no catalogue{reason or self._near(key_of(name), self.of('rig'))}")
        values = {key: value for key, value in entry.values.items() if key in LIMITS}
        lacks = {key: f"{key} is not known" for key in ("torque", "push", "pull") if key not in values}
        return Found(values, "is taken as " + ", ".join(f"{key} {value}" for key, value in values.items()),
                     entry.source, lacks)

    # ---- Pipes -------------------------------------------------------------------------------------------------------
    def pipe(self, name: str) -> Found:
        """Keys of [[string.pipes]] of a name with grade and class, or of "phi 73 x 6.5". Raises CatalogueError."""
        entry = self.entries.get(("pipe", key_of(name))) or self.entries.get(("collar", key_of(name)))
        rest, wear = self._suffix(key_of(name), "class")
        rest, grade = self._suffix(rest, "grade")
        entry = entry or self.entries.get(("pipe", rest)) or self.entries.get(("collar", rest))
        if entry is not None:
            values, sources, unknown = dict(entry.values), [entry.source], ""
        else:
            values, unknown = self._by_dimensions(name)
            sources = []
        if grade is not None:
            values["yield_strength"] = grade.values["yield_strength"]
            sources.append(grade.source)
        if wear is not None and units.parse(wear.values.get("remaining_wall", 1.0), "-") != 1.0:
            values["outer_diameter"] = self._worn(values, wear)
            sources.append(wear.source)
        values = {key: value for key, value in values.items() if key not in ABOUT}
        return Found(values, _described(values), "; ".join(dict.fromkeys(sources)), _lacks(values, unknown))

    def _suffix(self, key: Key, kind: str) -> tuple[Key, Entry | None]:
        """The key without the name of a grade or class at its end, and that."""
        for one in self.of(kind):
            end = key_of(one.name)
            if len(key) > len(end) and key[-len(end):] == end:
                return key[:-len(end)], one
        return key, None

    @staticmethod
    def _worn(values: dict[str, Any], wear: Entry) -> str:
        """Wear is on the outside and uniform: the bore stays."""
        outer, inner = (units.parse(values.get(key, 0), "m") for key in ("outer_diameter", "inner_diameter"))
        return _metres(inner + units.parse(wear.values["remaining_wall"], "-") * (outer - inner))

    def _by_dimensions(self, name: str) -> tuple[dict[str, Any], str]:
        """Of outer diameter x wall thickness, with a grade of the catalogue, a yield strength as "780 MPa", or another
        name of a grade."""
        match = re.fullmatch(  # size, wall thickness, unit, grade
            rf"(.*?{_NUMBER}\s*(?:[^\W\d]*|\"))\s*[x×*]\s*({_NUMBER})\s*(mm|cm|in|inch|\")?(?:\s+(.*))?",
            plain(name).strip(), re.I)
        unit = match and (re.search(r"(mm|cm|inch|in|m|\")?\s*$", match[1], re.I)[1]  # type: ignore[index]
                          or match[3] or
                          ("mm" if re.match(r"\s*(phi|dia|[φΦϕøØ⌀∅]|直径)", match[1], re.I) else None))
        if match is None or not unit:
            raise CatalogueError(self._unknown(key_of(name)))
        size = match[1] if match[1].casefold().rstrip().endswith(unit.casefold()) else f"{match[1]} {unit}"
        try:
            outer, wall = units.parse(size, "m"), units.parse(f"{match[2]} {match[3] or unit}", "m")
        except units.UnitError as error:
            raise CatalogueError(f"{size}: {error}") from error
        if not 0.0 < 3.0 * wall < outer:
            raise CatalogueError(f"has a wall of {1e3 * wall:g} mm, which must be below a third of the outer diameter, "
                                 f"{1e3 * outer:g} mm; "
                                 "the second number is the wall thickness")
        return self._graded({"outer_diameter": _metres(outer), "inner_diameter": _metres(outer - 2.0 * wall)},
                            match[4] or "")

    def _unknown(self, key: Key) -> str:
        """A name of a known size with an unknown grade, or none of the names."""
        key, _ = self._suffix(key, "class")
        for one in self.of("pipe", "collar"):
            size = key_of(one.name)
            if len(size) < len(key) and key[:len(size)] == size:
                grade = "".join(f"{part:g}" if isinstance(part, float) else str(part).upper()
                                for part in key[len(size):])
                return (f"is {one.name} of {grade}, which is no grade of a "
                        f"catalogue{meant(grade, [grade.name for grade in self.of('grade')])}")
        return ("is in no catalogue" + self._near(self._suffix(key, "grade")[0], self.of("pipe", "collar"))
                + '; other sizes are written with outer diameter and wall thickness, as "phi 73 x 6.5"')

    def _graded(self, values: dict[str, Any], words: str) -> tuple[dict[str, Any], str]:
        rest, _ = self._suffix(("",) + key_of(words), "class")
        rest, grade = self._suffix(rest, "grade")
        if rest == ("",):
            return values, ""
        if grade is None:
            try:
                return {**values,
                        "yield_strength":
                            f"{units.parse(re.sub('^yield', '', words, flags=re.I).strip(), 'Pa')!r} Pa"}, ""
            except units.UnitError:
                pass
        if len(rest) > 3 or isinstance(rest[1], float) or rest[1] == "x":
            raise CatalogueError(f"has '{words}' after the wall thickness, which must be a grade or a yield strength, "
                                 "as 780 MPa")
        return values, (f"the yield strength of grade {words} is in no catalogue (the number of a grade may be its "
                        "tensile strength): "
                        "give yield_strength of its certificate")

    def _near(self, key: Key, entries: list[Entry]) -> str:
        """Names of the same size, or those of similar spelling."""
        same = [one.name for one in entries if key and key_of(one.name)[:1] == key[:1] and isinstance(key[0], float)]
        by_text = {" ".join(map(str, key_of(one.name))): one.name for one in entries}
        close = same or [by_text[one] for one in difflib.get_close_matches(" ".join(map(str, key)), by_text, 3, 0.5)]
        return f"; did you mean {' or '.join(close[:5])}?" if close else "; drillmbd catalogue lists the names"


def _metres(value: float) -> str:
    return f"{round(value, 9)!r} m"


def _described(values: dict[str, Any]) -> str:
    if not {"outer_diameter", "inner_diameter"} <= set(values):
        return "is taken as " + ", ".join(f"{key} {value}" for key, value in values.items())
    outer, inner = (1e3 * units.parse(values[key], "m") for key in ("outer_diameter", "inner_diameter"))
    wall = (outer - inner) / 2.0
    if "yield_strength" not in values:
        return f"is taken as {outer:.5g} x {wall:.4g} mm (outer diameter x wall)"
    strength = 1e-6 * units.parse(values["yield_strength"], "Pa")
    return f"is taken as {outer:.5g} x {wall:.4g} mm (outer diameter x wall), yield strength {strength:.4g} MPa"


def _lacks(values: dict[str, Any], unknown: str) -> dict[str, str]:
    found = {"yield_strength": unknown or "no grade is named: the yield strength is not known",
             "joint_length": "without tool joints"}
    return {key: text for key, text in found.items() if key not in values}


# ---- Scene files -----------------------------------------------------------------------------------------------------
def _tables(holder: Any, path: Path, key: str) -> list[tuple[Path, dict[str, Any]]]:
    """The tables below a key; those that are none are left to the reading of the scene."""
    value = holder.get(key) if isinstance(holder, dict) else None
    if isinstance(value, dict):
        return [(path + (key,), value)]
    return [(path + (key, number), one) for number, one in enumerate(value if isinstance(value, list) else [])
            if isinstance(one, dict)]


def expand(content: dict[str, Any], problems: Problems, folder: Any) -> None:
    """Puts the values that names of a catalogue represent in their place, below the keys that are given."""
    places = [place for path, string in _tables(content, (), "string") for place in _tables(string, path, "pipes")]
    for path, sub in _tables(content, (), "sub"):
        places += [place for where, section in _tables(sub, path, "section")
                   for place in _tables(section, where, "pipes")]
    named = [("pipe", path, table) for path, table in places if "pipe" in table]
    named += [("rig", path, table) for path, table in _tables(content, (), "limits") if "rig" in table]
    files = content.pop("catalogue", [])
    if not named and not files:
        return
    try:
        catalogue = Catalogue(_paths(files, folder))
    except CatalogueError as error:
        problems.add(("catalogue",), files, str(error))
        catalogue = Catalogue()
    for kind, path, table in named:
        _fill(catalogue, kind, path, table, problems)


def _paths(files: Any, folder: Any) -> list[pathlib.Path]:
    files = [files] if isinstance(files, str) else files
    if not isinstance(files, list) or not all(isinstance(one, str) and one for one in files):
        raise CatalogueError('must name a file, as catalogue = "own.toml", or be an array of names')
    return [pathlib.Path(folder, one) for one in files]


def _fill(catalogue: Catalogue, kind: str, path: Path, table: dict[str, Any], problems: Problems) -> None:
    name = table.pop(kind)
    try:
        if not isinstance(name, str):
            raise CatalogueError("must be a name of a catalogue in quotes; drillmbd catalogue lists them")
        found = catalogue.pipe(name) if kind == "pipe" else catalogue.rig(name)
    except CatalogueError as error:
        problems.add(path + (kind,), name, str(error))
        return
    problems.remark(path + (kind,), name, found.text(table))
    for key, value in found.values.items():
        table.setdefault(key, value)


# ---- The list --------------------------------------------------------------------------------------------------------
HEADS = {"pipe": 'drill pipe and rods, pipe = "NAME GRADE CLASS" in [[string.pipes]]; other sizes: "phi 73 x 6.5" or '
                 '"phi 73 x 6.5 780 MPa"',
         "collar": 'drill collars, pipe = "NAME" in [[string.pipes]]', "grade": "grades", "class": "classes of wear",
         "rig": 'rigs, rig = "NAME" in [limits]'}


def text(word: str | None, files: Iterable[str] = ()) -> str:
    """The entries whose names or sources have a word, with values, units and source. Raises CatalogueError."""
    catalogue = Catalogue(pathlib.Path(one) for one in files)
    chosen = [one for one in catalogue.of(*KINDS) if not word
              or word.casefold() in f"{one.kind} {one.name} {one.source}".casefold()
              or key_of(word) == key_of(one.name)[:len(key_of(word))] != ()]
    if word and not chosen:
        reason = next((f"; {about}" for begins, about in catalogue.missing
                       if word.casefold().startswith(begins.casefold())), None)
        raise CatalogueError(f"{word}: is in no catalogue"
                             f"{reason or catalogue._near(key_of(word), catalogue.of(*KINDS))}")
    numbers = {source: number for number, source in enumerate(dict.fromkeys(one.source for one in chosen), 1)}
    lines = []
    for kind in KINDS:
        rows = [one for one in chosen if one.kind == kind]
        lines += [HEADS[kind],
                  *(f"  {one.name:24} {', '.join(f'{key} {value}' for key, value in one.values.items())}  "
                    f"[{numbers[one.source]}]"
                    for one in rows), ""] if rows else []
    return "\n".join([*lines, "sources", *(f"  [{number}] {source}" for source, number in numbers.items())]) + "\n"
