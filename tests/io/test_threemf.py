"""3MF as slicers and CAD systems write it: several model files, components of components, and what is no part."""

import zipfile

import numpy as np
import pytest
import trimesh

from jaxkin.io.load import load

SPACES = (
    'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
    'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" xmlns:s="urn:slices"'
)
OTHER = "/3D/Objects/other.model"


def mesh(*edges):
    box = trimesh.creation.box(edges)
    corners = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in box.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in box.faces)
    return f"<mesh><vertices>{corners}</vertices><triangles>{triangles}</triangles></mesh>"


def thing(number, inside, **said):
    more = "".join(f' {key}="{value}"' for key, value in said.items())
    return f'<object id="{number}"{more}>{inside}</object>'


def use(number, pose=None, path=None, tag="component"):
    """A component at a pose (4, 4), of a model file."""
    where = "" if path is None else f' p:path="{path}"'
    rows = "" if pose is None else f' transform="{" ".join(map(repr, np.asarray(pose)[:3].T.ravel().tolist()))}"'
    return f'<{tag} objectid="{number}"{where}{rows}/>'


def parts(*inside):
    return f"<components>{''.join(inside)}</components>"


def moved(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def read(folder, objects, items, other=None, before=""):
    """Load a file of a root model and of another one."""
    said = f"<model {SPACES}>{before}<resources>{objects}</resources><build>{items}</build></model>"
    with zipfile.ZipFile(folder / "plate.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", said)
        if other is not None:
            archive.writestr(OTHER[1:], f"<model {SPACES}><resources>{other}</resources><build/></model>")
    return load(folder / "plate.3mf")


def item(number, pose=None, path=None):
    return use(number, pose, path, "item")


def middles(assembly):
    return {
        part.name: (part.box.mean(axis=0).round(9).tolist(), np.ptp(part.box, axis=0).tolist())
        for part in assembly.parts
    }


def test_objects_of_another_model_file_are_those_of_their_own_identifiers(tmp_path):
    """Slicers keep every object in a file of its own, where identifiers begin at 1 again; one file may hold several."""
    inner = thing(1, mesh(1, 2, 3), name="lever") + thing(2, mesh(4, 4, 4))
    root = thing(1, mesh(2, 2, 2), name="own") + thing(
        5, parts(use(1, path=OTHER), use(2, moved(20), OTHER), use(1, moved(40), OTHER)), name="plate"
    )
    assembly = read(tmp_path, root, item(5) + item(1, moved(-20)) + item(2, moved(0, 50), OTHER), inner)
    assert middles(assembly) == {
        "lever": ([0, 0, 0], [1, 2, 3]),
        "plate": ([20, 0, 0], [4, 4, 4]),
        "lever#2": ([40, 0, 0], [1, 2, 3]),
        "own": ([-20, 0, 0], [2, 2, 2]),
        "part 5": ([0, 50, 0], [4, 4, 4]),
    }


@pytest.mark.parametrize("seed", range(3))
def test_components_of_components_stand_where_their_transforms_put_them(tmp_path, seed):
    """Rows of the format are columns here: a random turn, scale and mirror a level."""
    rng = np.random.default_rng(seed)
    poses = []
    for _ in range(4):
        pose = np.eye(4)
        pose[:3] = np.hstack([np.linalg.qr(rng.normal(size=(3, 3)))[0] * rng.uniform(0.5, 2), rng.normal(size=(3, 1))])
        poses.append(pose)
    levels = "".join(thing(k + 2, parts(use(k + 1, pose)), name=f"level {k}") for k, pose in enumerate(poses[:3]))
    (part,) = read(tmp_path, thing(1, mesh(1, 2, 3)) + levels, item(4, poses[3])).parts
    whole = poses[3] @ poses[2] @ poses[1] @ poses[0]
    found = np.unique(part.triangles.reshape(-1, 3).round(9), axis=0)
    expected = np.unique((trimesh.creation.box((1, 2, 3)).vertices @ whole[:3, :3].T + whole[:3, 3]).round(9), axis=0)
    np.testing.assert_allclose(found, expected, atol=1e-8)
    corners = part.triangles
    assert np.linalg.det(corners).sum() / 6 == pytest.approx(6 * abs(np.linalg.det(whole[:3, :3])))  # faces outwards


@pytest.mark.parametrize("kind", ["support", "solidsupport", "surface", "other"])
def test_supports_and_what_is_never_made_are_no_parts_and_named(tmp_path, kind):
    """The type of what holds others is ignored, as the format says."""
    objects = thing(1, mesh(1, 2, 3), name="lever") + thing(2, mesh(2, 2, 2), name="leg", type=kind)
    objects += thing(3, parts(use(1), use(2, moved(9))), type=kind)
    with pytest.warns(
        UserWarning, match=rf"plate\.3mf: the object 'leg' \(of the type '{kind}'\) is no part, and left"
    ):
        assembly = read(tmp_path, objects, item(3))
    assert len(assembly.parts) == 1 and np.ptp(assembly.parts[0].box, axis=0).tolist() == [1, 2, 3]
    with pytest.raises(ValueError, match="holds no parts: the object 'leg'"):
        read(tmp_path, objects, item(2))


def test_what_is_placed_and_not_there_is_named(tmp_path):
    lever = thing(1, mesh(1, 2, 3), name="lever") + thing(2, "<mesh><vertices/><triangles/></mesh>", name="beams")
    with pytest.warns(
        UserWarning, match=r"'7' \(it is not in the file\), the object 'beams' \(without triangles\) are"
    ):
        read(tmp_path, lever, item(1) + item(7) + item(2))
    with pytest.raises(ValueError, match="its build has no items"):
        read(tmp_path, lever, "")


def test_corners_of_extensions_are_none_of_the_mesh(tmp_path):
    slices = '<s:vertices><s:vertex x="1" y="2"/></s:vertices><s:triangle v1="0"/>'
    assert len(read(tmp_path, f"<s:stack>{slices}</s:stack>" + thing(1, mesh(1, 2, 3)), item(1)).parts) == 1


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('x="0.5"', 'x="0,5"', "a corner of it has '0,5' where a number is expected; numbers have decimal points"),
        ('v1="1"', 'v1="99"', "its triangles name corners that are not there"),
        ('<object id="1"', '<object id="2"/><object id="2"', "two of its objects have the identifier '2'"),
        ("<item ", '<item transform="1 0 0" ', "has 3 numbers in place of 12"),
    ],
)
def test_what_is_wrong_is_told_in_words(tmp_path, old, new, said):
    with pytest.raises(ValueError, match=rf"^plate\.3mf cannot be read as 3MF: .*{said}"):
        text = thing(1, mesh(1, 2, 3)).replace(old, new)
        read(tmp_path, text, item(1).replace(old, new))
