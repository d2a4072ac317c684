"""Couplings in files: in studies, and in whole mechanisms, which come back to the same numbers."""

import json
from dataclasses import replace
from inspect import signature

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.study_couplings import CouplingTable
from jaxkin.joints.coupling import COUPLINGS
from jaxkin.joints.evidence import Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from reference import mechanisms

Z = (0.0, 0.0, 1.0)
STUDY = """
fixed = ["ground"]
unit = "mm"
[joints.pinion]
kind = "revolute"
parts = ["ground", "shaft"]
point = [0, 0, 0]
axis = [0, 0, 1]
[joints.slide]
kind = "prismatic"
parts = ["ground", "bar"]
axis = [1, 0, 0]
[couplings.steering]
{coupling}
[drive]
pinion = "0:90:4"
"""
RACK = 'kind = "rack"\npinion = "pinion"\nrack = "slide"\nradius = 8.0'


def study(folder, coupling=RACK):
    (folder / "study.toml").write_text(STUDY.format(coupling=coupling))
    return jk.load_study(folder / "study.toml")


@pytest.mark.long
def test_a_study_couples(tmp_path):
    motion = study(tmp_path).sweep()
    np.testing.assert_allclose(motion.coordinates["slide"][-1], 4 * np.pi, rtol=1e-14)


def test_a_coupling_is_one_row_for_users_and_studies():
    """What its function takes is a key of a study, and users import the function."""
    for kind, function in COUPLINGS.items():
        assert set(signature(function).parameters) - {"name"} <= set(CouplingTable.model_fields)
        assert getattr(jk, kind) is function


@pytest.mark.long
@pytest.mark.parametrize(
    "coupling",
    [
        RACK,
        'kind = "relation"\nfactors = { pinion = 8.0, "slide.z" = -1.0 }',
        'kind = "polynomial"\nfollower = "slide"\nleader = "pinion"\ncoefficients = [0.0, 8.0, 0.5]',
    ],
)
def test_a_written_study_says_the_same(tmp_path, coupling):
    found = study(tmp_path, coupling)
    jk.write_study(found.mechanism, tmp_path / "again.toml", drive={"pinion.phi": "0:90:4"})
    again = jk.load_study(tmp_path / "again.toml").sweep()
    np.testing.assert_array_equal(again.coordinates["slide"], found.sweep().coordinates["slide"])


@pytest.mark.parametrize(
    ("coupling", "said"),
    [
        ('kind = "geer"', r"couplings.steering.kind: expected one of 'gear', .* got 'geer'; did you mean 'gear'"),
        ('kind = "gear"\na = "pinion"\nb = "slide"', "a coupling of kind 'gear' needs ratio"),
        (RACK.replace("8.0", '"8"'), "couplings.steering.radius: expected a number, got '8'"),
        (RACK.replace("radius", "radus"), r"no key 'couplings.steering.radus'; did you mean 'radius'"),
        (RACK + "\nratio = 2.0", "a coupling of kind 'rack' has no ratio; it takes pinion, rack, radius"),
        (RACK.replace("8.0", "0.0"), "study.toml: couplings.steering: the radius of 'pinion' must not be zero"),
        (
            'kind = "relation"\nfactors = { pinion = 1.0 }',
            "study.toml: couplings.steering: a coupling ties at least two",
        ),
        (RACK.replace('"slide"', '"slid"'), "coupling 'steering': there is no joint 'slid'; did you mean 'slide'"),
    ],
)
def test_what_is_wrong_in_a_study_is_named(tmp_path, coupling, said):
    with pytest.raises(ValueError, match=said):
        study(tmp_path, coupling).mechanism  # noqa: B018


def linkage():
    joints = [
        jk.revolute("A", "ground", "a", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "a", "b", point=(0, 1 / 3, 0), axis=Z),
        jk.revolute("C", "b", "c", point=(1.5, 3, 0), axis=Z),
        jk.revolute("D", "c", "d", point=(4, 1.1, 0), axis=Z),
        jk.revolute("E", "ground", "d", point=(4, 0, 0), axis=Z),
        jk.screw("S", "ground", "nut", point=(9, 0, 0), axis=(0.1, 0.2, 1.0), pitch=0.7),
    ]
    gears = [jk.gear("A", "E", -1.0), jk.relation({"E": 0.1, "S": 1 / 7})]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=gears, unit="mm")


