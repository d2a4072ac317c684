"""Our sweep beside what else there is, in one run: `uv run --group peers python benchmarks/peers.py [MECHANISM ...]`.

Every peer is used as its own documents advise, at its best: batched where it can be, and begun near the answer where
it needs that. Each answer is held against the closed form before it is timed. What is not installed is skipped and
named; slow peers are timed on few poses. Machines differ and are noisy: compare the rows of one run, not two runs.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from peer_engines import Missing, Run, mujoco, pinocchio, pinocchio_cpp, pylinkage
from problems import PROBLEMS, Problem
from timing import Timing, timed

SIZES = (1, 360, 10_000, 100_000)
FEW, NODES, LONGEST = 200, 64, 20.0
"""Poses for what goes one by one; starts along the range for what needs one; seconds of a call that is still made."""
RIGHT = 1e-6

Array = np.ndarray


def ours(problem: Problem, u: Array, method: str | None = None) -> tuple[Run, Callable[[], Array]]:
    mechanism, drive = problem.mechanism(), problem.drive(u)
    sweep = partial(mechanism.sweep, drive, **({"method": method} if method else {}))
    return lambda: sweep().displacements, lambda: problem.unknowns(sweep(), u)


def closed(problem: Problem, u: Array) -> tuple[Run, None]:
    if (formula := problem.closed) is None:
        raise Missing("there is none")
    angles = jnp.asarray(u[:, 0])
    return lambda: formula(angles), None


def closed_numpy(problem: Problem, u: Array) -> tuple[Run, None]:
    if (formula := problem.closed_numpy) is None:
        raise Missing("there is none")
    return lambda: formula(u[:, 0]), None


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
    seconds = np.array([run() for _ in range(7)], float)
    return Timing(*np.quantile(seconds, [0.5, 0.25, 0.75]).tolist())


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
