"""Ball bearings that are drawn as one ring: by their sizes, in any unit, wherever they lie."""

import numpy as np
import pytest

from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.inference.bores import bores
from jaxkin.assembly.inference.closed_bearings import SIZES, closed_bearings
from jaxkin.geometry.units import METRES
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

# a 608 bearing, 8 x 22 x 7
BORE, OUTSIDE, WIDTH = 4.0, 11.0, 7.0


def bearing(name, low, bore=BORE, outside=OUTSIDE, width=WIDTH):
    return part(name, ring(bore, outside, low, low + width))


def housing(play=0.0):
    return part("housing", ring(OUTSIDE + play, 20.0, 0.0, 30.0), block((-40, -40, -10), (-20, 40, 40)))


def shaft(play=0.0, low=-20.0):
    return part("shaft", pin(BORE - play, low, 50.0), block((-5, -5, 50), (5, 40, 60)))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("outer_play", [0.0, 0.1, -0.02])
@pytest.mark.parametrize("inner_play", [0.0, 0.1])
def test_a_shaft_turns_in_its_bearings_and_they_belong_to_the_housing(seed, outer_play, inner_play):
    """However it fits; a shaft without a collar slides on its bearings by exact contacts, and does not."""
    drawn = anywhere(
        assembly(housing(outer_play), shaft(inner_play), bearing("one", 0), bearing("other", 23)),
        seed,
        scaled_at_random=False,
    )
    mechanism = drawn.mechanism(fixed=["housing"])
    assert owners(mechanism)["one"] == owners(mechanism)["other"] == owners(mechanism)["housing"]
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence.kind == EvidenceKind.BEARING


@pytest.mark.parametrize("seed", SEEDS)
def test_a_spacer_in_a_bearing_goes_with_the_shaft(seed):
    """A ring that is tight in the hole of the bearing, and has play on its rod, is no bush of the bearing."""
    spacer = part("spacer", ring(2.2, BORE, 8.0, 11.5))
    rod = part("rod", pin(2.0, -30.0, 60.0), block((-5, -5, -40), (5, 5, -30)))
    mechanism = anywhere(
        assembly(housing(), rod, spacer, bearing("bearing", 8.0)), seed, scaled_at_random=False
    ).mechanism(fixed=["housing"])
    body = owners(mechanism)
    assert body["bearing"] == body["housing"] != body["spacer"]
    assert kind_of(mechanism, "spacer", "housing") == "revolute"


@pytest.mark.parametrize("unit", ["mm", "m", "in"])
def test_a_bearing_is_known_by_its_size_in_any_unit(unit):
    def found(bore, outside, width):
        scale = 1e-3 / METRES[unit]
        drawn = part("ring", ring(bore * scale / 2, outside * scale / 2, 0.0, width * scale))
        return bool(Assembly((drawn,), unit, "drawn.step")._measured.closed_bearings)

    for bore, outside, width in ((8, 22, 7), (17, 40, 12), (6.35, 12.7, 4.7625), (3, 10, 4), (8.02, 22.05, 7.02)):
        assert found(bore, outside, width)
    # a bush, a washer, a collar, a piston of the proportions of a bearing
    for bore, outside, width in ((8, 10, 12), (8.4, 16, 1.6), (8, 22, 12), (16, 44, 14)):
        assert not found(bore, outside, width)


def test_catalogued_rings_are_thick_enough_for_balls():
    """Balls leave no room in a ring whose section is narrower than a quarter of its width."""
    bore, outside, width = SIZES.T
    assert np.all(outside > 1.2 * bore) and np.all(outside - bore > 0.5 * width)
    assert len(np.unique(SIZES, axis=0)) == len(SIZES)


def test_what_has_other_bores_is_no_bearing():
    flange = part("flange", ring(BORE, OUTSIDE, 0, WIDTH), ring(0.5, 1.0, 0, WIDTH, at=(7.5, 0.0)))
    assert not closed_bearings([flange], {"flange": bores(flange)})


@pytest.mark.parametrize("seed", SEEDS)
def test_holes_that_line_up_do_not_lock_what_a_bearing_lets_turn(seed):
    """A flange in whose pose two holes stand over two of the housing, as if bolts held it: the search for more bolted
    bodies ends, and the shaft turns."""
    at = [(15.0, 0.0), (-15.0, 0.0)]
    below = part("housing", ring(OUTSIDE, 20.0, 0.0, 30.0), *(ring(1.5, 2.5, 20.0, 30.0, each) for each in at))
    flange = part("shaft", pin(BORE, -20.0, 50.0), *(ring(1.5, 2.5, 30.5, 36.0, each) for each in at))
    drawn = anywhere(assembly(below, flange, bearing("bearing", 10.0)), seed, scaled_at_random=False)
    mechanism = drawn.mechanism(fixed=["housing"])
    (joint,) = moving(mechanism)
    body = owners(mechanism)
    assert joint.kind == "revolute" and body["bearing"] == body["housing"] != body["shaft"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("outside", "rolls"), [(11.0, True), (10.0, False)])
