"""Models of MuJoCo: default classes, orientations, loops, actuators and keyframes, and MuJoCo's own kinematics."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from reference.archives import unpack
from reference.bare_models import bare_model

GRIPPER = """<mujoco model="fourbar"><compiler angle="{angle}" eulerseq="{sequence}"/>
<default><default class="link"><joint axis="0 1 0" range="-{range} {range}"/><default class="free"><joint range="0 0"/>
</default></default></default>
<worldbody><geom type="plane" size="1 1 1"/>
<body name="base" pos="0 0 1" {turn} childclass="link">
  <body name="crank"><joint name="motor" ref="{ref}"/><geom type="capsule" fromto="0 0 0 0 0 0.1" size="0.01"/>
    <body name="coupler" pos="0 0 0.1"><joint name="free1" class="free"/></body></body>
  <body name="rocker" pos="0.3 0 0"><joint name="free2" class="free"/></body>
</body></worldbody>
<equality><connect name="pin" body1="coupler" body2="rocker" anchor="0.3 0 0.1"/>{equality}</equality>
<actuator><position name="a" joint="motor"/>{actuator}</actuator>{more}</mujoco>"""

USUAL = {"angle": "degree", "sequence": "xyz", "range": "45", "turn": "", "ref": "0", "equality": "", "actuator": "",
         "more": ""}  # fmt: skip


def load(folder, text=GRIPPER, **said):
    for key, value in (USUAL | said).items():
        text = text.replace(f"{{{key}}}", value)
    (folder / "model.xml").write_text(text)
    return jk.load(folder / "model.xml")


def test_a_loop_by_connect_is_a_ball_and_the_actuated_joint_a_motor(tmp_path):
    mechanism = load(tmp_path, ref="10").mechanism()
    assert mechanism.motors == ("motor",)
    assert str(mechanism.joints["pin"].kind) == "spherical"
    assert mechanism.mobility().useful == 1  # a parallelogram
    np.testing.assert_allclose(mechanism.joints["pin"].frames_1[0][:3, 3], [0.3, 0, 1.2], atol=1e-15)
    (limits,) = mechanism.joints["motor"].limits
    np.testing.assert_allclose(limits, np.radians([-55, 35]), atol=1e-15)  # the written pose is at 10 degrees
    assert mechanism.joints["free1"].limits == ()
    assert {"world", "base"} <= {*mechanism.fixed}


def test_angles_are_in_the_unit_of_the_compiler(tmp_path):
    limits = load(tmp_path, angle="radian", range="0.5").mechanism().joints["motor"].limits
    np.testing.assert_allclose(limits, [[-0.5, 0.5]], atol=1e-15)


@pytest.mark.parametrize(
    ("turn", "sequence", "expected"),
    [
        ('euler="10 20 30"', "xyz", Rotation.from_euler("XYZ", [10, 20, 30], degrees=True)),
        ('euler="10 20 30"', "XYZ", Rotation.from_euler("xyz", [10, 20, 30], degrees=True)),
        ('euler="10 20 30"', "zyx", Rotation.from_euler("ZYX", [10, 20, 30], degrees=True)),
        ('quat="2 0 2 0"', "xyz", Rotation.from_euler("y", 90, degrees=True)),
        ('axisangle="0 0 3 40"', "xyz", Rotation.from_euler("z", 40, degrees=True)),
        ('xyaxes="0 1 0 -2 5 0"', "xyz", Rotation.from_euler("z", 90, degrees=True)),
        ('zaxis="0 -2 0"', "xyz", Rotation.from_euler("x", 90, degrees=True)),
    ],
)
def test_orientations_of_every_kind(tmp_path, turn, sequence, expected):
    frame = load(tmp_path, turn=turn, sequence=sequence).mechanism().joints["motor"].frames_1[0]
    np.testing.assert_allclose(frame[:3, 2], expected.as_matrix() @ [0, 1, 0], atol=1e-15)


def test_a_body_of_several_joints_has_parts_between_them(tmp_path):
    joints = '<joint name="x" type="slide" axis="1 0 0"/><joint name="tilt"/>'
    more = f'<worldbody><body name="cart">{joints}</body></worldbody>'
    mechanism = load(tmp_path, more=more).mechanism()
    assert [mechanism.joints[name].parts for name in ("x", "tilt")] == [("world", "cart/1"), ("cart/1", "cart")]


def test_what_is_not_kept_is_named(tmp_path):
    mechanism = load(
        tmp_path,
        equality='<joint name="e" joint1="free1"/><weld body1="base" active="false"/>',
        actuator='<motor name="s" site="x"/><motor name="p" tendon="t"/>',
        more='<tendon><fixed name="t"><joint joint="free2" coef="1"/></fixed><spatial name="u"/></tendon><odd/>',
    ).mechanism()
    notes = "\n".join(mechanism.notes)
    for said in (
        "<joint name='e'> holds 'free1'",
        "<weld> is not active",
        "<motor name='s'>",
        "tendon 't'",
        "'u'",
        "<odd>",
    ):
        assert said in notes
    assert mechanism.motors == ("motor", "free2")  # of the tendon


@pytest.mark.long
def test_joints_that_are_equal_by_a_polynomial_follow_each_other(tmp_path):
    """MuJoCo counts both from their references: here the follower stands at 5 degrees where the leader is at 10."""
    more = '<joint name="e" joint1="lid" joint2="motor" polycoef="0 0.5 0.25 0 0"/>'
    lid = '<joint name="lid" class="free" ref="5"/>'
    text = GRIPPER.replace("</body></worldbody>", f'<body name="lid">{lid}</body></body></worldbody>')
    assembly = load(tmp_path, text, equality=more, ref="10", actuator='<position joint="lid"/>')
    mechanism = assembly.mechanism()
    assert mechanism.motors == ("motor",) and any("'lid' follows the other motors" in note for note in mechanism.notes)
    angles = np.linspace(0, 0.5, 6)
    motion = mechanism.sweep({"motor": angles}, throw=True)
    np.testing.assert_allclose(motion.coordinates["lid"][:, 0], 0.5 * angles + 0.25 * angles**2, atol=1e-14)


def test_sites_that_are_apart_are_closed(tmp_path):
    sites = """<worldbody><body name="c"><joint name="j"/><site name="s" pos="0.5 0 0"/></body>
    <site name="g" pos="0 0.5 0"/></worldbody>"""
    assembly = load(tmp_path, more=sites, equality='<connect name="k" site1="s" site2="g"/>')
    assert any("the pose of the file is open" in note for note in assembly.exported.notes)
    np.testing.assert_allclose(np.cos(assembly.exported.joint_values["j"][0] - np.pi / 2), 1, atol=1e-12)


def test_a_pose_beyond_the_ranges_gives_way_to_a_keyframe(tmp_path):
    text = """<mujoco><worldbody><body name="a"><joint name="j" range="30 90"/></body></worldbody>
    <keyframe><key name="other" qpos="0.6"/><key name="home" qpos="1.0"/></keyframe></mujoco>"""
    assembly = load(tmp_path, text)
    assert assembly.exported.joint_values["j"] == (1.0,)
    np.testing.assert_allclose(assembly.mechanism().joints["j"].limits, [np.radians([30, 90]) - 1.0], atol=1e-15)
    assert any("<key name='home'>" in note for note in assembly.exported.notes)


def test_includes_are_read_and_missing_ones_refused(tmp_path):
    (tmp_path / "part.xml").write_text('<mujoco><body name="b"><joint name="j"/></body></mujoco>')
    text = '<mujoco><worldbody><body name="a"><include file="{more}"/></body></worldbody></mujoco>'
    assert "j" in load(tmp_path, text, more="part.xml").mechanism().joints
    with pytest.raises(FileNotFoundError, match=r"includes 'no\.xml', which is not there"):
        load(tmp_path, text, more="no.xml")
    with pytest.raises(ValueError, match="twice, or in a circle"):
        load(tmp_path, text, more="model.xml")


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"equality": '<connect body1="nobody" anchor="0 0 0"/>'}, "unknown body 'nobody'"),
        ({"more": '<worldbody><body><joint type="hing"/></body></worldbody>'}, "got 'hing'"),
        ({"more": '<worldbody><body childclass="no"><joint/></body></worldbody>'}, "unknown class 'no'"),
        ({"more": '<worldbody><body name="base"/></worldbody>'}, "another body has its name"),
        ({"turn": 'quat="0 0 0 0"'}, "zero vector"),
        ({"angle": "grad"}, "expected degree or radian"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(tmp_path, said, message):
    with pytest.raises(ValueError, match=message) as refused:
        load(tmp_path, **said)
    assert "\n" not in str(refused.value)


@pytest.fixture(scope="module")
def cassie(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cassie")
    unpack(
        Path(__file__).with_name("data") / "robots" / "robots.tar.xz", folder, "menagerie__agility_cassie_cassie.xml"
    )
    return folder / "menagerie__agility_cassie_cassie.xml"


@pytest.mark.long
def test_cassie_has_ten_motors_four_springs_and_two_rods_that_spin(cassie):
    mechanism = jk.load(cassie).mechanism()
    mobility = mechanism.mobility()
    springs = next(note for note in mechanism.notes if "spring" in note)
    assert len(mechanism.motors) == 10
    assert mobility.useful == 10 + sum(name in springs for name in mechanism.joints)
    assert {part for motion in mobility.idle_motions for part in motion.parts} == {
        "left-achilles-rod",
        "right-achilles-rod",
    }


@pytest.mark.long
def test_cassie_sweeps_all_motors(cassie):
    mechanism = jk.load(cassie).mechanism()
    angles = 0.1 * np.sin(np.linspace(0, 2 * np.pi, 31))
    assert np.all(mechanism.sweep(dict.fromkeys(mechanism.motors, angles)).closed)


@pytest.mark.long
def test_axes_and_loops_are_those_of_mujoco(cassie, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    model = bare_model(cassie, tmp_path)
    data = mujoco.MjData(model)
    assembly = jk.load(cassie)
    mechanism = assembly.mechanism()
    data.qpos[3] = 1.0
    data.qpos[:3] = model.body("cassie-pelvis").pos
    for name, value in assembly.exported.joint_values.items():
        if name in mechanism.joints and len(value) == 1 and str(mechanism.joints[name].kind) == "revolute":
            data.qpos[model.joint(name).qposadr[0]] = value[0]
    mujoco.mj_kinematics(model, data)
    for name, joint in mechanism.joints.items():
        if str(joint.kind) == "revolute":
            number = model.joint(name).id
            np.testing.assert_allclose(joint.frames_1[0][:3, 3], data.xanchor[number], atol=1e-12)
            np.testing.assert_allclose(joint.frames_1[0][:3, 2], data.xaxis[number], atol=1e-12)


FEATURES = """<mujoco model="m"><compiler angle="degree" eulerseq="zyx"/>
<default><joint damping="1"/><geom size="0.05"/><default class="a"><joint axis="1 0 0" range="-30 40"/>
<default class="b"><joint type="slide" pos="0.1 0 0"/></default></default></default>
<worldbody><body name="root" pos="1 2 3" euler="10 20 30" childclass="a"><geom/><joint name="j0" ref="15"/>
 <frame pos="0.1 0.2 0.3" axisangle="0 1 0 35" childclass="b">
  <body name="in frame" pos="0 0 1"><geom/><joint name="j1" ref="0.2"/><joint name="j2" class="a" axis="0 1 1"/></body>
 </frame>
 <replicate count="3" offset="0.2 0 0.1" euler="10 20 5" sep="-">
  <body name="leg" pos="0 0.1 0" zaxis="0 1 1"><geom/><joint name="hip"/>
   <replicate count="2" offset="0 0 0.1"><body name="toe" pos="0 0 0.2"><geom/><joint name="knee" class="b"/></body>
  </replicate></body>
 </replicate>
