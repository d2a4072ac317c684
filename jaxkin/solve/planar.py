"""Closure of planar loops: every joint turns about the normal of one plane, or slides in it.

Three equations a loop instead of six: the turns add up to none, and the links, each at its absolute angle, to nothing.
The angles are sums of coordinates, so that a whole loop is one product of matrices and one sum. Coordinates along the
normal (those of cylindrical joints) commute with all of this: they rest.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.spatial import Spatial
from jaxkin.solve.steps import steps
from jaxkin.solve.system import LoopSystem
from jaxkin.solve.trig import Trig


class Planar(NamedTuple):
    """Constants of the loops in the plane, lengths divided by the characteristic length."""

    turns: Float[Array, "loops links columns"]
    """Absolute angle of each link by the coordinates: -1, 0 or 1."""
    links: Float[Array, "2 loops links"]
    """Each link, from its joint to the next, as it lies in the assembled pose."""
    slides: Float[Array, "2 loops links columns"]
    """Direction in which a coordinate lengthens the link."""
    first: Float[Array, "2 loops"]
    """Where the first joint lies: the links lead from there back to the origin."""
    begun: Float[Array, "2 loops"]
    """Cosine and sine of the turn that the loop leaves open at the assembled pose: none unless lengths were changed."""
    off: Float[Array, ""]
    """Square of what leads out of the plane: no motion in the plane closes that."""


def planar_closure(
    system: LoopSystem, geometry: Planar, x: Float[Array, "columns poses"], trig: Trig
) -> tuple[Array, Array, Array, Array]:
    """Residual (turn and two translations a loop), Jacobian, and squares of Eq. 12: see `closure.Closure`."""
    loops, poses = len(system.loops), x.shape[-1]
    angles = jnp.einsum("lkc,cp->lkp", geometry.turns, x)
    cos, sin = trig(angles)

    def turned(vectors: Array) -> tuple[Array, Array]:
        return cos * vectors[0] - sin * vectors[1], sin * vectors[0] + cos * vectors[1]

    links = geometry.links[..., None]
    if slid := any(system.is_length[column] for column in system.plane or ()):
        links = links + jnp.einsum("dlkc,cp->dlkp", geometry.slides, x)
    along, across = turned(links)
    moved = geometry.first[..., None] + jnp.stack([jnp.sum(along, axis=1), jnp.sum(across, axis=1)])
    begun_cos, begun_sin = geometry.begun[..., None]
    rest_cos = cos[:, -1] * begun_cos - sin[:, -1] * begun_sin
    rest_sin = sin[:, -1] * begun_cos + cos[:, -1] * begun_sin
    residual = jnp.stack([rest_sin, *moved], axis=1)

    columns = [
        jnp.broadcast_to(geometry.turns[:, -1, :, None], (loops, system.columns, poses)),
        -jnp.einsum("lkc,lkp->lcp", geometry.turns, across),
        jnp.einsum("lkc,lkp->lcp", geometry.turns, along),
    ]
    if slid:
        columns[1] += jnp.einsum("lkc,lkp->lcp", geometry.slides[0], cos)
        columns[1] -= jnp.einsum("lkc,lkp->lcp", geometry.slides[1], sin)
        columns[2] += jnp.einsum("lkc,lkp->lcp", geometry.slides[0], sin)
        columns[2] += jnp.einsum("lkc,lkp->lcp", geometry.slides[1], cos)
    # a turn changes four of the nine entries of a rotation matrix; not 2 - 2 cos, which cancels
    rotated = 2 * jnp.sum((rest_cos - 1) ** 2 + rest_sin**2, axis=0)
    return (
        residual.reshape(system.equations, poses),
        jnp.stack(columns, axis=1).reshape(system.equations, system.columns, poses),
        rotated,
        jnp.sum(moved**2, axis=(0, 1)),
    )


def planar_geometry(system: LoopSystem, space: Spatial) -> Planar:
    """The constants in the plane of the first joint that turns, from those in space."""
    table, kept = steps(system), _kept(system)
    loops = np.arange(len(system.loops))

    def onward(pose: Array, between: Array) -> tuple[Array, Array]:
        pose = pose @ between
        return pose, pose

    eye = jnp.broadcast_to(jnp.eye(4, dtype=space.end.dtype), space.end.shape)
    last, poses = lax.scan(onward, eye, space.between)
    last = last @ space.end
    basis = poses[kept.reference][:3, :3].T
    normal, plane = basis[2], basis[:2]

    used = kept.step < len(table.sign)
    step = np.minimum(kept.step, len(table.sign) - 1)
    used_, sign = jnp.asarray(used), jnp.asarray(np.where(used, table.sign[step, loops], 0), last.dtype)
    chosen = poses[step, loops]
    axis, centre = chosen[..., :3, 2], jnp.einsum("di,kli->dkl", plane, chosen[..., :3, 3])
    turning = table.turn[step, loops] * used
    facing = jnp.where(turning, jnp.sign(axis @ normal), 0.0)
    one_hot = jnp.asarray(
        np.arange(system.columns) == np.where(used, table.column[step, loops], -1)[..., None], last.dtype
    )
    turns = jnp.cumsum((sign * facing)[..., None] * one_hot, axis=0)

    arrival = jnp.einsum("di,li->dl", plane, last[:, :3, 3])
    centre = jnp.where(used_, centre, arrival[:, None])  # steps that fill up the shorter loops stand at the end
    links = jnp.concatenate([centre[:, 1:], arrival[:, None]], axis=1) - centre
    direction = jnp.einsum("di,kli->dkl", plane, axis) * sign * jnp.asarray((1 - turning) * used)
    slides = direction[..., None] * one_hot

    tilt = jnp.where(turning, jnp.sum(jnp.cross(axis, normal) ** 2, axis=-1), (axis @ normal) ** 2)
    leaning = last[:, :3, :3] @ normal - normal
    off = jnp.sum(jnp.where(used_, tilt, 0.0)) + jnp.sum(leaning**2) + jnp.sum((last[:, :3, 3] @ normal) ** 2)
    begun = jnp.einsum("i,lij,dj->dl", plane[0], last[:, :3, :3], plane * jnp.array([1.0, -1.0])[:, None])
    return Planar(
        jnp.moveaxis(turns, 0, 1),
        jnp.swapaxes(links, 1, 2),
        jnp.swapaxes(slides, 1, 2),
        centre[:, 0],
        begun,
        off,
    )


class _Kept(NamedTuple):
    """Which elementary steps of the loops move in the plane."""

    step: np.ndarray
    """(links, loops): numbers of the steps; the number of steps, which is none, where a loop is shorter."""
    reference: tuple[int, int]
    """Step and loop of a turn, whose axis is the normal."""


@lru_cache(maxsize=256)
def _kept(system: LoopSystem) -> _Kept:
    table = steps(system)
    inside = np.isin(table.column, system.plane or ())
    chosen = [np.flatnonzero(column) for column in inside.T]
    length = max(map(len, chosen))
    filled = [np.append(numbers, [len(inside)] * (length - len(numbers))) for numbers in chosen]
    step, loop = np.argwhere(inside & (table.turn > 0))[0]
    return _Kept(np.array(filled, int).T, (int(step), int(loop)))
