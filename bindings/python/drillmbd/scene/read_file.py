"""Files that a user names: regular files up to a size, because a device has no end and a named pipe may never get a
writer."""
from __future__ import annotations

import os
import pathlib
import stat


class TooLarge(ValueError):
    """A file that is not read: too large, a device or a named pipe."""


def limited(path: pathlib.Path, most: int) -> bytes:
    """The content of a file. Raises TooLarge, OSError. A folder is refused by the system."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise TooLarge("is a device or a named pipe, must be a regular file; write its content to a file first")
    with open(path, "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise TooLarge(f"must be below {most} bytes")
    return data
