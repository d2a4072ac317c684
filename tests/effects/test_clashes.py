"""Clashes held to drawn parts whose overlap is known, and clearances to distances of sampled points."""

from dataclasses import replace

import jax
import numpy as np
import pytest
import trimesh
from scipy.spatial import KDTree

import jaxkin as jk
from jaxkin.effects import clash_progress
from jaxkin.effects.clash_shapes import clash_parts, displaced
from jaxkin.effects.invariant_faces import invariant
from jaxkin.examples import EXAMPLES, path
from reference.drawn_parts import box, loaded

ROUNDING = 1e-12
"""Of coordinates up to 100: corners are whole numbers, which STL holds exactly, and faces that touch none are flat."""


def by_hand(folder, parts, joints):
    """A mechanism of drawn parts whose joints are said, the first part at rest."""
    first = next(iter(parts))
    return loaded(folder, parts).mechanism(fixed=[first], joints=joints)


def pair_of(found, *names):
    (pair,) = [k for k, each in enumerate(found.pairs) if {*each} == {*names}]
    return pair


@pytest.mark.long
def test_a_slider_runs_into_a_wall(tmp_path):
    """The wall begins 10 ahead of the slider: free before, and as deep in it as it has gone on from there."""
    parts = {"wall": box([30, -20, -20], [60, 20, 20]), "slider": box([0, -5, -4], [20, 5, 4])}
    slide = jk.prismatic("slide", "wall", "slider", axis=(1, 0, 0))
    shift = np.arange(0.5, 20, 1.0)
    found = jk.clashes(by_hand(tmp_path, parts, [slide]).sweep({"slide": shift}), within=5)
    clear = 10 - shift
    # deeper than half its height the slider is nearest to the wall's front all the same: 30 deep, 20 wide
    np.testing.assert_allclose(found.clearances[0], np.where(clear > 5, np.inf, clear), atol=ROUNDING)
    assert found.first == (10, 0) and found.pairs == (("wall", "slider"),)
    assert "first at pose 10 (10.5 mm): wall - slider, 0.5 mm deep" in str(found)
    np.testing.assert_allclose(found.depths[0], np.maximum(-clear, 0), atol=ROUNDING)


def test_two_bars_that_cross_have_no_corner_in_each_other(tmp_path):
    """A bar, 10 high, is lowered into another one, 10 high too, across it: middles of edges tell how deep."""
    parts = {"base": box([-50, -4, 0], [50, 4, 10]), "bar": box([-4, -50, 11], [4, 50, 21])}
    lift = jk.prismatic("lift", "base", "bar", axis=(0, 0, -1))
    down = np.array([0.0, 0.5, 1.5, 3.0, 4.5])
    found = jk.clashes(by_hand(tmp_path, parts, [lift]).sweep({"lift": down}))
    # the lower edges of the bar are in the base by `down - 1`, and 4 from its sides in their middle
    np.testing.assert_allclose(found.clearances[0], [1.0, 0.5, -0.5, -2.0, -3.5], atol=1e-5)


def test_what_may_pass_between_two_poses_is_told(tmp_path):
    """A slider, 10 long, passes a wall, 2 thick: poses 40 apart are free of it, and nearer ones are not."""
    parts = {"wall": box([50, 0, 0], [52, 20, 10]), "slider": box([0, 5, -1], [10, 15, 8])}
    slide = jk.prismatic("slide", "wall", "slider", axis=(1, 0, 0))
    mechanism = by_hand(tmp_path, parts, [slide])

    def along(shift):
        return jk.clashes(mechanism.sweep({"slide": np.asarray(shift, float)}))

    far = along([0, 40, 80, 120])
    assert not far.clashing.any()
    np.testing.assert_allclose(far.step, 40, rtol=1e-12)
    assert "between two poses parts move by up to 40 mm" in str(far)
    assert along(np.arange(0, 120, 4)).clashing.any()
    # 20 to 22 before the wall, in steps of 1: it cannot pass; where no clearance is measured that is not known
    before = mechanism.sweep({"slide": np.array([18.0, 19.0, 20.0])})
    assert "between two poses" not in str(jk.clashes(before, within=25.0))
    assert "between two poses" in str(jk.clashes(before, within=0))


