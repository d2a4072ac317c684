"""Maps over two inputs: where a mechanism can go, where a point of it then is, and how near to singular."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Array, Bool, Float, Int

from jaxkin._arguments import by_name, check_known, check_mechanism, numbers, several
from jaxkin._guesses import Result
from jaxkin._names import listed, nearest
from jaxkin.effects.determined_drive import check_determined, home_of_drive
from jaxkin.effects.grid_flood import Flooded, flood, nodes_around
from jaxkin.effects.pose_plot import save_rows
from jaxkin.effects.workspace_plot import WorkspaceMap, draw_workspace
from jaxkin.geometry.headings import coordinate_with_unit, places_with_unit
from jaxkin.linkage.coordinates import coordinates
from jaxkin.linkage.first_order import Columns
from jaxkin.linkage.joint_motion import part_transforms
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.drive_plan import DrivePlan, plan_drive
from jaxkin.mechanism.joint_limits import beyond_as_assembled, with_limited
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion, as_point
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.solve.range.poses import RangePoses
from jaxkin.solve.range.solve_range import displacements
from jaxkin.solve.status import Status, default_tolerance
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem


@dataclass(frozen=True, eq=False, repr=False)
class Workspace(Result):
    """A map over two inputs; arrays have the first input as their first axis. Prints, draws and saves itself."""

    inputs: Mapping[str, Float[np.ndarray, " values"]]
    """The two inputs by "joint.coordinate", with the values of the grid: radians, lengths."""
    part: str
    point: tuple[float, float, float]
    """The point of the part, where it is in the assembled pose."""
    status: Int[np.ndarray, "first second"]
    """Codes of `Status`: CLOSED where a path over the grid leads from the assembled pose without a singular pose and
    within the limits of joints, LIMITED where a joint is beyond its limits, JUMPED where the loops close but no such
    path was found, UNREACHABLE where no neighbour leads to a closed pose."""
    points: Float[np.ndarray, "first second 3"]
    """Where the point is; NaN where the loops do not close."""
    rates: Float[np.ndarray, "first second 3 2"]
    """Derivatives of the point by the two inputs; NaN where the loops do not close."""
    motion: Motion
    """All poses, the second input fastest."""

    @property
    def reached(self) -> Bool[np.ndarray, "first second"]:
        """Which nodes are CLOSED."""
        return self.status == Status.CLOSED.value

    @cached_property
    def sigma_min(self) -> Float[np.ndarray, "first second"]:
        """How near to singular the loops are, as `motion.sigma_min`; NaN where they do not close."""
        found = np.asarray(self.motion.sigma_min).reshape(self.status.shape)
        return np.where(np.isfinite(self.points[..., 0]), found, np.nan)

    @cached_property
    def condition(self) -> Float[np.ndarray, "first second"]:
        """How evenly the inputs move the point: the smaller singular value of `rates` over the larger one.

        It is 1 where the point moves alike in all directions of the inputs, 0 where it cannot be moved in some; NaN
        where the loops do not close.
        """
        closed = np.all(np.isfinite(self.rates), axis=(2, 3))
        values = np.linalg.svd(np.where(closed[..., None, None], self.rates, 1.0), compute_uv=False)
        return np.where(closed, values[..., 1] / np.maximum(values[..., 0], 1e-300), np.nan)

    def __str__(self) -> str:
        (one, first), (other, second) = self.inputs.items()
        counts = [(status, int((self.status == status.value).sum())) for status in Status]
        said = listed([f"{count} {status.name}" for status, count in counts if count])
        lines = [
            f"Workspace of {self.part} over {len(first)} x {len(second)} poses: {said}",
            f"  {one} from {first[0]:.4g} to {first[-1]:.4g}, {other} from {second[0]:.4g} to {second[-1]:.4g}",
        ]
        if outside := beyond_as_assembled(self.motion.mechanism.all_joints):
            lines.append(
                f"  the assembled pose itself is beyond its limits: {outside}; assemble the mechanism within, as "
                "mechanism.at(motion, index) does, and map it from there"
            )
        elif not self.reached.any():
            lines.append("  the assembled pose leads to no node beside it: give values nearer to 0, where it is")
        if self.reached.any():
            unit = self.motion.mechanism.unit
            for name, values in zip("xyz", self.points[self.reached].T, strict=True):
                lines.append(f"  {name} from {values.min():.6g} to {values.max():.6g} {unit}".rstrip())
            for name, values in (("sigma_min", self.sigma_min), ("condition", self.condition)):
                at = np.unravel_index(np.argmin(np.where(self.reached, values, np.inf)), self.status.shape)
                lines.append(
                    f"  least {name} {values[at]:.2g} at {one} = {first[at[0]]:.4g}, {other} = {second[at[1]]:.4g}"
                )
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the map over the inputs, and the places of the point, into a picture file; returns its path."""
        return draw_workspace(drawn(self), Path(path))

    def save(self, path: str | Path) -> Path:
        """Write inputs, status, point, sigma_min and condition as comma-separated values, a row a pose."""
        first, second = np.meshgrid(*self.inputs.values(), indexing="ij")
        rows = [first, second, self.status, *np.moveaxis(self.points, -1, 0), self.sigma_min, self.condition]
        unit = self.motion.mechanism.unit
        inputs = [coordinate_with_unit(name, unit) for name in self.inputs]
        names = [*inputs, "status", *places_with_unit(unit), "sigma_min", "condition"]
        return save_rows(names, np.array([np.ravel(row) for row in rows], float), Path(path))


