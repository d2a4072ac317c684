"""The space that a part takes up along a motion, as a closed mesh (host code).

The signed distance from the part is sampled once on a grid in its own axes. The part is then placed along the motion,
with screw motions between successive poses, in steps of half a step of the grid, and in a grid in the world the least
distance of all placements is kept. The mesh is where that is zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import check_known, check_motion, one_number
from jaxkin._files import save_figure, whole
from jaxkin._guesses import Result
from jaxkin._names import counted, nearest
from jaxkin.effects.pose_runs import PoseRun, off_between, placements, runs_of, sagitta
from jaxkin.geometry.isosurface import zero_surface
from jaxkin.geometry.part import Part
from jaxkin.geometry.signed_distance import BAND, Open, signed_distance
from jaxkin.joints.kinds import JointKind
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion

if TYPE_CHECKING:
    from trimesh import Trimesh

STEPS_ACROSS = 80
"""Steps of the grid along the longest edge of the box of all poses, where no resolution is given: half a million points
at most, and a percent of that edge between them."""
MAX_POINTS = 60_000_000
"""Points of a grid at most: half a gigabyte for each array of numbers."""
PLACED = 0.5
"""Steps of the grid by which corners move from one placement to the next at most: sharp edges that slide across leave
notches, of which half remain compared to whole steps."""
OFF = np.sqrt(3.0) + PLACED / 2
"""Steps of the grid by which the surface may be off: half a diagonal of a cell for each of the two grids, between whose
points distances are interpolated, and what sharp edges leave between two placements."""
WANTED = 0.5
"""Share of the volume above which its bound tells little, as of thin rods."""
ON_ONE_SCREW = (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.SCREW)
"""Joints whose one coordinate moves a part along a screw motion."""
MESH_FILES = (".stl", ".ply", ".obj", ".glb")
"""Suffixes of the files that `SweptVolume.save` writes."""


@dataclass(frozen=True, eq=False, repr=False)
class SweptVolume(Result):
    """The space that a part takes up along a motion. Prints, draws and saves itself."""

    part: str
    mesh: Trimesh
    """Closed, wound outwards; world coordinates, unit of the mechanism."""
    resolution: float
    """Step of the grid. What is thinner than this may be missing, holes narrower may be filled."""
    error: float
    """How far the surface may be from that of the swept solid, but for what `resolution` loses: a length."""
    lost: float
    """Share of its volume by which the part alone is too small on this grid, negative where it is too large."""
    poses: int
    """Closed poses of the motion."""
    left_out: int
    """Poses that are not closed (`motion.closed`), past which nothing is swept."""
    placements: int
    """Places of the part, those between poses too; the cost grows with their number and the inverse cube of
    `resolution`."""
    field: Float[np.ndarray, "x y z"]
    """Distance from the swept solid at the points of the grid, negative inside, cut off at two steps."""
    origin: Float[np.ndarray, "3"]
    """First point of the grid."""
    unit: str = ""

    @property
    def volume(self) -> float:
        """Volume, in the cube of the unit of the mechanism."""
        return float(self.mesh.volume)

    @property
    def volume_error(self) -> float:
        """Volume of the layer of the thickness `error` on the surface: by far more than is usually wrong.

        On smooth surfaces errors are of second order; faces that sharp edges sweep are a quarter of a step too far
        inside.
        """
        return float(self.mesh.area) * self.error

    @property
    def box(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest corner."""
        return np.asarray(self.mesh.bounds)

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        low, high = (", ".join(f"{x:.5g}" for x in corner) for corner in self.box)
        own = f"{100 * abs(self.lost):.2g} % too {'small' if self.lost > 0 else 'large'}"
        left = (
            f"; {counted(self.left_out, 'pose')} left out as not closed, and the way past them" if self.left_out else ""
        )
        return (
            f"Swept volume of {self.part} over {counted(self.poses, 'pose')}{left}\n"
            f"  volume {self.volume:.6g}{f'{unit}^3' if unit else ''}, surface within {self.error:.3g}{unit}: at most "
            f"{self.volume_error:.2g}{f'{unit}^3' if unit else ''} off\n"
            f"  box ({low}) to ({high}){unit}\n"
            f"  {self.placements} placements on a grid of {self.field.size} points, {self.resolution:.3g}{unit} apart; "
            f"{len(self.mesh.faces)} triangles\n"
            f"  the part alone is {own} on this grid: {self._advice()}"
        )

    def _advice(self) -> str:
        """Say what makes the bounds smaller: where they tell little of the volume, with numbers."""
        allowed, rest = WANTED * self.volume / float(self.mesh.area), self.error - OFF * self.resolution
        if self.error <= allowed:
            return "a smaller resolution= makes both better"
        if allowed <= rest:
            return f"{rest:.2g} of the bound is not the grid's: take poses closer together, or finer triangles"
        return f"the bound is half of the volume or more: write resolution={0.9 * (allowed - rest) / OFF:.2g} or less"

    def plot(self, path: str | Path) -> Path:
        """Draw the swept solid as seen along z, y and x into a picture file; returns its path."""
        from matplotlib.figure import Figure

        path = Path(path)
        figure = Figure(figsize=(11.0, 4.2), layout="constrained")
        low = self.origin
        for place, (towards, right, up) in enumerate(((2, 0, 1), (1, 0, 2), (0, 1, 2))):
            axes = figure.add_subplot(1, 3, place + 1)
            seen = _shaded(np.moveaxis(self.field, (right, up, towards), (0, 1, 2)), from_above=towards != 1)
            high = low + self.resolution * (np.array(self.field.shape) - 1)
            half = self.resolution / 2
            extent = (low[right] - half, high[right] + half, low[up] - half, high[up] + half)
            axes.imshow(seen.T, origin="lower", extent=extent, cmap="Blues_r", vmin=0.0, vmax=1.25)
            unit = f" ({self.unit})" if self.unit else ""
            axes.set(xlabel="xyz"[right] + unit, ylabel="xyz"[up] + unit)
        volume = f"{self.volume:.5g}" if self.volume < 1e5 else f"{self.volume:,.0f}"
        figure.suptitle(f"swept by {self.part}, {volume} {self.unit or 'units'}$^3$", fontsize="medium")
        return save_figure(figure, path)

    def save(self, path: str | Path) -> Path:
        """Write the mesh, unit of the mechanism, as .stl, .ply, .obj or .glb; returns the path."""
        path = Path(path)
        if path.suffix.lower() not in MESH_FILES:
            raise ValueError(f"a swept volume is written as {', '.join(MESH_FILES)}, got {path.name!r}")
        with whole(path) as draft:
            self.mesh.export(draft)
        return path


