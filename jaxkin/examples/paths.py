"""The five path problems that four-bar synthesis is compared on, each as arguments of `jk.optimize`.

Statements, bounds and the designs of the methods compared are those of S. Nguyen-Van, Q. X. Lieu, N. Xuan-Mung and
T. T. N. Nguyen, "A New Study on Optimization of Four-Bar Mechanisms Based on a Hybrid-Combined Differential Evolution
and Jaya Algorithm", Symmetry 14 (2022) 381, doi:10.3390/sym14020381, who collect Kunjur and Krishnamurty, Cabrera et
al., Acharyya and Mandal, and others. The error is the sum of squared distances.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np

from jaxkin import design
from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism

BARS = (("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D"))


@dataclass(frozen=True)
class PathProblem:
    """Points that a coupler point of a four-bar with a turning crank is to pass."""

    statement: str
    targets: tuple[tuple[float, float], ...]
    bars: tuple[float, float]
    """Bounds of all four bars."""
    reach: float
    """The coupler point, in the coupler's frame, and the fixed pivot are within plus and minus this."""
    timing: str
    """ "given": the crank angles from the ground link are; "start": their steps are; "free": only their order is."""
    angles: tuple[float, ...] = ()
    placed: bool = True
    """Whether position and angle of the ground link may be chosen; it lies at the origin along x otherwise."""
    published: float = np.inf
    """Lowest error among the published designs within these bounds, computed from the numbers as they are printed."""

    def arguments(self) -> dict[str, Any]:
        """Return the arguments of `jk.optimize`: `jk.optimize(**PATHS["b"].arguments(), starts=64)`."""
        count, scale = len(self.targets), self.bars[1] / 10
        mechanism = fourbar(*(scale * bar for bar in (3.0, 1.0, 2.8, 2.4)))
        corner, reach = np.array([scale, 0.0]), self.reach
        # the coupler lies askew in the assembled pose: the square of its frame becomes this circle's box
        extras = {"P": design.Free(corner + scale, corner - reach, corner + reach)}
        if self.placed:
            low, high = [-reach, -reach, 0.0], [reach, reach, 2 * np.pi]
            extras["place"] = design.Free([0.0, 0.0, 0.0], low, high)
        angles, drive = np.array(self.angles), {}
        constraints = [design.full_crank(*BARS)]
        if self.timing == "given":
            drive["A"] = angles
        else:
            extras["first"] = design.Free(1.0, 0.0, 2 * np.pi)
        if self.timing == "start":
            drive["A"] = lambda extras: extras["first"] + angles
        if self.timing == "free":
            extras["steps"] = design.Free(np.full(count - 1, 5.0 / (count - 1)), 1e-3, np.pi)
            drive["A"] = lambda extras: extras["first"] + jnp.cumsum(jnp.append(0.0, extras["steps"]))
            constraints.append(design.in_sequence("A"))
        return dict(
            loss=design.path("coupler", "P", self.targets, placement="place" if self.placed else None),
            mechanism=mechanism,
            drive=drive,
            lengths={bar: self.bars for bar in BARS},
            extras=extras,
            constraints=constraints,
        )


def fourbar(ground: float, crank: float, coupler: float, rocker: float) -> Mechanism:
    """Make a four-bar in the plane x y with crank and ground link along x in the assembled pose."""
    apart = ground - crank
    along = (coupler**2 - rocker**2 + apart**2) / (2 * apart)
    pin = (crank + along, np.sqrt(coupler**2 - along**2), 0.0)
    z = (0.0, 0.0, 1.0)
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "crank", point=(0.0, 0.0, 0.0), axis=z),
            revolute("B", "crank", "coupler", point=(crank, 0.0, 0.0), axis=z),
            revolute("C", "coupler", "rocker", point=pin, axis=z),
            revolute("D", "ground", "rocker", point=(ground, 0.0, 0.0), axis=z),
        ],
    )


PATHS = {
    "a": PathProblem(
        "six points on a vertical line, timing free",
        tuple((20.0, y) for y in (20.0, 25.0, 30.0, 35.0, 40.0, 45.0)),
        bars=(5.0, 60.0),
        reach=60.0,
        timing="free",
        published=1.31e-11,
    ),
    "b": PathProblem(
        "five points at crank angles of 30 to 90 degrees",
        ((3.0, 3.0), (2.759, 3.363), (2.372, 3.663), (1.890, 3.862), (1.355, 3.943)),
        bars=(0.05, 50.0),
        reach=50.0,
        timing="given",
        angles=tuple(np.pi / 12 * np.arange(2, 7)),
        placed=False,
        published=1.284e-6,
    ),
    "c": PathProblem(
        "eighteen points of a closed curve at crank steps of 20 degrees",
        (
            *((0.5, 1.1), (0.4, 1.1), (0.3, 1.1), (0.2, 1.0), (0.1, 0.9), (0.05, 0.75), (0.02, 0.6), (0.0, 0.5)),
            *((0.0, 0.4), (0.03, 0.3), (0.1, 0.25), (0.15, 0.2), (0.2, 0.3), (0.3, 0.4), (0.4, 0.5), (0.5, 0.7)),
            *((0.6, 0.9), (0.6, 1.0)),
        ),
        bars=(0.05, 50.0),
        reach=50.0,
        timing="start",
        angles=tuple(np.pi / 9 * np.arange(18)),
        published=0.016077,
    ),
    "d": PathProblem(
        "six points of a half arc at crank angles of 30 to 180 degrees",
        ((0.0, 0.0), (1.9098, 5.8779), (6.9098, 9.5106), (13.09, 9.5106), (18.09, 5.8779), (20.0, 0.0)),
        bars=(5.0, 50.0),
        reach=50.0,
        timing="given",
        angles=tuple(np.pi / 6 * np.arange(1, 7)),
        published=2.58036,
    ),
    "e": PathProblem(
        "ten points of an ellipse, the first one twice, timing free",
        (
            *((20.0, 10.0), (17.66, 15.142), (11.736, 17.878), (5.0, 16.928), (0.60307, 12.736), (0.60307, 7.2638)),
            *((5.0, 3.0718), (11.736, 2.1215), (17.66, 4.8577), (20.0, 10.0)),
        ),
        bars=(5.0, 80.0),
        reach=80.0,
        timing="free",
        published=4.0199e-4,
    ),
}
