"""Placements are read in full from the text of a STEP file, where its reader hands them on in single precision."""

import re

import numpy as np
import pytest

from jaxkin.examples import path
from jaxkin.geometry.pose import apply, inverse
from jaxkin.io.load import load
from jaxkin.io.step_placements import FilePlacements, check_not_mirrored

EXAMPLES = ("fourbar", "slider_crank", "cam", "eighteen_bars", "air_cylinder")

FRAME = """#{0}=AXIS2_PLACEMENT_3D('',#{0}1,#{0}2,#{0}3);
#{0}1=CARTESIAN_POINT('',({1},{2},{3}));#{0}2=DIRECTION('a name (of, two)',({4}));#{0}3=DIRECTION('',({5}));
"""
UNIT = """#7{0}=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({1},.METRE.));
#8{0}=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#7{0})) REPRESENTATION_CONTEXT('',''));
"""
MILLIMETRES = UNIT.format(1, ".MILLI.")
AT_HOME = FRAME.format(1, 0, 0, 0, "0.,0.,1.", "1.,0.,0.")
TURNED = FRAME.format(2, 123.456789, -54.321123, 7.654321, "0.6,0.,0.8", "0.8,0.1,-0.5")


def placed(one="#1", other="#2"):
    return f"#5=ITEM_DEFINED_TRANSFORMATION('a','b (c)',{one},{other});"


def pose(point=(0.123456789, -0.054321123, 0.007654321)):
    z = np.array([0.6, 0.0, 0.8])
    x = np.array([0.8, 0.1, -0.5])
    x = (x - (x @ z) * z) / np.linalg.norm(x - (x @ z) * z)
    found = np.eye(4)
    found[:3] = np.stack([x, np.cross(z, x), z, point], axis=1)
    return found


def single(matrix):
    return matrix.astype(np.float32).astype(float)


def test_a_placement_is_found_by_its_numbers_in_single_precision():
    found = FilePlacements(MILLIMETRES + AT_HOME + TURNED + placed()).rounded_to(single(pose()))
    assert np.abs(single(pose()) - pose()).max() > 1e-9
    np.testing.assert_allclose(found, pose(), atol=1e-15)


def test_a_file_without_a_unit_is_in_millimetres():
    found = FilePlacements(AT_HOME + TURNED + placed()).rounded_to(single(pose()))
    np.testing.assert_allclose(found, pose(), atol=1e-15)


def test_translators_differ_in_which_frame_is_placed_in_which():
    found = FilePlacements(MILLIMETRES + AT_HOME + TURNED + placed("#2", "#1")).rounded_to(single(pose()))
    np.testing.assert_allclose(found, pose(), atol=1e-15)
    found = FilePlacements(MILLIMETRES + AT_HOME + TURNED + placed()).rounded_to(single(inverse(pose())))
    np.testing.assert_allclose(found, inverse(pose()), atol=1e-15)


def test_mapped_items_place_too():
    text = "#5=REPRESENTATION_MAP(#1,#9);#6=MAPPED_ITEM('',#5,#2);"
    found = FilePlacements(MILLIMETRES + AT_HOME + TURNED + text).rounded_to(single(pose()))
    np.testing.assert_allclose(found, pose(), atol=1e-15)


def test_assemblies_may_be_in_another_unit_than_their_parts():
    file = FilePlacements(UNIT.format(1, "$") + UNIT.format(2, ".MILLI.") + AT_HOME + TURNED + placed())
    for point in (pose()[:3, 3], 1000 * pose()[:3, 3]):
        np.testing.assert_allclose(file.rounded_to(single(pose(point))), pose(point), rtol=1e-14, atol=1e-15)


def test_a_frame_without_directions_is_that_of_the_world():
    bare = "#1=AXIS2_PLACEMENT_3D('',#11,$,$);#11=CARTESIAN_POINT('',(0.,0.,0.));"
    found = FilePlacements(MILLIMETRES + bare + TURNED + placed()).rounded_to(single(pose()))
    np.testing.assert_allclose(found, pose(), atol=1e-15)


def test_of_two_placements_that_single_precision_does_not_tell_apart_neither_is_taken():
    other = FRAME.format(3, 123.456789, -54.3211231, 7.654321, "0.6,0.,0.8", "0.8,0.1,-0.5")
    twice = placed() + placed("#1", "#3").replace("#5=", "#6=")
    assert FilePlacements(MILLIMETRES + AT_HOME + TURNED + other + twice).rounded_to(single(pose())) is None
    same = TURNED.replace("#2", "#3")
    assert FilePlacements(MILLIMETRES + AT_HOME + TURNED + same + twice).rounded_to(single(pose())) is not None


@pytest.mark.parametrize(
    "text",
    [
        "",
        placed(),
        MILLIMETRES + AT_HOME + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("0.6,0.,0.8", "0.,0.,0.") + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("0.6,0.,0.8", "1e300,1e300,0.") + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("0.6,0.,0.8", "0.6,0.,0.8.1") + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("0.6,0.,0.8", "0.6,0.8") + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("#22,", "$,") + placed(),
        MILLIMETRES + AT_HOME + TURNED.replace("#23)", "#2)") + placed(),
        MILLIMETRES + AT_HOME + TURNED + placed("#1", "#99"),
        MILLIMETRES + AT_HOME + TURNED + "#5=ITEM_DEFINED_TRANSFORMATION('','',#1);",
        MILLIMETRES + AT_HOME + TURNED + "#6=MAPPED_ITEM('',#5,#2);",
    ],
)
def test_what_is_not_told_whole_is_not_found(text):
    assert FilePlacements(text).rounded_to(single(pose())) is None


