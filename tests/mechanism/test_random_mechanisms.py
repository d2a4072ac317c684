"""Random linkages against closed forms, and those among them that were once followed wrongly."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.options import SolverOptions
from reference.hard_case import off_turns
from reference.random_linkages import LINKAGES
from reference.random_sweeps import checked, limits, sweeps

GENERAL = SolverOptions(formulas=False)
FOURBAR, WATT, STEPHENSON = LINKAGES[:3]


def planar(linkage, *points):
    """Points of A, P0, C0, Q0 and so on as one design, and its mechanism."""
    place = np.array([[(x, y, 0.0) for x, y in points]])
    axes = np.broadcast_to([0.0, 0.0, 1.0], place.shape)
    return place, axes, linkage.build(place[0], axes[0])


@pytest.mark.long
@pytest.mark.parametrize(
    "points",
    [
        ((0.461574, -0.159969), (0.450344, -0.332038), (-0.723593, 0.325277), (0.851904, -0.848022)),
        ((-0.554331, 0.390942), (-0.113259, 0.405396), (-0.370569, -0.687368), (-0.925114, -0.513042)),
        ((-0.241635, 0.974066), (-0.311935, 0.666179), (-0.503624, -0.409533), (-0.274264, 0.878949)),
    ],
    ids=["a gap shorter than a step", "a long step before a limit", "assembled beside a limit"],
)
def test_limits_are_found_however_the_steps_fall(points):
    place, axes, mechanism = planar(FOURBAR, *points)
    low, high = (float(limit[0, 0]) for limit in limits(FOURBAR, place, axes))
    inputs = np.concatenate([np.linspace(low, high, 20)[1:-1], [low - 0.02, high + 0.02]])
    motion = mechanism.sweep({"A": inputs})
    np.testing.assert_array_equal(motion.closed, [True] * 18 + [False] * 2)
    solved = FOURBAR.solve(FOURBAR.stages, place, axes, inputs[None])
    off = off_turns(np.asarray(motion.coordinates["Q0"][:, 0]) - solved.angles["Q0"][0])
    # rounding grows as the inverse root of the margin, which is that of the branches' distance
    assert np.all((off * np.sqrt(np.maximum(solved.margin[0], 0.0)))[:18] < 1e-12)


@pytest.mark.long
@pytest.mark.parametrize(
    "linkage, points",
    [
        (
            STEPHENSON,
            [
                *((-0.691735154, 0.558422598), (-0.176042331, 0.685412573), (-0.919994952, 0.266279238)),
                *((-0.158554891, 0.236437107), (-0.392809906, 0.826264212), (0.093289384, 0.537730566)),
                (-0.570305848, 0.837360138),
            ],
        ),
        (
            WATT,
            [
                *((0.226934309, -0.516411095), (-0.056732842, -0.638430013), (-0.053698326, 0.193528738)),
                *((-0.025561261, -0.498395206), (-0.141943776, 0.958277984), (0.70312855, 0.563701969)),
                (0.081622294, 0.852923135),
            ],
        ),
    ],
    ids=["a gap so shallow that a step passes over it", "a tangent so steep that it leads to another circuit"],
)
def test_nothing_behind_a_limit_is_closed(linkage, points):
    """Two of the 100,000 of `benchmarks/random_mechanisms.py`: each had poses CLOSED that nothing leads to."""
    place, axes, mechanism = planar(linkage, *points)
    low, high = (float(limit[0, 0]) for limit in limits(linkage, place, axes))
    inputs = np.concatenate([np.linspace(low, high, 20)[1:-1], low - np.geomspace(1e-2, 0.6, 12)])
    motion = mechanism.sweep({"A": inputs})
    np.testing.assert_array_equal(motion.closed, inputs > low)


@pytest.mark.long
@pytest.mark.parametrize(
    "linkage, drive, span, points",
    [
        (
            WATT,
            "Q1",
            0.44905269,
            [
                *((0.869327, 0.766479), (0.561406, 0.680559), (0.25179, -0.154331), (-0.721252, -0.740867)),
                *((-0.601941, -0.997271), (0.304403, 0.585855), (0.712071, 0.979743)),
            ],
        ),
        (
            STEPHENSON,
            "Q1",
            0.67325351,
            [
                *((0.696497, 0.588368), (0.611632, 0.109961), (0.148321, -0.099885), (-0.229846, -0.288318)),
                *((-0.185872, -0.109428), (0.855584, -0.818453), (-0.114728, -0.994226)),
            ],
        ),
        (
            STEPHENSON,
            "A",
            1.57915716,
            [
                *((0.242389, 0.455901), (-0.0574, -0.049879), (-0.577602, -0.328329), (-0.090961, 0.855055)),
                *((0.514425, -0.587096), (0.746399, -0.900184), (0.013089, -0.80179)),
            ],
        ),
    ],
    ids=["a curve that turns back", "a curve between two slopes", "a curve that ends at a limit"],
)
def test_no_pose_within_the_limits_is_taken_for_another_branch(linkage, drive, span, points):
    """What one input reaches from the assembled pose lies between two limits, and only behind these a pose can be on
    another branch: each of these had poses JUMPED in the middle, between samples of the branch far apart."""
    _, _, mechanism = planar(linkage, *points)
    inputs = span * np.linspace(-1.0, 1.0, 161)
    status = np.asarray(mechanism.sweep({drive: inputs}, options=GENERAL).status)
    assert status[80] == jk.Status.CLOSED
    reached = np.flatnonzero(status == jk.Status.CLOSED)
    np.testing.assert_array_equal(reached, np.arange(reached[0], reached[-1] + 1))


@pytest.mark.long
@pytest.mark.study
@pytest.mark.parametrize("name", ["four-bar", "Watt six-bar", "RSSR", "spherical four-bar"])
def test_every_pose_is_closed_on_its_branch_or_says_why_not(name):
    """The committed figures of 100 times as many are in `benchmarks/README.md`."""
    linkage = next(one for one in LINKAGES if one.name == name)
    count = checked(linkage, sweeps(linkage, GENERAL), np.random.default_rng(7), 500)
    assert count.residual == count.branch == count.behind == 0
    assert count.closed >= 0.999 * count.reachable and count.reachable > 0.4 * count.poses


@pytest.mark.long
@pytest.mark.parametrize("linkage", LINKAGES, ids=lambda one: one.name)
def test_formulas_alone_close_what_can_be_reached_or_say_why_not(linkage):
    """As inside of `vmap` over designs, where no other solver is at hand: a few poses near limits are in doubt."""
    count = checked(linkage, sweeps(linkage), np.random.default_rng(7), 60)
    assert count.residual == count.branch == count.behind == 0
    assert count.closed + count.stalled >= count.reachable > 0.2 * count.poses
    assert count.closed >= 0.95 * count.reachable
    assert count.error < 1e-12
    assert count.error < 1e-11  # times the margin
