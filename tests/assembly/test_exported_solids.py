"""The solids of an export: their units, where each part may have its own."""

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from reference.exported import instance


@pytest.mark.parametrize(
    ("part", "root", "metres"),
    [
        ('<ModelUnits length="millimeter"/>', '<ModelUnits length="inch"/>', 0.001),
        ("", '<ModelUnits length="inch"/>', 0.0254),
        ("", "", 1.0),
    ],
)
def test_meshes_that_say_no_unit_are_in_that_of_the_model_of_their_part(tmp_path, part, root, metres):
    """Numbers of the file are in metres throughout: a plate of STL in millimetres was taken for a hundred metres."""
    edges = np.array([0.1, 0.2, 0.3])
    box = trimesh.creation.box(edges / metres)
    box.export(tmp_path / "plate.STL", file_type="stl")
    path = tmp_path / "machine.xml"
    path.write_text(
        f'<SimscapeMultibodyImportXML>{root}<DataUnits length="meter"/><RootAssembly name="machine"><InstanceTree>'
        f"{instance('plate', (0.5, 0, 0), grounded='true')}</InstanceTree></RootAssembly>"
        f'<Parts><Part uid="P" name="plate">{part}<GeometryFile name="plate.STL"/></Part></Parts>'
        "</SimscapeMultibodyImportXML>"
    )
    assembly = jk.load(path)
    (solid,) = assembly.parts
    np.testing.assert_allclose(
        solid.box, [(0.5, 0, 0) - edges / 2, (0.5, 0, 0) + edges / 2], atol=1e-6
    )  # single precision
    assert assembly.unit == "m"
    assert any("plate.STL in" in note for note in assembly.mechanism().notes)
