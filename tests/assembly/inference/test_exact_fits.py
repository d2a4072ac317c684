"""What fits exactly and is needed by no loop is in doubt where others have play."""

import pytest

from jaxkin.joints.kinds import JointKind
from reference.round_parts import SEEDS, anywhere, assembly, block, moving, part, pin, ring

BASE = part("base", block((-60, -60, -30), (60, 60, -20)), pin(4.8, -20, 20), pin(9.0, -20, -5), pin(9.0, 5, 20))


def lever(*more):
    """A lever with play on a pin of the base, between its two collars, with a peg along its far end."""
    return part("lever", ring(5.0, 12.0, -4, 4), block((11, -3, -4), (90, 3, 4)), pin(3.0, 4, 30, at=(80, 0)), *more)


def grip(inner: float = 3.0, width: float = 6.0, length: float = 10.0):
    """A crank on the peg, down on the lever; not round, so that it does not only spin."""
    arm = block((84, -width / 2, 10), (84 + length, width / 2, 20))
    return part("grip", ring(inner, 5.0, 4, 30, at=(80, 0)), arm)


LARGE = {"width": 40.0, "length": 60.0}


@pytest.mark.parametrize("seed", SEEDS)
def test_a_large_part_that_fits_exactly_may_be_one_body_where_others_have_play(seed):
    drawn = anywhere(assembly(BASE, lever(), grip(**LARGE)), seed)
    mechanism = drawn.mechanism(fixed=["base"])
    (doubtful,) = [joint for joint in moving(mechanism) if "grip" in joint.parts]
    doubt = doubtful.evidence and doubtful.evidence.doubt
    assert doubt is not None and doubt.kind is JointKind.FIXED
    rigid = [list(doubtful.parts)]
    assert "and may be one body: it fits exactly" in str(mechanism) and f"rigid={rigid}" in str(mechanism)
    assert len(moving(drawn.mechanism(fixed=["base"], rigid=rigid))) == 1


def test_where_nothing_has_play_an_exact_fit_is_in_no_doubt():
    base = part("base", block((-60, -60, -30), (60, 60, -20)), pin(5.0, -20, 20), pin(9.0, -20, -4))
    mechanism = assembly(base, lever(), grip(**LARGE)).mechanism(fixed=["base"])
    assert len(moving(mechanism)) == 2 and "Doubtful" not in str(mechanism)
