"""What of a sweep depends on which coordinates are driven, and not on how far: found once for a mechanism and a drive.

A sweep of some hundred poses takes a few milliseconds: to find this anew each time would be a large part of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import numpy as np
from jax import dtypes

from jaxkin._memory import once_for_each
from jaxkin._traced import traced
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import coordinates
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.infeasible_drive import InfeasibleDrive, infeasible_drive
from jaxkin.solve.range.solve_range import Joints
from jaxkin.solve.system.from_linkage import Columns, block_joints, block_system
from jaxkin.solve.system.loop_system import Form, LoopSystem


class Given(NamedTuple):
    """The loops of joints that close at the assembled pose only."""

    system: LoopSystem
    columns: Columns
    joints: Joints


class Element(NamedTuple):
    """A structure element that is to be solved."""

    system: LoopSystem
    columns: Columns
    inputs: tuple[int, ...]
    """Which of the inputs it has, in the order of `system.driven`; none where it is only to be closed."""
    joints: Joints
    given: Given | None
    """What the poses are brought to the least residual of, where the loops solved are those of `linkage.ideal`."""


class Prepared(NamedTuple):
    """A drive of a mechanism, as yet without displacements."""

    driven: dict[str, tuple[int, int]]
    """(joint, coordinate) by full names, in the order given."""
    freedoms: tuple[int, ...]
    """Of every joint."""
    elements: tuple[Element, ...]
    infeasible: InfeasibleDrive | None
    """Why the loops cannot follow it."""


def prepare(linkage: Linkage, keys: tuple[str, ...]) -> Prepared:
    """The coordinates of these names, and the structure elements they move; ValueError as in `resolve`.

    Kept as long as the linkage lives, unless its numbers, or what JAX makes of them here, are traced.
    """
    if traced(linkage):
        return _prepared(linkage, keys)
    kept = _kept(linkage)
    key = keys, dtypes.canonicalize_dtype(float), getattr(jax.config, "jax_default_device", None)
    if key in kept:
        return kept[key]
    prepared = _prepared(linkage, keys)
    on_device = jax.device_put([element.joints for element in prepared.elements])
    if traced(on_device):
        return prepared
    elements = tuple(
        element._replace(joints=joints) for element, joints in zip(prepared.elements, on_device, strict=True)
    )
    kept[key] = prepared._replace(elements=elements)
    return kept[key]


@once_for_each
def _kept(linkage: Linkage) -> dict[Any, Prepared]:
    """What was found out about drives of a linkage, by the names that they give."""
    del linkage
    return {}


def _prepared(linkage: Linkage, keys: Sequence[str]) -> Prepared:
    driven = coordinates(linkage, keys)
    places = list(driven.values())
    elements = []
    for block, form in zip(linkage.structure.blocks, linkage.classes, strict=True):
        inside = sorted(
            (block.joints.index(joint), k, i) for i, (joint, k) in enumerate(places) if joint in block.joints
        )
        if not inside and not _edited([linkage.solved_joints[joint] for joint in block.joints]):
            continue
        inputs = tuple(i for _, _, i in inside)
        system, columns = block_system(linkage, block, tuple(places[i] for i in inputs), form)
        given = None
        if linkage.ideal:
            whole = block_system(linkage, block, tuple(places[i] for i in inputs), Form())
            given = Given(*whole, block_joints(linkage.joints, block))
        elements.append(Element(system, columns, inputs, block_joints(linkage.solved_joints, block), given))
    freedoms = tuple(joint.freedoms for joint in linkage.joints)
    judged = not traced(linkage) and all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(linkage))
    return Prepared(driven, freedoms, tuple(elements), infeasible_drive(linkage, places) if judged else None)


def _edited(joints: list[Joint]) -> bool:
    """Whether the loops may be open at the assembled pose: after a change of lengths, or where numbers are traced."""
    return traced(joints) or any(not np.array_equal(joint.before, joint.after) for joint in joints)
