"""Files that a user names, up to a size: a device has no end."""
from __future__ import annotations

import pathlib


class TooLarge(ValueError):
    """A file that is larger than is read."""


def limited(path: pathlib.Path, most: int) -> bytes:
    """The content of a file. Raises TooLarge, OSError."""
    with open(path, "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise TooLarge(f"must be below {most} bytes")
    return data
