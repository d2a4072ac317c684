"""Evaluate the closure of planar loops (Eq. 10): every joint turns about the normal of one plane, or slides in it.

A loop has three equations instead of six: its rotations add up to zero, and so do the vectors of its links, each at its
absolute angle. The absolute angles are sums of coordinates. Residual and Jacobian are linear in the cosines and sines
of these angles (for links that slide also in the products of cosines and sines with the sliding coordinate), so that a
loop is evaluated by two products of matrices. Coordinates out of the plane (`linkage.planes`,
`linkage.decoupled_plane`) rest, and are no columns of the system.
"""

from __future__ import annotations

from functools import lru_cache, reduce
from itertools import accumulate
from operator import add
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.closure.loop_closure import LoopClosure
from jaxkin.solve.closure.spatial_geometry import Spatial
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem

MIN_UNROLLED_SUM_POSES = 257
"""Number of poses from which on the sum over the terms is written out as straight-line code over the poses, which is
then faster than a product of matrices. For fewer poses, such as are corrected together, the gain is less than the time
to compile the code."""
MAX_UNROLLED_SUM_TERMS = 32
"""Largest number of terms of a sum that is written out: compile time grows with the number."""


class Planar(NamedTuple):
    """Constants of the loops in the plane, lengths divided by the characteristic length.

    The terms of a loop are the cosines of the absolute angles of its links, the sines, both multiplied by the sliding
    coordinates of the links (if the system has any), and the number one.
    """

    sense: Float[Array, "loops links"]
    """Sign of the coordinate by which a link turns relative to the previous one: -1 or 1; 0 for a link that slides."""
    moved: Float[Array, "loops 2 terms"]
    """Coefficients of the terms in the end point of the loop: the links from joint to joint in the assembled pose."""
    jacobian: Float[Array, "loops rows terms"]
    """Coefficients of the terms in the derivatives of rotation and both translations with respect to all columns."""
    open_turn: Float[Array, "2 loops"]
    """Cosine and sine of the rotation that is left open in the assembled pose: 1 and 0 unless lengths were changed."""
    off_plane: Float[Array, ""]
    """Squared residual out of the plane (Eq. 12), which no motion in the plane can close."""


def planar_closure(system: LoopSystem, geometry: Planar, x: Float[Array, "columns poses"]) -> LoopClosure:
    """Evaluate the closure of all loops in the plane.

    A loop has three equations: the sine of the rotation that is left open, and two translations.
    """
    poses = x.shape[-1]
    padded = jnp.concatenate([x, jnp.zeros_like(x[:1])])
    both = cos_sin(_sums(geometry.sense[..., None] * padded[_plane_motions(system).turner.T]))
    terms = [*both, jnp.ones_like(both[0, :, :1])]
    if _slides(system):
        terms[2:2] = list(padded[_plane_motions(system).slider.T] * both)
    moved = _moved(geometry, terms)
    cos, sin = both[:, :, -1]
    open_cos, open_sin = geometry.open_turn[..., None]
    rest_cos = cos * open_cos - sin * open_sin
    rest_sin = sin * open_cos + cos * open_sin
    # a rotation in the plane changes four of the nine entries; 2 - 2 cos would lose digits by cancellation
    rotated = 2 * reduce(add, (rest_cos - 1) ** 2 + rest_sin**2)
    if _unrolled(terms):
        jacobian = _along_links(system, geometry, terms)
    else:
        jacobian = jnp.einsum("lrt,ltp->lrp", geometry.jacobian, jnp.concatenate(terms, axis=1))
    return LoopClosure(
        jnp.concatenate([rest_sin[:, None], moved], axis=1).reshape(system.loop_equations, poses),
        jacobian.reshape(system.loop_equations, system.columns, poses),
        rotated,
        reduce(add, (moved**2).reshape(2 * len(moved), poses)),
    )


def _moved(geometry: Planar, terms: list[Float[Array, "loops _ poses"]]) -> Float[Array, "loops 2 poses"]:
    """Compute the end points of the loops in the plane, `Planar.moved` times the terms: the translations of Eq. 10."""
    if not _unrolled(terms):
        return jnp.einsum("ldt,ltp->ldp", geometry.moved, jnp.concatenate(terms, axis=1))
    single = (some[:, None, k] for some in terms for k in range(some.shape[1]))
    return reduce(add, (geometry.moved[..., t, None] * term for t, term in enumerate(single)))


