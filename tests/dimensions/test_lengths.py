"""Lengths by name: what they are, that changing one leaves all others as they are, and that impossible ones are told.

Tolerance: places follow from lengths by a few roundings of numbers of the size of the mechanism, about 1e-13 of it.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.pose import frame, rotation
from jaxkin.joints.pairs import contact_joint, cylindrical, fixed, planar, prismatic, revolute, screw, spherical
from jaxkin.mechanism.mechanism import Mechanism
from reference.mechanisms import (
    ball_in_bore,
    bennett_linkage,
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    slider_crank,
    spherical_linkage,
)
from reference.planar import fourbar

Z = (0.0, 0.0, 1.0)


def pin(name, part1, part2, x, y):
    return revolute(name, part1, part2, point=(x, y, 0.0), axis=Z)


def six_bar() -> Mechanism:
    """Stephenson's: coupler and ground are triangles, the ground of two parts."""
    at = fourbar(np.array([1.0]))
    b, c = at.crank_pin[0], at.rocker_pin[0]
    return Mechanism.build(
        fixed=["ground", "base"],
        joints=[
            pin("A", "ground", "crank", 0, 0),
            pin("B", "crank", "coupler", *b),
            pin("C", "coupler", "rocker", *c),
            pin("D", "base", "rocker", 100, 0),
            pin("E", "coupler", "rod", *(b + [30, 60])),
            pin("F", "rod", "arm", *(b + [90, 80])),
            pin("G", "base", "arm", 150, -20),
        ],
    )


def platform() -> Mechanism:
    """A part with an axis and three balls, in general position."""
    points = [(30.0, 5.0, 12.0), (-8.0, 40.0, 25.0), (20.0, -30.0, 50.0)]
    return Mechanism.build(
        fixed=["base"],
        joints=[
            revolute("A", "base", "body", point=(1, 2, 3), axis=(0.1, 0.2, 1.0)),
            *(spherical(name, "body", f"leg {name}", point=p) for name, p in zip("PQR", points, strict=True)),
            *(
                spherical(f"{n} foot", f"leg {n}", "base", point=(x, y, -60.0))
                for n, (x, y, _) in zip("PQR", points, strict=True)
            ),
        ],
    )


def others_kept(mechanism, changed, keys):
    return max(abs(changed.lengths[key] - value) for key, value in mechanism.lengths.items() if key not in keys)


def test_lengths_of_a_fourbar_are_its_bars():
    lengths = planar_fourbar(1.0).lengths
    bars = {("ground", "A", "D"): 100.0, ("crank", "A", "B"): 40.0, ("coupler", "B", "C"): 120.0}
    for key, bar in {**bars, ("rocker", "C", "D"): 80.0}.items():
        assert lengths[key] == pytest.approx(bar, rel=1e-14)
    assert all(value == 0 for key, value in lengths.items() if len(key) == 4)  # parallel and in one plane


def test_lengths_of_spatial_links_are_those_that_they_were_built_with():
    bennett = bennett_linkage(0.9, twist=0.7, length=60.0).lengths
    assert bennett["first", "A", "B"] == pytest.approx(60.0)
    assert bennett["first", "A", "B", "angle"] == pytest.approx(0.7)
    assert spherical_linkage(coupler=1.1).lengths["coupler", "B", "C", "angle"] == pytest.approx(1.1)
    found = rssr_linkage().lengths
    assert [found["crank", "A", "B"], found["rod", "B", "C"], found["rocker", "C", "D"]] == pytest.approx([30, 140, 70])


