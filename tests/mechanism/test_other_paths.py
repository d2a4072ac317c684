"""Several inputs that leave the reach of a five-bar and come back: other paths lead to what the curve does not."""

import numpy as np
import pytest

from jaxkin.mechanism.targets import point
from jaxkin.solve.status import Status
from reference.mechanisms import flat
from reference.planar_robots import five_bar, tip

ROD = 72.0
"""Length of both rods: the elbows can be too far apart for them."""
STEPS = 2000
"""Points of a way at which the closed form is asked whether the rods meet."""


def reached(left, right, ahead=(0.5, 0.5)) -> np.ndarray:
    """Whether the rods meet all the way from the assembled pose, by the closed form.

    The way is a parabola whose control point is `ahead` times its end, by default a straight line.
    """
    way = np.linspace(0.0, 1.0, STEPS)[:, None]
    one, other = (2 * way * (1 - way) * share + way**2 for share in ahead)
    places = tip((one * left).ravel(), (other * right).ravel(), ROD)
    return np.isfinite(places[:, 0]).reshape(STEPS, -1).all(axis=0)


@pytest.mark.long
@pytest.mark.parametrize("order", ["spiral", "shuffled", "there and back"])
def test_poses_are_told_by_the_closed_form(order):
    """A pose is unreachable where the rods do not meet, and closed wherever a line or a parabola leads to it."""
    way = np.linspace(0.0, 1.0, 240)
    left, right = 2.2 * way * np.cos(4 * np.pi * way), 2.2 * way * np.sin(4 * np.pi * way)
    which = np.random.default_rng(2).permutation(len(way)) if order == "shuffled" else np.arange(len(way))
    if order == "there and back":
        which = np.concatenate([which[::2], which[::-2]])
    left, right = left[which], right[which]
    motion = five_bar(ROD).sweep({"A": left, "E": right})
    status, wanted = np.asarray(motion.status), tip(left, right, ROD)
    meets, straight = np.isfinite(wanted[:, 0]), reached(left, right)
    assert 40 < straight.sum() < meets.sum() < len(way) - 40  # some of each, and some behind a gap
    led = straight | reached(left, right, (1, 0)) | reached(left, right, (0, 1))
    assert (led & ~straight).any()
    assert np.array_equal(status == Status.UNREACHABLE, ~meets)
    assert np.all(status[led] == Status.CLOSED)
    assert set(status[meets & ~led].tolist()) <= {Status.CLOSED, Status.JUMPED}
    # on the branch of the assembled pose, above the line of the elbows; mm, rounding of lengths of 100
    closed = status == Status.CLOSED
    found = motion.points("left rod", flat(tip([0.0], [0.0], ROD)))
    np.testing.assert_allclose(np.asarray(found)[closed, :2], wanted[closed], atol=1e-9)


@pytest.mark.long
def test_inputs_however_far_away_are_unreachable_in_a_few_steps():
    """As targets in millimetres of a mechanism in metres: a path to them was followed in steps of 0.15 of the size."""
    mechanism = five_bar(ROD)
    home = np.array(mechanism.joints["C"].frames_1[0][:3, 3])
    part = mechanism.joints["C"].parts[0]
    there = home + np.array([[2.0, 1.0, 0.0], [1e5, 1.0, 0.0], [1e11, 1.0, 0.0], [-1.0, 2.0, 0.0]])
    motion = mechanism.sweep({point(part, tuple(home)): there})
    closed, unreachable = Status.CLOSED.value, Status.UNREACHABLE.value
    np.testing.assert_array_equal(motion.status, [closed, unreachable, unreachable, closed])
    np.testing.assert_allclose(np.asarray(motion.points(part, home))[[0, 3]], there[[0, 3]], atol=1e-9)