def swept_volume(motion: Motion, part: str, *, resolution: float | None = None) -> SweptVolume:
    """Find the space that a part takes up along a motion, between its poses too, as a closed mesh with its volume.

    `resolution` is the step of a grid of distances, unit of the mechanism; by default an eightieth of the longest edge
    of the box that the part sweeps. Half of it costs up to sixteen times as much. The way between successive poses is
    filled by screw motions, and `SweptVolume.error` includes how far they are off, as told by each pose between its
    neighbours; two poses alone count as the ends of a quarter turn, and what is hinged to, or slides in, a fixed part
    moves so exactly. Nothing is swept between two poses of which those between them are not closed.

    Runs on the host. Raises ValueError for a part that is not there, has no solid or an open one, for successive poses
    of which one is a quarter turn from the other, for a grid that is too large, and inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "swept volumes")
    check_known("swept volumes", "jk.swept_volume", motion, resolution)
    solid, runs, left_out = _given(motion, part)
    corners = solid.outermost
    low = np.min([run.moved.min(axis=(0, 1)) for run in runs], axis=0)
    high = np.max([run.moved.max(axis=(0, 1)) for run in runs], axis=0)
    step = _step(part, resolution, low, high)
    try:
        distances, first = signed_distance(solid.triangles, step)
    except Open:
        raise ValueError(
            f"the surface of {part!r} is not closed, so that it has no inside to sweep: repair its mesh, or read the "
            "part from a STEP file"
        ) from None
    # screw motions may bulge out of the box of the poses by their sagitta
    margin = (BAND + 1.0) * step + max(map(sagitta, runs))
    origin = low - margin
    shape = tuple((np.ceil((high + margin - origin) / step).astype(int) + 1).tolist())
    field = np.full(shape, BAND * step)
    count = 0
    for run in runs:
        for place in placements(run, PLACED * step):
            _add(field, origin, distances, first, step, place)
            count += 1
    points, triangles = zero_surface(field)
    if not len(triangles):
        raise ValueError(
            f"{part!r} is thinner than {step:.3g}, the step of the grid, and leaves nothing there: write "
            f"resolution={step / 8:.2g}"
        )
    from trimesh import Trimesh

    mesh = Trimesh(origin + step * points, triangles, process=False)
    alone = Trimesh(*zero_surface(distances), process=False)
    lost = 1.0 - float(alone.volume) * step**3 / solid.volume if len(alone.faces) else 1.0
    between = 0.0 if _on_one_screw(motion.mechanism, part) else max(off_between(run, corners) for run in runs)
    off = OFF * step + between + max((face.bulge for face in solid.faces), default=0.0)
    counts = sum(len(run.places) for run in runs), left_out, count
    return SweptVolume(part, mesh, step, off, lost, *counts, field, origin, motion.mechanism.unit)


def _given(motion: Motion, part: str) -> tuple[Part, list[PoseRun], int]:
    """Find the solid of a part, its closed poses, and the number of those left out; ValueError if there are none."""
    mechanism = motion.mechanism
    if part not in mechanism.parts:
        raise ValueError(f"there is no part {part!r}{nearest(str(part), mechanism.parts)}")
    solid = next((each for each in mechanism.solids if each.name == part), None)
    if solid is None or not solid.is_solid or not len(solid.triangles):
        raise ValueError(f"{part!r} has no solid to sweep: read the mechanism from a file of solids")
    closed = np.asarray(motion.closed)
    if not closed.any():
        raise ValueError(f"no pose of the motion is closed: {motion}")
    places = np.broadcast_to(np.asarray(motion.transforms[part], float), (len(closed), 4, 4))
    return solid, runs_of(places, closed, solid.outermost), int((~closed).sum())


def _on_one_screw(mechanism: Mechanism, part: str) -> bool:
    """Tell whether a part turns about, or slides along, an axis of what is fixed: screw motions are its way then."""
    fixed = {*mechanism.fixed, part}
    return any(
        joint.kind in ON_ONE_SCREW and part in joint.parts and fixed.issuperset(joint.parts)
        for joint in mechanism.joints.values()
    )


def _step(part: str, resolution: float | None, low: np.ndarray, high: np.ndarray) -> float:
    """Choose the step of the grid; ValueError for one that makes no sense, or too many points."""
    if resolution is None:
        return float((high - low).max()) / STEPS_ACROSS
    expected = "a length above zero, unit of the mechanism"
    resolution = float(one_number(resolution, "the resolution", expected))
    if resolution <= 0:
        raise ValueError(f"the resolution must be {expected}, got {resolution!r}")
    points = float(np.prod((high - low) / resolution + 2 * BAND + 3))
    if points > MAX_POINTS:
        least = float(resolution * (points / MAX_POINTS) ** (1 / 3))
        raise ValueError(
            f"the box that {part!r} sweeps has {points:.2g} points {resolution:g} apart, and {MAX_POINTS:.2g} are the "
            f"most: write resolution={1.1 * least:.2g}"
        )
    return resolution


def _add(
    field: np.ndarray, origin: np.ndarray, distances: np.ndarray, first: np.ndarray, step: float, place: np.ndarray
) -> None:
    """Lower the distances in the world to those of a part at a place."""
    from scipy.ndimage import affine_transform

    ends = first + step * (np.array(list(np.ndindex(2, 2, 2))) * (np.array(distances.shape) - 1))
    there = (ends @ place[:3, :3].T + place[:3, 3] - origin) / step
    low = np.maximum(np.ceil(there.min(axis=0)).astype(int), 0)
    high = np.minimum(np.floor(there.max(axis=0)).astype(int) + 1, field.shape)
    # the point i of the grid of the world is the point R^T (o + h i - p), in steps from the first one of the part
    back = place[:3, :3].T
    offset = (back @ (origin + step * low - place[:3, 3]) - first) / step
    own = affine_transform(
        distances, back, offset, tuple(high - low), order=1, mode="constant", cval=BAND * step, prefilter=False
    )
    block = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    np.minimum(field[block], own, out=field[block])


def _shaded(field: Float[np.ndarray, "right up towards"], from_above: bool) -> Float[np.ndarray, "right up"]:
    """Shade the surface that is seen first along the last axis: its brightness; NaN where nothing is seen."""
    field = field[:, :, ::-1] if from_above else field
    inside = field < 0
    at = np.argmax(inside, axis=2)
    seen = inside.any(axis=2)
    here = np.take_along_axis(field, at[..., None], axis=2)[..., 0]
    before = np.take_along_axis(field, np.maximum(at - 1, 0)[..., None], axis=2)[..., 0]
    depth = np.where(seen, at - here / np.where(seen, here - before, 1.0), np.nan)
    slopes = np.gradient(depth)
    normal = np.stack([slopes[0], slopes[1], np.ones_like(depth)]) / np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)
    light = np.array([-0.4, 0.5, 0.77])
    return np.where(
        seen, 0.2 + 0.8 * np.clip(np.tensordot(light, np.nan_to_num(normal, nan=0.2), axes=1), 0, 1), np.nan
    )
