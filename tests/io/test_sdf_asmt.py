"""Models of Gazebo (SDF) and of FreeCAD's solver (ASMT): graphs of joints, frames and markers."""

import re

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.sdf import read_sdf
from jaxkin.io.xml_tree import read_xml

FOURBAR = """<sdf version="{version}"><model name="fourbar"><pose>0 0 1 0 0 0</pose>
<link name="AB"/><link name="BC"><pose>0 0 0.4 0 0.3 0</pose></link>
<link name="CD"><pose relative_to="D">0 0 0 0 0 0</pose></link><frame name="D"><pose>0.5 0 0 0 0 0</pose></frame>
<joint name="A" type="revolute"><parent>world</parent><child>AB</child><axis><xyz>0 1 0</xyz>
<limit><lower>-1</lower><upper>1e16</upper></limit></axis></joint>
<joint name="B" type="revolute"><parent>AB</parent><child>BC</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="C" type="ball"><pose relative_to="D">0 0 0.5 0 0 0</pose><parent>BC</parent><child>CD</child></joint>
<joint name="E" type="continuous"><parent>world</parent><child>CD</child>
<axis><xyz expressed_in="__model__">0 1 0</xyz></axis></joint>
<plugin name="JointPositionController" filename="x"><joint_name>A</joint_name></plugin>{more}</model></sdf>"""


def sdf(folder, more="", version="1.7"):
    (folder / "robot.sdf").write_text(FOURBAR.replace("{more}", more).replace("{version}", version))
    return jk.load(folder / "robot.sdf")


def test_a_loop_of_sdf_is_closed_by_its_joints(tmp_path):
    mechanism = sdf(tmp_path).mechanism()
    assert mechanism.mobility().useful == 1 and mechanism.motors == ("A",)
    np.testing.assert_allclose(mechanism.joints["C"].frames_1[0][:3, 3], [0.5, 0, 1.5], atol=1e-15)
    np.testing.assert_allclose(mechanism.joints["E"].frames_1[0][:3, 3], [0.5, 0, 1], atol=1e-15)
    assert mechanism.joints["A"].limits == ((-1.0, np.inf),)


@pytest.mark.parametrize(("version", "axis"), [("1.4", [1, 0, 0]), ("1.6", [0, 1, 0]), ("1.9", [0, 1, 0])])
def test_axes_are_in_the_model_in_old_files_and_in_the_joint_in_new_ones(tmp_path, version, axis):
    more = """<link name="x"><pose>0 0 0 0 0 1.5707963267948966</pose></link>
    <joint name="j" type="prismatic"><parent>AB</parent><child>x</child><axis><xyz>1 0 0</xyz></axis></joint>"""
    frame = sdf(tmp_path, more, version).mechanism().joints["j"].frames_1[0]
    np.testing.assert_allclose(frame[:3, 2], axis, atol=1e-15)


def test_what_floats_is_held_and_what_is_not_kept_is_named(tmp_path):
    more = """<link name="loose"/><odd/><joint name="g" type="gearbox"><parent>AB</parent><child>CD</child>
    <gearbox_reference_body>BC</gearbox_reference_body><axis><xyz>0 1 0</xyz></axis></joint>"""
    mechanism = sdf(tmp_path, more).mechanism()
    notes = "\n".join(mechanism.notes)
    assert "loose" in mechanism.fixed and "nothing ties 'loose'" in notes
    assert "'gearbox' is not kept, and its links move on their own: no two joints turn its links on 'BC'" in notes
    assert "<odd> is not understood" in notes


GEARBOX = """<sdf version="1.9"><model name="m"><pose>1 2 3 0.4 0.5 0.6</pose><link name="arm"/>
<link name="sun"/><link name="planet"><pose>0.3 0 0 0 0 1</pose></link>
<joint name="carrier" type="revolute"><parent>world</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>
<joint name="s" type="revolute"><parent>arm</parent><child>sun</child><axis><xyz>0 0 1</xyz></axis></joint>
<joint name="p" type="revolute"><parent>{first}</parent><child>{second}</child><axis><xyz>0 0 {own}</xyz></axis></joint>
<joint name="g" type="gearbox"><parent>sun</parent><child>planet</child>
<gearbox_reference_body>arm</gearbox_reference_body><gearbox_ratio>2.5</gearbox_ratio>
<axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 0 {turn}</xyz></axis2></joint></model></sdf>"""


