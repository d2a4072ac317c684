"""Draw a map over two inputs, and the places of a point, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin._files import save_figure
from jaxkin.geometry.headings import coordinate_label
from jaxkin.solve.status import Status

FLAT = 1e-9
"""Extent of a point's places along an axis, over the largest one, below which they are drawn in the plane across."""
GREYS = {Status.LIMITED: "0.7", Status.JUMPED: "0.82", Status.UNREACHABLE: "0.95", Status.STALLED: "0.55"}
"""Colours of nodes that are not reached."""

MARK = "crimson"
"""Colour of singular poses."""


class WorkspaceMap(NamedTuple):
    """What is drawn of a workspace: see the fields of the same names of `Workspace`."""

    inputs: Mapping[str, Float[np.ndarray, " values"]]
    part: str
    status: Int[np.ndarray, "first second"]
    reached: Bool[np.ndarray, "first second"]
    sigma_min: Float[np.ndarray, "first second"]
    condition: Float[np.ndarray, "first second"]
    points: Float[np.ndarray, "first second 3"]
    unit: str


def draw_workspace(
    found: WorkspaceMap,
    path: Path,
    singular: Float[np.ndarray, "singular 2"] | None = None,
    places: Float[np.ndarray, "singular 3"] | None = None,
) -> Path:
    """Draw `sigma_min` over the inputs and `condition` over the places of the point; returns the path.

    The inputs `singular`, at which the point is at `places`, are marked.
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    figure = Figure(figsize=(11, 5), layout="constrained")
    axes = figure.add_subplot(1, 2, 1)
    first, second = found.inputs.values()
    handles = []
    for status, grey in GREYS.items():
        here = found.status == status.value
        if here.any():
            axes.pcolormesh(
                first, second, np.where(here, 1.0, np.nan).T, cmap=ListedColormap([grey]), shading="nearest"
            )
            handles.append(Patch(facecolor=grey, edgecolor="0.5", label=status.name))
    values = np.where(found.reached & np.isfinite(found.sigma_min), found.sigma_min, np.nan)
    if np.isfinite(values).any():
        drawn = axes.pcolormesh(first, second, values.T, cmap="viridis", shading="nearest", vmin=0.0)
        figure.colorbar(drawn, ax=axes, label="sigma_min")
    unit = f" ({found.unit})" if found.unit else ""
    along = [coordinate_label(name, found.unit) for name in found.inputs]
    axes.set(xlabel=along[0], ylabel=along[1])
    axes.set_title("inputs: how near the loops are to singular", fontsize="medium")
    if singular is not None:
        handles += axes.plot(*singular.T, ".", color=MARK, markersize=4, label="singular")
    if handles:
        # below the map, which it would cover
        figure.legend(handles=handles, fontsize="small", frameon=False, loc="outside lower left", ncols=len(handles))

    points = found.points[found.reached]
    extent = np.ptp(points, axis=0) if len(points) else np.ones(3)
    across = [k for k in range(3) if extent[k] <= FLAT * max(extent.max(), 1e-300)]
    title = f"places of the point of {found.part}"
    if across:
        a, b = [k for k in range(3) if k != across[-1]]
        plane = figure.add_subplot(1, 2, 2)
        drawn = plane.scatter(points[:, a], points[:, b], c=found.condition[found.reached], s=6, vmin=0.0)
        if places is not None:
            plane.plot(places[:, a], places[:, b], ".", color=MARK, markersize=4)
        plane.set(xlabel="xyz"[a] + unit, ylabel="xyz"[b] + unit, title=title)
        plane.set_aspect("equal")
        figure.colorbar(drawn, ax=plane, label="condition")
    else:
        space = figure.add_subplot(1, 2, 2, projection="3d")
        drawn = space.scatter(*points.T, c=found.condition[found.reached], s=6, vmin=0.0)
        if places is not None:
            space.plot(*places.T, ".", color=MARK, markersize=4)
        space.set(xlabel="x" + unit, ylabel="y" + unit, zlabel="z" + unit, title=title)
        figure.colorbar(drawn, ax=space, label="condition")
    return save_figure(figure, path)
