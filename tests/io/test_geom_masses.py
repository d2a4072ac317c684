"""Masses of MuJoCo bodies that have no <inertial> of their own, or one in a frame: closed forms, and MuJoCo itself.

Tolerance: rounding of a few products of poses, 1e-12 of the size. MuJoCo keeps the corners of meshes in single
precision, and their inertias agree to 1e-8.
"""

import numpy as np
import pytest

import jaxkin as jk

MESH = (
    "<asset><mesh name='q' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 2 1 0 1 3 1 2 3 0 3 2' {}/></asset>"
    "<worldbody><body name='a'><joint name='j' axis='0 1 0'/><geom type='mesh' mesh='q' density='6000' {}/></body>"
    "</worldbody>"
)


def model(inside: str, before: str = "") -> str:
    body = f"<body name='a' pos='1 2 3' euler='10 20 30'><joint name='j' axis='0 1 0'/>{inside}</body>"
    return f"<mujoco>{before}<worldbody>{body}</worldbody></mujoco>"


def loaded(text: str, folder) -> jk.Mechanism:
    (folder / "model.xml").write_text(text)
    return jk.load(folder / "model.xml").mechanism()


def of_body(mechanism, **given) -> tuple[float, np.ndarray, np.ndarray]:
    masses = jk.masses(mechanism, **given)
    number = masses.parts.index("a")
    return float(masses.mass[number]), np.asarray(masses.centre[number]), np.asarray(masses.inertia[number])


def test_a_written_mass_goes_before_a_density_of_zero(tmp_path):
    mechanism = loaded(model("<geom size='.1' mass='1'/>", "<default><geom density='0'/></default>"), tmp_path)
    mass, centre, inertia = of_body(mechanism)
    assert mass == 1.0
    np.testing.assert_allclose(centre, [1, 2, 3], atol=1e-12)
    np.testing.assert_allclose(inertia, 0.004 * np.eye(3), atol=1e-15)  # 2/5 m r^2


def test_an_inertial_in_a_frame_is_read_there(tmp_path):
    inside = "<frame pos='1 0 0' euler='0 0 90'><inertial pos='1 0 0' mass='2' diaginertia='.1 .2 .25'/></frame>"
    text = model(inside).replace("pos='1 2 3' euler='10 20 30'", "")
    mass, centre, inertia = of_body(loaded(text, tmp_path))
    assert mass == 2.0
    np.testing.assert_allclose(centre, [1, 1, 0], atol=1e-12)
    np.testing.assert_allclose(inertia, np.diag([0.2, 0.1, 0.25]), atol=1e-15)


def test_what_weighs_nothing_is_not_weighed_with_the_rest(tmp_path):
    """The usual pair of a massless solid that is seen, and one for collisions, which has the density of water."""
    inside = (
        "<geom size='.2' mass='0.0' pos='1 0 0'/><geom size='.1' group='3'/><geom size='.3' group='5' density='0'/>"
    )
    mechanism = loaded(model(inside), tmp_path)
    alone = of_body(mechanism)
    with pytest.warns(UserWarning, match="the density is that of no part: the file has the mass of 'a'"):
        beside = of_body(mechanism, density=7850)
    for mass, centre, _ in (alone, beside):
        np.testing.assert_allclose(mass, 1000 * 4 / 3 * np.pi * 0.1**3, rtol=1e-12)
        np.testing.assert_allclose(centre, [1, 2, 3], atol=1e-12)


def test_solids_without_a_mass_stay_unknown(tmp_path):
    mechanism = loaded(model("<geom size='.1'/>"), tmp_path)
    with pytest.raises(ValueError, match="no density of 'a'"):
        jk.masses(mechanism)
    mass, *_ = of_body(mechanism, density=500)
    np.testing.assert_allclose(mass, 500 * 4 / 3 * np.pi * 0.1**3, rtol=1e-12)


def test_groups_that_do_not_count(tmp_path):
    before = "<compiler inertiagrouprange='0 1'/>"
    mechanism = loaded(model("<geom size='.1' mass='1'/><geom size='.1' mass='9' group='2'/>", before), tmp_path)
    assert of_body(mechanism)[0] == 1.0


@pytest.mark.parametrize("setting", ["settotalmass", "boundmass", "boundinertia"])
def test_settings_that_scale_masses_are_told(tmp_path, setting):
    """MuJoCo would give the body another mass, or inertia, than is written."""
    solid = "<geom size='.1' mass='1'/>"
    mechanism = loaded(model(solid, f"<compiler {setting}='3'/>"), tmp_path)
    assert of_body(mechanism)[0] == 1.0
    assert any(f"{setting}='3'" in note and "is not kept" in note for note in mechanism.notes)
    without = loaded(model(solid, f"<compiler {setting}='-1'/>"), tmp_path)
    assert not any(setting in note for note in without.notes)