def _unrolled(terms: list[Float[Array, "loops _ poses"]]) -> bool:
    """Tell whether sums over the terms are written out as straight-line code over the poses."""
    count = sum(some.shape[0] * some.shape[1] for some in terms)
    return terms[0].shape[-1] >= MIN_UNROLLED_SUM_POSES and count <= MAX_UNROLLED_SUM_TERMS


def _along_links(
    system: LoopSystem, geometry: Planar, terms: list[Float[Array, "loops _ #poses"]]
) -> Float[Array, "loops rows poses"]:
    """Compute the Jacobian, `Planar.jacobian` times the terms, link by link: most of its coefficients are zero.

    A coordinate by which a link turns moves the vector from the link to the end of the loop at right angles to it; one
    by which a link slides moves the end along the direction of the link.
    """
    kept, (cos, sin) = _plane_motions(system), terms[:2]
    links, none = cos.shape[1], jnp.zeros_like(cos[0, 0])
    found = []
    for loop in range(len(cos)):
        every: list[list[Array]] = [[none, none, none] for _ in range(system.columns)]
        x, y = none, none
        for k in reversed(range(links)):
            for number, some in enumerate(terms[:-1]):
                x = x + geometry.moved[loop, 0, number * links + k] * some[loop, k]
                y = y + geometry.moved[loop, 1, number * links + k] * some[loop, k]
            sense, (turner, slider) = geometry.sense[loop, k], (kept.turner[k, loop], kept.slider[k, loop])
            moved = [(turner, [sense, -sense * y, sense * x])]
            if _slides(system):
                along, across = geometry.moved[loop, :, 2 * links + k], geometry.moved[loop, :, 3 * links + k]
                moved.append((slider, [none, *(along[:, None] * cos[loop, k] + across[:, None] * sin[loop, k])]))
            for column, by in moved:
                if column < system.columns:
                    every[column] = [a + b for a, b in zip(every[column], by, strict=True)]
        found.append(jnp.stack([each[row] for row in range(3) for each in every]))
    return jnp.stack(found)


def planar_geometry(system: LoopSystem, space: Spatial) -> Planar:
    """Compute the constants in the plane from those in space; the normal is the axis of the first rotation."""
    table, kept = chain_tables(system), _plane_motions(system)
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
    sense = (sign * facing).T
    turns = jnp.cumsum(sense[..., None] * one_hot.swapaxes(0, 1), axis=1)

    arrival = jnp.einsum("di,li->dl", plane, last[:, :3, 3])
    centre = jnp.where(used_, centre, arrival[:, None])  # padding of shorter loops lies at their end point
    links = (jnp.concatenate([centre[:, 1:], arrival[:, None]], axis=1) - centre).swapaxes(1, 2)
    direction = jnp.einsum("di,kli->dlk", plane, axis) * (sign * jnp.asarray((1 - turning) * used)).T

    off_plane = squared_off_plane(axis, turning, used_, normal, last)
    open_turn = jnp.einsum("i,lij,dj->dl", plane[0], last[:, :3, :3], plane * jnp.array([1.0, -1.0])[:, None])
    moved, jacobian = _by_terms(system, turns, links, direction, one_hot.swapaxes(0, 1), centre[:, 0])
    return Planar(sense, moved, jacobian, open_turn, off_plane)


def squared_off_plane(
    axis: Array | np.ndarray,
    turning: Array | np.ndarray,
    moves: Array | np.ndarray,
    normal: Array | np.ndarray,
    left_open: Array | np.ndarray,
    xp: Any = jnp,
) -> Any:
    """Compute the squared residual of planar loops out of their plane (Eq. 12), which no motion in the plane can close.

    `axis` (rows, loops, 3) are the axes of the elementary motions in the assembled pose: of those that `moves` counts,
    the `turning` ones should be parallel to the `normal`, and the others perpendicular. `left_open` (loops, 4, 4) are
    the displacements that are left open there. `xp` is jax.numpy or numpy.
    """
    tilt = xp.where(turning, xp.sum(xp.cross(axis, normal) ** 2, axis=-1), (axis @ normal) ** 2)
    leaning = left_open[:, :3, :3] @ normal - normal
    return xp.sum(xp.where(moves, tilt, 0.0)) + xp.sum(leaning**2) + xp.sum((left_open[:, :3, 3] @ normal) ** 2)