def drawn(found: Workspace) -> WorkspaceMap:
    """Collect what is drawn of a workspace."""
    return WorkspaceMap(
        found.inputs,
        found.part,
        found.status,
        found.reached,
        found.sigma_min,
        found.condition,
        found.points,
        found.motion.mechanism.unit,
    )


def workspace(
    mechanism: Mechanism,
    ranges: Mapping[str, Sequence[float] | np.ndarray],
    part: str,
    point: Sequence[float | int] | np.ndarray,
    *,
    hold: Iterable[str] = (),
    options: SolverOptions | None = None,
) -> Workspace:
    """Map a mechanism over a grid of two inputs: which poses it reaches, where a point of a part is, how near singular.

    `ranges` maps two coordinates to rising arrays of displacements from the assembled pose, radians or lengths. The map
    is filled from the nodes around the assembled pose, from neighbour to neighbour, past no singular pose. Nodes are
    CLOSED where a path over the grid leads there, on the branch of the assembled pose and within the limits of joints;
    LIMITED where a path leads there, but a joint is beyond its limits; JUMPED where the loops close, but no path was
    found, or none within the limits; UNREACHABLE where no neighbour leads to a closed pose. A passage narrower than the
    grid is not found. Coordinates in `hold` stay as assembled.

    Raises ValueError for names, ranges and points that make no sense, for a drive that leaves freedoms or that the
    loops cannot follow, for loops that cannot be closed with all of them at 0, and inside `jit`, `vmap` and `grad`.
    """
    check_mechanism(mechanism, "workspaces")
    check_known("workspaces", "jk.workspace", mechanism, ranges, point)
    linkage, options = mechanism.linkage, options_with(options)
    grid = _grid(ranges)
    if part not in mechanism.parts:
        raise ValueError(f"there is no part {part!r}{nearest(part, mechanism.parts)}")
    keys = (*grid, *several(hold, "hold", "coordinates"))
    driven = coordinates(linkage, keys)
    check_determined(mechanism, driven, "a workspace", "jk.workspace({}, ...)", "hold")
    home = home_of_drive(mechanism, driven)
    where = as_point(point)

    first, second = grid.values()
    shape = len(first), len(second)
    plan, nodes = plan_drive(linkage, keys), _nodes(first, second, len(keys) - 2)
    max_residual = float(options.tolerance or default_tolerance(nodes.dtype))
    found = flood(plan.loop_groups, home, options, nodes, shape, max_residual)
    rows, points, rates = _evaluate_nodes(linkage, plan, found, nodes, mechanism.parts.index(part), where)
    inputs = {name: jnp.asarray(row) for name, row in zip(driven, nodes, strict=True)}
    motion = Motion(mechanism, inputs, rows, jnp.asarray(found.status), jnp.asarray(found.residual), options=options)
    status = _within_limits(np.asarray(with_limited(motion).status).reshape(shape), nodes[:2])
    motion = replace(motion, status=jnp.asarray(status.ravel()))
    closed = np.isin(found.status, (Status.CLOSED.value, Status.JUMPED.value))
    return Workspace(
        dict(zip(driven, (first, second), strict=False)),
        part,
        tuple(float(each) for each in where),  # pyright: ignore[reportArgumentType]
        status,
        np.where(closed[:, None], points, np.nan).reshape(*shape, 3),
        np.where(closed[:, None, None], rates, np.nan).reshape(*shape, 3, 2),
        motion,
    )


def _nodes(
    first: Float[np.ndarray, " first"], second: Float[np.ndarray, " second"], held: int
) -> Float[np.ndarray, "driven nodes"]:
    """List the inputs of all nodes of a grid, the second input fastest; then zeros for so many `held` coordinates."""
    nodes = np.stack([np.ravel(each) for each in np.meshgrid(first, second, indexing="ij")])
    nodes = np.concatenate([nodes, np.zeros((held, nodes.shape[1]))])
    return nodes.astype(dtypes.canonicalize_dtype(float))


