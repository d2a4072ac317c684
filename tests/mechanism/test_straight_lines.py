"""Several inputs that leave the reach of a five-bar and come back: straight lines lead to what the curve does not."""

import numpy as np
import pytest

from jaxkin.solve.status import Status
from reference.mechanisms import flat
from reference.planar_robots import five_bar, tip

ROD = 72.0
"""Length of both rods: the elbows can be too far apart for them."""
STEPS = 2000
"""Points of a straight line of inputs at which the closed form is asked whether the rods meet."""


def reached_in_a_straight_line(left, right) -> np.ndarray:
    """Whether the rods meet all the way from the assembled pose, by the closed form."""
    way = np.linspace(0.0, 1.0, STEPS)[:, None]
    places = tip((way * left).ravel(), (way * right).ravel(), ROD)
    return np.isfinite(places[:, 0]).reshape(STEPS, -1).all(axis=0)


@pytest.mark.long
@pytest.mark.parametrize("order", ["spiral", "shuffled", "there and back"])
def test_poses_are_told_by_the_closed_form(order):
    """A pose is unreachable where the rods do not meet, and closed wherever a straight line leads to it."""
    way = np.linspace(0.0, 1.0, 240)
    left, right = 2.2 * way * np.cos(4 * np.pi * way), 2.2 * way * np.sin(4 * np.pi * way)
    which = np.random.default_rng(2).permutation(len(way)) if order == "shuffled" else np.arange(len(way))
    if order == "there and back":
        which = np.concatenate([which[::2], which[::-2]])
    left, right = left[which], right[which]
    motion = five_bar(ROD).sweep({"A": left, "E": right})
    status, wanted = np.asarray(motion.status), tip(left, right, ROD)
    meets, straight = np.isfinite(wanted[:, 0]), reached_in_a_straight_line(left, right)
    assert 40 < straight.sum() < meets.sum() < len(way) - 40  # some of each, and some behind a gap
    assert np.array_equal(np.isin(status, (Status.UNREACHABLE, Status.STALLED)), ~meets)
    assert order == "shuffled" or Status.STALLED not in status
    assert np.all(status[straight] == Status.CLOSED)
    assert set(status[meets & ~straight].tolist()) <= {Status.CLOSED, Status.JUMPED}
    # on the branch of the assembled pose, above the line of the elbows; mm, rounding of lengths of 100
    closed = status == Status.CLOSED
    found = motion.points("left rod", flat(tip([0.0], [0.0], ROD)))
    np.testing.assert_allclose(np.asarray(found)[closed, :2], wanted[closed], atol=1e-9)
