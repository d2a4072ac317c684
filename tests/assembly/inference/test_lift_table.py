"""An assembly that others drew, from its STEP file alone, against the joints that its CAD system exported.

The lift table of the Simscape Multibody Multiphysics Library (MathWorks, licence beside the file): a parallelogram of
two links lifts a platform, a cylinder drives one of them. Its pins end in lugs that have no holes for them.
"""

import json
import lzma
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk

DATA = Path(__file__).parents[1] / "data"
FIXED = ["Base*", "CylBracket*"]


@pytest.fixture(scope="module")
def assembly(tmp_path_factory):
    file = tmp_path_factory.mktemp("lift table") / "lift_table.step"
    file.write_bytes(lzma.decompress((DATA / "lift_table.step.xz").read_bytes()))
    return jk.load(file)


@pytest.fixture(scope="module")
def mechanism(assembly):
    return assembly.mechanism(fixed=FIXED)


@pytest.fixture(scope="module")
def exported():
    """The mechanism of the exported joints, in metres."""
    data = json.loads((DATA / "lift_table.joints.json").read_text())
    joints = []
    for each in data["joints"]:
        parts = each["a"]["part"], each["b"]["part"]
        if each["type"] == "Weld":
            joints.append(jk.fixed(each["name"], *parts))
        else:
            make = getattr(jk, each["type"].lower())
            joints.append(make(each["name"], *parts, point=each["a"]["point"], axis=each["a"]["axis"]))
    fixed = [each["name"] for each in data["instances"] if each["grounded"]]
    return jk.Mechanism.build(fixed=fixed, joints=joints)  # nine digits, which building aligns


@pytest.mark.long
def test_without_inference_it_is_refused(assembly):
    with pytest.raises(ValueError, match="'Platform <1>' touches no other part"):
        assembly.mechanism(fixed=FIXED, infer=False)


@pytest.mark.long
def test_it_has_one_freedom_beside_idle_ones(mechanism, exported):
    assert mechanism.mobility().useful == exported.mobility().useful == 1
    owners = {part: body for body, parts in mechanism.bodies.items() for part in parts}
    welds = [joint.parts for joint in exported.all_joints if joint.kind == "fixed"]
    assert all(owners[one] == owners[other] for one, other in welds)


@pytest.mark.long
def test_what_is_inferred_is_told(mechanism):
    told = [note for note in mechanism.notes if note.startswith("inferred from")]
    assert len(told) == 7 and all("'" in note for note in told)
    assert sum("stands in the material of" in note for note in told) == 5


@pytest.mark.long
def test_what_to_fix_and_to_drive_is_proposed(assembly):
    best = assembly.proposals()[0]
    assert set(best.fixed) == {"Base <1>", "CylBracket <1>"} and best.freedoms == 1 and len(best.drive) == 1


@pytest.mark.long
def test_it_moves_as_the_exported_joints_do(mechanism, exported):
    """Every part within 0.01 mm; met are 1e-5 mm, the digits of the exporter."""
    angle = np.linspace(0.0, -0.15, 7)
    (name,) = mechanism.joints_between("Cylinder <1>", "Pin CylBracket <1>")
    there = exported.joints["RevoluteCylinderBracket"]
    drawn = mechanism.joints[name]
    along = np.sign(drawn.frames_1[0, :3, 2] @ there.frames_1[0, :3, 2])
    along *= 1 if drawn.parts.index("Cylinder <1>") == there.parts.index("Cylinder <1>") else -1
    motion, expected = mechanism.sweep({f"{name}.phi": along * angle}), exported.sweep({there.name: angle})
    assert np.all(motion.closed) and np.all(expected.closed)
    boxes = {part.name: part.box.mean(axis=0) for part in mechanism.solids}
    for part, centre in boxes.items():
        one, other = (np.asarray(each.transforms[part]) for each in (motion, expected))
        places = [moved[:, :3, :3] @ centre + moved[:, :3, 3] for moved in (one, other)]
        np.testing.assert_allclose(*places, atol=1e-5)
