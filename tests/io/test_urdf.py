"""Robots in URDF with their loops in YAML, against forward kinematics computed from the file alone."""

import re
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.yaml_subset import parse_yaml
from reference.archives import unpack
from reference.robots import frame_links, urdf_poses

ROBOTS = {"5bar_linkage": (2, 1), "robot_delta": (2, 3), "cassie_like": (5, 2), "digit_like": (6, 3)}
"""Robots of Gepetto -> motors, and idle freedoms: a ball of three hinges at each end of a rod lets it spin."""

CLOSED = 1e-12
"""Metres, and entries of rotations: loops close to about 1e-15 of the size, which is a metre or less."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("robots")
    unpack(Path(__file__).with_name("data") / "robots" / "robots.tar.xz", where)
    return where


def robot(folder, name):
    path = folder / f"gepetto__{name}.urdf"
    return path, jk.load(path, loops=path.with_suffix(".yaml"))


def close_enough(path, values):
    """Check in the text of the files that both frames of each loop coincide for values of the joints."""
    links, _ = urdf_poses(path, values)
    owner = frame_links(path)
    for one, other in parse_yaml(path.with_suffix(".yaml").read_text(), "robot.yaml")["closed_loop"]:
        np.testing.assert_allclose(links[owner[one]], links[owner[other]], atol=CLOSED)


@pytest.mark.long
@pytest.mark.parametrize("name", ROBOTS)
def test_robots_stand_closed_with_the_mobility_of_their_motors(folder, name):
    path, assembly = robot(folder, name)
    mechanism = assembly.mechanism()
    motors, idle = ROBOTS[name]
    mobility = mechanism.mobility()
    assert (len(mechanism.motors), mobility.useful, mobility.idle_freedoms) == (motors, motors, idle)
    values = assembly.exported.joint_values
    close_enough(path, values)
    assert not any(np.any(values[motor]) for motor in mechanism.motors)  # they are where the file has them
    _, axes = urdf_poses(path, values)
    for joint, (point, axis) in axes.items():
        frame = mechanism.joints[joint].frames_1[0]
        np.testing.assert_allclose(frame[:3, 3], point, atol=CLOSED)
        np.testing.assert_allclose(frame[:3, 2], axis, atol=CLOSED)
    assert any("the pose of the file is open" in note for note in mechanism.notes)


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(ROBOTS, key=lambda name: name == "robot_delta"))  # the last one in CI
def test_all_motors_sweep_as_the_file_says(folder, name):
    path, assembly = robot(folder, name)
    mechanism = assembly.mechanism()
    motion = mechanism.sweep({motor: 0.1 * np.sin(np.linspace(0, 2 * np.pi, 31)) for motor in mechanism.motors})
    assert np.all(motion.closed)
    zero = assembly.exported.joint_values
    for pose in (7, 22):
        moved = {joint: np.asarray(q)[pose] for joint, q in motion.coordinates.items()}
        values = {joint: np.add(value, moved.get(joint, 0.0)) for joint, value in zero.items()}
        close_enough(path, values)
        links, begun = urdf_poses(path, values)[0], urdf_poses(path, zero)[0]
        for link in links:
            np.testing.assert_allclose(np.asarray(motion.transforms[link])[pose] @ begun[link], links[link], atol=1e-11)


@pytest.mark.long
@pytest.mark.parametrize("name", ROBOTS)
def test_links_are_where_pinocchio_has_them(folder, name):
    pinocchio = pytest.importorskip("pinocchio")
    path, assembly = robot(folder, name)
    model = pinocchio.buildModelFromUrdf(str(path))
    data, q = model.createData(), pinocchio.neutral(model)
    for joint, values in assembly.exported.joint_values.items():
        if model.existJointName(joint) and values:
            own = model.joints[model.getJointId(joint)]
            # Pinocchio has a hinge without limits as cosine and sine
            q[own.idx_q : own.idx_q + own.nq] = values if own.nq == 1 else (np.cos(values[0]), np.sin(values[0]))
    pinocchio.framesForwardKinematics(model, data, q)
    mechanism = assembly.mechanism()
    for joint in mechanism.all_joints:
        if joint.freedoms and model.existJointName(joint.name):
            place = data.oMi[model.getJointId(joint.name)]
            np.testing.assert_allclose(joint.frames_1[0][:3, 3], place.translation, atol=CLOSED)
    for one, other in parse_yaml(path.with_suffix(".yaml").read_text(), "robot.yaml")["closed_loop"]:
        first, second = (data.oMf[model.getFrameId(frame)].homogeneous for frame in (one, other))
        np.testing.assert_allclose(first, second, atol=CLOSED)


ARM = """<robot name="arm">
<link name="base"/><link name="upper"><visual><origin xyz="0 0 0.2"/><geometry><box size="0.1 0.1 0.4"/></geometry>
</visual></link><link name="lower"/><link name="hand"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 1" rpy="0 0 0"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.4" rpy="0 0 0.5"/>
<axis xyz="1 0 0"/><mimic joint="shoulder" multiplier="2"/></joint>
<joint name="slide" type="prismatic"><parent link="lower"/><child link="hand"/><axis xyz="0 0 2"/>
<limit upper="0.3"/></joint>
<transmission name="t"><joint name="shoulder"/><actuator name="m"/></transmission>{more}</robot>"""


def write(folder, more="", loops=None, text=ARM):
    (folder / "arm.urdf").write_text(text.replace("{more}", more))
    if loops is not None:
        (folder / "arm.yaml").write_text(loops)
    return jk.load(folder / "arm.urdf", loops=None if loops is None else folder / "arm.yaml")


@pytest.mark.long
def test_a_serial_arm_keeps_its_limits_its_motors_and_its_solids(tmp_path):
    assembly = write(tmp_path)
    mechanism = assembly.mechanism()
    assert mechanism.fixed == ("base",)
    assert mechanism.motors == ("shoulder",)
    limits = {name: joint.limits for name, joint in mechanism.joints.items()}
    assert limits == {"shoulder": ((-1.0, 2.0),), "elbow": (), "slide": ((0.0, 0.3),)}
    assert "-1 to 2" in str(mechanism) and "Motors: shoulder" in str(mechanism)
    np.testing.assert_allclose(assembly.parts[1].box, [[-0.05, -0.05, 1.0], [0.05, 0.05, 1.4]], atol=1e-12)
    motion = mechanism.sweep({"shoulder": np.linspace(0, 1, 5)}, throw=True)
    np.testing.assert_allclose(motion.coordinates["elbow"], 2 * motion.coordinates["shoulder"], atol=1e-14)
    assert mechanism.with_points({"slide": (0, 0, 2)}).joints["shoulder"].limits == ((-1.0, 2.0),)


@pytest.mark.long
def test_a_joint_that_mimics_with_an_offset_stands_where_the_offset_says(tmp_path):
    """The zero of the file does not obey it: the robot is assembled where it does, and the motor stays if it can."""
    assembly = write(tmp_path, text=ARM.replace('multiplier="2"', 'multiplier="2" offset="0.25"'))
    mechanism = assembly.mechanism()
    assert any("the pose of the file is open" in note for note in mechanism.notes)
    values = assembly.exported.joint_values
    np.testing.assert_allclose([values["shoulder"][0], values["elbow"][0]], [0.0, 0.25], atol=1e-9)
    motion = mechanism.sweep({"shoulder": np.linspace(0, 1, 5)}, throw=True)
    np.testing.assert_allclose(motion.coordinates["elbow"], 2 * motion.coordinates["shoulder"], atol=1e-12)


def test_a_mimic_of_nothing_and_one_of_a_weld_are_named_and_left_out(tmp_path):
    arm = write(tmp_path, text=ARM.replace('mimic joint="shoulder"', 'mimic joint="sholder"')).mechanism()
    assert "mimic names the unknown joint 'sholder'; did you mean 'shoulder'?; left out" in "\n".join(arm.notes)
    assert arm.mobility().useful == write(tmp_path).mechanism().mobility().useful + 1
    more = """<link name="x"/><joint name="tool" type="fixed"><parent link="hand"/><child link="x"/>
    <mimic joint="shoulder"/></joint>"""
    assert any("'tool' has not one coordinate" in note for note in write(tmp_path, more).mechanism().notes)


def test_a_missing_mesh_and_unknown_elements_are_named(tmp_path):
    mesh = '<link name="x"><visual><geometry><mesh filename="package://arm/x.wrl"/></geometry></visual></link>'
    more = f'{mesh}<joint name="j" type="fixed"><parent link="hand"/><child link="x"/></joint><wheel name="w"/>'
    notes = "\n".join(write(tmp_path, more).mechanism().notes)
    assert "mesh 'package://arm/x.wrl' is not read" in notes and "'x' is drawn without it" in notes
    assert "<wheel name='w'> is not understood" in notes


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('<joint name="k" type="revolute"><parent link="base"/><child link="hand"/></joint>', "a URDF is a tree"),
        ('<joint name="k" type="revolute"><parent link="hand"/><child link="base"/></joint>', "go in a circle"),
        ('<link name="a"/>', "are both the child of no joint"),
        ('<joint name="k" type="hinge"><parent link="hand"/><child link="a"/></joint><link name="a"/>', "got 'hinge'"),
        ('<joint name="k" type="fixed"><parent link="hnd"/><child link="a"/></joint><link name="a"/>', "mean 'hand'"),
        ('<joint name="elbow" type="fixed"><parent link="hand"/><child link="a"/></joint><link name="a"/>', "twice"),
        ('<link name="hand"/>', "link 'hand' is there twice"),
        (
            '<link name="a"/><joint name="k" type="fixed"><parent link="hand"/><child link="a"/>'
            '<origin rpy="0 0 1" quat_xyzw="0 0 0 1"/></joint>',
            "gives its rotation twice",
        ),
        ('<link name="${name}"/>', "xacro"),
        ('<link name="$(arg name)"/>', "xacro"),
        ('<link name="a"><xacro:inertia_of_a_box mass="1"/></link>', "xacro"),
        ('<xacro:leg side="left"/>', "xacro"),
        ("<link", "damaged XML"),
    ],
)
def test_what_is_no_tree_of_known_joints_is_refused_in_one_line(tmp_path, more, message):
    with pytest.raises(ValueError, match=re.escape(message)) as refused:
        write(tmp_path, more)
    assert "\n" not in str(refused.value)


def test_an_entity_bomb_is_refused(tmp_path):
    bomb = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><robot name="&b;"/>'
    with pytest.raises(ValueError, match="document type"):
        write(tmp_path, text=bomb)


@pytest.mark.parametrize(
    ("loops", "message"),
    [
        ("closed_loop: [['hand', 'foot']]", "unknown frame 'foot'"),
        ("closed_loop: [['hand', 'slide']]", "on the same link"),
        ("closed_loop: [['hand', 'base']]\ntype: ['2d']", "expected one of 6d, 3d"),
        ("closed_loop: [['hand', 'base']]\ntype: ['6d', '6d']", "type has 2 entries and closed_loop has 1"),
        ("name_mot: ['hip']", "unknown joint 'hip'"),
        ("name_mot: ['elbow'", "is not closed"),
        ("&anchor x", "line 1"),
        ("", "closes no loop and names no motor"),
        ("closed_loop: [['hand', 'base'], ['hand', 'base']]", r"arm.yaml: closed_loop has \['hand', 'base'\] twice"),
        ("closed_loop: []", "closes no loop and names no motor"),
    ],
)
def test_loops_that_make_no_sense_are_refused(tmp_path, loops, message):
    with pytest.raises(ValueError, match=message):
        write(tmp_path, loops=loops)


def test_joints_get_other_types_from_the_loops(tmp_path):
    loops = "%YAML 1.2\n---\nname_mot: elbow\nclosed_loop:\njoint_name: [elbow, slide]\nodd:\n  a: {b: 1}\n  c: &x\n"
    loops += "joint_type: [CARDAN, SPHERICAL]\nmore: {a: [\n1]}\n"
    mechanism = write(tmp_path, loops=loops).mechanism()
    assert [str(joint.kind) for joint in mechanism.all_joints] == ["revolute", "universal", "spherical"]
    assert all(any(f"the key {key!r} is not understood" in note for note in mechanism.notes) for key in ("odd", "more"))
    first = mechanism.joints["elbow"].frames_1[0]
    np.testing.assert_allclose(first[:3, 1], [np.cos(0.5), np.sin(0.5), 0], atol=1e-15)  # it turns about x first


def test_an_origin_may_be_turned_by_a_quaternion(tmp_path):
    turned = ARM.replace('rpy="0 0 0.5"', f'quat_xyzw="0 0 {np.sin(0.25)} {np.cos(0.25)}"')
    frames = [write(tmp_path, text=text).mechanism().joints["elbow"].frames_1 for text in (ARM, turned)]
    np.testing.assert_allclose(*frames, atol=1e-15)


def test_loops_belong_to_urdf_only(tmp_path):
    (tmp_path / "a.stl").write_text("solid")
    with pytest.raises(ValueError, match="loops is the YAML file"):
        jk.load(tmp_path / "a.stl", loops="x.yaml")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a: [x, 'y z', [\"w\"]]  # c", ["x", "y z", ["w"]]),
        ("a: [x,\n  y]", ["x", "y"]),
        ("a:\n  - x\n  - [y, z]", ["x", ["y", "z"]]),
        ("a:\n- - x\n  - y\n- - z\n  - w", [["x", "y"], ["z", "w"]]),
        ("a: []", []),
        ("a: text", "text"),
        ("a: ['pin #1', b#2, 'it''s'] # c", ["pin #1", "b#2", "it's"]),
        ("a:\n  [x,  # first\n  'y # z', 'z[1', \"]\"]", ["x", "y # z", "z[1", "]"]),
        ("a:\n- 'x [#1'\n- [y,\n z]", ["x [#1", ["y", "z"]]),
        ("'a': x", "x"),
        ('"a" : [x]', ["x"]),
        ("\ufeffa: x", "x"),
        ("a: it's it", "it's it"),
    ],
)
def test_the_part_of_yaml_that_is_read(text, value):
    assert parse_yaml(text, "a.yaml") == {"a": value}
    assert pytest.importorskip("yaml").safe_load(text) == {"a": value}


@pytest.mark.parametrize("text", ["a:", "a: null", "a: ~ # none"])
def test_nothing_is_an_empty_text(text):
    assert parse_yaml(text, "a.yaml") == {"a": ""}
    assert pytest.importorskip("yaml").safe_load(text) == {"a": None}


@pytest.mark.parametrize("text", ["a: {b: c}", "a: [x", "a: x]", "a: [x,,y]", "a: 1\na: 2", "  a: 1", "a: *x", "- a"])
def test_other_yaml_is_refused_with_its_line(text):
    with pytest.raises(ValueError, match=r"a\.yaml, line \d: "):
        parse_yaml(text, "a.yaml")


def test_no_inference_is_blamed_for_what_floats(tmp_path):
    """It is held by the reader: neither `ignore` nor `infer` of the assembly has a part in that."""
    path = tmp_path / "floating.urdf"
    links = '<link name="a"/><link name="b"/>'
    joint = '<joint name="p" type="floating"><parent link="a"/><child link="b"/></joint>'
    path.write_text(f'<robot name="r">{links}{joint}</robot>')
    said = str(jk.load(path).mechanism())
    assert "It cannot move: all its parts are one body. Its file has them so: see the notes." in said
    assert "it floats: 'b' is held at rest on 'a'" in said
    assert "ignore=" not in said
