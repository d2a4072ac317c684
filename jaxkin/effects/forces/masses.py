"""Mass, centre and inertia of the parts of a mechanism: from their solids or their file, or as they are given."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, check_mechanism, check_one, one_number
from jaxkin._guesses import Result
from jaxkin._names import listed, nearest
from jaxkin._traced import traced
from jaxkin.effects.forces.densities import densities_of
from jaxkin.geometry.inertial import exceeds_sum, of_density_one
from jaxkin.geometry.part import Part
from jaxkin.geometry.units import METRES
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.placed_at import check_closed_pose, motion_of
from jaxkin.mechanism.pose import Pose

Number = float | int | np.ndarray | Array


@dataclass(frozen=True, eq=False)
class Mass:
    """The mass of one part, as a user gives it: `jk.Mass(0.3, centre=(10, 0, 0))`.

    What is None is taken from the solid of the part, scaled to this mass; without a solid, a part of no inertia is a
    point mass.
    """

    mass: Number
    """Kilograms."""
    centre: Sequence[float | int] | np.ndarray | Array | None = None
    """Centre of mass in the assembled pose, world coordinates, unit of the mechanism."""
    inertia: Any = None
    """Inertia about the centre of mass, kg m^2: (3, 3) in world axes of the assembled pose, or one number for all axes
    (a planar mechanism needs no more)."""


jax.tree_util.register_dataclass(Mass, data_fields=["mass", "centre", "inertia"], meta_fields=[])


@dataclass(frozen=True, eq=False, repr=False)
class Masses(Result):
    """Mass, centre and inertia of all parts of a mechanism, in their assembled pose. A pytree."""

    parts: tuple[str, ...]
    """Names of the parts, in the order of `mechanism.parts`; fixed parts have none unless they were given."""
    mass: Float[Array, " parts"]
    """Kilograms."""
    centre: Float[Array, "parts 3"]
    """Centres of mass, world coordinates, unit of the mechanism."""
    inertia: Float[Array, "parts 3 3"]
    """About the centres of mass, world axes, kg m^2."""
    unit: str = ""
    """Unit of the lengths."""

    @property
    def batch(self) -> tuple[int, ...]:
        """Axes in front of that of the parts, where `jax.vmap` made several masses at once; () of one mechanism."""
        return np.shape(self.mass)[:-1]

    @property
    def total(self) -> Float[Array, "*batch"]:
        """Sum of all masses, kilograms."""
        return jnp.sum(self.mass, axis=-1)

    def at(self, motion: Motion | Pose, index: int = 0) -> Masses:
        """Move the masses with their parts to pose `index` of a motion: those of `motion.mechanism.at(motion, index)`.

        Raises ValueError for a pose that is not there or not closed, and for a mechanism with other parts.
        """
        motion = motion_of(motion, "masses in another pose")
        check_one("masses in another pose", "the masses of one mechanism", self.batch)
        if motion.mechanism.parts != self.parts:
            raise ValueError("the motion is that of a mechanism with other parts than the masses have")
        check_closed_pose(motion, index)
        moved = jnp.stack([motion.transforms[part][index] for part in self.parts])
        turned = moved[:, :3, :3]
        centre = jnp.einsum("pij,pj->pi", turned, self.centre) + moved[:, :3, 3]
        return replace(self, centre=centre, inertia=turned @ self.inertia @ turned.swapaxes(1, 2))

    def __str__(self) -> str:
        if self.batch:
            return f"Masses of {len(self.parts)} parts, a batch of {' x '.join(map(str, self.batch))}"
        width = max(map(len, self.parts), default=0)
        lines = [f"Masses of {len(self.parts)} parts, {float(self.total):.6g} kg in all, centres in {self.unit or 'm'}"]
        for part, mass, centre, inertia in zip(self.parts, self.mass, self.centre, self.inertia, strict=True):
            if mass == 0 and not np.any(inertia):
                lines.append(f"  {part:<{width}}  none")
                continue
            at = ", ".join(f"{x:.6g}" for x in np.asarray(centre))
            own = ", ".join(f"{x:.3g}" for x in np.linalg.eigvalsh(np.asarray(inertia)))
            lines.append(f"  {part:<{width}}  {float(mass):<9.4g} kg at ({at}), principal inertias {own} kg m^2")
        return "\n".join(lines)


jax.tree_util.register_dataclass(Masses, data_fields=["mass", "centre", "inertia"], meta_fields=["parts", "unit"])


def masses(
    mechanism: Mechanism,
    density: float | int | str | Array | Mapping[str, Any] | None = None,
    *,
    given: Mapping[str, Mass | Number] | None = None,
) -> Masses:
    """Find mass, centre and inertia of each part of a mechanism: as given, as its file says, or from its solids.

    `density` is in kg/m^3, or the name of a material in `jaxkin.effects.forces.densities.DENSITIES`; a dictionary has
    one for each part, whose names may have "*", where a full name goes before "*". `given` has for a part its
    `jk.Mass`, or only its kilograms: it needs no density, and on mechanisms by hand no solid. Files of robots and
    exports of CAD systems say what their parts weigh: that goes before a density for all parts ("*" too), and not
    before one that names the part. The density of a material that a STEP file says is taken where `density` has none.
    Fixed parts need no mass.

    Works inside `jit` and `grad` with respect to densities and given masses. Warns of a density that no part takes,
    since files say what all of them weigh. Raises ValueError for parts of which no mass can be found, with what to
    write; for solids that are open, inertias that no body has, and unknown parts and materials.
    """
    check_mechanism(mechanism, "masses")
    known = dict(by_name(given or {}, "given masses", "{'rod': jk.Mass(0.3, centre=(10, 0, 0))}"))
    for name in known:
        if name not in mechanism.parts:
            raise ValueError(f"there is no part {name!r} to give a mass{nearest(str(name), mechanism.parts)}")
    parts = {part.name: part for part in mechanism.solids}
    solids = {name: part for name, part in parts.items() if part.is_solid}
    densities, named = densities_of(density, tuple(parts.values()))
    rows, missing, passed_over, taken = [], [], [], False
    for name in mechanism.parts:
        if name in known:
            rows.append(_given(name, known[name], solids.get(name), METRES[mechanism.unit]))
        elif name in mechanism.fixed:
            rows.append((0.0, np.zeros(3), np.zeros((3, 3))))
        elif name in parts and name not in named and (own := parts[name].inertial) is not None:
            rows.append((own.mass, own.centre, own.inertia))
            passed_over += [name] if name in densities else []
        elif name in solids and (own := densities.get(name, solids[name].density)) is not None:
            rows.append(_of_solid(solids[name], own, METRES[mechanism.unit]))
            taken |= name in densities
        else:
            missing.append(name)
    if missing:
        raise ValueError(_what_is_missing(missing, solids, density))
    if passed_over and not taken:
        warnings.warn(
            f"the density is that of no part: the file has the mass of {listed([*map(repr, passed_over)])}, and goes "
            "before a density for all parts; one that names a part goes before the file, as in "
            f"{{{passed_over[0]!r}: 'steel'}}",
            stacklevel=2,
        )
    # known numbers are put together on the host, where nothing is compiled for it
    xp = jnp if traced(rows) else np
    mass, centre, inertia = (
        jnp.asarray(xp.stack([xp.asarray(each, float) for each in column])) for column in zip(*rows, strict=True)
    )
    return Masses(mechanism.parts, mass, centre, inertia, mechanism.unit)


def _what_is_missing(missing: Sequence[str], solids: Mapping[str, Part], density: Any) -> str:
    """Say which parts have no mass, and what to write for the first of them."""
    names = ", ".join(map(repr, missing))
    first = missing[0]
    if first in solids and density is None:
        return f"no density of {names}: write jk.masses(mechanism, 7850) or jk.masses(mechanism, 'steel')"
    if first in solids:
        return f"no density of {names}: give one of {first!r}, such as 7850, or one of '*' for all others"
    return (
        f"no mass of {names}: a part without a solid needs given={{{first!r}: jk.Mass(0.3, centre=(x, y, z))}}, or "
        f"given={{{first!r}: 0}} for none"
    )


def _of_solid(part: Part, density: Any, metre: float) -> tuple[Any, Any, Any]:
    """Compute mass, centre and inertia of a solid of some density."""
    volume, centre, inertia = _volume(part)
    return density * volume * metre**3, centre, density * inertia * metre**5


def _volume(part: Part) -> tuple[float, np.ndarray, np.ndarray]:
    """Compute volume, centre and inertia for a density of one, unit of the part; ValueError for open surfaces."""
    found = of_density_one(part.triangles)
    if found is None:
        raise ValueError(
            f"the surface of {part.name!r} is not closed, so that its volume is unknown: give its mass, "
            f"given={{{part.name!r}: jk.Mass(0.3, centre=(x, y, z), inertia=...)}}"
        )
    return found.mass, found.centre, found.inertia


def _given(name: str, given: Any, part: Part | None, metre: float) -> tuple[Any, Any, Any]:
    """Complete mass, centre and inertia of a part, as given, from its solid."""
    given = given if isinstance(given, Mass) else Mass(given)
    kilograms = "one number of kilograms"
    if not traced(one_number(given.mass, f"the mass of {name!r}", kilograms)) and given.mass < 0:
        raise ValueError(f"the mass of {name!r} must be {kilograms}, got {given.mass!r}")
    none = not traced(given.mass) and given.mass == 0
    shape = None
    if part is not None and not none and (given.centre is None or given.inertia is None):
        shape = _volume(part)
    if given.centre is not None:
        centre = _shaped(name, "centre", given.centre, (3,))
    elif shape is not None:
        centre = shape[1]
    elif none:
        centre = np.zeros(3)
    else:
        raise ValueError(
            f"the mass of {name!r} needs a centre, as it has no solid: jk.Mass({given.mass!r}, centre=(x, y, z))"
        )
    if given.inertia is not None:
        inertia = given.inertia
        if np.shape(inertia) == ():
            expected = "one number, or a matrix (3, 3), kg m^2"
            inertia = one_number(inertia, f"the inertia of {name!r}", expected) * np.eye(3)
        inertia = _shaped(name, "inertia", inertia, (3, 3))
        _check_inertia(name, inertia)
    elif shape is not None:
        inertia = given.mass / shape[0] * shape[2] * metre**2
    else:
        inertia = np.zeros((3, 3))
    return given.mass, centre, inertia


def _check_inertia(name: str, inertia: Any) -> None:
    """Raise ValueError for known numbers that no distribution of mass has."""
    if traced(inertia):
        return
    size, moments = np.abs(inertia).max(), np.linalg.eigvalsh(inertia)
    if np.abs(inertia - inertia.T).max() > 1e-9 * size or moments.min() < -1e-9 * size:
        raise ValueError(
            f"the inertia of {name!r} is no inertia of a part: its matrix must be symmetric, without negative "
            f"eigenvalues, got {np.asarray(inertia).tolist()}"
        )
    if exceeds_sum(moments):
        raise ValueError(
            f"the inertia of {name!r} is no inertia of a part: none of its principal moments may be above the sum of "
            f"the other two, got {', '.join(f'{x:.4g}' for x in moments)}; a part that turns about one axis only needs "
            f"one number, inertia={moments[2]:.4g}"
        )


def _shaped(name: str, what: str, value: Any, shape: tuple[int, ...]) -> Any:
    """Check numbers of one shape; ValueError for others."""
    try:
        found = (jnp if traced(value) else np).asarray(value, float)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.shape != shape or (not traced(found) and not np.isfinite(found).all()):
        raise ValueError(f"the {what} of {name!r} must be finite numbers of shape {shape}, got {value!r}")
    return found
