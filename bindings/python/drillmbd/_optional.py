"""Packages that are used where they are there: numpy for arrays, pandas for frames, matplotlib for plots."""
from __future__ import annotations

import importlib
import sys
from typing import Any

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


def need(name: str) -> Any:
    """The module. Raises ImportError that says how it is installed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{name} is needed for this and was not found by {sys.executable}: pip install "
                          f"{name.split('.')[0]}, or "
                          f"apt install {DEBIAN.get(name, name)} for /usr/bin/python3; `.ci/install-packages command` "
                          "of the sources installs "
                          "all that the command uses") from error