def test_radii_of_contact_surfaces():
    """Contact (b) holds the radius of the cylinder, (d) of the ball, (g) both, (f) the distance of the axes."""
    assert cam(radius=15.0, eccentricity=5.0).lengths["touch", "radius"] == pytest.approx(15.0)
    assert cam(radius=15.0, eccentricity=5.0).lengths["cam", "shaft", "touch"] == pytest.approx(5.0)
    plate, ball = frame(np.zeros(3), np.array(Z)), frame(np.array([3.0, 1.0, 6.0]), np.array(Z))
    across = [
        frame(np.array([0.0, 0.0, -4.0]), np.array([1.0, 0.0, 0.0])),
        frame(np.zeros(3), np.array(Z)),
        frame(np.array([0.0, 0.0, 7.0]), np.array([0.3, 1.0, 0.0])),
    ]
    rolls = [frame(np.zeros(3), np.array(Z)), frame(np.array([0.0, 11.0, 5.0]), np.array(Z))]
    mechanism = Mechanism.build(
        fixed=["base"],
        joints=[
            contact_joint("d", "base", "one", state="d", frames=[plate, ball]),
            contact_joint("g", "base", "two", state="g", frames=across),
            contact_joint("f", "base", "three", state="f", frames=rolls),
            screw("s", "base", "nut", point=(0, 0, 0), axis=Z, pitch=2.5),
        ],
    )
    found = {key: value for key, value in mechanism.lengths.items() if len(key) == 2}
    expected = {("d", "radius"): 6.0, ("g", "radius 1"): 4.0, ("g", "radius 2"): 7.0, ("f", "distance"): 11.0}
    assert found == pytest.approx({**expected, ("s", "pitch"): 2.5})
    larger = mechanism.with_lengths({("g", "radius 1"): 4.5, ("s", "pitch"): 3.0})
    assert larger.lengths["g", "radius 1"] == pytest.approx(4.5)
    assert larger.lengths["s", "pitch"] == 3.0
    assert others_kept(mechanism, larger, [("g", "radius 1"), ("s", "pitch")]) < 1e-13


@pytest.mark.parametrize(
    "build",
    [planar_fourbar, bennett_linkage, slider_crank, spherical_linkage, cardan_shafts, ball_in_bore, rssr_linkage, cam],
)
def test_changing_one_length_leaves_all_others(build):
    mechanism = build()
    for key, value in mechanism.lengths.items():
        if key[-1] == "angle" and (value == 0 or value > 3):
            continue  # offsets are of another kind for axes that are not parallel any more
        changed = mechanism.with_lengths({key: value + 0.1})
        assert changed.lengths[key] == pytest.approx(value + 0.1, abs=1e-12)
        same = [key, (key[0], *key[2:0:-1], "offset")] if key[-1] == "offset" else [key]  # of parallel axes
        assert others_kept(mechanism, changed, same) < 1e-12


@pytest.mark.parametrize(
    "key", [("coupler", "B", "C"), ("coupler", "C", "B"), ("coupler", "E", "B"), ("base", "D", "G")]
)
def test_a_side_of_a_triangle_leaves_the_other_two(key):
    mechanism = six_bar()
    changed = mechanism.with_lengths({key: 70.0})
    row = mechanism.structure.row_of[key[0]]
    listed = (row, *sorted(key[1:]))
    assert changed.lengths[listed] == pytest.approx(70.0, rel=1e-13)
    assert others_kept(mechanism, changed, [listed]) < 1e-12
    moved = {
        joint
        for joint in mechanism.joints
        for side in ("frames_1", "frames_2")
        if not np.array_equal(getattr(mechanism.joints[joint], side), getattr(changed.joints[joint], side))
    }
    assert moved == {key[2]}  # the second one named moves, all others stay


def test_all_sides_of_a_triangle_at_once():
    """One at a time the first change would not fit: 40, 50 and 80 only fit together."""
    changed = six_bar().with_lengths(
        {("coupler", "B", "C"): 80.0, ("coupler", "C", "E"): 40.0, ("coupler", "B", "E"): 50.0}
    )
    assert changed.lengths["coupler", "B", "C"] == pytest.approx(80.0, rel=1e-13)
    assert changed.lengths["coupler", "C", "E"] == pytest.approx(40.0, rel=1e-13)
    assert changed.lengths["coupler", "B", "E"] == pytest.approx(50.0, rel=1e-13)