@pytest.mark.long
def test_a_saved_mechanism_comes_back_to_the_same_numbers(tmp_path):
    mechanism = linkage()
    name = next(iter(mechanism.lengths))
    mechanism = mechanism.with_lengths({name: 1.02 * mechanism.lengths[name]})  # frames that differ on both parts
    back = jk.load(mechanism.save(tmp_path / "linkage.json")).mechanism()
    assert str(back) == str(mechanism)
    drive = {"A": np.linspace(0, 0.4, 7)}
    for one, other in zip(mechanism.sweep(drive).displacements, back.sweep(drive).displacements, strict=True):
        np.testing.assert_array_equal(one, other)


def test_limits_motors_and_the_ideal_joints_of_rounded_numbers_are_kept(tmp_path):
    robot = """<robot name="r"><link name="base"/><link name="arm"/><joint name="j" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-1" upper="2"/></joint>
    <transmission name="t"><joint name="j"/></transmission></robot>"""
    (tmp_path / "r.urdf").write_text(robot)
    back = jk.load(jk.load(tmp_path / "r.urdf").mechanism().save(tmp_path / "r.json")).mechanism()
    assert back.motors == ("j",) and back.joints["j"].limits == ((-1.0, 2.0),)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "is no mechanism that Mechanism.save wrote: Expecting"),
        ("[1]", 'it does not say "format": "jaxkin mechanism"'),
        ('{"format": "jaxkin mechanism", "version": 99}', "version 99, and this jaxkin reads up to 2"),
        ('{"format": "jaxkin mechanism", "version": 1, "unit": "mm"}', "there is no 'linkage'"),
    ],
)
def test_files_that_hold_no_mechanism_are_refused(tmp_path, text, said):
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises(ValueError, match=said):
        jk.load(tmp_path / "bad.json")


def test_a_damaged_mechanism_is_refused_and_other_words_too(tmp_path):
    path = linkage().save(tmp_path / "whole.json")
    for words in ({"fixed": ["ground"]}, {"align": 1e-3}, {"clearance": 0.5}, {"contacts": []}, {"infer": False}):
        with pytest.raises(ValueError, match=r"whole.json holds a whole mechanism: write .mechanism\(\) without"):
            jk.load(path).mechanism(**words)
    record = json.loads(path.read_text())
    record["linkage"]["joints"][0]["frames_1"] = [[1.0, 2.0]]
    path.write_text(json.dumps(record))
    with pytest.raises(ValueError, match=r"is no mechanism that Mechanism\.save wrote"):
        jk.load(path)
    with pytest.raises(ValueError, match=r"a mechanism is saved as a .json file, got 'm.toml'"):
        linkage().save("m.toml")


def _in(record, *keys):
    """The list or table in which the last of some keys is."""
    for key in keys[:-1]:
        record = record[key]
    return record


