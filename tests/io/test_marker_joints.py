"""Joints between two markers, held against the equations of FreeCAD's solver on the poses of the markers."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import rotation
from reference.mates import turned as by_vector

RANDOM = np.random.default_rng(0)
X, Y, Z = SAME = np.eye(3)


def pose(turn=SAME, point=(0.0, 0.0, 0.0)):
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = turn, point
    return made


def turned(x=0.0, y=0.0, z=0.0):
    return rotation(Z, z) @ rotation(Y, y) @ rotation(X, x)


def place(depth, at):
    rows = [at[:3, 3], *at[:3, :3]]
    lines = ["\t".join(map(repr, map(float, row))) for row in rows]
    tab = "\t" * depth
    return f"{tab}Position3D\n{tab}\t{lines[0]}\n{tab}RotationMatrix\n" + "".join(
        f"{tab}\t{row}\n" for row in lines[1:]
    )


def marks(depth, markers):
    tab = "\t" * depth
    said = "".join(
        f"{tab}\t\t\tMarker\n{tab}\t\t\t\tName\n{tab}\t\t\t\t\t{name}\n{place(depth + 4, at)}"
        for name, at in markers.items()
    )
    return f"{tab}RefPoints\n{tab}\tRefPoint\n{place(depth + 2, np.eye(4))}{tab}\t\tMarkers\n{said}"


def assembly(folder, world, parts, joints):
    """Write and load an assembly: markers in world coordinates, by part; joints (kind, name, I, J, {key: number})."""
    text = f"OndselSolver\nAssembly\n\tName\n\t\tA\n{place(1, np.eye(4))}{marks(1, world)}\tParts\n"
    for part, markers in parts.items():
        text += f"\t\tPart\n\t\t\tName\n\t\t\t\t{part}\n{place(3, np.eye(4))}{marks(3, markers)}"
    text += "\tConstraintSets\n\t\tJoints\n"
    for kind, name, one, other, sizes in joints:
        said = {"Name": name, "MarkerI": f"/A/{one}", "MarkerJ": f"/A/{other}", **sizes}
        text += f"\t\t\t{kind}\n" + "".join(f"\t\t\t\t{key}\n\t\t\t\t\t{value}\n" for key, value in said.items())
    (folder / "a.asmt").write_text(f"{text}\tForceTorques\n")
    return jk.load(folder / "a.asmt")


ANY = turned(0.4, -0.7, 1.1)
RIGHT = turned(0.0, np.pi / 2, 0.0) @ turned(0.3, 0.0, 0.0)
"""A rotation that makes the z axis perpendicular to itself."""

CASES = {
    # of the rod between two points, 6 freedoms: it spins about itself
    # kind: (place of J in I, sizes, equations of I^-1 J, freedoms, whether opposite axes are the same joint)
    "PointInLineJoint": (pose(ANY, (0, 0, 0.6)), {}, lambda r, p: p[:2], 4, False),
    "PointInPlaneJoint": (pose(ANY, (0.3, 0.5, 0.2)), {"offset": 0.2}, lambda r, p: [p[2] - 0.2], 5, False),
    "LineInPlaneJoint": (pose(RIGHT, (0.3, 0.5, 0.2)), {"offset": 0.2}, lambda r, p: [p[2] - 0.2, r[2, 2]], 4, False),
    "ParallelAxesJoint": (pose(turned(z=0.5), (0.3, 0.5, 0.2)), {}, lambda r, p: r[2, :2], 4, True),
    "PerpendicularJoint": (pose(RIGHT, (0.3, 0.5, 0.2)), {}, lambda r, p: [r[2, 2]], 5, False),
    "AngleJoint": (pose(turned(0.7, 0.0, 0.4), (0.3, 0.5, 0.2)), {"theIzJz": 0.7}, lambda r, p: [r[2, 2] - np.cos(0.7)],
                   5, False),
    "NoRotationJoint": (pose(np.eye(3), (0.3, 0.5, 0.2)), {}, lambda r, p: [r[0, 1], r[1, 2], r[2, 0]], 3, True),
    "SphSphJoint": (pose(ANY, (0.3, 0.4, 1.2)), {"distanceIJ": 1.3}, lambda r, p: [p @ p - 1.69], 6, False),
    "CylSphJoint": (pose(ANY, (0.3, 0.4, 1.2)), {"distanceIJ": 0.5}, lambda r, p: [p[:2] @ p[:2] - 0.25], 5, False),
    "RevCylJoint": (pose(turned(z=0.5), (0.3, 0.4, 1.2)), {"distanceIJ": 0.5},
                    lambda r, p: [p[:2] @ p[:2] - 0.25, *r[2, :2]], 3, True),
    "RevRevJoint": (pose(turned(z=0.5), (0.3, 0.4, 0)), {"distanceIJ": 0.5},
                    lambda r, p: [p[:2] @ p[:2] - 0.25, p[2], *r[2, :2]], 2, True),
    "RevoluteJoint": (pose(turned(z=0.5)), {}, lambda r, p: [*p, *r[2, :2]], 1, True),
    "TranslationalJoint": (pose(np.eye(3), (0, 0, 0.7)), {}, lambda r, p: [*p[:2], r[0, 1], r[1, 2], r[2, 0]], 1, True),
}  # fmt: skip


def drive_of(mechanism, poses):
    """Give each coordinate of an open chain a path from zero."""
    given = {}
    for joint in mechanism.all_joints:
        for name in joint.coordinates:
            given[f"{joint.name}.{name}"] = RANDOM.uniform(-0.5, 0.5) * np.linspace(0, 1, poses)
    return given


@pytest.mark.parametrize(
    ("kind", "opposite"),
    [(kind, side) for kind, case in CASES.items() for side in ([False, True] if case[4] else [False])],
)
def test_what_a_joint_demands_of_its_markers_holds_however_it_moves(tmp_path, kind, opposite):
    local, sizes, equations, freedoms, _ = CASES[kind]
    one = pose(turned(0.2, 0.9, -0.4), (1.0, 2.0, 3.0))
    other = one @ local @ (pose(turned(x=np.pi)) if opposite else np.eye(4))
    loaded = assembly(tmp_path, {"I": one}, {"part": {"J": other}}, [(kind, "j", "I", "part/J", sizes)])
    mechanism = loaded.mechanism()
    assert not loaded.exported.notes  # nothing had to be moved
    assert mechanism.mobility().useful == freedoms
    there = mechanism.sweep(drive_of(mechanism, 4)).transforms["part"] @ other
    found = [equations(each[:3, :3], each[:3, 3]) for each in np.linalg.inv(one) @ there]
    assert np.abs(there[-1] - there[0]).max() > 1e-2
    np.testing.assert_allclose(found, 0.0, atol=1e-13)  # numbers of order one, a chain of at most three joints


@pytest.mark.parametrize(
    ("kind", "found"),
    [("ParallelAxesJoint", "schoenflies"), ("PerpendicularJoint", "constant angle"), ("AngleJoint", "constant angle"),
     ("NoRotationJoint", "cartesian")],
)  # fmt: skip
def test_what_keeps_directions_only_is_one_joint_without_a_part_between(tmp_path, kind, found):
    local, sizes, *_ = CASES[kind]
    joints = [(kind, "j", "I", "part/J", sizes)]
    mechanism = assembly(tmp_path, {"I": np.eye(4)}, {"part": {"J": local}}, joints).mechanism()
    assert mechanism.parts == ("world", "part") and [joint.kind for joint in mechanism.all_joints] == [found]


@pytest.mark.parametrize("angle", [0.0, np.pi])
def test_an_angle_of_no_or_half_a_turn_takes_two_freedoms(tmp_path, angle):
    """The cosine of the solver is 1 or -1 where the axes are parallel or opposite, and nowhere else."""
    local = pose(turned(x=angle, z=0.5), (0.3, 0.5, 0.2))
    joints = [("AngleJoint", "j", "I", "part/J", {"theIzJz": repr(angle)})]
    loaded = assembly(tmp_path, {"I": np.eye(4)}, {"part": {"J": local}}, joints)
    mechanism = loaded.mechanism()
    assert not loaded.exported.notes and mechanism.mobility().freedoms == 4
    there = mechanism.sweep(drive_of(mechanism, 4)).transforms["part"] @ local
    np.testing.assert_allclose(there[:, 2, 2], np.cos(angle), atol=1e-15)


@pytest.mark.parametrize(
    ("joints", "message"),
    [
        ([("AngleJoint", "j", "I", "part/J", {})], r"a\.asmt: AngleJoint 'j': theIzJz: expected 1 finite number"),
        ([("RevoluteJoint", "j", "I", "part/J", {})] * 2, r"a\.asmt: RevoluteJoint 'j': another joint is called 'j'"),
    ],
)
def test_joints_without_their_angle_and_of_one_name_are_refused(tmp_path, joints, message):
    """The second joint of a name was taken in place of the first one, without a word."""
    with pytest.raises(ValueError, match=message):
        assembly(tmp_path, {"I": np.eye(4)}, {"part": {"J": np.eye(4)}}, joints)


def test_axes_that_are_opposite_where_they_are_to_be_parallel_are_turned(tmp_path):
    """Unlike parallel axes, those at an angle of zero have a sense."""
    local = pose(turned(x=np.pi))
    for kind, moved in (("AngleJoint", True), ("ParallelAxesJoint", False)):
        joints = [(kind, "j", "I", "part/J", {"theIzJz": "0.0"} if moved else {})]
        loaded = assembly(tmp_path, {"I": np.eye(4)}, {"part": {"J": local}}, joints)
        assert any("the pose of the file is open; closed" in note for note in loaded.exported.notes) == moved


@pytest.mark.parametrize(
    ("joints", "kind", "freedoms"),
    [
        (["SphericalJoint", "PerpendicularJoint"], "universal", 2),
        (["SphericalJoint", "ParallelAxesJoint"], "revolute", 1),
        (["CylindricalJoint", "NoRotationJoint"], "prismatic", 1),
        (["PlanarJoint", "NoRotationJoint"], "rectangular", 2),
        (["ParallelAxesJoint", "AngleJoint"], "schoenflies", 4),
    ],
)
def test_joints_between_the_same_two_parts_are_the_one_that_they_amount_to(tmp_path, joints, kind, freedoms):
    """Of two markers each, the second pair turned about x of the first where its axes are not parallel."""
    other = {"PerpendicularJoint": turned(x=np.pi / 2), "AngleJoint": turned(x=0.7)}
    world = {f"I{number}": np.eye(4) for number, _ in enumerate(joints)}
    markers = {f"J{number}": pose(other.get(name, np.eye(3))) for number, name in enumerate(joints)}
    sizes = {"AngleJoint": {"theIzJz": "0.7"}}
    said = [
        (name, f"j{number}", f"I{number}", f"part/J{number}", sizes.get(name, {})) for number, name in enumerate(joints)
    ]
    mechanism = assembly(tmp_path, world, {"part": markers}, said).mechanism()
    assert [joint.kind for joint in mechanism.all_joints] == [kind]
    assert mechanism.mobility().freedoms == freedoms


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_random_joints_of_two_parts_leave_the_freedoms_of_their_equations(tmp_path, seed):
    """Six less the rank, by central differences (errors of 1e-10), and the spin of each rod; half along the axes."""
    random = np.random.default_rng(seed)
    for _ in range(8):
        kinds = [str(kind) for kind in random.choice([*CASES], random.integers(1, 4))]
        turns = np.where(random.random(len(kinds)) < 0.5, random.integers(0, 4, (3, len(kinds))) * np.pi / 2, 1.0)
        ones = [pose(turned(*turn), random.uniform(-1, 1, 3)) for turn in turns.T]
        ends = [one @ CASES[kind][0] for one, kind in zip(ones, kinds, strict=True)]

        def left(twist, kinds=kinds, ones=ones, ends=ends):
            there = np.linalg.inv(ones) @ pose(by_vector(twist[:3]), twist[3:]) @ ends
            equations = [CASES[kind][2] for kind in kinds]
            return np.concatenate([own(at[:3, :3], at[:3, 3]) for own, at in zip(equations, there, strict=True)])

        slopes = np.array([(left(1e-5 * unit) - left(-1e-5 * unit)) / 2e-5 for unit in np.eye(6)])
        world, part = ({f"M{k}": at for k, at in enumerate(side)} for side in (ones, ends))
        said = [(kind, f"j{k}", f"M{k}", f"part/M{k}", CASES[kind][1]) for k, kind in enumerate(kinds)]
        mechanism = assembly(tmp_path, world, {"part": part}, said).mechanism()
        expected = 6 - np.linalg.matrix_rank(slopes, tol=1e-7) + kinds.count("SphSphJoint")
        assert mechanism.mobility().freedoms == expected, kinds


@pytest.mark.parametrize(
    ("kind", "same"), [("SphSphJoint", "spherical"), ("RevCylJoint", "cylindrical"), ("RevRevJoint", "revolute")]
)
def test_a_distance_of_zero_is_the_joint_without_a_rod(tmp_path, kind, same):
    joints = [(kind, "j", "I", "part/J", {"distanceIJ": 0.0})]
    mechanism = assembly(tmp_path, {"I": np.eye(4)}, {"part": {"J": np.eye(4)}}, joints).mechanism()
    assert str(mechanism.joints["j"].kind) == same


def orbit(one, other):
    """Measure the angle of the origin of the second marker about the z axis of the first one."""
    x, y, _ = np.moveaxis((np.linalg.inv(one) @ other)[:, :3, 3], -1, 0)
    return np.unwrap(np.arctan2(y, x))


def about(one, other):
    """Measure the angle of the second marker about the z axis of the first one."""
    turn = np.linalg.inv(one) @ other
    return np.unwrap(np.arctan2(turn[:, 1, 0], turn[:, 0, 0]))


@pytest.mark.long
@pytest.mark.parametrize("belt", [1.0, -1.0])
@pytest.mark.parametrize("flipped", [False, True])
def test_gears_and_belts_obey_the_solver_on_a_carrier_that_moves(tmp_path, belt, flipped):
    at = {"a": pose(turned(z=0.3), (0, 0, 0)), "b": pose(turned(z=-1.0), (0.9, 0.3, 0))}
    wheel = at["b"] @ (pose(turned(x=np.pi)) if flipped else np.eye(4))  # its own axis the other way round
    parts = {"arm": {"O": np.eye(4), "A": at["a"], "B": at["b"]}, "a": {"J": at["a"]}, "b": {"J": wheel}}
    joints = [
        ("RevoluteJoint", "arm", "O", "arm/O", {}),
        ("RevoluteJoint", "left", "a/J", "arm/A", {}),  # the carrier second
        ("CylindricalJoint", "right", "arm/B", "b/J", {}),
        ("GearJoint", "teeth", "a/J", "b/J", {"radiusI": 0.7, "radiusJ": belt * 0.25}),
    ]
    loaded = assembly(tmp_path, {"O": np.eye(4)}, parts, joints)
    mechanism = loaded.mechanism()
    (coupling,) = mechanism.linkage.couplings
    assert coupling.name == "teeth" and not loaded.exported.notes
    path = np.linspace(0, 1, 9)
    motion = mechanism.sweep({"arm": 0.8 * path, "left": 2.5 * path, "right.z": 0.0 * path})
    assert motion.closed.all()
    a, b = motion.transforms["a"] @ at["a"], motion.transforms["b"] @ wheel
    kept = 0.7 * orbit(a, b) + belt * 0.25 * orbit(b, a)
    np.testing.assert_allclose(kept, kept[0], atol=1e-12)  # angles of some radians
    assert np.ptp(orbit(a, b)) > 1


def test_a_rack_rolls_its_pinion_as_in_the_solver(tmp_path):
    rack, pinion = pose(turned(z=0.0), (0.2, -0.5, 0)), pose(turned(z=0.8), (0, 0, 0))
    parts = {"rack": {"J": rack, "S": pose(turned(y=np.pi / 2), (0, -0.5, 0))}, "pinion": {"J": pinion}}
    world = {"O": pose(), "S": pose(turned(y=np.pi / 2), (0, -0.5, 0))}
    joints = [
        ("TranslationalJoint", "slide", "rack/S", "S", {}),
        ("RevoluteJoint", "turn", "O", "pinion/J", {}),
        ("RackPinionJoint", "teeth", "rack/J", "pinion/J", {"pitchRadius": 0.5}),
    ]
    mechanism = assembly(tmp_path, world, parts, joints).mechanism()
    motion = mechanism.sweep({"turn": np.linspace(0, 4, 9)})
    one, other = motion.transforms["rack"] @ rack, motion.transforms["pinion"] @ pinion
    kept = (np.linalg.inv(one) @ other)[:, 0, 3] + 0.5 * about(one, other)
    np.testing.assert_allclose(kept, kept[0], atol=1e-12)
    # the teeth do not slip: the lowest point of the pinion moves as the rack does
    np.testing.assert_allclose(motion.transforms["rack"][-1, 0, 3], 0.5 * 4, atol=1e-12)


@pytest.mark.parametrize("slides", [True, False])
def test_a_screw_between_a_slide_and_a_turn_obeys_the_solver(tmp_path, slides):
    nut, spindle = pose(turned(z=0.3), (0, 0, 0.4)), pose(turned(z=0.1), (0, 0, 0))
    parts = {"nut": {"J": nut}, "spindle": {"J": spindle}}
    ends = ("nut/J", "spindle/J") if slides else ("spindle/J", "nut/J")
    joints = [
        ("TranslationalJoint", "slide", "S", "nut/J", {}),
        ("RevoluteJoint", "turn", "spindle/J", "O", {}),
        ("ScrewJoint", "thread", *ends, {"pitch": 0.06}),
    ]
    mechanism = assembly(tmp_path, {"O": pose(), "S": pose(turned(z=0.3))}, parts, joints).mechanism()
    motion = mechanism.sweep({"turn": np.linspace(0, 6, 9)})
    at = {"nut/J": motion.transforms["nut"] @ nut, "spindle/J": motion.transforms["spindle"] @ spindle}
    one, other = at[ends[0]], at[ends[1]]
    kept = 2 * np.pi * (np.linalg.inv(one) @ other)[:, 2, 3] - 0.06 * about(one, other)
    np.testing.assert_allclose(kept, kept[0], atol=1e-12)
    assert abs(motion.transforms["nut"][-1, 2, 3]) > 0.05


@pytest.mark.parametrize(
    ("tie", "why"),
    [
        (("GearJoint", "t", "a/J", "b/J", {"radiusI": 1.0, "radiusJ": 1.0}), "no two joints that turn its parts"),
        (("GearJoint", "t", "a/J", "b/J", {"radiusI": 0.0, "radiusJ": 1.0}), "its radius_i is zero"),
        (("RackPinionJoint", "t", "a/J", "b/J", {"pitchRadius": 1.0}), "no joint that slides the rack"),
        (("ScrewJoint", "t", "a/J", "b/J", {"pitch": 1.0}), "no cylindrical joint between its parts"),
        (("ConstantVelocityJoint", "t", "a/J", "b/J", {}), "ConstantVelocityJoint 't' is not kept"),
    ],
)
def test_what_cannot_be_tied_is_named(tmp_path, tie, why):
    parts = {"a": {"J": np.eye(4)}, "b": {"J": pose(point=(1, 0, 0))}}
    joints = [("RevoluteJoint", "left", "O", "a/J", {}), ("SphericalJoint", "right", "P", "b/J", {}), tie]
    mechanism = assembly(tmp_path, {"O": np.eye(4), "P": pose(point=(1, 0, 0))}, parts, joints).mechanism()
    assert not mechanism.linkage.couplings
    assert any(why in note for note in mechanism.notes)
