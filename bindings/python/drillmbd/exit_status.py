"""Exit statuses of the command, the same for all of its commands, and the errors that lead to them."""
from __future__ import annotations

from typing import Any

STATUSES = {
    0: "done; a result that this scene does not allow is stated as not assessed, with the reason",
    1: "an analysis failed, or none of the results could be computed; sweep: a case failed",
    2: "wrong command line or scene file, or the scene lacks a table that the command needs",
    3: "a file could not be read or written",
    130: "stopped by Ctrl-C; the results so far and summary.json are written",
}
FAILED, WRONG, FILE, STOPPED = 1, 2, 3, 130


def text() -> str:
    """The statuses as lines of a help text."""
    return "\n".join(f"  {status:<4} {about}" for status, about in STATUSES.items())


def status_and_message(error: BaseException) -> tuple[int, str] | None:
    """The exit status and the line for an error that a user can meet; None for a fault of the program."""
    from .errors import Error, Usage
    from .fmu import CannotExport
    from .language import without_functions
    from .scene import CannotSave, SceneError
    if isinstance(error, SceneError):
        return WRONG, str(error)
    if isinstance(error, (Usage, CannotSave, CannotExport, ImportError)):
        return WRONG, f"drillmbd: {error}"
    if isinstance(error, Error):
        return FAILED, f"drillmbd: {without_functions(error.message)}"
    if isinstance(error, ArithmeticError):
        return FAILED, f"drillmbd: {error}"
    if isinstance(error, MemoryError):
        return FAILED, "drillmbd: not enough memory; use fewer pipes, elements, rows or points"
    if isinstance(error, OSError) and not isinstance(error, BrokenPipeError):
        where = f": {error.filename}" if error.filename else ""
        return FILE, f"drillmbd: {error.strerror or error}{where}"
    if isinstance(error, KeyboardInterrupt):
        return STOPPED, "drillmbd: stopped by Ctrl-C"
    return None


def line_of(error: Any) -> str:
    """The message of an error for a summary."""
    found = status_and_message(error)
    return (found[1] if found else f"{type(error).__name__}: {error}").removeprefix("drillmbd: ")
