"""Mates of CAD systems: what each leaves free, and what those of two parts amount to together."""

import numpy as np
import pytest

from reference.exported import X, Y, Z, instance, load, mate


def hinge(name, one, other, point):
    """A concentric mate of a pin and its hole, and a coincident one of two faces: a revolute joint about z."""
    return mate("Concentric", f"{name} pin", (one, "cylinder", point, Z), (other, "cylinder", point, Z)) + mate(
        "Coincident", f"{name} face", (one, "plane", point, Z), (other, "plane", point, Z)
    )


@pytest.mark.long
def test_mates_of_two_parts_are_intersected(tmp_path):
    """A slider-crank of mates only: x = r cos(q) + sqrt(l^2 - r^2 sin(q)^2)."""
    r, length = 0.03, 0.1
    crank, slider = (r, 0, 0), (r + length, 0, 0)
    tree = instance("base", grounded="true") + instance("crank") + instance("rod") + instance("slider")
    rail = mate("Coincident", "floor", ("base", "plane", (0, 0, 0), Z), ("slider", "plane", (0, 0, 0), Z))
    rail += mate("Distance", "wall", ("base", "plane", (0, 0.02, 0), Y), ("slider", "plane", (0, 0.01, 0), Y))
    mates = (
        hinge("A", "base", "crank", (0, 0, 0)) + hinge("B", "crank", "rod", crank) + hinge("C", "rod", "slider", slider)
    )
    mechanism = load(tmp_path, tree, mates=mates + rail).mechanism()
    kinds = {joint.parts: joint.kind for joint in mechanism.all_joints}
    assert sorted(kinds.values()) == ["prismatic", "revolute", "revolute", "revolute"]
    q = np.linspace(0, 2 * np.pi, 37)
    motion = mechanism.sweep({"base-crank": q})
    x = np.array(motion.transforms["slider"])[:, 0, 3] + slider[0]
    np.testing.assert_allclose(x, r * np.cos(q) + np.sqrt(length**2 - (r * np.sin(q)) ** 2), atol=1e-12)


PLANE, LINE, POINT = ("plane", (0, 0, 0), Z), ("line", (0, 0, 0), X), ("point", (0, 0, 0), Z)
CONE = ("cone", (0, 0, 0), Z)


@pytest.mark.parametrize(
    ("kind", "one", "other", "freedoms"),
    [
        ("Coincident", PLANE, PLANE, 3),
        ("Coincident", PLANE, LINE, 4),
        ("Coincident", PLANE, POINT, 5),
        ("Concentric", LINE, LINE, 2),
        ("Distance", LINE, ("line", (0, 0.1, 0), X), 3),
        ("Distance", LINE, ("line", (0, 0, 0.1), Y), 5),
        ("Coincident", LINE, POINT, 4),
        ("Distance", LINE, ("point", (0.2, 0.1, 0), Z), 5),
        ("Concentric", POINT, ("sphere", (0, 0, 0), Z), 3),
        ("Distance", POINT, ("point", (0, 0.1, 0), Z), 5),
        ("Tangent", PLANE, ("cylinder", (0, 0, 0.1), X), 4),
        ("Coincident", ("circle", (0, 0, 0), Z), ("circle", (0, 0, 0), (0, 0, -1)), 1),
        ("Coincident", ("circle", (0.1, 0, 0), Z), PLANE, 3),
        ("Coincident", CONE, ("cone", (0, 0, 0.2), (0, 0, -1)), 1),
        ("Distance", CONE, ("cone", (0, 0, 0.2), Z), 1),
        ("Concentric", CONE, ("cone", (0, 0, 0.2), Z), 2),
        ("Coincident", CONE, ("circle", (0, 0, 0.2), Z), 1),
        ("Coincident", CONE, ("line", (0, 0, 0.2), Z), 2),
        ("Tangent", CONE, ("sphere", (0, 0, 0.2), Z), 3),
        ("Concentric", CONE, ("point", (0, 0, 0.2), Z), 4),
        ("Lock", POINT, POINT, 0),
    ],
)
@pytest.mark.parametrize("swapped", [False, True])
def test_each_mate_leaves_its_freedoms(tmp_path, kind, one, other, freedoms, swapped):
    tree = instance("base", grounded="true") + instance("part", (0.3, 0, 0)).replace("0.3", "0")
    sides = (("part", *one), ("base", *other)) if swapped else (("base", *one), ("part", *other))
    mechanism = load(tmp_path, tree, mates=mate(kind, "m", *sides)).mechanism()
    assert mechanism.mobility().freedoms == freedoms


