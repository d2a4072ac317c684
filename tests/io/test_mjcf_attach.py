"""Models of MuJoCo that are attached to others, against MuJoCo's own compiler and kinematics."""

import numpy as np
import pytest

import jaxkin as jk

ARM = """<mujoco model="arm"><compiler angle="radian" eulerseq="zyx" autolimits="true" meshdir="parts"/>
<default><joint axis="0 1 0" range="-1 1" ref="0.1"/><site euler="0.1 0.2 0.3"/>
<default class="big"><joint axis="1 0 0" range="-0.5 2" type="slide" ref="0"/></default></default>
<asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>
<worldbody><geom size="0.2"/>
<body name="base" pos="0 0 1" euler="0.3 0.1 -0.2"><joint name="j"/><geom size="0.1"/>
<frame euler="0.1 0.2 0.3"><body name="tip" pos="1 0 0" axisangle="0 1 1 0.4" childclass="big"><joint name="k"/>
<geom type="mesh" mesh="m"/><site name="s" pos="0 0.1 0"/><body name="hand" pos="0 0 0.5"><joint name="h" class="main"/>
<inertial pos="0.1 0 0.2" euler="0.3 0.2 0.1" mass="2" diaginertia="0.3 0.2 0.15"/><geom size="0.1"/></body></body>
</frame></body>
<body name="second" pos="3 0 0"><joint name="q" pos="0.1 0 0"/><geom size="0.1"/></body></worldbody>
<equality><joint joint1="j" joint2="q" polycoef="0.2 0.5 0 0 0"/><connect name="pin" body1="hand" body2="world"
anchor="0 0 0"/></equality>
<actuator><motor name="m" joint="j"/></actuator></mujoco>"""

OUTER = """<mujoco><compiler angle="degree" eulerseq="XYZ"/><default><joint axis="0 0 1" range="-20 20"/>
<geom type="capsule"/></default>
<asset><model name="arm" file="sub/arm.xml"/><model name="nested" file="nested.xml"/></asset>
<worldbody><body name="b" pos="0 0 2" euler="10 20 30"><joint name="r"/><geom size="0.1 0.1"/>
<frame pos="1 1 1" euler="0 30 90">{attach}</frame></body></worldbody></mujoco>"""

NESTED = """<mujoco model="nested"><compiler angle="radian"/><asset><model file="sub/arm.xml"/></asset><worldbody>
<body name="n" pos="0 1 0"><joint name="u" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
<attach model="arm" body="base" prefix="in_"/></body></worldbody></mujoco>"""

CASES = {
    "a body": '<attach model="arm" body="base" prefix="l-"/>',
    "all bodies": '<attach model="arm" prefix="l-"/>',
    "a body of a frame, without what is around it": '<attach model="arm" body="tip" prefix="l-"/>',
    "twice": '<attach model="arm" body="base" prefix="l-"/><attach model="arm" body="second" prefix="r-"/>',
    "one in the other": '<attach model="nested" body="n" prefix="x-"/>',
}


def written(folder, attach):
    (folder / "sub").mkdir()
    (folder / "sub" / "arm.xml").write_text(ARM)
    (folder / "nested.xml").write_text(NESTED)
    (folder / "model.xml").write_text(OUTER.format(attach=attach))
    return folder / "model.xml"


def as_mujoco_has_it(model):
    """Collect poses of bodies, and kinds, ranges, axes and places of joints, by name, at `qpos0`."""
    import mujoco

    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    poses = {model.body(number).name: data.body(number) for number in range(1, model.nbody)}
    joints = {model.joint(number).name: (model.joint(number), data.joint(number)) for number in range(model.njnt)}
    return poses, joints