def turning(folder):
    """An arm that turns past a ball and a post on a table, at changing distance."""
    ball = trimesh.creation.icosphere(3, radius=6.0)
    ball.apply_translation([32, 10, 9])
    post = box([-30, 14, 0], [-22, 30, 12])
    parts = {"table": box([-60, -60, -5], [60, 60, 0]), "arm": box([-4, -3, 2], [29, 3, 7]), "ball": ball, "post": post}
    joints = [
        jk.revolute("turn", "table", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.fixed("ball on it", "table", "ball"),
        jk.fixed("post on it", "table", "post"),
    ]
    return parts, by_hand(folder, parts, joints)


@pytest.mark.long
def test_clearances_are_the_distances_of_sampled_points(tmp_path):
    parts, mechanism = turning(tmp_path)
    angle = np.linspace(0, 2 * np.pi, 25)
    found = jk.clashes(mechanism.sweep({"turn": angle}), within=40)
    spacing = 0.6
    points = {name: trimesh.sample.sample_surface_even(mesh, 20000, seed=1)[0] for name, mesh in parts.items()}
    for other in ("ball", "post"):
        tree, pair = KDTree(points[other]), pair_of(found, "arm", other)
        compared = 0
        for a, clearance in zip(angle, found.clearances[pair], strict=True):
            turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
            sampled = tree.query(points["arm"] @ turn.T)[0].min()
            if clearance < 0:
                assert sampled < spacing
            elif np.isfinite(clearance):
                compared += 1
                # points are farther apart than surfaces, by no more than their spacing; coordinates in float32
                assert clearance - 1e-4 <= sampled <= clearance + spacing
        assert compared > 10
    # the arm is parallel to the table and 2 over it
    np.testing.assert_allclose(found.clearances[pair_of(found, "arm", "table")], 2.0, atol=1e-5)


def test_the_depth_is_that_of_sampled_points(tmp_path):
    """The deepest sampled point of either part in the other is as deep as told, but for the spacing of the points."""
    parts, mechanism = turning(tmp_path)
    angle = np.linspace(0.1, 0.5, 9)
    found = jk.clashes(mechanism.sweep({"turn": angle}))
    pair = pair_of(found, "arm", "ball")
    assert found.clashing[pair].sum() >= 5
    samples = trimesh.sample.sample_surface_even(parts["arm"], 20000, seed=1)[0]
    on_ball = trimesh.sample.sample_surface_even(parts["ball"], 20000, seed=1)[0]
    for a, clearance in zip(angle, found.clearances[pair], strict=True):
        turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
        in_ball = 6 - np.linalg.norm(samples @ turn.T - [32, 10, 9], axis=1)
        at = on_ball @ turn - [12.5, 0, 4.5]
        in_arm = (np.array([16.5, 3, 2.5]) - np.abs(at)).min(axis=1)
        deepest = max(in_ball.max(), in_arm.max(), 0.0)
        # corners of the ball's triangles are 0.9 apart
        assert deepest - 0.5 <= max(-clearance, 0.0) <= deepest + 0.1


@pytest.mark.long
@pytest.mark.parametrize("one_part", [False, True])
def test_a_pin_in_its_hole_is_no_clash_but_through_a_wall_it_is(tmp_path, one_part):
    """The pin, from 0 to 60, turns and slides in its bush and meets a wall at 75, of the same part or of another one.

    Pin and bush have chords of their own, which overlap.
    """
    pin = trimesh.creation.cylinder(5, segment=[[0, 0, 0], [0, 0, 60]], sections=40)
    bush = trimesh.creation.annulus(5, 10, segment=[[0, 0, 20], [0, 0, 30]], sections=64)
    wall = box([-20, -20, 75], [20, 20, 95])
    parts = {"bush": bush + wall, "pin": pin} if one_part else {"bush": bush, "pin": pin, "wall": wall}
    mechanism = loaded(tmp_path, parts).mechanism(fixed=[name for name in parts if name != "pin"])
    (name,) = [joint.name for joint in mechanism.all_joints if joint.freedoms]
    shift = np.arange(-30.0, 22.0, 2.0)
    motion = mechanism.sweep({f"{name}.z": shift, f"{name}.phi": 0.05 * shift})
    found = jk.clashes(motion, within=4)
    own, far = pair_of(found, "bush", "pin"), pair_of(found, "pin", "bush" if one_part else "wall")
    assert found.joined[own] and found.joined[far] == one_part
    along = np.asarray(motion.points("pin", (0, 0, 60)))[:, 2] - 75
    # the end of the pin is nearest to the front of the wall, which is deeper than the pin gets
    expected = -np.maximum(along, 0) if one_part else np.where(along < -4 - 1e-3, np.inf, -along)
    np.testing.assert_allclose(found.clearances[far], expected, atol=ROUNDING)
    assert np.any(along > 0) and found.first is not None and found.first[1] == far
    if not one_part:
        np.testing.assert_array_equal(found.clearances[own], 0.0)


def test_what_turns_about_its_own_axis_is_compared_once_and_the_rest_at_all_poses(tmp_path):
    """A pin with a handle turns in its bush, which has a post at 90 degrees: the handle hits the post, the pin nothing.

    The handle, 4 wide, and the post, 6 wide, are as far apart as their corners and sides are.
    """
    pin = trimesh.creation.cylinder(5, segment=[[0, 0, 0], [0, 0, 40]], sections=48)
    handle = box([-2, -2, 41], [30, 2, 46])
    bush = trimesh.creation.annulus(5, 10, segment=[[0, 0, 5], [0, 0, 30]], sections=64)
    post = box([-3, 20, 5], [3, 26, 50])
    mechanism = loaded(tmp_path, {"bush": bush + post, "pin": pin + handle}).mechanism(fixed=["bush"])
    (joint,) = mechanism.all_joints
    turning = np.linspace(0, 2 * np.pi, 73)
    motion = mechanism.sweep({f"{joint.name}.z": np.zeros(73), f"{joint.name}.phi": turning})
    found = jk.clashes(motion)
    assert found.joined.all()
    ahead = np.asarray(motion.points("pin", (1, 0, 0)))
    angle = np.arctan2(ahead[:, 1], ahead[:, 0])  # the axis of the joint may point either way
    # pin, bush and nothing else keep their place, and were free at the first pose
    parts = clash_parts(mechanism.solids)
    shapes = [each.shape for each in parts]
    moved = displaced(*parts, *(np.asarray(motion.transforms[part.name]) for part in mechanism.solids))
    ignored = invariant(*shapes, moved, 1e-6)
    rows = ignored.all(axis=1), ignored.all(axis=0)
    kept = [shape.part.faces[k].surface for shape, row in zip(shapes, rows, strict=True) for k in np.flatnonzero(row)]
    assert sorted(surface.radius for surface in kept) == pytest.approx([5, 5, 10])
    # the handle's edge nearest to the post is its end's corner, at 30 and 2 from the axis, or its side
    away = angle - np.pi / 2
    corners = np.array([[30, 2], [30, -2], [-2, 2], [-2, -2]])
    expected = []
    for a in away:
        turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        handle_2d, post_2d = corners @ turn.T, np.array([[20, -3], [20, 3], [26, -3], [26, 3]])
        axes = [*turn.T, [1, 0], [0, 1]]
        gaps = [
            max((handle_2d @ n).min() - (post_2d @ n).max(), (post_2d @ n).min() - (handle_2d @ n).max()) for n in axes
        ]
        expected.append(max(gaps) < 0)
    np.testing.assert_array_equal(found.clashing[0], expected)
    assert 3 < np.sum(expected) < 30


def test_a_part_inside_of_another_is_a_clash(tmp_path):
    """Between two poses the cube, 4 wide, has come into the block without that their surfaces cross at either."""
    parts = {"block": box([-20, -20, -20], [20, 20, 20]), "cube": box([28, -2, -2], [32, 2, 2])}
    slide = jk.prismatic("slide", "block", "cube", axis=(-1, 0, 0))
    found = jk.clashes(by_hand(tmp_path, parts, [slide]).sweep({"slide": np.array([0.0, 15.0, 30.0])}), within=100)
    np.testing.assert_allclose(found.clearances[0], [8.0, -7.0, -18.0], atol=ROUNDING)


def test_two_parts_in_the_same_place_are_a_clash(tmp_path):
    """All faces coincide, none crosses another, and no corner is inside: a point in the middle tells."""
    parts = {"block": box([-2, -2, -2], [2, 2, 2]), "twin": box([18, -2, -2], [22, 2, 2])}
    slide = jk.prismatic("slide", "block", "twin", axis=(-1, 0, 0))
    found = jk.clashes(by_hand(tmp_path, parts, [slide]).sweep({"slide": np.array([0.0, 20.0])}), within=30)
    np.testing.assert_array_equal(found.clashing[0], [False, True])
    assert 1 < found.depths[0, 1] <= 2


@pytest.mark.long
@pytest.mark.parametrize("name", ["cam", "fourbar"])
def test_shipped_assemblies_do_not_clash(name, tmp_path):
    example = EXAMPLES[name]
    mechanism = jk.load(path(name)).mechanism(fixed=example.fixed)
    (driven,) = mechanism.joints_between(*example.drive)
    found = jk.clashes(mechanism.sweep({driven: np.linspace(0, 2 * np.pi, 37)}))
    assert not found.clashing.any() and found.first is None and found.joined.any()
    assert found.plot(tmp_path / "clashes.png").stat().st_size > 1000
    assert len(found.save(tmp_path / "clashes.csv").read_text().splitlines()) == 38
    if name == "fourbar":  # drawn: layers are half a millimetre apart
        assert found.clearances[pair_of(found, "ground", "coupler")].min() == pytest.approx(0.5, abs=1e-4)


def test_poses_that_are_not_closed_are_nan_and_pairs_can_be_left_out(tmp_path):
    _, mechanism = turning(tmp_path)
    motion = mechanism.sweep({"turn": np.array([0.0, 0.3, 0.3])})
    cut = replace(motion, status=jax.numpy.array([0, 0, 1]) + motion.status[0])
    found = jk.clashes(cut)
    assert np.isnan(found.clearances[:, 2]).all() and not np.isnan(found.clearances[:, :2]).any()
    assert found.first == (1, pair_of(found, "arm", "ball"))
    assert jk.clashes(cut, ignore=[["ball", "arm"]]).first is None
    assert jk.clashes(cut, tolerance=20).first is None
    assert np.isinf(jk.clashes(cut, within=0).least[0])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"within": -1}, "within must be a length, zero or more"),
        ({"ignore": ["arm"]}, r"pairs of parts, \[\['bolt', 'plate'\]\], got the entry 'arm'"),
        ({"ignore": [["arm", "bal"]]}, "unknown part 'bal'.*'ball'"),
    ],
)
def test_wrong_words_are_refused(tmp_path, given, said):
    _, mechanism = turning(tmp_path)
    with pytest.raises(ValueError, match=said):
        jk.clashes(mechanism.sweep({"turn": np.array([0.0])}), **given)


