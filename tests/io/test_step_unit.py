"""How exact a file says its geometry is, and that faces within that are no matter for a note."""

from pathlib import Path

import pytest

import jaxkin as jk
from jaxkin.io.step_unit import uncertainty
from reference.archives import unpack

PACKED = Path(__file__).parents[1] / "assembly" / "data" / "lift_table_export.tar.xz"
SAID = "#40 = UNCERTAINTY_MEASURE_WITH_UNIT( LENGTH_MEASURE( {} ), #38, '', '' );"


@pytest.mark.parametrize(("number", "expected"), [("1.00000000000000E-06", 1e-6), ("0.01", 0.01), ("1.", 1.0)])
def test_the_uncertainty_is_read_as_files_write_it(number, expected):
    assert uncertainty(SAID.format(number)) == expected


@pytest.mark.parametrize("text", ["", SAID.format("..."), SAID.format("-1.0"), "LENGTH_MEASURE(1.0);"])
def test_what_is_no_uncertainty_is_none(text):
    assert uncertainty(text) == 0.0


def test_faces_are_noted_only_beyond_what_the_file_says_of_them(tmp_path):
    """An exporter's solids that say 1e-6 m; the same solids that say nothing have nothing more to tell."""
    unpack(PACKED, tmp_path, "Platform.step")
    file = tmp_path / "Platform.step"
    assert uncertainty(file.read_text()) == 1e-6
    assert jk.load(file).parts[0].notes == ()
