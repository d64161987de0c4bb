"""Finds and loads libdrillmbd: the file that the environment variable DRILLMBD_LIBRARY names; else one in the folder of
this package, or where `cmake --install` wrote down that it put it; else the one the system finds."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import pathlib
from ctypes import c_uint32

from ._functions import declare
from .enums import VERSION

HERE = pathlib.Path(__file__).resolve().parent


def _beside() -> str | None:
    """The library in this folder, or at the place, relative to this folder, that the file library.txt names."""
    found = (sorted(HERE.glob("libdrillmbd.so*")) + sorted(HERE.glob("libdrillmbd.dylib"))
             + sorted(HERE.glob("drillmbd.dll")))
    note = HERE / "library.txt"
    if note.exists():
        found.append(HERE / note.read_text(encoding="utf-8").strip())
    return next((str(path) for path in found if path.exists()), None)


def find() -> str:
    """The file or name of the library. Raises ImportError where there is none."""
    name = os.environ.get("DRILLMBD_LIBRARY") or _beside() or ctypes.util.find_library("drillmbd")
    if not name:
        raise ImportError("libdrillmbd was not found: not in this package, not by the system; set DRILLMBD_LIBRARY to "
                          "its "
                          "file (libdrillmbd.so)")
    return name


def load() -> ctypes.CDLL:
    """The library with all its functions declared. Raises ImportError where its version does not fit."""
    name = find()
    try:
        library = ctypes.CDLL(name)
        version = library.dmb_version
    except (OSError, AttributeError) as error:
        raise ImportError(f"{name} could not be loaded as libdrillmbd: {error}") from error
    version.restype, version.argtypes = c_uint32, []
    found = version()
    if found // 10000 != VERSION[0] or found < 10000 * VERSION[0] + 100 * VERSION[1]:
        raise ImportError(f"{name} has version {found // 10000}.{found // 100 % 100}.{found % 100}, this package needs "
                          f"{VERSION[0]}.{VERSION[1]}")
    try:
        declare(library)
    except AttributeError as error:
        raise ImportError(f"{name} is older than this package: {error}") from error
    return library


lib = load()
