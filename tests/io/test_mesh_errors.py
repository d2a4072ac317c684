"""Mesh files that are broken or hostile: one clear message each, within bounded time and memory."""

import io
import json
import struct
import zipfile

import numpy as np
import pytest
import trimesh

from jaxkin.examples import path
from jaxkin.geometry import region_growing
from jaxkin.io.load import load
from jaxkin.io.mesh_check import MAX_MESH_NODES, MAX_TRIANGLES
from tessellation import RECORD, write_stl

BOX = trimesh.creation.box((10.0, 20.0, 30.0))
CORNERS = np.asarray(BOX.triangles)
NOISE = np.random.default_rng(0).bytes(20_000)


def stl(corners, count=None):
    records = np.zeros(len(corners), RECORD)
    records["corners"] = corners
    return bytes(80) + np.uint32(len(corners) if count is None else count).tobytes() + records.tobytes()


def ply(vertices, faces, body=b""):
    head = f"ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n"
    return (head + f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n").encode() + body


def threemf(model, name="3D/3dmodel.model"):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr(name, model)
    return buffer.getvalue()


def model(objects, unit="millimeter"):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in BOX.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in BOX.faces)
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    listed = "".join(
        f'<object id="{name}" type="model"><components>'
        + "".join(f'<component objectid="{child}"/>' for child in children)
        + "</components></object>"
        for name, children in objects.items()
    )
    return (
        f'<?xml version="1.0"?><model unit="{unit}" xmlns="{space}"><resources><object id="0" type="model">{mesh}'
        f'</object>{listed}</resources><build><item objectid="{max(objects, default=0)}"/></build></model>'
    )


def glb(nodes, count=36):
    """A box whose accessor claims `count` corners."""
    data = CORNERS.astype("<f4").tobytes()
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": nodes,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "buffers": [{"byteLength": len(data)}],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


BROKEN = {
    "empty.stl": (b"", "is empty"),
    "zeros.stl": (bytes(20_000), "its header announces 0 triangles, which take 84 bytes, but it has 20000"),
    "solid.stl": (b"ISO-10303-21;\nHEADER;\n" + NOISE, r"is a STEP file: call it solid\.step"),
    "solid.obj": (b"ISO-10303-21;\nHEADER;\n", r"is a STEP file: call it solid\.step"),
    "none.stl": (stl(CORNERS[:0]), "holds no triangles"),
    "claims.stl": (stl(CORNERS, 2**32 - 1), "announces 4294967295 triangles, which take 214748364834 bytes, but"),
    "noise.stl": (NOISE, "is damaged or cut off, or no STL file"),
    "nan.stl": (stl(np.where(np.arange(12)[:, None, None] == 3, np.nan, CORNERS)), "1 of its triangles .* no numbers"),
    "point.stl": (stl(np.ones((12, 3, 3))), "all its triangles are one point"),
    "lines.stl": (stl(CORNERS[:, [0, 1, 1]]), "no triangles but points and lines"),
    "sheet.stl": (stl(np.concatenate([CORNERS[:2], CORNERS[:2, ::-1]])), "is a sheet, or nothing"),
    "open.stl": (stl(CORNERS[1:]), r"is not closed, .* there is a hole near \(.*\), [\d.]+ across with 3 edges; close"),
    "mixed.stl": (stl(np.concatenate([CORNERS[:6], CORNERS[6:, ::-1]])), "not all wound the same way"),
    "vast.stl": (stl(CORNERS * 1e30), r"a part of the size 3.7e\+31 is none in any unit"),
    "minute.stl": (stl(CORNERS * 1e-30), "a part of the size 3.7e-29 is none in any unit"),
    "far.stl": (stl(CORNERS + 1e7), r"coordinates up to 1e\+07 leave too few digits"),
    "text.stl": (b"solid a\n facet normal 0 0 0\n outer loop\n vertex 0 0 0\n", "does not end with endsolid"),
    "words.stl": (
        b"solid a\n facet\n vertex a b c\n endfacet\nendsolid a\n",
        "holds no triangles|cannot be read as STL",
    ),
    "zeros.obj": (bytes(500), "is no OBJ file"),
    "points.obj": (b"v 0 0 0\nv 1 0 0\n", "holds no triangles"),
    "flat.obj": (b"v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n", "its corners have 2 coordinates"),
    "overflow.obj": (b"v 0 0 0\nv 1e300 0 0\nv 0 1e300 0\nf 1 2 3\n", "a part of the size inf is none in any unit"),
    "index.obj": (b"v 0 0 0\nv 1 0 0\nf 1 2 99999999\n", "cannot be read as OBJ"),
    "noise.ply": (NOISE, "does not begin with ply"),
    "claims.ply": (ply(4_000_000_000, 1), "announces 4000000000 of vertex, but 0 bytes follow"),
    "index.ply": (ply(3, 1, b"0 0 0\n1 0 0\n0 1 0\n3 0 1 7000\n"), "name corners that are not there"),
    "zeros.3mf": (bytes(20_000), "is damaged or no 3MF file"),
    "empty.3mf": (threemf("hello", "a.txt"), "there is no 3D/3dmodel.model in it"),
    "bomb.3mf": (lambda: threemf(b" " * 600_000_000), "unpacks to 600 MB, more than 500"),
    "unit.3mf": (threemf(model({}, "parsec")), "is in the length unit 'parsec': export it in micron"),
    "itself.3mf": (threemf(model({1: (0, 2), 2: (1,)})), "nested without end"),
    "doubled.3mf": (threemf(model({k: (k - 1, k - 1) for k in range(1, 40)})), f"more than {MAX_MESH_NODES} parts"),
    "noise.glb": (NOISE, "does not begin with glTF"),
    "short.glb": (glb([{"mesh": 0}])[:-4], "is damaged or cut off"),
    "claims.glb": (glb([{"mesh": 0}], 2**31), "cannot be read as GLB"),
    "circle.glb": (glb([{"mesh": 0, "children": [1]}, {"mesh": 0, "children": [0]}]), "cannot be read as GLB"),
}


