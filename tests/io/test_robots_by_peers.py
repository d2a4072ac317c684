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
