"""Round parts that are drawn to turn count as freedoms of use, and others that only spin do not."""

import numpy as np
import pytest

from assembly.polygons import prism, teeth
from jaxkin.geometry.teeth import find_teeth
from reference.round_parts import SEEDS, Z, anywhere, assembly, block, part, pin, ring

PLATE = part("plate", block((-60, -60, -30), (60, 60, -20)), ring(5.2, 9.0, -2, 2, at=(40, 40)), pin(5.0, -20, 20))
COLLARS = part("collars", pin(9.0, -20, -5), pin(9.0, 5, 20))
LEVER = part("lever", ring(5.2, 12.0, -4, 4), block((11, -3, -4), (90, 3, 4)))
POST = part("post", pin(4.0, -20, 20, at=(-40, 0)), pin(9.0, -20, -5, at=(-40, 0)), pin(9.0, 5, 20, at=(-40, 0)))
WHEEL = part("wheel", ring(4.2, 16.0, -4, 4, at=(-40, 0)))
COLLAR = [pin(8.0, *ends, at=(40, 40)) for ends in ((-12, -3), (3, 12))]
SPINDLE = part("spindle", pin(5.0, -19, 60, at=(40, 40)), pin(12.0, 40, 44, at=(40, 40)), *COLLAR)


def saw(number, root, tip):
    """The outline of a ratchet wheel."""
    steps = [(2 * np.pi * (k + share) / number, r) for k in range(number) for share, r in ((0.0, tip), (0.96, root))]
    return [(r * np.cos(turn), r * np.sin(turn)) for turn, r in steps]


def mobility(*parts, seed=0):
    """The mobility with all fixed that does not turn."""
    drawn = anywhere(assembly(PLATE, COLLARS, POST, *parts), seed)
    return drawn.mechanism(fixed=["plate", "collars", "post"]).mobility()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wheel_beside_what_has_work_only_spins_and_alone_is_what_turns(seed):
    beside, alone = mobility(LEVER, WHEEL, seed=seed), mobility(WHEEL, seed=seed)
    assert (beside.useful, beside.spinning) == (1, ("wheel",))
    assert (alone.useful, alone.spinning) == (1, ())


@pytest.mark.parametrize("seed", SEEDS)
def test_a_shaft_with_play_between_faces_is_there_to_turn(seed):
    found = mobility(LEVER, WHEEL, SPINDLE, seed=seed)
    assert (found.useful, found.spinning) == (2, ("wheel",))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("outline", [teeth(20, 1.5), saw(24, 14.0, 17.0)])
def test_a_wheel_with_teeth_is_there_to_turn(outline, seed):
    hub = [ring(4.2, 8.0, -4, 4, at=(-40, 0)), prism(outline, -3, 3, at=(-40, 0))]
    found = mobility(LEVER, part("wheel", *hub), seed=seed)
    assert (found.useful, found.spinning) == (2, ())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("count", "radius", "journal", "turns"),
    [(4, 1.0, 5.2, True), (4, 2.6, 5.2, False), (2, 1.0, 5.2, False), (16, 1.0, 5.2, False), (4, 1.0, 16.0, False)],
)
def test_a_flange_with_a_circle_of_holes_for_screws_around_its_journal_is_there_to_turn(
    count, radius, journal, turns, seed
):
    """Wide holes make a wheel lighter, many cool a brake, two are for a pin wrench, and a sieve is in its rim."""
    turned = [2 * np.pi * k / count for k in range(count)]
    holes = [ring(radius, 2 * radius, 2, 6, (40 + 12 * np.cos(turn), 40 + 12 * np.sin(turn)))[2:3] for turn in turned]
    rim = part("rim", ring(16.0, 20.0, 2, 6, at=(40, 40))[2:]) if journal > 12 else None
    shaft = [pin(journal, -12, 2, at=(40, 40)), pin(9.0, -12, -2, at=(40, 40))] if rim is None else []
    flange = part("flange", *shaft, pin(16.0, 2, 6, at=(40, 40)), *holes)
    plate = part(
        "plate",
        *([(face.surface, face.triangles) for each in (PLATE, *([rim] if rim else ())) for face in each.faces],),
    )
    drawn = anywhere(assembly(plate, COLLARS, POST, LEVER, flange), seed)
    found = drawn.mechanism(fixed=["plate", "collars", "post"]).mobility()
    assert (found.useful, found.spinning) == (1 + turns, () if turns else ("flange",))


def test_a_ring_that_fits_its_post_exactly_only_spins_where_nothing_else_moves():
    """It may as well be a nut: nothing drawn says that it turns."""
    found = mobility(part("wheel", ring(4.0, 16.0, -5, 5, at=(-40, 0))))
    assert found.useful == 0


@pytest.mark.parametrize(("root", "tip"), [(16.2, 18.9), (30.0, 33.0)])
def test_saw_teeth_around_a_bore_are_counted(root, tip):
    solid = part("wheel", ring(1.6, 4.0, 0, 4), prism(saw(32, root, tip), 0, 4))
    found = find_teeth(solid.triangles, np.zeros(3), Z, (0.0, 4.0))
    assert {(each.number, each.side) for each in found} >= {(32, "outer")}


def test_no_proposal_fixes_a_lever_so_that_only_the_wheel_beside_it_is_left():
    base = part("base", *([(face.surface, face.triangles) for each in (PLATE, COLLARS, POST) for face in each.faces],))
    hub = [ring(4.2, 8.0, -4, 4, at=(-40, 0)), prism(saw(24, 14.0, 17.0), -3, 3, at=(-40, 0))]
    first = assembly(base, LEVER, part("wheel", *hub)).proposals()[0]
    assert (len(first.fixed), first.moving) == (1, 2)