@pytest.mark.parametrize("parts", [("arm", "planet"), ("planet", "arm")])
@pytest.mark.parametrize(("own", "turn"), [(1, 1), (-1, 1), (1, -1)])
def test_a_gearbox_ties_the_angles_from_its_reference_link(tmp_path, parts, own, turn):
    text = GEARBOX.format(first=parts[0], second=parts[1], own=own, turn=turn)
    (tmp_path / "m.sdf").write_text(text)
    mechanism = jk.load(tmp_path / "m.sdf").mechanism()
    motion = mechanism.sweep({"carrier": np.linspace(0, 0.7, 5), "s": np.linspace(0, 1, 5)})
    turns = {name: np.asarray(motion.transforms[name])[:, :3, :3] for name in ("arm", "sun", "planet")}
    up = (jk.load(tmp_path / "m.sdf").exported.constraints[0].chain.frames[0])[:3, 2]

    def angle(link):  # from the arm, about the axis of the model
        skew = np.swapaxes(turns["arm"], 1, 2) @ turns[link]
        return np.unwrap(np.arctan2(np.stack([skew[:, 2, 1] - skew[:, 1, 2], skew[:, 0, 2] - skew[:, 2, 0],
                                              skew[:, 1, 0] - skew[:, 0, 1]], -1) @ up,
                                    np.trace(skew, axis1=1, axis2=2) - 1))  # fmt: skip

    np.testing.assert_allclose(angle("sun"), np.linspace(0, 1, 5), atol=1e-12)
    np.testing.assert_allclose(turn * angle("planet"), -2.5 * angle("sun"), atol=1e-12)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('<joint name="j" type="gearbox"><parent>AB</parent><child>CD</child></joint>', "<gearbox_reference_body>"),
        ('<joint name="j" type="bend"><parent>AB</parent><child>CD</child></joint>', "got 'bend'"),
        ('<joint name="j" type="fixed"><parent>AB</parent><child>XY</child></joint>', "no link or frame 'XY'"),
        ('<joint name="j" type="fixed"><parent>AB</parent><child>AB</child></joint>', "the same link"),
        ('<frame name="p"><pose relative_to="p"/></frame><link name="l"><pose relative_to="p"/></link>', "to itself"),
        ('<link name="AB"/>', "two elements of the name 'AB'"),
    ],
)
def test_sdf_that_is_wrong_is_refused(tmp_path, more, message):
    with pytest.raises(ValueError, match=message):
        sdf(tmp_path, more)


def test_an_include_that_is_missing_is_refused_and_others_are_read(tmp_path):
    text = '<sdf version="1.7"><world name="w"><include><uri>model://arm</uri><name>left</name></include></world></sdf>'
    (tmp_path / "w.sdf").write_text(text)
    with pytest.raises(FileNotFoundError, match="includes 'model://arm', which is not there"):
        jk.load(tmp_path / "w.sdf")
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "model.sdf").write_text(FOURBAR.replace("{more}", "").replace("{version}", "1.7"))
    assert jk.load(tmp_path / "w.sdf").mechanism().mobility().useful == 1


ARM = """<sdf version="{version}"><model name="inner"><pose>9 9 9 0 0 0</pose>
<frame name="f"><pose>0 0 1 0 0 0</pose></frame><frame name="g" attached_to="l2"><pose>0 0 1 0 0 0</pose></frame>
<link name="l1"><pose>1 0 0 0 0 0</pose></link><link name="l2"><pose relative_to="f">1 1 0 0 0 0.5</pose></link>
<joint name="ij" type="revolute"><parent>l1</parent><child>l2</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="w" type="ball"><parent>__model__</parent><child>g</child></joint></model></sdf>"""
ON_BASE = """<sdf version="1.9"><model name="outer"><link name="base"/><include merge="{merge}"><uri>arm.sdf</uri>
<name>arm</name><pose relative_to="base">0 0 2 0 0 1.5707963267948966</pose></include>
<joint name="j" type="revolute"><parent>base</parent><child>{arm}l1</child><axis><xyz>0 0 1</xyz></axis></joint>
<joint name="k" type="revolute"><pose relative_to="{arm}g"/><parent>{arm}l2</parent><child>tip</child>
<axis><xyz>1 0 0</xyz></axis></joint><link name="tip"><pose relative_to="{arm}g">0 0 1 0 0 0</pose></link></model></sdf>
"""


