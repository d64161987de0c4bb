"""Sentences in other languages. English is the source: a phrase is an English template with the values that stand in
it, and is a str of the
English sentence. A catalogue, language_zh.toml, has the template of another language by the English one; a test finds
missing, unused and different entries."""
from __future__ import annotations

import functools
import pathlib
import re
import unicodedata
from collections.abc import Iterable
from typing import Any


class Phrase(str):
    """An English sentence with the template and the values that it was made of."""
    template: str
    values: dict[str, Any]
    units: Any  # the system of units into which numbers in SI are converted, or None

    def __new__(cls, template: str, values: dict[str, Any], units: Any = None) -> Phrase:
        english = template.format(**values)
        self = super().__new__(cls, units.sentence(english) if units is not None else english)
        self.template, self.values, self.units = template, values, units
        return self


class Listed(str):
    """Sentences one behind another, with a separator that is a phrase too."""
    parts: tuple[str, ...]
    separator: str

    def __new__(cls, separator: str, parts: Iterable[str]) -> Listed:
        kept = tuple(parts)
        self = super().__new__(cls, separator.join(kept))
        self.parts, self.separator = kept, separator
        return self


def without_functions(message: str) -> str:
    """A message of the library with commands in place of functions of C, and values of scene files in place of its
    constants."""
    text = re.sub(r"\bdmb_(?:analysis_)?(\w+)", lambda found: found[1].replace("_", "-"), message)
    return re.sub(rf"\bDMB_(?:{CHOICES})_(\w+)", lambda found: '"' + found[1].lower().replace("_", "-") + '"', text)


#: Enumerations of the library whose values scene files name by their last words.
CHOICES = "STEADY|PIPE|ROCK|DRIVE|TARGET|HOLE|MODES|SCALE|CONTACT|INPUT|OUTPUT"


class Foreign(str):
    """A message that the library or the reader of scene files wrote in English, with numbers in SI."""
    original: str
    units: Any  # into which numbers are converted, or None

    def __new__(cls, text: str, units: Any = None) -> Foreign:
        shown = without_functions(text)
        self = super().__new__(cls, units.sentence(shown) if units is not None else shown)
        self.original, self.units = text, units
        return self


def phrase(template: str, /, **values: Any) -> Phrase:
    """A sentence. The template is a literal: the test of the catalogue reads it in the source."""
    return Phrase(template, values)


def joined(separator: str, parts: Iterable[str]) -> Listed:
    """Sentences with a separator between them, literals are separated in the same way."""
    return Listed(separator, parts)


class Language:
    """Writes sentences in one language."""

    def __init__(self, name: str = "en") -> None:
        self.name = name
        self.phrases, self.patterns = _catalogue(name) if name != "en" else ({}, [])

    @property
    def tag(self) -> str:
        """As HTML names the language."""
        return {"en": "en", "zh": "zh-CN"}[self.name]

    def __call__(self, text: str) -> str:
        """The sentence in this language; names and numbers, which are plain texts, as they are."""
        if self.name == "en":
            return str.__str__(text)
        if isinstance(text, Phrase):
            values = {key: self(value) if isinstance(value, str) else value for key, value in text.values.items()}
            found = self.phrases.get(text.template, text.template).format(**values)
            return str(text.units.sentence(found)) if text.units is not None else found
        if isinstance(text, Listed):
            return self.phrases.get(text.separator, text.separator).join(self(part) for part in text.parts)
        return self._foreign(text) if isinstance(text, Foreign) else text

    def _foreign(self, text: Foreign) -> str:
        """By the first pattern that fits; else the English original, which is said to be one."""
        found = self._fitting(text.original)
        if found is not None:
            return str(text.units.sentence(found)) if text.units is not None else found
        return self(phrase("{message}", message=str.__str__(text))) if text.strip() else str(text)

    def _fitting(self, text: str) -> str | None:
        for pattern, template in self.patterns:
            match = pattern.fullmatch(text)
            if match:
                return template.format(**{key: self._fitting(value) or value
                                          for key, value in match.groupdict().items()})
        parts = [self._fitting(part) for part in text.split("; ")] if "; " in text else [None]
        return self.phrases["; "].join(part for part in parts if part) if all(parts) else None

    def lines(self, text: str) -> str:
        """A message of several lines, line by line."""
        return str(text) if self.name == "en" else "\n".join(map(self._cells, text.split("\n")))

    def _cells(self, line: str) -> str:
        """Columns of a table are two blanks apart or more; a number needs no translation."""
        padded, wanted = "", 0
        for i, cell in enumerate(re.split(r"(\s{2,})", line)):
            wanted += len(cell)
            padded += (" " * max(2, wanted - _width(padded)) if i % 2 else cell if re.fullmatch(r"[-+\d.e]*", cell)
                       else self(Foreign(cell)))
        return padded

    def all(self, value: Any) -> Any:
        """A structure, as a figure is, with all of its sentences in this language."""
        if isinstance(value, str):
            return self(value)
        if isinstance(value, dict):
            return {key: self.all(one) for key, one in value.items()}
        return [self.all(one) for one in value] if isinstance(value, (list, tuple)) else value


def _width(text: str) -> int:
    """Of letters in a table; those of Chinese are two wide."""
    return sum(2 if unicodedata.east_asian_width(one) in "WF" else 1 for one in text)


ENGLISH = Language()
FIELD = re.compile(r"\{(\w+)(?:[:!][^{}]*)?\}")


@functools.lru_cache(maxsize=2)
def _catalogue(name: str) -> tuple[dict[str, str], list[tuple[re.Pattern[str], str]]]:
    import tomllib
    path = pathlib.Path(__file__).with_name(f"language_{name}.toml")
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    # "{a} elements" fits many
    exact_first = sorted(content["messages"].items(), key=lambda one: -len(FIELD.sub("", one[0])))
    return content["phrases"], [(pattern_of(key), text) for key, text in exact_first]


def pattern_of(template: str) -> re.Pattern[str]:
    """A message of the library with fields {a}, {b} instead of its numbers and names."""
    pieces = FIELD.split(template)
    return re.compile("".join(re.escape(piece) if i % 2 == 0 else f"(?P<{piece}>.+?)"
                              for i, piece in enumerate(pieces)))
