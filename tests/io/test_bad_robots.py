"""What robot files may hold that makes no sense: one line each, with the file and the element."""

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

TREE = '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>{}</robot>'
JOINT = '<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><axis xyz="0 0 1"/></joint>'
TWO = '<mujoco><worldbody><body name="a"><joint name="x"/><body name="b"><joint name="y"/></body></body></worldbody>'
BOMB = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>'


@pytest.mark.parametrize(
    ("suffix", "text", "message"),
    [
        (".urdf", TREE.format(JOINT.format("1", "a", "b") + JOINT.format("2", "b", "c") + JOINT.format("3", "a", "c")),
         "link 'c' is the child of two joints, '2' and '3': a URDF is a tree; close the loop in a file of loops"),
        (".urdf", TREE.format(JOINT.format("1", "a", "b")), "'a' and 'c' are both the child of no joint"),
        (".urdf", BOMB + TREE.format(""), "DOCTYPE"),
        (".xml", BOMB + "<mujoco/>", "DOCTYPE"),
        (".sdf", BOMB + "<sdf/>", "DOCTYPE"),
        (".xml", TWO + '<equality><joint joint1="x" joint2="y" polycoef="1 b"/></equality></mujoco>',
         r"model.xml: <joint>: polycoef: expected 2 finite numbers, got '1 b'"),
        (".xml", TWO + '<tendon><fixed name="t"><joint joint="x" coef="q"/><joint joint="y"/></fixed></tendon>'
         '<equality><tendon tendon1="t"/></equality></mujoco>', r"<tendon>: coef: expected 1 finite number, got 'q'"),
        (".xml", TWO + '<equality><weld name="w" body1="a" body2="a"/></equality></mujoco>',
         r"<weld name='w'>: it ties the body 'a' to itself"),
        (".xml", TWO + '<equality><connect body1="a" body2="q"/></equality></mujoco>', "unknown body 'q'"),
        (".sdf", '<sdf><model name="m"><link name="a"/><include><uri>model://no</uri></include></model></sdf>',
         "it includes 'model://no', which is not there"),
        (".asmt", "OndselSolver\nAssembly\n\tName\n\t\tA\n\tPosition3D\n\t\t0\t0\t0\n\tRotationMatrix\n",
         "line 2: Assembly: expected a RotationMatrix of three rows"),
    ],
)  # fmt: skip
def test_one_line_names_the_file_and_the_element(tmp_path, suffix, text, message):
    path = tmp_path / f"model{suffix}"
    path.write_text(text)
    with pytest.raises((ValueError, FileNotFoundError), match=message) as caught:
        jk.load(path).mechanism()
    assert "\n" not in str(caught.value) and path.name in str(caught.value)


def test_a_ball_is_no_gear_and_a_ratio_not_zero():
    ball = jk.spherical("ball", "ground", "a", point=(0, 0, 0))
    hinge = jk.revolute("hinge", "ground", "b", point=(1, 0, 0), axis=(0, 0, 1))
    with pytest.raises(ValueError, match=r"joint 'ball' \(spherical\) has no coordinate to couple"):
        jk.Mechanism.build(fixed=["ground"], joints=[ball, hinge], couplings=[jk.gear("ball", "hinge", 2)])
    with pytest.raises(ValueError, match="must not be zero"):
        jk.gear("ball", "hinge", 0)


def test_a_pose_that_asks_for_more_than_the_freedoms_is_refused():
    poses = np.tile(np.eye(4), (3, 1, 1))
    with pytest.raises(ValueError, match="the mechanism of crank, coupler, rocker has 1 freedom"):
        planar_fourbar().sweep({jk.pose("coupler"): poses})
    with pytest.raises(ValueError, match="the part 'ground' is fixed"):
        planar_fourbar().sweep({jk.pose("ground"): poses})