@pytest.mark.parametrize("attach", CASES.values(), ids=CASES)
def test_an_attached_model_is_what_mujoco_makes_of_it(tmp_path, attach):
    mujoco = pytest.importorskip("mujoco")
    path = written(tmp_path, attach)
    poses, joints = as_mujoco_has_it(mujoco.MjModel.from_xml_path(str(path)))
    from jaxkin.io.mjcf import read_mjcf
    from jaxkin.io.xml_tree import read_xml

    found = read_mjcf(path, read_xml(path))
    links = {each.name: each.pose for each in found.links if each.name != "world"}
    assert links.keys() == poses.keys()
    for name, own in poses.items():
        np.testing.assert_allclose(links[name][:3, 3], own.xpos, atol=1e-12)
        np.testing.assert_allclose(links[name][:3, :3], own.xmat.reshape(3, 3), atol=1e-12)
    weighed = [each for each in found.links if each.inertial is not None and each.inertial.mass]
    assert all(each.name.endswith("hand") for each in weighed) and (weighed or "second" in attach)
    for each in weighed:
        there, own = each.inertial.moved(each.pose), poses[each.name]
        turn = own.ximat.reshape(3, 3)
        np.testing.assert_allclose(there.centre, own.xipos, atol=1e-12)
        np.testing.assert_allclose(there.inertia, turn @ np.diag([0.3, 0.2, 0.15]) @ turn.T, atol=1e-12)
    read = {each.name: each for each in found.joints}
    assert joints.keys() == {name for name in read if str(read[name].kind) in ("revolute", "prismatic")}
    for name, (said, own) in joints.items():
        joint = read[name]
        np.testing.assert_allclose(joint.frame_1[:3, 2], own.xaxis, atol=1e-12)
        np.testing.assert_allclose(np.cross(joint.frame_1[:3, 3] - own.xanchor, own.xaxis), 0.0, atol=1e-12)
        assert str(joint.kind) == ("revolute" if said.type[0] == mujoco.mjtJoint.mjJNT_HINGE else "prismatic")
        value = said.qpos0[0]
        np.testing.assert_allclose(joint.limits, [said.range - value], atol=1e-12)
        np.testing.assert_allclose((joint.values or (0.0,))[0], value, atol=1e-12)


def test_what_comes_with_a_body_is_tied_and_moved_as_in_its_model(tmp_path):
    from jaxkin.io.mjcf import read_mjcf
    from jaxkin.io.xml_tree import read_xml

    def read(name, attach):
        (tmp_path / name).mkdir()
        path = written(tmp_path / name, attach)
        return read_mjcf(path, read_xml(path))

    both = read("all", CASES["all bodies"])
    assert both.motors == ("l-j",) and [each.coordinates for each in both.couplings] == [("l-q", "l-j")]
    assert {("l-hand", "world")} <= {each.parts for each in both.joints}
    assert any(shape.kind == "mesh" for link in both.links for shape in link.shapes)
    base, tip = read("base", CASES["a body"]), read("tip", CASES["a body of a frame, without what is around it"])
    assert base.motors == ("l-j",) and not base.couplings  # its other joint did not come
    assert not tip.motors and "l-pin" in {each.name for each in tip.joints}


@pytest.mark.parametrize(
    ("attach", "error", "message"),
    [
        ('<attach model="leg" body="base" prefix="l-"/>', ValueError, "there is no <model> 'leg'"),
        ('<attach model="arm" body="bse" prefix="l-"/>', ValueError, "there is no body 'bse' in arm.xml; .*'base'"),
        ('<attach model="arm" body="base"/>', ValueError, "expected a prefix"),
        ('<attach model="arm" body="base" prefix=""/><attach model="arm" body="base" prefix=""/>', ValueError,
         "another body has its name"),
    ],
)  # fmt: skip
def test_what_cannot_be_attached_is_refused(tmp_path, attach, error, message):
    with pytest.raises(error, match=message):
        jk.load(written(tmp_path, attach))


@pytest.mark.long
def test_models_that_are_missing_or_attach_themselves_are_refused(tmp_path):
    path = written(tmp_path, CASES["a body"])
    (tmp_path / "sub" / "arm.xml").unlink()
    with pytest.raises(FileNotFoundError, match=r"it attaches 'arm\.xml', which is not there"):
        jk.load(path)
    text = (
        '<mujoco><asset><model name="m" file="m.xml"/></asset><worldbody><body name="b">{0}{0}</body></worldbody>'
        "</mujoco>"
    )
    (tmp_path / "m.xml").write_text(text.format('<attach model="m" body="b" prefix="x"/>'))
    with pytest.raises(ValueError, match="or in a circle"):
        jk.load(tmp_path / "m.xml")
    for number in range(12):  # each level attaches the one below four times
        inner = '<attach model="m" prefix="{}"/>' if number else "<body/>"
        below = "".join(inner.format(letter) for letter in "abcd")
        (tmp_path / f"n{number}.xml").write_text(
            f'<mujoco><asset><model name="m" file="n{number - 1}.xml"/></asset><worldbody>{below}</worldbody></mujoco>'
            if number
            else f"<mujoco><worldbody>{below}</worldbody></mujoco>"
        )
    with pytest.raises(ValueError, match="have more than 100000 elements"):
        jk.load(tmp_path / "n11.xml")


