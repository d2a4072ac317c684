"""Robots as others publish them: which are read, and whether their links move and weigh as other programs have it.

    python benchmarks/published_robots.py FOLDER...

Takes every .urdf and every .xml with a <mujoco> element below the folders. Of each, all joints of one coordinate that
no other one drives (all motors, where the file names some) move by up to 0.1 at five poses. Then Pinocchio (URDF) or
MuJoCo is given the values of our joints, reads the file itself, and says where the links are. *links* is the largest
difference, of entries of poses, metres. Of a URDF without followers, *torques* is the largest difference of the torques
that hold the joints against gravity, over the largest torque, by `jk.drive_forces` and by Pinocchio. Needs the group
`peers`. A folder is what `pip install --target FOLDER PACKAGE` makes of a package of robots.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections import Counter
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

os.environ.setdefault("JAX_ENABLE_X64", "1")
import numpy as np

import jaxkin as jk

POSES, AMPLITUDE = 5, 0.1
GRAVITY = (1.0, -2.0, -9.0)
SAME = 1e-6
"""Differences from here on are printed by file: files write directions with six to eight digits, and
`mechanism.notes` say by how much they were aligned."""
MOVES = ("revolute", "prismatic", "screw")


@dataclass(frozen=True)
class Verdict:
    """What came of one file."""

    file: Path
    refused: str = ""
    """Why it was not read, or by whom."""
    links: float | None = None
    torques: float | None = None


def main() -> None:
    """Print a line for each folder, and below it each file that is refused or differs."""
    print(f"{'folder':<40} {'files':>5} {'read':>5} {'move':>5}   links  torques")
    for folder in map(Path, sys.argv[1:]):
        files = sorted(
            file
            for file in folder.rglob("*")
            if file.suffix == ".urdf" or (file.suffix == ".xml" and b"<mujoco" in file.read_bytes()[:10_000])
        )
        verdicts = [verdict(file) for file in files]
        moved = [each for each in verdicts if each.links is not None]
        links, torques = (
            max((value for each in moved if (value := getattr(each, what)) is not None), default=np.nan)
            for what in ("links", "torques")
        )
        read = sum(not each.refused for each in verdicts)
        print(f"{folder.name:<40} {len(files):>5} {read:>5} {len(moved):>5} {links:>7.0e} {torques:>8.0e}")
        for reason, count in Counter(each.refused for each in verdicts if each.refused).most_common():
            print(f"    {count} x {reason}")
        for each in moved:
            if max(each.links or 0.0, each.torques or 0.0) > SAME:
                print(f"    {each.file.name}: links {each.links:.0e}, torques {each.torques or np.nan:.0e}")


def verdict(file: Path) -> Verdict:
    """Read a file, move its joints, and compare."""
    warnings.simplefilter("ignore")
    try:
        assembly = jk.load(file)
        mechanism = assembly.mechanism()
    except (ValueError, FileNotFoundError) as error:
        return Verdict(file, str(error).partition(": ")[2][:150] or str(error)[:150])
    couplings = assembly.exported.couplings if assembly.exported else ()
    led = {each.coordinates[0].partition(".")[0] for each in couplings}
    single = [name for name, joint in mechanism.joints.items() if str(joint.kind) in MOVES]
    driven = [*mechanism.motors] or [name for name in single if name not in led]
    if not driven:
        return Verdict(file)
    turn = np.linspace(0, 2 * np.pi, POSES)
    motion = mechanism.sweep({name: AMPLITUDE * (np.sin(turn + k) - np.sin(k)) for k, name in enumerate(driven)})
    peer = of_pinocchio if file.suffix == ".urdf" else of_mujoco
    try:
        placed, torques = peer(file, joint_values(assembly, motion))
    except (ValueError, KeyError) as error:
        return Verdict(file, f"by its own program: {str(error).splitlines()[0][:100]}")
    links = max(
        (
            np.abs(poses - np.asarray(motion.transforms[link]) @ poses[0]).max()
            for link, poses in placed.items()
            if link in motion.transforms
        ),
        default=np.nan,
    )
    if torques is None or couplings or {*driven} != {*single}:
        return Verdict(file, links=float(links))
    return Verdict(file, links=float(links), torques=torque_difference(mechanism, motion, torques))


def joint_values(assembly: Any, motion: Any) -> dict[str, np.ndarray]:
    """List the values (poses, coordinates) of all joints, as the file counts them."""
    moved = {name: np.asarray(values) for name, values in motion.coordinates.items()}
    zero = assembly.exported.joint_values
    return {name: value + moved.get(name, np.zeros((POSES, len(value)))) for name, value in zero.items()}


def torque_difference(mechanism: Any, motion: Any, torques: dict[str, np.ndarray]) -> float | None:
    """Compare the torques (poses,) of joints; None where masses are not known."""
    try:
        masses = jk.masses(mechanism, given={part: 0.0 for part in mechanism.fixed})
    except ValueError:
        return None
    found = jk.drive_forces(motion, masses, gravity=GRAVITY).forces
    largest = max(np.abs(each).max() for each in torques.values())
    ours = {name.partition(".")[0]: np.asarray(values) for name, values in found.items()}
    return max(float(np.abs(ours[name] - torques[name]).max()) for name in torques if name in ours) / (largest or 1.0)


def of_pinocchio(file: Path, values: dict[str, np.ndarray]) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return the poses (poses, 4, 4) of links and the torques (poses,) of joints against gravity."""
    pinocchio: Any = import_module("pinocchio")

    model = pinocchio.buildModelFromUrdf(str(file))
    model.gravity.linear = np.array(GRAVITY)
    data = model.createData()
    links = [(number, frame.name) for number, frame in enumerate(model.frames)
             if frame.type == pinocchio.FrameType.BODY]  # fmt: skip
    own = {name: model.joints[model.getJointId(name)] for name in values if model.existJointName(name)}
    if any(joint.nv != 1 for joint in own.values()):
        raise ValueError("joints of several coordinates")
    poses, torques = {name: [] for _, name in links}, {name: [] for name in own}
    for pose in range(POSES):
        q = pinocchio.neutral(model)
        for name, joint in own.items():
            (value,) = values[name][pose]
            # a hinge without limits is a cosine and a sine
            q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
        pinocchio.framesForwardKinematics(model, data, q)
        for number, name in links:
            poses[name].append(data.oMf[number].homogeneous.copy())
        force = pinocchio.computeGeneralizedGravity(model, data, q)
        for name, joint in own.items():
            torques[name].append(force[joint.idx_v])
    return {name: np.array(each) for name, each in poses.items()}, {
        name: np.array(each) for name, each in torques.items()
    }


def of_mujoco(file: Path, values: dict[str, np.ndarray]) -> tuple[dict[str, np.ndarray], None]:
    """Return the poses (poses, 4, 4) of bodies."""
    mujoco: Any = import_module("mujoco")

    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    poses = np.tile(np.eye(4), (model.nbody, POSES, 1, 1))
    single = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)
    for pose in range(POSES):
        mujoco.mj_resetData(model, data)
        for k in range(model.njnt):
            name = model.joint(k).name
            if model.jnt_type[k] in single and name in values:
                data.qpos[model.jnt_qposadr[k]] = values[name][pose, 0]
        mujoco.mj_kinematics(model, data)
        poses[:, pose, :3, 3], poses[:, pose, :3, :3] = data.xpos, data.xmat.reshape(-1, 3, 3)
    return {model.body(k).name: poses[k] for k in range(1, model.nbody)}, None


if __name__ == "__main__":
    main()
