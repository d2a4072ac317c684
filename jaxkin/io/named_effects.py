"""Effects by name, as studies and the command line ask for them: only those are computed.

To give an effect a name: a row of `EFFECTS`. A function of a motion whose other arguments have defaults, such as
`clashes(motion, *, within=None)`, stands there as it is; its keyword arguments are the settings. Beside it stands what
it may lack, in the words of a study.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

from jaxkin._arguments import by_name, one_number
from jaxkin._names import closest, listed, nearest
from jaxkin.effects.clashes import clashes
from jaxkin.effects.contact_validity import contact_validity
from jaxkin.effects.forces.acting import STANDARD_GRAVITY
from jaxkin.effects.forces.drive import drive_forces
from jaxkin.effects.forces.masses import masses
from jaxkin.effects.forces.reactions import reactions
from jaxkin.effects.rates import accelerations, velocities
from jaxkin.geometry.movements import is_length
from jaxkin.mechanism.motion import Motion


class Result(Protocol):
    """What an effect finds: it prints, draws and saves itself."""

    def plot(self, path: str | Path) -> Path: ...

    def save(self, path: str | Path) -> Path: ...


def _rates(motion: Motion, /, **speeds: float | int) -> dict[str, Result]:
    """Compute velocities and accelerations for constant `speeds` of the drive, degrees and lengths a unit of time.

    Without speeds each drive moves by 1 radian, or 1 unit of length, per unit of time.
    """
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
    weights = masses(motion.mechanism, density)
    rates = None if speeds is None else _in_radians(motion, "forces", speeds)
    return {
        "drive_forces": drive_forces(motion, weights, gravity=gravity, rates=rates),
        "reactions": reactions(motion, weights, gravity=gravity, rates=rates),
    }


def _in_radians(motion: Motion, effect: str, speeds: Mapping[str, float | int]) -> dict[str, float]:
    """Convert speeds of driven coordinates in degrees into radians; those of lengths stay."""
    example = ", ".join(f'"{name}" = 10' for name in motion.inputs)
    found = {}
    for name, speed in by_name(speeds, f"{effect}: speeds", f"{{ {example} }}").items():
        if isinstance(speed, Mapping) and speed:
            dotted = f"{name}.{next(iter(speed))}"
            raise ValueError(f"{effect}: a name with a dot stands in quotes: {dotted!r} = 10")
        known_speed = float(one_number(speed, f"{effect}: the speed of {name!r}"))
        found[name] = known_speed if is_length(_coordinate_name(motion, effect, name)) else np.radians(known_speed)
    return found


def _coordinate_name(motion: Motion, effect: str, name: str) -> str:
    """Find the driven coordinate, such as "phi", that "joint" or "joint.coordinate" means; ValueError for others."""
    found = [each for each in motion.inputs if each == name or each.rpartition(".")[0] == name]
    if not found:
        raise ValueError(f"{effect}: {name!r} is not driven{nearest(name, motion.inputs)}")
    return found[0].rpartition(".")[2]


def _rates_lack(motion: Motion, settings: Mapping[str, Any]) -> str:
    if settings or len(motion.inputs) == 1:
        return ""
    return (
        f"the speeds of the driven coordinates, of which there are {len(motion.inputs)}: write in a study "
        f"[effects.rates] with {' and '.join(f'{name!r} = 10' for name in motion.inputs)}"
    )


def _clashes_lack(motion: Motion, settings: Mapping[str, Any]) -> str:
    if any(part.is_solid for part in motion.mechanism.solids):
        return ""
    return 'solids, and there are none: name their file in a study, geometry = "machine.step"'


def _contacts_lack(motion: Motion, settings: Mapping[str, Any]) -> str:
    if any(part.faces for part in motion.mechanism.solids):
        return ""
    return (
        "solids with faces, and there are none: the file of a robot says its joints itself, without faces; name solids "
        'in a study, geometry = "machine.step"'
    )


def _forces_lack(motion: Motion, settings: Mapping[str, Any]) -> str:
    solids = motion.mechanism.solids
    known = {part.name for part in solids if part.inertial} | {*motion.mechanism.fixed}
    left = [part for part in motion.mechanism.parts if part not in known]
    solid = {part.name for part in solids if part.is_solid}
    if hollow := [part for part in left if part not in solid]:
        return (
            f"the mass of {listed(hollow)}, without a solid: no study can say it; jk.masses(..., given=) in Python can"
        )
    if not left or settings.get("density") is not None:
        return ""
    return (
        "the density of the parts, in kg/m^3 or the name of a material: write in a study [effects.forces] with "
        'density = "steel", or density = { crank = 2700, "*" = 7850 }'
    )


Settings = Mapping[str, Mapping[str, Any]]
"""The effects that are asked for by name, each with its settings."""


class Effect(NamedTuple):
    """An effect that has a name."""

    compute: Callable[..., Result | Mapping[str, Result]]
    """A function of a motion and of settings (keyword arguments). It returns one result, whose files have the name of
    the effect, or several results by the names of their files."""
    lack: Callable[[Motion, Mapping[str, Any]], str]
    """What the effect needs and does not have, for a motion and settings, in words; empty where it can be computed."""


EFFECTS = {
    "rates": Effect(_rates, _rates_lack),
    "clashes": Effect(clashes, _clashes_lack),
    "contacts": Effect(contact_validity, _contacts_lack),
    "forces": Effect(_forces, _forces_lack),
}
"""The effects by name."""


def check_effects(names: Iterable[str]) -> None:
    """Raise ValueError for a name that no effect has."""
    for name in names:
        if name not in EFFECTS:
            raise ValueError(f"there is no effect {name!r}{closest(name, EFFECTS)}; there are {', '.join(EFFECTS)}")


def compute(motion: Motion, asked: Settings, progress: Callable[[int, int], None] | None = None) -> dict[str, Result]:
    """Compute the effects that are asked for, and no others; returns results by the names of their files.

    `progress(done, total)` is called as an effect that takes long goes on. Raises ValueError, with the name of the
    effect, for settings that it does not have and for what it lacks.
    """
    check_effects(asked)
    results: dict[str, Result] = {}
    for name, settings in asked.items():
        effect = EFFECTS[name]
        takes = signature(effect.compute).parameters
        free = any(each.kind is each.VAR_KEYWORD for each in takes.values())
        has = [key for key, each in takes.items() if each.kind is each.KEYWORD_ONLY and key != "progress"]
        for key in settings:
            if not free and key not in has:
                knows = f"it has {', '.join(has)}" if has else "it has none"
                raise ValueError(f"effect {name!r}: there is no setting {key!r}; {knows}")
        if lack := effect.lack(motion, settings):
            raise ValueError(f"{name} needs {lack}")
        told = {"progress": progress} if progress and "progress" in takes else {}
        found = effect.compute(motion, **settings, **told)
        results |= found if isinstance(found, Mapping) else {name: found}
    return results


def missing(motion: Motion, asked: Iterable[str]) -> str:
    """Name the effects that were not asked for, and say what computes them; empty where all were asked for.

    Those that can be computed of the motion are offered as an option of the command line. A line on each of the others
    says what it lacks.
    """
    left = {name: EFFECTS[name].lack(motion, {}) for name in EFFECTS if name not in asked}
    able = [name for name, lack in left.items() if not lack]
    offered = f" (--effects {','.join(able)})" if able else ""
    needs = [f"  {name} needs {lack}" for name, lack in left.items() if lack]
    return "\n".join([f"Not computed: {', '.join(left)}{offered}.", *needs]) if left else ""
