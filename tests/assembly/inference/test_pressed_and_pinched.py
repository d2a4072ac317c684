"""What an interference, a screw in the end of a rod, a set screw and a slit hold, and what turns or slides beside it.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("pivot lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""
FITTING = part("pivot lever", ring(4.0, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""The same without play: where others have some, what fits exactly is pressed on."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("crown", "runner", "held"), [(0.02, -0.1, True), (0.02, 0.02, False), (0.6, -0.1, False)])
def test_a_pin_is_pressed_into_the_crown_where_it_has_play_in_the_runner(seed, crown, runner, held):
    """Interferences on the radius: a pin that is tight in both parts, or by a twenty-fifth, was drawn so by a slip."""
    base = part("base", ring(15 - crown, 30, 0, 28), block((30, -10, 0), (60, 10, 28)))
    tube = part("tube", pin(15, -150, 28), block((-30, -5, -170), (30, 5, -150)))
    slider = part("runner", ring(15 - runner, 22, -120, -60), block((22, -3, -100), (60, 3, -80)))
    body, mechanism = of(seed, base, tube, slider)
    told = [note for note in mechanism.history if "is pressed into" in note]
    assert bool(told) == held and all(note.endswith(": what has play on that pin turns") for note in told)
    assert not held or (body["tube"] == body["base"] and kind_of(mechanism, "base", "runner") == "cylindrical")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "roller", "held"), [(0.2, False, True), (0.05, False, False), (0.2, True, False)])
def test_a_screw_in_the_end_of_a_rod_holds_it_to_the_plate_between_head_and_rod(seed, play, roller, held):
    """Not what fits the screw as a hinge does, nor a roller."""
    arm = [] if roller else [block((8, -4, -6), (40, 4, 0))]
    plate = part("base", ring(2.5 + play, 9.0, -6, 0), *arm)
    rod = part("rod", ring(2.5, 4.0, 0, 16), pin(4.0, 16, 80))
    screw = part("screw", pin(2.5, -6, 16), pin(4.5, -10, -6))
    guide = part("guide", ring(4.02, 12.0, 50, 64), block((12, -3, 50), (40, 3, 64)))
    _, mechanism = of(seed, plate, rod, screw, guide)
    assert any("'screw' in the end of 'rod' pulls it" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("kind", "held"), [("post", True), ("no screw", False), ("motor", False)])
def test_a_set_screw_holds_a_post_on_the_floor_of_its_hole_but_no_motor(seed, kind, held):
    """What has screw holes round about its shaft is a motor, and the hub on its shaft turns."""
    base = part(
        "base", ring(10, 16, 4, 40), block((-70, -70, -8), (70, 70, 4)), across(ring(2, 2.1, 10, 16, (-22.0, 0.0)))
    )
    spots = [(sx * 15.0, sy * 15.0) for sx in (-1, 1) for sy in (-1, 1)]
    holes = [ring(1.25, 2.0, 60, 70, at) for at in spots] if kind == "motor" else []
    post = part("post", pin(10, 4, 60), block((-9, -30, 60), (9, 30, 80)), *holes)
    grub = part("grub", pin(2, 80, 86)) if kind == "no screw" else part("grub", across(pin(2, 10, 16, (-22.0, 0.0))))
    _, mechanism = of(seed, base, post, grub)
    assert any("'grub' holds 'base' to 'post'" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("far", "held"), [(1.2, True), (None, False)])
def test_a_screw_in_a_hole_for_its_thread_beyond_the_slit_pinches_the_stem(seed, far, held):
    """A bracket without a slit, whose screw is beside the shaft, turns on it."""
    base = part("base", block((-60, -60, -140), (80, 80, -130)), ring(5.0, 12.0, -60, -40), ring(5.0, 12.0, 40, 60))
    shaft = part("shaft", pin(5.0, -70, 70))
    ears = [across(ring(1.5, 3.0, -8, -1 if far else 8, (0.0, 14.0)))]
    ears += [across(ring(far, 3.0, 1, 8, (0.0, 14.0)))] if far else []
    hub = part("hub", ring(5.0, 12.0, -10, 10), *ears, block((-3, -60, -5), (3, -11, 5)))
    screw = part("screw", across(pin(1.2, -8, 8, (0.0, 14.0))))
    body, _ = of(seed, base, shaft, hub, screw)
    assert (body["hub"] == body["shaft"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.2, 12.0])
def test_a_ram_between_rails_slides_where_its_links_would_keep_it_in_line_as_well(seed, play):
    """A slider-crank in the plane z = 0: the ram lies on its board, and rails leave it a play, or are far away."""
    rails = [block((-40, 0, low), (60, 20, low + 10)) for low in (-45, 35)]
    arm = block((130, 0, -60), (140, 90, -50)), block((84, 70, -60), (140, 90, -9)), pin(4.0, -9, 20, (94, 80))
    base = part("base", block((-100, -10, -60), (150, 0, 60)), *rails, *arm)
    foot = block((-20, 0, play / 2 - 35), (20, 14, 35 - play / 2))
    ram = part("ram", foot, block((-4, 14, -9), (4, 34, 9)), ring(4.0, 10.0, -9, 9, (0, 40)))
    link = part("link", pin(4.0, -9, 9, (0, 40)), pin(4.0, -9, 9, (94, 40)), block((-6, 34, 9), (100, 46, 15)))
    eyes = [ring(4.0, 10.0, -9, 9, at) for at in ((94, 40), (94, 80))]
    crank = part("crank", *eyes, block((90, 50, -9), (98, 70, 9)))
    _, mechanism = of(seed, base, ram, link, crank)
    assert mechanism.mobility().useful == 1
    assert kind_of(mechanism, "base", "ram") == ("prismatic" if play < 1 else "planar")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("half", "kind"), [(13, "cylindrical"), (60, "revolute")])
def test_a_piston_amid_its_cylinder_slides_and_an_axle_that_sticks_out_on_both_sides_turns(seed, half, kind):
    base = part("base", ring(13, 20, -40, 40), block((20, -10, -40), (80, 10, 40)), PIVOT)
    arm = block((-4, -3, half), (4, 3, half + 6)) if half < 40 else block((-13, -150, half), (13, 4, half + 30))
    piston = part("piston", pin(13, -half, half), arm)
    _, mechanism = of(seed, base, piston, FITTING)
    assert kind_of(mechanism, "base", "piston") == kind


@pytest.mark.parametrize("seed", SEEDS)
def test_a_carriage_stays_on_its_rail_though_no_coupling_ties_its_screw(seed):
    """The screw turns, the carriage and a cover on it slide, and none moves another: all is idle, nothing is locked."""
    sides = [block((min(s * 10, s * 20), -30, -100), (max(s * 10, s * 20), -19.9, 100)) for s in (-1, 1)]
    lips = [block((min(s * 5.1, s * 20), -19.9, -100), (max(s * 5.1, s * 20), -15, 100)) for s in (-1, 1)]
    lug = ring(4.0, 8.0, -110, -104), block((-6, -40, -110), (6, -6, -104))
    base = part("base", block((-20, -40, -100), (20, -30.1, 100)), *sides, *lips, *lug)
    screw = part("screw", pin(4.0, -120, 90), pin(7.0, -113, -110), pin(7.0, -104, -101))
    feet = block((-9.9, -30, -10), (9.9, -20, 10)), block((-5, -20, -10), (5, -6, 10))
    carriage = part("carriage", ring(4.0, 8.0, -10, 10), *feet)
    fitted = block((-10, -30.1, -95), (10, -20, -90)), block((-5, -20, -95), (5, -6, -90))
    cover = part("cover", ring(4.0, 8.0, -95, -90), *fitted)
    _, mechanism = of(seed, base, screw, carriage, cover)
    assert kind_of(mechanism, "base", "carriage") == "prismatic"
    assert kind_of(mechanism, "base", "screw") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bar_that_screws_hold_to_the_ends_of_two_rods_is_a_link(seed):
    base = part("base", block((-80, -80, -30), (80, 80, -20)), PIVOT)
    spots = (0.0, 0.0), (40.0, 0.0)
    posts = [part(f"post {k}", ring(2.5, 6.0, -15, 0, at), pin(6.0, -18, -15, at)) for k, at in enumerate(spots)]
    bar = part("bar", *(ring(2.75, 9.0, 0, 6, at) for at in spots), block((8, -4, 0), (32, 4, 6)))
    screws = [part(f"screw {k}", pin(2.5, -15, 6, at), pin(4.5, 6, 11, at)) for k, at in enumerate(spots)]
    _, mechanism = of(seed, base, *posts, bar, *screws, LEVER)
    assert not any("in the end of" in note for note in mechanism.history)
