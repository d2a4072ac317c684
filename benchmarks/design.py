"""Many designs at once, what derivatives cost, and time to a given loss, beside what else there is, in one process.

    python benchmarks/design.py [gradient] [ratios] [batch] [race]
    python benchmarks/design.py paths [a b c d e]

Beside formulas written by hand in JAX; pylinkage's `Ensemble` where it is installed (`uv run --group peers`); SciPy's
least squares with finite differences.

`paths` searches for a path problem from 64 starts, and again, each in a process of its own. Of all else, the shortest
of repeated runs, results awaited, since other work on the machine only lengthens them. Machines differ:
compare the figures of one run.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from peer_engines import Missing, pylinkage_linkage

from jaxkin._progress import ProgressBar
from jaxkin.design.augmented_lagrangian import MET, Penalty
from jaxkin.design.least_squares import least_squares
from jaxkin.design.optimisers import LevenbergMarquardt
from jaxkin.design.optimize import POOL, _best_of
from jaxkin.design.problem import design_problem
from jaxkin.design.search import search
from jaxkin.design.variables import spread, variables
from jaxkin.examples.paths import PATHS
from jaxkin.solve.options import SolverOptions
from reference import catalogue, mechanisms

SECONDS, RUNS = 2.0, 15
"""Each figure is the shortest of so many runs, or of those that fit into this time."""
BARS = [("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")]
NOW = [100.0, 40.0, 120.0, 80.0]
POINT = (30.0, 60.0, 0.0)
FOURBARS, LEGS = 10_000, 1_000
RACE = 16


def least_time(function, *args) -> tuple[float, float]:
    """Seconds of a call, and of its first run."""
    begin = time.perf_counter()
    jax.block_until_ready(function(*args))
    first = time.perf_counter() - begin
    times: list[float] = []
    while not times or (len(times) < RUNS and sum(times) < SECONDS):
        begin = time.perf_counter()
        jax.block_until_ready(function(*args))
        times.append(time.perf_counter() - begin)
    return min(times), first


def dyad(bars, theta):
    """Crank pin and rocker pin of a four-bar by two circles; poses, and designs, in the last axes."""
    ground, crank, coupler, rocker = bars
    x, y = crank * jnp.cos(theta), crank * jnp.sin(theta)
    across, up = ground - x, -y
    square = across * across + up * up
    along = (coupler**2 - rocker**2 + square) / (2.0 * square)
    beside = jnp.sqrt(coupler**2 / square - along * along)
    return x, y, x + along * across - beside * up, y + along * up + beside * across


def by_hand(bars, theta, point):
    """Path of a coupler point, given along and across the coupler."""
    x, y, rocker_x, rocker_y = dyad(bars, theta)
    along, up = (rocker_x - x) / bars[2], (rocker_y - y) / bars[2]
    return jnp.stack([x + point[0] * along - point[1] * up, y + point[0] * up + point[1] * along], axis=-1)


def gradient() -> None:
    """Gradient of a path error with respect to all four bars, over 360, 10,000 and 100,000 poses."""
    for poses in (360, 10_000, 100_000):
        gradient_over(poses)


def gradient_over(poses: int) -> None:
    mechanism, start = mechanisms.planar_fourbar(1.0), 1.0
    inputs = jnp.linspace(0.0, 2 * jnp.pi, poses)
    pins = [mechanism.joints[name].frames_1[0][:2, 3] for name in "BC"]
    unit = (pins[1] - pins[0]) / 120.0
    local = jnp.array(
        [
            unit @ (jnp.asarray(POINT[:2]) - pins[0]),
            unit[0] * (POINT[1] - pins[0][1]) - unit[1] * (POINT[0] - pins[0][0]),
        ]
    )
    wanted = by_hand(jnp.array(NOW), start + inputs, local) + jnp.array([1.0, 2.0])

    def swept(bars):
        return mechanism.with_lengths(dict(zip(BARS, bars, strict=True))).sweep({"A": inputs})

    def ours(bars):
        return jnp.sum((swept(bars).points("coupler", POINT)[:, :2] - wanted) ** 2)

    def hand(bars):
        return jnp.sum((by_hand(bars, start + inputs, local) - wanted) ** 2)

    bars = jnp.array([101.0, 39.0, 122.0, 79.0])
    one, other = jax.jit(jax.grad(ours)), jax.jit(jax.grad(hand))
    far = float(jnp.max(jnp.abs(one(bars) / other(bars) - 1)))
    print(f"gradient of a path error, {poses:>6} poses, four bars    ms   first [s]")
    for name, function in {
        "sweep": jax.jit(lambda bars: swept(bars).displacements),
        "loss": jax.jit(ours),
        "gradient": one,
        "gradient of the formula by hand": other,
    }.items():
        seconds, first = least_time(function, bars)
        print(f"  {name:45}{seconds * 1e3:>8.2f}{first:>10.1f}", flush=True)
    print(f"  largest relative difference of the two gradients {far:.1e}\n")


def ratios() -> None:
    """Derivatives over the forward sweep: reverse for all frames at once, velocity and acceleration nested."""
    inputs = jnp.linspace(0.0, 2 * jnp.pi, 360)
    print("over the forward sweep, 360 poses    forward [ms]   reverse  velocity  acceleration")
    cases = {
        "four-bar": (mechanisms.planar_fourbar(1.0), "A"),
        "Jansen leg": (catalogue.jansen(), "O"),
        "spherical four-bar": (mechanisms.spherical_linkage(1.0), "A"),
    }
    for name, (mechanism, joint) in cases.items():

        def place(mechanism, inputs, joint=joint):
            return jnp.concatenate(mechanism.sweep({joint: inputs}).displacements, axis=1)

        def loss(mechanism, inputs, place=place):
            return jnp.sum(place(mechanism, inputs) ** 2)

        def velocity(mechanism, inputs, place=place):
            return jax.jvp(lambda u: place(mechanism, u), (inputs,), (jnp.ones_like(inputs),))

        def acceleration(mechanism, inputs, velocity=velocity):
            return jax.jvp(lambda u: velocity(mechanism, u), (inputs,), (jnp.ones_like(inputs),))

        forward, *rest = (
            least_time(jax.jit(function), mechanism, inputs)[0]
            for function in (loss, jax.value_and_grad(loss), velocity, acceleration)
        )
        print(f"  {name:35}{forward * 1e3:>12.2f}" + "".join(f"{each / forward:>10.2f}" for each in rest), flush=True)
    print()


def batch() -> None:
    """10,000 four-bars and 1,000 Jansen legs, 200 poses each, in one compiled call."""
    inputs = jnp.linspace(0.0, 2 * jnp.pi, 200)
    random = np.random.default_rng(0)
    print("designs of 200 poses in one call      designs   ms a call   ns a pose   closed   first [s]")

    def line(name, count, seconds, first, closed):
        nanoseconds = seconds / count / 200 * 1e9
        print(
            f"  {name:35}{count:>8}{seconds * 1e3:>12.1f}{nanoseconds:>12.0f}{closed:>9.1%}{first:>12.1f}", flush=True
        )

    def many(mechanism, keys, joint):
        def one(lengths):
            motion = mechanism.with_lengths(dict(zip(keys, lengths, strict=True))).sweep({joint: inputs})
            return motion.displacements, motion.closed

        return jax.jit(jax.vmap(one))

    bars = jnp.asarray(np.array(NOW) * random.uniform(0.97, 1.03, (FOURBARS, 4)))
    hand = jax.jit(lambda bars, theta: dyad(bars[..., None].swapaxes(0, 1), theta))
    seconds, first = least_time(hand, bars, 1.0 + inputs)
    line("four-bars by hand", len(bars), seconds, first, 1.0)
    ours = many(mechanisms.planar_fourbar(1.0), BARS, "A")
    seconds, first = least_time(ours, bars)
    line("four-bars", len(bars), seconds, first, float(jnp.mean(ours(bars)[1])))

    leg = catalogue.jansen()
    keys = [key for key in leg.lengths if len(key) == 3 and float(leg.lengths[key]) > 0]
    # two pins in one place belong to one hinge of three links: their distances to a third pin stay equal
    hinges = [(key[0], round(float(leg.lengths[key]), 6)) for key in keys]
    which = np.array([sorted(set(hinges)).index(hinge) for hinge in hinges])
    now = np.array([length for _, length in sorted(set(hinges))])
    legs = jnp.asarray((now * random.uniform(0.99, 1.01, (LEGS, len(now))))[:, which])
    ours = many(leg, keys, "O")
    seconds, first = least_time(ours, legs)
    line(f"Jansen legs, {len(now)} lengths", len(legs), seconds, first, float(jnp.mean(ours(legs)[1])))
    for name, template, count, share in (
        ("four-bars", "four-bar", FOURBARS, 0.03),
        ("Jansen legs", "Jansen leg", LEGS, 0.01),
    ):
        try:
            linkage = pylinkage_linkage(template, 1.0, float(inputs[1]))
        except Missing as missing:
            print(f"  {name} by pylinkage: {missing}")
            continue
        from pylinkage.population import Ensemble

        bars = np.array(linkage.get_constraints())
        members = bars * random.uniform(1 - share, 1 + share, (count, len(bars)))
        home = np.array([(each.x, each.y) for each in linkage.components])
        ensemble = Ensemble(linkage, members, np.broadcast_to(home, (count, *home.shape)))
        seconds, first = least_time(lambda ensemble=ensemble: ensemble.simulate(iterations=len(inputs), store=False))
        paths = ensemble.simulate(iterations=len(inputs), store=False)
        line(f"{name} by pylinkage", count, seconds, first, float(np.mean(np.isfinite(paths).all(axis=(2, 3)))))


def race() -> None:
    """Processor seconds from the same starts to the lowest error published for a path problem; nothing is compiled in
    them. All ask the same compiled program, so that only the ways downhill differ."""
    print(f"to the published error, {RACE} starts    processor s   starts taken  designs judged")
    for name in "bcd":
        given = PATHS[name].arguments()
        chosen = variables(given["mechanism"], given["drive"], given["lengths"], {}, given["extras"], {})
        options = SolverOptions()
        problem = design_problem(given["loss"], True, given["mechanism"], chosen, given["constraints"], options)
        together, alone = least_squares(problem), least_squares(problem, 1)
        target = PATHS[name].published * (1 + 1e-5)
        pool = spread(chosen, RACE * POOL, 0)
        constraints = problem.constraint_count(*problem.motion(chosen.start)[:2])
        vectors, weight = _best_of(pool, together.judge(pool, np.zeros((len(pool), constraints))), RACE)
        alone.begin(vectors[:1], Penalty.plain(weight, 1, constraints))  # compiled
        stop = LevenbergMarquardt(target=target)

        def downhill(vectors, solver, weight=weight, stop=stop, constraints=constraints):
            penalty = Penalty.plain(weight, len(vectors), constraints)
            active = np.ones(len(vectors), bool)
            found, _, history = search(solver, vectors, penalty, active, stop, ProgressBar(stop.iterations, False, ""))
            verdict = solver.judge(found, penalty.shifts)
            judged = int(np.isfinite(np.concatenate(history)).sum()) + len(vectors)
            return bool(np.any((verdict.losses <= stop.target) & (verdict.violations <= MET))), judged

        def one_by_one(way, vectors=vectors):
            judged = 0
            for taken, vector in enumerate(vectors, 1):
                reached, more = way(vector)
                judged += more
                if reached:
                    return taken, judged
            return None, judged

        def scipy_from(vector, problem=problem, chosen=chosen, weight=weight, target=target):
            return _scipy(problem, chosen, weight, target, vector)

        scipy_from(vectors[0], target=np.inf)  # compiled

        def side_by_side(vectors=vectors, together=together, downhill=downhill):
            reached, judged = downhill(vectors, together)
            return len(vectors) if reached else None, judged

        def in_turn(alone=alone, downhill=downhill, one_by_one=one_by_one):
            return one_by_one(lambda vector: downhill(vector[None], alone))

        for label, run in {
            "all starts together": side_by_side,
            "one start at a time": in_turn,
            "SciPy, finite differences": lambda one_by_one=one_by_one, way=scipy_from: one_by_one(way),
        }.items():
            began = time.process_time()
            taken, judged = run()
            seconds = time.process_time() - began
            print(f"  ({name}) {label:34}{seconds:>11.2f}{taken or 'not reached':>15}{judged:>16}", flush=True)


def _scipy(problem, chosen, weight, target, vector) -> tuple[bool, int]:
    """Whether SciPy's bounded least squares reaches the target from a vector, and the designs that it asked for."""
    width = chosen.upper - chosen.lower
    if id(problem) not in _compiled:
        penalty = Penalty(weight, np.zeros(jax.eval_shape(problem.judge, chosen.start).margins.size))
        _compiled[id(problem)] = (
            jax.jit(lambda vector: jnp.concatenate(problem.judge(vector).weighted(penalty))),
            jax.jit(problem.judge),
        )
    residuals, judge = _compiled[id(problem)]
    asked = 0

    class Reached(Exception):
        pass

    def function(unit):
        nonlocal asked
        asked += 1
        design = chosen.lower + width * unit
        found = np.asarray(residuals(design))
        if np.sum(found**2) <= target * (1 + 1e-9):
            judged = judge(design)
            violations = np.concatenate([judged.gaps, np.minimum(judged.margins, 0.0)])
            if np.sum(judged.rows**2) <= target and np.linalg.norm(violations) <= MET:
                raise Reached
        return np.clip(np.nan_to_num(found, nan=1e6), -1e6, 1e6)

    begin = np.clip((vector - chosen.lower) / width, 1e-6, 1 - 1e-6)
    try:
        scipy.optimize.least_squares(
            function, begin, bounds=(0.0, 1.0), xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=300
        )
    except Reached:
        return True, asked
    return False, asked


_compiled: dict[int, tuple] = {}


def paths(names: list[str]) -> None:
    """Print the time of a first search for each path problem, of the process up to its end, and of the same again, and
    what they find."""
    heads = zip(
        ("first: cpu", "wall", "process: cpu", "wall", "again: cpu", "wall"), (12, 8, 15, 8, 14, 8), strict=True
    )
    print(
        f"{'':4}{''.join(f'{head:>{width}}' for head, width in heads)}  [s]{'published':>13}{'found':>13}", flush=True
    )
    for name in names or PATHS:
        subprocess.run([sys.executable, str(Path(__file__).with_name("path_problem.py")), name], check=True)


if __name__ == "__main__":
    jax.config.update("jax_enable_x64", True)
    print(f"jax {jax.__version__}, {jax.devices()[0].device_kind}, float64\n")
    if sys.argv[1:2] == ["paths"]:
        paths(sys.argv[2:])
        sys.exit()
    for name in sys.argv[1:] or ("gradient", "ratios", "batch", "race"):
        {"gradient": gradient, "ratios": ratios, "batch": batch, "race": race}[name]()
