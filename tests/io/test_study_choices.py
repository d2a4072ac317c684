"""What is open in a study, as lines to uncomment: each of them makes a study that can be swept."""

import lzma
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.proposals import Proposal
from jaxkin.cli.app import app
from jaxkin.geometry.part import Part
from jaxkin.io.study_drives import can_drive, small_drive
from jaxkin.joints.evidence import Bond, Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from tessellation import write_stl

CHOICE = re.compile(r'^(\s*)# (?=instead = |off = |")')
FASTENER = Evidence(EvidenceKind.FASTENER, (("radius", 2.0),), "held by 'ground' only")
CLEARANCE = Evidence(EvidenceKind.CLEARANCE, (("clearance", 0.05),), "the pin has a clearance of 0.05")
DOUBTFUL = replace(
    CLEARANCE, doubt=Doubt(JointKind.CYLINDRICAL, "no face that is drawn stops its slide", Certainty.CENTRED)
)
LIFT_TABLE = Path(__file__).parents[1] / "assembly" / "data" / "lift_table.step.xz"


def bars(closed=True):
    """A four-bar linkage of boxes in mm, with two bolts in its ground, and a lamp that touches nothing; or one that is
    open between coupler and rocker."""
    pins = {"A": (0, 0, 0), "B": (0, 40, 0), "C": (120, 80, 0), "D": (100, 0, 0)}
    joined = {
        "A": ("ground", "crank"),
        "B": ("crank", "coupler"),
        "C": ("coupler", "rocker"),
        "D": ("ground", "rocker"),
    }
    places = {"ground": "AD", "crank": "AB", "coupler": "BC", "rocker": "CD"}
    middles = {name: np.mean([pins[pin] for pin in two], axis=0) for name, two in places.items()}
    middles |= {"bolt <1>": np.array([0, -10, 0]), "bolt <2>": np.array([100, -10, 0]), "lamp": np.array([0, 500, 0])}
    box = trimesh.creation.box((8.0, 6.0, 4.0)).triangles
    assembly = Assembly(tuple(Part(name, (), box + middle) for name, middle in middles.items()), "mm", "bars")
    joints = [jk.revolute(name, *joined[name], point=point, axis=(0, 0, 1)) for name, point in pins.items()]
    joints = [joint for joint in joints if closed or joint.name != "C"]
    joints[1:] = [replace(joint, evidence=DOUBTFUL if joint.name == "C" else CLEARANCE) for joint in joints[1:]]
    bolts = [["ground", "bolt <1>"], ["ground", "bolt <2>"]]
    mechanism = assembly.of_joints(fixed=["ground"], rigid=bolts, joints=joints)
    bonds = [Bond(bond.parts, FASTENER) if "lamp" not in bond.parts else bond for bond in mechanism.bonds]
    return replace(mechanism, bonds=tuple(bonds))


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The study of the four-bar linkage, with its solids as files beside it."""
    return written(bars(), tmp_path_factory.mktemp("bars"))


def written(mechanism, folder):
    geometry = {part.name: write_stl(folder / f"{part.name}.stl", part.triangles).name for part in mechanism.solids}
    tried = [
        Proposal(fixed, (), 1, 4, 4) for fixed in (("ground",), ("rocker",), ("ground", "coupler"), ("ground", "crank"))
    ]
    path = folder / "study.toml"
    jk.write_study(mechanism, path, geometry=geometry, drive=small_drive(mechanism), proposals=tried)
    return path


def variants(path):
    """The lines of a study that can be uncommented, each with the study in which it is."""
    lines = path.read_text("utf-8").splitlines()
    other = path.with_name("variant.toml")
    for number, line in enumerate(lines):
        if CHOICE.match(line):
            text = [*lines[:number], CHOICE.sub(r"\1", line), *lines[number + 1 :]]
            other.write_text("\n".join(text), "utf-8")
            yield line, jk.load_study(other)


def test_the_other_reading_of_a_doubtful_joint_is_beside_its_kind_with_what_it_gives(study):
    text = study.read_text("utf-8")
    (line,) = [line for line in text.splitlines() if "# or" in line]
    assert line.startswith(
        'kind = "revolute"  # or "cylindrical", since no face that is drawn stops its slide: it has '
    )
    other = study.with_name("other.toml")
    other.write_text(text.replace(line, 'kind = "cylindrical"'), "utf-8")
    mechanism = jk.load_study(other).mechanism
    assert mechanism.joints["C"].coordinates == ("z", "phi")
    assert (
        mechanism.mobility().useful == 1 and "one freedom of use in 4 bodies then" in line
    )  # the loop stops the slide


def test_a_joint_that_may_be_none_is_told_with_the_group_that_makes_one_body_of_its_parts(tmp_path):
    doubt = Doubt(JointKind.FIXED, "it fits exactly", Certainty.FIT)
    mechanism = bars(closed=False)  # a loop that moves needs its joints, which are in no such doubt
    joints = [
        replace(joint, evidence=replace(CLEARANCE, doubt=doubt)) if joint.name == "D" else joint
        for joint in mechanism.all_joints
    ]
    mechanism = replace(mechanism, linkage=mechanism.linkage.with_joints(joints))
    text = written(mechanism, tmp_path).read_text("utf-8")
    (line,) = [line for line in text.splitlines() if "in rigid" in line]
    assert 'or ["ground", "rocker"] in rigid, since it fits exactly: it has 2 freedoms of use in 3 bodies' in line


@pytest.mark.long
def test_the_study_is_the_mechanism_and_drives_it(study):
    read, given = jk.load_study(study), bars()
    assert set(map(frozenset, read.mechanism.bodies.values())) == set(map(frozenset, given.bodies.values()))
    assert read.fixed == ["ground"] and [*read.ranges] == ["A.phi"]
    assert can_drive(read.mechanism, [*read.ranges])
    assert "'lamp' is tied to nothing: left at rest" in study.read_text()


@pytest.mark.long
def test_each_line_that_is_uncommented_makes_a_study_that_can_be_driven(study):
    found = list(variants(study))
    kinds = [line.split()[1] for line, _ in found]
    assert kinds.count("instead") == 1 + 3  # the rocker to fix; the other pins to drive
    assert kinds.count("off") == 3 and kinds.count('"bolt*",') == 1 and kinds.count('"lamp",') == 1
    for line, read in found:
        assert can_drive(read.mechanism, [*read.ranges]), line


@pytest.mark.long
def test_what_is_instead_replaces_the_fixed_part_and_the_drive(study):
    for line, read in variants(study):
        if "instead = { fixed" in line:
            assert read.mechanism.fixed == ("rocker",) and "one freedom of use in 4 bodies" in line
            assert {"bolt <1>", "bolt <2>", "ground", "lamp"} in map(set, read.mechanism.bodies.values())
        elif "instead" in line:
            (name,) = read.ranges
            assert f'"{name}"' in line and name != "A.phi" and read.fixed == ["ground"]


@pytest.mark.long
def test_a_joint_that_is_off_is_gone_and_its_line_says_what_is_left(study):
    for line, read in variants(study):
        if "off = " in line:
            assert len(read.mechanism.joints) < len(bars().joints)
            useful = read.mechanism.mobility().useful
            assert f"{useful} freedoms of use in {len(read.mechanism.bodies)} bodies" in line and useful > 1


def test_parts_with_fractions_in_their_names_are_left_out_by_a_pattern_that_means_them(tmp_path):
    given = bars()
    names = {"bolt <1>": "Nut 5/16", "bolt <2>": "Nut 5/16#2"}
    parts = tuple(replace(each, name=names.get(each.name, each.name)) for each in given.solids)
    bolts = [["ground", name] for name in names.values()]
    joints = [each for each in given.joints.values() if each.freedoms]
    mechanism = Assembly(parts, "mm", "bars").of_joints(fixed=["ground"], rigid=bolts, joints=joints)
    jk.write_study(mechanism, tmp_path / "study.toml", geometry="bars.step", proposals=())
    assert '# "Nut 5/16*",  # 2 parts' in (tmp_path / "study.toml").read_text("utf-8")
    assert Assembly(parts, "mm", "bars").without(["Nut 5/16*"]).names == (*given.parts[:4], "lamp")


@pytest.mark.long
def test_parts_that_nothing_needs_are_named_with_their_size(study):
    given = bars()
    for line, read in variants(study):
        if '  # "' in line:
            gone = {*given.parts} - {*read.mechanism.parts}
            assert gone == ({"lamp"} if "lamp" in line else {"bolt <1>", "bolt <2>"})
            assert f"{np.linalg.norm((8, 6, 4)):.3g} across" in line
            assert [joint.name for joint in read.mechanism.all_joints if joint.freedoms] == ["A", "B", "C", "D"]


def test_a_body_comes_apart_where_its_line_is_taken_out(study):
    lines = study.read_text("utf-8").splitlines()
    (line,) = [line for line in lines if line.startswith('  ["ground", "bolt <2>"]')]
    assert line.endswith("# fastener: held by 'ground' only")
    other = study.with_name("apart.toml")
    other.write_text("\n".join(each for each in lines if each != line), "utf-8")
    mechanism = jk.load_study(other).mechanism
    assert "'bolt <2>' is tied to nothing: left at rest" in " ".join(mechanism.notes)
    assert "bolt <2>" in mechanism.fixed


@pytest.mark.parametrize(
    ("old", "new"),
    [("rigid = [", 'rigid = [["crank", "coupler"],'), ('fixed = ["ground"]', 'fixed = ["ground", "rocker"]')],
)
def test_joints_inside_a_body_that_somebody_adds_are_left_out_and_named(study, old, new):
    """What a user says of two parts is meant more than the joint that was found between them."""
    gone = "B" if "rigid" in new else "D"
    other = study.with_name("one_body.toml")
    other.write_text(study.read_text("utf-8").replace(old, new, 1), "utf-8")
    mechanism = jk.load_study(other).mechanism
    assert [joint.name for joint in mechanism.all_joints if joint.freedoms] == [each for each in "ABCD" if each != gone]
    (note,) = [note for note in mechanism.notes if "left out" in note]
    assert f"joint {gone!r}" in note and ("rigid" if gone == "B" else "fixed") in note


def test_a_drive_of_a_joint_inside_a_body_is_refused_with_the_reason(study):
    other = study.with_name("driven.toml")
    other.write_text(study.read_text("utf-8").replace("rigid = [", 'rigid = [["ground", "crank"],', 1), "utf-8")
    with pytest.raises(ValueError, match=r"driven\.toml: joint 'A' is left out, since fixed and rigid say.*is driven"):
        _ = jk.load_study(other).drive


def test_a_joint_of_exact_contacts_can_be_turned_off_and_what_somebody_said_is_left_to_them(tmp_path):
    """Faces that fit exactly in the modelled pose need not guide each other."""
    given = bars()
    known = {"A": Evidence(EvidenceKind.USER), "B": Evidence(EvidenceKind.CONTACT)}
    joints = [replace(each, evidence=known.get(each.name, CLEARANCE)) for each in given.joints.values()]
    assembly = Assembly(given.solids, "mm", "bars")
    mechanism = assembly.of_joints(fixed=["ground"], joints=[each for each in joints if each.freedoms])
    path = tmp_path / "study.toml"
    jk.write_study(mechanism, path, geometry="bars.step", proposals=())
    tables = {each[0]: each for each in path.read_text("utf-8").split('[joints."')[1:]}
    assert "# off = true" in tables["B"] and "off = true" not in tables["A"]


def test_joints_go_with_a_part_that_is_left_out(study):
    other = study.with_name("less.toml")
    other.write_text(study.read_text("utf-8").replace("exclude = [", 'exclude = ["rocker",', 1), "utf-8")
    mechanism = jk.load_study(other).mechanism
    assert [joint.name for joint in mechanism.all_joints if joint.freedoms] == ["A", "B"]


def test_a_small_drive_leaves_no_joint_beyond_a_small_range():
    """A slide at its dead centre moves the crank without bound: the crank drives; 1 mm of a long one stays 1 mm."""
    box = trimesh.creation.box((100.0, 100.0, 100.0)).triangles
    assembly = Assembly(tuple(Part(name, (), box) for name in ("ground", "crank", "rod", "slider")), "mm", "boxes")
    pins = [("A", "ground", "crank", (0, 0, 0)), ("B", "crank", "rod", (10, 0, 0)), ("C", "rod", "slider", (90, 0, 0))]
    joints = [jk.revolute(name, one, other, point=point, axis=(0, 0, 1)) for name, one, other, point in pins]
    joints.append(jk.prismatic("D", "slider", "ground", point=(0, 0, 0), axis=(1, 0, 0)))
    mechanism = assembly.of_joints(fixed=["ground"], joints=joints)
    (name,), (text,) = zip(*small_drive(mechanism).items(), strict=True)
    assert name in ("A.phi", "B.phi", "C.phi")  # not the slide
    low, high, count = map(float, text.split(":"))
    assert -low == high <= 10 and count == 21  # degrees


@pytest.mark.long
@pytest.mark.study
def test_the_lift_table_is_swept_with_every_line(tmp_path):
    """The study that the command line writes of a real assembly, and each of its variants: some poses are closed."""
    (tmp_path / "lift.step").write_bytes(lzma.decompress(LIFT_TABLE.read_bytes()))
    study = tmp_path / "lift.toml"
    done = CliRunner().invoke(app, ["inspect", str(tmp_path / "lift.step"), "--study", str(study)])
    assert done.exit_code == 0, done.output
    done = CliRunner().invoke(app, ["sweep", str(study), "--out", str(tmp_path / "motion")])
    assert done.exit_code == 0 and "21  CLOSED" in done.output, done.output
    found = list(variants(study))
    assert len(found) > 6
    for line, read in found:
        assert np.asarray(read.sweep().on_branch).sum() > 10, line
