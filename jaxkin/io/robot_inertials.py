"""Masses of links from the elements <inertial> of robot files; notes name what no body weighs."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.geometry.inertial import Inertial, exceeds_sum
from jaxkin.geometry.pose import Transform
from jaxkin.io.robot_model import numbers
from jaxkin.io.sdf_frames import is_true, read_pose

SIX = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
"""Names of the entries of an inertia matrix in URDF and SDF, in the order of `inertial`."""
ROUNDED = 1e-6
"""Least eigenvalue of an inertia over its largest one, below zero, that still counts as rounding of the file."""
SMALL = 1e-3
"""Radius in metres: the inertia of a body is held against that of its mass at this radius, if that is larger. Exporters
write 1e-20 in place of zero."""


def inertial(
    mass: float, place: Transform, six: Sequence[float] | np.ndarray, where: str, notes: list[str]
) -> Inertial | None:
    """Make the inertial of a link of the place of its centre and axes, and xx, yy, zz, xy, xz, yz of its inertia there.

    Files of robots that move well have matrices that no distribution of mass has: the nearest one without negative
    eigenvalues is taken, others are kept, and a note says so. None, and a note, for a mass below zero.
    """
    if mass < 0:
        notes.append(f"{where}: expected a mass from 0 on, got {mass:g}; it is not taken")
        return None
    xx, yy, zz, xy, xz, yz = map(float, six)
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    values, axes = np.linalg.eigh(matrix)
    if values[0] < -ROUNDED * max(abs(values[-1]), mass * SMALL**2):
        notes.append(
            f"{where}: no body has the inertia {list(map(float, six))}, of which one eigenvalue is {values[0]:.3g}: "
            "the nearest without negative ones is taken; correct the file"
        )
        matrix = axes * np.maximum(values, 0.0) @ axes.T
    elif exceeds_sum(values) and values[2] > mass * SMALL**2:
        notes.append(
            f"{where}: no body has principal moments of inertia of {', '.join(f'{x:.3g}' for x in values)}, of which "
            "the largest is above the sum of the others: they are taken as they are; correct the file"
        )
    turn = place[:3, :3]
    return Inertial(mass, place[:3, 3].copy(), turn @ matrix @ turn.T)


def sdf_inertial(link: Element, where: str, notes: list[str]) -> Inertial | None:
    """Read the mass of a link of SDF, with the defaults of the format inside of <inertial>: 1 kg, 1 kg m^2."""
    found = link.find("inertial")
    if found is None or is_true(found.get("auto")):
        return None
    mass, matrix = float(numbers(found.findtext("mass"), 1, where, (1,))[0]), found.find("inertia")
    given = {} if matrix is None else {each.tag: each.text for each in matrix}
    six = [float(numbers(given.get(name), 1, f"{where}: {name}", (name[1] == name[2],))[0]) for name in SIX]
    return inertial(mass, read_pose(found, where), six, where, notes)
