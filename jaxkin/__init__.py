"""jaxkin: differentiable kinematics of closed-loop mechanisms, from solid models to joints, loops and motion.

assembly = jk.load("fourbar.step")
mechanism = assembly.mechanism(fixed=["ground"])
motion = mechanism.sweep({"ground-crank": jnp.linspace(0, 2 * jnp.pi, 361)})
motion.save("out/")
"""

import typing

if typing.TYPE_CHECKING:
    from jaxkin._api import *  # noqa: F403

__version__ = "0.1.0"


def __getattr__(name: str) -> typing.Any:
    """Import what users import, and JAX, when the first name is asked for: the help of the command line needs none."""
    if name.startswith("__"):
        raise AttributeError(name)
    from importlib import import_module

    found = vars(import_module("jaxkin._api"))
    if name not in found:
        raise AttributeError(f"module 'jaxkin' has no attribute {name!r}")
    globals()[name] = found[name]
    return found[name]


def __dir__() -> list[str]:
    from jaxkin import _api

    return sorted(name for name in vars(_api) if not name.startswith("_")) + ["__version__"]
