"""Mesh files of every format give the same parts; what is a part, what it is called, and in which unit it is."""

import re

import numpy as np
import pytest
import trimesh

from jaxkin.examples import path
from jaxkin.geometry.part import size
from jaxkin.io.load import load
from jaxkin.io.study import load_study
from tessellation import tessellated, write_stl

NAMES = ("cam", "follower", "frame")


@pytest.fixture(scope="module")
def cam():
    return tessellated(path("cam"), 0.35)


@pytest.fixture(scope="module")
def files(cam, tmp_path_factory):
    """A folder with the cam in one file of each format, and in one STL file a part."""
    folder = tmp_path_factory.mktemp("cam")
    meshes = {part.name: trimesh.Trimesh(**trimesh.triangles.to_kwargs(part.triangles)) for part in cam}
    scene = trimesh.Scene(meshes)
    alone = trimesh.Scene({"frame": trimesh.creation.box((1.0, 2.0, 3.0))})
    whole = trimesh.util.concatenate(list(meshes.values()))
    for suffix in ("glb", "3mf"):
        # 3MF is in millimetres where nothing else is said
        (folder / f"cam.{suffix}").write_bytes(scene.export(file_type=suffix))
        (folder / f"frame.{suffix}").write_bytes(alone.export(file_type=suffix))
    text = trimesh.exchange.obj.export_obj(scene, include_normals=False, include_color=False, include_texture=False)
    (folder / "cam.obj").write_text(text)
    (folder / "cam.ply").write_bytes(whole.export(file_type="ply"))
    (folder / "text.stl").write_text(whole.export(file_type="stl_ascii"))
    write_stl(folder / "whole.stl", whole.triangles)
    away = np.array([0.0, 0.0, 200.0])
    write_stl(folder / "apart.stl", np.concatenate([meshes["cam"].triangles, meshes["follower"].triangles + away]))
    for part in cam:
        write_stl(folder / f"{part.name}.stl", part.triangles)
    return folder


@pytest.mark.long
@pytest.mark.parametrize(
    ("file", "unit", "names"),
    [
        ("whole.stl", "", ("part 1", "part 2", "part 3")),
        ("text.stl", "", ("part 1", "part 2", "part 3")),
        ("cam.ply", "", ("part 1", "part 2", "part 3")),
        ("cam.obj", "", NAMES),
        ("cam.3mf", "mm", NAMES),
        ("cam.glb", "m", NAMES),
    ],
)
def test_every_format_gives_the_same_parts(files, cam, file, unit, names):
    """Bodies of a file with one node, else its nodes; corners to float32, surfaces with them."""
    assembly = load(files / file)
    assert (sorted(assembly.names), assembly.unit) == (sorted(names), unit)  # nodes are in the order of the file
    parts = {part.name: part for part in assembly.parts}
    for name, drawn in zip(names, cam, strict=True):
        part = parts[name]
        assert len(part.triangles) == len(drawn.triangles) and not part.notes
        # coordinates in float32
        np.testing.assert_allclose(part.box, drawn.box, atol=np.spacing(np.abs(drawn.box).max(), dtype=np.float32))
        radii = [
            sorted(face.surface.radius for face in p.faces if hasattr(face.surface, "radius")) for p in (part, drawn)
        ]
        np.testing.assert_allclose(*radii, rtol=1e-5)


@pytest.mark.long
def test_one_file_a_part(files):
    assembly = load({name: files / f"{name}.stl" for name in NAMES}, unit="mm")
    assert (assembly.names, assembly.unit, assembly.source) == (NAMES, "mm", "cam.stl, follower.stl, frame.stl")
    states = {tuple(sorted(contact.parts)): contact.state for contact in assembly.contacts() if contact.state != "a"}
    assert states == {("cam", "follower"): "b", ("cam", "frame"): "e", ("follower", "frame"): "e"}
    mechanism = assembly.mechanism(fixed=["frame"])
    assert (mechanism.mobility().freedoms, mechanism.unit) == (1, "mm")


def test_a_file_of_several_bodies_as_one_part(files):
    (part,) = load({"all": files / "apart.stl"}).parts
    assert part.name == "all"
    assert len(part.triangles) == sum(len(p.triangles) for p in load(files / "apart.stl").parts) > 100


