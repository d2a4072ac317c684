"""Where a map over two inputs ends at singular poses: points of its singularity curves, to rounding."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._guesses import Result
from jaxkin.effects.limit_search import CoordinateRange, LimitKind, find_limit, why_locked
from jaxkin.effects.mode_search import PoseFeatures
from jaxkin.effects.motion_curve import MotionCurve
from jaxkin.effects.pose_plot import save_rows
from jaxkin.effects.workspace import Workspace, drawn
from jaxkin.effects.workspace_plot import draw_workspace
from jaxkin.geometry.headings import coordinate_with_unit, places_with_unit
from jaxkin.geometry.pose import apply
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.placed_at import part_places
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.solve.status import Status


@dataclass(frozen=True, eq=False, repr=False)
class Singularities(Result):
    """Points on the singularity curves that bound a workspace. Prints, draws and saves itself."""

    workspace: Workspace
    values: Float[np.ndarray, "found 2"]
    """The two inputs: radians, lengths."""
    points: Float[np.ndarray, "found 3"]
    """Where the point of the workspace is."""
    reasons: tuple[str, ...]
    """How the mechanism locks at each, in words."""
    passed: int
    """How many edges of the map no lock was found on: the branch is lost or only nearly singular there."""

    def __str__(self) -> str:
        one, other = self.workspace.inputs
        lines = [f"{len(self.values)} points of singularity curves over {one} and {other}"]
        lines += [f"  {count} where {reason}" for reason, count in Counter(self.reasons).most_common()]
        if self.passed:
            lines.append(f"  no lock on {self.passed} other edges of the map")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the points over the workspace into a picture file; returns its path."""
        return draw_workspace(drawn(self.workspace), Path(path), self.values, self.points)

    def save(self, path: str | Path) -> Path:
        """Write inputs and places as comma-separated values, a row a point; returns the path."""
        rows = np.concatenate([self.values, self.points], axis=1)
        unit = self.workspace.motion.mechanism.unit
        names = [coordinate_with_unit(name, unit) for name in self.workspace.inputs]
        return save_rows([*names, *places_with_unit(unit)], rows.T, Path(path))


def singularities(workspace: Workspace) -> Singularities:
    """Find points of the singularity curves that bound a workspace, one on each edge of its grid that they cut.

    From each CLOSED node beside one to which the loops do not lead, one input is moved on, the other at rest, until the
    mechanism locks (as in `jk.limits`): there the loops can move while both inputs rest. A point is right to rounding,
    some 1e-13 radians, or lengths over the size. Singular poses within the workspace, at which two branches meet
    without an end, are not looked for: `sigma_min` of the workspace shows them.

    Raises ValueError for what is no `Workspace`, and where the two inputs do not move the same loops.
    """
    if not isinstance(workspace, Workspace):
        raise ValueError(f"singularities are those of a workspace, jk.workspace(...), got {type(workspace).__name__}")
    motion, mechanism = workspace.motion, workspace.motion.mechanism
    linkage = mechanism.linkage
    places = [coordinate(linkage, name) for name in motion.inputs]
    groups = [number for number, group in enumerate(linkage.structure.loop_groups) if places[0][0] in group.joints]
    if not groups or places[1][0] not in linkage.structure.loop_groups[groups[0]].joints:
        raise ValueError("the two inputs move no loop together: the limits of each are those of jk.limits")
    group = linkage.structure.loop_groups[groups[0]]
    loops = closed_loops(linkage, group)
    columns = [loops.columns.index(place) for place in places if place in loops.columns]
    idle = len(loop_freedoms(linkage)[groups[0]].motions) - len(columns)
    joints = {index: linkage.joints[index] for index in group.joints}
    rows = np.concatenate([np.asarray(each, float) for each in motion.displacements], axis=1)
    first = np.cumsum([0, *(joint.freedoms for joint in linkage.joints)])
    every = rows[:, [first[joint] + k for joint, k in loops.columns]] / loops.units

    values, points, reasons, edges = [], [], [], list(_edges(workspace))
    for edge in edges:
        drive, q = columns[edge.axis], every[edge.node]
        curve = MotionCurve(loops, drive, [column for column in columns if column != drive], idle)
        begun = curve.begin(edge.direction, q)
        if begun is None:
            continue
        end = edge.end / loops.units[drive]
        bound = CoordinateRange(drive, min(end, q[drive]), max(end, q[drive]))
        found = find_limit(curve, begun, edge.direction, [bound], False, PoseFeatures(loops, idle))
        if found.kind is not LimitKind.LOCKS:
            continue
        at = found.here.q * loops.units
        given = np.split(rows[edge.node].copy(), first[1:-1])
        for (joint, k), value in zip(loops.columns, at, strict=True):
            given[joint][k] = value
        values.append(at[columns[:2]])
        points.append(apply(part_places(linkage, given)[workspace.part], np.array(workspace.point)))
        reasons.append(why_locked(joints, curve, found.here)[1].replace("while it is", "while the inputs are"))
    return Singularities(
        workspace,
        np.array(values).reshape(-1, 2),
        np.array(points).reshape(-1, 3),
        tuple(reasons),
        len(edges) - len(values),
    )


class _Edge(NamedTuple):
    """A line of the grid from a CLOSED node to a neighbour that is neither CLOSED nor LIMITED."""

    node: int
    axis: int
    """Which of the two inputs changes."""
    direction: float
    end: float
    """Its value at the neighbour."""


def _edges(workspace: Workspace) -> Iterator[_Edge]:
    """List the lines of the grid along which a singularity is looked for."""
    reached, grids = workspace.reached, list(workspace.inputs.values())
    followed = reached | (workspace.status == Status.LIMITED.value)  # where joints end, the loops go on
    for axis, grid in enumerate(grids):
        for step in (1, -1):
            for place in np.argwhere(reached):
                other = place.copy()
                other[axis] += step
                if 0 <= other[axis] < len(grid) and not followed[tuple(other)]:
                    node = int(np.ravel_multi_index(tuple(place), reached.shape))
                    yield _Edge(node, axis, float(step), float(grid[other[axis]]))
