"""Describe the bodies of a loop group and the twists that joints allow between them, at one pose (host code).

Parts that are welded to each other are one body. Joints outside of the loop group count too: they connect its bodies
to others. Twists are (w; v) in world coordinates about the centroid, lengths over the characteristic length.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import inverse
from jaxkin.joints.screws import complement, moved
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.loop_freedoms import LoopFreedoms
from jaxkin.mobility.twists import constraints
from jaxkin.topology.components import connected

Twists = Float[np.ndarray, "6 twists"]
Constraints = Float[np.ndarray, "constraints 6"]
"""Rows that vanish on the twists that are allowed."""


class BodyGraph:
    """The bodies of a loop group, each named by its first row of parts, at the pose of `found.screws`.

    Parts in `left_out`, such as those that only spin, hold no other part and are held by none.
    """

    def __init__(self, linkage: Linkage, found: LoopFreedoms, left_out: Collection[str] = ()) -> None:
        self._found = found
        structure, joints = linkage.structure, linkage.joints
        ends = [tuple(structure.row_of[part] for part in joint.parts) for joint in joints]
        rigid = [pair for joint, pair in zip(joints, ends, strict=True) if not joint.freedoms]
        groups = [sorted(rows, key=structure.parts.index) for rows in connected(structure.parts, rigid)]
        self.parts_of = {rows[0]: rows for rows in groups}
        """For each body its rows of parts."""
        body_of = {row: rows[0] for rows in groups for row in rows}
        pairs = [(body_of[one], body_of[other]) for one, other in ends]
        self.joints: dict[tuple[str, str], list[int]] = {}
        """(body, other body), in either order -> numbers of the joints of the loop group between them."""
        self._hanging: dict[str, list[int]] = {}
        for index, (one, other) in enumerate(pairs):
            if one == other:
                continue
            if index in found.ends:
                self.joints.setdefault((one, other), []).append(index)
                self.joints.setdefault((other, one), []).append(index)
            elif not {one, other} & set(left_out):
                self._hanging.setdefault(one, []).append(index)
                self._hanging.setdefault(other, []).append(index)
        self.neighbours: dict[str, list[str]] = {}
        """For each body of the loop group the bodies that it is joined to, without those left out."""
        for body, other in self.joints:
            self.neighbours.setdefault(body, []).extend([] if other in left_out else [other])
        self._all_joints, self._second = joints, {index: pair[1] for index, pair in enumerate(pairs)}
        outside = [pair for index, pair in enumerate(pairs) if index not in found.ends]
        ground = body_of[found.fixed]
        with_ground = next(bodies for bodies in connected(self.parts_of, outside) if ground in bodies)
        self.carrier = next(body for body in self.neighbours if body in with_ground)
        """The body through which the loop group is connected to the fixed parts, or that of the fixed parts."""
        self.movable = [body for body in self.neighbours if body != self.carrier and body not in left_out]
        """The bodies of the loop group without the carrier and those left out."""

    def is_link(self, body: str) -> bool:
        """Tell whether a body is movable, joined to two others, and to nothing outside the loop group."""
        return self.is_in_row(body) and body not in self._hanging

    def is_in_row(self, body: str) -> bool:
        """Tell whether a body is movable and joined to two others within the loop group."""
        return body in self.movable and len(self.neighbours[body]) == 2

    def beyond(self, link: str, before: str) -> str:
        """Return the second of the two neighbours of a body in a row, the one that is not `before`."""
        return next(other for other in self.neighbours[link] if other != before)

    def forbidden(self, body: str, other: str) -> Constraints:
        """Compute the constraints of all joints between two bodies on the twist of one relative to the other."""
        return np.concatenate([complement(self._screws(joint)) for joint in self.joints[body, other]])

    def allowed(self, body: str, other: str) -> Twists:
        """Compute an orthonormal basis of the twists that all joints between two bodies allow."""
        return self.free_of(self.forbidden(body, other))

    def held_outside(self, body: str) -> Constraints:
        """Compute the constraints on the twist of a body by joints to bodies outside the loop group, which rest."""
        places = self._found.places
        back = moved(inverse(next(places[row] for row in self.parts_of[body] if row in places)), np.eye(6))
        rows = [
            constraints(self._all_joints[index], self._found.centre, self._found.length) @ back
            for index in self._hanging.get(body, [])
        ]
        return np.concatenate([np.zeros((0, 6)), *rows])

    def relative(self, body: str, other: str, motions: Float[np.ndarray, "motions columns"]) -> Twists:
        """Compute a basis of the twists between two bodies joined to each other, in motions of the loop group."""
        joint = self.joints[body, other][0]
        basis, sizes, _ = np.linalg.svd(self._screws(joint) @ motions[:, self._columns(joint)].T)
        return basis[:, : int((sizes > self._found.thresholds.rate).sum())]

    def rates(self, body: str, other: str, twist: Float[np.ndarray, "6"]) -> Float[np.ndarray, " columns"]:
        """Compute the rates of the joints between two bodies at which `body` has this twist relative to `other`."""
        found = np.zeros(len(self._found.columns))
        for joint in self.joints[body, other]:
            sign = 1 if self._second[joint] == body else -1
            found[self._columns(joint)] = sign * np.linalg.pinv(self._screws(joint), rcond=1e-9) @ twist
        return found

    def free_of(self, rows: Constraints) -> Twists:
        """Compute an orthonormal basis of the twists that these constraints allow."""
        _, sizes, directions = np.linalg.svd(np.concatenate([rows, np.zeros((6, 6))]), full_matrices=False)
        return directions[int((sizes > self._found.thresholds.rate).sum()) :].T

    def _screws(self, joint: int) -> Twists:
        return self._found.screws[:, self._columns(joint)]

    def _columns(self, joint: int) -> list[int]:
        return [column for column, (owner, _) in enumerate(self._found.columns) if owner == joint]