</body></worldbody></mujoco>"""


def test_classes_frames_and_copies_are_those_of_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(FEATURES)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    (tmp_path / "model.xml").write_text(FEATURES)
    mechanism = jk.load(tmp_path / "model.xml").mechanism()
    for number in range(model.njnt):
        joint = mechanism.joints[model.joint(number).name]
        np.testing.assert_allclose(joint.frames_1[0][:3, 3], data.xanchor[number], atol=1e-14)  # rounding
        np.testing.assert_allclose(joint.frames_1[0][:3, 2], data.xaxis[number], atol=1e-14)
        expected = model.jnt_range[number] - model.qpos0[model.jnt_qposadr[number]]
        np.testing.assert_allclose(joint.limits, [expected], atol=1e-14)
    assert {model.body(number).name for number in range(1, model.nbody)} <= {*mechanism.parts}


@pytest.mark.parametrize("count", ["", "0", "two", "100001"])
def test_copies_without_a_sensible_count_are_refused(tmp_path, count):
    text = f'<mujoco><worldbody><replicate count="{count}"><body name="a"/></replicate></worldbody></mujoco>'
    with pytest.raises(ValueError, match="<replicate>: expected a count"):
        load(tmp_path, text)


FREE = """<mujoco><worldbody>{bodies}<body name="plate" pos="0 0 1"><freejoint/><geom size="0.1"/></body></worldbody>
<equality>{ties}</equality></mujoco>"""
LEG = """<body name="leg{n}" pos="{x} {y} 0"><joint name="x{n}" axis="1 0 0"/><joint name="y{n}" axis="0 1 0"/>
<body name="rod{n}"><joint name="s{n}" type="slide"/><geom size="0.1"/></body></body>"""
TIE = '<connect body1="rod{n}" body2="plate" anchor="0 0 1"/>'


@pytest.mark.parametrize(("legs", "freedoms"), [(0, 0), (1, 6), (3, 6)])
def test_a_body_that_floats_is_held_only_where_no_loop_ties_it(tmp_path, legs, freedoms):
    """The plate has six freedoms, and each leg three joints and a ball at its end that takes three."""
    corners = [(1, 0), (-1, 1), (-1, -1)][:legs]
    bodies = "".join(LEG.format(n=n, x=x, y=y) for n, (x, y) in enumerate(corners))
    text = FREE.format(bodies=bodies, ties="".join(TIE.format(n=n) for n in range(legs)))
    mechanism = load(tmp_path, text).mechanism()
    assert ("plate" in mechanism.fixed) == (not legs)
    assert any("nothing ties 'plate' to the ground" in note for note in mechanism.notes) == (not legs)
    assert mechanism.mobility().freedoms == freedoms


def test_why_a_robot_does_not_move_speaks_of_no_contacts(tmp_path):
    text = """<mujoco><worldbody><body name="trunk"><freejoint/><geom size="0.1"/><body name="leg"><joint name="hip"/>
    <geom size="0.1"/></body></body></worldbody></mujoco>"""
    said = str(load(tmp_path, text).mechanism(fixed=["leg"]))
    assert "Nothing can move but parts by themselves" in said and "contact" not in said
