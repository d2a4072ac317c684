"""Mates that keep an angle only, alone and with others, against their equations in numpy (`reference.mates`)."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.assembly.wheels import wheels_last
from jaxkin.geometry.movements import is_length
from jaxkin.joints.screws import displacements
from reference.exported import X, Y, Z, instance, load, mate
from reference.mates import draw, freedoms, residual

TREE = instance("base", grounded="true") + instance("part")


def mechanism_of(folder, mates):
    written = "".join(
        mate(kind, f"m{number}", ("base", *one), ("part", *other)) for number, (kind, one, other) in enumerate(mates)
    )
    return load(folder, TREE, mates=written).mechanism()


def plane(normal, point=(0.0, 0.0, 0.0)):
    return "plane", np.array(point, float), np.array(normal, float) / np.linalg.norm(normal)


def line(*given):
    return "line", *plane(*given)[1:]


PARALLEL_X, PARALLEL_Z = ("Parallel", plane(X), plane(X)), ("Parallel", plane(Z), plane(Z))
FLAT, PIN = ("Coincident", plane(Z), plane(Z)), ("Concentric", line(Z), line(Z))
SLANTED = ("Angle", plane(Z), plane((1, 0, 1)))
ALONE = {
    "parallel planes": ([PARALLEL_Z], "schoenflies", 4),
    "parallel lines": ([("Parallel", line(X), line(X))], "schoenflies", 4),
    "a plane and its normal": ([("Perpendicular", plane(X), line(X))], "schoenflies", 4),
    "a right angle": ([("Perpendicular", line(X), line(Y))], "constant angle", 5),
    "a line along a plane": ([("Parallel", plane(X), line(Y))], "constant angle", 5),
    "another angle": ([SLANTED], "constant angle", 5),
    "the same angle twice": ([SLANTED, ("Angle", line(Z), plane((1, 0, 1), (0.1, 0.2, 0.3)))], "constant angle", 5),
    "two parallel mates": ([PARALLEL_X, PARALLEL_Z], "cartesian", 3),
    "parallel, and an angle about it": ([PARALLEL_Z, ("Angle", plane(X), plane((1, 1, 0)))], "cartesian", 3),
    "parallel, and an angle to it": ([PARALLEL_Z, SLANTED], "schoenflies", 4),
    "one axis at right angles to two": (
        [("Perpendicular", line(Z), line(X)), ("Perpendicular", line(Z), line(Y))],
        "schoenflies",
        4,
    ),
    "an XY table": ([FLAT, PARALLEL_X], "rectangular", 2),
    "an XY table, told twice": ([FLAT, PARALLEL_X, PARALLEL_Z], "rectangular", 2),
    "a plane kept from turning by an angle": ([FLAT, ("Angle", plane(X), plane((1, 1, 0)))], "rectangular", 2),
    "a plane that is parallel to it": ([FLAT, PARALLEL_Z], "planar", 3),
    "a point in a plane, and no turn": (
        [("Coincident", plane(Z), ("point", *plane(Z)[1:])), PARALLEL_X, PARALLEL_Z],
        "rectangular",
        2,
    ),
    "a point in a plane that stays level": (
        [("Coincident", plane(Z), ("point", *plane(Z)[1:])), PARALLEL_Z],
        "planar",
        3,
    ),
    "a pin at a right angle to a line along it": ([PIN, ("Perpendicular", line(Z), line(X))], "cylindrical", 2),
    "a pin kept from turning by a right angle": ([PIN, ("Perpendicular", line(X), line(Y))], "prismatic", 1),
    "a ball that stays upright": ([("Coincident", ("point", *plane(Z)[1:]), ("point", *plane(Z)[1:])), PARALLEL_Z],
                                  "revolute", 1),
}  # fmt: skip
"""Mates of two parts, the joint that they are, and its freedoms."""


@pytest.mark.parametrize(("mates", "kind", "count"), ALONE.values(), ids=ALONE)
def test_mates_of_angles_are_one_joint_that_keeps_them(tmp_path, mates, kind, count):
    """Of all displacements of the joint each keeps all mates; none is missing, by their rank. Rounding: 1e-15."""
    mechanism = mechanism_of(tmp_path, mates)
    (found,) = mechanism.all_joints
    assert found.kind == kind and found.freedoms == count == freedoms(mates) == mechanism.mobility().freedoms
    assert not any("left out" in note for note in mechanism.notes)
    q = np.random.default_rng(0).uniform(-1, 1, (5, count))
    for pose in np.moveaxis(displacements(found, q), -1, 0):
        between = (
            pose if found.parts == ("base", "part") else np.column_stack([pose[:, :3].T, -pose[:, :3].T @ pose[:, 3]])
        )
        np.testing.assert_allclose(
            np.concatenate([residual(m, between[:, :3], between[:, 3]) for m in mates]), 0, atol=1e-13
        )


@pytest.mark.parametrize(
    ("one", "other", "freedoms"),
    [
        (plane(Z), plane(Z), 4),
        (plane(Z), plane((0, 0, -1)), 4),
        (line(Z), line(Z), 4),
        (plane(Z), line(Z), 4),  # of 90 degrees
        (plane(Z), plane((5e-4, 0, 1)), 4),  # as solved for its cosine
        (plane(Z), plane((3e-3, 0, 1)), 5),  # of 0.17 degrees
        (plane(Z), line(X), 5),  # of 0 degrees, and yet no extremum
    ],
)
def test_an_angle_at_its_extremum_keeps_its_directions_parallel(tmp_path, one, other, freedoms):
    """Two equations, of which an angle alone has one: no other pose has a cosine of 1, or of -1."""
    mechanism = mechanism_of(tmp_path, [("Angle", one, other)])
    assert mechanism.mobility().freedoms == freedoms
    assert mechanism.all_joints[0].kind == ("schoenflies" if freedoms == 4 else "constant angle")
    told = [note for note in mechanism.notes if "takes two freedoms and not one" in note]
    assert bool(told) == (freedoms == 4)
    off = np.linalg.norm(np.cross(one[2], other[2])) if freedoms == 4 else 0.0
    assert any("apart as exported" in note for note in mechanism.notes) == (off > 1e-5)


def test_slides_of_a_table_run_along_its_mates(tmp_path):
    """x of the table is along the direction that the parallel mate keeps."""
    askew = np.array([0.6, 0.8, 0.0])
    (table,) = mechanism_of(tmp_path, [FLAT, ("Parallel", plane(askew), plane(askew))]).all_joints
    assert table.coordinates == ("x", "y")
    np.testing.assert_allclose(np.asarray(table.frames_1)[0, :3, 0], askew, atol=1e-15)
    (free,) = mechanism_of(tmp_path, [("Parallel", plane(Y), plane(Y)), PARALLEL_X]).all_joints
    np.testing.assert_allclose(np.asarray(free.frames_1)[0, :3, :3].T, [X, (0, 0, -1), Y], atol=1e-15)


@pytest.mark.parametrize("seed", [pytest.param(seed, marks=[pytest.mark.long] if seed else []) for seed in range(4)])
def test_random_mates_leave_the_freedoms_of_their_equations(tmp_path, seed):
    """One to four mates of two parts: their joints, side by side where there are several, have as many freedoms."""
    random = np.random.default_rng(seed)
    for _ in range(30):
        mates = [draw(random) for _ in range(random.integers(1, 5))]
        mechanism = mechanism_of(tmp_path, mates)
        assert mechanism.mobility().freedoms == freedoms(mates), mates
        assert not any("left out" in note for note in mechanism.notes)
        if len(mechanism.all_joints) == 1 and (joint := mechanism.all_joints[0]).parts == ("base", "part"):
            q = random.uniform(-0.3, 0.3, (2, joint.freedoms))
            for pose in np.moveaxis(displacements(joint, q), -1, 0):
                left = np.concatenate([residual(each, pose[:, :3], pose[:, 3]) for each in mates])
                np.testing.assert_allclose(left, 0, atol=1e-13)  # sums of a few roundings of numbers below one


BALL = ("Coincident", ("point", *plane(Z)[1:]), ("point", *plane(Z)[1:]))
ON_LINE = ("Coincident", line(X), ("point", *plane(Z)[1:]))
ON_PLANE = ("Coincident", plane(Z), ("point", *plane(Z)[1:]))
SIDE_BY_SIDE = {
    "a ball at an angle": ([BALL, SLANTED], ["constant angle", "spherical"]),
    "a point on a line that stays level": ([ON_LINE, PARALLEL_Z], ["contact j", "schoenflies"]),
    "a point on a plane at an angle": ([ON_PLANE, SLANTED], ["constant angle", "contact d"]),
    "two angles": ([SLANTED, ("Angle", plane(X), plane((0, 1, 1)))], ["constant angle", "constant angle"]),
    "a point at a distance that does not turn": (
        [("Distance", ("point", *plane(Z)[1:]), ("point", *plane(Z, (0.1, 0, 0))[1:])), PARALLEL_X, PARALLEL_Z],
        ["cartesian", "contact p"],
    ),
}
"""Mates that are no one joint, and the fewest joints that say them."""


@pytest.mark.long
@pytest.mark.parametrize(("mates", "kinds"), SIDE_BY_SIDE.values(), ids=SIDE_BY_SIDE)
def test_mates_that_are_no_one_joint_are_kept_by_several(tmp_path, mates, kinds):
    """Along a finite motion all mates are kept: loops close to 1e-14 of the size, of which 1e-11 is a wide margin."""
    mechanism = mechanism_of(tmp_path, mates)
    assert sorted(joint.kind for joint in mechanism.all_joints) == kinds
    drive = {
        name: np.linspace(0, 0.02 if is_length(name.rpartition(".")[2]) else 0.3, 4) for name in wheels_last(mechanism)
    }
    motion = mechanism.sweep(drive)
    assert np.all(np.asarray(motion.closed))
    moved = np.asarray(motion.transforms["part"])
    assert np.abs(moved[-1] - np.eye(4)).max() > 1e-3
    for pose in moved:
        for each in mates:
            if each[1][0] == each[2][0] == "point" and kinds[0] == "cartesian":
                left = np.linalg.norm(pose[:3, :3] @ each[2][1] + pose[:3, 3]) - 0.1
            else:
                left = residual(each, pose[:3, :3], pose[:3, 3])
            np.testing.assert_allclose(left, 0, atol=1e-11)


def test_a_point_on_a_circle_stays_in_its_plane_and_at_its_distance(tmp_path):
    """It was left out, and its part stood still: it is no joint by itself."""
    on_edge = mate("Coincident", "m", ("base", "circle", (0, 0, 0), Z), ("part", "point", (0.1, 0, 0), Z))
    mechanism = load(tmp_path, TREE, mates=on_edge).mechanism()
    assert sorted(joint.kind for joint in mechanism.all_joints) == ["contact d", "contact j"]
    assert mechanism.mobility().freedoms == 4 and not any("left out" in note for note in mechanism.notes)


def test_the_joint_by_hand_that_the_note_on_a_mate_asks_for_takes_its_place(tmp_path):
    """A point on a cone, whose half-angle the export does not say."""
    mates = mate("Coincident", "m", ("base", "cone", (0, 0, 0), Z), ("part", "point", (0.1, 0, 0.2), Z))
    assembly = load(tmp_path, TREE, mates=mates + mate("Parallel", "up", ("base", *plane(Z)), ("part", *plane(Z))))
    (note,) = [each for each in assembly.mechanism().notes if "not understood" in each]
    assert "joint by hand between the two (joints=)" in note
    slide = jk.prismatic("slide", "base", "part", axis=(0.1, 0, 0.2))
    mechanism = assembly.mechanism(joints=[slide])
    assert [joint.name for joint in mechanism.all_joints] == ["slide"]
    assert any("replaces Parallel 'up'" in note for note in mechanism.notes)


def test_a_parallel_mate_keeps_a_part_level_in_a_loop(tmp_path):
    """A plate on two balls of cranks of equal length, kept level: the mate was left out, and the plate could tip."""
    tree = instance("base", grounded="true") + instance("crank") + instance("plate")
    mates = mate("Concentric", "pin", ("base", "line", (0, 0, 0), Z), ("crank", "line", (0, 0, 0), Z))
    mates += mate("Coincident", "face", ("base", *plane(Z)), ("crank", *plane(Z)))
    mates += mate("Coincident", "ball", ("crank", "point", (0.1, 0, 0), Z), ("plate", "point", (0.1, 0, 0), Z))
    mates += mate("Parallel", "front", ("base", *plane(X)), ("plate", *plane(X)))
    mates += mate("Parallel", "level", ("base", *plane(Z)), ("plate", *plane(Z)))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert mechanism.mobility().freedoms == 1
    motion = mechanism.sweep({"base-crank": np.linspace(0, 1, 5)})
    np.testing.assert_allclose(
        np.asarray(motion.transforms["plate"])[:, :3, :3], np.eye(3)[None].repeat(5, 0), atol=1e-12
    )
