"""Hollow pins, screws in annular grooves, and dowels that lie half in each of two parts.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring


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


def screw_in_hub(*shaft, end=6.0):
    """A round hub with a radial hole, the screw in that, which ends at some distance from the axis, some shaft, and a
    lever on a pin of the hub."""
    hole = across(ring(3.0, 6.0, 9.0, 20.0)[2:3])
    hub = part("hub", ring(9.0, 20.0, -30.0, 30.0), hole, pin(5.0, -30.0, 30.0, (-60.0, 0.0)))
    lever = part("lever", ring(5.1, 9.0, -28.0, 28.0, (-60.0, 0.0)), block((-64, 10, -5), (-56, 60, 5)))
    return assembly(hub, lever, part("shaft", *shaft), part("screw", across(pin(3.0, end, 20.0))))


def grooved(width):
    """A shaft with a groove all round it."""
    return pin(9.0, -40.0, -width / 2), pin(6.0, -width / 2, width / 2), pin(9.0, width / 2, 48.0)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("width", [6.0, 7.0])
@pytest.mark.parametrize("end", [6.0, 6.2])
def test_a_screw_in_a_groove_round_a_shaft_takes_its_slide_and_leaves_its_turn(width, end, seed):
    """Whether the tip fits the groove or has play in it, and whether it stands on the root or above it."""
    mechanism = anywhere(screw_in_hub(*grooved(width), end=end), seed).mechanism(fixed=["hub"])
    body = owners(mechanism)
    assert body["screw"] == body["hub"]
    assert kind_of(mechanism, "hub", "shaft") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "shaft",
    [
        (pin(9.0, -40.0, 48.0), across(ring(3.0, 6.0, 6.0, 9.0)[2:3])),
        (pin(9.0, -40.0, -3.0), block((-6, -6, -3), (6, 6, 3)), pin(9.0, 3.0, 48.0)),
        grooved(14.0),
    ],
    ids=["dimple", "square", "neck"],
)
def test_a_screw_in_a_dimple_on_a_flat_or_in_a_wide_neck_holds_the_shaft(shaft, seed):
    mechanism = anywhere(screw_in_hub(*shaft), seed).mechanism(fixed=["hub"])
    body = owners(mechanism)
    assert body["shaft"] == body["screw"] == body["hub"]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_pin_of_a_fork_that_a_screw_keeps_in_its_groove_is_a_pin_still(seed):
    """It may turn in the fork, but the eye turns on it: fork and eye have their hinge."""
    hole = across(ring(2.0, 6.0, 10.0, 22.0, (-26.0, 0.0))[2:3])
    lugs = [ring(10.0, 22.0, low, low + 12.0) for low in (-32.0, 20.0)]
    fork = part("fork", *lugs, hole, block((-60, -20, -32), (-23, 20, 32)))
    eye = part("eye", ring(10.0, 19.0, -20.0, 20.0), block((20, -10, -15), (150, 10, 15)))
    bolt = part("bolt", pin(10.0, -32.0, 24.0), pin(7.0, 24.0, 28.0), pin(10.0, 28.0, 32.0))
    keeper = part("screw", across(pin(2.0, 7.0, 22.0, (-26.0, 0.0))))
    mechanism = anywhere(assembly(fork, eye, bolt, keeper), seed).mechanism(fixed=["fork"])
    body = owners(mechanism)
    assert body["bolt"] == body["screw"] == body["fork"]
    assert kind_of(mechanism, "fork", "eye") == "revolute"


def half_groove(radius, low, high, way):
    """The round face of a groove about the axis z that is open by half, towards y or against it."""
    surface, triangles = ring(radius, 2 * radius, low, high)[2]
    return [(surface, triangles[way * triangles[:, :, 1].mean(axis=1) < 0])]


def halves(low, high, *others):
    """A base, a bush pressed into it, in which a crank turns, and a groove of each round the axis z."""
    base = part("base", ring(40.0, 60.0, low, high, (0.0, -40.0)), half_groove(3.0, low, high, -1.0))
    bush = part("bush", ring(20.0, 40.0, low, high, (0.0, -40.0)), half_groove(3.0, low, high, 1.0))
    crank = part("crank", pin(19.8, low, high, (0.0, -40.0)), block((-5, -60, high + 1), (5, 20, high + 9)))
    return assembly(base, bush, crank, *others)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("ends", "held"), [((0.0, 12.0), True), ((0.0, 14.0), True), ((-20.0, 40.0), False)])
def test_a_dowel_half_in_each_of_two_parts_of_one_body_is_held_there(ends, held, seed):
    """Also one with an end that stands out, and no shaft, which comes out of its two halves on both sides."""
    dowel = part("dowel", pin(3.0, *ends))
    mechanism = anywhere(halves(0.0, 12.0, dowel), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["bush"] == body["base"] and (body["dowel"] == body["base"]) == held


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_in_two_grooves_on_one_side_is_not_held(seed):
    """It would fall out of both."""
    base = part("base", block((-30, 3, 0), (30, 30, 12)), half_groove(3.0, 0.0, 12.0, -1.0))
    more = part("more", block((-30, 3, 12), (30, 30, 24)), half_groove(3.0, 12.0, 24.0, -1.0))
    drawn = assembly(base, more, part("dowel", pin(3.0, 0.0, 24.0)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"], rigid=[["base", "more"]])
    assert owners(mechanism)["dowel"] != owners(mechanism)["base"]
