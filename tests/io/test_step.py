"""STEP files against the dimensions that they were drawn with; units, names, repairs."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.pose import apply, rotation, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere
from jaxkin.io.step import read_step
from jaxkin.io.step_glb import instances

DATA = Path(__file__).parent / "data"
read = cache(read_step)  # half a second each

# The reader passes placements through float32: 6e-8 of coordinates of up to 200 mm, and of parts 150 mm long.
NOISE = 2e-5

MILLIMETRE = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );"
METRE, MICROMETRE = MILLIMETRE.replace(".MILLI.", "$"), MILLIMETRE.replace(".MILLI.", ".MICRO.")
CONVERSION = "( CONVERSION_BASED_UNIT('SOME NAME',#90001) LENGTH_UNIT() NAMED_UNIT(#90003) );"
BASE = f"""#90001 = LENGTH_MEASURE_WITH_UNIT({{}},#90002);
#90002 = {MILLIMETRE.replace("MILLI", "CENTI")}
#90003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
ENDSEC;
END-ISO"""


def test_cylinders_of_the_fourbar_have_their_radii_and_sides():
    parts, unit_name = read(path("fourbar"))
    assert unit_name == "mm"
    assert [part.name for part in parts] == ["ground", "crank", "coupler", "rocker"]
    link = [(5.0, 1), (6.0, -1), (10.0, 1), (12.0, 1)]  # pin, hole, two rounded ends
    expected = {
        "ground": [(3.5, -1)] * 4 + [(6.0, 1)] * 2 + [(12.0, 1)] * 4,  # four holes, two pins, four rounded corners
        "crank": link,
        "coupler": [(5.0, -1)] * 2 + [(10.0, 1)] * 2,
        "rocker": link,
    }
    for part in parts:
        cylinders = sorted((face.radius, face.side) for face in surfaces(part, Cylinder))
        np.testing.assert_allclose(cylinders, expected[part.name], rtol=1e-9)
        assert part.notes == ()


def test_colours_are_those_of_the_drawing():
    drawn = {"ground": "#AEB8C2", "crank": "#E4572E", "rod": "#2A7FB8", "slider": "#F0A830"}
    for part in read(path("slider_crank"))[0]:
        assert "#" + bytes(round(255 * value) for value in part.color).hex().upper() == drawn[part.name]


@pytest.mark.long
@pytest.mark.parametrize("file", [*map(path, EXAMPLES), *(DATA / f"{name}.step" for name in ("halves", "nested"))])
def test_faces_close_the_solid_and_face_outwards(file):
    """Faces that face outwards have no net area, and enclose a positive volume."""
    for part in read(file)[0]:
        size = np.linalg.norm(np.ptp(part.box, axis=0))
        corners = np.concatenate([face.triangles for face in part.faces])
        assert np.linalg.norm(areas(corners).sum(axis=0)) < 1e-6 * size**2
        assert np.sum(areas(corners) * (corners.mean(axis=1) - part.box[0])) > 0
        assert np.ptp(part.triangles, axis=(0, 1)) == pytest.approx(np.ptp(corners, axis=(0, 1)))
        for face in part.faces:
            assert np.abs(face.surface.distance(face.triangles)).max() < 1e-6 * size
            outwards = np.sum(areas(face.triangles) * face.surface.normals(face.triangles.mean(axis=1)), axis=-1)
            assert outwards.min() > -1e-6 * outwards.sum()  # slivers at the seam of a face may be turned over


@pytest.mark.parametrize(
    ("unit_name", "declared", "base"),
    [
        ("m", METRE, ""),
        ("um", MICROMETRE, ""),
        ("in", CONVERSION, BASE.format("LENGTH_MEASURE(2.54)")),
        ("ft", CONVERSION, BASE.format("30.48")),
    ],
)
def test_numbers_are_those_of_the_file_in_any_unit(tmp_path, unit_name, declared, base):
    file = tmp_path / "fourbar.step"
    text = path("fourbar").read_text().replace(MILLIMETRE, declared)
    file.write_text(text.replace("ENDSEC;\nEND-ISO", base) if base else text)
    parts, read_unit = read_step(file)
    assert read_unit == unit_name
    for part, same in zip(parts, read(path("fourbar"))[0], strict=True):
        assert part.name == same.name
        assert len(part.faces) == len(same.faces)
        for face, other in zip(part.faces, same.faces, strict=True):
            assert face.surface.kind == other.surface.kind
            for field in ("radius", "half_angle", "side"):
                assert getattr(face.surface, field, 0) == pytest.approx(getattr(other.surface, field, 0), rel=1e-9)
            assert np.abs(other.surface.distance(face.triangles)).max() < NOISE


def test_a_file_without_unit_is_in_millimetres_and_says_so(tmp_path):
    file = tmp_path / "halves.step"
    file.write_text((DATA / "halves.step").read_text().replace("LENGTH_UNIT()", ""))
    with pytest.warns(UserWarning, match="halves.step does not say its length unit"):
        parts, unit_name = read_step(file)
    assert unit_name == "mm"
    assert surfaces(parts[0], Cylinder)[0].radius == pytest.approx(5.0, rel=1e-9)


def test_faces_of_other_colours_are_read_too():
    (bush,), _ = read_step(DATA / "painted.step")
    assert sorted((face.radius, face.side) for face in surfaces(bush, Cylinder)) == [
        (pytest.approx(3, rel=1e-9), -1),
        (pytest.approx(5, rel=1e-9), 1),
    ]
    assert sorted(face.normal[2] * face.point[2] for face in surfaces(bush, Plane)) == pytest.approx([0, 10], abs=1e-9)
    assert bush.color == pytest.approx((0x2A / 255, 0x7F / 255, 0xB8 / 255), abs=1e-3)  # that of the part
    assert bush.notes == ()


@pytest.mark.parametrize(
    "written", [rb"B\X2\00F6\X0\gen", rb"B\X\F6gen", "B\u00f6gen".encode(), "B\u00f6gen".encode("latin-1")]
)
def test_names_in_any_encoding(tmp_path, written):
    file = tmp_path / "halves.step"
    file.write_bytes((DATA / "halves.step").read_bytes().replace(b"'pin'", b"'" + written + b"'"))
    assert [part.name for part in read_step(file)[0]] == ["B\u00f6gen", "plate"]


def test_half_cylinders_are_one_face():
    pin, plate = read(DATA / "halves.step")[0]
    (shaft,), (hole,) = (surfaces(part, Cylinder) for part in (pin, plate))
    assert (shaft.side, hole.side) == (1, -1)
    assert (shaft.radius, hole.radius) == pytest.approx((5.0, 5.0), rel=1e-9)
    assert len(pin.faces) == 3
    areas_of = {face.surface.kind: face.area for face in pin.faces}
    assert areas_of["cylinder"] == pytest.approx(2 * np.pi * 5 * 10, rel=0.01)  # chords of at most 0.2 rad
    assert areas_of["plane"] == pytest.approx(np.pi * 25, rel=0.01)


def test_instances_of_nested_assemblies_are_parts_with_names_of_their_own():
    parts = {part.name: part for part in read(DATA / "nested.step")[0]}
    assert list(parts) == ["washer", "bolt", "other bolt", "washer#2", "bolt#2", "bolt#3"]
    left, right = np.eye(4), np.eye(4)
    left[:3, :3] = rotation(unit(np.array([1.0, 1.0, 0.0])), np.radians(30))
    right[:3, :3] = rotation(unit(np.array([0.0, 1.0, 1.0])), np.radians(50))
    right[:3, 3] = [100, 10, 0]
    for pose, washer, bolt, other in (
        (left, "washer", "bolt", "other bolt"),
        (right, "washer#2", "bolt#2", "bolt#3"),
    ):
        for name, ends in ((washer, (0, 2)), (bolt, (0, 10)), (other, (20, 30))):
            for cylinder in surfaces(parts[name], Cylinder):
                axis = apply(pose, np.array([[0.0, 0, 0], [0, 0, 30]]))
                assert np.abs(cylinder.distance(axis) + cylinder.side * cylinder.radius).max() < NOISE
            heights = sorted(plane.point @ pose[:3, 2] for plane in surfaces(parts[name], Plane))
            np.testing.assert_allclose(heights, np.array(ends) + pose[:3, 3] @ pose[:3, 2], atol=NOISE)
    assert parts["washer"].color == parts["washer#2"].color is not None
    assert parts["bolt"].color is None


def test_parts_without_a_name_are_numbered(tmp_path):
    file = tmp_path / "split.step"
    text = (DATA / "halves.step").read_text()
    for name, placeholder in (("'pin'", "'=>[0:1:1:15]_7'"), ("'plate'", "'Open CASCADE STEP translator 7.9 3'")):
        text = text.replace(name, placeholder)
    file.write_text(text)
    assert [part.name for part in read_step(file)[0]] == ["part 1", "part 2"]


def test_parts_without_a_name_have_that_of_their_subassembly(tmp_path):
    file = tmp_path / "nested.step"
    file.write_text((DATA / "nested.step").read_text().replace("'bolt'", "'COMPOUND'"))
    names = [part.name for part in read_step(file)[0]]
    assert names == ["washer", "left", "other bolt", "washer#2", "right", "right#2"]


def test_a_torus_is_named_and_the_cone_beside_it_is_read():
    (shaft,), _ = read(DATA / "fillet.step")
    (note,) = shaft.notes
    assert note == "face 4: torus, not one of the four surfaces"
    assert "face 4" not in [face.name for face in shaft.faces]
    (cone,) = surfaces(shaft, Cone)
    assert (cone.half_angle, cone.side) == (pytest.approx(np.pi / 4, rel=1e-9), 1)
    np.testing.assert_allclose(cone.apex, [0, 0, 25], atol=1e-9)  # a chamfer from radius 6 to 5 at height 19 to 20
    np.testing.assert_allclose(cone.axis, [0, 0, -1], atol=1e-12)  # from the apex into the material
    assert len(shaft.triangles) > sum(len(face.triangles) for face in shaft.faces)  # the torus is still drawn


def test_a_ball_trimmed_across_its_seam_is_no_socket():
    (part,), _ = read(DATA / "ball.step")
    (ball,) = surfaces(part, Sphere)
    assert (ball.radius, ball.side) == (pytest.approx(12.5, rel=1e-9), 1)
    assert any("sphere" in note and "face 1" in note for note in part.notes)
    (sphere,) = (face for face in part.faces if isinstance(face.surface, Sphere))
    outwards = np.sum(areas(sphere.triangles) * (sphere.triangles.mean(axis=1) - ball.centre), axis=-1)
    assert np.all(outwards >= 0)


def test_a_face_without_triangles_is_named(monkeypatch):
    """The kernel cannot triangulate every face; here the triangles of one are taken away."""
    import jaxkin.io.step as step

    def without_face_3(*given, **named):
        for whole in instances(*given, **named):
            mesh = whole.mesh
            arrays = {name: getattr(mesh, name)[mesh.face_of != 2] for name in ("triangles", "normals", "face_of")}
            yield replace(whole, mesh=replace(mesh, **arrays))

    monkeypatch.setattr(step, "instances", without_face_3)
    said = "face 3: it came without triangles, so where it ends is not known: left out"
    with pytest.warns(
        UserWarning, match=f"^splines.step is damaged or incomplete .'nose': {said}; 'nose': it is not closed"
    ):
        (bush,), _ = read_step(DATA / "splines.step")
    assert bush.notes[0] == said
    assert "face 3" not in [face.name for face in bush.faces]


def test_surfaces_written_as_splines_are_recognised():
    (nose,), _ = read(DATA / "splines.step")
    assert nose.notes == ()
    (cylinder,), (cone,), (sphere,) = (surfaces(nose, kind) for kind in (Cylinder, Cone, Sphere))
    # fitted to corners that are float32: 6e-8 of 21 mm
    assert cylinder.radius == pytest.approx(8, abs=1e-6)
    assert cone.half_angle == pytest.approx(np.arctan2(3, 6), abs=1e-6)
    assert sphere.radius == pytest.approx(5, abs=1e-6)
    np.testing.assert_allclose(sphere.centre, [0, 0, 16], atol=1e-6)
    assert cylinder.side == cone.side == sphere.side == 1


@pytest.mark.parametrize(("stretch", "recognised"), [(2e-5, True), (6e-3, False)])
def test_a_spline_is_a_cylinder_within_1e_5_of_its_size_and_not_off_by_1e_3(stretch, recognised, tmp_path):
    """The cylinder of radius 8 and height 10, stretched to an ellipse: off the best one by 4 `stretch` of 24.7 mm."""
    text = (DATA / "splines.step").read_text()
    for number in range(69, 83):  # its control points
        text = re.sub(
            rf"(#{number} = CARTESIAN_POINT\('',\()([^,]+)",
            lambda found: f"{found[1]}{float(found[2]) * (1 + stretch):.15g}",
            text,
        )
    (tmp_path / "off.step").write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # its edges are those of the circle, which may leave a crack
        (nose,), _ = read_step(tmp_path / "off.step")
    assert len(surfaces(nose, Cylinder)) == recognised
    assert any("freeform surface, not one of the four" in note for note in nose.notes) != recognised


def surfaces(part, kind):
    return [face.surface for face in part.faces if isinstance(face.surface, kind)]


def areas(triangles):
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2
