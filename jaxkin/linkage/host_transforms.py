"""Compute displacements of parts on the host (numpy, float64): nothing is compiled, for whatever number of poses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.joints.joint import Joint
from jaxkin.joints.screws import displacements, inverses, products
from jaxkin.topology.structure import Structure


def host_transforms(
    structure: Structure, joints: Sequence[Joint], columns: Sequence[Float[np.ndarray, "poses _"]]
) -> Iterator[Float[np.ndarray, "poses 4 4"]]:
    """Compute the displacements of all parts from the assembled pose, in the world, in the order of
    `structure.part_names`: P_child = P_parent J along the tree, as `joint_motion.transforms` does.

    `columns` are the coordinates of each joint: radians, and lengths in the unit of the mechanism. Where a joint up to
    a part has no finite coordinates, the displacement of the part is NaN.
    """
    poses = len(columns[0])
    found: dict[str, Float[np.ndarray, "3 4 poses"]] = {}
    known: dict[str, Bool[np.ndarray, " poses"]] = {}
    for part, parent, number, sign in structure.tree:
        joint, q = joints[number], np.asarray(columns[number], float)
        finite = np.all(np.isfinite(q), axis=1, keepdims=True)
        moved = displacements(joint, np.where(finite, q, 0.0))
        moved = moved if sign > 0 else inverses(moved)
        found[part] = products(found[parent], moved) if parent in found else moved
        known[part] = finite[:, 0] & known[parent] if parent in known else finite[:, 0]
    for part in structure.part_names:
        place = np.tile(np.eye(4), (poses, 1, 1))
        if part in found:
            place[:, :3] = np.where(known[part], found[part], np.nan).transpose(2, 0, 1)
        yield place
