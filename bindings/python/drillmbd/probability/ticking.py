"""Seconds on the terminal beside a computation that does not let this process run, as a fit within OpenTURNS."""
from __future__ import annotations

import contextlib
import subprocess
import sys
from collections.abc import Iterator

LEAST = 2.0  #: [s] predicted, below which nothing is shown
_CLOCK = """import os, sys, time
parent, started = os.getppid(), time.monotonic()
while os.getppid() == parent:
    print(f"\\r{sys.argv[1]}: {time.monotonic() - started:.0f} s of about {float(sys.argv[2]):.2g} s ",
          end="", file=sys.stderr, flush=True)
    time.sleep(1.0)
"""


@contextlib.contextmanager
def ticking(name: str, seconds: float, shown: bool) -> Iterator[None]:
    """Shows the time within it, by another process, which ends with this one."""
    if not shown or seconds < LEAST:
        yield
        return
    clock = subprocess.Popen([sys.executable, "-c", _CLOCK, name, str(seconds)])
    try:
        yield
    finally:
        clock.terminate()
        clock.wait()
        print(file=sys.stderr)