@pytest.mark.parametrize(("version", "axis"), [("1.4", [-1, 0, 0]), ("1.9", [-np.cos(0.5), -np.sin(0.5), 0])])
def test_a_model_that_is_merged_is_the_one_that_is_nested_by_other_names(tmp_path, version, axis):
    """An axis of version 1.4 is in the frame of its model, which is turned by 90 degrees, later in that of its link."""
    (tmp_path / "arm.sdf").write_text(ARM.replace("{version}", version))
    found = []
    for merge, arm in (("true", ""), ("false", "arm::")):
        (tmp_path / "robot.sdf").write_text(ON_BASE.replace("{merge}", merge).replace("{arm}", arm))
        model = read_sdf(tmp_path / "robot.sdf", read_xml(tmp_path / "robot.sdf"))
        assert not model.notes
        joints = {each.name: each.frame_1[:3, 2:] for each in model.joints}  # how x and y lie is for each to choose
        links = {each.name: each.pose for each in model.links}
        found.append(
            {name.removeprefix("arm::"): numbers for name, numbers in (links | joints).items() if name[-1] != "w"}
        )
    merged, nested = found
    assert merged.keys() == nested.keys()
    for name, numbers in merged.items():
        np.testing.assert_allclose(numbers, nested[name], atol=1e-15)
    np.testing.assert_allclose(merged["l2"][:3, 3], [-1, 1, 3], atol=1e-15)
    np.testing.assert_allclose(merged["ij"][:, 0], axis, atol=1e-15)


def test_models_of_a_world_stand_relative_to_frames_and_to_each_other(tmp_path):
    (tmp_path / "w.sdf").write_text("""<sdf version="1.9"><world name="w"><frame name="table"><pose>0 0 1 0 0 0</pose>
    </frame><model name="a"><pose relative_to="table">1 0 0 0 0 1.5707963267948966</pose><link name="l"/></model>
    <model name="b"><pose relative_to="a">1 0 0 0 0 0</pose><link name="l"/></model>
    <model name="c"><pose relative_to="world">0 3 0 0 0 0</pose><link name="l"/></model></world></sdf>""")
    links = read_sdf(tmp_path / "w.sdf", read_xml(tmp_path / "w.sdf")).links
    places = {each.name: each.pose[:3, 3] for each in links}
    np.testing.assert_allclose([places[f"{name}::l"] for name in "abc"], [[1, 0, 1], [1, 1, 1], [0, 3, 0]], atol=1e-15)


def block(depth, *lines):
    return "".join("\t" * (depth + extra) + f"{text}\n" for extra, text in lines)


ALONG = ("1\t0\t0", "0\t1\t0", "0\t0\t1")
"""The rows of a rotation that turns nothing."""


def placed(depth, point, turn=ALONG):
    return block(depth, (0, "Position3D"), (1, "\t".join(map(str, point)))) + block(
        depth, (0, "RotationMatrix"), *((1, row) for row in turn)
    )


def named(depth, kind, name):
    return block(depth, (0, kind), (1, "Name"), (2, name))


def markers(depth, **points):
    own = "".join(named(depth + 3, "Marker", name) + placed(depth + 4, point) for name, point in points.items())
    return (
        block(depth, (0, "RefPoints"), (1, "RefPoint"))
        + placed(depth + 2, (0, 0, 0))
        + block(depth, (2, "Markers"))
        + own
    )


UP = ("0\t-1\t0", "1\t0\t0", "0\t0\t1")
"""A quarter turn about z."""


PARTS = (("crank", (0, 0, 0), UP, 1), ("rod", (0, 1, 0), ALONG, 4), ("rocker", (4, 0, 0), UP, 2))


def asmt(folder, joints, more=""):
    text = "OndselSolver\nAssembly\n" + block(1, (0, "Name"), (1, "A")) + placed(1, (0, 0, 0))
    text += markers(1, G1=(0, 0, 0), G2=(4, 0, 0)) + "\tParts\n"
    for name, point, turn, length in PARTS:
        text += named(2, "Part", name) + placed(3, point, turn)
        text += markers(3, E1=(0, 0, 0), E2=(length, 0, 0))
    text += "\tConstraintSets\n\t\tJoints\n"
    for kind, name, one, other in joints:
        text += named(3, kind, name) + block(4, (0, "MarkerI"), (1, f"/A/{one}"), (0, "MarkerJ"), (1, f"/A/{other}"))
    (folder / "robot.asmt").write_text(f"{text}{more}\tForceTorques\nTimeSeries\nNumber\tInput\n")
    return jk.load(folder / "robot.asmt")


