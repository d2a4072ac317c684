"""Hollow pins.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def fork_and_eye(in_fork, in_eye, *others):
    """A fork with an eye between its plates, round a tube of radius 10 with a bore of 6."""
    lugs = [ring(10.0 + in_fork, 22.0, low, low + 12.0) for low in (-32.0, 20.0)]
    fork = part("fork", *lugs, block((-60, -20, -32), (-23, 20, 32)))
    eye = part("eye", ring(10.0 + in_eye, 19.0, -18.0, 18.0), block((20, -10, -15), (150, 10, 15)))
    return assembly(fork, eye, part("tube", ring(6.0, 10.0, -32.0, 32.0)), *others)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("in_fork", "in_eye", "holder"), [(0, 0, "fork"), (0, 0.06, "fork"), (0.06, 0, "eye")])
def test_a_tube_with_nothing_in_its_bore_is_a_pin(in_fork, in_eye, holder, seed):
    """As the gudgeon pin of a piston, which is hollow to be light: it is held as a solid pin is."""
    mechanism = anywhere(fork_and_eye(in_fork, in_eye), seed).mechanism(fixed=["fork"])
    body = owners(mechanism)
    assert body["tube"] == body[holder] and body["fork"] != body["eye"]
    assert kind_of(mechanism, "fork", "eye") == "revolute"


def rod(radius, length):
    return part("rod", pin(radius, -length, length), block((-20, -3, -length - 20), (20, 3, -length)))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "other",
    [
        rod(5.8, 60.0),
        rod(2.0, 60.0),
        part("sheet", ring(6.0, 30.0, 32.0, 40.0), block((-60, 23, 32), (-23, 40, 40))),
    ],
)
def test_a_tube_with_something_in_its_bore_is_an_axle(other, seed):
    """A rod through it, also a thin one, or a hole in line with its bore, for a bolt that is not drawn: the bore is
    there for these, and neither fork nor eye holds the tube for being farthest out."""
    mechanism = anywhere(fork_and_eye(0.0, 0.0, other), seed).mechanism(fixed=["fork"], rigid=[["fork", other.name]])
    assert not any("'tube' held by" in note for note in mechanism.notes)
