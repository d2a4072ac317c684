"""Couplings in files: in studies, and in whole mechanisms, which come back to the same numbers."""

import json
from inspect import signature

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.study_couplings import CouplingTable
from jaxkin.joints.coupling import COUPLINGS
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
        ('{"format": "jaxkin mechanism", "version": 99}', "version 99, and this jaxkin reads up to 1"),
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