@pytest.mark.parametrize("name", EXAMPLES)
def test_parts_of_the_examples_meet_as_their_files_say(name):
    """Their texts have thirteen digits, so that faces in contact are apart by 1e-12 of some 100 mm, where single
    precision left 1e-6."""
    assembly = load(path(name))
    assert max(contact.misfit for contact in assembly.contacts()) < 1e-9
    assert max(part.surface_resolution for part in assembly.parts) < 1e-10


def test_a_placement_that_the_text_does_not_have_is_rounded(tmp_path):
    """A frame whose second direction is left to the reader: its part is known to single precision."""
    text = path("fourbar").read_text()
    frame = re.findall(r"ITEM_DEFINED_TRANSFORMATION\('','',#\d+,#(\d+)\)", text)[0]
    along, across = re.findall(rf"#{frame} = AXIS2_PLACEMENT_3D\('',#\d+,(#\d+),(#\d+)\)", text)[0]
    bare = re.sub(rf"(#{frame} = AXIS2_PLACEMENT_3D\('',#\d+,{along},){across}\)", r"\1$)", text)
    assert bare != text
    file = tmp_path / "bare.step"
    file.write_text(bare)
    rounded = [part.surface_resolution for part in load(file).parts]
    assert sum(each > 1e-7 for each in rounded) == 1


AXES = """#91=DIRECTION('',(0.,1.,0.));#92=DIRECTION('',(-1.,0.,0.));#93=DIRECTION('',(0.,0.,{}));
#94=CARTESIAN_POINT('',(0.,0.,0.));#90=CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,$,#91,#92,#94,1.,{});"""
RELATED = """#80=(REPRESENTATION_RELATIONSHIP('','',#1,#2)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#90)
SHAPE_REPRESENTATION_RELATIONSHIP());"""
MAPPED = "#80={}REPRESENTATION('',(),#1);#81=REPRESENTATION_MAP(#94,#80);#82=MAPPED_ITEM('',#81,#90);"


@pytest.mark.parametrize("used", [RELATED, MAPPED.format("ADVANCED_BREP_SHAPE_")])
def test_mirrored_placements_are_refused(used):
    """The modelling kernel turns the part round in place of mirroring it, without a word."""
    with pytest.raises(ValueError, match=r"^a\.step mirrors a part where it places it \(#90, .*as one of its own$"):
        check_not_mirrored(AXES.format("-1.", "#93") + used, "a.step")
    for right_handed in (AXES.format("1.", "#93"), AXES.format("1.", "$")):
        check_not_mirrored(right_handed + used, "a.step")


@pytest.mark.parametrize("used", ["", MAPPED.format("DRAUGHTING_"), "#81=MAPPED_ITEM('',#99,#90);"])
def test_mirrors_that_place_no_part_are_none(used):
    check_not_mirrored(AXES.format("-1.", "#93") + used, "a.step")


def moved_by(axes, scale="1."):
    """The shipped four-bar with its first occurrence, placed by an operator in place of two frames."""
    text = path("fourbar").read_text()
    first = re.findall(r"#(\d+) = ITEM_DEFINED_TRANSFORMATION", text)[0]
    operator = (
        f"#{first} = CARTESIAN_TRANSFORMATION_OPERATOR_3D({axes},#99994,{scale},#99993);"
        "#99991=DIRECTION('',(0.,1.,0.));"
        "#99992=DIRECTION('',(-1.,0.,0.));#99993=DIRECTION('',(0.,0.,1.));#99994=CARTESIAN_POINT('',(500.,0.,0.));"
    )
    return re.sub(rf"#{first} = ITEM_DEFINED_TRANSFORMATION[^;]*;", operator, text)


NAMED = ["''", "'',$", "'','',$"]
"""What programs write before the axes of an operator: its name, and its name and description as a transformation."""


@pytest.mark.parametrize("named", NAMED)
def test_operators_place_parts_with_or_without_a_description(named, tmp_path):
    """The reader knew the last form alone, and left the parts of the others where they were drawn."""
    turned = np.array([[0, -1, 0, 500], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    (tmp_path / "moved.step").write_text(moved_by(f"{named},#99991,#99992"))
    (tmp_path / "drawn.step").write_text(moved_by(f"{NAMED[-1]},$,$").replace("(500.", "(0."))
    drawn, moved = (load(tmp_path / f"{each}.step").parts[0].box for each in ("drawn", "moved"))
    box = np.sort(apply(turned, drawn), axis=0)  # a quarter turn keeps boxes
    np.testing.assert_allclose(moved, box, atol=1e-4)  # single precision of 500 mm


@pytest.mark.parametrize("named", NAMED)
def test_operators_that_scale_are_refused(named, tmp_path):
    (tmp_path / "a.step").write_text(moved_by(f"{named},#99991,#99992", "2."))
    with pytest.raises(ValueError, match="is scaled or mirrored in its assembly: export it as a part"):
        load(tmp_path / "a.step")
