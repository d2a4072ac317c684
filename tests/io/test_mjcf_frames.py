"""Elements of MuJoCo's bodies inside of frames, and sites and welds between two points, where MuJoCo has them."""

from xml.etree import ElementTree

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.mjcf import read_mjcf

IN_FRAMES = """<mujoco><default><default class="S"><joint type="slide" axis="1 0 0" range="-1 2"/></default></default>
<worldbody><body name="a"><geom size="0.1"/>
 <frame childclass="S" euler="0 0 90"><joint name="in class"/><frame pos="1 0 0"><joint name="deeper" axis="0 1 0"/>
 </frame></frame></body>
<replicate count="2" offset="1 0 0" childclass="S"><body name="b"><geom size="0.1"/><joint name="in copy"/></body>
</replicate></worldbody></mujoco>"""


def in_mujoco(text):
    """Compile a model, and compute its poses at `qpos0`; skips where there is no MuJoCo."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def loop_of(folder, text, name):
    """Read the joint of a constraint, before the loop that it closes is closed."""
    return next(
        each for each in read_mjcf(folder / "model.xml", ElementTree.fromstring(text)).joints if each.name == name
    )


def test_joints_have_the_class_of_the_frame_around_them(tmp_path):
    model, data = in_mujoco(IN_FRAMES)
    (tmp_path / "model.xml").write_text(IN_FRAMES)
    joints = jk.load(tmp_path / "model.xml").mechanism().joints
    assert len(joints) == model.njnt == 4
    for number in range(model.njnt):
        joint = joints[model.joint(number).name]
        assert str(joint.kind) == "prismatic"
        np.testing.assert_allclose(joint.frames_1[0][:3, 2], data.xaxis[number], atol=1e-15)  # rounding
        np.testing.assert_allclose(joint.limits, [model.jnt_range[number]], atol=1e-15)


@pytest.mark.parametrize("free", ["<freejoint/>", '<joint type="free"/>', '<joint class="f"/>'])
def test_a_free_joint_in_a_frame_makes_its_body_float(tmp_path, free):
    """Its seven numbers are in `qpos`, as those of one outside."""
    text = f"""<mujoco><default><default class="f"><joint type="free"/></default></default><worldbody>
    <body name="trunk"><frame pos="1 0 0">{free}</frame></body><body name="a"><joint name="j" range="30 90"/></body>
    </worldbody><keyframe><key name="home" qpos="0 0 0 1 0 0 0 0.7"/></keyframe></mujoco>"""
    (tmp_path / "model.xml").write_text(text)
    mechanism = jk.load(tmp_path / "model.xml").mechanism()
    assert "trunk" in mechanism.fixed and {*mechanism.joints} == {"j"}
    assert any("nothing ties 'trunk' to the ground: held at rest" in note for note in mechanism.notes)
    np.testing.assert_allclose(mechanism.joints["j"].limits, [np.radians([30, 90]) - 0.7], atol=1e-15)  # rounding


def test_a_site_between_two_points_is_where_it_is_for_mujoco(tmp_path):
    text = """<mujoco><worldbody><body name="a" pos="1 0 0" euler="0 0 90"><joint name="j"/><geom size="0.1"/>
    <site name="s" type="capsule" size="0.1" fromto="1 2 0 3 4 5"/></body><body name="b"><joint name="k"/>
    <geom size="0.1"/><site name="t" type="capsule" size="0.1" fromto="0 0 1 0 2 2"/></body></worldbody>
    <equality><weld name="w" site1="s" site2="t"/></equality></mujoco>"""
    _, data = in_mujoco(text)
    loop = loop_of(tmp_path, text, "w")
    for number, frame in enumerate((loop.frame_1, loop.frame_2)):
        np.testing.assert_allclose(frame[:3, 3], data.site_xpos[number], atol=1e-15)  # rounding
        np.testing.assert_allclose(frame[:3, :3], data.site_xmat[number].reshape(3, 3), atol=1e-15)


WELD = """<mujoco><compiler angle="radian"/><worldbody>
<body name="x"><joint name="x" type="slide" axis="1 0 0"/><geom size=".1"/>
 <body name="y"><joint name="y" type="slide" axis="0 1 0"/><geom size=".1"/>
  <body name="a"><joint name="turn" axis="0 0 1"/><geom size=".1"/></body></body></body>
