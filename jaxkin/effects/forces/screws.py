"""The freedoms of a joint in each pose: unit twists of its coordinates, and what they let through."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.elementary_motions import amount, displaced_columns, rates
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.rigid import as_rigid, inverse, product
from jaxkin.joints.joint import Joint

TINY = 1e4
"""What is added to S^T S, in units of rounding, where coordinates of a joint may depend on each other."""


def joint_screws(
    joint: Joint, q: Float[Array, "poses _"], part_1: Float[Array, "poses 4 4"], size: Any, driven: Collection[int] = ()
) -> tuple[Float[Array, "poses 3"], Float[Array, "poses 6 _"]]:
    """The point of a joint in each pose, and the unit twists of its coordinates about this point, in world axes.

    Twists are those of part 2 relative to part 1. Lengths count over `size` in linear velocities, and in the
    coordinates that are lengths. The angles of a ball without a driven one are replaced by turns about the axes of the
    world, which allow the same at every angle.
    """
    found = jnp.moveaxis(part_1[:, :3], 0, -1)
    twists: list[Any] = []
    first = 0
    for number, (movement, frame) in enumerate(zip(joint.movements, joint.frames_1, strict=True)):
        if number:
            found = product(found, inverse(as_rigid(jnp.asarray(joint.frames_2[number - 1], float))))
        found = product(found, as_rigid(jnp.asarray(frame, float)))
        own: dict[int, list[Any]] = {}
        curve = joint.curves[number] if joint.curves else None
        point = None if curve is None else curve.spline(jnp).at(q[:, first], jnp)
        for element in MOVEMENTS[movement].elements:
            axis, at = found[:, element.axis], found[:, 3]
            slides, turns = rates(element, jnp.asarray(joint.pitch, float) / size, point)
            if element.law == "turn":  # the parameter of a curve is a length, and counts over `size`
                turns = turns * size
            turning = turns * axis
            if MOVEMENTS[movement].ball and not any(first + k in driven for k in range(3)):
                turning = jnp.broadcast_to(jnp.eye(3)[:, element.axis, None], axis.shape)
            own.setdefault(element.coordinate, []).append((turning, slides * axis, at))
            value = q[:, first + element.coordinate]
            how_far = amount(element, value, jnp.asarray(joint.pitch, float), point, _cos_sin)
            columns = displaced_columns([found[:, column] for column in range(4)], element.axis, *how_far)
            found = jnp.stack(columns, axis=1)
        twists += [own[k] for k in range(len(own))]
        first += len(own)
    place = found[:, 3]
    rows = [
        # a coordinate may drive several motions: their twists add up
        sum(
            jnp.concatenate([turning, along + jnp.cross(turning, (place - at) / size, axis=0)])
            for turning, along, at in each
        )
        for each in twists
    ]
    screws = jnp.stack(rows, axis=-1) if rows else jnp.zeros((6, q.shape[0], 0))
    return place.T, jnp.moveaxis(screws, 1, 0)


def _cos_sin(angle: Array) -> tuple[Array, Array]:
    return jnp.cos(angle), jnp.sin(angle)


def pulls_of(screws: Float[Array, "poses 6 free"]) -> Float[Array, "poses 6 free"]:
    """S (S^T S)^-1: the wrench of least norm that has a unit load in one coordinate and none in the others."""
    if not screws.shape[2]:
        return screws
    gram = jnp.einsum("pik,pil->pkl", screws, screws)
    tiny = TINY * jnp.finfo(screws.dtype).eps
    return jnp.moveaxis(jnp.linalg.solve(gram + tiny * jnp.eye(gram.shape[-1]), jnp.moveaxis(screws, 1, 2)), 1, 2)


def purified(projectors: Float[Array, "poses 6 6"]) -> Float[Array, "poses 6 6"]:
    """Bring matrices to the projectors that they nearly are: 3 P^2 - 2 P^3 squares the errors of the eigenvalues.

    What `TINY` leaves in the directions of freedoms would be a stiffness beside that of `balance.HOLD`.
    """
    square = projectors @ projectors
    return 3 * square - 2 * square @ projectors
