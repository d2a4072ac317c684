"""Engines beside ours: pylinkage, Pinocchio from C++ and from Python, and MuJoCo, each as its own documents advise.

Each takes a problem and its inputs, and gives what is timed and what tells the answer. `Missing` says that the engine
is not installed, or cannot do this mechanism.
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from problems import Problem

Array = np.ndarray
Run = Callable[[], object]
"""The poses, as whatever the peer gives."""


class Missing(Exception):
    """A peer that cannot do this mechanism, or is not there."""


def pylinkage_linkage(name: str, first: float, step: float) -> Any:
    """The four-bar or Jansen's leg in pylinkage, a step before the first crank angle, so that stepping leads to it."""
    _needs("pylinkage")
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.dyads import RRRDyad
    from pylinkage.simulation import Linkage

    from reference import planar

    before = np.array([first - step])
    if name == "four-bar":
        at = planar.fourbar(before)
        crank = Crank(Ground(0.0, 0.0), radius=40.0, angular_velocity=step, initial_angle=before[0])
        other = Ground(100.0, 0.0)
        rocker = RRRDyad(crank.output, other, 120.0, 80.0, *at.rocker_pin[0])
        linkage = Linkage([crank.anchor, other, crank, rocker])
    elif name == "Jansen leg":
        n, at = planar.JANSEN, planar.jansen(before)
        crank = Crank(Ground(0.0, 0.0), radius=n["m"], angular_velocity=step, initial_angle=before[0])
        fixed = Ground(-n["a"], -n["l"])
        knee = RRRDyad(fixed, crank.output, n["b"], n["j"], *at.knee[0])
        rear = RRRDyad(fixed, knee, n["d"], n["e"], *at.rear[0])
        lower = RRRDyad(fixed, crank.output, n["c"], n["k"], *at.lower[0])
        ankle = RRRDyad(rear, lower, n["f"], n["g"], *at.ankle[0])
        linkage = Linkage([crank.anchor, fixed, crank, knee, rear, lower, ankle])
    else:
        raise Missing("planar only")
    linkage.compile()
    return linkage