def test_a_part_with_an_axis_and_three_balls():
    """Balls in general position: three lengths tell where one is, an axis gives two of them."""
    mechanism = platform()
    part = {key: value for key, value in mechanism.lengths.items() if key[0] == "body"}
    assert len(part) == 9 and ("body", "A", "P", "offset") in part
    both = {("body", "A", "P"): part["body", "A", "P"] + 1.0, ("body", "P", "Q"): part["body", "P", "Q"] + 0.5}
    with pytest.raises(ValueError, match="'body' cannot have"):
        mechanism.with_lengths({("body", "P", "Q"): part["body", "P", "Q"] + 1.0})  # 9 lengths, 8 of them independent
    with pytest.raises(ValueError, match="with_points"):
        mechanism.with_lengths(both)


def test_coincident_joints_of_a_part_move_together():
    """Two pins in one hole of a bar: a new length of the bar moves both."""
    mechanism = Mechanism.build(
        fixed=["ground"],
        joints=[
            pin("A", "ground", "bar", 0, 0),
            pin("B", "bar", "left", 3, 4),
            pin("C", "bar", "right", 3, 4),
            pin("D", "ground", "left", -5, 1),
            pin("E", "ground", "right", 9, 2),
        ],
    )
    changed = mechanism.with_lengths({("bar", "A", "B"): 10.0})
    np.testing.assert_allclose(changed.joints["B"].frames_1[0][:3, 3], (6.0, 8.0, 0.0), atol=1e-13)
    np.testing.assert_allclose(changed.joints["C"].frames_1[0][:3, 3], (6.0, 8.0, 0.0), atol=1e-13)
    np.testing.assert_allclose(changed.joints["B"].frames_2[0][:3, 3], (3.0, 4.0, 0.0))
    apart = mechanism.with_lengths({("bar", "B", "C"): 1.0})  # coaxial: along x of the first one's frame
    assert apart.lengths["bar", "B", "C"] == pytest.approx(1.0)
    assert apart.lengths["bar", "A", "C"] == pytest.approx(5.0)


@pytest.mark.parametrize("turn", [rotation(np.array([0.6, 0.0, 0.8]), 0.7)])
def test_planes_slides_and_pins(turn):
    """A block on a plane with a pin and a slide, turned in space: distances from the plane along its normal."""
    place = lambda *x: turn @ np.array(x, float)  # noqa: E731
    mechanism = Mechanism.build(
        fixed=["table"],
        joints=[
            planar("on", "table", "block", normal=place(0, 0, 1), point=place(0, 0, 2)),
            spherical("ball", "block", "foot", point=place(4, 1, 7)),
            cylindrical("pin", "foot", "table", point=place(5, 5, 0), axis=place(0, 0, 1)),
            prismatic("slide", "foot", "cart", axis=place(1, 0, 0), point=place(0, 0, 3)),
            fixed("glue", "cart", "box"),
        ],
    )
    assert mechanism.lengths["block", "on", "ball"] == pytest.approx(5.0)
    assert mechanism.lengths["foot", "ball", "pin"] == pytest.approx(np.hypot(1, 4))
    higher = mechanism.with_lengths({("block", "on", "ball"): -2.0})  # behind the plane
    assert higher.lengths["block", "on", "ball"] == pytest.approx(-2.0)
    assert others_kept(mechanism, higher, [("block", "on", "ball")]) < 1e-12
    assert not any("glue" in key for key in mechanism.lengths)


