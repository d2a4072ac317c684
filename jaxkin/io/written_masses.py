"""What the parts of a mechanism weigh, as files of robots say it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import check_one
from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.effects.forces.masses import Masses
from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.units import METRES

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def written_inertials(mechanism: Mechanism, masses: Masses | None) -> dict[str, Inertial]:
    """List what is known of the masses of parts, by name: centres in metres, world axes of the assembled pose.

    `masses` are those of `jk.masses`; None for what the file says that the mechanism was read from. A fixed part whose
    mass is zero, as `jk.masses` has all that were not given, is left out. Raises ValueError for masses of other parts,
    for traced ones, and for a batch of them.
    """
    if masses is None:
        found = {part.name: part.inertial for part in mechanism.solids if part.inertial is not None}
    elif not isinstance(masses, Masses) or masses.parts != mechanism.parts:
        got = f"those of {listed(masses.parts)}" if isinstance(masses, Masses) else type(masses).__name__
        raise ValueError(f"masses are what jk.masses(mechanism, ...) finds for all parts of this mechanism, got {got}")
    elif traced((masses.mass, masses.centre, masses.inertia)):
        raise ValueError("the masses are traced: write the file outside of jit, vmap and grad")
    else:
        check_one("masses in a file", "one mechanism", masses.batch)
        numbers = zip(*(np.asarray(each, float) for each in (masses.mass, masses.centre, masses.inertia)), strict=True)
        found = {
            name: Inertial(float(mass), centre, inertia)
            for name, (mass, centre, inertia) in zip(masses.parts, numbers, strict=True)
            if mass or name not in mechanism.fixed
        }
    return {name: inertial.in_unit(METRES[mechanism.unit]) for name, inertial in found.items()}


def principal_axes(inertia: Float[np.ndarray, "3 3"]) -> tuple[np.ndarray, Float[np.ndarray, "4"]]:
    """Find the principal moments of an inertia, and the quaternion (w, x, y, z) of their axes.

    Of an inertia that is diagonal already, the axes stay as they are.
    """
    from scipy.spatial.transform import Rotation

    if not np.any(inertia - np.diag(np.diag(inertia))):
        return np.diag(inertia), np.array([1.0, 0.0, 0.0, 0.0])
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return np.maximum(moments, 0.0), Rotation.from_matrix(axes).as_quat(scalar_first=True)
