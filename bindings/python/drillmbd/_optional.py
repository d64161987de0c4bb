"""Packages that are used where they are there: numpy for arrays, pandas for frames, matplotlib for plots."""
from __future__ import annotations

import contextlib
import importlib
import signal
import sys
import threading
from typing import Any, Iterator

try:
    import numpy as _numpy
    numpy: Any = _numpy
except ImportError:
    numpy = None

DEBIAN = {"numpy": "python3-numpy", "pandas": "python3-pandas", "matplotlib.pyplot": "python3-matplotlib",
          "openpyxl": "python3-openpyxl", "plotly.offline": "python3-plotly", "tqdm": "python3-tqdm",
          **{f"scipy.{part}": "python3-scipy" for part in ("stats", "special", "optimize", "signal")},
          "h5py": "python3-h5py", "openturns": "python3-openturns", "mpi4py.MPI": "python3-mpi4py",
          "mpi4py.futures": "python3-mpi4py", "distributed": "python3-distributed"}


@contextlib.contextmanager
def _interrupted_behind() -> Iterator[None]:
    """Ctrl-C within the block has its effect behind it: matplotlib takes one within its import for a bad value."""
    usual = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or usual is not signal.default_int_handler:
        yield
        return
    came: list[int] = []
    signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
    if came:
        raise KeyboardInterrupt


def need(name: str) -> Any:
    """The module. Raises ImportError that says how it is installed."""
    try:
        # Twenty times as quick, and asked for each sample of a study.
        with contextlib.nullcontext() if name in sys.modules else _interrupted_behind():
            return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{name} is needed for this and was not found by {sys.executable}: pip install "
                          f"{name.split('.')[0]}, or "
                          f"apt install {DEBIAN.get(name, name)} for /usr/bin/python3; `.ci/install-packages command` "
                          "of the sources installs "
                          "all that the command uses") from error