<body name="b" pos="1 0.5 0"><joint name="lever" axis="0 0 1"/><geom size=".1"/></body></worldbody>
<equality><weld body1="b" body2="a" {said}/></equality></mujoco>"""


@pytest.mark.parametrize(
    "said",
    [
        "",
        'anchor="0 0.4 0"',
        'relpose="0.3 0 0 1 0 0 0"',
        'anchor="0 0.4 0" relpose="0.3 0 0 1 0 0 0"',
        'anchor="0.1 0.4 0" relpose="0.3 0 0 1 0 0 0.2"',
    ],
)
def test_a_weld_is_closed_where_mujoco_finds_it_closed(tmp_path, said):
    """Of a weld with both, `relpose` places the point on body 1 that meets `anchor` on body 2."""
    mujoco = pytest.importorskip("mujoco")

    text = WELD.format(said=said)
    model, data = in_mujoco(text)
    (tmp_path / "model.xml").write_text(text)
    assembly = jk.load(tmp_path / "model.xml")
    motion = assembly.mechanism().sweep({"lever": [0.0, 0.2, -0.3]}, throw=True)
    start = assembly.exported.joint_values
    for pose in range(3):
        for name, values in motion.coordinates.items():
            if name in ("x", "y", "turn", "lever"):
                data.joint(name).qpos = (start.get(name) or (0.0,))[0] + values[pose, 0]
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.efc_pos[:6], 0, atol=1e-12)  # the tolerance of sweeps


def test_a_ball_turns_about_the_axes_of_its_body_whatever_frame_it_is_in(tmp_path):
    """MuJoCo's quaternion of a ball is a rotation in the axes of the body, not in those of a frame around the joint."""
    turned = "<frame pos='0 0 1' euler='0 90 0'><joint name='ball' type='ball'/></frame>"
    (tmp_path / "model.xml").write_text(
        f"<mujoco><worldbody><body name='a' euler='0 0 90'>{turned}<geom size='.1'/></body></worldbody></mujoco>"
    )
    mechanism = jk.load(tmp_path / "model.xml").mechanism()
    np.testing.assert_allclose(mechanism.joints["ball"].frames_1[0, :3, 3], [0, 0, 1], atol=1e-15)
    drive = {"ball.theta": np.array([0, 0.3]), "ball.phi": np.zeros(2), "ball.psi": np.zeros(2)}
    rotation = np.asarray(mechanism.sweep(drive).transforms["a"])[1, :3, :3]
    x = [0, 1, 0]  # the x axis of the body
    np.testing.assert_allclose(rotation @ x, x, atol=1e-12)
    assert np.trace(rotation) == pytest.approx(1 + 2 * np.cos(0.3))


TURNED = {
    "quat": "quat='.7071067811865476 0 0 .7071067811865476'", "axisangle": "axisangle='1 0 0 90'",
    "euler": "euler='0 90 0'", "xyaxes": "xyaxes='0 1 0 0 0 1'", "zaxis": "zaxis='0 1 1'",
}  # fmt: skip


@pytest.mark.parametrize("own", TURNED)
@pytest.mark.parametrize("given", TURNED)
def test_an_orientation_goes_before_that_of_the_class_in_whichever_way_it_is_written(tmp_path, given, own):
    """As MuJoCo has it: a site that says how it is turned is turned so, also where its class says it otherwise."""

    def turn(default, said):
        site = f"<body name='b'><geom size='.1'/><site name='s' {said}/></body><body name='c'><geom size='.1'/></body>"
        weld = "<equality><weld name='w' site1='s' site2='t'/></equality>"
        other = "<site name='t' quat='1 0 0 0'/>"
        text = f"<mujoco><default><site {default}/></default><worldbody>{other}{site}</worldbody>{weld}</mujoco>"
        return loop_of(tmp_path, text, "w").frame_1[:3, :3]

    np.testing.assert_allclose(turn(TURNED[given], TURNED[own]), turn("", TURNED[own]), atol=1e-15)
