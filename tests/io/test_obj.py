"""OBJ as its exporters write it: corners that are counted back, groups, corners of no face, and decimal commas."""

import numpy as np
import pytest
import trimesh

from jaxkin.io.load import load
from jaxkin.io.obj_faces import triangles

BOXES = {"crank": trimesh.creation.box((1, 2, 3)), "rod": trimesh.creation.box((2, 2, 2)).apply_translation((9, 0, 0))}


def written(letter="o", back=False, boxes=BOXES):
    """The boxes, each under the letter of its name; corners of faces counted back from the face, or from the start."""
    lines, first = [], 1
    for name, box in boxes.items():
        start = -len(box.vertices) if back else first
        lines += [f"{letter} {name}", *("v {:g} {:g} {:g}".format(*corner) for corner in box.vertices), "vn 0 0 1"]
        lines += ["f " + " ".join(f"{k + start}//{-1 if back else 1}" for k in face) for face in box.faces]
        first += len(box.vertices)
    return "\n".join(lines) + "\n"


def boxes_of(folder, text):
    file = folder / "boxes.obj"
    file.write_text(text)
    return {part.name: part.box.tolist() for part in load(file).parts}


@pytest.mark.long
def test_corners_may_be_counted_back_from_their_face(tmp_path):
    """All were counted back from the end of the file: the first part was the second one, and left out as its twin."""
    assert boxes_of(tmp_path, written(back=True)) == {name: box.bounds.tolist() for name, box in BOXES.items()}
    split = written(back=True).replace("f -8//-1", "f \\\n -8//-1")
    assert boxes_of(tmp_path, split) == boxes_of(tmp_path, written())


@pytest.mark.long
def test_groups_that_are_solids_are_parts_with_their_names(tmp_path):
    """Also where they touch; groups of faces of one solid are none."""
    near = {**BOXES, "rod": trimesh.creation.box((2, 2, 2)).apply_translation((1.5, 0, 0))}
    assert boxes_of(tmp_path, written("g", boxes=near)) == {name: box.bounds.tolist() for name, box in near.items()}
    lines = written("g", boxes={"all": BOXES["crank"]}).splitlines()
    faces = [line for line in lines if line.startswith("f")]
    sides = [each for k, face in enumerate(faces) for each in (f"g side {k}", face)]
    text = "\n".join([line for line in lines if not line.startswith("f")] + sides)
    assert list(boxes_of(tmp_path, text)) == ["boxes"]


@pytest.mark.long
@pytest.mark.parametrize("whole", ["{}# end\n", "# Vertices: 18\n{}", "# 18 vertices, 24 faces\n{}"])
def test_corners_of_no_face_are_told_where_the_file_says_that_it_is_whole(tmp_path, whole):
    text = written() + "o light\nv 0 0 0\nv 1 1 1\n"
    with pytest.warns(
        UserWarning, match=r"boxes\.obj: behind its last face come corners that no face has, which are left"
    ):
        found = boxes_of(tmp_path, whole.format(text))
    assert found == boxes_of(tmp_path, written())
    for other in (text, whole.replace("18", "17").replace("# end", "").format(text)):
        with pytest.raises(ValueError, match=r"is cut off: .* or, if it is whole, add the line '# end' at its end"):
            boxes_of(tmp_path, other)


@pytest.mark.parametrize("kind", ["obj", "stl", "ply"])
def test_decimal_commas_are_told_as_such(tmp_path, kind):
    file = tmp_path / f"crank.{kind}"
    form = {"obj": written(), "stl": BOXES["crank"].export(file_type="stl_ascii")}
    text = form.get(kind) or BOXES["crank"].export(file_type="ply", encoding="ascii").decode()
    head, begin, rest = text.partition("end_header") if kind == "ply" else ("", "", text)
    file.write_text(head + begin + rest.replace(".", ","))
    with pytest.raises(ValueError, match=rf"^crank\.{kind} has numbers with commas, such as '-?\d+,\d+'.* points"):
        load(file)


def ring(rng, count, size):
    """A simple polygon (count, 2) around the origin, with corners at random distances up to a size."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, count - 3).tolist() + [0.1, 2.2, 4.3])
    return (size * rng.uniform(0.3, 1, count) * [np.cos(angles), np.sin(angles)]).T


def area(flat):
    x, y = flat.T
    return (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


@pytest.mark.parametrize("seed", range(30))
def test_faces_that_are_not_convex_are_divided_into_triangles_without_overlap(seed):
    """In any plane, however far away; the areas of the triangles, none turned over, add up to that of the face."""
    rng = np.random.default_rng(seed)
    flat = ring(rng, rng.integers(4, 15), 5.0)
    if seed % 3 == 0:  # a hole, with a bridge to it that is passed twice
        hole = 0.1 * ring(rng, 5, 5.0)[::-1]
        start = int(np.argmax(np.linalg.norm(flat, axis=1)))
        near = int(np.argmax(hole @ flat[start]))
        flat = np.concatenate(
            [np.roll(flat, -start, axis=0), flat[[start]], np.roll(hole, -near, axis=0), hole[[near]]]
        )
    flat = flat if seed % 2 else flat[::-1]
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    corners = np.pad(flat, ((0, 0), (0, 1))) @ turn.T + 1e4 * rng.normal(size=3) * (seed % 5 == 0)
    found = triangles(corners)
    if len(found) > 1:
        assert len(found) == len(flat) - 2
        areas = np.array([area(flat[rows]) for rows in found]) * np.sign(area(flat))
        assert areas.min() > -1e-7 and areas.sum() == pytest.approx(abs(area(flat)), rel=1e-9)
    else:
        assert found == [list(range(len(flat)))]
    turns = [area(np.take(flat, [k, k + 1, k + 2], axis=0, mode="wrap")) for k in range(len(flat))]
    assert len(found) > 1 or np.min(np.array(turns) * np.sign(area(flat))) >= 0


@pytest.mark.long
@pytest.mark.parametrize("start", [0, 2, 3])
def test_a_bracket_of_polygons_is_a_solid(tmp_path, start):
    """The fans of its two sides covered what is outside of it, and it was said to cut itself."""
    side = np.roll([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)], start, axis=0)
    around = [f"f {k + 1} {(k + 1) % 6 + 1} {(k + 1) % 6 + 7} {k + 7}" for k in range(6)]
    corners = [f"v {x} {y} {z}" for z in (0, 2) for x, y in side]
    (tmp_path / "bracket.obj").write_text("\n".join([*corners, "f 6 5 4 3 2 1", "f 7/1 8 9 10 11 12", *around]))
    (part,) = load(tmp_path / "bracket.obj").parts
    assert np.linalg.det(part.triangles).sum() / 6 == pytest.approx(14.0) and len(part.faces) == 8
