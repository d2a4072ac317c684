"""What is drawn of the links of a robot: meshes read together, and what a link collides with where nothing else can
be read."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io import mesh_nodes
from jaxkin.io.mesh_nodes import read_several

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
FACES = ((1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4))


def obj(path, size=1.0):
    """Write a tetrahedron of the given size."""
    lines = [f"v {x} {y} {z}" for x, y, z in size * CORNERS] + [f"f {a} {b} {c}" for a, b, c in FACES]
    path.write_text("\n".join(lines))
    return path


def dae(path, metres, size=1.0):
    """Write the tetrahedron in COLLADA, whose unit is so many metres, on a node moved by (0, 0, 3)."""
    points, faces = size * CORNERS, np.array(FACES) - 1
    path.write_text(f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{metres}"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">{" ".join(map(str, points.ravel()))}</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>{" ".join(map(str, faces.ravel()))}</p>
</triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1</matrix>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""")
    return path


def link(name, visual="", collision=""):
    tags = [
        f'<{tag}><geometry><mesh filename="{file}"/></geometry></{tag}>'
        for tag, file in (("visual", visual), ("collision", collision))
        if file
    ]
    return f'<link name="{name}">{"".join(tags)}</link>'


def robot(folder, *links):
    """Load a robot whose links hang on one hinge each."""
    names = [each.split('"')[1] for each in links]
    joints = [
        f'<joint name="to {name}" type="continuous"><parent link="base"/><child link="{name}"/></joint>'
        for name in names
    ]
    (folder / "robot.urdf").write_text(f'<robot name="r"><link name="base"/>{"".join((*links, *joints))}</robot>')
    return jk.load(folder / "robot.urdf")


@pytest.fixture
def runs(monkeypatch):
    """Count the programs that read meshes; one that meets a file called "bad" dies there."""
    real, counted = mesh_nodes.run_apart, []

    def run(worker, most, parts, target, *files, **bounds):
        counted.append([file.name for file in files])
        sound = [file for k, file in enumerate(files) if all("bad" not in each.name for each in files[: k + 1])]
        status = real(worker, most, parts, target, *sound, **bounds) if sound else (0, "")
        return status if len(sound) == len(files) else (-11, "")

    monkeypatch.setattr(mesh_nodes, "run_apart", run)
    return counted


def test_all_meshes_are_read_by_one_program(tmp_path, runs):
    for k in range(5):
        obj(tmp_path / f"{k}.obj", 1.0 + k)
    loaded = robot(tmp_path, *(link(f"l{k}", f"{k}.obj") for k in range(5)))
    assert len(runs) == 1 and len(runs[0]) == 5
    for k in range(5):
        part = next(part for part in loaded.parts if part.name == f"l{k}")
        assert np.ptp(part.triangles.reshape(-1, 3), axis=0).max() == pytest.approx(1.0 + k)


def test_what_one_file_does_to_the_program_hides_no_other(tmp_path, runs):
    paths = [obj(tmp_path / name) for name in ("a.obj", "b.obj", "bad.obj", "c.obj")]
    (damaged := tmp_path / "d.obj").write_text("v 0 0 0\nf 1 2 9\n")
    found = read_several([*paths, damaged])
    assert list(found) == [*paths, damaged]
    assert all(isinstance(found[path], list) for path in paths if path.stem in "abc")
    assert "bad.obj cannot be read as OBJ: the reader crashed on it" in str(found[paths[2]])
    assert isinstance(found[damaged], ValueError) and "d.obj" in str(found[damaged])
    assert [names[0] for names in runs] == ["a.obj", "bad.obj", "c.obj"]


def test_a_link_whose_look_cannot_be_read_is_drawn_as_what_it_collides_with(tmp_path):
    obj(tmp_path / "felt.obj", 2.0)
    loaded = robot(tmp_path, link("a", "seen.wrl", "felt.obj"), link("b", "seen.wrl", "gone.obj"))
    a, b = (next(part for part in loaded.parts if part.name == name) for name in "ab")
    assert np.ptp(a.triangles.reshape(-1, 3), axis=0).max() == pytest.approx(2.0) and a.is_solid
    assert not b.is_solid
    notes = "\n".join(loaded.mechanism().notes)
    assert "mesh 'seen.wrl' is not read" in notes and "'a', 'b' are drawn without it" in notes
    assert "mesh 'gone.obj' is not there; 'b' is drawn without it" in notes


def test_collada_is_read_in_metres_and_not_turned(tmp_path):
    """The axis that it calls up is left as it is, as in the viewers of ROS; its unit counts."""
    loaded = robot(
        tmp_path, link("a", dae(tmp_path / "a.dae", 0.01, 50.0).name), link("b", dae(tmp_path / "b.dae", 1).name)
    )
    a, b = (next(part for part in loaded.parts if part.name == name).triangles.reshape(-1, 3) for name in "ab")
    np.testing.assert_allclose([a.min(axis=0), a.max(axis=0)], [[0, 0, 0.03], [0.5, 0.5, 0.53]], atol=1e-7)  # float32
    np.testing.assert_allclose([b.min(axis=0), b.max(axis=0)], [[0, 0, 3], [1, 1, 4]], atol=1e-6)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("solid", "no COLLADA file"),
        ('<!DOCTYPE x [<!ENTITY a "aa">]><COLLADA/>', "no DOCTYPE"),
        ("<COLLADA>", "cannot be read as DAE"),
    ],
)
def test_what_is_no_collada_is_named(tmp_path, text, why):
    (tmp_path / "a.dae").write_text(text)
    assert why in "\n".join(robot(tmp_path, link("a", "a.dae")).mechanism().notes)


def test_a_blank_line_before_the_declaration_is_read(tmp_path):
    loaded = robot(tmp_path, link("a"))
    file = tmp_path / "robot.urdf"
    file.write_text("\n\n<?xml version='1.0'?>\n" + file.read_text())
    assert [part.name for part in jk.load(file).parts] == [part.name for part in loaded.parts]


def test_a_part_of_a_model_of_mujoco_is_named_as_such(tmp_path):
    (file := tmp_path / "defaults.xml").write_text("<mujocoinclude><default/></mujocoinclude>")
    with pytest.raises(ValueError, match="load the file that includes it"):
        jk.load(file)
