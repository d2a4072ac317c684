"""What the contacts of joints along curves and over surfaces are in each pose, and what is wrong with them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.effects.pose_axis import drive_axis
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.headings import with_unit

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

IN_THE_WAY = 1e-6
"""Depth, over the size of a profile, from which on something is in the way: far above rounding, and below what can be
made."""

PerPose = Float[np.ndarray, " poses"]


@dataclass(frozen=True, eq=False, repr=False)
class CurveContact(Result):
    """The contact of one joint along a curve, or over a surface along one of its coordinates, at each pose.

    NaN where the pose is not closed; lengths in the unit of the mechanism. Of two curves of which that of part 1 is
    open it is not known on which side the other one is: curvature, clearance and depth are NaN.
    """

    joint: str
    what: str
    """What follows the curve: "a point", "a roller", "a flat face", "a curve", "a ball"."""
    of: str
    """What is followed: "curve", or "surface along u" and "surface along v", a contact for each."""
    parameter: PerPose
    """How far the contact is along the curve from the first of its points."""
    curvature: PerPose
    """Curvature of the profile at the contact, over one length: positive where it bends away from what follows it. Of a
    surface the least of its two principal curvatures."""
    clearance: PerPose
    """1 + radius times curvature of a roller, the sum of both curvatures, times the size of the profile, of a curve:
    negative where the profile is undercut, where it bends towards what follows it more than that is bent itself. Of
    a flat face curvature times size; 1 for a point."""
    depth: PerPose
    """How deep what follows would have to pass through the profile or surface, anywhere; 0 where it need not."""
    beyond: PerPose
    """How far the contact is beyond an end of an open curve; 0 on the curve, and of closed ones."""

    @property
    def over(self) -> str:
        """What is followed, as what it is of a part: "profile" or "surface"."""
        return "profile" if self.of == "curve" else "surface"

    @property
    def lost(self) -> Bool[np.ndarray, " poses"]:
        """The poses that what follows cannot be in."""
        return (self.clearance < 0) | (self.depth > 0) | (self.beyond > 0)


@dataclass(frozen=True, eq=False, repr=False)
class CurveContacts(Result):
    """The contacts of all joints along curves over a motion. Prints, draws and saves itself."""

    motion: Motion
    """The motion that was looked at."""
    contacts: tuple[CurveContact, ...]
    unit: str
    """Unit of all lengths."""

    @property
    def holds(self) -> bool:
        """Whether all contacts are possible at all closed poses."""
        return not any(each.lost.any() for each in self.contacts)

    def __str__(self) -> str:
        lines = [line for each in self.contacts for line in self._of(each)]
        none = not any(np.isfinite(each.parameter).any() for each in self.contacts)
        all_held = "possible" if len(self.contacts) == 1 else "all are possible"
        held = "no pose is closed" if none else f"{all_held} at all closed poses"
        half_known = [each.joint for each in self.contacts if np.isnan(each.depth[np.isfinite(each.parameter)]).any()]
        return "\n".join(
            [
                *(lines or [f"{counted(len(self.contacts), 'contact')} on curves: {held}"]),
                *(
                    f"curve contact: joint {joint!r}: whether its curves pass through each other is not known, since "
                    "that of part 1 is open"
                    for joint in half_known
                ),
            ]
        )

    def _of(self, each: CurveContact) -> list[str]:
        """Tell what is wrong with one contact: how bad, at which pose, and where on its curve."""
        lines = []
        undercut = each.clearance < 0
        told = (
            (undercut, -each.clearance, "is undercut"),
            (each.depth > 0, each.depth, f"would have {each.what} pass through the {each.over}"),
            (each.beyond > 0, each.beyond, f"leaves the end of its {each.of}"),
        )
        for where, size, said in told:
            if not where.any():
                continue
            worst = int(np.nanargmax(np.where(where, size, -np.inf)))
            poses = np.flatnonzero(where)
            how_far = f"up to {self._length(size[worst])}"
            if where is undercut:
                radius = 1 / abs(each.curvature[worst])
                how_far = f"radius of curvature {self._length(radius)} in a hollow or an edge too sharp for {each.what}"
            lines.append(
                f"curve contact: joint {each.joint!r} {said} at {len(poses)} of {len(where)} poses, {poses[0]} to "
                f"{poses[-1]}: {how_far}, worst at pose {worst} with the contact {self._length(each.parameter[worst])} "
                "from the first point"
            )
        return lines

    def _length(self, value: float) -> str:
        return f"{value:.4g} {self.unit}".rstrip()

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw how deep followers pass through profiles, and beyond ends, over the drive or `times`; returns the
        path."""
        names, rows = self._rows(("depth", "beyond"))
        title = "contacts on curves" if self.holds else "contacts on curves that are not possible"
        label = f"depth, distance beyond ends ({self.unit})" if self.unit else "depth, distance beyond ends"
        return draw_lines(names, rows, label, title, Path(path), axis=drive_axis(self.motion, times))

    def save(self, path: str | Path) -> Path:
        """Write all numbers as comma-separated values, a row a pose; returns the path."""
        fields = ("parameter", "curvature", "clearance", "depth", "beyond")
        units = [f"1/{self.unit}" if field == "curvature" and self.unit else self.unit for field in fields]
        names, rows = self._rows(fields)
        heads = [with_unit(name, unit) for name, unit in zip(names, units * len(self.contacts), strict=True)]
        return save_rows(heads, rows, Path(path))

    def _rows(self, fields: tuple[str, ...]) -> tuple[list[str], Float[np.ndarray, "rows poses"]]:
        names = [f"{each.joint} {field}" for each in self.contacts for field in fields]
        return names, np.array([getattr(each, field) for each in self.contacts for field in fields])


class CurvePlace(NamedTuple):
    """Where a contact is on its curve, or along a coordinate of its surface."""

    s: PerPose
    """From the first of the points; NaN where the pose is not closed."""
    whole: float
    """The length of the curve or surface."""
    closed: bool


class CurveFit(NamedTuple):
    """How a curve and what follows it fit together: fields of `CurveContact`, before rounding is taken for zero."""

    curvature: PerPose
    clearance: PerPose
    depth: PerPose
    size: float
    """Of the profile."""


def made_contact(joint: str, what: str, of: str, place: CurvePlace, fit: CurveFit) -> CurveContact:
    """Make a contact from what is known of it at each pose; other arguments are fields of `CurveContact`."""
    s, whole, closed = place
    finite = np.isfinite(s)
    curvature, clearance, depth, size = fit
    beyond = np.zeros(len(s)) if closed else np.maximum(np.maximum(-s, s - whole), 0.0)
    kept = (
        np.mod(s, whole) if closed else s,
        curvature,
        np.where(np.abs(clearance) <= IN_THE_WAY, 0.0, clearance),
        np.where(depth <= IN_THE_WAY * size, 0.0, depth),
        np.where(beyond > IN_THE_WAY * size, beyond, 0.0),
    )
    return CurveContact(joint, what, of, *(np.where(finite, values, np.nan) for values in kept))
