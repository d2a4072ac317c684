"""A study that was written makes the mechanism that it was written from."""

from dataclasses import replace
from pathlib import Path

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from reference import catalogue, mechanisms
from reference.round_parts import assembly, block, part, pin, ring

BY_HAND = {
    "four-bar": mechanisms.planar_fourbar,
    "cam": mechanisms.cam,
    "Cardan": mechanisms.cardan_shafts,
    "RSSR": mechanisms.rssr_linkage,
    "ball in bore": mechanisms.ball_in_bore,
    "hexapod": catalogue.hexapod,
}


def assert_same(found: jk.Mechanism, given: jk.Mechanism) -> None:
    """The same parts, bodies and joints that move; frames but for rounding of the axes that they are made from."""
    assert found.fixed == given.fixed and set(found.parts) == set(given.parts) and found.unit == given.unit
    assert set(map(frozenset, found.bodies.values())) == set(map(frozenset, given.bodies.values()))
    moving = {joint.name: joint for joint in found.all_joints if joint.freedoms}
    assert moving.keys() == {joint.name for joint in given.all_joints if joint.freedoms}
    for name, joint in moving.items():
        other = given.joints[name]
        assert (joint.parts, joint.movements) == (other.parts, other.movements)
        np.testing.assert_allclose(joint.frames_1[:, :3, 2:], other.frames_1[:, :3, 2:], atol=1e-12)
        assert float(joint.pitch) == float(other.pitch)
    one, other = found.mobility(), given.mobility()
    assert (one.freedoms, one.idle_freedoms, one.drivable) == (other.freedoms, other.idle_freedoms, other.drivable)


@pytest.mark.long
@pytest.mark.parametrize("name", BY_HAND)
def test_joints_by_hand(name, tmp_path):
    given = BY_HAND[name]()
    jk.write_study(given, tmp_path / "study.toml")
    assert_same(jk.load_study(tmp_path / "study.toml").mechanism, given)


def test_slides_come_back_along_the_directions_that_they_had(tmp_path):
    joints = [
        jk.rectangular("table", "ground", "a", normal=(1, 2, 2), direction=(2, 1, -2), limits={"y": (-1, 2)}),
        jk.cartesian("gantry", "a", "b", axis=(1, 1, 0), direction=(1, -1, 3), point=(1, 2, 3)),
        jk.schoenflies("hand", "b", "c", axis=(0, 3, 4), direction=(5, 4, -3), point=(3, 2, 1)),
        jk.constant_angle("slope", "c", "d", axis1=(0, 3, 4), axis2=(1, 1, 1), direction=(1, 4, -3), point=(3, 2, 1)),
    ]
    given = jk.Mechanism.build(fixed=["ground"], joints=joints)
    jk.write_study(given, tmp_path / "study.toml")
    found = jk.load_study(tmp_path / "study.toml").mechanism
    assert_same(found, given)
    for joint in joints:
        np.testing.assert_allclose(found.joints[joint.name].frames_1, joint.frames_1, atol=1e-15)
        np.testing.assert_allclose(found.joints[joint.name].limits, joint.limits, atol=1e-15)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.long] * (name != "fourbar")) for name in EXAMPLES]
)
def test_shipped_assemblies_need_no_detection(name, tmp_path):
    given = jk.load(path(name)).mechanism(fixed=EXAMPLES[name].fixed)
    jk.write_study(given, tmp_path / "study.toml", geometry=Path(path(name)).as_posix())
    study = jk.load_study(tmp_path / "study.toml")
    assert_same(study.mechanism, given)
    assert study.assembly is not None and not study.assembly.found


