"""OBJ as its exporters write it: corners that are counted back, groups, corners of no face, and decimal commas."""

import pytest
import trimesh

from jaxkin.io.load import load

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
