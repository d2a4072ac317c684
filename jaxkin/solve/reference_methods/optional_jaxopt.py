"""Import jaxopt when it is used: the import takes a third of a second, and warns."""

from __future__ import annotations

import warnings
from types import ModuleType


def jaxopt() -> ModuleType:
    """Import the library, without its warning that it is not maintained any more."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="JAXopt is no longer maintained", category=DeprecationWarning)
        import jaxopt
    return jaxopt