@pytest.mark.long
def test_it_is_swept_by_the_range_that_it_was_given(tmp_path):
    given = mechanisms.planar_fourbar()
    jk.write_study(given, tmp_path / "study.toml", drive={"A.phi": "0:90:4"})
    motion, expected = jk.load_study(tmp_path / "study.toml").sweep(), given.sweep({"A": np.radians([0, 30, 60, 90])})
    for one, other in zip(motion.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


def test_motors_come_back(tmp_path):
    given = replace(mechanisms.planar_fourbar(), motors=("A", "D"))
    jk.write_study(given, tmp_path / "study.toml")
    assert jk.load_study(tmp_path / "study.toml").mechanism.motors == given.motors
    text = (tmp_path / "study.toml").read_text()
    (tmp_path / "study.toml").write_text(text.replace('motors = ["A"', 'motors = ["Q"'))
    with pytest.raises(ValueError, match=r"study\.toml: motors: there is no joint 'Q'"):
        _ = jk.load_study(tmp_path / "study.toml").mechanism


def test_without_a_range_it_says_what_can_drive(tmp_path):
    jk.write_study(mechanisms.planar_fourbar(), tmp_path / "study.toml")
    text = (tmp_path / "study.toml").read_text()
    assert '# "A.phi" = "0:10:11"' in text and "a range for this" in text
    with pytest.raises(ValueError, match="nothing is driven"):
        _ = jk.load_study(tmp_path / "study.toml").drive


def test_names_of_any_kind_come_back(tmp_path):
    names = ['a "quoted" part', "tab\tand\x7f\x01", "Ünïcode <1>/bolt #2", "back\\slash"]
    joints = [
        jk.revolute(f"joint of {part}", before, part, point=(k, 0, 0), axis=(0, 0, 1))
        for k, (before, part) in enumerate(zip(["ground", *names], names, strict=False))
    ]
    given = jk.Mechanism.build(fixed=["ground"], joints=joints)
    jk.write_study(given, tmp_path / "study.toml")
    assert_same(jk.load_study(tmp_path / "study.toml").mechanism, given)


@pytest.mark.long
def test_what_cannot_be_written_is_said_and_leaves_no_file(tmp_path):
    target = tmp_path / "study.toml"
    changed = mechanisms.planar_fourbar().with_lengths({("crank", "A", "B"): 41.0})
    with pytest.raises(ValueError, match=r"as after with_lengths: write mechanism\.close\(\)\.mechanism"):
        jk.write_study(changed, target)
    with pytest.raises(ValueError, match=r"say where they are from, as in geometry="):
        jk.write_study(jk.load(path("fourbar")).mechanism(fixed=["ground"]), target)
    with pytest.raises(ValueError, match="traced numbers"):
        jax.jit(lambda each: jk.write_study(each, target))(mechanisms.planar_fourbar())
    assert not list(tmp_path.iterdir())
    jk.write_study(changed.close().mechanism, target)
    assert_same(jk.load_study(target).mechanism, changed.close().mechanism)


def test_a_study_says_how_the_tolerances_that_it_advises_are_taken(tmp_path):
    """A lever with play on its pin, exact contacts only: the study that holds what was found has no use for them."""
    base = part("base", block((-40, -40, -10), (40, 40, 0)), pin(4.0, 0, 20))
    lever = part("lever", ring(4.2, 9.0, 0, 19.5), block((8, -4, 0), (40, 4, 6)))
    given = assembly(base, lever).mechanism(fixed=["base"], infer=False)
    jk.write_study(given, tmp_path / "study.toml", geometry="drawn.step")
    said = (tmp_path / "study.toml").read_text()
    assert "give fit=0.05" in said
    assert said.count("delete contacts = false, rigid and [joints]") == 1


def test_a_study_of_one_body_says_so(tmp_path):
    drawn = assembly(part("base", block((-40, -40, -10), (40, 40, 0))))
    jk.write_study(drawn.mechanism(fixed=["base"]), tmp_path / "study.toml", geometry="drawn.step")
    assert (tmp_path / "study.toml").read_text().startswith("# 1 part, 1 body, 0 joints that move;")


def test_near_misses_that_joints_and_bodies_account_for_are_not_in_a_study(tmp_path):
    """A screw thicker than its hole is one body with the base by inference: to hold both together is done. The play of
    the lever on its pin is told with its joint."""
    base = part("base", block((-40, -40, -10), (40, 40, 0)), pin(4.0, 0, 20), ring(3.4, 9.0, -30, -10))
    lever = part("lever", ring(4.2, 9.0, 0.5, 19.5), block((8, -4, 1), (40, 4, 6)))
    drawn = assembly(base, lever, part("screw", pin(4.0, -35, -12)))
    assert any("rigid=[['base', 'screw']]" in str(each) for each in drawn.contacts().near_misses)
    given = drawn.mechanism(fixed=["base"])
    assert given.bodies["base"] == ("base", "screw") and given.joints_between("base", "lever")
    jk.write_study(given, tmp_path / "study.toml", geometry="drawn.step")
    said = (tmp_path / "study.toml").read_text()
    assert "nearly" not in said and "give tolerance" not in said and '["base", "screw"]' in said