@pytest.mark.parametrize(
    ("keys", "value", "said"),
    [
        (("linkage", "joints", 0, "frames_1", 0, 1, 0), 0.5, "frames_1 of joint 'A' must be rigid 4x4 poses"),
        (("linkage", "joints", 0, "frames_1", 0, 3, 3), -1.0, "frames_1 of joint 'A' must be rigid 4x4 poses"),
        (("linkage", "joints", 0, "frames_1", 0, 0, 3), 10**400, "frames_1 of joint 'A' must be numbers"),
        (("linkage", "joints", 0, "limits"), [[2.0, -1.0]], "limits of joint 'A' must be two numbers, the lower one"),
        (("linkage", "joints", 0, "limits"), [[-1.0, 2.0]] * 2, "joint 'A' has 1 coordinates, and limits of 2"),
        (("linkage", "joints", 5, "pitch"), float("nan"), "the pitch of joint 'S' must be finite numbers"),
        (
            ("linkage", "joints", 5, "curves"),
            [None, None],
            "joint 'S' must have a curve for each movement that follows",
        ),
        (
            ("linkage", "couplings", 0, "coefficients"),
            [[1.0]],
            "of coupling .* 2 x n, got those of shape .1, 1",
        ),
        (("linkage", "couplings", 0, "offset"), [0.0], "offset of coupling .* finite numbers, one"),
        (("linkage", "couplings", 0, "angles"), "yes", "angles of coupling .* true, false or null, got 'yes'"),
        (("linkage", "spinning"), {"nobody": 1}, "spinning must name parts with their freedoms, got 'nobody'"),
        (("linkage", "joints", 0, "evidence"), {"kind": "rumour"}, "'rumour' is not a valid EvidenceKind"),
        (("bonds",), [{"parts": ["a", "z"], "evidence": {"kind": "user"}}], "a bond names the unknown part 'z'"),
        (("motors",), ["Z"], "there is no joint 'Z'"),
        (("motors",), "A", "motors must be a list of texts, got 'A'"),
        (("history",), [1], "each of history must be text, got 1"),
        (("version",), "1", "its version must be a whole number"),
    ],
)
def test_altered_numbers_and_words_of_a_saved_mechanism_are_refused(tmp_path, keys, value, said):
    """Frames that no rigid part has were swept without a word, and other values failed as errors of Python later."""
    path = linkage().save(tmp_path / "whole.json")
    record = json.loads(path.read_text())
    _in(record, *keys)[keys[-1]] = value
    path.write_text(json.dumps(record))
    with pytest.raises(ValueError, match=rf"whole\.json is no mechanism that Mechanism\.save wrote: .*{said}"):
        jk.load(path)


def test_what_cannot_be_read_back_is_not_saved(tmp_path):
    mechanism = linkage()
    bent = np.array(mechanism.joints["A"].frames_1) * 1.5
    first, *others = mechanism.all_joints
    bent = mechanism.with_linkage(mechanism.linkage.with_joints([replace(first, frames_1=bent), *others]))
    with pytest.raises(ValueError, match="frames_1 of joint 'A' must be rigid 4x4 poses"):
        bent.save(tmp_path / "bent.json")
    assert not [*tmp_path.iterdir()]


def test_what_joints_and_bodies_are_known_from_is_kept(tmp_path):
    """With their doubts, which the mechanism that was read back prints as before: it told nothing of them."""
    given = linkage()
    doubt = Doubt(JointKind.CYLINDRICAL, "nothing stops it along its axis", Certainty.NO_STOP)
    known = Evidence(EvidenceKind.CLEARANCE, (("clearance", 0.1), ("radius", 1 / 3)), "a pin with play 0.1", doubt)
    *others, last = given.all_joints
    joints = [replace(others[0], evidence=known), *others[1:], replace(last, evidence=None)]
    bond = jk.Bond(("a", "b"), Evidence(EvidenceKind.FASTENER, text="a screw"))
    mechanism = replace(given, linkage=given.linkage.with_joints(joints), bonds=(bond,))
    back = jk.load(mechanism.save(tmp_path / "known.json")).mechanism()
    assert [joint.evidence for joint in back.all_joints] == [joint.evidence for joint in joints]
    assert back.bonds == (bond,) and str(back) == str(mechanism) and "may be cylindrical" in str(back)
    record = json.loads((tmp_path / "known.json").read_text())
    del record["bonds"], record["linkage"]["joints"][0]["evidence"]
    (tmp_path / "first.json").write_text("\ufeff" + json.dumps(record | {"version": 1}))  # as before there was evidence
    assert jk.load(tmp_path / "first.json").mechanism().joints["A"].evidence is None


def test_words_about_a_saved_mechanism_are_taken_or_refused(tmp_path):
    """A unit is that of its lengths where the file has none; loops belong to robots, and a study says nothing of it."""
    path = mechanisms.planar_fourbar().save(tmp_path / "whole.json")
    assert jk.load(path).mechanism().unit == ""
    assert jk.load(path, unit="mm").unit == jk.load(path, unit="mm").mechanism().unit == "mm"
    with pytest.raises(ValueError, match=r"YAML file of the loops of a robot in URDF; whole\.json is none"):
        jk.load(path, loops=tmp_path / "loops.yaml")
    (tmp_path / "study.toml").write_text('geometry = "whole.json"\nfixed = ["ground"]\n')
    with pytest.raises(ValueError, match=r"study\.toml: whole\.json holds a whole mechanism.* in place of the study"):
        jk.load_study(tmp_path / "study.toml")
