"""Gears proposed from solids: teeth are counted, and the equation of a pair is that of its numbers of teeth."""

import numpy as np
import pytest

import jaxkin as jk
from assembly.toothed import Z, ratio, walls_between, wheel, with_solids
from jaxkin.cli.report import print_gears
from jaxkin.geometry.teeth import find_teeth


@pytest.mark.parametrize("number", [8, 17, 40, 133])
@pytest.mark.parametrize("twist", [0.0, 0.02])
def test_teeth_are_counted(number, twist):
    part = wheel("wheel", number, 2.0, at=(3, -2, 5), axis=(1, 2, 3), twist=twist)
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14)
    point = np.array([3.0, -2.0, 5.0])
    found = find_teeth(part.triangles, point, axis, (float(point @ axis) - 4, float(point @ axis) + 4))
    assert {(each.number, each.side) for each in found} == {(number, "outer")}
    # the pitch circle is an eighth of a module above the middle of teeth that are 1 above and 1.25 below it
    assert all(abs(each.pitch_radius - number + 0.25) < 0.05 for each in found)


@pytest.mark.parametrize("corners", [3, 6, 8, 24])
def test_prisms_and_discs_have_no_teeth(corners):
    angle = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    low, high = (np.stack([10 * np.cos(angle), 10 * np.sin(angle), 0 * angle + h], axis=1) for h in (0.0, 5.0))
    walls = np.concatenate([*walls_between(low, high), *walls_between(low, 0 * low)])
    assert find_teeth(walls, np.zeros(3), Z, (0.0, 5.0)) == []


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("reversed_parts", [False, True])
def test_a_pair_turns_as_its_teeth_and_the_senses_of_its_axes_say(sense, reversed_parts):
    parts = ("wheel", "ground") if reversed_parts else ("ground", "wheel")
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", *parts, point=(60, 0, 9), axis=(0, 0, sense)),
    ]
    mechanism = with_solids(joints, wheel("pinion", 20, 2.0), wheel("wheel", 40, 2.0, at=(60, 0, 0)))
    (found,) = jk.gear_proposals(mechanism)
    assert (found.parts, found.teeth, found.meshing) == (("pinion", "wheel"), (20, 40), "external")
    assert found.module == pytest.approx(2.0, abs=1e-9)  # from the distance of the axes, exact
    # in the world the wheel turns by half the angle, against the pinion, whatever its joint is written like
    about_z = -sense if reversed_parts else sense
    assert about_z * ratio(found.coupling, "A.phi", "B.phi") == pytest.approx(-0.5, abs=1e-12)
    assert str(found).startswith("'pinion' (20 teeth) and 'wheel' (40 teeth) may mesh, external, module 2: ")


@pytest.mark.parametrize("away", [-3.0, 3.0])
def test_wheels_whose_pitch_circles_do_not_touch_are_no_gear(away):
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "ground", "wheel", point=(60 + 4 * away, 0, 0), axis=(0, 0, 1)),
    ]
    mechanism = with_solids(joints, wheel("pinion", 20, 2.0), wheel("wheel", 40, 2.0, at=(60 + 4 * away, 0, 0)))
    assert jk.gear_proposals(mechanism) == ()


def test_wheels_of_other_modules_or_beside_each_other_are_no_gear():
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "ground", "wheel", point=(60, 0, 0), axis=(0, 0, 1)),
    ]
    coarse = wheel("wheel", 20, 4.0, at=(60, 0, 0))
    assert jk.gear_proposals(with_solids(joints, wheel("pinion", 20, 2.0), coarse)) == ()
    above = wheel("wheel", 40, 2.0, at=(60, 0, 30))
    assert jk.gear_proposals(with_solids(joints, wheel("pinion", 20, 2.0), above)) == ()


def test_bevel_wheels_turn_about_axes_that_meet():
    apex_1, apex_2 = 40.0, 20.0  # heights of the apex above the wheels: radii 20 and 40 at right angles
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "ground", "wheel", point=(0, 0, 0), axis=(1, 0, 0)),
    ]
    pinion = wheel("pinion", 20, 2.0, at=(0, 0, -apex_1), axis=(0, 0, 1), apex=apex_1, width=4.0)
    crown = wheel("wheel", 40, 2.0, at=(-apex_2, 0, 0), axis=(1, 0, 0), apex=apex_2, width=4.0)
    mechanism = with_solids(joints, pinion, crown)
    (found,) = jk.gear_proposals(mechanism)
    assert (found.teeth, found.meshing) == ((20, 40), "bevel")
    # where the pitch cones touch, both wheels have one velocity: there w_1 z x p = w_2 x x p
    turn = ratio(found.coupling, "A.phi", "B.phi")
    touching = np.array([-apex_2, 0.0, -apex_1])
    assert np.cross([0, 0, 1], touching) == pytest.approx(turn * np.cross([1, 0, 0], touching), abs=1e-12)


