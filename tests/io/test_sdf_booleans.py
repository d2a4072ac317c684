"""Booleans of SDF: 1, or true in letters of any case, as sdformat reads them."""

import numpy as np
import pytest

import jaxkin as jk

MODEL = """<sdf version="1.9"><model name="m"><static>{static}</static><link name="a"/>
<link name="b"><pose degrees="{degrees}">1 0 0 0 0 90</pose></link>
<joint name="j" type="prismatic"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis></joint>
</model></sdf>"""


@pytest.mark.parametrize(
    ("said", "yes"), [("1", True), ("true", True), ("TRUE", True), ("True", True), ("0", False), ("false", False)]
)
def test_angles_are_degrees_and_models_rest_where_the_file_says_so(tmp_path, said, yes):
    angle = np.pi / 2 if yes else 90.0
    (tmp_path / "m.sdf").write_text(MODEL.format(degrees=said, static="false"))
    axis = jk.load(tmp_path / "m.sdf").mechanism().joints["j"].frames_1[0][:3, 2]
    np.testing.assert_allclose(axis, [np.cos(angle), np.sin(angle), 0], atol=1e-14)  # rounding of 90 radians
    (tmp_path / "m.sdf").write_text(MODEL.format(degrees="0", static=said))
    assert ({"a", "b"} <= {*jk.load(tmp_path / "m.sdf").mechanism().fixed}) == yes
