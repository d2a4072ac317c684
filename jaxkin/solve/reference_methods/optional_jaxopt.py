"""jaxopt, imported when it is used: it takes a third of a second, and warns that it is not developed any further."""

from __future__ import annotations

import warnings
from types import ModuleType


def jaxopt() -> ModuleType:
    """The library."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="JAXopt is no longer maintained", category=DeprecationWarning)
        import jaxopt
    return jaxopt
