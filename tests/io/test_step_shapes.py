"""What other systems write beside solids: surfaces, sketches, parts in other files, tessellations."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

from jaxkin.examples import path
from jaxkin.geometry.surfaces import Cylinder
from jaxkin.io.load import load
from jaxkin.io.step import read_step
from jaxkin.io.step_shapes import StepShapes, solids_alone

TEXT = path("fourbar").read_text()
HALVES = (Path(__file__).parent / "data" / "halves.step").read_text()
SOLID = dict(
    zip(("ground", "crank", "coupler", "rocker"), re.findall(r"#(\d+) = MANIFOLD_SOLID_BREP", TEXT), strict=True)
)
JOINTS = {"ground-crank", "ground-rocker", "crank-coupler", "coupler-rocker"}


def with_lines(text, *lines):
    end = text.rindex("ENDSEC;")
    return text[:end] + "\n".join((*lines, text[end:]))


def representation(solid, text=TEXT):
    """The number of the representation of a solid, and that of its context."""
    return re.search(rf"#(\d+) = ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#11,#{solid}\),#(\d+)\)", text).groups()


def with_items(text, solid, items):
    """The text with other items in the representation of a solid."""
    return re.sub(
        rf"ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#11,#{solid}\)", f"SHAPE_REPRESENTATION('',({items})", text
    )


def without(text, solid):
    """The text with a point in place of a solid, so that its colour is of something."""
    return re.sub(rf"#{solid} = MANIFOLD_SOLID_BREP[^;]*;", f"#{solid} = GEOMETRIC_CURVE_SET('',(#12));", text)


def surface(kind, name="crank"):
    """The side of the first cylinder of a solid, or all of its faces, as a model of surfaces."""
    shell = re.search(rf"#{SOLID[name]} = MANIFOLD_SOLID_BREP\('',#(\d+)\)", TEXT)[1]
    faces = re.search(rf"#{shell} = CLOSED_SHELL\('',\(([^)]*)\)", TEXT)[1]
    first = faces.split(",")[0] if kind == "OPEN_SHELL" else faces
    return f"#90000=SHELL_BASED_SURFACE_MODEL('',(#90001));#90001={kind}('',({first}));"


def loaded(folder, text):
    file = folder / "other.step"
    file.write_text(text)
    return load(file)


def beside(kind):
    """Surfaces in a representation of their own, which is said to be of the same product."""
    number, context = representation(SOLID["crank"])
    own = f"#90002=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#90000,#11),#{context});"
    return with_lines(TEXT, surface(kind), own, f"#90003=SHAPE_REPRESENTATION_RELATIONSHIP('','',#{number},#90002);")


@pytest.mark.parametrize(
    "text",
    [
        with_lines(with_items(TEXT, SOLID["crank"], f"#11,#{SOLID['crank']},#90000"), surface("OPEN_SHELL")),
        beside("OPEN_SHELL"),
    ],
)
def test_surfaces_beside_a_solid_are_left_out(tmp_path, text):
    """They were faces of the part, which was said to be damaged."""
    with pytest.warns(UserWarning) as told:
        assembly = loaded(tmp_path, text)
    assert [str(each.message) for each in told] == [
        "other.step: open surfaces of 'crank' bound no solid: left out; export them as solids if they matter"
    ]
    plain = load(path("fourbar"))
    assert [len(part.faces) for part in assembly.parts] == [len(part.faces) for part in plain.parts]
    assert all(not part.notes for part in assembly.parts)
    assert set(assembly.mechanism(fixed=["ground"]).joints) == JOINTS


def test_a_part_of_surfaces_alone_is_left_out(tmp_path):
    text = with_lines(with_items(TEXT, SOLID["rocker"], "#11,#90000"), surface("OPEN_SHELL", "rocker"))
    text = without(text, SOLID["rocker"])
    with pytest.warns(UserWarning, match="^other.step: open surfaces of 'rocker' bound no solid: left out"):
        parts = loaded(tmp_path, text).parts
    assert [part.name for part in parts] == ["ground", "crank", "coupler"]


def test_surfaces_without_a_rim_are_kept(tmp_path):
    """Some systems write the closed shell of a solid as a model of surfaces."""
    text = with_lines(with_items(TEXT, SOLID["crank"], "#11,#90000"), surface("CLOSED_SHELL"))
    assert solids_alone(text) == (text, [])
    assert set(loaded(tmp_path, without(text, SOLID["crank"])).mechanism(fixed=["ground"]).joints) == JOINTS


@pytest.mark.parametrize(
    ("lines", "more"),
    [
        ((), ""),
        (("#90000=GEOMETRIC_CURVE_SET('',(#12));",), ""),
        (
            ("#90001=DOCUMENT_FILE('rocker.stp','','',#90002,'',$);", "#90002=DOCUMENT_TYPE('');"),
            ", and it refers to files that are not beside it, rocker.stp",
        ),
    ],
)
def test_parts_without_a_solid_are_named(tmp_path, lines, more):
    """Skeletons, sketches and parts in other files: they were counted as damages."""
    text = with_lines(with_items(TEXT, SOLID["rocker"], "#11,#90000" if lines[:1] == ("#90000",) else "#11"), *lines)
    text = without(text, SOLID["rocker"])
    with pytest.warns(UserWarning) as told:
        parts = loaded(tmp_path, text).parts
    assert [str(each.message) for each in told] == [
        f"other.step: it places 'rocker' without a solid{more}: left out; export them as solids if they matter"
    ]
    assert [part.name for part in parts] == ["ground", "crank", "coupler"]


def tessellated(name, first):
    """The triangles of a part of `halves.step` in its own frame, as a tessellated solid, and the number of it."""
    part = next(part for part in read_step(Path(__file__).parent / "data" / "halves.step")[0] if part.name == name)
    lines, faces = [], []
    for number, face in enumerate(part.faces):
        points, rows = np.unique(face.triangles.reshape(-1, 3), axis=0, return_inverse=True)
        points = points - np.array([0.0, 0.0, 3.0 if name == "plate" else 0.0])
        listed = ",".join(str(tuple(point)) for point in points.tolist())
        corners = ",".join(str(tuple(row)) for row in (rows.reshape(-1, 3) + 1).tolist())
        at = first + 2 * number
        lines.append(f"#{at}=COORDINATES_LIST('',{len(points)},({listed}));")
        lines.append(f"#{at + 1}=TRIANGULATED_FACE('',#{at},{len(points)},(),$,(),({corners}));")
        faces.append(f"#{at + 1}")
    return [*lines, f"#{first + 99}=TESSELLATED_SOLID('',({','.join(faces)}),$);"], first + 99


PIN, PLATE = re.findall(r"#(\d+) = MANIFOLD_SOLID_BREP", HALVES)


def test_a_tessellated_solid_has_the_faces_of_a_mesh(tmp_path):
    """Was a KeyError: the kernel gives no normals of triangles without surfaces."""
    text = HALVES
    for name, solid, first in (("pin", PIN, 90000), ("plate", PLATE, 91000)):
        lines, number = tessellated(name, first)
        text = with_lines(with_items(text, solid, f"#11,#{number}"), *lines)
        text = without(text, solid)
    assembly = loaded(tmp_path, text)
    for part, side in zip(assembly.parts, (1, -1), strict=True):
        (round_face,) = (face.surface for face in part.faces if isinstance(face.surface, Cylinder))
        # the corners are on the cylinder to single precision of some 10 mm
        assert (round_face.radius, round_face.side) == (pytest.approx(5.0, rel=1e-6), side)
        assert part.notes[0].startswith("the file has its triangles only, from which its faces are recovered")
    assert [joint.kind for joint in assembly.mechanism(fixed=["plate"]).joints.values()] == [
        joint.kind
        for joint in load(Path(__file__).parent / "data" / "halves.step").mechanism(fixed=["plate"]).joints.values()
    ]


@pytest.mark.parametrize("together", [True, False])
def test_the_tessellation_of_a_solid_beside_it_is_not_another_part(tmp_path, together):
    """Was an IndexError in one representation, and a second part in two."""
    lines, number = tessellated("plate", 91000)
    shape, context = representation(PLATE, HALVES)
    if together:
        text = with_items(HALVES, PLATE, f"#11,#{PLATE},#{number}")
    else:
        text = HALVES
        lines.append(f"#92000=TESSELLATED_SHAPE_REPRESENTATION('',(#{number}),#{context});")
        lines.append(f"#92001=SHAPE_REPRESENTATION_RELATIONSHIP('','',#{shape},#92000);")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parts = loaded(tmp_path, with_lines(text, *lines)).parts
    plain, _ = read_step(Path(__file__).parent / "data" / "halves.step")
    assert [(part.name, len(part.faces), part.notes) for part in parts] == [
        (part.name, len(part.faces), ()) for part in plain
    ]


def test_a_part_of_several_solids_says_so(tmp_path):
    """Some systems write a whole mechanism as the bodies of one part, in which nothing would move without a word."""
    shell = re.search(rf"#{PLATE} = MANIFOLD_SOLID_BREP\('',#(\d+)\)", HALVES)[1]
    text = with_lines(HALVES, f"#90000=MANIFOLD_SOLID_BREP('',#{shell});")
    pin, plate = loaded(tmp_path, with_items(text, PIN, f"#11,#{PIN},#90000")).parts
    assert sum("it is made of 2 solids that count as one body" in note for note in pin.notes) == 1
    assert plate.notes == ()


@pytest.mark.parametrize("quantity", ["", "QUANTIFIED_ASSEMBLY_COMPONENT_USAGE(#9)"])
def test_occurrences_as_complex_instances_are_placed(tmp_path, quantity):
    """The kernel left the part at the origin, without a word."""
    text = re.sub(
        r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('4','rocker','',(#\d+,#\d+),\$\)",
        r"(ASSEMBLY_COMPONENT_USAGE($)NEXT_ASSEMBLY_USAGE_OCCURRENCE()"
        rf"PRODUCT_DEFINITION_RELATIONSHIP('4','rocker (left)','',\1)PRODUCT_DEFINITION_USAGE(){quantity})",
        TEXT,
    )
    assert text != TEXT
    parts = loaded(tmp_path, text).parts
    assert [part.name for part in parts] == ["ground", "crank", "coupler", "rocker (left)"]
    assert all(
        (part.triangles == same.triangles).all() for part, same in zip(parts, load(path("fourbar")).parts, strict=True)
    )


def test_damaged_shapes_end():
    """Shells in a circle, representations in a circle, and numbers that are not there."""
    text = """#1=SHAPE_REPRESENTATION('',(#2,#99),#9);#2=SHELL_BASED_SURFACE_MODEL('',(#3,#98));
    #3=OPEN_SHELL('',(#3,#4,#97));#4=ADVANCED_FACE('',(#5),#9,.T.);#5=FACE_BOUND('',#6,.T.);#6=EDGE_LOOP('',(#7,#6));
    #7=ORIENTED_EDGE('',*,*,#8,.T.);#8=EDGE_CURVE('',#9,#9,#9,.T.);
    #10=SHAPE_REPRESENTATION_RELATIONSHIP('','',#1,#1);#11=SHAPE_DEFINITION_REPRESENTATION(#12,#1);
    #12=PRODUCT_DEFINITION_SHAPE('','',#13);#13=PRODUCT_DEFINITION('','',#14,#9);
    #14=PRODUCT_DEFINITION_FORMATION('','',#15);#15=PRODUCT('a','an ''a''','',());#16=SHAPE_REPRESENTATION('',(),#9);"""
    left, sheets = solids_alone(text)
    assert sheets == ["an 'a'"]
    assert "SHAPE_REPRESENTATION('',(#99),#9)" in left
    assert StepShapes(left).without_solids() == {}  # what #99 is, nobody knows
