"""Effects by name, as studies and the command line ask for them: only those are computed.

To give an effect a name: a row of `EFFECTS`. A function of a motion whose other arguments have defaults, such as
`clashes(motion, *, within=None)`, stands there as it is; its keyword arguments are the settings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from jaxkin._names import closest, nearest
from jaxkin.effects.clashes import clashes
from jaxkin.effects.contact_validity import contact_validity
from jaxkin.effects.forces.drive import drive_forces
from jaxkin.effects.forces.masses import masses
from jaxkin.effects.forces.reactions import reactions
from jaxkin.effects.forces.wrenches import STANDARD_GRAVITY
from jaxkin.effects.rates import accelerations, velocities
from jaxkin.geometry.movements import is_length
from jaxkin.mechanism.motion import Motion


class Result(Protocol):
    """What an effect finds: it prints, draws and saves itself."""

    def plot(self, path: str | Path) -> Path: ...

    def save(self, path: str | Path) -> Path: ...


def _rates(motion: Motion, **speeds: float | int) -> dict[str, Result]:
    """Compute velocities and accelerations for constant `speeds` of the drive, degrees and lengths a unit of time."""
    if not speeds and len(motion.inputs) > 1:
        raise ValueError(
            f"rates needs the speeds of the driven coordinates, of which there are {len(motion.inputs)}: write in a "
            f"study [effects.rates] with {' and '.join(f'{name!r} = 10' for name in motion.inputs)}"
        )
    given = _in_radians(motion, "rates", speeds) or dict.fromkeys(motion.inputs, 1.0)
    return {"velocities": velocities(motion, given), "accelerations": accelerations(motion, given)}


def _forces(
    motion: Motion,
    *,
    density: Any = None,
    gravity: Sequence[float | int] = STANDARD_GRAVITY,
    speeds: Mapping[str, float | int] | None = None,
) -> dict[str, Result]:
    """Compute drive forces and reactions under weight, at rest or for constant `speeds`, degrees and lengths a second.

    `density` is that of `jk.masses`: kg/m^3, the name of a material, or either by part; files of robots need none.
    """
    if density is None and not any(part.inertial for part in motion.mechanism.solids):
        raise ValueError(
            "forces needs the density of the parts, in kg/m^3 or the name of a material: write in a study "
            '[effects.forces] with density = "steel", or density = { crank = 2700, "*" = 7850 }'
        )
    weights = masses(motion.mechanism, density)
    rates = None if speeds is None else _in_radians(motion, "forces", speeds)
    return {
        "drive_forces": drive_forces(motion, weights, gravity=gravity, rates=rates),
        "reactions": reactions(motion, weights, gravity=gravity, rates=rates),
    }


def _in_radians(motion: Motion, effect: str, speeds: Mapping[str, float | int]) -> dict[str, float]:
    """Convert speeds of driven coordinates in degrees into radians; those of lengths stay."""
    return {
        name: float(speed) if is_length(_coordinate_name(motion, effect, name)) else float(np.radians(speed))
        for name, speed in speeds.items()
    }


def _coordinate_name(motion: Motion, effect: str, name: str) -> str:
    """Find the driven coordinate, such as "phi", that "joint" or "joint.coordinate" means; ValueError for others."""
    found = [each for each in motion.inputs if each == name or each.rpartition(".")[0] == name]
    if not found:
        raise ValueError(f"{effect}: {name!r} is not driven{nearest(name, motion.inputs)}")
    return found[0].rpartition(".")[2]


EFFECTS: dict[str, Callable[..., Result | Mapping[str, Result]]] = {
    "rates": _rates,
    "clashes": clashes,
    "contacts": contact_validity,
    "forces": _forces,
}
"""Name of an effect -> a function of a motion and of settings (keyword arguments). The function returns one result,
whose files have the name of the effect, or several results by the names of their files."""

Settings = Mapping[str, Mapping[str, Any]]
"""The effects that are asked for by name, each with its settings."""


def known(names: Iterable[str]) -> None:
    """Raise ValueError for a name that no effect has."""
    for name in names:
        if name not in EFFECTS:
            raise ValueError(f"there is no effect {name!r}{closest(name, EFFECTS)}; there are {', '.join(EFFECTS)}")


def compute(motion: Motion, asked: Settings) -> dict[str, Result]:
    """Compute the effects that are asked for, and no others; returns results by the names of their files.

    Raises ValueError, with the name of the effect, for settings that it does not have and for what it lacks.
    """
    known(asked)
    results: dict[str, Result] = {}
    for name, settings in asked.items():
        takes = signature(EFFECTS[name]).parameters
        free = any(each.kind is each.VAR_KEYWORD for each in takes.values())
        has = [key for key, each in takes.items() if each.kind is each.KEYWORD_ONLY]
        for key in settings:
            if not free and key not in has:
                knows = f"it has {', '.join(has)}" if has else "it has none"
                raise ValueError(f"effect {name!r}: there is no setting {key!r}; {knows}")
        found = EFFECTS[name](motion, **settings)
        results |= found if isinstance(found, Mapping) else {name: found}
    return results


def missing(asked: Iterable[str]) -> str:
    """Name the effects that were not asked for, in a line for the user; empty where all were."""
    left = [name for name in EFFECTS if name not in asked]
    return f"Not computed: {', '.join(left)} (--effects {','.join(left)})." if left else ""
