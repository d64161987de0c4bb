"""Reads numbers as people write them: "63.5", "98,4", "1 000", "1,234.5", "8 1/2", "8-1/2", "9⅝", "1e7", "phi 73"."""
from __future__ import annotations

import re
import unicodedata
from decimal import Decimal, InvalidOperation

from .unit_text import plain

_SIGN = r"[-+]?\s*"
_FRACTION = re.compile(rf"\s*({_SIGN})(?:(\d+)(?:\s+|\s*-\s*))?(\d+)\s*/\s*(\d+)(?![\d.,])\s*(.*)$", re.S)
_NUMBER = re.compile(rf"\s*({_SIGN})(\d{{1,3}}(?: \d{{3}})+(?:[.,]\d*)?(?![\d_])|(?:\d[\d_]*(?:[.,]\d+)*)?(?:[.,]\d*)?)"
                     r"((?:[eE][-+]?\d+)?)(?!\d)\s*(.*)$", re.S)
_DIAMETER = re.compile(r"\s*(?:phi|dia\.?|diameter|直径|[φΦϕøØ⌀∅])\s*(?=[\d.])", re.I)
_MOST = 80  # characters


class NoNumber(ValueError):
    """A text that does not begin with a number, or with one of two meanings."""


def split(text: str) -> tuple[Decimal, str, bool]:
    """The number at the beginning, the remaining text, and whether a sign of a diameter stands before it. Raises
    NoNumber."""
    if len(text) > _MOST:
        raise NoNumber("is too long for a number with its unit")
    text = plain(_spelled_fractions(text))
    diameter = _DIAMETER.match(text)
    text = text[diameter.end():] if diameter else text
    mixed = _FRACTION.match(text)
    if mixed and int(mixed[4]):
        value = Decimal(mixed[2] or 0) + Decimal(mixed[3]) / Decimal(mixed[4])
        return (-value if "-" in mixed[1] else value), mixed[5].strip(), bool(diameter)
    match = _NUMBER.match(text)
    if match is None or not any(sign.isdigit() for sign in match[2]):
        raise NoNumber("")
    unit = match[4].strip()
    return _decimal(match[1], match[2], match[3], unit), unit, bool(diameter)


def _spelled_fractions(text: str) -> str:
    """"8½" as "8 1/2"."""
    found = ""
    for sign in text:
        whole = unicodedata.normalize("NFKC", sign)
        found += f" {whole.replace('⁄', '/')}" if "⁄" in whole else sign
    return found


def _decimal(sign: str, digits: str, exponent: str, unit: str) -> Decimal:
    """A comma is decimal only where it cannot divide thousands."""
    bare = re.sub(r"[_ ]", "", digits)
    if "," in bare and "." in bare:
        last = max(bare.rfind(","), bare.rfind("."))
        thousands, fraction = bare[:last], bare[last + 1:]
        groups = re.split(r"[.,]", thousands)
        if bare[last] in thousands or not _are_thousands(groups) or len(set(re.findall(r"[.,]", thousands))) != 1:
            raise NoNumber("has commas and points that make no number")
        bare = "".join(groups) + "." + fraction
    elif "," in bare:
        bare = _by_comma(bare, unit)
    elif bare.count(".") > 1:
        if not _are_thousands(bare.split(".")):
            raise NoNumber("has several decimal points")
        bare = bare.replace(".", "")
    try:
        return Decimal(sign.replace(" ", "") + bare + exponent)
    except InvalidOperation as error:
        raise NoNumber("") from error


def _by_comma(text: str, unit: str) -> str:
    groups = text.split(",")
    if len(groups) > 2:
        if not _are_thousands(groups):
            raise NoNumber("has several commas")
        return "".join(groups)
    if _are_thousands(groups):
        readings = [f"{groups[0]}{between}{groups[1]} {unit}".strip() for between in ("", ".")]
        raise NoNumber(f"may be {readings[0]} or {readings[1]}; write one of these")
    return text.replace(",", ".")


def _are_thousands(groups: list[str]) -> bool:
    """1 to 3 digits that do not begin with 0, then groups of 3."""
    return (bool(re.fullmatch(r"[1-9]\d{0,2}", groups[0])) and all(len(group) == 3 and group.isdigit()
                                                                   for group in groups[1:]))