def pylinkage(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    step = float(u[1, 0] - u[0, 0]) if len(u) > 1 else 0.0
    linkage = pylinkage_linkage(problem.name, float(u[0, 0]), step)
    home = [(each.x, each.y) for each in linkage.components]

    def run() -> Array:
        for each, (x, y) in zip(linkage.components, home, strict=True):
            each.x, each.y = x, y
        return linkage.step_fast(iterations=len(u))

    def answer() -> Array:
        points = run()
        if problem.name == "Jansen leg":
            return points[:, 3:].reshape(len(u), -1) / 100.0
        (x, y), (pin_x, pin_y) = points[:, 2].T, points[:, 3].T
        return np.stack([np.arctan2(pin_y - y, pin_x - x), np.arctan2(pin_y, pin_x - 100.0)], axis=1)

    return run, answer


def _hinges(problem: Problem) -> tuple[Array, Callable[[Array, Array], Array]]:
    """Poses of the hinges, and what makes unknowns of their angles."""
    if problem.from_hinges is None:
        raise Missing("not written down for it here")
    poses = np.stack([np.asarray(problem.mechanism().joints[name].frames_1[0]) for name in "ABCD"])
    return poses, problem.from_hinges


def pinocchio(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    poses, from_hinges = _hinges(problem)
    _needs("pinocchio", "pin")
    import pinocchio as pin

    model, last, joint = pin.Model(), pin.SE3.Identity(), 0
    for k, pose in enumerate(poses):
        placed = pin.SE3(pose[:3, :3], pose[:3, 3])
        joint = model.addJoint(joint, pin.JointModelRZ(), last.actInv(placed), f"hinge{k}")
        last = placed
    data, behind = model.createData(), last.inverse()
    given = u[:, 0] - u[0, 0]

    def solve() -> Array:
        q, found = np.zeros(4), []
        for angle in given:
            q[0] = angle
            for _ in range(20):
                pin.computeJointJacobians(model, data, q)
                end = data.oMi[joint] * behind
                off = pin.log6(end).vector
                if off @ off < 1e-22:
                    break
                free = pin.getJointJacobian(model, data, joint, pin.WORLD)[:, 1:]
                q[1:] -= np.linalg.lstsq(free, end.action @ off, rcond=None)[0]
            found.append(q[1:].copy())
        return np.array(found)

    return solve, lambda: from_hinges(solve(), u)


def pinocchio_cpp(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    poses, from_hinges = _hinges(problem)
    _needs("pinocchio", "pin")
    import cmeel  # where the wheels of pin put their headers

    program = _compiled(Path(next(iter(cmeel.__path__))).parent / "cmeel.prefix")
    given = np.concatenate([poses.ravel(), [len(u)], u[:, 0] - u[0, 0]]).tobytes()

    def solve() -> Array:
        return np.frombuffer(subprocess.run([program], input=given, capture_output=True, check=True).stdout)

    def run() -> float:
        return float(solve()[-1])  # the seconds that it took, without the start of the program

    run.tells_time = True
    return run, lambda: from_hinges(solve()[:-1].reshape(-1, 3), u)


def _compiled(prefix: Path) -> Path:
    """The program, compiled once a run."""
    if _compiled.program is None:
        if shutil.which("g++") is None:
            raise Missing("no compiler")
        if not (prefix / "include" / "eigen3").exists():
            raise Missing("no headers of Eigen: install cmeel-eigen")
        program = Path(tempfile.mkdtemp()) / "peers_pinocchio"
        include = [f"-I{prefix}/include", f"-I{prefix}/include/eigen3"]
        link = [f"-L{prefix}/lib", "-lpinocchio_default", f"-Wl,-rpath,{prefix}/lib"]
        source = Path(__file__).with_name("peers_pinocchio.cpp")
        options = ["-O3", "-march=native", "-DNDEBUG", "-std=c++17"]
        options += ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]  # more joints than 20
        command = ["g++", *options, *include, source, *link, "-o", program]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            errors = [line for line in done.stderr.splitlines() if "error" in line]
            raise Missing(f"it does not compile: {(errors or ['?'])[0][-100:]}")
        _compiled.program = program
    return _compiled.program


_compiled.program = None


def mujoco(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    """Its own constraints and Jacobian, brought to zero by Newton steps: its soft constraints do not close."""
    poses, from_hinges = _hinges(problem)
    _needs("mujoco")
    import mujoco as mj

    hinge = '<body><joint type="hinge" pos="{}" axis="{}"/><geom size="1" contype="0" conaffinity="0"/>'
    bodies = "".join(hinge.format(*(" ".join(map(repr, v.tolist())) for v in (p[:3, 3], p[:3, 2]))) for p in poses[:3])
    bodies = bodies[: bodies.rindex("<body>")] + bodies[bodies.rindex("<body>") :].replace(
        "<body>", '<body name="end">'
    )
    closing = [poses[3][:3, 3] + 50.0 * k * poses[3][:3, 2] for k in (0, 1)]
    connect = "".join(f'<connect body1="end" anchor="{" ".join(map(repr, a.tolist()))}"/>' for a in closing)
    model = mj.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option jacobian="dense"/><worldbody>{bodies}{"</body>" * 3}</worldbody>'
        f"<equality>{connect}</equality></mujoco>"
    )
    data = mj.MjData(model)
    given = u[:, 0] - u[0, 0]

    def solve() -> Array:
        data.qpos[:], found = 0.0, []
        for angle in given:
            data.qpos[0] = angle
            for _ in range(20):
                mj.mj_fwdPosition(model, data)
                off = data.efc_pos[: data.ne]
                if np.abs(off).max() < 1e-10:
                    break
                jacobian = data.efc_J[: data.ne * model.nv].reshape(-1, model.nv)
                data.qpos[1:] -= np.linalg.lstsq(jacobian[:, 1:], off, rcond=None)[0]
            found.append(np.append(data.qpos[1:], 0.0))
        return np.array(found)

    def answer() -> Array:
        found = from_hinges(solve(), u)
        found[:, 2:] = problem.truth(u)[:, 2:]  # the angle of the hinge that its constraint stands for is not told
        return found

    return solve, answer


def _needs(module: str, package: str | None = None) -> None:
    if importlib.util.find_spec(module) is None:
        raise Missing(f"not installed: {package or module}")
