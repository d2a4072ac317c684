"""Mechanisms written to a file and read back: names and units of their coordinates there, and poses to compare.

Poses are closed on the host, by numpy, so that a whole catalogue costs no compilation.
"""

import numpy as np

from jaxkin.geometry.movements import is_length
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.placed_at import placed_at

METRES = {"": 1.0, "m": 1.0, "mm": 1e-3, "in": 0.0254}
"""Mechanisms without a unit are taken for metres."""


def small_drive(mechanism: Mechanism, step=0.02) -> dict[str, float]:
    """Small displacements of coordinates that determine the motion together, by "joint.coordinate"."""
    mobility = mechanism.mobility()
    names = mobility.drivable[: mobility.freedoms]
    # lengths move as far as an angle moves what is a tenth of the extent away
    reach = 0.1 * float(np.ptp([joint.frames_1[0][:3, 3] for joint in mechanism.all_joints], axis=0).max() or 1.0)
    return {name: step * (reach if is_length(name.rpartition(".")[2]) else 1.0) for name in names}


def coordinate_in_file(mechanism: Mechanism, key: str, single: bool) -> str:
    """The name in the file of a coordinate "joint.coordinate": its joint's, or "joint_coordinate" of several.

    `single` says whether the format has joints of one coordinate only.
    """
    joint, _, coordinate = key.rpartition(".")
    several = len(mechanism.joints[joint].driven_together) > 1
    return f"{joint}_{coordinate}" if several and single else joint


def scale_of(mechanism: Mechanism, key: str) -> float:
    """Metres in the unit of a coordinate."""
    return METRES[mechanism.unit] if is_length(key.rpartition(".")[2]) else 1.0


def host_pose(mechanism: Mechanism, drive: dict[str, float]) -> dict[str, np.ndarray]:
    """Displacements (4, 4) of all parts, with the loops closed from the assembled pose by numpy."""
    linkage = mechanism.linkage
    rows = {joint.name: np.zeros(joint.freedoms) for joint in linkage.joints}
    for name, value in drive.items():
        joint, _, coordinate = name.rpartition(".")
        rows[joint][mechanism.joints[joint].coordinates.index(coordinate)] = value
    for group in linkage.structure.loop_groups:
        loops = ClosedLoops(linkage.joints, linkage.structure, group, linkage.couplings)
        every = [f"{linkage.joints[j].name}.{linkage.joints[j].coordinates[k]}" for j, k in loops.columns]
        held = [column for column, name in enumerate(every) if name in drive]
        q = np.array([drive.get(name, 0.0) for name in every]) / loops.units
        q, there = loops.closed(q, held)
        assert there.residual_norm < 1e-12, f"{there.residual_norm} left open"  # what counts as closed
        for index, columns in loops.slices.items():
            rows[linkage.joints[index].name] = (q * loops.units)[columns]
    return placed_at(mechanism, rows, 0.0)[1]


def in_metres(mechanism: Mechanism, places: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    scale = np.array([[1, 1, 1, METRES[mechanism.unit]]] * 3 + [[1, 1, 1, 1]])
    return {part: np.asarray(each) * scale for part, each in places.items()}


def compare_moved(mechanism: Mechanism, back: Mechanism, single: bool, metres: bool = True) -> None:
    """Check that a mechanism that was read back has the freedoms of the first one, and moves its parts alike."""
    assert back.mobility().freedoms == mechanism.mobility().freedoms
    assert {*mechanism.parts} <= {*back.parts}
    drive = small_drive(mechanism)
    expected = host_pose(mechanism, drive)
    renamed = {}
    for key, value in drive.items():
        name = coordinate_in_file(mechanism, key, single)
        coordinate = key.rpartition(".")[2]
        own = back.joints[name].coordinates
        renamed[f"{name}.{coordinate if coordinate in own else own[0]}"] = (
            value * scale_of(mechanism, key) if metres else value
        )
    found = host_pose(back, renamed)
    if metres:
        expected = in_metres(mechanism, expected)
    spinning = {part for idle in mechanism.mobility().idle_motions for part in idle.parts}
    size = max(1.0, *(float(np.abs(each).max()) for each in expected.values()))
    for part, place in expected.items():
        there = found[part]
        if part in spinning:  # which turn closes the loops is a matter of taste, but not where its joints are
            joints = [joint.frames_1 for joint in mechanism.all_joints if part in joint.parts]
            points = np.concatenate([frames[:, :, 3] for frames in joints]).T
            points[:3] *= METRES[mechanism.unit] if metres else 1.0
            place, there = place @ points, there @ points
        # 1e-12 of the largest number: both are closed to rounding, and conditioning takes two digits
        np.testing.assert_allclose(there, place, rtol=0, atol=1e-12 * size, err_msg=part)


def check_solids(now, was):
    """Solids in millimetres come back in metres; the bounds tell placement and size, corners come in another order."""
    before = {part.name: np.asarray(part.triangles).reshape(-1, 3) for part in was}
    after = {part.name: np.asarray(part.triangles).reshape(-1, 3) for part in now if part.name in before}
    assert after.keys() == before.keys()
    for name, corners in before.items():
        for bound in (np.min, np.max):
            np.testing.assert_allclose(bound(after[name], axis=0), 1e-3 * bound(corners, axis=0), rtol=0, atol=1e-15)
