"""Parts that only one body holds: wheels in chambers and hubs on pins, which turn there, gland nuts, and shims.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from assembly.polygons import prism, teeth
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = [pin(4.0, 0, 20, (150.0, 0.0)), pin(9.0, -10, 0, (150.0, 0.0))]
LEVER = part("lever", ring(4.1, 9.0, 0, 10, (150.0, 0.0)), block((158, -3, 0), (190, 3, 10)))
"""Something that moves: where nothing can, inferences are left out until something does."""


def read(seed, fixed, *parts, **words):
    mechanism = anywhere(assembly(LEVER, *parts), seed).mechanism(fixed=fixed, **words)
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("rim", "chamber", "turns"),
    [
        (prism(teeth(9, 3.0), 0, 25), (0, 25), True),
        (pin(16.5, 0, 25), (0, 25), True),
        (pin(9.5, 0, 25), (0, 25), True),
        (pin(9.5, 0, 25), (8, 16), False),
        (pin(9.5, 0, 25), None, False),
    ],
    ids=["wheel", "close rim", "collar", "pillar through a plate", "pillar"],
)
def test_what_is_in_a_chamber_between_two_covers_that_fit_it_turns(rim, chamber, turns, seed):
    """A pillar between two plates has no bore about all of it, or none at all."""
    body = part("body", block((40, -30, 0), (60, 30, 25)), *([ring(17.25, 30.0, *chamber)] if chamber else []), *PIVOT)
    covers = [part(f"cover {k}", ring(8.0, 30.0, low, low + 9)) for k, low in enumerate((-9, 25))]
    wheel = part("wheel", rim, pin(8.0, -7, 0), pin(8.0, 25, 32))
    of, mechanism = read(seed, ["body", "cover 0", "cover 1"], body, *covers, wheel)
    assert (of["wheel"] != of["body"]) == turns
    assert not turns or kind_of(mechanism, "wheel", "body") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("washer", "gap", "turns"), [(True, 1.0, True), (True, 0.0, False), (False, 1.0, False)])
def test_a_hub_that_a_washer_keeps_on_its_pin_with_play_turns(washer, gap, turns, seed):
    """The screw clamps the washer on the end of the pin; without the play it clamps the hub as well, and a ring on the
    same thread is a lock nut, wherever it stands."""
    top = 68 + gap
    walls = ring(6.0, 10.0, 40, top)[2:3]
    spindle = part("spindle", pin(34.0, 0, 50), pin(16.0, 50, top if washer else 90), walls if washer else [], *PIVOT)
    cup = part("cup", ring(16.0, 46.0, 50, 68))
    held = [part("washer", ring(6.0, 24.0, top, top + 3)), part("screw", pin(6.0, 45, top + 3), pin(11.0, top + 3, 80))]
    held = held if washer else [part("nut", ring(16.0, 24.0, top, top + 10))]
    of, mechanism = read(seed, ["spindle"], spindle, cup, *held)
    assert all(of[each.name] == of["spindle"] for each in held)
    assert (of["cup"] != of["spindle"]) == turns
    assert not turns or kind_of(mechanism, "cup", "spindle") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_nut_on_a_bolt_in_a_recess_is_held_on_the_face_that_the_bolt_clamps(seed):
    """The part lies on the shoulder of the bolt, and not on its end, and has a floor beyond that."""
    base = part("base", ring(10.0, 40.0, 0, 20), ring(10.0, 40.0, -30, -22), ring(38.0, 40.0, -22, 0), *PIVOT)
    bolt = part("bolt", pin(10.0, -21, 20), pin(17.0, 20, 26), block((-6, -60, 26), (6, 60, 60)))
    of, _ = read(seed, ["base"], base, bolt, part("nut", ring(10.0, 17.0, -16, 0)))
    assert of["nut"] == of["bolt"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("touching", [False, True])
def test_a_nut_through_which_a_shaft_passes_is_on_the_neck_that_it_fits(touching, seed):
    """One that lies on a collar of the shaft may go with it."""
    cover = part("cover", ring(8.0, 16.0, 0, 22), ring(8.0, 40.0, -9, 0), *PIVOT)
    collar = [pin(10.0, 26, 30)] if touching else []
    shaft = part("shaft", pin(8.0, -30, 80), pin(6.0, 80, 95), *collar)
    gland = part("gland nut", ring(16.0, 20.0, 6, 22), ring(8.5, 20.0, 22, 26))
    wheel = part("wheel", ring(8.0, 30.0, 60, 80), block((-4, 29, 60), (4, 60, 80)))
    nut = [part("washer", ring(6.0, 12.0, 80, 82)), part("nut", ring(6.0, 11.0, 82, 92))]
    of, _ = read(seed, ["cover"], cover, shaft, gland, wheel, *nut, rigid=[["shaft", "wheel"]])
    assert of["shaft"] != of["cover"] and of["nut"] == of["shaft"]
    assert of["gland nut"] == of["shaft" if touching else "cover"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("out", "fork", "clamped"),
    [(15, False, True), (60, False, False), (15, True, False), (None, False, False)],
    ids=["shim", "lever", "eye in a fork", "roller"],
)
def test_a_plate_between_two_parts_that_a_bolt_draws_together_is_clamped(out, fork, clamped, seed):
    """Not a lever that stands out, nor what is between the cheeks of one part, or may roll there."""
    spots = [(-25.0, 0.0), (25.0, 0.0)]

    def hole(low, high, at):
        return ring(4.0, 9.0, low, high, at)[2:3]

    def lug(low):
        return [block((-40, -15, low), (40, 15, low + 10)), *(hole(low, low + 10, at) for at in spots)]

    lugs = [part("one", *lug(0), *lug(15), *PIVOT)] if fork else [part("one", *lug(0), *PIVOT), part("other", *lug(15))]
    parts = []
    for k, at in enumerate(spots):
        plate = [block((at[0] - 12, -15, 10), (at[0] + 12, out, 15)), hole(10, 15, at)] if out else []
        parts.append(part(f"shim {k}", *plate or [ring(4.0, 14.0, 10, 15, at)]))
        parts.append(part(f"bolt {k}", pin(4.0, 0, 35, at), pin(8.0, -8, 0, at)))
        parts.append(part(f"nut {k}", ring(4.0, 8.0, 25, 32, at)))
    of, _ = read(seed, ["one"], *lugs, *parts)
    assert all(of[f"{name} {k}"] == of["one"] for name in ("bolt", "nut") for k in (0, 1))
    assert [of[f"shim {k}"] == of["one"] for k in (0, 1)] == [clamped] * 2


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("driven", [True, False])
def test_a_ring_with_pins_of_levers_in_its_slots_turns_in_its_case(driven, seed):
    """A unison ring, as that of an iris or of guide vanes; by itself it is a bush with play, set into the hole."""
    case, levers = [ring(30.1, 38.0, 0, 12), ring(20.0, 38.0, -4, 0)], []
    driver = [ring(20.5, 30.0, 0, 10), ring(18.0, 20.5, 0, 16)]
    for side in (-1, 1):
        near, far = sorted((side * 21, side * 28))
        driver += [block((near, low, 10), (far, high, 16)) for low, high in ((-5, -1.6), (1.6, 5))]
        case.append(ring(3.1, 10.0, 0, 12, (side * 50, 0)))
        inner, outer = sorted((side * 26, side * 46))
        pins = pin(3.0, 0, 22, (side * 50, 0)), pin(1.5, 10.5 if driven else 18, 22, (side * 24.5, 0))
        levers.append(part(f"lever {side}", block((inner, -2, 18), (outer, 2, 22)), *pins))
    drawn = anywhere(assembly(part("case", *case), part("ring", *driver), *levers), seed)
    body = owners(drawn.mechanism(fixed=["case"]))
    assert (body["ring"] != body["case"]) is driven
