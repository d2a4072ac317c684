"""Four mechanisms as a user would write them down for a general solver: equations by hand, and their closed forms."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from timing import closed_fourbar, hexapod_curve

import jaxkin as jk
from reference import catalogue, mechanisms, parallel, planar, spatial  # on the path by `timing`

Array = np.ndarray
TURN = 2 * np.pi


class Problem(NamedTuple):
    """Equations f(x, u) = 0 in unknowns x for inputs u, and the same mechanism here."""

    name: str
    residual: Callable[..., Any]
    """`(x, u, numpy or jax.numpy)`: over about the size of the mechanism."""
    square: bool
    """Whether there are as many equations as unknowns."""
    inputs: Callable[[int], Array]
    """(poses, inputs), in the order in which they are passed through."""
    truth: Callable[[Array], Array]
    """(poses, unknowns), continuous."""
    mechanism: Callable[[], jk.Mechanism]
    drive: Callable[[Array], Mapping[str, Array]]
    """The displacements from the assembled pose that are these inputs."""
    unknowns: Callable[[jk.Motion, Array], Array]
    """From our motion."""
    closed: Callable[..., Any] | None = None
    """By formula in JAX, of the first input."""
    closed_numpy: Callable[..., Any] | None = None
    from_hinges: Callable[[Array, Array], Array] | None = None
    """From the angles of the second, third and fourth hinge of a loop of four, and the inputs."""
    periodic: bool = True
    """Whether unknowns are angles."""

    def error(self, found: Array, truth: Array) -> Array:
        """(poses,): the largest of the unknowns, radians or over the size."""
        off = np.asarray(found) - truth
        return np.abs((off + np.pi) % TURN - np.pi if self.periodic else off).max(axis=1)


def _turn(start: float) -> Callable[[int], Array]:
    return lambda poses: np.linspace(start, start + TURN, poses, endpoint=False)[:, None]


def _hinges(motion: jk.Motion) -> Array:
    return np.concatenate([np.asarray(motion.coordinates[name]) for name in "BCD"], axis=1)


def fourbar() -> Problem:
    start = 1.0

    def residual(x, u, xp):
        coupler, rocker = x
        across = 40 * xp.cos(u[0]) + 120 * xp.cos(coupler) - 80 * xp.cos(rocker) - 100
        up = 40 * xp.sin(u[0]) + 120 * xp.sin(coupler) - 80 * xp.sin(rocker)
        return xp.stack([across, up]) / 100

    def truth(u: Array) -> Array:
        at = planar.fourbar(u[:, 0])
        return np.stack([at.coupler, at.rocker], axis=1)

    def from_hinges(angles: Array, u: Array) -> Array:
        coupler0, rocker0 = truth(np.array([[start]]))[0]
        coupler = angles[:, 0] + u[:, 0] - start + coupler0
        return np.stack([coupler, angles[:, 1] + coupler - coupler0 + rocker0], axis=1)

    return Problem(
        "four-bar",
        residual,
        True,
        _turn(start),
        truth,
        mechanisms.planar_fourbar,
        lambda u: {"A": u[:, 0] - start},
        lambda motion, u: from_hinges(_hinges(motion), u),
        closed_fourbar,
        planar.fourbar,
        from_hinges,
    )


def _meet(p, p_radius: float, q, q_radius: float, side: int):
    """Where circles meet, as in `reference.planar`."""
    x, y = q[0] - p[0], q[1] - p[1]
    square = x * x + y * y
    along = (p_radius**2 - q_radius**2 + square) / (2 * square)
    beside = side * jnp.sqrt(p_radius**2 / square - along * along)
    return p[0] + along * x - beside * y, p[1] + along * y + beside * x


@jax.jit
def closed_jansen(theta):
    """Knee, rear, lower and ankle of the leg: four pairs of circles, no angle."""
    n = planar.JANSEN
    crank, fixed = (n["m"] * jnp.cos(theta), n["m"] * jnp.sin(theta)), (-n["a"], -n["l"])
    knee = _meet(fixed, n["b"], crank, n["j"], 1)
    rear = _meet(fixed, n["d"], knee, n["e"], 1)
    lower = _meet(fixed, n["c"], crank, n["k"], -1)
    return knee, rear, lower, _meet(rear, n["f"], lower, n["g"], -1)


def jansen() -> Problem:
    start, n, size = 1.0, planar.JANSEN, 100.0
    rods = list("bjdeckfg")

    def residual(x, u, xp):
        knee, rear, lower, ankle = x.reshape(4, 2) * size
        crank = n["m"] * xp.stack([xp.cos(u[0]), xp.sin(u[0])])
        fixed = xp.asarray([-n["a"], -n["l"]])
        starts = xp.stack([knee, knee, rear, rear, lower, lower, ankle, ankle])
        ends = xp.stack([fixed, crank, fixed, knee, fixed, crank, rear, lower])
        return (xp.sum((starts - ends) ** 2, axis=1) - xp.asarray([n[rod] ** 2 for rod in rods])) / 1000

    def truth(u: Array) -> Array:
        at = planar.jansen(u[:, 0])
        return np.concatenate([at.knee, at.rear, at.lower, at.ankle], axis=1) / size

    def unknowns(motion: jk.Motion, u: Array) -> Array:
        home = truth(np.array([[start]]))[0].reshape(4, 2) * size
        parts = ("upper rod", "thigh", "lower rod", "link")
        points = [motion.points(part, (*place, 0.0))[:, :2] for part, place in zip(parts, home, strict=True)]
        return np.concatenate(points, axis=1) / size

    return Problem(
        "Jansen leg",
        residual,
        True,
        _turn(start),
        truth,
        catalogue.jansen,
        lambda u: {"O": u[:, 0] - start},
        unknowns,
        closed_jansen,
        planar.jansen,
        periodic=False,
    )


def bennett() -> Problem:
    start, twists = 0.9, (0.7, 1.2) * 2
    other = spatial.bennett_length()
    lengths = (60.0, other) * 2

    def residual(x, u, xp):
        angles, pose = [u[0], x[0], x[1], x[2]], xp.eye(4)
        for angle, length, twist in zip(angles, lengths, twists, strict=True):
            c, s, ct, st = xp.cos(angle), xp.sin(angle), np.cos(twist), np.sin(twist)
            none = xp.zeros_like(c)
            rows = [[c, -s * ct, s * st, length * c], [s, c * ct, -c * st, length * s]]
            rows += [[none, none + st, none + ct, none], [none, none, none, none + 1]]
            pose = pose @ xp.stack([xp.stack(row) for row in rows])
        r = pose[:3, :3]
        turned = 0.5 * xp.stack([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
        return xp.concatenate([turned, pose[:3, 3] / 60])

    def truth(u: Array) -> Array:
        return np.unwrap(spatial.bennett(u[:, 0])[:, 1:], axis=0)

    def from_hinges(angles: Array, u: Array) -> Array:
        return angles + truth(np.array([[start]]))[0]

    @jax.jit
    def closed(theta):
        ratio = np.sin(0.95) / np.sin(0.25)
        return 2 * jnp.arctan2(ratio * jnp.cos(theta / 2), jnp.sin(theta / 2))

    return Problem(
        "Bennett",
        residual,
        False,
        _turn(start),
        truth,
        mechanisms.bennett_linkage,
        lambda u: {"A": u[:, 0] - start},
        lambda motion, u: from_hinges(_hinges(motion), u),
        closed,
        spatial.bennett,
        from_hinges,
    )


def stewart() -> Problem:
    mechanism = catalogue.hexapod()
    home = np.array([mechanism.joints[f"top {i}"].frames_1[0][:3, 3] for i in range(6)])
    base, size = parallel.hexapod().base, 100.0
    rest = np.linalg.norm(home - base, axis=1)
    middle = home.mean(axis=0)

    def turned(w, xp):
        """Cayley's rotation matrix."""
        x, y, z = w
        none = xp.zeros_like(x)
        skew = xp.stack([xp.stack([none, -z, y]), xp.stack([z, none, -x]), xp.stack([-y, x, none])])
        square = xp.sum(w * w)
        return xp.eye(3) + 2 / (1 + square) * (skew + skew @ skew)

    def residual(x, u, xp):
        tops = (home - middle) @ turned(x[3:], xp).T + middle + size * x[:3]
        return (xp.sqrt(xp.sum((tops - base) ** 2, axis=1)) - rest - u) / size

    def truth_of(poses: int) -> Array:
        moved = hexapod_curve(poses).moved
        shift = moved[:, :3, :3] @ middle + moved[:, :3, 3] - middle
        skew = np.linalg.solve(moved[:, :3, :3] + np.eye(3), moved[:, :3, :3] - np.eye(3))
        return np.concatenate([shift / size, skew[:, [2, 0, 1], [1, 2, 0]]], axis=1)

    def unknowns(motion: jk.Motion, u: Array) -> Array:
        moved = np.asarray(motion.transforms["platform"])
        shift = moved[:, :3, :3] @ middle + moved[:, :3, 3] - middle
        skew = np.linalg.solve(moved[:, :3, :3] + np.eye(3), moved[:, :3, :3] - np.eye(3))
        return np.concatenate([shift / size, skew[:, [2, 0, 1], [1, 2, 0]]], axis=1)

    return Problem(
        "Stewart-Gough",
        residual,
        True,
        lambda poses: hexapod_curve(poses).legs,
        lambda u: truth_of(len(u)),
        catalogue.hexapod,
        lambda u: {f"leg {i}": leg for i, leg in enumerate(u.T)},
        unknowns,
        periodic=False,
    )


PROBLEMS = {"four-bar": fourbar, "Jansen leg": jansen, "Bennett": bennett, "Stewart-Gough": stewart}
