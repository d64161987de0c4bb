"""Packages that are used where they are there: numpy for arrays, pandas for frames, matplotlib for plots."""
from __future__ import annotations

import importlib
from typing import Any

try:
    import numpy as _numpy
    numpy: Any = _numpy
except ImportError:
    numpy = None

DEBIAN = {"numpy": "python3-numpy", "pandas": "python3-pandas", "matplotlib.pyplot": "python3-matplotlib",
          "pint": "python3-pint", "plotly.offline": "python3-plotly", "tqdm": "python3-tqdm"}


def need(name: str) -> Any:
    """The module. Raises ImportError that says how it is installed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{name} is needed for this and was not found: pip install {name.split('.')[0]}, or "
                          f"apt install {DEBIAN.get(name, name)}") from error