def _by_terms(
    system: LoopSystem,
    turns: Float[Array, "loops links columns"],
    links: Float[Array, "2 loops links"],
    slides: Float[Array, "2 loops links"],
    coordinate: Float[Array, "loops links columns"],
    first: Float[Array, "2 loops"],
) -> tuple[Float[Array, "loops 2 terms"], Float[Array, "loops rows terms"]]:
    """Compute `Planar.moved` and `Planar.jacobian`.

    `turns` is the derivative of the absolute angle of each link with respect to the columns, `links` and `slides` are
    the vectors of the links and the directions in which they slide in the assembled pose, `coordinate` marks the column
    of each link, and `first` is the first point of each loop.
    """

    def rotating(vectors: Array) -> list[Array]:
        """Compute the coefficients of cosine and sine of the angle of each link in a vector that turns with it."""
        along, across = vectors
        return [jnp.stack([along, across]), jnp.stack([-across, along])]

    parts = [links, slides] if _slides(system) else [links]
    moving = jnp.concatenate([by for vectors in parts for by in rotating(vectors)], axis=-1)
    # a rotation moves all later links at right angles to their direction
    behind = jnp.concatenate([turns] * (2 * len(parts)), axis=1)
    derivative = jnp.einsum("dlt,ltc->ldct", jnp.stack([-moving[1], moving[0]]), behind)
    if _slides(system):
        along = jnp.einsum(
            "dlt,ltc->ldct", jnp.concatenate(rotating(slides), axis=-1), jnp.concatenate([coordinate] * 2, 1)
        )
        derivative = derivative.at[..., : along.shape[-1]].add(along)
    by_one = jnp.pad(turns[:, None, -1, :, None], [(0, 0), (0, 2), (0, 0), (0, 0)])
    turn = jnp.zeros_like(derivative[:, :1])
    jacobian = jnp.concatenate([jnp.concatenate([turn, derivative], axis=1), by_one], axis=-1)
    moved = jnp.concatenate([moving, first[..., None]], axis=-1)
    return moved.swapaxes(0, 1), jacobian.reshape(len(system.loops), 3 * system.columns, -1)


def _sums(angles: Float[Array, "loops links poses"]) -> Float[Array, "loops links poses"]:
    """Add up the relative angles of the links to absolute angles, by straight-line code, since links are few."""
    return jnp.stack(list(accumulate(jnp.moveaxis(angles, 1, 0))), axis=1)


def _slides(system: LoopSystem) -> bool:
    """Tell whether any coordinate of the system is a length."""
    return any(system.is_length)


class _PlaneMotions(NamedTuple):
    """The elementary motions of each loop that act in the plane."""

    step: np.ndarray
    """(links, loops): row of each motion in `chain_tables`; shorter loops are padded with the number of rows."""
    turner: np.ndarray
    """(links, loops): column of the coordinate by which a link turns; the number of columns if there is none."""
    slider: np.ndarray
    """(links, loops): column of the coordinate by which a link slides; the number of columns if there is none."""
    reference: tuple[int, int]
    """Row and loop in `chain_tables` of the rotation whose axis is the normal."""


@lru_cache(maxsize=256)
def _plane_motions(system: LoopSystem) -> _PlaneMotions:
    """Select the elementary motions that act in the plane from the tables of the system."""
    table = chain_tables(system)
    inside = table.column < system.columns
    chosen = [np.flatnonzero(column) for column in inside.T]
    length = max(map(len, chosen))
    filled = [np.append(numbers, [len(inside)] * (length - len(numbers))) for numbers in chosen]
    step, loop = np.argwhere(inside & (table.turn > 0))[0]
    number = np.array(filled, int).T
    used = number < len(inside)
    at = np.minimum(number, len(inside) - 1), np.arange(number.shape[1])
    turner, slider = (
        np.where(used & (kind[at] > 0), table.column[at], system.columns) for kind in (table.turn, table.slide)
    )
    return _PlaneMotions(number, turner, slider, (int(step), int(loop)))
