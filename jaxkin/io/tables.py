"""A motion as arrays (`motion.npz`) and as a table (`motion.csv`)."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.headings import coordinate_with_unit
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion


def write_arrays(motion: Motion, path: Path) -> None:
    """Write all arrays of a motion, in its own precision, for `numpy.load(path)`; nothing in it is pickled.

    - `input:<joint>.<coordinate>` (poses,): driven displacements
    - `joint:<joint>` (poses, k): displacements of a joint, and `coordinates:<joint>` (k,): their names
    - `part:<part>` (poses, 4, 4): displacement of a part from its assembled pose, in world coordinates
    - `status` (poses,): codes, `status_names[status]` says them in words
    - `residual` (poses,): square root of Eq. 12 with lengths over the characteristic length
    - `unit`: of all lengths; angles are in radians
    """
    arrays = poses_of(motion) | words_of(motion.mechanism)
    for name, transforms in motion.transforms.items():
        arrays[f"part:{name}"] = np.asarray(transforms)
    np.savez(path, **arrays)  # pyright: ignore[reportArgumentType]  # no key of ours is "allow_pickle"


def poses_of(motion: Motion) -> dict[str, np.ndarray]:
    """List the arrays of one row a pose, but for the displacements of parts, which follow from those of the joints."""
    arrays = {f"input:{name}": np.asarray(values) for name, values in motion.inputs.items()}
    arrays |= {f"joint:{name}": np.asarray(values) for name, values in motion.coordinates.items()}
    return arrays | {"status": np.asarray(motion.status), "residual": np.asarray(motion.residual)}


def words_of(mechanism: Mechanism) -> dict[str, np.ndarray]:
    """Name the columns and codes of the arrays of `poses_of`."""
    words = {f"coordinates:{name}": np.array(j.coordinates, dtype=str) for name, j in mechanism.joints.items()}
    return words | {"status_names": np.array([s.name for s in Status]), "unit": np.array(mechanism.unit)}


def write_table(motion: Motion, path: Path) -> None:
    """Write a motion as comma-separated values, one row a pose: inputs, joint displacements, status, residual.

    The first row names the columns and their units, such as `crank-coupler.phi [rad]`. Every number is the shortest
    decimal that reads back as the same number of the motion's precision.
    """
    columns: dict[str, np.ndarray] = {"pose": np.arange(len(motion))}
    for name, values in motion.inputs.items():
        columns[f"input:{coordinate_with_unit(name, motion.mechanism.unit)}"] = np.asarray(values)
    for name, joint in motion.mechanism.joints.items():
        for index, full_name in enumerate(joint.full_names):
            heading = coordinate_with_unit(full_name, motion.mechanism.unit)
            columns[heading] = np.asarray(motion.coordinates[name])[:, index]
    columns["status"] = np.array([status.name for status in Status])[np.asarray(motion.status)]
    columns["residual"] = np.asarray(motion.residual)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*(column.astype(str).tolist() for column in columns.values()), strict=True))
