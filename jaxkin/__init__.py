"""jaxkin: differentiable kinematics of closed-loop mechanisms, from solid models to joints, loops and motion.

assembly = jk.load("fourbar.step")
mechanism = assembly.mechanism(fixed=["ground"])
motion = mechanism.sweep({"ground-crank": jnp.linspace(0, 2 * jnp.pi, 361)})
motion.save("out/")
"""

import functools
import sys
import types
import typing

if typing.TYPE_CHECKING:
    from jaxkin._api import *  # noqa: F403

__version__ = "0.1.0"


class _Floor(types.ModuleType):
    """A package within jaxkin: whoever calls it, as in `jk.mobility(mechanism)`, is told what to write."""

    def __call__(self, *args: typing.Any, **named: typing.Any) -> typing.NoReturn:
        from jaxkin._guesses import called

        raise called(self.__name__)


class _Package(types.ModuleType):
    """jaxkin itself, of which the import system makes each package within it an attribute."""

    def __setattr__(self, name: str, value: typing.Any) -> None:
        if type(value) is types.ModuleType and value.__name__ == f"{__name__}.{name}":
            value.__class__ = _Floor
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> typing.Any:
    """Import a name from its module, and what that needs, when it is asked for: all modules take nearly as long to
    import as JAX, which the help of the command line does not need either."""
    if name.startswith("__"):
        raise AttributeError(name)
    from importlib import import_module

    module = _exports().get(name)
    if module is None:
        from jaxkin._guesses import missing

        raise missing("module 'jaxkin'", name, list(_exports()))
    found = import_module(f"jaxkin.{name}") if module == "jaxkin" else getattr(import_module(module), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*_exports(), "__version__"])


@functools.cache
def _exports() -> dict[str, str]:
    """Read the list of what users import, without importing that: each name with its module."""
    import ast
    from importlib import import_module
    from pkgutil import get_data

    exports: dict[str, str] = {}
    for node in ast.parse(get_data("jaxkin", "_api.py") or "").body:
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [alias.name for alias in node.names]
            exports |= dict.fromkeys(import_module(node.module).__all__ if names == ["*"] else names, node.module)
    return exports