@pytest.mark.long
def test_a_planetary_set_obeys_willis():
    """With the ring held the carrier turns by s / (s + r) of the sun's angle."""
    sun, planet, ring = 20, 15, 50
    joints = [
        jk.revolute("sun", "ring", "s", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("carrier", "ring", "c", point=(0, 0, 0), axis=(0, 0, -1)),
        jk.revolute("planet", "c", "p", point=(35, 0, 0), axis=(0, 0, 1)),
    ]
    solids = (
        wheel("s", sun, 2.0),
        wheel("p", planet, 2.0, at=(35, 0, 0)),
        wheel("ring", ring, 2.0, ring=60.0),
    )
    mechanism = with_solids(joints, *solids, fixed=("ring",))
    found = jk.gear_proposals(mechanism)
    assert sorted(each.meshing for each in found) == ["external", "internal"]
    motion = mechanism.with_couplings([each.coupling for each in found]).sweep({"sun": np.array([0.0, 0.7])})
    assert motion.coordinates["carrier"][1, 0] == pytest.approx(-0.7 * sun / (sun + ring), abs=1e-12)


def test_proposals_do_not_depend_on_place_unit_and_order():
    rng = np.random.default_rng(3)
    for scale in (1e-3, 1.0, 1e3):
        axis, at = rng.normal(size=3), scale * rng.normal(size=3) * 100
        axis /= np.linalg.norm(axis)
        across = np.cross(axis, [1.0, 0.2, 0.0])
        away = at + 45 * scale * across / np.linalg.norm(across)
        joints = [
            jk.revolute("A", "ground", "one", point=at, axis=axis),
            jk.cylindrical("B", "ground", "other", point=away, axis=-axis),
        ]
        pair = [
            wheel("one", 14, 1.5 * scale, at=at, axis=axis, width=8 * scale),
            wheel("other", 46, 1.5 * scale, at=away, axis=axis, width=8 * scale),
        ]
        for solids in (pair, pair[::-1]):
            (found,) = jk.gear_proposals(with_solids(joints, *solids))
            assert ratio(found.coupling, "A.phi", "B.phi") == pytest.approx(14 / 46)


def test_parts_without_teeth_joints_or_solids_give_none():
    joint = jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1))
    assert jk.gear_proposals(jk.Mechanism.build(fixed=["ground"], joints=[joint])) == ()
    assert (
        jk.gear_proposals(with_solids([joint], wheel("pinion", 20, 2.0), wheel("ground", 40, 2.0, at=(60, 0, 0)))) == ()
    )


def test_a_wheel_beside_its_axis_is_no_gear():
    """A part whose teeth are about another line than the axis of its joint, such as a rack's gear rolled away."""
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "ground", "wheel", point=(60, 0, 0), axis=(0, 0, 1)),
    ]
    for moved in (15.0, 90.0):
        aside = wheel("wheel", 40, 2.0, at=(60, moved, 0))
        assert jk.gear_proposals(with_solids(joints, wheel("pinion", 20, 2.0), aside)) == ()


@pytest.mark.parametrize(("count", "verbose", "listed"), [(0, False, 0), (1, False, 1), (7, False, 5), (7, True, 7)])
def test_inspect_lists_gears_with_teeth_and_ratio_and_few_of_many(capsys, count, verbose, listed):
    joints, solids = [jk.revolute("shaft", "ground", "crank", point=(-500, 0, 0), axis=(0, 0, 1))], []
    for k in range(count):
        joints += [
            jk.revolute(f"A{k}", "ground", f"pinion {k}", point=(0, 200 * k, 0), axis=(0, 0, 1)),
            jk.revolute(f"B{k}", "ground", f"wheel {k}", point=(60, 200 * k, 0), axis=(0, 0, 1)),
        ]
        solids += [wheel(f"pinion {k}", 20, 2.0, at=(0, 200 * k, 0)), wheel(f"wheel {k}", 40, 2.0, at=(60, 200 * k, 0))]
    print_gears(with_solids(joints, *solids), verbose)
    said = capsys.readouterr().out
    assert said.count("(20 teeth)") == said.count("(40 teeth)") == said.count("ratio 2") == listed
    assert ("2 more" in said) == (count > listed)
    assert bool(said) == bool(count)