@pytest.mark.parametrize(
    ("kind", "other"),
    [
        ("Coincident", ("point", (0.1, 0, 0.2), Z)),
        ("Tangent", ("plane", (0, 0, 0.2), X)),
        ("Tangent", ("sphere", (0.1, 0, 0.2), Z)),
        ("Distance", ("cone", (0.1, 0, 0.2), Z)),
        ("Coincident", ("line", (0.1, 0, 0.2), (0.5, 0, 1))),
    ],
)
def test_what_touches_a_cone_beside_its_axis_is_named(tmp_path, kind, other):
    """It moves along a ruling, at an angle that exporters do not say; it was taken to keep its distance."""
    tree = instance("base", grounded="true") + instance("part")
    mechanism = load(tmp_path, tree, mates=mate(kind, "m", ("base", *CONE), ("part", *other))).mechanism()
    assert any(f"{kind} 'm' of a cone and a" in note and "not understood" in note for note in mechanism.notes)


@pytest.mark.parametrize(("kind", "axis"), [("Parallel", X), ("Perpendicular", Y)])
def test_mates_of_angles_count_with_others(tmp_path, kind, axis):
    """A pin in its hole, kept from turning; alone: `test_exported_angles`."""
    tree = instance("base", grounded="true") + instance("part")
    angle = mate(kind, "square", ("base", "plane", (0, 0, 0), X), ("part", "plane", (0, 0, 0), axis))
    pin = mate("Concentric", "pin", ("base", "line", (0, 0, 0), Z), ("part", "line", (0, 0, 0), Z))
    (found,) = load(tmp_path, tree, mates=pin + angle).mechanism().all_joints
    assert found.kind == "prismatic"


def test_mates_that_exporters_have_no_name_for_are_read_by_their_own(tmp_path):
    """A lock comes without geometry, and a limit as a distance."""
    tree = instance("base", grounded="true") + instance("slide") + instance("knob")
    nothing = "".join(
        f'<ConstraintGeometry geomType="Unknown"><InstancePath><Uid>{uid}</Uid></InstancePath></ConstraintGeometry>'
        for uid in ("slide", "knob")
    )
    mates = f'<UnknownConstraint name="Lock3">{nothing}</UnknownConstraint>'
    mates += mate("Distance", "LimitDistance1", ("base", *PLANE), ("slide", *PLANE))
    mates += mate("Concentric", "pin", ("base", *LINE), ("slide", *LINE))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert mechanism.bodies["slide"] == ("slide", "knob")
    assert mechanism.mobility().freedoms == 2
    for said in ("'Lock3' between 'slide' and 'knob' is taken for a lock", "'LimitDistance1'"):
        assert any(said in note for note in mechanism.notes)


@pytest.mark.parametrize(
    ("name", "geometry", "locks"),
    [
        ("Sperren1", "Unknown", True),
        ("\u30ed\u30c3\u30af1", None, True),  # a lock in Japanese, between two instances
        ("Sperren1", "plane", False),
        ("Gear1", "Unknown", False),
    ],
)
def test_a_lock_is_known_in_any_language_as_it_is_of_two_whole_parts(tmp_path, name, geometry, locks):
    inside = "".join(
        path if geometry is None else f'<ConstraintGeometry geomType="{geometry}">{path}{axis}</ConstraintGeometry>'
        for path in (f"<InstancePath><Uid>{uid}</Uid></InstancePath>" for uid in ("base", "part"))
        for axis in ("<Axis>0 0 1</Axis>" if geometry == "plane" else "",)
    )
    tree = instance("base", grounded="true") + instance("part")
    mates = f'<UnknownConstraint name="{name}">{inside}</UnknownConstraint>'
    mates += mate("Concentric", "pin", ("base", *LINE), ("part", *LINE))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert (len(mechanism.bodies) == 1) == locks
    said = "taken for a lock, since it is of two parts as a whole" if locks else "is not understood"
    assert any(f"{name!r}" in note and said in note for note in mechanism.notes)


def test_mates_with_planes_of_the_assembly_are_with_what_is_held(tmp_path):
    """Exporters name the assembly itself by its own identifier."""
    tree = instance("base", (1, 0, 0), grounded="true") + instance("slide")
    mates = mate("Coincident", "top", ("machine", "plane", (0, 0, 0.5), Z), ("slide", "plane", (0, 0, 0.5), Z))
    (joint,) = load(tmp_path, tree, mates=mates).mechanism().all_joints
    assert joint.kind == "planar" and joint.parts == ("base", "slide")


def beside(feature, by, axis=Z):
    """A feature of the same kind that is moved along x, with another axis."""
    kind, point, _ = feature
    return kind, (point[0] + by, *point[1:]), axis


