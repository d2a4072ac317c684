"""Bodies that only stand on or against others, with no screw drawn, beside a lever that moves whatever is held."""

import numpy as np
import pytest

from jaxkin.geometry.surfaces import Cylinder
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

POST = block((-20, -100, -10), (0, 100, 10))
BAR = block((0, -10, -10), (100, 10, 10))
PLATE = block((-20, -10, -16), (30, 10, -10))
COVER = block((-20, -10, 10), (30, 10, 16))
SHORT = block((-20, -10, -10), (0, 10, 10))


def with_lever(*parts):
    """Parts, the first of which carries a lever on a pin."""
    first = part(
        "post", *parts[0], block((-40, -10, -10), (-20, 10, 10)), pin(3.0, 10, 30, (-30, 0)), pin(6.0, 30, 34, (-30, 0))
    )
    lever = part("lever", ring(3.05, 6.0, 22, 30, (-30, 0)), block((-80, -2, 22), (-36, 2, 30)))
    return assembly(first, lever, *parts[1:])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("post", "beside", "held"),
    [
        ([POST], [part("bar", BAR), part("plate", PLATE)], True),  # a corner of two bars with a plate under both
        ([POST], [part("bar", BAR), part("plate", PLATE), part("cover", COVER)], False),  # between two plates
        ([POST], [part("bar", BAR, PLATE)], False),  # an angle that may travel along an edge
        ([SHORT], [part("bar", BAR, PLATE)], True),  # flush with what it is on at both ends of the slide
    ],
)
def test_what_is_butted_against_a_part_stays_where_nothing_stands_opposite(post, beside, held, seed):
    names = [each.name for each in beside]
    drawn = anywhere(with_lever(post, *beside), seed)
    mechanism = drawn.mechanism(fixed=["post"], rigid=[names] if len(names) > 1 else [])
    body = owners(mechanism)
    assert (body["bar"] == body["post"]) is held
    assert kind_of(mechanism, "lever", "post") in ("revolute", "cylindrical")
    if not held:
        assert [joint.kind for joint in moving(mechanism) if "lever" not in joint.parts] == ["prismatic"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_slide_that_is_all_that_moves_stays(seed):
    drawn = anywhere(assembly(part("post", POST), part("bar", BAR), part("plate", PLATE)), seed)
    (joint,) = moving(drawn.mechanism(fixed=["post"], rigid=[["bar", "plate"]]))
    assert joint.kind == "prismatic"


def half_disc():
    """The round face of half a disc of radius 20, towards y."""
    angles = np.linspace(0, np.pi, 61)
    x, y = 20 * np.cos(angles), 20 * np.sin(angles)
    corners = np.array([[[a, b, z] for a, b in zip(x, y, strict=True)] for z in (-6.0, 5.0)])
    low, high = corners[:, :-1], corners[:, 1:]
    quads = np.stack([low[0], high[0], high[1], low[0], high[1], low[1]], axis=1).reshape(-1, 3, 3)
    return [(Cylinder(np.zeros(3), np.array([0.0, 0.0, 1.0]), 20.0, 1), quads)]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("on", ["dwell", "disc", "pin"])
def test_a_follower_on_the_dwell_of_its_cam_leaves_its_bracket_resting(on, seed):
    """A lever on a bracket that stands on the base touches a cam there. On a pin of the disc instead, it turns where
    the bracket slides; and a disc that is round altogether may be a roller."""
    base = part("base", block((-60, -40, -10), (80, -30, 10)), block((-5, -30, -10), (5, 5, -6)), pin(3.0, -6, 9))
    bracket = part("bracket", block((40, -30, -10), (60, 30, -6)), pin(3.0, -6, 9, (50, 24)))
    lever = [ring(3.0, 6.0, -6, 9, (50, 24)), block((10, 21, 6), (44, 27, 9))]
    if on == "pin":
        disc = part("disc", ring(3.0, 30.0, -6, 5), pin(4.0, 5, 9, (0, 24)))
        lever += [ring(4.0, 9.0, 5, 9, (0, 24))]
    else:
        face = half_disc() if on == "dwell" else ring(15.0, 20.0, -6, 5)
        disc = part("disc", ring(3.0, 15.0, -6, 5), face)
        lever += [pin(4.0, -6, 9, (0, 24)), block((0, 21, 6), (10, 27, 9))]
    mechanism = anywhere(assembly(base, bracket, disc, part("lever", *lever)), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["bracket"] == body["base"]) is (on == "dwell")
    assert kind_of(mechanism, "lever", "bracket") in ("revolute", "cylindrical")


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cover_that_lies_on_its_case_is_held_though_its_crank_could_turn_in_two_halves_without(seed):
    """The webs of a built-up crank turn on each other where the bearing of one may be pushed about; else they turn as
    one, as what carries them stays."""
    case = part("case", ring(5.0, 30.0, 0, 10), block((26, -8, 10), (34, 8, 60)), block((-34, -8, 10), (-26, 8, 60)))
    cover = part("cover", ring(5.0, 34.0, 60, 70))
    rear = part("rear web", pin(5.0, -10, 16), ring(4.0, 9.0, 16, 24, (12, 0)), block((0, -4, 16), (4, 4, 24)))
    front = part(
        "front web", pin(5.0, 40, 90), pin(9.0, 40, 48), block((6, -4, 40), (12, 4, 48)), pin(4.0, 16, 48, (12, 0))
    )
    rod = part("rod", ring(4.1, 8.0, 28, 36, (12, 0)), block((20, -3, 28), (24, 3, 36)))
    mechanism = anywhere(assembly(case, cover, rear, front, rod), seed).mechanism(fixed=["case"])
    body = owners(mechanism)
    assert body["cover"] == body["case"]
    assert body["front web"] != body["case"] != body["rear web"]