def test_a_bearing_by_itself_over_a_hole_is_a_roller(seed, outside, rolls):
    """A 608 on the end of a bracket, whose bolt is not drawn; a ring of no such size lies there."""
    hole, pivot = ring(2.0, 5.0, -10, 0, (50.0, 0.0))[2:3], (-50.0, 0.0)
    axle = [pin(4.0, 0, 10, pivot), pin(7.0, 10, 12, pivot)]
    base = part("base", block((-60, -10, -10), (60, 10, 0)), hole, *axle)
    lever = part("lever", ring(4.1, 9.0, 0.1, 9.9, pivot), block((-42, -3, 0.1), (20, 3, 9.9)))
    drawn = assembly(base, lever, part("roller", ring(BORE, outside, 0, WIDTH, (50.0, 0.0))))
    mechanism = anywhere(drawn, seed, scaled_at_random=False).mechanism(fixed=["base"])
    found = [joint for joint in mechanism.all_joints if "roller" in joint.parts and joint.freedoms]
    assert [joint.kind for joint in found] == (["revolute"] if rolls else [])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("room", "turns"), [(1.0, True), (0.1, False)])
def test_a_bearing_with_room_about_it_is_not_seated_beside_its_axle(room, turns, seed):
    """An arm holds the axle of its roller more closely than the roller, which has a millimetre of room in it."""
    cheeks = [ring(BORE, 20.0, low, low + 8) for low in (-10.0, 9.0)]
    arm = part("arm", *cheeks, ring(OUTSIDE + room, 20.0, -2, 9), block((20, -5, -10), (60, 5, 17)))
    drawn = assembly(arm, part("axle", pin(BORE, -10, 17)), bearing("roller", 0.0))
    body = owners(anywhere(drawn, seed, scaled_at_random=False).mechanism(fixed=["arm"]))
    assert (body["roller"] != body["arm"]) == turns


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hollow", "beside"), [(7.0, True), (5.1, False)])
def test_a_shaft_in_the_wide_hollow_of_another_one_is_beside_it_where_both_have_bearings(hollow, beside, seed):
    """With the play of a bush the hollow guides the shaft, as a needle bearing in a gear box does."""
    housing = part("housing", ring(9.5, 20.0, 0, 5), ring(16.0, 20.0, 20, 27), ring(18.0, 20.0, 5, 20))
    rings = [part("6800", ring(5.0, 9.5, 0, 5)), part("6804", ring(10.0, 16.0, 20, 27))]
    inner = part("inner", pin(5.0, -10, 18), block((-40, -3, -10), (0, 3, -5)))
    outer = part("outer", ring(hollow, 10.0, 14, 28), block((10, -3, 27), (40, 3, 28)))
    drawn = anywhere(assembly(housing, *rings, inner, outer), seed, scaled_at_random=False)
    mechanism = drawn.mechanism(fixed=["housing"])
    body = owners(mechanism)
    pairs = [{body[part] for part in joint.parts} for joint in mechanism.all_joints if joint.freedoms]
    assert ({body["inner"], body["outer"]} not in pairs) is beside
    assert {body["inner"], body["housing"]} in pairs and {body["outer"], body["housing"]} in pairs


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("name", "width", "turns"),
    [
        ("Pinion bearing", 6.0, True),
        ("Rillenkugellager_2", 6.0, True),
        ("wheel bearing left", 6.0, True),
        ("linear bearing", 6.0, False),
        ("bearing cap", 6.0, False),
        ("bearing", 14.0, False),
        ("ring", 6.0, False),
    ],
)
@pytest.mark.parametrize("flange", [False, True])
def test_a_ring_of_any_size_is_a_ball_bearing_by_its_name_unless_it_is_long(name, width, turns, flange, seed):
    """The shaft fits the ring as exactly as that fits its seat: by contacts alone it turns and slides."""
    base = part("base", ring(10.0, 20.0, 0, 20), block((14, -10, 0), (70, 10, 10)), pin(4.0, 10, 40, (60, 0)))
    lever = part("lever", ring(4.1, 8.0, 12, 22, (60, 0)), block((67, -3, 12), (110, 3, 22)))
    axle = part("axle", pin(5.0, -10, 40), block((-30, -3, 35), (0, 3, 40)))
    rim = [ring(5.0, 11.5, -1, 0)] if flange else []
    drawn = assembly(base, lever, axle, part(name, ring(5.0, 10.0, 0, width), *rim))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert not turns or body[name] == body["base"]
    told = [joint for joint in mechanism.all_joints if joint.evidence and "by its name" in joint.evidence.text]
    assert [str(joint.kind) for joint in told if joint.freedoms] == (["revolute"] if turns else [])