JOINTS = (("RevoluteJoint", "J1", "G1", "crank/E1"), ("RevoluteJoint", "J2", "crank/E2", "rod/E1"),
          ("RevoluteJoint", "J3", "rod/E2", "rocker/E2"), ("RevoluteJoint", "J4", "G2", "rocker/E1"))  # fmt: skip

MORE = (
    "\t\tMotions\n" + named(3, "RotationalMotion", "M") + block(4, (0, "MotionJoint"), (1, "/A/J1"))
    + "\t\tLimits\n" + named(3, "RotationLimit", "L")
    + block(4, (0, "MotionJoint"), (1, "/A/J1"), (0, "Limit"), (1, "30.0*pi/180.0"), (0, "Type"), (1, "=>"))
)  # fmt: skip


def test_markers_of_asmt_are_closed_without_turning_the_motor(tmp_path):
    assembly = asmt(tmp_path, JOINTS, MORE)
    mechanism = assembly.mechanism()
    assert mechanism.motors == ("J1",) and mechanism.mobility().useful == 1
    # the crank stays upright: the end of the rod is 4 from (0, 1), and 2 from (4, 0)
    x, y, _ = mechanism.joints["J3"].frames_1[0][:3, 3]
    np.testing.assert_allclose([np.hypot(x, y - 1), np.hypot(x - 4, y)], [4, 2], atol=1e-12)
    np.testing.assert_allclose(assembly.exported.joint_values["J1"], [np.pi / 2], atol=1e-12)
    (limits,) = mechanism.joints["J1"].limits
    np.testing.assert_allclose(limits, [np.pi / 6 - np.pi / 2, np.inf], atol=1e-12)


def test_a_pin_that_screws_and_a_point_in_a_line(tmp_path):
    screw = named(3, "ScrewJoint", "S") + block(
        4, (0, "MarkerI"), (1, "/A/G2"), (0, "MarkerJ"), (1, "/A/rocker/E1"), (0, "pitch"), (1, "0.5")
    )
    joints = (
        *JOINTS[:2],
        ("PointInLineJoint", "J3", "rod/E2", "rocker/E2"),
        ("CylindricalJoint", "J4", "G2", "rocker/E1"),
    )
    mechanism = asmt(tmp_path, joints, screw).mechanism()
    assert str(mechanism.joints["J4"].kind) == "screw" and float(mechanism.joints["J4"].pitch) == 0.5
    assert mechanism.mobility().useful == 1


def test_unknown_joints_and_markers_are_refused(tmp_path):
    for joint, message in (
        (("BentJoint", "b", "G1", "rod/E1"), "BentJoint 'b': expected one of"),
        (("RevoluteJoint", "b", "G1", "rod/E9"), "unknown marker '/A/rod/E9'"),
    ):
        with pytest.raises(ValueError, match=re.escape(message)):
            asmt(tmp_path, (*JOINTS, joint))
    (tmp_path / "bad.asmt").write_text("something else\n")
    with pytest.raises(ValueError, match="in line 1"):
        jk.load(tmp_path / "bad.asmt")


def test_asmt_that_ends_too_soon_is_never_a_part_of_its_mechanism(tmp_path):
    """Its text has no end of its own: cut at any line, it was read with the joints that were left."""
    asmt(tmp_path, JOINTS, MORE)
    lines = (tmp_path / "robot.asmt").read_text().splitlines(keepends=True)
    behind = lines.index("\tForceTorques\n")
    for end in range(2, behind + 1):
        (tmp_path / "cut.asmt").write_text("".join(lines[:end]))
        with pytest.raises(ValueError, match=r"cut\.asmt"):
            jk.load(tmp_path / "cut.asmt")
    (tmp_path / "cut.asmt").write_text("".join(lines[: behind + 1]))
    assert len(jk.load(tmp_path / "cut.asmt").mechanism().joints) == len(JOINTS)
