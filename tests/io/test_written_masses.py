"""Masses in files of robots that are written: read back they are the same, and MuJoCo and Pinocchio have them, too."""

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import cardan_shafts, planar_fourbar, slider_crank
from reference.round_trips import METRES
from reference.tied import press

WRITTEN = {"urdf": jk.write_urdf, "xml": jk.write_mjcf}


def weighed(mechanism, seed=0) -> jk.Masses:
    """Masses of any kind: a ball, a thing without axes of symmetry, a rod without thickness, a point, nothing."""
    rows = np.random.default_rng(seed)
    turn = np.linalg.qr(rows.normal(size=(3, 3)))[0]
    kinds = (0.4 * np.eye(3), turn @ np.diag([3.0, 4.0, 6.0]) @ turn.T, np.diag([0.0, 2.0, 2.0]), np.zeros((3, 3)))
    given, moving = {}, [part for part in mechanism.parts if part not in mechanism.fixed]
    for number, part in enumerate(moving):
        inertia = 1e-4 * kinds[number % 4]
        given[part] = jk.Mass(rows.uniform(0.1, 3.0), rows.uniform(-5, 5, 3), 0.5 * (inertia + inertia.T))
    return jk.masses(mechanism, given=given | {moving[-1]: 0})


def back(mechanism, masses, path):
    """What is read from the file that is written."""
    WRITTEN[path.suffix[1:]](mechanism, path, masses=masses)
    loops = path.with_suffix(".yaml")
    return jk.load(path, loops=loops if loops.exists() else None).mechanism()


@pytest.mark.parametrize("suffix", WRITTEN)
@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, cardan_shafts, press])
def test_masses_come_back(make, suffix, tmp_path):
    mechanism = make()
    masses = weighed(mechanism)
    again = jk.masses(back(mechanism, masses, tmp_path / f"robot.{suffix}"))
    metres = METRES[mechanism.unit]
    for number, part in enumerate(mechanism.parts):
        if part in mechanism.fixed:
            continue
        other = again.parts.index(part)
        np.testing.assert_allclose(again.mass[other], masses.mass[number], rtol=1e-15)
        if masses.mass[number]:
            # rounding of sums of places, and of turns to principal axes and back
            np.testing.assert_allclose(again.centre[other], metres * masses.centre[number], rtol=0, atol=1e-13)
        np.testing.assert_allclose(again.inertia[other], masses.inertia[number], rtol=0, atol=1e-17)
    assert float(again.total) == pytest.approx(float(masses.total), rel=1e-14)  # what is between joints has no mass


