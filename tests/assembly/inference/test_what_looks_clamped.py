"""What looks clamped or hinged and is not: what pushes pins, the bracket of a friction hinge, a jaw on a round rail.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import anywhere, assembly, block, kind_of, owners, part, pin, ring


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("holes", [False, True])
def test_a_plate_that_lies_on_the_heads_of_two_pins_is_not_bolted_by_them(seed, holes):
    """Two axes in common are those of holes in both bodies: with holes for the pins the plate is."""
    at = [(-20.0, 0.0), (20.0, 0.0)]
    base = part("base", block((-40, -10, -12), (40, 10, -2)), *(ring(3.0, 8.0, -2, 10, each) for each in at))
    pins = [part(f"pin {k}", pin(3.0, 0, 20, each), pin(5.0, 20, 24, each)) for k, each in enumerate(at)]
    plate = [ring(3.1, 12.0, 10, 20, each) for each in at] if holes else [block((-30, -8, 24), (30, 8, 30))]
    cover = part("cover", *plate, *([block((-8, -4, 10), (8, 4, 20))] if holes else []))
    _, mechanism = of(seed, base, *pins, cover)
    assert any("2 parallel common axes of" in note for note in mechanism.history) == holes


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("keyed", [True, False])
def test_a_bracket_under_a_nut_turns_beside_a_washer_that_a_flat_of_the_shaft_keeps(seed, keyed):
    """As that of a friction hinge, whose washer does not turn with what it brakes; a crank is pressed on."""
    base = part("base", ring(8.1, 16.0, -50, -30), block((-60, -60, -80), (60, 60, -70)))
    flat = [block((0, -2, 0), (3.2, 2, 34))] if keyed else []
    shaft = part("shaft", pin(8.0, -60, 0), pin(4.0, 0, 34), *flat)
    bracket = part("bracket", ring(4.1, 14.0, 0, 6), block((13, -4, 0), (70, 4, 6)))
    tooth = [block((3.2, -2, 6), (6, 2, 8))] if keyed else []
    washer = part("washer", ring(4.0 if keyed else 4.1, 9.0, 6, 8), *tooth)
    nut = part("nut", ring(4.0, 8.0, 8, 14)[:-1])  # without its outside, which is not round
    body, mechanism = of(seed, base, shaft, bracket, washer, nut)
    assert body["nut"] == body["shaft"] and (body["bracket"] == body["shaft"]) != keyed
    assert not keyed or kind_of(mechanism, "shaft", "bracket") == "revolute"


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("play", [0.0, 0.1])
@pytest.mark.parametrize(("slot", "kind"), [(2.6, "prismatic"), (8.0, "cylindrical")])
def test_a_jaw_on_a_round_rail_slides_where_its_neck_is_in_a_slot(seed, play, slot, kind):
    walls = [block((8, slot, 10), (30, slot + 6, 90)), block((8, -slot - 6, 10), (30, -slot, 90))]
    base = part("base", ring(5.0, 12.0, -60, 0), *walls, block((8, -slot - 6, 90), (30, slot + 6, 100)))
    jaw = part("jaw", pin(5.0 - play, -50, 50), block((4, -2.5, 20), (40, 2.5, 50)))
    _, mechanism = of(seed, base, jaw)
    assert kind_of(mechanism, "base", "jaw") == kind