KEYED = """<mujoco model="keyed"><compiler angle="degree" autolimits="true"/><default>
<joint range="30 90" axis="0 1 0"/><default class="slides"><joint type="slide" range="0.5 2"/>
</default></default><worldbody><body name="base">
<body name="tip" pos="1 0 0"><joint name="k" class="slides"/><geom size="0.1"/></body>
<frame pos="0 0 1"><joint name="j" ref="10"/></frame><geom size="0.1"/></body>
<body name="second"><freejoint/><geom size="0.1"/><body name="ball" pos="0 1 0">
<joint name="b" type="ball" range="0 0"/><geom size="0.1"/></body></body></worldbody>
<keyframe><key name="short" qpos="1"/><key name="other" qpos="1.1 0.7 0 0 0 1 0 0 0 1 0 0 0"/>
<key name="home" qpos="0.8 0.6 9 9 9 1 0 0 0 0.8 0 0.6 0"/></keyframe></mujoco>"""

HOLDER = """<mujoco><asset><model name="keyed" file="keyed.xml"/></asset><worldbody><body name="hub"><joint name="r"
range="-90 90" ref="20"/><geom size="0.1"/><frame pos="0 0 1" euler="0 0 30">{inside}</frame></body>
<frame pos="0 1 1" euler="0 30 0">{beside}</frame></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("inside", "beside", "keys"),
    [
        ('<attach model="keyed" body="base" prefix="l-"/>', "", ["l-home"]),
        ("", '<attach model="keyed" prefix="l-"/>', ["l-home"]),
        ('<attach model="keyed" body="tip" prefix="l-"/>', '<attach model="keyed" body="base" prefix="r-"/>',
         ["l-home", "r-home"]),
    ],
)  # fmt: skip
def test_keyframes_of_attached_models_are_those_of_mujoco(tmp_path, inside, beside, keys):
    """Of a pose beyond ranges: the joints of each attached model are where MuJoCo's merged keyframe has them."""
    mujoco = pytest.importorskip("mujoco")
    (tmp_path / "keyed.xml").write_text(KEYED.replace('<key name="short" qpos="1"/>', ""))
    (tmp_path / "model.xml").write_text(HOLDER.format(inside=inside, beside=beside))
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    (tmp_path / "keyed.xml").write_text(KEYED)  # a keyframe of another length, which MuJoCo refuses
    from jaxkin.io.mjcf import read_mjcf
    from jaxkin.io.xml_tree import read_xml

    found = read_mjcf(tmp_path / "model.xml", read_xml(tmp_path / "model.xml"))
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    for key in keys:  # each moves joints of its own model
        at = model.key(key).qpos
        for number in range(model.njnt):
            if model.joint(number).name.startswith(key[:2]) and model.jnt_type[number] != mujoco.mjtJoint.mjJNT_FREE:
                first = model.jnt_qposadr[number]
                size = {0: 7, 1: 4}.get(int(model.jnt_type[number]), 1)
                data.qpos[first : first + size] = at[first : first + size]
    mujoco.mj_kinematics(model, data)
    links = {each.name: each.pose for each in found.links}
    for number in range(1, model.nbody):
        np.testing.assert_allclose(links[model.body(number).name][:3, 3], data.xpos[number], atol=1e-12)
        np.testing.assert_allclose(links[model.body(number).name][:3, :3], data.xmat[number].reshape(3, 3), atol=1e-12)
    note = " and ".join(f"<key name={key!r}>" for key in keys)
    assert any(f"the assembled pose is that of {note}" in each for each in found.notes)
    assert not any(low > 1e-9 or high < -1e-9 for each in found.joints for low, high in each.limits)
