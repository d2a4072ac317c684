"""The shipped assemblies and the gallery of states from STL: the same joints and the same motion as from STEP.

The STL files are tessellations of the STEP files, one of all parts, with float32 coordinates and without names: a part
is a connected body, in the order of the parts.
"""

import lzma
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.contacts.detect import find_contacts
from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.part import size
from jaxkin.io.mesh import read_mesh
from tessellation import tessellated, write_stl

CONTACT_STATES = Path(__file__).parents[1] / "contacts" / "data" / "states.step"
LIFT_TABLE = Path(__file__).parents[1] / "assembly" / "data" / "lift_table.step.xz"
ANGLES = {"fourbar": 0.2, "slider_crank": 0.3, "cam": 0.1, "eighteen_bars": 0.35, "air_cylinder": 0.25}


def from_stl(step, angle, folder):
    """The parts that are read from one STL file of all parts, and the parts of the STEP file."""
    drawn = tessellated(step, angle)
    file = write_stl(folder / "all.stl", np.concatenate([part.triangles for part in drawn]))
    parts, unit = read_mesh(file)
    assert unit == "" and [part.name for part in parts] == [f"part {k + 1}" for k in range(len(drawn))]
    return tuple(replace(part, name=there.name) for part, there in zip(parts, drawn, strict=True)), drawn


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(EXAMPLES))
def test_the_same_joints_and_the_same_motion(name, tmp_path):
    """To 1e-5 of the size, on a range in which every one of them moves."""
    example = EXAMPLES[name]
    step = jk.load(path(name))
    parts, _ = from_stl(path(name), ANGLES[name], tmp_path)
    found = replace(step, parts=parts).mechanism(fixed=example.fixed)
    wanted = step.mechanism(fixed=example.fixed)
    assert [(joint.name, joint.kind, joint.parts) for joint in found.all_joints] == [
        (joint.name, joint.kind, joint.parts) for joint in wanted.all_joints
    ]
    assert str(found.mobility()) == str(wanted.mobility())
    length = size(step.parts)
    for joint in wanted.all_joints:
        np.testing.assert_allclose(found.joints[joint.name].frames_1[..., :3, 2], joint.frames_1[..., :3, 2], atol=1e-5)
    driven = wanted.joints_between(*example.drive)[0]
    coordinate = {"prismatic": "z", "cylindrical": "z"}.get(wanted.joints[driven].kind, "phi")
    coordinate = "phi" if name == "eighteen_bars" else coordinate
    drive = {f"{driven}.{coordinate}": np.linspace(0, 0.05 * length if coordinate == "z" else 0.3, 5)}
    motion, expected = found.sweep(drive), wanted.sweep(drive)
    assert motion.closed.all() and expected.closed.all()
    assert max(float(np.max(np.abs(pose - np.eye(4)))) for pose in expected.transforms.values()) > 0.01
    for part, pose in expected.transforms.items():
        corners = next(p for p in step.parts if p.name == part).box
        corners = np.stack(np.meshgrid(*corners.T), axis=-1).reshape(-1, 3)
        moved, there = (
            corners @ T[:, :3, :3].mT + T[:, None, :3, 3] for T in map(np.asarray, (motion.transforms[part], pose))
        )
        np.testing.assert_allclose(moved, there, atol=1e-5 * length, err_msg=part)


@pytest.mark.long
@pytest.mark.parametrize("angle", [0.2, 0.35])
def test_a_machine_that_others_drew_has_the_same_joints_from_one_stl_file_a_part(angle, tmp_path):
    """The lift table: pins with play, enclosed pins and equal bores have to be inferred from triangles alike."""
    file = tmp_path / "lift_table.step"
    file.write_bytes(lzma.decompress(LIFT_TABLE.read_bytes()))
    step = jk.load(file)
    files = {}
    for number, part in enumerate(tessellated(file, angle)):
        files[part.name] = write_stl(tmp_path / f"{number}.stl", part.triangles)
    fixed = ["Base*", "CylBracket*"]
    found, wanted = (each.mechanism(fixed=fixed) for each in (jk.load(files, unit=step.unit), step))
    assert found.bodies == wanted.bodies
    assert [(joint.parts, joint.kind) for joint in found.all_joints] == [
        (joint.parts, joint.kind) for joint in wanted.all_joints
    ]
    assert found.mobility().useful == wanted.mobility().useful == 1


@pytest.mark.long
def test_every_state_is_found_between_meshes(tmp_path):
    """All 25 variants of the gallery, with the faces that were drawn: planes, cylinders, cones, spheres."""
    parts, drawn = from_stl(CONTACT_STATES, 0.35, tmp_path)
    for part, there in zip(parts, drawn, strict=True):
        kinds = [Counter(face.surface.kind for face in faces) for faces in (part.faces, there.faces)]
        assert kinds[0] == kinds[1] and not part.notes, part.name
    contacts = find_contacts(parts)
    found = {contact.parts[0][:-2]: (contact.state, contact.region) for contact in contacts}
    assert found == {part.name[:-2]: tuple(part.name.split()[:2]) for part in parts}
    assert len(contacts) == 25 and not contacts.near_misses and not contacts.notes
