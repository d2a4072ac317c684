"""FreeCAD's own documents: assemblies of its workbench, written here as it writes them, against closed forms."""

import re
import zipfile

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import rotation
from jaxkin.io.fcstd import read_fcstd
from reference.freecad import (
    CRANK,
    ROD,
    SAME,
    WHERE,
    X,
    Y,
    assembled,
    document,
    group,
    joint,
    number,
    pose,
    slider_crank,
    xlink,
    yes,
)


def test_a_document_says_parts_limits_motors_and_what_is_suppressed(tmp_path):
    loaded = jk.load(slider_crank(tmp_path)[0])
    mechanism = loaded.mechanism()
    assert loaded.unit == "mm" and mechanism.motors == ("main",) and mechanism.fixed == ("base",)
    assert mechanism.parts == ("base", "the crank", "rod", "slider") and mechanism.mobility().useful == 1
    assert {str(joint.kind) for joint in mechanism.all_joints} == {"revolute", "prismatic"}
    assert not any("open" in note for note in mechanism.notes)
    assert any("App::FeaturePython 'off' is suppressed" in note for note in mechanism.notes)
    ((low, high),) = mechanism.joints["main"].limits
    (value,) = loaded.exported.joint_values["main"]
    np.testing.assert_allclose(low, -np.pi / 2 - value, atol=1e-12)
    assert high == np.inf


@pytest.mark.long
def test_a_crank_slider_moves_as_its_closed_form(tmp_path):
    path, angle, reach = slider_crank(tmp_path)
    turn = np.linspace(0.0, 2 * np.pi, 25)
    motion = jk.load(path).mechanism().sweep({"main": turn})
    assert motion.closed.all()
    # the axis of the joint on the crank points down, which is the same revolute: angles are about that on the base
    theta = angle + turn
    expected = CRANK * np.cos(theta) + np.sqrt(ROD**2 - (CRANK * np.sin(theta)) ** 2)
    along = WHERE[:3, :3] @ X
    moved = np.asarray(motion.transforms["slider"])[:, :3, 3]
    np.testing.assert_allclose(moved, (expected - reach)[:, None] * along, atol=1e-9)  # of 110 mm


def two_wheels(kind, **sizes):
    """List a rack or a pair of wheels: base, a turning wheel, and a second one or a rack."""
    turning = joint("Revolute", ("Assembly", "base.Face1"), ("Assembly", "one.Face1"), np.eye(4), np.eye(4))
    parts = {"base": np.eye(4), "one": np.eye(4), "two": pose((3.0, 0.0, 0.0))}
    tie = joint(kind, ("Assembly", "one.Face1"), ("Assembly", "two.Face1"), np.eye(4), np.eye(4), **sizes)
    second = joint("Revolute", ("Assembly", "base.Face2"), ("Assembly", "two.Face1"), parts["two"], np.eye(4))
    if kind == "RackPinion":
        parts["two"] = pose((0.0, -2.0, 0.0))
        up = pose(turn=rotation(Y, np.pi / 2))
        tie = joint(kind, ("Assembly", "one.Face1"), ("Assembly", "two.Face1"), np.eye(4), up, **sizes)
        second = joint("Slider", ("Assembly", "base.Face2"), ("Assembly", "two.Face1"), parts["two"] @ up, up)
    if kind == "Screw":
        parts["two"] = np.eye(4)
        second = joint("Slider", ("Assembly", "base.Face2"), ("Assembly", "two.Face1"), np.eye(4), np.eye(4))
    return {"turn": turning, "second": second, "tie": tie}, parts


@pytest.mark.parametrize(
    ("kind", "sizes", "ratio"),
    [
        ("Gears", {"Distance": 2.0, "Distance2": 1.0}, -2.0),
        ("Belt", {"Distance": 2.0, "Distance2": 1.0}, 2.0),
        ("RackPinion", {"Distance": 2.0}, 2.0),  # the rack below moves along x as the pinion turns left
        ("Screw", {"Distance": 0.5}, -0.5 / (2 * np.pi)),  # against the spindle the nut turns back
    ],
)
def test_gears_belts_racks_and_screws_are_couplings(tmp_path, kind, sizes, ratio):
    joints, parts = two_wheels(kind, **{key: number(value) for key, value in sizes.items()})
    mechanism = jk.load(document(tmp_path / "a.FCStd", assembled(joints, parts))).mechanism()
    (coupling,) = mechanism.linkage.couplings
    assert coupling.name == "tie" and mechanism.mobility().useful == 1
    motion = mechanism.sweep({"turn": np.array([0.0, 1.0])})
    np.testing.assert_allclose(motion.coordinates["second"][-1], [ratio], rtol=1e-12)


