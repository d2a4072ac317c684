"""Boxes of panels that lie on each other without screws, lids that rest on them and turn on a hinge, and leaves of
hinges some of whose screws are not drawn.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

PANELS = ("bottom", "left", "right", "back", "front")


def leaf(name, panel, y, first):
    """A panel with two or one of the three knuckles of a hinge along x beside it, at the height of 60."""
    spans = [(20, 40), (60, 80)] if first else [(40.1, 59.9)]
    return part(name, panel, across(*(ring(1.55, 4.0, *span, (-60.0, y)) for span in spans)))


def box(gap, lids, front=True):
    """Panels in contact, and one lid on a hinge behind them, or one on either side, with a gap to what it lies on."""
    halves = [(0, 100), None] if lids == 1 else [(50.2, 100), (0, 49.8)]
    parts = [part("bottom", block((0, 0, 0), (100, 100, 8)))]
    parts += [part(name, block((x, 0, 8), (x + 8, 100, 60))) for name, x in (("left", 0), ("right", 92))]
    parts.append(leaf("back", block((8, 92, 8), (92, 100, 60)), 105.0, True))
    if front:
        parts.append(leaf("front", block((8, 0, 8), (92, 8, 60)), -5.0, True))
    for k, (half, y) in enumerate(zip(halves, (105.0, -5.0), strict=True)):
        if half:
            parts.append(leaf(f"lid {k}", block((0, half[0], 60 + gap), (100, half[1], 68)), y, False))
            parts.append(part(f"pin {k}", across(pin(1.5, 20, 80, (-60.0, y)))))
    return assembly(*parts)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("fixed", ["bottom", "left"])
@pytest.mark.parametrize(("gap", "lids", "front"), [(0.0, 1, True), (0.0, 1, False), (0.0, 2, True), (0.5, 1, True)])
def test_a_lid_that_rests_on_its_box_turns_and_does_not_keep_the_panels_from_being_one_body(
    gap, lids, front, fixed, seed
):
    mechanism = anywhere(box(gap, lids, front), seed).mechanism(fixed=[fixed])
    body = owners(mechanism)
    assert len({body[name] for name in PANELS if front or name != "front"}) == 1
    assert len(moving(mechanism)) == mechanism.mobility().useful == lids
    for k in range(lids):
        assert kind_of(mechanism, f"lid {k}", "back") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_lid_without_a_hinge_is_held_to_its_box(seed):
    """A lever on a post of the bottom moves whatever is held."""
    parts = [each for each in box(0.0, 1).parts if each.name != "pin 0"]
    post = part("post", pin(5.0, -20, 8, (50.0, 50.0)), pin(8.0, -24, -20, (50.0, 50.0)))
    lever = part("lever", ring(5.05, 9.0, -12, -4, (50.0, 50.0)), block((58, 46, -12), (90, 54, -4)))
    lid = part("lid 0", block((0, 0, 60), (100, 100, 68)))
    others = [each for each in parts if each.name not in ("lid 0", "back")]
    drawn = assembly(*others, part("back", block((8, 92, 8), (92, 100, 60))), lid, post, lever)
    body = owners(anywhere(drawn, seed).mechanism(fixed=["bottom"], rigid=[["bottom", "post"]]))
    assert len({body[name] for name in (*PANELS, "lid 0")}) == 1


def leaf_on_a_wall(screws, empty, turned, pilot):
    """A leaf with holes for screws, of which some are drawn, and with an arm on a pin of it: across the screws, or else
    along them as on a lever. A second arm, on a post of the wall, moves whatever is held."""
    places = [(12.0 * k, 0.0) for k in range(screws + empty)]
    holes = [ring(pilot, 3.0, -20, 0, at) for at in places[:screws]] if pilot else []
    post = pin(3.0, 0, 20, (-50.0, 30.0))
    wall = part("wall", block((-60, -40, -20), (80, 40, 0)), *holes, post)
    arm2 = part("second arm", ring(3.05, 6.0, 4, 10, (-50.0, 30.0)), block((-44, 28, 4), (-20, 32, 10)))
    head = [part(f"screw {k}", pin(1.5, -12, 3, at), pin(2.8, 3, 5, at)) for k, at in enumerate(places[:screws])]
    eyes = [ring(1.7, 4.0, 0, 3, at) for at in places]
    if turned:
        leaf = part("leaf", *eyes, across(ring(2.05, 4.0, 0, 8, (-12.0, 20.0)), ring(2.05, 4.0, 20, 28, (-12.0, 20.0))))
        arm = part("arm", across(ring(2.05, 4.0, 8.1, 19.9, (-12.0, 20.0))), block((8.1, 24, 10), (19.9, 60, 14)))
        return assembly(wall, *head, leaf, arm, part("pin", across(pin(2.0, 0, 28, (-12.0, 20.0)))), arm2)
    leaf = part("leaf", *eyes, ring(2.05, 4.0, 0, 3, (-15.0, 0.0)))
    arm = part("arm", ring(2.05, 4.0, 3.1, 6, (-15.0, 0.0)), block((-19, 4, 3.1), (-11, 38, 6)))
    return assembly(
        wall, *head, leaf, arm, part("pin", pin(2.0, 0, 6, (-15.0, 0.0)), pin(3.5, 6, 8, (-15.0, 0.0))), arm2
    )


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pilot", [0.0, 1.2])
@pytest.mark.parametrize(("empty", "turned", "held"), [(1, True, True), (2, True, True), (1, False, False)])
def test_the_leaf_of_a_hinge_is_held_by_one_screw_that_is_drawn_and_others_that_are_not(
    empty, turned, held, pilot, seed
):
    """Of a lever with an empty hole only what one screw clamps is known."""
    mechanism = anywhere(leaf_on_a_wall(1, empty, turned, pilot), seed).mechanism(fixed=["wall"])
    body = owners(mechanism)
    assert body["leaf"] == body["wall"] or not held
    assert any("as for screws that are not drawn" in note for note in mechanism.notes) == held
