"""Assemblies far from the origin: only what their files round widens what counts as touching, and a note says so."""

import re
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.contacts.tolerance import default_length
from jaxkin.examples import path
from jaxkin.geometry.part import size
from jaxkin.io.step_rounding import text_rounding

HALVES = (Path(__file__).parent / "data" / "halves.step").read_text()
CRANK = Path(path("slider_crank")).read_text()
FAR = (123456.789, -54321.123, 7654.321)
NUMBERS = re.compile(r"((?:CARTESIAN_POINT|DIRECTION)\s*\('[^']*',\s*)\(([^()]*)\)")


def rewritten(text, by=(0.0, 0.0, 0.0), digits=17, which=lambda statement: "POINT" in statement):
    """Add a vector to those points of space that are chosen, and round all points and directions to some digits."""

    def changed(statement):
        found = NUMBERS.search(statement)
        if found is None:
            return statement
        values = np.array(found[2].split(","), float)
        values += by if len(values) == 3 and which(statement) else 0.0
        numbers = [f"{value:.{digits - 1}E}" for value in values]
        return f"{statement[: found.start()]}{found[1]}({','.join(numbers)}){statement[found.end() :]}"

    return ";".join(map(changed, text.split(";")))


def placed(text, by, digits=17):
    """Place all parts of a file farther away by a vector, their shapes as they are."""
    frames = re.findall(r"ITEM_DEFINED_TRANSFORMATION\('','',#\d+,#(\d+)\)", text)
    points = {point for frame in frames for point in re.findall(rf"#{frame} = AXIS2_PLACEMENT_3D\('',#(\d+)", text)}
    return rewritten(text, by, digits, lambda statement: statement.split("=")[0].strip(" \n#") in points)


def load(tmp_path, text):
    file = tmp_path / "far.step"
    file.write_text(text)
    return jk.load(file)


def touching(contacts):
    return {(contact.parts, contact.faces, contact.state) for contact in contacts}


@pytest.mark.parametrize("by", [(1e5, 0.0, 0.0), (1e5, -2e5, 5e4)])
def test_a_pin_beside_the_middle_of_its_hole_is_seen_however_far_its_shape_is_from_the_origin(tmp_path, by):
    """The surfaces are known to 1e-9 there, of parts of 30 mm; 0.05 is 200 times what counts as touching."""
    assert touching(load(tmp_path, rewritten(HALVES, by)).contacts())
    moved = placed(HALVES, (0.05, 0.0, 0.0)).replace("5.0000000000000003E-02", "0.", 1)  # the plate alone
    for text in (moved, rewritten(moved, by)):
        assembly = load(tmp_path, text)
        contacts = assembly.contacts()
        assert not contacts
        assert len(contacts.near_misses) == 1
        assert not contacts.notes
        assert default_length(assembly.parts) < 1.01e-5 * size(assembly.parts)


def test_placements_far_away_are_those_of_the_file(tmp_path):
    """At 1.4e5 mm double precision has steps of 3e-11 mm; the reader rounds places to steps of 0.0156 mm."""
    near = load(tmp_path, CRANK)
    far = load(tmp_path, placed(CRANK, FAR))
    assert touching(far.contacts()) == touching(near.contacts())
    assert max(contact.misfit for contact in far.contacts()) < 1e-9
    assert default_length(far.parts) == pytest.approx(default_length(near.parts), rel=1e-6)
    assert not far.contacts().notes


def test_placements_far_away_that_are_rounded_to_single_precision_are_told(tmp_path, monkeypatch):
    """Where the text does not have them: places are off by up to 0.0078 mm along each axis."""
    near = load(tmp_path, CRANK).contacts()
    monkeypatch.setattr("jaxkin.io.step.FilePlacements", lambda text: None)
    assembly = load(tmp_path, placed(CRANK, FAR))
    far = assembly.contacts()
    assert touching(far) == touching(near)
    assert max(contact.misfit for contact in far) > 1e-3 * default_length(assembly.parts)
    assert 0.01 < default_length(assembly.parts) < 0.03
    (note,) = far.notes
    assert re.match(r"gaps of up to 0\.0\d+ count as none: the place of '\w+' is rounded by 0\.\d+", note)
    assert not assembly.contacts(length=1e-3).notes


def test_a_file_of_few_digits_keeps_its_contacts_far_away(tmp_path):
    """Seven digits leave steps of 0.1 mm at 1e5 mm."""
    near = load(tmp_path, CRANK).contacts()
    assembly = load(tmp_path, placed(CRANK, FAR, digits=7))
    assert touching(assembly.contacts()) == touching(near)
    assert 0.1 < default_length(assembly.parts) < 0.3


def test_digits_are_those_that_a_file_rounds_to(tmp_path):
    assert text_rounding(CRANK) < 1e-14
    assert text_rounding(rewritten(CRANK, digits=7)) == pytest.approx(5e-7)
    # round dimensions far away: as many digits as the place needs, and no more where the numbers are small
    assert text_rounding("".join(f"CARTESIAN_POINT('',({1e6 + k / 10},{k}.,12.5));" for k in range(99))) < 1e-14
    assert text_rounding("CARTESIAN_POINT('',(1.2.3,,*));") < 1e-14
