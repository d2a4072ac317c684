"""From a path to an assembly, and from there to its mechanism; what is said about parts that nothing holds."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import apply
from jaxkin.io.load import load

DATA = Path(__file__).parent / "data"
PLACEMENT = EXAMPLES["fourbar"].placement


@pytest.fixture(scope="module")
def fourbar():
    return load(path("fourbar"))


def shifted(part, x, z):
    """The part moved in the directions of the drawing."""
    pose = np.eye(4)
    pose[:3, 3] = PLACEMENT[:3, :3] @ [x, 0.0, z]
    faces = tuple(Face(face.name, face.surface.moved(pose), apply(pose, face.triangles)) for face in part.faces)
    return Part(part.name, faces, apply(pose, part.triangles), part.color)


@pytest.mark.long
def test_an_assembly_reads_well(fourbar):
    text = str(fourbar)
    assert text.splitlines()[0] == "Assembly of 4 parts from fourbar.step, lengths in mm"
    assert "coupler  4 cylinders, 4 planes" in text
    assert repr(fourbar) == "<Assembly 'fourbar.step': ground, crank, coupler, rocker; mm>"
    assert "face 4: torus, not one of the four surfaces" in str(load(DATA / "fillet.step"))


@pytest.mark.long
def test_a_path_with_blanks_and_accents(tmp_path, fourbar):
    file = tmp_path / "Bögen und Räder" / "four bar ü.step"
    file.parent.mkdir()
    file.write_bytes(path("fourbar").read_bytes())
    assert load(str(file)).names == fourbar.names


@pytest.mark.parametrize(("combine", "joints"), [(True, 4), (False, 8)])
def test_a_mechanism_of_an_assembly(fourbar, combine, joints):
    mechanism = fourbar.mechanism(fixed=["ground"], combine=combine)
    assert mechanism.parts == fourbar.names
    assert mechanism.fixed == ("ground",)
    assert mechanism.unit == "mm"
    assert mechanism.solids is fourbar.parts
    assert len(mechanism.joints) == joints
    assert not mechanism.notes
    assert fourbar.contacts() is fourbar.contacts()


def test_contacts_between_fixed_parts_are_left_out(fourbar):
    mechanism = fourbar.mechanism(fixed=["ground", "crank"])
    assert mechanism.joints_between("ground", "crank") == ()
    assert len(mechanism.joints) == 3


@pytest.mark.parametrize(
    ("fixed", "message"),
    [
        ([], "no part is fixed"),
        (["grund"], r"no part 'grund' to fix; did you mean 'ground'\?"),
    ],
)
def test_fixed_parts_that_are_none(fourbar, fixed, message):
    with pytest.raises(ValueError, match=message):
        fourbar.mechanism(fixed=fixed)


def test_parts_that_nothing_holds_are_named():
    nested = load(DATA / "nested.step")  # twice a bolt in a washer, and another bolt 10 mm above
    with pytest.raises(ValueError, match=r"^nested\.step: 'other bolt', 'bolt#3' touch no other part"):
        nested.mechanism(fixed=["washer"], infer=False)
    with pytest.raises(ValueError, match=r"no chain of contacts ties 'washer#2', 'bolt#2' to the fixed 'washer', "):
        nested.mechanism(fixed=["washer", "other bolt", "bolt#3"], infer=False)


def test_what_nearly_holds_a_part_is_said(fourbar):
    """The coupler 0.15 mm aside and 0.01 mm above: its holes are off their pins by more than the clearance of a fit."""
    parts = tuple(shifted(part, 0.15, 0.01) if part.name == "coupler" else part for part in fourbar.parts)
    with pytest.raises(ValueError, match="'coupler' touches no other part") as caught:
        replace(fourbar, parts=parts).mechanism(fixed=["ground"], infer=False)
    nearly = str(caught.value).splitlines()[1:]
    assert all("nearly (" in line and "coupler" in line for line in nearly)
    assert any("plane on plane" in line for line in nearly)
    assert any("cylinder in cylinder" in line for line in nearly)
