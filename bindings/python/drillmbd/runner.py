"""The run of a command: warnings first, then the results, with progress; any end of it leaves a
summary with the exit status and the time that it took."""
from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from typing import IO, Any

from .results import CommandOutput
from .errors import Error
from .exit_status import STOPPED, line_of, status_and_message
from .language import phrase
from .scene import Scene
from .scene.warned import warnings_of

Command = Callable[[Scene, CommandOutput, Any], int]


class Meter:
    """A line on the terminal with the part of a long analysis that is done. It appears after a while, and nowhere but
    on a terminal."""

    AFTER, EVERY = 1.0, 0.3  #: [s]

    def __init__(self, name: str, stream: IO[str] | None = None) -> None:
        self.name, self.stream = name, sys.stderr if stream is None else stream
        self.begun = self.reported = time.monotonic()
        self.width = 0

    def __call__(self, fraction: float) -> None:
        now = time.monotonic()
        if now - self.begun < self.AFTER or now - self.reported < self.EVERY:
            return
        self.reported = now
        text = f"{self.name}: {100.0 * fraction:3.0f} % of this analysis, {now - self.begun:.0f} s"
        self.stream.write("\r" + text.ljust(self.width))
        self.stream.flush()
        self.width = len(text)

    def clear(self) -> None:
        """Takes the line away, so that another can be written there."""
        if self.width:
            self.stream.write("\r" + " " * self.width + "\r")
            self.stream.flush()
            self.width = 0


def carry_out(scene: Scene, out: CommandOutput, options: Any, command: Command) -> int:
    """The exit status of a command. Errors are raised again after the summary is written."""
    meter = None if out.quiet or not sys.stderr.isatty() else Meter(out.summary["command"])
    out.meter = scene.progress = meter
    try:
        for text in warnings_of(scene):
            out.warn(out.units.sentence(text))
        return command(scene, out, options)
    except KeyboardInterrupt:
        out.stopped(phrase("stopped by Ctrl-C before all results were computed"))
        return out.finish(STOPPED)
    except Exception as error:
        if isinstance(error, Error):
            error.message = out.units.sentence(error.message)
        found = status_and_message(error)
        out.summary["error"] = line_of(error)
        with contextlib.suppress(OSError):
            out.write_summary(found[0] if found else 1)
        raise
    finally:
        scene.progress = None
        if meter is not None:
            meter.clear()