OF_THEIR_KIND = ("points.obj", "flat.obj", "overflow.obj", "doubled.3mf", "circle.glb")
"""Files that libraries read, in processes of their own, as they do another one of the same format."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.long] * (name in OF_THEIR_KIND)) for name in BROKEN]
)
def test_broken_files_are_refused_in_one_line(tmp_path, capfd, name):
    content, message = BROKEN[name]
    file = tmp_path / name
    file.write_bytes(content() if callable(content) else content)  # what takes seconds is made only for its test
    with pytest.raises(ValueError, match=message) as caught:
        load(file)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == [file]


def test_ten_million_triangles_are_refused_unread(tmp_path):
    file = tmp_path / "many.stl"
    with file.open("wb") as target:
        target.write(bytes(80) + np.uint32(10_000_000).tobytes())
        target.truncate(84 + 50 * 10_000_000)  # a sparse file
    with pytest.raises(ValueError, match=f"holds 10000000 triangles, more than {MAX_TRIANGLES}: export it coarser"):
        load(file)


def test_a_part_that_cuts_itself_is_refused(tmp_path):
    """Two boxes that overlap, as one part."""
    file = write_stl(tmp_path / "crossed.stl", np.concatenate([CORNERS, CORNERS + 5.0]))
    with pytest.raises(ValueError, match="'crossed' cuts itself, or solids touch or overlap in it, near"):
        load({"crossed": file})


def test_the_same_file_twice_is_refused(tmp_path):
    file = write_stl(tmp_path / "box.stl", CORNERS)
    with pytest.raises(ValueError, match="'one' and 'other' are the same solid in the same place: leave one out"):
        load({"one": file, "other": file})
    step = path("cam").with_name("cam.step")
    with pytest.raises(ValueError, match="holds 3 solids, but is given as the one part 'cam'"):
        load({"cam": step, "box": file})


def test_a_solid_twice_in_one_mesh_is_one_part(tmp_path):
    file = write_stl(tmp_path / "twice.stl", np.concatenate([CORNERS, CORNERS]))
    with pytest.warns(UserWarning, match=r"twice\.stl: 'part 2' \(as 'part 1'\) is the same solid in the same place"):
        (part,) = load(file).parts
    assert part.name == "part 1" and part.notes == ("'part 2' is the same solid in the same place: left out",)


@pytest.mark.long
def test_free_forms_end_when_no_face_is_found(tmp_path, monkeypatch):
    """Triangles on no surface at all: named in the report after so many trials, however many triangles there are."""
    monkeypatch.setattr(region_growing, "MAX_FAILURES", 20)
    ball = trimesh.creation.icosphere(4, 10.0)
    rough = ball.vertices * (1 + 0.002 * np.random.default_rng(0).normal(size=(len(ball.vertices), 1)))
    (part,) = load(write_stl(tmp_path / "rough.stl", rough[ball.faces])).parts
    assert not part.faces
    *named, ended = part.notes
    assert all("freeform surface" in note for note in named)
    assert "the search for round faces ended at its bounds" in ended and "export the part as STEP" in ended


def test_an_obj_that_is_cut_off_among_corners_is_not_read_without_its_last_parts(tmp_path):
    """The parts before are whole: the file was read as these, without a word."""
    boxes = [trimesh.creation.box().apply_translation((3 * k, 0, 0)) for k in range(3)]
    scene = trimesh.Scene({f"box{k}": box for k, box in enumerate(boxes)})
    text = trimesh.exchange.obj.export_obj(scene, include_normals=False, include_color=False, include_texture=False)
    lines = text.splitlines(keepends=True)
    file = tmp_path / "boxes.obj"
    file.write_text(text)
    assert len(load(file, unit="mm").parts) == 3
    seen = set()
    for end in range(1, len(lines)):
        if lines[end - 1].startswith("v ") and any(line.startswith("f ") for line in lines[:end]):
            file.write_text("".join(lines[:end]))
            with pytest.raises(ValueError, match=r"boxes\.obj is cut off: behind its last face"):
                load(file, unit="mm")
            seen.add(end)
    assert len(seen) == 16  # corners of two boxes