@pytest.mark.parametrize(
    ("kind", "sizes", "freedoms", "found"),
    [("Parallel", {}, 4, "schoenflies"), ("Perpendicular", {}, 5, "constant angle"),
     ("Angle", {"Angle": number(90.0)}, 5, "constant angle"), ("Angle", {"Angle": number(180.0)}, 4, "schoenflies"),
     ("Cylindrical", {}, 2, "cylindrical"), ("Ball", {}, 3, "spherical"), ("Fixed", {}, 0, None)],
)  # fmt: skip
def test_joints_leave_as_many_freedoms_as_in_freecad(tmp_path, kind, sizes, freedoms, found):
    upright = kind not in ("Perpendicular", "Angle") or "180" in str(sizes)
    place = pose(turn=SAME if upright else rotation(X, np.pi / 2))
    one = joint(kind, ("Assembly", "base.Face1"), ("Assembly", "part.Face1"), np.eye(4), np.eye(4), **sizes)
    objects = assembled({"j": one}, {"base": np.eye(4), "part": place})
    mechanism = jk.load(document(tmp_path / "a.fcstd", objects)).mechanism()
    assert mechanism.mobility().useful == freedoms
    assert [joint.kind for joint in mechanism.all_joints] == ([found] if found else [])


def test_an_angle_joint_keeps_its_angle_on_a_part_that_is_not_there_yet(tmp_path):
    """A lid drawn shut, whose angle to the box is 30 degrees: it stands at that, and keeps it, however it moves."""
    lid = joint("Angle", ("Assembly", "base.Face1"), ("Assembly", "lid.Face1"), np.eye(4), np.eye(4),
                Angle=number(30.0))  # fmt: skip
    objects = assembled({"lid angle": lid}, {"base": np.eye(4), "lid": np.eye(4)})
    loaded = jk.load(document(tmp_path / "a.FCStd", objects))
    assert any("moved: lid by 0 mm and 0.524 rad" in note for note in loaded.exported.notes)
    mechanism = loaded.mechanism()
    assert mechanism.mobility().freedoms == 5
    axis = np.asarray(mechanism.all_joints[0].frames_1)[-1, :3, 2]  # of the lid, where it stands now
    motion = mechanism.sweep({name: [0.0, 0.4] for name in mechanism.all_joints[0].full_names})
    moved = np.asarray(motion.transforms["lid"])[:, :3, :3] @ axis
    np.testing.assert_allclose(moved[:, 2], np.cos(np.pi / 6), atol=1e-15)
    assert np.abs(moved[1] - moved[0]).max() > 0.1


@pytest.mark.parametrize(("element", "kept"), [("Vertex1", True), ("Face1", False)])
def test_a_distance_of_points_is_a_rod_and_one_of_faces_is_named(tmp_path, element, kept):
    away = pose((3.0, 4.0, 0.0))
    ends = ("Assembly", f"base.{element}"), ("Assembly", f"part.{element}")
    rod = joint("Distance", *ends, np.eye(4), np.eye(4), Distance=number(5.0))
    objects = assembled({"rod": rod}, {"base": np.eye(4), "part": away})
    mechanism = jk.load(document(tmp_path / "a.FCStd", objects)).mechanism()
    assert ("rod" in mechanism.joints) == kept
    assert any("what a Distance of faces or edges keeps" in note for note in mechanism.notes) != kept


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"Reference2": xlink("Assembly", "lost.Face1")}, "its Reference2: 'lost' is not in a.FCStd"),
        ({"Reference2": xlink("lost", "Face1")}, "its Reference2 is 'lost', which is not in the document"),
        ({"Reference2": xlink("")}, "it has no Reference2"),
        ({"Activated": yes(False)}, "is suppressed"),
    ],
)
def test_joints_on_what_is_not_there_are_named(tmp_path, change, message):
    kind, own = joint("Revolute", ("Assembly", "base.Face1"), ("Assembly", "part.Face1"), np.eye(4), np.eye(4))
    objects = assembled({"hinge": (kind, own | change)}, {"base": np.eye(4), "part": np.eye(4)})
    notes = jk.load(document(tmp_path / "a.FCStd", objects)).exported.notes
    assert any("'hinge'" in note and message in note for note in notes)


