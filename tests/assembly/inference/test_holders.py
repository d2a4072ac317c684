"""Which of several bodies holds a shaft or a screw; places, sizes and orders at random change nothing."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def arm(name, bore, low, at, way):
    """A flat arm that goes from a bore at the origin to one `at` along x or y, of the same width as both."""
    end = (at, 0.0) if way == "x" else (0.0, at)
    bar = ((bore, -4, low), (at - bore, 4, low + 5)) if way == "x" else ((-4, bore, low), (4, at - bore, low + 5))
    return part(name, ring(bore, 9.0, low, low + 5), ring(bore, 9.0, low, low + 5, end), block(*bar))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_shaft_across_belongs_to_the_arms_that_it_fits_exactly(seed):
    """As in a scissor lift: what is beside these, and what is between them, has play on the shaft, and turns there.

    It was held on one end, by an arm with play. Of the two that fit alike the fixed one holds it.
    """
    inner = [arm(f"inner {k}", 4.0, low, 80, "x") for k, low in enumerate((6, 184))]
    outer = [arm(f"outer {k}", 4.1, low, 80, "y") for k, low in enumerate((0, 190))]
    eye = part("rod", ring(4.1, 8.0, 90, 105), block((-4, -60, 90), (4, -8, 105)))
    drawn = assembly(*inner, *outer, eye, part("shaft", pin(4.0, -14, 209)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["inner 0"])
    body = owners(mechanism)
    assert body["shaft"] == body["inner 0"]
    for name in ("outer 0", "outer 1", "rod"):
        assert kind_of(mechanism, name, "shaft") in ("revolute", "cylindrical")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("fixed", ["plate", "link"])
def test_a_screw_with_play_in_two_parts_belongs_to_the_fixed_one(fixed, seed):
    """A spacer between them, a nut below: the link was taken to hold the screw, as its hole is longer."""
    screw = part("screw", pin(3.0, 20, 23), pin(1.5, 0, 20))
    nut = part("nut", ring(1.5, 3.0, 0, 2.5))
    plate = part("plate", ring(1.6, 6.0, 2.5, 5.5), block((6, -30, 2.5), (60, 30, 5.5)))
    spacer = part("spacer", ring(1.55, 3.0, 5.5, 15))
    link = part("link", ring(1.6, 6.0, 15, 20), block((6, -5, 15), (60, 5, 20)))
    mechanism = anywhere(assembly(screw, nut, plate, spacer, link), seed).mechanism(fixed=[fixed])
    body = owners(mechanism)
    assert body["screw"] == body["nut"] == body[fixed]
    assert body["plate"] != body["link"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("half", "host"), [(4, "beam"), (12, "stand")])
def test_a_long_shaft_belongs_to_a_short_hole_that_it_fits_exactly(half, host, seed):
    """The beam of an engine, between cheeks with play; in a hole longer than wide it may be a carriage on a rod."""
    cheeks = [ring(6.1, 12.0, low, low + 8) for low in (-60, 52)]
    posts = [block((-8, -60, low), (8, -11, low + 8)) for low in (-60, 52)]
    stand = part("stand", *cheeks, *posts, block((-8, -80, -60), (8, -60, 60)))
    beam = part("beam", ring(6.0, 12.0, -half, half), block((11, -5, -half), (90, 5, half)))
    mechanism = anywhere(assembly(stand, beam, part("shaft", pin(6.0, -64, 64))), seed).mechanism(fixed=["stand"])
    body = owners(mechanism)
    assert body["shaft"] == body[host]
    assert body["beam"] != body["stand"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bearing_block_is_no_nut_of_its_shaft(seed):
    """It has the form of a square nut, with play, and stands on the base with a face along the shaft."""
    base = part("base", block((-40, -30, -10), (40, -10, 110)))
    blocks = [
        part(name, ring(5.2, 7.5, low, low + 12), *_around(7.5, 10.0, low, low + 12))
        for name, low in (("block 1", 0), ("block 2", 80))
    ]
    shaft = part("shaft", pin(5.0, -20, 100), pin(9.0, -26, -20), block((8, -3, -26), (40, 3, -20)))
    mechanism = anywhere(assembly(base, *blocks, shaft), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["block 1"] == body["block 2"] == body["base"]
    assert kind_of(mechanism, "shaft", "base") in ("revolute", "cylindrical")


def _around(inner, outer, low, high):
    """Four bars around a round hole, as of a square."""
    return [
        block((-outer, -outer, low), (outer, -inner, high)),
        block((-outer, inner, low), (outer, outer, high)),
        block((-outer, -inner, low), (-inner, inner, high)),
        block((inner, -inner, low), (outer, inner, high)),
    ]
