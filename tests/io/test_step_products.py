"""A product that a STEP file places many times is converted, read and fitted once, whatever its colours."""

import re
import warnings
from itertools import count
from pathlib import Path

import numpy as np
import pytest

import jaxkin.io.step as step
from jaxkin.examples import path
from jaxkin.io.step import read_step
from jaxkin.io.step_colors import one_color_each
from jaxkin.io.step_glb import ProductMesh

DATA = Path(__file__).parent / "data"


def counted(monkeypatch, name):
    """The calls of a function of the reader, as they are made."""
    calls, function = [], getattr(step, name)
    monkeypatch.setattr(step, name, lambda *given: (calls.append(given), function(*given))[1])
    return calls


def distances(part):
    """Distances of corners from the first one: those of a solid, wherever it is placed."""
    corners = part.triangles.reshape(-1, 3)
    return np.linalg.norm(corners - corners[0], axis=1)


@pytest.mark.parametrize("name", ["nested", "flanges"])
def test_each_product_is_fitted_once(name, monkeypatch):
    made = counted(monkeypatch, "make_solid")
    parts, _ = step.read_step(DATA / f"{name}.step")
    assert len(made) < len(parts)
    solids = {len(part.triangles): part for part in parts}
    assert len(made) == len(solids)  # the products of these files differ in their number of triangles
    for part in parts:
        # single precision of the file, over lengths of up to 200
        np.testing.assert_allclose(distances(part), distances(solids[len(part.triangles)]), atol=1e-9 * 200)


@pytest.mark.long
def test_parts_are_the_same_where_each_is_fitted_by_itself(monkeypatch):
    shared, _ = step.read_step(DATA / "flanges.step")
    numbers = count()
    monkeypatch.setattr(ProductMesh, "key", property(lambda mesh: str(next(numbers)).encode()))
    made = counted(monkeypatch, "make_solid")
    alone, _ = step.read_step(DATA / "flanges.step")
    assert len(made) == len(alone)
    for one, other in zip(shared, alone, strict=True):
        assert [face.name for face in one.faces] == [face.name for face in other.faces]
        assert np.array_equal(one.triangles, other.triangles)


def unpainted(text):
    return text.replace("STYLED_ITEM", "UNSTYLED_ITEM")


@pytest.mark.long
def test_a_part_with_several_colours_is_converted_once_and_has_all_its_faces(monkeypatch, tmp_path):
    text = (DATA / "painted.step").read_text()
    (tmp_path / "plain.step").write_text(unpainted(text))
    (plain,), _ = step.read_step(tmp_path / "plain.step")
    conversions = counted(monkeypatch, "convert")
    (painted,), _ = step.read_step(DATA / "painted.step")
    assert len(conversions) == 1
    assert np.array_equal(painted.triangles, plain.triangles)
    assert [face.name for face in painted.faces] == [face.name for face in plain.faces]
    assert plain.color is None
    assert painted.color is not None


@pytest.mark.long
def test_faces_without_a_colour_are_not_lost(monkeypatch, tmp_path):
    """Of a part some faces are painted, and neither the others nor the solid are: it is read again without colours."""
    text = (DATA / "painted.step").read_text()
    whole = [line for line in text.split(";") if "=STYLED_ITEM" in line.replace(" ", "")]
    assert len(whole) == 1
    number = whole[0].split("=")[0].strip()
    text = text.replace(whole[0], whole[0].replace("STYLED_ITEM", "UNSTYLED_ITEM"))
    text = text.replace("OVER_RIDING_STYLED_ITEM", "STYLED_ITEM").replace(f",{number})", ")")
    (tmp_path / "half.step").write_text(text)
    (part,), _ = step.read_step(tmp_path / "half.step")
    (painted,), _ = step.read_step(DATA / "painted.step")
    assert len(part.faces) == len(painted.faces)


def test_only_products_with_several_colours_are_written_anew():
    text = path("fourbar").read_text()  # four parts with a colour each
    assert one_color_each(text) == text
    painted = (DATA / "painted.step").read_text()
    once = one_color_each(painted)
    assert once != painted
    assert one_color_each(once) == once
    assert unpainted(once).count(";") == painted.count(";")


def test_damaged_styles_and_shells_end():
    """Shells in a circle, styles in a circle, and numbers that are not there."""
    text = """#1=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#2),#9);#2=MANIFOLD_SOLID_BREP('',#3);
    #3=CLOSED_SHELL('',(#3,#4,#5));
    #4=ADVANCED_FACE('',(),#9,.T.);#5=ADVANCED_FACE('',(),#9,.T.);#6=STYLED_ITEM('',(#7),#4);#7=STYLE((#8));
    #8=STYLE((#7,#99));#10=STYLED_ITEM('',(#11),#5);#11=COLOUR_RGB('',1.,0.,0.);#12=STYLED_ITEM('',(),#77);
    #13=OVER_RIDING_STYLED_ITEM('');"""
    assert "COLOUR_RGB" in one_color_each(text)


def test_parts_that_are_read_are_told():
    told = []
    parts, _ = step.read_step(path("fourbar"), progress=lambda done, total: told.append((done, total)))
    assert told == [(number, len(parts)) for number in range(1, len(parts) + 1)]


STYLE = (
    "#90003=PRESENTATION_STYLE_ASSIGNMENT((#90004));", "#90004=SURFACE_STYLE_USAGE(.BOTH.,#90005);",
    "#90005=SURFACE_SIDE_STYLE('',(#90006));", "#90006=SURFACE_STYLE_FILL_AREA(#90007);",
    "#90007=FILL_AREA_STYLE('',(#90008));", "#90008=FILL_AREA_STYLE_COLOUR('',#90009);",
    "#90009=COLOUR_RGB('',1.,0.,0.);",
)  # fmt: skip


@pytest.mark.parametrize(
    ("hidden", "told"),
    [
        (("#90001=INVISIBILITY((#90002));", "#90002=STYLED_ITEM('',(#90003),#{solid});", *STYLE), True),
        (("#90001=INVISIBILITY((#90002));", "#90002=PRESENTATION_LAYER_ASSIGNMENT('off','',(#{solid}));"), True),
        (("#90001=INVISIBILITY((#90002));", "#90002=STYLED_ITEM('',(#90003),#{point});", *STYLE), False),
    ],
)
def test_solids_that_the_file_hides_are_told(tmp_path, hidden, told):
    """They are parts as all others, without a word: spare ones touch what they are drawn in."""
    text = path("fourbar").read_text()
    crank = re.findall(r"#(\d+) = MANIFOLD_SOLID_BREP", text)[1]
    point = re.findall(r"#(\d+) = CARTESIAN_POINT", text)[0]
    end = text.rindex("ENDSEC;")
    lines = "\n".join(hidden).format(solid=crank, point=point)
    file = tmp_path / "hidden.step"
    file.write_text(f"{text[:end]}{lines}\n{text[end:]}")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        parts, _ = read_step(file)
    assert [part.name for part in parts] == ["ground", "crank", "coupler", "rocker"]
    texts = [str(each.message) for each in said]
    assert len(texts) == told
    assert all("solids of 'crank' are hidden in it" in text and "exclude=['crank']" in text for text in texts)