CIRCLE, CYLINDER, ACROSS = ("circle", (0, 0, 0), Z), ("cylinder", (0, 0, 0), Z), ("plane", (0, 0, 0), X)


@pytest.mark.parametrize(
    ("kind", "one", "other", "found"),
    [
        ("Concentric", CYLINDER, beside(CYLINDER, 1e-3), "cylindrical"),
        ("Concentric", CYLINDER, beside(CYLINDER, 0, (1e-3, 0, 1)), "cylindrical"),
        ("Concentric", ("sphere", (0, 0, 0), Z), ("sphere", (1e-3, 0, 0), Z), "spherical"),
        ("Coincident", POINT, beside(POINT, 0.1), "spherical"),
        ("Coincident", CIRCLE, beside(CIRCLE, 1e-3), "revolute"),
        ("Coincident", ACROSS, beside(ACROSS, 1e-3, X), "planar"),
        ("Coincident", ACROSS, beside(ACROSS, 0, (1, 1e-3, 0)), "planar"),
        ("Coincident", ("line", (0, 0, 0), Z), beside(("point", (0, 0, 0), Z), 1e-3), "contact j"),
    ],
)
def test_features_that_are_to_coincide_and_do_not_are_taken_to_and_named(tmp_path, kind, one, other, found):
    """A centre that is to be in another one is a ball there, and not a rod that is as long as the two are apart."""
    tree = instance("base", grounded="true") + instance("part", (0.5, 0, 0)).replace("0.5", "0")
    mechanism = load(tmp_path, tree, mates=mate(kind, "m", ("base", *one), ("part", *other))).mechanism()
    assert [joint.kind for joint in mechanism.all_joints] == [found]
    assert any(f"{kind} 'm'" in note and "apart as exported" in note for note in mechanism.notes)


def test_features_of_parts_that_lock_each_other_and_do_not_meet_are_named(tmp_path):
    tree = instance("base", grounded="true") + instance("lid")
    mates = "".join(
        mate("Coincident", f"{axis}", ("base", "plane", (0, 0, 0), axis), ("lid", "plane", (0.1, 0, 0), axis))
        for axis in (X, Y, Z)
    )
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert mechanism.mobility().freedoms == 0
    assert any("0.1 and 0 rad apart as exported" in note for note in mechanism.notes)


def test_parts_that_were_modelled_where_they_stand_are_no_small_machine(tmp_path):
    """Mates far from the origin that all parts have: these locked parts had a slide, as of a machine of 1 mm."""
    tree, slanted = instance("base", grounded="true") + instance("part"), (0.26, -0.91, 0.33)
    pin, end = (-0.12, -0.08, 0.19), (-0.12, -0.08, 0.24)
    mates = mate("Parallel", "up", ("base", *ACROSS), ("part", *ACROSS))
    mates += mate(
        "Distance",
        "face",
        ("base", "plane", (-0.19, 0.12, 0.16), slanted),
        ("part", "plane", (0.2, -0.2, 0.1), slanted),
    )
    mates += mate("Coincident", "pin", ("base", "line", pin, Z), ("part", "point", end, Z))
    assert load(tmp_path, tree, mates=mates).mechanism().mobility().freedoms == 0


@pytest.mark.parametrize(("kind", "axis"), [("Parallel", (1, 1, 0)), ("Perpendicular", (1, 1, 0))])
def test_mates_of_angles_that_do_not_hold_are_named(tmp_path, kind, axis):
    tree = instance("base", grounded="true") + instance("part")
    mates = mate("Concentric", "pin", ("base", *CYLINDER), ("part", *CYLINDER))
    mates += mate(kind, "square", ("base", *ACROSS), ("part", "plane", (0, 0, 0), axis))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert [joint.kind for joint in mechanism.all_joints] == ["prismatic"]
    assert any(f"{kind} 'square'" in note and "0.79 rad apart as exported" in note for note in mechanism.notes)


def test_points_on_round_faces_keep_their_distance_and_are_no_error(tmp_path):
    tree = instance("base", grounded="true") + instance("part", (0.5, 0, 0)).replace("0.5", "0")
    on_face = mate("Coincident", "m", ("base", *CYLINDER), ("part", "point", (0.1, 0, 0), Z))
    mechanism = load(tmp_path, tree, mates=on_face).mechanism()
    assert mechanism.mobility().freedoms == 5
    on_edge = mate("Coincident", "m", ("base", *CIRCLE), ("part", "point", (0.1, 0, 0), Z))
    upright = mate("Parallel", "up", ("base", *ACROSS), ("part", *ACROSS))
    upright += mate("Parallel", "level", ("base", *PLANE), ("part", *PLANE))
    noted = load(tmp_path, tree, mates=on_edge + upright).mechanism().notes
    assert not any("apart" in note for note in (*mechanism.notes, *noted))