@pytest.mark.long
def test_lengths_inside_jit_vmap_and_grad():
    """The law of cosines: moving C about B and E by the side B C, first and second derivatives, a thousand at once."""
    mechanism = six_bar()
    key = ("coupler", "B", "C")

    def place(side):
        return mechanism.with_lengths({key: side}).joints["C"].frames_1[0, :2, 3]

    be, ce = mechanism.lengths["coupler", "B", "E"], mechanism.lengths["coupler", "C", "E"]
    b, e, c = (np.asarray(mechanism.joints[name].frames_1[0, :2, 3]) for name in "BEC")
    along = (e - b) / be
    across = np.array([-along[1], along[0]]) * np.sign(along[0] * (c - b)[1] - along[1] * (c - b)[0])

    def closed(side):
        foot = (side**2 + be**2 - ce**2) / (2 * be)
        return b + foot * along + jnp.sqrt(side**2 - foot**2) * across

    sides = jnp.linspace(80.0, 130.0, 1000)
    np.testing.assert_allclose(jax.jit(jax.vmap(place))(sides), jax.vmap(closed)(sides), atol=1e-12)

    def slopes(function, side):
        """Of first order in either mode, and of second order."""
        return [mode(function)(side) for mode in (jax.jacfwd, jax.jacrev, lambda f: jax.jacfwd(jax.jacrev(f)))]

    for found, expected in zip(jax.jit(lambda side: slopes(place, side))(118.0), slopes(closed, 118.0), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-9)
    spoilt = jax.jit(lambda side: mechanism.with_lengths({key: side}).joints["C"].frames_1)(400.0)
    assert np.all(np.isnan(spoilt))  # the triangle cannot be: no number is better than a wrong one


@pytest.mark.long
def test_frames_and_points_on_both_parts_or_on_one():
    mechanism = planar_fourbar(1.0)
    both = mechanism.with_points({"D": (110.0, 0.0, 0.0)})
    assert both.lengths["ground", "A", "D"] == pytest.approx(110.0)
    assert both.lengths["rocker", "C", "D"] != pytest.approx(80.0)
    one = mechanism.with_points({("ground", "D"): (110.0, 0.0, 0.0)})
    assert one.lengths["ground", "A", "D"] == pytest.approx(110.0)
    assert others_kept(mechanism, one, [("ground", "A", "D")]) == 0
    pose = np.eye(4)
    pose[:3, 3] = (110.0, 0.0, 0.0)
    assert mechanism.with_frames({("ground", "D"): pose}).lengths == one.lengths
    slope = jax.grad(
        lambda x: mechanism.with_points({("ground", "D"): jnp.array([x, 0.0, 0.0])}).lengths["ground", "A", "D"]
    )
    assert slope(110.0) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({("couplr", "B", "C"): 1.0}, "no part 'couplr'; did you mean 'coupler'"),
        ({("coupler", "B", "Q"): 1.0}, "no joint 'Q'"),
        ({("coupler", "B", "D"): 1.0}, r"of 'coupler' there are: \('coupler', 'B', 'C'\)"),
        ({"coupler": 1.0}, "a length is named by a part and two of its joints"),
        ({("coupler", "B", "C"): -1.0}, "must not be negative, got -1.0"),
        ({("coupler", "B", "C"): float("nan")}, "must be a finite number"),
        ({("coupler", "B", "C"): "long"}, "must be a number, got 'long'"),
        ({("coupler", "B", "C"): [1.0, 2.0]}, r"must be one number, got an array of shape \(2,\)"),
        ({("coupler", "B", "C", "angle"): 4.0}, "between 0 and pi"),
        ({("coupler", "B", "C"): 90.0, ("coupler", "C", "B"): 90.0}, "are the same"),
        ({("coupler", "B", "C"): 400.0}, "'coupler' cannot have .* 400"),
    ],
)
def test_bad_lengths(changes, said):
    with pytest.raises(ValueError, match=said):
        six_bar().with_lengths(changes)


def test_bad_points_and_frames():
    mechanism = planar_fourbar(1.0)
    with pytest.raises(ValueError, match="no joint 'E'"):
        mechanism.with_points({"E": (0, 0, 0)})
    with pytest.raises(ValueError, match="between 'ground' and 'rocker', not on 'crank'"):
        mechanism.with_points({("crank", "D"): (0, 0, 0)})
    with pytest.raises(ValueError, match="three finite numbers"):
        mechanism.with_points({"D": (0, 0)})
    with pytest.raises(ValueError, match="no rigid pose"):
        mechanism.with_frames({"D": 2 * np.eye(4)})
    with pytest.raises(ValueError, match=r"has 2 frames: say on which part, as \('follower', 'touch'\)"):
        cam().with_points({"touch": (0, 0, 0)})
    with pytest.raises(ValueError, match=r"radius .* must be positive"):
        cam().with_lengths({("touch", "radius"): 0.0})
