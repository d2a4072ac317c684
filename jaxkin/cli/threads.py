"""NumPy's linear algebra on one thread: the matrices of an assembly are too small to share.

OpenBLAS, which NumPy's wheels contain, has its threads wait for each other several times a row of a matrix. Where other
programs keep the cores busy, the singular values of 340 rows then take a second instead of 20 ms.
"""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

import numpy as np

_SETTERS = ("scipy_openblas_set_num_threads64_", "scipy_openblas_set_num_threads", "openblas_set_num_threads")


def one_thread() -> None:
    """Have NumPy work on one thread in this process, unless OPENBLAS_NUM_THREADS says otherwise.

    The variable itself is read when NumPy is imported, which is before any code of the command line runs. Without a
    library of OpenBLAS beside NumPy, nothing is done.
    """
    if "OPENBLAS_NUM_THREADS" in os.environ:
        return
    place = Path(np.__file__).parent
    for library in (*place.parent.glob("numpy.libs/*openblas*"), *place.glob(".dylibs/*openblas*")):
        loaded = ctypes.CDLL(str(library))
        for name in _SETTERS:
            if hasattr(loaded, name):
                getattr(loaded, name)(1)
