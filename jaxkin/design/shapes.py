"""Shapes of parts for clearances: round bars that follow the lengths of a design, and solids as they are drawn.

A part whose lengths change has no solid that follows them: it is given as bars between its joints.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._arguments import text, yes_or_no
from jaxkin._names import nearest
from jaxkin.design import given
from jaxkin.design.measures import STATIC, part_point
from jaxkin.design.objective import Extras
from jaxkin.dimensions.frames import locate
from jaxkin.geometry.mesh_elements import Mesh, Points
from jaxkin.geometry.sample_points import core_points
from jaxkin.geometry.triangles import Triangles
from jaxkin.geometry.weld import weld
from jaxkin.mechanism.mechanism import Mechanism

if TYPE_CHECKING:
    import trimesh

MAX_TRIANGLES = 4000
"""Triangles of a solid up to which clearances to it are computed: each edge and face of the one shape is compared with
each of the other, in each pose of each design."""
_ROUNDING = 1e-7
"""Share of the size of a solid within which corners are one: meshes hold them in float32."""
_AXIS = np.linspace(0.0, 1.0, 5)
"""Where on the axis of a bar the points are that tell how deep it is in a solid. More would only find more bars that go
through walls thinner than that, and cost as much again each."""


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _NamedEnd:
    """An end of a bar by the name of a joint of its part, or of an extra variable."""

    name: str = field(metadata=STATIC)


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Bar:
    """A round bar of a part, with round ends: all that is at most `radius` from its axis."""

    part: str = field(metadata=STATIC)
    ends: tuple[Any, Any]
    """Points of the part in its assembled pose (3,), or names."""
    radius: Any

    def mesh(self, mechanism: Mechanism, extras: Extras) -> Mesh:
        """Make the axis, in world coordinates of the assembled pose."""
        corners = jnp.stack([self._place(end, mechanism, extras) for end in self.ends])
        weights = np.stack([1 - _AXIS, _AXIS, 0 * _AXIS], axis=-1)
        samples = Points(np.broadcast_to([0, 1, 1], weights.shape), weights)
        return Mesh(corners, np.array([[0, 1]]), np.zeros((0, 3), int), samples)

    def joints(self, mechanism: Mechanism) -> set[str]:
        """Name the joints at its ends."""
        return {end.name for end in self.ends if isinstance(end, _NamedEnd)} & set(mechanism.joints)

    def _place(self, end: Any, mechanism: Mechanism, extras: Extras) -> Float[Array, "3"]:
        """Find where an end is in the assembled pose."""
        if not isinstance(end, _NamedEnd):
            return jnp.asarray(end, float)
        if end.name in mechanism.joints:
            column, side = locate(mechanism.linkage, (self.part, end.name))
            joint = mechanism.all_joints[column]
            return jnp.asarray((joint.frames_1[0] if side == "frames_1" else joint.frames_2[-1])[:3, 3])
        if end.name not in extras:
            joints = [joint.name for joint in mechanism.all_joints if self.part in joint.parts]
            raise ValueError(
                f"bar: {self.part!r} has no joint {end.name!r}{nearest(end.name, joints)}, nor is it an extra variable"
            )
        return given.extra_point(extras, end.name, f"bar of {self.part!r}")


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Solid:
    """The solid of a part, in world coordinates of the assembled pose."""

    part: str = field(metadata=STATIC)
    corners: Float[Array | np.ndarray, "corners 3"]
    edges: Int[Array | np.ndarray, "edges 2"]
    faces: Int[Array | np.ndarray, "faces 3"]

    radius = 0.0

    def mesh(self, mechanism: Mechanism, extras: Extras) -> Mesh:
        """Make the mesh; all of its corners, and points inside, tell how deep it is in another shape."""
        index = jnp.broadcast_to(jnp.arange(len(self.corners))[:, None], (len(self.corners), 3))
        samples = Points(index, jnp.broadcast_to(jnp.array([1.0, 0.0, 0.0]), index.shape))
        return Mesh(self.corners, self.edges, self.faces, samples)

    def joints(self, mechanism: Mechanism) -> set[str]:
        """Name the joints that it ends at: none, as nothing says where its faces are."""
        return set()


Shape = Bar | Solid


def bar(part: str, start: Any, end: Any, radius: float | int = 0.0) -> Shape:
    """Make a round bar of a part with round ends, for `clearance` and `apart`; a ball where both ends are the same.

    `start` and `end` are joints of the part, by name, points of it in the assembled pose, (x, y, z) or (x, y), or names
    of extra variables. A bar between joints follows the lengths of a design.
    """
    text(part, "bar: part")
    ends = []
    for name, each in (("start", start), ("end", end)):
        is_name = isinstance(each, str)
        ends.append(_NamedEnd(text(each, f"bar: {name}")) if is_name else part_point(part, each, f"bar: {name}").given)
    return Bar(part, (ends[0], ends[1]), given.number(radius, "bar: radius", 0.0))


def solid(part: str, of: Mechanism | trimesh.Trimesh, *, hull: bool = False) -> Shape:
    """Take a solid of a part, for `clearance` and `apart`: that of a mechanism from files, or a mesh, as of an obstacle
    that stands on the part, in world coordinates of the assembled pose.

    With `hull` its convex hull is taken: less to compute, and on the safe side. The solid is carried along by the part,
    and does not change with the lengths of a design: give parts whose lengths change as bars.

    Raises ValueError for a part without a solid, for more than 4,000 triangles, and for a mesh that is not closed.
    """
    triangles = _triangles(text(part, "solid: part"), of)
    if yes_or_no(hull, "solid: hull"):
        from trimesh.convex import convex_hull

        triangles = np.asarray(convex_hull(triangles.reshape(-1, 3)).triangles, float)
    if len(triangles) > MAX_TRIANGLES:
        raise ValueError(
            f"solid: {part!r} has {len(triangles):,} triangles, up to {MAX_TRIANGLES:,} are compared: write hull=True "
            "for its convex hull, or give a simpler mesh that contains it, or bars"
        )
    size = float(np.ptp(triangles, axis=(0, 1)).max())
    welded = weld(triangles, _ROUNDING * size)
    if len(welded.open_edges) or not len(welded.triangles):
        raise ValueError(
            f"solid: the triangles of {part!r} do not enclose a volume ({len(welded.open_edges)} open edges): mend the "
            "mesh, or write hull=True for its convex hull"
        )
    ends = np.concatenate([welded.triangles[:, [0, 1]], welded.triangles[:, [1, 2]], welded.triangles[:, [2, 0]]])
    found = welded.points[welded.triangles]
    cores = core_points(found, np.arange(len(found)))
    return Solid(
        part, np.concatenate([welded.points, cores]), np.unique(np.sort(ends, axis=1), axis=0), welded.triangles
    )


def _triangles(part: str, of: Mechanism | trimesh.Trimesh) -> Triangles:
    """Find the triangles of the solid of a part."""
    if not isinstance(of, Mechanism):
        triangles = np.asarray(getattr(of, "triangles", ()), float)
        if triangles.ndim != 3 or triangles.shape[1:] != (3, 3) or not np.all(np.isfinite(triangles)):
            raise ValueError(
                f"solid: give the mechanism that the solid of {part!r} is in, or a trimesh.Trimesh, got "
                f"{type(of).__name__}"
            )
        return triangles
    drawn = {each.name: each for each in of.solids if each.is_solid}
    if part not in drawn:
        why = nearest(part, drawn) if drawn else ": solids are those of files, jk.load(files).mechanism(fixed=...)"
        raise ValueError(f"solid: the mechanism has no solid of {part!r}{why}")
    return np.asarray(drawn[part].triangles, float)
