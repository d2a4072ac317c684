"""Robots of other people along a motion of all their motors, pose by pose, against kinematics of other programs.

Needs the group `peers`. Each program reads the file itself, and is given the coordinates of our motion.
"""

from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.yaml_subset import parse_yaml
from reference.archives import unpack
from reference.bare_models import bare_model
from reference.grippers import ROBOTIQ_2F85, XARM_HAND

SAME = 1e-11
"""Metres, and entries of rotations: sums along chains of a dozen links a metre long, of angles that are closed to
about 1e-14."""

POSES = 9

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("robots")
    unpack(Path(__file__).with_name("data") / "robots" / "robots.tar.xz", where)
    return where


def moved(assembly):
    """Sweep all motors, each by an amplitude of its own, and give the values of all joints as the file counts them."""
    mechanism = assembly.mechanism()
    path = np.linspace(0, 2 * np.pi, POSES)
    drive = {motor: (0.06 + 0.01 * k) * np.sin(path + k) - (0.06 + 0.01 * k) * np.sin(k)
             for k, motor in enumerate(mechanism.motors)}  # fmt: skip
    motion = mechanism.sweep(drive, throw=True)
    assert max(np.abs(np.asarray(motion.transforms[part]) - np.eye(4)).max() for part in mechanism.parts) > 0.02
    zero = assembly.exported.joint_values
    moving = {name: np.asarray(values) for name, values in motion.coordinates.items()}
    return motion, {name: value + moving.get(name, np.zeros((POSES, len(value)))) for name, value in zero.items()}


@pytest.mark.parametrize("name", ["5bar_linkage", "robot_delta", "cassie_like", "digit_like"])
def test_every_link_is_where_pinocchio_has_it_and_every_loop_is_closed(folder, name):
    pinocchio = pytest.importorskip("pinocchio")
    path = folder / f"gepetto__{name}.urdf"
    motion, values = moved(jk.load(path, loops=path.with_suffix(".yaml")))
    model = pinocchio.buildModelFromUrdf(str(path))
    data = model.createData()

    def frames(pose):
        q = pinocchio.neutral(model)
        for joint, rows in values.items():
            if model.existJointName(joint) and rows.size:
                own, (value,) = model.joints[model.getJointId(joint)], rows[pose]
                # Pinocchio has a hinge without limits as cosine and sine
                q[own.idx_q : own.idx_q + own.nq] = value if own.nq == 1 else (np.cos(value), np.sin(value))
        pinocchio.framesForwardKinematics(model, data, q)
        return {frame.name: data.oMf[number].homogeneous.copy() for number, frame in enumerate(model.frames)}

    loops = parse_yaml(path.with_suffix(".yaml").read_text(), "robot.yaml")
    begun = frames(0)  # the motion begins in the assembled pose
    links = [frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY]
    assert len(links) > 4
    for pose in range(POSES):
        found = frames(pose)
        for link in links:
            expected = np.asarray(motion.transforms[link])[pose] @ begun[link]
            np.testing.assert_allclose(found[link], expected, atol=SAME)
        for one, other in loops["closed_loop"]:
            np.testing.assert_allclose(found[one], found[other], atol=SAME)