def test_a_mechanism_without_solids_says_what_to_do():
    slide = jk.prismatic("slide", "base", "slider", axis=(1, 0, 0))
    motion = jk.Mechanism.build(fixed=["base"], joints=[slide]).sweep({"slide": np.array([0.0, 1.0])})
    with pytest.raises(ValueError, match=r"clashes needs solids, .* make it from files, jk\.load"):
        jk.clashes(motion)
    for effect in (jk.clashes, jk.contact_validity):
        with pytest.raises(ValueError, match=r"those of a motion, mechanism\.sweep\(drive\), got Mechanism"):
            effect(motion.mechanism)


@pytest.mark.long
def test_joints_by_hand_hold_what_they_keep_on_each_other(tmp_path):
    """A pin and its hole touch by design whether their joint was found or is written in a study: nothing is nearest."""
    mechanism = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    jk.write_study(mechanism, tmp_path / "study.toml", geometry=str(path("fourbar")))
    by_hand = jk.load_study(tmp_path / "study.toml").mechanism
    assert not by_hand.contacts
    (drive,) = mechanism.mobility().drivable[:1]
    angles = np.linspace(0, 6, 5)
    found, of_study = (jk.clashes(each.sweep({drive: angles}), within=3.0) for each in (mechanism, by_hand))
    assert of_study.pairs == found.pairs and found.joined.sum() == 4
    np.testing.assert_array_equal(of_study.joined, found.joined)
    # joints of the study have ten digits
    np.testing.assert_allclose(of_study.clearances, found.clearances, atol=1e-6)


def test_a_search_tells_how_far_it_is_and_what_would_take_less(tmp_path, monkeypatch):
    parts = {"base": box([-50, -4, 0], [50, 4, 10]), "bar": box([-4, -50, 11], [4, 50, 21])}
    lift = jk.prismatic("lift", "base", "bar", axis=(0, 0, 1))
    mechanism = by_hand(tmp_path, parts, [lift])
    motion = mechanism.sweep({"lift": np.linspace(0, 1, 7)})
    told = []
    plain = jk.clashes(motion, progress=lambda *done: told.append(done))
    assert told == [(7, 7)]
    monkeypatch.setattr(clash_progress, "_LONG", -1.0)
    with pytest.warns(UserWarning, match="fewer poses take as much less, .* within=0 finds clashes only") as warned:
        again = jk.clashes(motion, progress=False)
    assert warned[0].filename == __file__
    np.testing.assert_array_equal(again.clearances, plain.clearances)
    with pytest.warns(UserWarning, match=r"7 placements .* ignore=\[\[part, part\]\]$"):
        jk.clashes(mechanism.sweep({"lift": np.linspace(-3, -2, 7)}), within=0)
