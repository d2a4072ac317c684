"""Random joint states of Cassie moved onto its loops, as a reset for training needs: ours, Pinocchio and MuJoCo.

    python benchmarks/projection.py CASSIE.xml [WIDTH]

`CASSIE.xml` is the model of MuJoCo Menagerie. All engines start from the same states, uniform within WIDTH radians
(0.3) around the assembled pose and within the limits. Ours finds the nearest closed poses, 10,000 states at once. The
others take Newton steps of least norm on their own kinematics and Jacobians, of models that are written by
`jk.write_urdf` and `jk.write_mjcf`, one state after the other from Python, until the loops close to the same residual;
that is no nearest pose, but one near.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import jax
import numpy as np

jax.config.update("jax_enable_x64", True)
ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

import jaxkin as jk  # noqa: E402
from jaxkin.io.yaml_subset import parse_yaml  # noqa: E402

OURS, THEIRS = 10_000, 200
"""States that an engine is given: a loop in Python is slow."""
CLOSED = 1e-12
STEPS = 30

Rows = Mapping[str, np.ndarray]


def states(mechanism: jk.Mechanism, width: float, count: int) -> dict[str, np.ndarray]:
    """Random displacements of all joints, (states, coordinates)."""
    rng, rows = np.random.default_rng(0), {}
    for joint in mechanism.all_joints:
        if joint.freedoms:
            ends = np.array(joint.limits or ((-np.inf, np.inf),) * joint.freedoms)
            low, high = np.clip(ends[:, 0], -width, 0), np.clip(ends[:, 1], 0, width)
            rows[joint.name] = rng.uniform(low, high, (count, joint.freedoms))
    return rows


def ours(mechanism: jk.Mechanism, rows: Rows) -> tuple[float, float, float]:
    """Seconds of the first call and of one state later, and the share that closes."""
    begin = time.process_time()
    found = jax.block_until_ready(jk.project(mechanism, rows))
    first = time.process_time() - begin
    again = []
    for _ in range(3):
        begin = time.process_time()
        jax.block_until_ready(jk.project(mechanism, rows).distance)
        again.append(time.process_time() - begin)
    return first, min(again) / OURS, float(np.mean(found.motion.closed))


def pinocchio(mechanism: jk.Mechanism, folder: Path) -> Callable[[Rows, int], float]:
    """What closes one state in Pinocchio, and gives the residual that is left."""
    import pinocchio as pin

    from reference.pinocchio_models import with_balls

    file = jk.write_urdf(mechanism, folder / "cassie.urdf")
    loops = parse_yaml(file.with_suffix(".yaml").read_text(), "cassie.yaml")
    model = with_balls(pin, pin.buildModelFromUrdf(str(file)), loops.get("joint_name", ()))
    data = model.createData()
    pairs = [tuple(model.getFrameId(name, pin.FrameType.BODY) for name in pair) for pair in loops["closed_loop"]]
    points = [kind == "3d" for kind in loops["type"]]
    joints = [(name, model.joints[model.getJointId(name)]) for name in list(model.names)[1:]]

    def close(rows: Rows, state: int) -> float:
        q = pin.neutral(model)
        for name, joint in joints:
            values = rows[name][state] if name in rows else np.zeros(joint.nv)
            if joint.nq == 4:
                q[joint.idx_q : joint.idx_q + 4] = pin.Quaternion(pin.rpy.rpyToMatrix(values)).coeffs()
            else:
                q[joint.idx_q : joint.idx_q + joint.nq] = (
                    values if joint.nq == 1 else (np.cos(values[0]), np.sin(values[0]))
                )
        for _ in range(STEPS):
            pin.computeJointJacobians(model, data, q)
            pin.updateFramePlacements(model, data)
            errors, slopes = [], []
            for (one, other), point in zip(pairs, points, strict=True):
                first, second = data.oMf[one], data.oMf[other]
                turn = [] if point else [pin.log3(second.rotation @ first.rotation.T)]
                errors += [second.translation - first.translation, *turn]
                sides = [pin.getFrameJacobian(model, data, each, pin.LOCAL_WORLD_ALIGNED) for each in (one, other)]
                slopes.append((sides[1] - sides[0])[: 3 if point else 6])
            error = np.concatenate(errors)
            if np.linalg.norm(error) < CLOSED:
                break
            q = pin.integrate(model, q, -np.linalg.lstsq(np.concatenate(slopes), error, rcond=1e-10)[0])
        return float(np.linalg.norm(error))

    return close


def mujoco(mechanism: jk.Mechanism, folder: Path) -> Callable[[Rows, int], float]:
    """What closes one state in MuJoCo by its own constraints and Jacobian: its soft constraints do not close."""
    import mujoco as mj

    file = jk.write_mjcf(mechanism, folder / "cassie.xml")
    model = mj.MjModel.from_xml_path(str(file))
    model.opt.jacobian = mj.mjtJacobian.mjJAC_DENSE
    data, step = mj.MjData(model), np.zeros(model.nv)
    joints = [(model.joint(number).name, model.jnt_qposadr[number]) for number in range(model.njnt)]

    def close(rows: Rows, state: int) -> float:
        mj.mj_resetData(model, data)
        for (name, at), kind in zip(joints, model.jnt_type, strict=True):
            values = rows[name][state] if name in rows else np.zeros(1)
            if kind == mj.mjtJoint.mjJNT_BALL:
                mj.mju_euler2Quat(data.qpos[at : at + 4], values, "XYZ")
            else:
                data.qpos[at] = values[0]
        for _ in range(STEPS):
            mj.mj_fwdPosition(model, data)
            off = data.efc_pos[: data.ne]
            if np.linalg.norm(off) < CLOSED:
                break
            jacobian = data.efc_J[: data.ne * model.nv].reshape(-1, model.nv)
            step[:] = -np.linalg.lstsq(jacobian, off, rcond=1e-10)[0]
            mj.mj_integratePos(model, data.qpos, step, 1.0)
        return float(np.linalg.norm(off))

    return close


def timed(close: Callable[[Rows, int], float], rows: Rows) -> tuple[float, float, float]:
    """Seconds of one state, the share that closes, and the median residual."""
    close(rows, 0)
    begin = time.process_time()
    left = np.array([close(rows, state) for state in range(THEIRS)])
    return (time.process_time() - begin) / THEIRS, float(np.mean(left < CLOSED)), float(np.median(left))


def main() -> None:
    path, width = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 0.3
    mechanism = jk.load(path).mechanism()
    rows = states(mechanism, width, OURS)
    first, each, share = ours(mechanism, rows)
    print(f"| jaxkin, nearest pose, {OURS} at once | {1e6 * each:.1f} us | 1 | {100 * share:.1f}% | 1e-13 |")
    print(f"  (first call {first:.1f} s of processor time)")
    with tempfile.TemporaryDirectory() as name:
        for what, make in (("Pinocchio", pinocchio), ("MuJoCo", mujoco)):
            try:
                seconds, closed, left = timed(make(mechanism, Path(name)), rows)
            except ImportError as missing:
                print(f"| {what} | not installed: {missing.name} | | | |")
                continue
            told = f"| {1e6 * seconds:.0f} us | {seconds / each:.0f} | {100 * closed:.1f}% | {left:.0e} |"
            print(f"| {what}, Newton's method from Python {told}")


if __name__ == "__main__":
    main()
