"""Our sweep beside what else there is, in one run: `uv run --group peers python benchmarks/peers.py [MECHANISM ...]`.

Every peer is used as its own documents advise, at its best: batched where it can be, and begun near the answer where
it needs that. Each answer is held against the closed form before it is timed. What is not installed is skipped and
named; slow peers are timed on few poses. Machines differ and are noisy: compare the rows of one run, not two runs.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from problems import PROBLEMS, Problem
from timing import Timing, timed

SIZES = (1, 360, 10_000, 100_000)
FEW, NODES, LONGEST = 200, 64, 20.0
"""Poses for what goes one by one; starts along the range for what needs one; seconds of a call that is still made."""
RIGHT = 1e-6

Array = np.ndarray
Run = Callable[[], object]
"""The poses, as whatever the peer gives."""


class Missing(Exception):
    """A peer that cannot do this mechanism, or is not there."""


def ours(problem: Problem, u: Array, method: str | None = None) -> tuple[Run, Callable[[], Array]]:
    mechanism, drive = problem.mechanism(), problem.drive(u)
    sweep = partial(mechanism.sweep, drive, **({"method": method} if method else {}))
    return lambda: sweep().displacements, lambda: problem.unknowns(sweep(), u)


def closed(problem: Problem, u: Array) -> tuple[Run, None]:
    if problem.closed is None:
        raise Missing("there is none")
    angles = jnp.asarray(u[:, 0])
    return lambda: problem.closed(angles), None


def closed_numpy(problem: Problem, u: Array) -> tuple[Run, None]:
    if problem.closed_numpy is None:
        raise Missing("there is none")
    return lambda: problem.closed_numpy(u[:, 0]), None


def starts(problem: Problem, u: Array) -> Array:
    """The true answer at the nearest of some nodes along the range: no solver finds its own branch of so many."""
    truth = problem.truth(u)
    width = max(1, -(-len(u) // NODES))
    return truth[np.minimum((np.arange(len(u)) // width) * width + width // 2, len(u) - 1)]


def jaxopt_lm(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from jaxopt import LevenbergMarquardt

    residual = partial(problem.residual, xp=jnp)
    solver = LevenbergMarquardt(
        residual, materialize_jac=True, solver="cholesky", tol=1e-12, xtol=1e-15, gtol=1e-15, maxiter=30, jit=True
    )
    solve = jax.jit(jax.vmap(lambda start, u: solver.run(start, u).params))
    return _called(solve, jnp.asarray(starts(problem, u)), jnp.asarray(u))


def optimistix(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    import optimistix as optx

    def residual(x, u):
        return problem.residual(x, u, jnp)

    if problem.square:
        solver = optx.Newton(rtol=1e-10, atol=1e-12)
        find = partial(optx.root_find, residual, solver, throw=False, max_steps=30)
    else:
        solver = optx.GaussNewton(rtol=1e-10, atol=1e-12)
        find = partial(optx.least_squares, residual, solver, throw=False, max_steps=30)
    solve = jax.jit(jax.vmap(lambda start, u: find(start, u).value))
    return _called(solve, jnp.asarray(starts(problem, u)), jnp.asarray(u))


def _called(solve, *arguments) -> tuple[Run, Callable[[], Array]]:
    return lambda: solve(*arguments), lambda: np.asarray(solve(*arguments))


def scipy(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    from scipy.optimize import least_squares

    first = problem.truth(u)[0]

    def solve() -> Array:
        x, found = first, []
        for each in u:
            x = least_squares(problem.residual, x, method="lm", args=(each, np), xtol=1e-15, ftol=1e-15, gtol=1e-15).x
            found.append(x)
        return np.array(found)

    return solve, solve


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


def _hinge_poses(problem: Problem) -> Array:
    if problem.from_hinges is None:
        raise Missing("not written down for it here")
    return np.stack([np.asarray(problem.mechanism().joints[name].frames_1[0]) for name in "ABCD"])


def pinocchio(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    poses = _hinge_poses(problem)
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

    return solve, lambda: problem.from_hinges(solve(), u)


def pinocchio_cpp(problem: Problem, u: Array) -> tuple[Run, Callable[[], Array]]:
    poses = _hinge_poses(problem)
    _needs("pinocchio", "pin")
    import cmeel  # where the wheels of pin put their headers

    program = _compiled(Path(next(iter(cmeel.__path__))).parent / "cmeel.prefix")
    given = np.concatenate([poses.ravel(), [len(u)], u[:, 0] - u[0, 0]]).tobytes()

    def solve() -> Array:
        return np.frombuffer(subprocess.run([program], input=given, capture_output=True, check=True).stdout)

    def run() -> float:
        return float(solve()[-1])  # the seconds that it took, without the start of the program

    run.tells_time = True
    return run, lambda: problem.from_hinges(solve()[:-1].reshape(-1, 3), u)


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
        source = Path(__file__).with_suffix("").with_name("peers_pinocchio.cpp")
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
    poses = _hinge_poses(problem)
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
        found = problem.from_hinges(solve(), u)
        found[:, 2:] = problem.truth(u)[:, 2:]  # the angle of the hinge that its constraint stands for is not told
        return found

    return solve, answer


def _needs(module: str, package: str | None = None) -> None:
    if importlib.util.find_spec(module) is None:
        raise Missing(f"not installed: {package or module}")


PEERS: dict[str, tuple[Callable, bool]] = {
    "formula, jitted": (closed, False),
    "formula, NumPy": (closed_numpy, False),
    "jaxkin": (ours, False),
    "jaxkin, dfp": (partial(ours, method="dfp"), True),
    "jaxopt LM, vmap": (jaxopt_lm, False),
    "optimistix, vmap": (optimistix, False),
    "SciPy least_squares": (scipy, True),
    "pylinkage": (pylinkage, False),
    "Pinocchio, C++": (pinocchio_cpp, False),
    "Pinocchio, Python": (pinocchio, True),
    "MuJoCo, Newton": (mujoco, True),
}
"""How each is made ready, and whether it goes pose by pose through an interpreter."""


def rows(problem: Problem) -> Iterator[str]:
    for name, (make, slow) in PEERS.items():
        seconds = 0.0
        for poses in (FEW,) if slow else SIZES:
            if seconds * poses > LONGEST:
                yield f"{name:20}{poses:>8}   left out: some {seconds * poses:.0f} s a call"
                continue
            u = problem.inputs(poses)
            try:
                run, answer = make(problem, u)
            except (Missing, ImportError) as missing:
                yield f"{name:20}{'':>8}   skipped: {missing}"
                break
            error = "" if answer is None else _error(problem, answer(), problem.truth(u))
            timing = _told(run) if getattr(run, "tells_time", False) else timed(run)
            seconds = timing.median / poses
            spread = f"{timing.low / poses * 1e9:.0f}-{timing.high / poses * 1e9:.0f}"
            yield f"{name:20}{poses:>8}{timing.median * 1e3:>11.3f}{seconds * 1e9:>12.0f}{spread:>23}   {error}"


def _told(run: Run) -> Timing:
    run()
    return Timing(*np.quantile([run() for _ in range(7)], [0.5, 0.25, 0.75]).tolist())


def _error(problem: Problem, found: Array, truth: Array) -> str:
    error = problem.error(found, truth)
    right = error < RIGHT
    share = "" if right.all() else f", {right.mean():.1%} of the poses right"
    return f"{error[right].max() if right.any() else np.inf:.0e}{share}"


def main(names: list[str]) -> None:
    jax.config.update("jax_enable_x64", True)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    print(f"jax {jax.__version__}, {jax.devices()[0].device_kind}, {os.cpu_count()} cores{load}, float64")
    for name in names or PROBLEMS:
        print(f"\n{name:20}{'poses':>8}{'ms a call':>11}{'ns a pose':>12}{'middle half':>23}   error")
        for row in rows(PROBLEMS[name]()):
            print(row, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