def test_every_body_of_cassie_is_where_mujoco_has_it(folder, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    file = folder / "menagerie__agility_cassie_cassie.xml"
    model = bare_model(file, tmp_path)
    data = mujoco.MjData(model)
    motion, values = moved(jk.load(file))
    hinges = [model.joint(k).name for k in range(model.njnt) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE]
    rods = {int(model.jnt_bodyid[k]) for k in range(model.njnt) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_BALL}
    assert len(hinges) > 15 and len(rods) == 2

    def placed(pose):
        data.qpos[:7] = [*model.body("cassie-pelvis").pos, 1, 0, 0, 0]
        for name in hinges:
            data.qpos[model.joint(name).qposadr[0]] = values[name][pose, 0]
        mujoco.mj_kinematics(model, data)
        return data.xpos.copy(), data.xmat.reshape(-1, 3, 3).copy()

    def end(number, point, points, turns):
        return points[number] + turns[number] @ point

    first_points, first_turns = placed(0)
    for pose in range(POSES):
        points, turns = placed(pose)
        for number in range(1, model.nbody):
            if number not in rods:  # these are told by the loops: what turns them is three angles
                step = np.asarray(motion.transforms[model.body(number).name])[pose]
                np.testing.assert_allclose(points[number], (step @ [*first_points[number], 1])[:3], atol=SAME)
                np.testing.assert_allclose(turns[number], step[:3, :3] @ first_turns[number], atol=SAME)
        for k in range(model.neq):
            if model.eq_type[k] != mujoco.mjtEq.mjEQ_CONNECT:
                continue
            one, other = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
            near, far = model.eq_data[k, :3], model.eq_data[k, 3:6]
            if rods & {one, other}:  # the rod reaches from its ball to the other body
                rod, body = (one, other) if one in rods else (other, one)
                own, at = (near, far) if rod == one else (far, near)
                reach = np.linalg.norm(end(body, at, points, turns) - points[rod])
                np.testing.assert_allclose(reach, np.linalg.norm(own), atol=SAME)
            else:
                np.testing.assert_allclose(end(one, near, points, turns), end(other, far, points, turns), atol=SAME)


@pytest.mark.parametrize(
    ("text", "closed", "others"),
    [(ROBOTIQ_2F85, 0.8, {"right_follower": -0.5, "left_follower": -0.2}), (XARM_HAND, 0.85, {})],
    ids=["Robotiq", "xArm"],
)
def test_a_gripper_closes_as_newton_has_it_on_kinematics_of_mujoco(text, closed, others, tmp_path):
    """From the driver alone, over its whole range: what MuJoCo's Jacobians lead to is where our fingers are.

    The fingers of the Robotiq give way to what they grasp: each has a freedom of its own beside the driver.
    """
    mujoco = pytest.importorskip("mujoco")
    (tmp_path / "gripper.xml").write_text(text)
    mechanism = jk.load(tmp_path / "gripper.xml").mechanism()
    (motor,) = mechanism.motors
    drive = {name: np.linspace(0, end, 18) for name, end in {motor: closed, **others}.items()}
    assert mechanism.mobility().freedoms == len(drive)
    motion = mechanism.sweep(drive, throw=True)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    held = {model.joint(name).dofadr[0]: values for name, values in drive.items()}
    free = np.flatnonzero(~np.isin(np.arange(model.nv), [*held]))
    first = None
    for pose in range(len(motion)):
        for place, values in held.items():
            data.qpos[place] = values[pose]
        for _ in range(20):
            residual, jacobian = _ties(mujoco, model, data)
            data.qpos[free] -= np.linalg.lstsq(jacobian[:, free], residual, rcond=1e-10)[0]
        residual, _ = _ties(mujoco, model, data)
        assert np.abs(residual).max() < 1e-14
        places = np.tile(np.eye(4), (model.nbody, 1, 1))
        places[:, :3, :3], places[:, :3, 3] = data.xmat.reshape(-1, 3, 3), data.xpos
        first = places if first is None else first
        for number in range(1, model.nbody):
            step = np.asarray(motion.transforms[model.body(number).name])[pose]
            np.testing.assert_allclose(places[number], step @ first[number], atol=1e-12)
        for number in range(model.njnt):
            found = float(motion.coordinates[model.joint(number).name][pose, 0])
            np.testing.assert_allclose(found, data.qpos[number], atol=1e-12)
    assert np.abs(data.qpos).min() > 0.1  # all joints have moved


def _ties(mujoco, model, data):
    """Residuals of the constraints, and their derivatives, from MuJoCo's kinematics at `data.qpos`."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    residual, rows = [], []
    for k in range(model.neq):
        one, other = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
        if model.eq_type[k] == mujoco.mjtEq.mjEQ_CONNECT:
            at, jacobians = [], []
            for body, own in ((one, model.eq_data[k, :3]), (other, model.eq_data[k, 3:6])):
                at.append(data.xpos[body] + data.xmat[body].reshape(3, 3) @ own)
                jacobians.append(np.zeros((3, model.nv)))
                mujoco.mj_jac(model, data, jacobians[-1], None, at[-1], body)
            residual += list(at[0] - at[1])
            rows += list(jacobians[0] - jacobians[1])
        elif model.eq_type[k] == mujoco.mjtEq.mjEQ_JOINT:
            residual.append(data.qpos[one] - model.eq_data[k, 1] * data.qpos[other])
            row = np.zeros(model.nv)
            row[one], row[other] = 1.0, -model.eq_data[k, 1]
            rows.append(row)
    return np.array(residual), np.array(rows)
