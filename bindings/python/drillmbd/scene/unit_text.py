"""Reads a unit as people write it: "kN m", "kft-lbs", "deg/30 m", "N·m", "r/min", "9.8 m/s²" without its number."""
from __future__ import annotations

import functools
import itertools
import re
import unicodedata
from decimal import Decimal

from .unit_names import NOTHING, REFUSED, Unit, tables

_TOKEN = re.compile(r"""\s*(?:(?P<number>\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)
    |(?P<name>[^\W\d]+|[°'"#%‰])
     (?P<power>(?:\s*(?:\^|\*\*)\s*\(?\s*[-+]?\d+(?:\.\d+)?\s*\)?|-?\d+(?:\.\d+)?)?)
    |(?P<sign>[*·.×⋅∙・/÷()-]))""", re.X)
_PHRASES = (("metric tonnes", "tonne"), ("metric tonne", "tonne"), ("metric tons", "tonne"), ("metric ton", "tonne"),
            ("short tons", "short_ton"), ("short ton", "short_ton"), ("long tons", "long_ton"),
            ("long ton", "long_ton"),
            ("u.s. gal", "USgal"), ("us gal", "USgal"), ("uk gal", "UKgal"), ("imp gal", "UKgal"),
            ("imp. gal", "UKgal"),
            ("us ft", "usft"), ("survey feet", "usft"), ("specific gravity", "sg"), ("in.", "in "), ("ft.", "ft "),
            ("lb.", "lb "),
            ("lbs.", "lbs "))
MOST = 60  # characters of a unit


class UnknownUnit(ValueError):
    """A text that names no unit; args: the text, its fault."""


def plain(text: str) -> str:
    """The same text in signs of the parser: full-width signs, primes, degrees, powers."""
    text = text.replace("º", "°").replace("˚", "°").replace("’", "'").replace("”", '"').replace("“", '"')
    text = unicodedata.normalize("NFKC", text).replace("′′", '"').replace("′", "'").replace("''", '"')
    return text.replace("−", "-").replace("–", "-").replace("µ", "μ").replace("每",
                                                                              "/").replace("℃", "°C").replace("⁄", "/")


def _without_dots(word: str) -> str:
    """"s.g." and "r.p.m." without their dots, if there is such a unit."""
    if re.fullmatch(r"(?:[A-Za-z]\.){2,}[A-Za-z]?", word):
        joined = word.replace(".", "")
        if joined.casefold() in tables()[1]:
            return joined
    return word


def _prepared(text: str) -> str:
    text = " ".join(_without_dots(word) for word in plain(text).split())
    for phrase, word in _PHRASES:
        text = re.sub(r"(?<![^\W\d_])" + re.escape(phrase) + ("" if phrase.endswith(".") else r"(?![^\W\d_])"), word,
                      text, flags=re.I)
    return re.sub(r"(?<![^\W\d_])per(?![^\W\d_])", "/", text, flags=re.I).strip().rstrip(".").strip()


Factor = tuple[str, float]  # a name, or a number, and its power


@functools.lru_cache(maxsize=2000)
def factors(text: str) -> tuple[Factor, ...]:
    """Names and numbers with their powers. Raises UnknownUnit."""
    prepared = _prepared(text)
    if len(prepared) > MOST:
        raise UnknownUnit(text, "is too long for a unit")
    found: list[Factor] = []
    at, sign, signs = 0, 1.0, [1.0]
    while at < len(prepared):
        match = _TOKEN.match(prepared, at)
        if match is None:
            raise UnknownUnit(text, "is not a known unit")
        at = match.end()
        if match["sign"]:
            sign = _after_sign(text, match["sign"], sign, signs)
            continue
        if match["number"]:
            if found and sign * signs[-1] > 0.0:
                raise UnknownUnit(text, "is not a known unit")
            found.append((match["number"], sign * signs[-1]))  # "deg/30 m": the sign is that of what follows, too
            continue
        power = float(re.sub(r"[\^*()\s]", "", match["power"])) if match["power"] else 1.0
        found.append((match["name"], sign * signs[-1] * power))
        sign = 1.0
    if len(signs) != 1 or not found or (found[0][0][0].isdigit() and not re.match(r"1\s*[/÷]", prepared)):
        raise UnknownUnit(text, "is not a known unit")
    return tuple(found)


def _after_sign(text: str, sign: str, before: float, signs: list[float]) -> float:
    """The power of the unit that follows a sign, by which parentheses are kept track of, too."""
    if sign == "(":
        signs.append(before * signs[-1])
        return 1.0
    if sign == ")":
        if len(signs) < 2:
            raise UnknownUnit(text, "is not a known unit")
        signs.pop()
        return 1.0
    return -1.0 if sign in "/÷" else 1.0


def _of_name(text: str, name: str) -> tuple[dict[str, Unit], dict[str, Unit]]:
    """Units that a name may mean: as it is written, and in other capitals."""
    exact, loose = tables()
    name = {"'": "ft", '"': "in"}.get(name, name)
    if name.casefold() in REFUSED:
        raise UnknownUnit(text, f"has '{name}', which " + REFUSED[name.casefold()])
    written = {name: exact[name]} if name in exact else {}
    others = {key: unit for key, (unit, prefix) in loose.get(name.casefold(), {}).items() if key != name
              and name.startswith(prefix)}
    if not written and not others:
        raise UnknownUnit(text, "is not a known unit")
    return written, others


@functools.lru_cache(maxsize=2000)
def meanings(text: str) -> tuple[tuple[bool, Unit, str], ...]:
    """All units that a text may mean, the one in its own capitals first: whether it is that one, unit, spelling.
    Raises UnknownUnit."""
    choices: list[list[tuple[bool, Unit, str]]] = []
    powers = []
    for name, power in factors(text):
        powers.append(power)
        if name[0].isdigit():
            choices.append([(True, Unit(Decimal(name), NOTHING.powers), name)])
            continue
        written, others = _of_name(text, name)
        choices.append([(True, unit, key) for key, unit in written.items()] + [(False, unit, key)
                                                                               for key, unit in others.items()])
    found = []
    for combination in itertools.islice(itertools.product(*choices), 200):
        unit = NOTHING
        for (_, one, _), power in zip(combination, powers):
            try:
                unit = unit.times(one, power)
            except ArithmeticError as error:
                raise UnknownUnit(text, "is not a known unit") from error
        found.append((all(own for own, _, _ in combination), unit, " ".join(key for _, _, key in combination)))
    return tuple(sorted(found, key=lambda one: not one[0]))
