"""Assembly modes that a path over two inputs connects without a singular pose between them.

A mechanism may have several closed poses for the same inputs on one sheet: a path around a cusp of its singularity
curves leads from one to another (Innocenti and Parenti-Castelli, 1998, for planar platforms). Poses are therefore
spread from node to node of a grid as in `grid_flood`, but as many a node as steps lead to, all within the limits of
joints. Poses that steps connect are one region, a part of what the literature of parallel robots calls an aspect.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jax import dtypes
from jaxtyping import Float, Int

from jaxkin._arguments import by_name
from jaxkin._guesses import Result
from jaxkin._names import counted, listed, nearest
from jaxkin.effects.assembly_modes import AssemblyModes
from jaxkin.effects.grid_steps import GridSteps
from jaxkin.effects.mode_limits import WithinLimits
from jaxkin.effects.pose_plot import save_rows
from jaxkin.effects.region_plot import draw_regions
from jaxkin.effects.sheets import Sheets
from jaxkin.geometry.headings import coordinate_with_unit
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.solve.options import options_with
from jaxkin.solve.status import default_tolerance

SAME_VALUE = 1e-9
"""Distance of a value of the grid from that of the modes, over the range, at which it is replaced: rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class ModeRegions(Result):
    """Which assembly modes a path over two inputs connects. Prints, draws and saves itself."""

    modes: AssemblyModes
    inputs: Mapping[str, Float[np.ndarray, " values"]]
    """The two inputs by "joint.coordinate", with the values of the grid, those of the modes among them."""
    regions: tuple[tuple[int, ...], ...]
    """The modes of each region, numbered from 0 as in `modes`."""
    poses: Int[np.ndarray, "regions first second"]
    """How many poses of each region each node of the grid has."""
    sheets: Sheets
    """All poses that were found, and the steps between them."""

    def connected(self, one: int, other: int) -> bool:
        """Tell whether a path over the grid leads from one mode to another one past no singular pose, within limits."""
        return self._region(one) == self._region(other)

    def path(self, one: int, other: int) -> dict[str, Float[np.ndarray, " nodes"]]:
        """Give the inputs of a shortest path over the grid from one mode to another, by "joint.coordinate".

        They count as those of the modes do, from the assembled pose; those of `modes[one].mechanism()` count from its
        own. Raises ValueError for modes that are not connected.
        """
        if not self.connected(one, other):
            raise ValueError(
                f"no path over this grid connects {self.modes.names[one]} and {self.modes.names[other]} without a "
                f"singular pose{self._limits}: .regions are {self.regions}"
            )
        nodes = self.sheets.path(one % len(self.modes), other % len(self.modes))
        given = self.sheets.inputs[:, nodes]
        return dict(zip(self.modes.inputs, given, strict=True))

    def __str__(self) -> str:
        (one, first), (other, second) = self.inputs.items()
        count = len(self.regions)
        lines = [
            f"{counted(len(self.modes), 'assembly mode')} in {count} "
            f"region{'' if count == 1 else 's'} over {len(first)} x {len(second)} values of {one} and {other}"
        ]
        for modes, poses in zip(self.regions, self.poses, strict=True):
            names = listed([self.modes.names[k] for k in modes])
            beyond = any(far[list(modes)].any() for far in self.modes.beyond_limits.values())
            said = "beyond the limits of joints" if beyond else "not connected with another mode"
            if len(modes) > 1:
                said = f"connected without a singular pose{self._limits}"
            most = f", up to {poses.max()} for the same inputs" if poses.max() > 1 else ""
            lines.append(f"  {names}: {said}; {counted(poses.sum(), 'pose')}{most}")
        if count > 1:
            lines.append("  a passage narrower than the grid, or beyond it, is not found")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw for each region how many poses it has at each node, into a picture file; returns its path."""
        one, other = (float(self.modes.inputs[name]) for name in self.inputs)
        titles = [f"mode{'' if len(modes) == 1 else 's'} {', '.join(self._numbers(modes))}" for modes in self.regions]
        unit = self.modes.motion.mechanism.unit
        return draw_regions(self.inputs, self.poses, titles, (one, other), unit, Path(path))

    def save(self, path: str | Path) -> Path:
        """Write both inputs and the number of poses of each region as comma-separated values, a row a node."""
        grid = np.meshgrid(*self.inputs.values(), indexing="ij")
        names = ["+".join(self._numbers(modes)) for modes in self.regions]
        rows = np.array([np.ravel(each) for each in (*grid, *self.poses)], float)
        inputs = [coordinate_with_unit(name, self.modes.motion.mechanism.unit) for name in self.inputs]
        return save_rows([*inputs, *(f"poses of modes {name}" for name in names)], rows, Path(path))

    @property
    def _limits(self) -> str:
        """What a path keeps to besides, in words: nothing where no joint has limits."""
        return " and within the limits of joints" if self.sheets.within.any else ""

    def _numbers(self, modes: Sequence[int]) -> list[str]:
        return [self.modes.names[k].removeprefix("mode ") for k in modes]

    def _region(self, mode: int) -> int:
        """Find the region of a mode, which may be counted from the last one; IndexError where there is none such."""
        if not -len(self.modes) <= mode < len(self.modes):
            raise IndexError(f"there are {len(self.modes)} modes, numbered from 0, got {mode}")
        mode %= len(self.modes)
        return next(k for k, modes in enumerate(self.regions) if mode in modes)


def mode_regions(modes: AssemblyModes, ranges: Mapping[str, Sequence[float] | np.ndarray]) -> ModeRegions:
    """Find the assembly modes that a path over two inputs connects without a singular pose between them.

    `modes` are those of `jk.assembly_modes`. `ranges` maps two of their inputs to rising arrays of displacements from
    the assembled pose, radians or lengths; the inputs of the modes are added to them, and the other inputs rest. From
    each mode all poses to which steps lead past no singular pose are found, as many at a node as there are, and within
    the limits of joints at each node: a mode beyond these is connected with none. Modes that are said to be connected
    are: `path` gives the inputs of a path. Others may be by a passage that is narrower than the grid, beyond it, or by
    other inputs.

    Raises ValueError for names and ranges that make no sense, for a singular mode, for loops with idle freedoms, which
    make a continuum of one pose, and where a node has more poses than a mechanism has.
    """
    if not isinstance(modes, AssemblyModes):
        raise ValueError(
            f"regions are those of modes, jk.assembly_modes(mechanism, inputs), got {type(modes).__name__}"
        )
    if not len(modes):
        raise ValueError("there are no modes: the loops do not close for these inputs")
    mechanism = modes.motion.mechanism
    grid = _grid(modes, ranges)
    loop_groups = plan_drive(mechanism.linkage.in_space, tuple(modes.inputs)).loop_groups
    _check_idle(mechanism, loop_groups)
    first, second = grid.values()
    every = dict(zip(grid, map(np.ravel, np.meshgrid(first, second, indexing="ij")), strict=True))
    rest = np.ones(len(first) * len(second))
    nodes = np.array([every[name] if name in grid else value * rest for name, value in modes.inputs.items()])
    nodes = nodes.astype(dtypes.canonicalize_dtype(float))
    options = options_with(modes.motion.options)
    max_residual = float(options.tolerance or default_tolerance(nodes.dtype))
    steps = GridSteps(loop_groups, options, max_residual)
    home = [int(np.searchsorted(values, modes.inputs[name])) for name, values in grid.items()]
    shape = len(first), len(second)
    sheets = Sheets(steps, nodes, shape, WithinLimits(mechanism, loop_groups, nodes, tuple(modes.inputs)))
    sheets.begin(int(np.ravel_multi_index(home, shape)), modes.motion)
    sheets.spread()
    regions, poses = sheets.regions(len(modes))
    return ModeRegions(modes, grid, regions, poses, sheets)


def _grid(modes: AssemblyModes, ranges: Mapping[str, Sequence[float] | np.ndarray]) -> dict[str, np.ndarray]:
    """Check the values of the two inputs, and add those of the modes."""
    linkage = modes.motion.mechanism.linkage
    given = by_name(ranges, "ranges", "{'A': np.linspace(-1, 1, 41), 'B': np.linspace(-1, 1, 41)}")
    names = list(coordinates(linkage, tuple(given)))
    if len(names) != 2:
        raise ValueError(f"regions are mapped over two inputs, got {len(names)}")
    found = {}
    for name, (key, values) in zip(names, given.items(), strict=True):
        if name not in modes.inputs:
            raise ValueError(f"{key!r} is no input of the modes{nearest(name, modes.inputs)}")
        try:
            row = np.asarray(values, float)
        except (TypeError, ValueError):
            raise ValueError(f"the values of {key!r} must be numbers, got {values!r}") from None
        if row.ndim != 1 or len(row) < 2 or not np.isfinite(row).all() or np.any(np.diff(row) <= 0):
            raise ValueError(f"the values of {key!r} must be two finite numbers or more, rising, got {values!r}")
        if not row[0] <= modes.inputs[name] <= row[-1]:
            raise ValueError(
                f"the values of {key!r}, {row[0]:g} to {row[-1]:g}, must hold that of the modes, {modes.inputs[name]:g}"
            )
        apart = np.abs(row - modes.inputs[name]) > SAME_VALUE * np.ptp(row)
        found[name] = np.sort([*row[apart], modes.inputs[name]])
    return found


def _check_idle(mechanism: Mechanism, loop_groups: Sequence) -> None:
    """Raise ValueError for loops with freedoms that no input drives."""
    groups = mechanism.linkage.structure.loop_groups
    freedoms = loop_freedoms(mechanism.linkage)
    for loop_group in loop_groups:
        idle = len(freedoms[groups.index(loop_group.members)].motions) - len(loop_group.inputs)
        if idle:
            raise ValueError(
                f"the loops have {counted(idle, 'idle freedom')}, such as the spin of a rod between two "
                "balls, so that one mode is many poses: make one ball of each such rod a universal joint"
            )