def test_a_ball_and_two_lines_that_stay_perpendicular_are_a_universal_joint(tmp_path):
    tree = instance("fork", grounded="true") + instance("shaft")
    mates = mate("Coincident", "centre", ("shaft", *POINT), ("fork", *POINT))
    mates += mate("Perpendicular", "cross", ("fork", "line", (0, 0, 0), Z), ("shaft", "line", (0, 0, 0), X))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    (joint,) = mechanism.all_joints
    assert (joint.kind, joint.parts) == ("universal", ("fork", "shaft"))
    turned = mechanism.sweep({f"{joint.name}.phi": np.array([0.0, 0.7]), f"{joint.name}.theta": np.array([0.0, 0.4])})
    assert abs(np.asarray(turned.transforms["shaft"])[-1, :3, :3] @ X @ Z) < 1e-12
    assert not any("left out" in note for note in mechanism.notes)


@pytest.mark.parametrize(
    "name", ["LimitDistance1", "Distance limite 2", "Dist\u00e1ncia l\u00edmite1", "\u9650\u5236\u8ddd\u79bb1"]
)
def test_limits_are_known_in_other_languages(tmp_path, name):
    tree = instance("base", grounded="true") + instance("part")
    mates = mate("Concentric", "pin", ("base", *CYLINDER), ("part", *CYLINDER))
    mates += mate("Distance", name, ("base", *PLANE), ("part", "plane", (0, 0, 0.1), Z))
    mechanism = load(tmp_path, tree, mates=mates).mechanism()
    assert [joint.kind for joint in mechanism.all_joints] == ["cylindrical"]
    assert any(name in note and "limit" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", range(6))
def test_mates_that_repeat_each_other_are_one_joint_with_numbers_of_six_digits(tmp_path, seed):
    """A slide of two pairs of faces and two parallel mates, of parts that stand askew in the assembly."""
    random = np.random.default_rng(seed)
    z, x, y = np.linalg.qr(random.normal(size=(3, 3)))[0].T
    places = {name: np.linalg.qr(random.normal(size=(3, 3)))[0] for name in ("base", "slide")}
    places = {name: turn * np.sign(np.linalg.det(turn)) for name, turn in places.items()}

    def six(numbers):
        return " ".join(f"{number:.6f}" for number in np.ravel(numbers))

    tree = "".join(
        instance(name, grounded=str(name == "base").lower()).replace("1 0 0 0 1 0 0 0 1", six(turn))
        for name, turn in places.items()
    )
    mates = ""
    for number, (kind, normal) in enumerate([("Coincident", x), ("Coincident", y), ("Parallel", x), ("Parallel", z)]):
        sides = []
        for name, turn in places.items():
            point = np.cross(normal, random.normal(size=3)) * 0.1
            local = [np.array(six(turn.T @ each).split(), float) for each in (point, normal)]
            sides.append((name, "plane", *local))
        mates += mate(kind, f"m{number}", *sides)
    (joint,) = load(tmp_path, tree, mates=mates).mechanism().all_joints
    assert joint.kind == "prismatic"
    assert np.linalg.norm(np.cross(np.asarray(joint.frames_1)[0, :3, 2], z)) < 1e-5  # a few roundings of 5e-7


def solved(kind, name, one, point, axis, error):
    """A mate of the part that stands as systems solve it, turned about the origin by a small vector, with the base."""

    def on_part(vector):
        return np.asarray(vector, float) + np.cross(error, vector)

    sides = [("base", one, point, axis), ("part", one, on_part(point), on_part(axis))]
    return mate(kind, name, *sides[:: -1 if len(name) % 2 else 1])  # either side may come first


@pytest.mark.parametrize("error", [(5e-6, 0, 0), (0, 5e-6, 0), (4e-6, -3e-6, 1e-6)])
def test_mates_that_are_solved_to_a_few_millionths_lock_nothing_that_turns(tmp_path, error):
    tree = instance("base", grounded="true") + instance("part") + instance("far", (0.5, 0, 0), grounded="true")
    mates = solved("Concentric", "pin", "cylinder", (0, 0, 0.1), Z, error)
    mates += solved("Coincident", "face", "plane", (0, 0, 0), Z, error)
    mates += solved("Parallel", "level", "plane", (0, 0, 0), Z, error)
    mates += solved("Coincident", "axis", "line", (0, 0, 0), Z, error)
    assert [joint.kind for joint in load(tmp_path, tree, mates=mates).mechanism().all_joints] == ["revolute"]
