"""OpenBLAS on one thread: the sums in eigenvectors and products, and so their last digits, go with the number of
threads, which workers, ranks and the parent do not share."""
from __future__ import annotations

import ctypes
import functools
import pathlib


@functools.lru_cache(maxsize=1)
def one_thread() -> None:
    """From now on in this process; nothing where there is no OpenBLAS. After numpy was loaded."""
    try:
        lines = pathlib.Path("/proc/self/maps").read_text(encoding="utf-8").splitlines()
    except OSError:
        return
    for path in sorted({line.split(None, 5)[-1] for line in lines if "blas" in line}):
        try:
            ctypes.CDLL(path).openblas_set_num_threads(1)
        except (OSError, AttributeError):
            continue
