"""What a user says about the parts of an assembly: fixed, rigid, ignored, joined by hand."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.assembly.joined import _alignment_notes
from jaxkin.examples import EXAMPLES, path
from jaxkin.joints.from_contacts import FoundJoints

TURN = np.linspace(0.0, 1.0, 5)
DRIVE = {"ground-crank": TURN}


@pytest.fixture(scope="module")
def fourbar():
    return jk.load(path("fourbar"))


@pytest.fixture(scope="module")
def motion(fourbar):
    return fourbar.mechanism(fixed=["ground"]).sweep(DRIVE)


def split(assembly, name):
    """The assembly with a part cut in two: its cylinders, and all its other faces."""
    parts = []
    for part in assembly.parts:
        if part.name != name:
            parts.append(part)
            continue
        for suffix, wanted in (("", True), (" pins", False)):
            faces = tuple(face for face in part.faces if (face.surface.kind != "cylinder") == wanted)
            triangles = np.concatenate([face.triangles for face in faces])
            parts.append(replace(part, name=name + suffix, faces=faces, triangles=triangles))
    return replace(assembly, parts=tuple(parts))


def same(motion, other):
    """Transforms in mm: the frames are the same, so only rounding differs."""
    assert np.all(other.closed)
    for part, transforms in motion.transforms.items():
        np.testing.assert_allclose(other.transforms[part], transforms, atol=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("cut", ["crank", "coupler"])
def test_a_part_in_two_rigid_pieces_moves_as_one(fourbar, motion, cut):
    """Each hinge then rests on a face of one piece and a pin of the other: only together are they a hinge."""
    pieces = split(fourbar, cut).mechanism(fixed=["ground"], rigid=[[f"{cut} pins", cut]])
    kinds = {joint.name: joint.kind for joint in pieces.all_joints}
    assert list(kinds.values()).count("revolute") == 4
    assert kinds[f"{cut}-{cut} pins"] == "fixed"
    assert any("the same two bodies" in note for note in pieces.notes)
    found = pieces.sweep({next(iter(pieces.joints_between("ground", "crank"))): TURN})
    same(motion, found)
    np.testing.assert_array_equal(found.transforms[f"{cut} pins"], found.transforms[cut])


@pytest.mark.long
def test_several_fixed_parts_are_one(fourbar, motion):
    pieces = split(fourbar, "ground").mechanism(fixed=["ground", "ground pins"])
    assert [joint.kind for joint in pieces.all_joints] == ["revolute"] * 4
    assert len(pieces.structure.loops) == 1
    same(motion, pieces.sweep(DRIVE))


@pytest.mark.long
def test_what_is_rigid_with_a_fixed_part_is_fixed(fourbar):
    mechanism = fourbar.mechanism(fixed=["ground"], rigid=[["crank", "ground"]])
    assert mechanism.fixed == ("ground", "crank")
    assert len(mechanism.all_joints) == 3


def test_groups_that_share_a_part_are_one(fourbar):
    mechanism = fourbar.mechanism(fixed=["ground"], rigid=[["rocker", "coupler"], ["coupler", "crank"]])
    assert {joint.name: joint.kind for joint in mechanism.all_joints} == {
        "ground-crank": "fixed",  # its two hinges allow nothing together
        "crank-coupler": "fixed",
        "crank-rocker": "fixed",
    }
    assert mechanism.mobility().freedoms == 0


def test_ignored_contacts_leave_what_the_others_allow(fourbar):
    """A hinge without the face that it rests on is a pin that slides."""
    contact = next(c for c in fourbar.contacts() if set(c.parts) == {"ground", "crank"} and c.state == "a")
    sides = [f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True)]
    for order in (sides, sides[::-1]):
        mechanism = fourbar.mechanism(fixed=["ground"], ignore=[order])
        assert mechanism.joints["ground-crank"].kind == "cylindrical"
        assert "1 contact ignored, as was asked for" in mechanism.notes
    mechanism = fourbar.mechanism(fixed=["ground"], ignore=[("ground", "crank")])
    assert mechanism.joints_between("ground", "crank") == ()
    assert len(mechanism.structure.loops) == 0


def test_contacts_are_ignored_by_patterns(fourbar):
    """The coupler touches the crank and the rocker, and no pair of an entry needs to touch but one."""
    named = fourbar.mechanism(fixed=["ground"], ignore=[["coupler", "crank"]], infer=False)
    for pattern in (["coup*", "crank"], ["c?ank", "*er"]):
        mechanism = fourbar.mechanism(fixed=["ground"], ignore=[pattern], infer=False)
        assert mechanism.joints_between("coupler", "crank") == named.joints_between("coupler", "crank") == ()
        assert mechanism.joints_between("ground", "crank")
    with pytest.raises(ValueError, match="'crank' touches no other part"):
        fourbar.mechanism(fixed=["ground"], ignore=[["cr*", "*"]], infer=False)


def test_a_face_of_a_part_with_a_slash_in_its_name_is_no_pattern(fourbar):
    parts = [replace(part, name="Nut 5/16") if part.name == "coupler" else part for part in fourbar.parts]
    assembly = replace(fourbar, parts=tuple(parts))
    contact = next(each for each in assembly.contacts() if "Nut 5/16" in each.parts and each.state == "a")
    sides = [f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True)]
    mechanism = assembly.mechanism(fixed=["ground"], ignore=[sides], infer=False)
    assert "1 contact ignored, as was asked for" in mechanism.notes


@pytest.mark.long
def test_a_joint_by_hand_replaces_the_contacts(fourbar, motion):
    hinge = motion.mechanism.joints["ground-crank"]
    place = {"point": hinge.frames_1[0, :3, 3], "axis": hinge.frames_1[0, :3, 2]}
    mechanism = fourbar.mechanism(fixed=["ground"], joints=[jk.revolute("motor", "ground", "crank", **place)])
    assert mechanism.joints_between("ground", "crank") == ("motor",)
    assert "joint 'motor', given by hand, replaces the 2 contacts (a), (e) between its parts" in mechanism.notes
    same(motion, mechanism.sweep({"motor": TURN}))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"rigid": ["crank", "rocker"]}, '[["bolt", "plate"]]'),
        ({"rigid": "crank"}, '[["bolt", "plate"]]'),
        ({"rigid": [["crank"]]}, "two parts or more, got the group ['crank']"),
        ({"rigid": [["crank", "roker"]]}, "rigid names the unknown part 'roker'; did you mean 'rocker'?"),
        ({"ignore": ["crank"]}, '[["slider", "stop"]]'),
        (
            {"ignore": [["crank", "rocker"]]},
            "to ignore, and nothing is inferred there; 'crank' touches",
        ),
        ({"ignore": [["crank", "grund"]]}, "did you mean 'ground'?"),
        ({"ignore": [["crank", "xyz"]]}, "there; there is 'ground', 'crank', 'rocker', 'coupler'"),
        ({"ignore": [["crank", "x*"]]}, "ignore names 'x*', which no part matches"),
        ({"ignore": [["rock*", "cr*"]]}, "no contact between 'rocker' and 'crank' to ignore"),
        ({"ignore": [["crank", "*ock?r"], ["g*", "*upler"]]}, "no contact between 'crank' and 'rocker' to ignore"),
        ({"joints": [jk.fixed("weld", "ground", "cranc")]}, "joint 'weld' names the unknown part 'cranc'; did you"),
        (
            {"joints": [jk.fixed("weld", "coupler", "crank")], "rigid": [["coupler", "crank"]]},
            "joint 'weld' joins parts that are rigidly connected: coupler, crank; leave the joint out (in a study, "
            'off = true in [joints."weld"]), or one of its parts out of rigid or fixed',
        ),
        ({"joints": [jk.fixed("ground-crank", "coupler", "crank")]}, "joint 'ground-crank' is named twice"),
    ],
)
def test_what_makes_no_sense_is_refused(fourbar, options, said):
    with pytest.raises(ValueError) as error:
        fourbar.mechanism(fixed=["ground"], **options)
    assert said in str(error.value)


@pytest.mark.long
def test_a_joint_by_hand_holds_a_part_that_touches_nothing(fourbar):
    away = np.eye(4)
    away[2, 3] = 500.0
    loose = replace(
        fourbar,
        parts=(
            *fourbar.parts,
            replace(fourbar.parts[1], name="flag", faces=(), triangles=fourbar.parts[1].triangles + 500.0),
        ),
    )
    with pytest.raises(ValueError, match="'flag' touches no other part"):
        loose.mechanism(fixed=EXAMPLES["fourbar"].fixed, infer=False)
    mechanism = loose.mechanism(fixed=["ground"], rigid=[["flag", "coupler"]])
    motion = mechanism.sweep(DRIVE)
    np.testing.assert_array_equal(motion.transforms["flag"], motion.transforms["coupler"])


@pytest.mark.parametrize("size", [1.0, 1e3])
def test_alignment_by_rounding_of_the_size_of_an_assembly_is_not_told(size):
    """Coordinates of an assembly of a metre, in mm, are rounded by 1e-13: lengths of a few of these are no noise."""
    for share, told in ((1e-14, False), (1e-9, True)):
        found = FoundJoints((), {}, 1e-16, share * size, ())
        assert bool(_alignment_notes(found, "mm", size)) == told
    assert not _alignment_notes(FoundJoints((), {}, 0.0, 0.0, ()), "mm", 0.0)


def test_notes_on_parts_whose_names_begin_alike_stay_when_one_is_left_out(fourbar):
    """Files number parts: a note on part 12 is none on part 2."""
    names, note = ("1", "2", "12", "3"), "face 9: a spline, not one of the four surfaces"
    parts = tuple(replace(part, name=name, notes=(note,)) for part, name in zip(fourbar.parts, names, strict=True))
    made = replace(fourbar, parts=parts).mechanism(fixed=["1"], exclude=["2"])
    assert [each for each in made.notes if note in each] == [f"{name}: {note}" for name in ("1", "12", "3")]


def test_an_assembly_without_parts_is_told_as_such(fourbar):
    assert str(fourbar.without(["*"])).startswith("Assembly of 0 parts from fourbar.step")