def test_a_mesh_is_moved_to_its_reference_before_it_is_scaled(tmp_path):
    """A corner of a cube, of 1/6 of its volume, whose centre is at a quarter of each edge."""
    scaled = "scale='.1 .2 .3' refpos='.5 0 0'"
    text = f"<mujoco>{MESH.format(scaled, '')}</mujoco>"
    mechanism = loaded(text, tmp_path)
    mass, centre, _ = of_body(mechanism)
    np.testing.assert_allclose(mass, 6000 * 0.1 * 0.2 * 0.3 / 6, rtol=1e-12)
    np.testing.assert_allclose(centre, [0.1 * (0.25 - 0.5), 0.2 / 4, 0.3 / 4], atol=1e-12)
    # and it is drawn there
    solid = next(part for part in mechanism.solids if part.name == "a")
    np.testing.assert_allclose(solid.triangles.reshape(-1, 3).min(axis=0), [-0.05, 0, 0], atol=1e-12)


FACES, MIRRORED = "face='0 2 1 0 1 3 1 2 3 0 3 2'", "scale='1 -2 1'"
TURNED, PLACED = "scale='.1 .2 .3' refpos='.5 0 0' refquat='1 .2 .3 .4'", "pos='1 2 3'"
ALL = (
    "<geom type='capsule' size='.1 .3' pos='1 0 0' euler='10 20 30' mass='1.3'/>"
    "<geom type='box' size='.1 .2 .3' density='500'/><geom type='cylinder' fromto='0 0 0 1 1 1' size='.05'/>"
    "<geom type='ellipsoid' size='.1 .2 .3' pos='1 2 3' group='3'/>"
)


@pytest.mark.parametrize(
    "text",
    [
        model(ALL),
        model("<geom size='.1' mass='0' pos='1 0 0'/><geom size='.1'/>"),
        model(f"<frame pos='1 0 0' euler='40 0 90'>{ALL}</frame>"),
        f"<mujoco>{MESH.format(TURNED, PLACED)}</mujoco>",
        f"<mujoco>{MESH.format(TURNED, PLACED)}</mujoco>".replace(FACES, ""),
        f"<mujoco>{MESH.format(MIRRORED, PLACED)}</mujoco>".replace(FACES, ""),
        model("<geom type='capsule' size='.05' mass='1'/>", "<default><geom size='.1 .3'/></default>"),
    ],
    ids=["all kinds", "one without mass", "in a frame", "mesh", "hull", "mirrored hull", "one size of two"],
)
def test_masses_are_those_of_mujoco(text, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    known = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(known)
    mujoco.mj_forward(known, data)
    body = known.body("a").id
    turn = data.ximat[body].reshape(3, 3)
    mass, centre, inertia = of_body(loaded(text, tmp_path))
    np.testing.assert_allclose(mass, known.body_mass[body], rtol=1e-12)
    np.testing.assert_allclose(centre, data.xipos[body], atol=1e-12)
    expected = turn @ np.diag(known.body_inertia[body]) @ turn.T
    np.testing.assert_allclose(inertia, expected, atol=1e-8 * np.abs(expected).max())


def test_a_body_on_another_one_may_be_a_point(tmp_path):
    """An <inertial> without moments, which MuJoCo takes where the body does not move on its own."""
    inside = (
        "<inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/><body name='p'><inertial pos='2 0 0' mass='2'/></body>"
    )
    mechanism = loaded(model(inside).replace("pos='1 2 3' euler='10 20 30'", ""), tmp_path)
    total = jk.masses(mechanism)
    assert float(total.total) == 4.0
    centre = np.asarray(total.mass) @ np.asarray(total.centre) / 4.0
    np.testing.assert_allclose(centre, [1, 0, 0], atol=1e-12)


@pytest.mark.parametrize("option", ["<option gravity='0 -9.81 0'/>", "<option><flag gravity='disable'/></option>"])
def test_a_gravity_that_is_not_kept_is_told(option, tmp_path):
    notes = loaded(model("<geom size='.1'/>", option), tmp_path).notes
    assert any("gravity is not kept" in note for note in notes)
    assert not any("gravity" in note for note in loaded(model("<geom size='.1'/>"), tmp_path).notes)


@pytest.mark.parametrize(("written", "told"), [("1", True), ("0.00", False)])
def test_a_body_that_gravity_does_not_act_on_is_told(written, told, tmp_path):
    text = model("<geom size='.1'/>").replace("<body name='a'", f"<body name='a' gravcomp='{written}'")
    assert any("gravcomp is not kept" in note for note in loaded(text, tmp_path).notes) is told


def test_a_gravity_of_sdf_is_told(tmp_path):
    (tmp_path / "arm.sdf").write_text(
        "<sdf version='1.10'><world name='w'><gravity>0 -3 0</gravity><model name='m'><link name='a'/>"
        "<joint name='j' type='revolute'><parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz></axis></joint>"
        "</model></world></sdf>"
    )
    assert any("gravity=(0, -3, 0)" in note for note in jk.load(tmp_path / "arm.sdf").mechanism().notes)


def test_a_solid_that_cannot_be_weighed_leaves_its_body_unknown(tmp_path):
    mechanism = loaded(model("<geom size='.1' density='10' shellinertia='true'/>"), tmp_path)
    assert any("what its <geom> weighs is not computed" in note for note in mechanism.notes)
    with pytest.raises(ValueError, match="no density of 'a'"):
        jk.masses(mechanism)
    with pytest.raises(ValueError, match="expected a mass from 0 on, got -1"):
        loaded(model("<geom size='.1' mass='-1'/>"), tmp_path)