def test_a_cavity_belongs_to_the_body_around_it(tmp_path):
    """A hollow box, and another box in its cavity: two bodies."""
    outer, inner, within = (trimesh.creation.box((s, s, s)).triangles for s in (10.0, 8.0, 5.0))
    assembly = load(write_stl(tmp_path / "boxes.stl", np.concatenate([outer, inner[:, ::-1], within])))
    assert [len(part.triangles) for part in assembly.parts] == [24, 12]


def test_a_part_wound_inwards_is_turned_round(tmp_path):
    box = trimesh.creation.box((1.0, 2.0, 3.0)).triangles
    (part,) = load(write_stl(tmp_path / "box.stl", box[:, ::-1])).parts
    assert part.notes == ("its triangles faced inwards: turned round",)
    assert all(face.surface.distance(np.zeros(3)) < 0 for face in part.faces)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_unit_does_not_matter(files, cam, scale, tmp_path):
    parts = load(write_stl(tmp_path / "part.stl", cam[1].triangles * scale)).parts
    assert [type(face.surface) for face in parts[0].faces] == [
        type(face.surface) for face in load(files / "follower.stl").parts[0].faces
    ]
    np.testing.assert_allclose(size(parts), scale * size(cam[1:2]), rtol=1e-6)


@pytest.mark.long
def test_units_that_differ_are_refused(files):
    with pytest.raises(ValueError, match=re.escape("frame (frame.3mf) is in mm, not in m: nothing is rescaled")):
        load({"frame": files / "frame.3mf"}, unit="m")
    with pytest.raises(ValueError, match=r"the files differ in their unit: a .* in m, b .* in mm; nothing is rescaled"):
        load({"a": files / "frame.glb", "b": files / "frame.3mf"})
    with pytest.raises(ValueError, match=r"cam \(cam.stl\): the format has no unit, but .*; say that all are"):
        load({"cam": files / "cam.stl", "frame": files / "frame.3mf"})
    with pytest.raises(ValueError, match=r"unit must be one of .*, got 'furlong'"):
        load(files / "cam.stl", unit="furlong")


def test_a_study_of_several_files(files):
    """Named in the table of its geometry, in the unit that it says."""
    listed = ", ".join(f'{name} = "{name}.stl"' for name in NAMES)
    (files / "study.toml").write_text(
        f'geometry = {{ {listed} }}\nunit = "mm"\nfixed = ["frame"]\n[drive]\ncam-frame = "0:90:3"\n'
    )
    study = load_study(files / "study.toml")
    assert (study.assembly.names, study.mechanism.unit) == (NAMES, "mm")
    np.testing.assert_allclose(study.drive["cam-frame.phi"], [0, np.pi / 4, np.pi / 2])


def test_colours_of_glb_are_of_linear_light(tmp_path):
    """glTF has 0.2140 for what a screen shows at one half (IEC 61966-2-1)."""
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    material = trimesh.visual.material.PBRMaterial(baseColorFactor=[0.2140, 1.0, 0.0, 1.0])
    box.visual = trimesh.visual.TextureVisuals(material=material)
    (tmp_path / "box.glb").write_bytes(trimesh.Scene(box).export(file_type="glb"))
    (part,) = load(tmp_path / "box.glb").parts
    np.testing.assert_allclose(part.color, (0.5, 1.0, 0.0), atol=3e-3)  # trimesh keeps eight bits of the linear light


@pytest.mark.parametrize("written", [str.upper, "\ufeff{}".format, lambda text: text.replace("\n", "\r\n")])
def test_stl_as_text_is_read_however_it_is_written(tmp_path, written):
    """In capitals, and behind the mark of UTF-8, it was taken for a damaged binary file."""
    text = trimesh.exchange.stl.export_stl_ascii(trimesh.creation.box((1.0, 2.0, 3.0)))
    (tmp_path / "box.stl").write_text(written(text), encoding="utf-8", newline="")
    (part,) = load(tmp_path / "box.stl").parts
    assert len(part.faces) == 6
    np.testing.assert_allclose(part.box, [[-0.5, -1.0, -1.5], [0.5, 1.0, 1.5]], atol=1e-12)
