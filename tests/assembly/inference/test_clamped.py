"""What holds round parts on shafts and threads, and what turns there all the same.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.surfaces import Sphere
from reference.round_parts import SEEDS, across, anywhere, assembly, block, moving, owners, part, pin, ring

BASE = block((-60, -60, -140), (60, 60, -130))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (60.0, 0.0)), block((68, -3, 5), (100, 3, 15)))
"""Something that moves: where nothing can, inferences are left out until something does."""


def of(drawn, seed):
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("tip", "held"), [(5.0, True), (11.0, False)])
def test_a_set_screw_holds_a_hub_on_its_shaft_where_it_reaches_it(seed, tip, held):
    base = part("base", BASE, ring(5.0, 12.0, -60, -40), ring(5.0, 12.0, 40, 60))
    shaft = part("shaft", pin(5.0, -70, 70))
    lever = part("lever", ring(5.0, 14.0, -10, 10), across(ring(2.0, 4.0, 5, 14)), block((-4, -60, -10), (4, -13, 10)))
    screw = part("screw", across(pin(2.0, tip, 16)))
    body, mechanism = of(assembly(base, shaft, lever, screw), seed)
    assert any("holds 'lever' to 'shaft'" in note for note in mechanism.notes) == held
    assert (body["lever"] == body["shaft"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hole", "held"), [(True, True), (False, False)])
def test_a_round_collar_with_a_hole_across_it_is_clamped_on_its_shaft(seed, hole, held):
    base = part("base", BASE, ring(5.1, 12.0, -60, -40), block((-20, 11, -60), (20, 30, -40)))
    flag = block((-3, -40, 60), (3, 40, 66))
    shaft = part("shaft", pin(5.0, -70, 70), flag if not hole else pin(5.0, 60, 66))
    crank = part("crank", ring(5.0, 12.0, 30, 40), block((-4, 11, 30), (4, 60, 40)))
    collar = part("collar", ring(5.0, 12.0, -30, -10), *([across(ring(1.5, 1.6, 5, 12, (20.0, 0.0)))] if hole else []))
    _, mechanism = of(assembly(base, shaft, crank, collar), seed)
    assert any("a screw that is not drawn" in note for note in mechanism.notes) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("shoulder", "locked"), [(False, True), (True, False)])
def test_a_nut_locks_a_thread_but_not_a_hinge_between_it_and_a_shoulder(seed, shoulder, locked):
    """The stud of the lever goes through the base to the nut; with a shoulder on the other side the lever turns."""
    base = part("base", block((-60, -60, -10), (60, -12, 0)), ring(5.0, 14.0, -10, 0))
    stop = [pin(9.0, -20, -10)] if shoulder else []
    lever = part("lever", pin(5.0, -8, 40), *stop, block((-4, -4, 20), (60, 4, 30)))
    other = part("other", pin(4.0, 42, 60), block((3, -3, 42), (60, 3, 50)))
    nut = part("nut", ring(5.0, 9.0, 0, 6)[:-1])  # without its outside, which is not round
    lever = part("lever", *[[(f.surface, f.triangles)] for f in lever.faces], ring(4.0, 9.0, 40, 62))
    body, mechanism = of(assembly(base, lever, nut, other), seed)
    assert any("locked by 'nut'" in note for note in mechanism.notes) == locked
    assert (body["lever"] == body["base"]) == locked


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "held"), [(10.0, True), (40.0, False)])
def test_a_flat_of_a_shaft_holds_a_short_hub(seed, length, held):
    """A longer one slides on it."""
    base = part("base", BASE, ring(5.1, 12.0, -60, -40), block((-20, 11, -60), (20, 30, -40)))
    shaft = part("shaft", pin(5.0, -70, 70), block((0, -2.9, -30), (4, 2.9, 70)))
    crank = part(
        "crank", ring(5.0, 12.0, 0, length), block((4, -2.9, 0), (8, 2.9, length)), block((11, -4, 0), (60, 4, 10))
    )
    body, mechanism = of(assembly(base, shaft, crank), seed)
    assert any("keeps 'crank' from turning" in note for note in mechanism.notes) == held
    assert not held or body["crank"] == body["shaft"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_roller_turns_on_the_pin_of_a_bracket_though_it_is_wider(seed):
    base = part("base", block((-30, -30, -10), (80, 30, 0)), ring(3.0, 8.0, -10, 0), pin(4.0, 0, 20, (60.0, 0.0)))
    roller = part("roller", ring(3.0, 9.0, 0.5, 25))
    clip = part("clip", ring(3.0, 5.0, 26, 27))
    body, _ = of(assembly(base, part("pin", pin(3.0, -10, 28)), roller, clip, LEVER), seed)
    assert body["pin"] == body["base"] != body["roller"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_shaft_in_bushes_belongs_to_its_crank(seed):
    """Bushes and crank fit alike: what bushes are on turns in them."""
    base = part("base", BASE, ring(7.0, 14.0, -60, -40), ring(7.0, 14.0, 20, 40))
    bushes = [part(f"bush {z}", ring(5.0, 7.0, z, z + 20)) for z in (-60, 20)]
    crank = part("crank", ring(5.0, 12.0, 45, 55), block((11, -4, 45), (60, 4, 55)))
    body, _ = of(assembly(base, *bushes, part("shaft", pin(5.0, -62, 56)), crank), seed)
    assert body["shaft"] == body["crank"] != body["base"] == body["bush -60"] == body["bush 20"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_lone_shaft_turns_in_its_bushes_and_is_more_than_a_pin(seed):
    """Both bushes keep their seat, and the turn of the shaft is one of use."""
    base = part("base", BASE, ring(7.0, 14.0, -60, -40), ring(7.0, 14.0, 20, 40))
    bushes = [part(f"bush {z}", ring(5.0, 7.0, z, z + 20)) for z in (-60, 20)]
    body, mechanism = of(assembly(base, *bushes, part("shaft", pin(5.0, -90, 80))), seed)
    assert body["bush -60"] == body["bush 20"] == body["base"] != body["shaft"]
    assert mechanism.mobility().useful >= 1 and not mechanism.mobility().spinning
    assert not any("only spins" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("bore", "slides"), [(5.4, True), (5.0, False)])
def test_a_loose_bar_that_sticks_out_on_both_sides_slides(seed, bore, slides):
    base = part("base", block((-60, -60, -8), (80, -12, 8)), ring(bore, 14.0, -8, 8), pin(4.0, 0, 20, (60.0, 0.0)))
    body, _ = of(assembly(base, part("bar", pin(5.0, -60, 50)), LEVER), seed)
    assert (body["bar"] != body["base"]) == slides


@pytest.mark.parametrize("seed", SEEDS)
def test_a_flange_with_a_pattern_is_screwed_on_and_not_seated_on_its_screw(seed):
    """The nut fits its screw more tightly than the plate; the holes of its flange are those of the plate."""
    places = [(10.0, 0.0), (-10.0, 0.0)]
    plate = part(
        "plate", ring(6.2, 8.0, 0, 8), *(ring(1.5, 1.6, 0, 8, at) for at in places), block((8, -20, 0), (40, 20, 8))
    )
    nut = part("nut", ring(4.05, 6.0, -4, 20), ring(4.05, 14.0, -4, 0), *(ring(1.7, 1.8, -4, 0, at) for at in places))
    base = part("base", BASE, ring(4.1, 12.0, -110, -90), block((-20, 11, -110), (20, 30, -90)))
    screw = part("screw", pin(4.0, -120, 100), pin(9.0, -88, -80))
    body, _ = of(assembly(base, screw, nut, plate), seed)
    assert body["nut"] == body["plate"] != body["screw"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("bolted", [True, False])
def test_a_bolt_through_the_ball_of_a_rod_end_holds_it_to_the_lever(seed, bolted):
    """The lever is then on the rod end by its ball; a ball that is only near the lever is not."""
    sphere, low = trimesh.creation.icosphere(3, 8.0).triangles, 5.0 if bolted else 5.5
    kept = sphere[np.abs(sphere[:, :, 2]).max(axis=1) < 5.0]
    ball = part("ball", [(Sphere(np.zeros(3), 8.0, 1), kept)], ring(3.0, 6.2, -5, 5)[:-1])
    race = sphere[np.abs(sphere[:, :, 2]).max(axis=1) < 3.5][:, ::-1]
    eye = ring(7.2, 12.0, -3.5, 3.5)
    base = part("base", [(Sphere(np.zeros(3), 8.0, -1), race)], eye[:2] + eye[3:], block((-5, 11, -3), (5, 60, 3)))
    lever = part("lever", ring(3.0, 9.0, low, low + 5), block((8, -3, low), (60, 3, low + 5)))
    bolt = part("bolt", pin(3.0, -5, 14), pin(5.0, -9, -5))
    body, mechanism = of(assembly(base, ball, lever, bolt), seed)
    assert any("of the rod end 'base'" in note for note in mechanism.notes)
    assert (body["lever"] == body["ball"]) == bolted
    assert "spherical" in [joint.kind for joint in moving(mechanism)]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bush_beside_a_disc_is_no_set_screw(seed):
    """A disc in a bore, and a bush in a hole across that bore that ends at the disc: it presses on nothing."""
    base = part("base", BASE, ring(30.0, 40.0, -30, 30), across(ring(6.0, 9.0, 31, 50)))
    disc = part("disc", pin(29.9, -10, 10))
    bush = part("bush", across(ring(4.0, 6.0, 31, 50)))
    _, mechanism = of(assembly(base, disc, bush, LEVER), seed)
    assert not any("the screw 'bush'" in note for note in mechanism.notes)