def _within_limits(
    status: Int[np.ndarray, "first second"], nodes: Float[np.ndarray, "2 nodes"]
) -> Int[np.ndarray, "first second"]:
    """Give nodes that no path within the limits leads to from the assembled pose the status JUMPED.

    Where the assembled pose itself is beyond a limit, there is no node to begin from, and the status stays as it is.
    """
    from scipy.ndimage import label

    closed = status == Status.CLOSED.value
    around = nodes_around(nodes)
    starts = around[closed.ravel()[around]]
    if Status.LIMITED.value not in status or not len(starts):
        return status
    pieces = np.asarray(label(closed)[0])  # pyright: ignore[reportIndexIssue]  # along the edges of the grid, as the map is filled
    return np.where(closed & ~np.isin(pieces, pieces.ravel()[starts]), Status.JUMPED.value, status)


def _grid(ranges: Mapping[str, Sequence[float] | np.ndarray]) -> dict[str, Float[np.ndarray, " values"]]:
    """Check the values of the two inputs."""
    example = "{'A': np.linspace(-1, 1, 41), 'B': np.linspace(-1, 1, 41)}"
    found = {}
    for key, values in by_name(ranges, "ranges", example).items():
        found[key] = row = numbers(values, f"the values of {key!r}")
        if row.ndim != 1 or len(row) < 2 or not np.isfinite(row).all() or np.any(np.diff(row) <= 0):
            raise ValueError(f"the values of {key!r} must be two finite numbers or more, rising, got {values!r}")
    if len(found) != 2:
        raise ValueError(f"a workspace has two inputs, as in {example}, got {len(found)}")
    return found


EvaluatedPoses = tuple[tuple[Float[Array, "poses _"], ...], Float[Array, "poses 3"], Float[Array, "poses 3 2"]]
"""Displacements of all joints, where a point is, and its derivatives by the first two inputs."""


def _evaluate_nodes(
    linkage: Linkage, plan: DrivePlan, found: Flooded, nodes: Float[np.ndarray, "driven nodes"], part: int, point: Array
) -> EvaluatedPoses:
    """Compute displacements, points and their derivatives from the states of the nodes, by one program.

    `part` is the number of the part that the point, given in the assembled pose, belongs to.
    """
    layout = _Layout(
        plan.freedoms,
        tuple(plan.driven.values()),
        tuple(loop_group.system for loop_group in plan.loop_groups),
        tuple(loop_group.columns for loop_group in plan.loop_groups),
        tuple(loop_group.inputs for loop_group in plan.loop_groups),
        part,
    )
    poses = tuple(RangePoses(state, jnp.asarray(found.status), jnp.asarray(found.residual)) for state in found.states)
    joints = tuple(loop_group.joints for loop_group in plan.loop_groups)
    return _evaluate(layout, linkage, joints, jnp.asarray(nodes), poses, point)


class _Layout(NamedTuple):
    """What goes where in a pose (static)."""

    freedoms: tuple[int, ...]
    driven: Columns
    systems: tuple[LoopSystem, ...]
    columns: tuple[Columns, ...]
    inputs: tuple[tuple[int, ...], ...]
    part: int


@partial(whole_program, static=(0,))
def _evaluate(
    layout: _Layout,
    linkage: Linkage,
    joints: tuple[Joints, ...],
    inputs: Float[Array, "driven poses"],
    poses: tuple[RangePoses, ...],
    point: Float[Array, "3"],
) -> EvaluatedPoses:
    """Compute the displacements of all joints, where a point is, and its derivatives by the first two inputs."""

    def placed(inputs: Float[Array, "driven poses"]):
        rows = [jnp.zeros((inputs.shape[1], count), inputs.dtype) for count in layout.freedoms]
        for (joint, k), row in zip(layout.driven, inputs, strict=True):
            rows[joint] = rows[joint].at[:, k].set(row)
        for system, columns, own, group, found in zip(
            layout.systems, layout.columns, layout.inputs, joints, poses, strict=True
        ):
            x = displacements(system, group, inputs[np.array(own, int)], found)
            for (joint, k), row in zip(columns, x, strict=True):
                rows[joint] = rows[joint].at[:, k].set(row)
        place = part_transforms(linkage, tuple(rows))[layout.part]
        return jnp.einsum("pij,j->pi", place[:, :3, :3], point) + place[:, :3, 3], tuple(rows)

    points, rows = placed(inputs)
    rates = []
    for number in range(2):
        unit = jnp.zeros_like(inputs).at[number].set(1.0)
        rates.append(jax.jvp(lambda u: placed(u)[0], (inputs,), (unit,))[1])
    return rows, points, jnp.stack(rates, axis=-1)
