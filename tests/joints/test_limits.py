"""Limits by hand: said for one coordinate or several, kept in studies, refused where they can mean nothing."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.study_drives import small_drive

Z = (0.0, 0.0, 1.0)
POINT = (0.0, 0.0, 0.0)


def test_limits_of_one_and_of_several_coordinates():
    assert jk.revolute("A", "a", "b", point=POINT, axis=Z, limits=(-1, 2)).limits == ((-1.0, 2.0),)
    pin = jk.cylindrical("A", "a", "b", point=POINT, axis=Z, limits={"phi": (0, 1)})
    assert pin.limits == ((-np.inf, np.inf), (0.0, 1.0))
    assert jk.revolute("A", "a", "b", point=POINT, axis=Z).limits == ()


@pytest.mark.parametrize(
    ("make", "limits", "message"),
    [
        (jk.revolute, (1, -1), "lower one first"),
        (jk.revolute, (0, np.nan), "lower one first"),
        (jk.revolute, (np.inf, np.inf), "lower one first"),
        (jk.revolute, (1, 2, 3), "two numbers"),
        (jk.revolute, {"z": (0, 1)}, "no coordinate 'z'.*'phi'"),
        (jk.cylindrical, (0, 1), r"coordinates z, phi.*limits=\{'z'"),
    ],
)
def test_limits_that_mean_nothing_are_refused(make, limits, message):
    with pytest.raises(ValueError, match=message):
        make("A", "a", "b", point=POINT, axis=Z, limits=limits)


def test_the_angles_of_a_ball_have_none():
    with pytest.raises(ValueError, match="angles of a ball"):
        jk.free("A", "a", "b", point=POINT, limits={"phi": (-1, 1)})


def test_a_study_has_them_in_degrees_and_keeps_them(tmp_path):
    arm = jk.revolute("arm", "base", "arm", point=POINT, axis=Z, limits=(-np.pi / 2, np.inf))
    pin = jk.cylindrical("pin", "arm", "end", point=(1, 0, 0), axis=Z, limits={"z": (-0.25, 4)})
    mechanism = jk.Mechanism.build(fixed=["base"], joints=[arm, pin])
    jk.write_study(mechanism, tmp_path / "study.toml")
    assert "limits = { phi = [-90.0, inf] }" in (tmp_path / "study.toml").read_text()
    back = jk.load_study(tmp_path / "study.toml").mechanism
    assert back.joints["arm"].limits == ((-np.pi / 2, np.inf),)
    assert back.joints["pin"].limits == ((-0.25, 4.0), (-np.inf, np.inf))
    said = (tmp_path / "study.toml").read_text().replace("limits = { phi = [-90.0, inf] }", "limits = [-90, 45]")
    (tmp_path / "study.toml").write_text(said)
    assert jk.load_study(tmp_path / "study.toml").mechanism.joints["arm"].limits == ((-np.pi / 2, np.pi / 4),)
    (tmp_path / "study.toml").write_text(said.replace("[-90, 45]", "[90, 45]"))
    with pytest.raises(ValueError, match=r"study\.toml.*lower one first"):
        jk.load_study(tmp_path / "study.toml")


def locked():
    """A slide that is locked as assembled on an arm, and a turn that is locked elsewhere."""
    arm = jk.revolute("arm", "base", "arm", point=POINT, axis=Z, limits=(-1, 2))
    slide = jk.prismatic("slide", "arm", "end", axis=(1, 0, 0), limits=(0, 0))
    turn = jk.revolute("turn", "end", "tip", point=(1, 0, 0), axis=Z, limits=(0.5, 0.5))
    return jk.Mechanism.build(fixed=["base"], joints=[arm, slide, turn], unit="m")


@pytest.mark.parametrize("suffix", [".json", ".toml", ".urdf", ".xml", ".asmt"])
def test_a_joint_of_equal_limits_is_locked_in_every_format(tmp_path, suffix):
    mechanism, path = locked(), tmp_path / f"model{suffix}"
    if suffix == ".toml":
        jk.write_study(mechanism, path)
        back = jk.load_study(path).mechanism
    else:
        write = {".json": jk.Mechanism.save, ".urdf": jk.write_urdf, ".xml": jk.write_mjcf, ".asmt": jk.write_asmt}
        back = jk.load(write[suffix](mechanism, path)).mechanism()
    for name in ("arm", "slide", "turn"):
        np.testing.assert_allclose(back.joints[name].limits, mechanism.joints[name].limits, rtol=1e-15)  # degrees


def test_a_written_study_leaves_locked_joints_where_they_are(tmp_path):
    mechanism = jk.load(jk.write_urdf(locked(), tmp_path / "robot.urdf")).mechanism()
    drive = small_drive(mechanism)
    assert {drive[name] for name in ("slide.z", "turn.phi")} == {"0:0:21"} and drive["arm.phi"] != "0:0:21"


def test_mujoco_holds_locked_joints(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(jk.write_mjcf(locked(), tmp_path / "model.xml")))
    data = mujoco.MjData(model)
    data.qpos[:] = [0.3, 0.2, 0.4]
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.efc_pos[: data.ne], [0.2, 0.4 - 0.5], atol=1e-15)  # rounding


@pytest.mark.parametrize("lock", ["crank", "rocker"])
def test_locked_joints_stay_where_they_are_when_loops_are_closed(tmp_path, lock):
    """A four-bar of rounded numbers: what closes it is one of the joints that may move."""
    limit = '<limit lower="0" upper="0" effort="1" velocity="1"/>'
    origins = {"crank": ("base", "0 0 0"), "rod": ("crank", "1 0 0"), "rocker": ("base", "3 0 0")}
    text = '<robot name="r"><link name="base"/>'
    for name, (parent, origin) in origins.items():
        kind, more = ("revolute", limit) if name == lock else ("continuous", "")
        text += f'<link name="{name}"/><joint name="{name}" type="{kind}"><origin xyz="{origin}"/><axis xyz="0 0 1"/>'
        text += f'<parent link="{parent}"/><child link="{name}"/>{more}</joint>'
    for name, parent, origin in (("end 1", "rod", "1.4 2 0"), ("end 2", "rocker", "-0.6 2.01 0")):
        text += f'<link name="{name}"/><joint name="{name}" type="fixed"><origin xyz="{origin}"/>'
        text += f'<parent link="{parent}"/><child link="{name}"/></joint>'
    (tmp_path / "r.urdf").write_text(f"{text}</robot>")
    (tmp_path / "r.yaml").write_text("closed_loop: [['end 1', 'end 2']]\ntype: ['3d']\n")
    assembly = jk.load(tmp_path / "r.urdf", loops=tmp_path / "r.yaml")
    assert any("the pose of the file is open" in note for note in assembly.exported.notes)
    assert assembly.mechanism().joints[lock].limits == ((0.0, 0.0),)