def test_mujoco_has_the_same_masses(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    mechanism = planar_fourbar()
    masses = weighed(mechanism)
    model = mujoco.MjModel.from_xml_path(str(jk.write_mjcf(mechanism, tmp_path / "model.xml", masses=masses)))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    metres, compared = METRES[mechanism.unit], 0
    for number, part in enumerate(mechanism.parts):
        if part in mechanism.fixed or float(masses.mass[number]) == 0:
            continue
        body, turn = model.body(part).id, data.ximat[model.body(part).id].reshape(3, 3)
        np.testing.assert_allclose(model.body_mass[body], masses.mass[number], rtol=1e-15)
        np.testing.assert_allclose(data.xipos[body], metres * masses.centre[number], atol=1e-12)
        found = turn @ np.diag(model.body_inertia[body]) @ turn.T
        np.testing.assert_allclose(found, masses.inertia[number], atol=1e-15)
        compared += 1
    assert compared == 2


def test_pinocchio_has_the_same_masses(tmp_path):
    pinocchio = pytest.importorskip("pinocchio")
    mechanism = planar_fourbar()
    masses = weighed(mechanism)
    model = pinocchio.buildModelFromUrdf(str(jk.write_urdf(mechanism, tmp_path / "robot.urdf", masses=masses)))
    data = model.createData()
    pinocchio.forwardKinematics(model, data, pinocchio.neutral(model))
    metres = METRES[mechanism.unit]
    for number, part in enumerate(mechanism.parts):
        if part in mechanism.fixed or float(masses.mass[number]) == 0:
            continue
        joint = model.frames[model.getFrameId(part, pinocchio.FrameType.BODY)].parentJoint
        own = data.oMi[joint].act(model.inertias[joint])
        np.testing.assert_allclose(own.mass, masses.mass[number], rtol=1e-15)
        np.testing.assert_allclose(own.lever, metres * masses.centre[number], atol=1e-12)
        np.testing.assert_allclose(own.inertia, masses.inertia[number], atol=1e-15)


TWO = """<mujoco><worldbody><body name="arm" pos="1 2 3"><joint name="a" axis="0 1 0"/>
<inertial pos="0.1 0.2 0.3" mass="2" euler="5 10 15" diaginertia="0.3 0.4 0.5"/><body name="hand" pos="0 0 1">
<joint name="b" axis="1 0 0"/>{geom}</body></body></worldbody></mujoco>"""


@pytest.mark.parametrize("suffix", WRITTEN)
def test_what_a_file_says_is_written_without_being_asked_for(suffix, tmp_path):
    (tmp_path / "two.xml").write_text(TWO.format(geom=""))
    mechanism = jk.load(tmp_path / "two.xml").mechanism()
    again = back(mechanism, None, tmp_path / f"again.{suffix}")
    was, now = jk.masses(mechanism), jk.masses(again)
    for part in ("arm", "hand"):
        one, other = was.parts.index(part), now.parts.index(part)
        np.testing.assert_allclose(now.mass[other], was.mass[one], rtol=1e-15)
        np.testing.assert_allclose(now.centre[other] * was.mass[one], was.centre[one] * was.mass[one], atol=1e-14)
        np.testing.assert_allclose(now.inertia[other], was.inertia[one], atol=1e-15)
    # the boxes that mark links without solids are no solids of the file
    assert not any(part.is_solid for part in again.solids)


def test_links_of_unknown_mass_are_named(tmp_path):
    (tmp_path / "two.xml").write_text(TWO.format(geom='<geom size="0.1"/>'))
    mechanism = jk.load(tmp_path / "two.xml").mechanism()
    with pytest.warns(UserWarning, match="nothing is known of what 'hand' weighs, and readers of URDF take it to"):
        jk.write_urdf(mechanism, tmp_path / "robot.urdf")
    back(mechanism, jk.masses(mechanism, "steel"), tmp_path / "robot.urdf")  # the remedy of the message
    jk.write_mjcf(mechanism, tmp_path / "model.xml")  # where MuJoCo computes it from the ball
    with pytest.raises(ValueError, match="no density of 'hand'"):
        jk.masses(jk.load(tmp_path / "model.xml").mechanism())


def test_fixed_parts_keep_their_masses_and_bodies_of_the_world_have_none(tmp_path):
    joint = jk.revolute("A", "world", "arm", point=(0, 0, 0), axis=(0, 0, 1))
    mechanism = jk.Mechanism.build(fixed=["world"], joints=[joint])
    masses = jk.masses(mechanism, given={"world": jk.Mass(5.0, (1, 0, 0)), "arm": jk.Mass(1.0, (0, 1, 0))})
    assert float(jk.masses(back(mechanism, masses, tmp_path / "model.xml")).total) == 1.0
    jk.write_urdf(mechanism, tmp_path / "robot.urdf", masses=masses)
    assert '<mass value="5.0"' in (tmp_path / "robot.urdf").read_text()


def test_masses_of_another_mechanism_are_refused(tmp_path):
    mechanism = planar_fourbar()
    for write, file in ((jk.write_urdf, "robot.urdf"), (jk.write_mjcf, "model.xml"), (jk.write_asmt, "model.asmt")):
        with pytest.raises(ValueError, match=r"masses are what jk\.masses\(mechanism, \.\.\.\) finds .* got float"):
            write(mechanism, tmp_path / file, masses=1.0)
        with pytest.raises(ValueError, match="got those of ground, crank"):
            write(mechanism, tmp_path / file, masses=weighed(slider_crank()))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, cardan_shafts, press])
def test_masses_come_back_from_the_solver_of_freecad(make, tmp_path):
    """The format names no unit: what comes back counts in the unit that it was written in."""
    mechanism = make()
    masses, metres = weighed(mechanism), METRES[mechanism.unit]
    jk.write_asmt(mechanism, tmp_path / "model.asmt", masses=masses)
    again = jk.load(tmp_path / "model.asmt").mechanism()
    found = {part.name: part.inertial for part in again.solids}
    for number, part in enumerate(mechanism.parts):
        if part in mechanism.fixed:
            continue
        assert found[part].mass == float(masses.mass[number])
        if found[part].mass:
            # rounding of places, some units from the origin
            np.testing.assert_allclose(found[part].centre, masses.centre[number], rtol=0, atol=1e-12)
        # turned to principal axes and back
        np.testing.assert_allclose(
            found[part].inertia, masses.inertia[number] / metres**2, rtol=0, atol=1e-13 / metres**2
        )


def test_unknown_masses_are_unknown_again_to_the_solver_of_freecad(tmp_path):
    text = jk.write_asmt(planar_fourbar(), tmp_path / "model.asmt").read_text()
    assert "MomentOfInertias\n\t\t\t\t\t1.0\t1.0\t1.0\n" in text
    again = jk.load(tmp_path / "model.asmt").mechanism()
    assert all(part.inertial is None for part in again.solids)
    (tmp_path / "bad.asmt").write_text(text.replace("\t\t\t\tMass\n\t\t\t\t\t1.0", "\t\t\t\tMass\n\t\t\t\t\t-2.0", 1))
    notes = "\n".join(jk.load(tmp_path / "bad.asmt").mechanism().notes)
    assert "PrincipalMassMarker: expected a mass from 0 on, got -2; it is not taken" in notes
    (tmp_path / "bad.asmt").write_text(text.replace("1.0\t1.0\t1.0\n", "1.0\tx\t1.0\n", 1))
    with pytest.raises(ValueError, match="MomentOfInertias"):
        jk.load(tmp_path / "bad.asmt")