def test_a_link_to_a_document_that_is_missing_is_refused_where_it_is_needed(tmp_path):
    path, *_ = slider_crank(tmp_path)
    (tmp_path / "slider.FCStd").unlink()
    with pytest.raises(FileNotFoundError, match=r"App::Link 'slider': it links to 'slider.FCStd', which is not there"):
        jk.load(path)


def circle(folder):
    links = {
        "a": ("App::Link", {"LinkedObject": xlink("b"), "LinkTransform": yes()}),
        "b": ("App::Link", {"LinkedObject": xlink("a"), "LinkTransform": yes()}),
    }
    top = {"Assembly": ("Assembly::AssemblyObject", {"Group": group("a", "b")})}
    return document(folder / "a.FCStd", links | top)


def bomb(folder):
    with zipfile.ZipFile(folder / "a.FCStd", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("Document.xml", bytes(260_000_000))
    return folder / "a.FCStd"


def plain(folder, data):
    (folder / "a.FCStd").write_bytes(data)
    return folder / "a.FCStd"


def other(folder):
    with zipfile.ZipFile(folder / "a.FCStd", "w") as archive:
        archive.writestr("something.txt", "else")
    return folder / "a.FCStd"


def truncated(folder):
    whole = slider_crank(folder)[0].read_bytes()
    start = whole.index(b"Document.xml") + 60
    return plain(folder, whole[:start] + b"\x00" * 200 + whole[start + 200 :])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda folder: plain(folder, b"no archive"), "expected a document of FreeCAD, a zip archive"),
        (truncated, "expected a document of FreeCAD, a zip archive"),
        (other, "there is no Document.xml in it"),
        (bomb, "Document.xml is longer than"),
        (lambda folder: document(folder / "a.FCStd", {}, '<!DOCTYPE x [<!ENTITY a "a">]>'), "declares a document type"),
        (lambda folder: document(folder / "a.FCStd", {}), "there is no assembly of FreeCAD's own workbench"),
        (circle, "links lead to each other"),
    ],
)  # fmt: skip
def test_what_is_no_document_is_refused_in_one_line(tmp_path, make, message):
    with pytest.raises(ValueError, match=message) as error:
        jk.load(make(tmp_path))
    assert "\n" not in str(error.value) and "a.FCStd" in str(error.value)


def test_a_damaged_list_of_objects_is_read_or_refused_in_one_line(tmp_path):
    path = slider_crank(tmp_path)[0]
    with zipfile.ZipFile(path) as archive:
        text = archive.read("Document.xml").decode()
    random, refused = np.random.default_rng(0), 0
    for _ in range(150):
        values = [*re.finditer(r'"([^"]*)"', text)]
        at = values[random.integers(len(values))]
        other = ["", "x", "nan", "1e400", "-5", "Assembly", "crank", "99999999999", "a.b.c", values[-5][1]]
        changed = f"{text[: at.start(1)]}{other[random.integers(len(other))]}{text[at.end(1) :]}"
        elements = [*re.finditer(r"<Property [^>]*>.*?</Property>|<[^>]*/>", changed)]
        gone = elements[random.integers(len(elements))]
        with zipfile.ZipFile(tmp_path / "damaged.FCStd", "w") as archive:
            archive.writestr("Document.xml", changed[: gone.start()] + changed[gone.end() :])
        try:
            model = read_fcstd(tmp_path / "damaged.FCStd")
        except (ValueError, FileNotFoundError) as error:
            refused += 1
            assert "\n" not in str(error) and ".FCStd" in str(error)
        else:
            assert {part for joint in model.joints for part in joint.parts} <= {link.name for link in model.links}
    assert 5 < refused < 100
