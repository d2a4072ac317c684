"""Clearances of bars and solids along a motion, against closed forms, `jk.clashes` and differences."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin import design
from jaxkin.geometry.closest_points import closest_points, signed_distance
from jaxkin.geometry.mesh_elements import Mesh, Points
from reference.drawn_parts import box, loaded
from reference.mechanisms import Z, planar_fourbar

TURN = np.linspace(0.0, 2 * np.pi, 25)
CRANK = ("crank", "A", "B")


def arm(*joints):
    """A part that turns about z on the ground, and what is given beside."""
    return jk.Mechanism.build(
        fixed=["ground"], joints=[jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=Z), *joints]
    )


def test_a_ball_and_a_point():
    """The centre of a ball on an arm goes round a circle of radius 2, a ball on the ground is at (3, 0, 1)."""
    motion = arm().sweep({"A": TURN})
    found = design.clearance(
        motion, design.bar("arm", (2, 0, 0), (2, 0, 0), 0.25), design.bar("ground", (3, 0, 1), (3, 0, 1), 0.5)
    )
    np.testing.assert_allclose(found, np.sqrt(14 - 12 * np.cos(TURN)) - 0.75, atol=1e-14)


def test_bars_that_cross_at_a_height():
    """Of two bars that seem to cross from above the clearance is the height between their axes, less the radii; where
    the end of one is nearest, it is that of a point and a line."""
    motion = arm().sweep({"A": np.radians([30.0, 90.0])})
    bars = design.bar("arm", (0, 0, 2), (4, 0, 2), 0.3), design.bar("ground", (1, -5, 0), (1, 5, 0), 0.4)
    expected = np.array([2.0, np.sqrt(5)]) - 0.7
    np.testing.assert_allclose(design.clearance(motion, *bars), expected, atol=1e-14)
    np.testing.assert_allclose(design.clearance(motion, *bars[::-1]), expected, atol=1e-14)


def test_parallel_bars():
    motion = arm().sweep({"A": [0.0]})
    for start, expected in ((0.0, 1.0), (5.0, np.hypot(1.0, 1.0)), (-2.0, 1.0)):
        other = design.bar("ground", (start, 1, 0), (start + 3, 1, 0))
        found = design.clearance(motion, design.bar("arm", (0, 0, 0), (4, 0, 0)), other)
        np.testing.assert_allclose(found, expected, atol=1e-14)


def test_a_bar_and_a_box():
    """A bar along x above, beside a corner of, and in a cube of side 2 about the origin."""
    cube = design.solid("ground", trimesh.creation.box((2, 2, 2)))
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=[jk.prismatic("S", "ground", "slider", axis=(0, 0, 1))])
    motion = mechanism.sweep({"S": [3.0, 1.5, 0.75, -0.5, 0.0]})
    through = design.clearance(motion, design.bar("slider", (-4, 0, 0), (4, 0, 0), 0.1), cube)
    # the middle of the axis is a sample, and is a half deep at -0.5
    np.testing.assert_allclose(through, np.array([2.0, 0.5, -0.25, -0.5, -1.0]) - 0.1, atol=1e-14)
    beside = design.clearance(motion, design.bar("slider", (2, 2, 1), (3, 2, 1), 0.1), cube)
    np.testing.assert_allclose(beside[:2], np.sqrt(2 + np.array([9.0, 2.25])) - 0.1, atol=1e-14)
    inside = design.clearance(motion, design.bar("slider", (-0.5, 0, 0), (0.5, 0, 0), 0.1), cube)
    np.testing.assert_allclose(inside[2:], -np.array([0.25, 0.5, 1.0]) - 0.1, atol=1e-14)


@pytest.mark.parametrize("seed", [0, 1])
def test_convex_solids_against_a_quadratic_program(seed):
    """The distance of two convex solids is that of the nearest of all weighted means of their corners."""
    from scipy.optimize import nnls

    rng = np.random.default_rng(seed)
    hulls = [trimesh.convex.convex_hull(rng.normal(size=(12, 3))) for _ in range(2)]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=[jk.spherical("S", "ground", "arm", point=(9, 0, 0))])
    motion = mechanism.sweep({f"S.{angle}": rng.uniform(-1.2, 1.2, 6) for angle in ("theta", "phi", "psi")})
    hulls[1].apply_translation((3.5, 0, 0))
    found = design.clearance(motion, design.solid("ground", hulls[0]), design.solid("arm", hulls[1]))
    for pose, place in enumerate(np.asarray(motion.transforms["arm"])):
        corners = hulls[0].vertices, hulls[1].vertices @ place[:3, :3].T + place[:3, 3]
        # both sums of weights are 1: two rows of large weight, which bounds how exact the least squares are
        rows = np.concatenate([corners[0], -corners[1]]).T
        sums = 1e4 * np.repeat(np.eye(2), [len(each) for each in corners], axis=1)
        _, distance = nnls(np.concatenate([rows, sums]), np.array([0, 0, 0, 1e4, 1e4]))
        assert found[pose] == pytest.approx(distance, rel=1e-6) if distance > 1e-3 else found[pose] <= 1e-3


@pytest.mark.long
def test_as_clashes_finds_them(tmp_path):
    """Of drawn solids `jk.clashes` finds the same clearances, and says of the same poses that they clash."""
    solids = {
        "ground": box([3, -1, -1], [5, 1, 1]),
        "arm": box([-0.5, -0.4, -0.4], [4.0, 0.4, 0.4]),
        "slider": trimesh.creation.cylinder(0.7, 3.0, sections=24),
    }
    joints = [
        jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=Z),
        jk.prismatic("S", "ground", "slider", axis=(1, 0, 0)),
    ]
    solids["slider"].apply_translation((-4, 0, 0))
    mechanism = loaded(tmp_path, solids).mechanism(fixed=["ground"], joints=joints)
    motion = mechanism.sweep({"A": TURN, "S": np.linspace(0.0, 2.0, len(TURN))})
    expected = jk.clashes(motion, within=100.0)
    assert len(expected.pairs) == 3
    for pair, row in zip(expected.pairs, expected.clearances, strict=True):
        found = np.asarray(design.clearance(motion, *(design.solid(part, mechanism) for part in pair)))
        np.testing.assert_array_equal(found < 0, row < 0)
        np.testing.assert_allclose(found[row > 0], row[row > 0], rtol=1e-12)
    assert (expected.clearances < 0).any()


@pytest.mark.long
def test_derivatives_are_differences():
    """By a length, by the drive, by an extra variable and by a radius, of bars and of a solid, apart and crossing."""
    mechanism, angles = planar_fourbar(1.0), np.linspace(0.3, 1.5, 7)
    cone = trimesh.creation.cone(0.8, 1.0, sections=7)

    for centre in ((1.7, 1.4, 0.4), (1.2, 0.9, -0.3)):
        obstacle = cone.copy()
        obstacle.apply_translation(centre)
        post = design.solid("ground", obstacle)

        def clearances(given, post=post):
            length, turn, place, radius = given
            motion = mechanism.with_lengths({CRANK: length}).sweep({"A": angles + turn})
            rod = design.bar("coupler", "B", "C", radius)
            tip = design.bar("ground", (2.0, 3.0, 0.2), "tip", 0.1)
            extras = {"tip": jnp.stack([place, 3.0, 0.2])}
            return jnp.stack([design.clearance(motion, rod, each, extras) for each in (post, tip)])

        start = jnp.array([1.1 * float(mechanism.lengths[CRANK]), 0.01, 2.3, 0.05])
        found = jax.jacfwd(clearances)(start)
        assert np.all(np.isfinite(found))
        step = 1e-6
        expected = np.stack(
            [(clearances(start + step * d) - clearances(start - step * d)) / (2 * step) for d in jnp.eye(4)], axis=-1
        )
        # second derivatives times the step, 1e-10 at most but for nearest points that change within it: none here
        np.testing.assert_allclose(found, expected, atol=1e-7)
        backward = jax.jacrev(clearances)(start)
        np.testing.assert_allclose(backward, found, atol=1e-12)


@pytest.mark.long
def test_many_designs_at_once():
    mechanism, angles = planar_fourbar(1.0), np.linspace(0.0, 1.0, 5)
    post = design.solid("ground", trimesh.creation.icosphere(subdivisions=1, radius=0.3))

    def least(length):
        motion = mechanism.with_lengths({CRANK: length}).sweep({"A": angles})
        return design.clearance(motion, design.bar("coupler", "B", "C", 0.1), post)

    lengths = float(mechanism.lengths[CRANK]) * jnp.array([0.9, 1.0, 1.1])
    together = jax.jit(jax.vmap(least))(lengths)
    np.testing.assert_allclose(together, jnp.stack([least(each) for each in lengths]), atol=1e-13)


def test_units_and_placement():
    """Scaled by a thousand and turned as a whole, clearances are a thousand times as large; crossing ones, too."""
    rng = np.random.default_rng(3)
    corners, faces = np.array(trimesh.creation.box((1, 2, 3)).vertices), trimesh.creation.box().faces
    ends = Points(np.arange(8)[:, None].repeat(3, axis=1), np.tile([1.0, 0.0, 0.0], (8, 1)))
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    one, other = (Mesh(corners, edges, faces, ends) for _ in range(2))
    turns = trimesh.transformations.random_rotation_matrix

    def found(scale, whole):
        rng = np.random.default_rng(4)
        places = []
        for _ in range(12):
            place = turns(rng.random(3))
            place[:3, 3] = 2.0 * rng.normal(size=3)
            places.append(place)
        meshes = [each._replace(corners=scale * each.corners) for each in (one, other)]
        first = np.broadcast_to(np.eye(4), (12, 4, 4)).copy()
        second = np.array(places)
        second[:, :3, 3] *= scale
        rigid = [jnp.moveaxis(jnp.asarray(each)[:, :3], 0, -1) for each in (whole @ first, whole @ second)]
        closest = closest_points(*meshes, jnp.moveaxis(jnp.asarray(second)[:, :3], 0, -1))
        return np.asarray(signed_distance(*meshes, (rigid[0], rigid[1]), closest))

    plain = found(1.0, np.eye(4))
    assert (plain < 0).any() and (plain > 0).any()
    whole = turns(rng.random(3))
    whole[:3, 3] = 5e3
    np.testing.assert_allclose(found(1e3, whole), 1e3 * plain, atol=1e-9)


def test_wrong_shapes():
    mechanism = planar_fourbar(1.0)
    motion = mechanism.sweep({"A": [0.0, 0.1]})
    rod, crank = design.bar("coupler", "B", "C"), design.bar("crank", "A", "B")
    cube = trimesh.creation.box()
    for call, said in (
        (lambda: design.clearance(motion, rod, crank), r"both end at the joint 'B', where they always meet"),
        (lambda: design.apart(rod, rod), r"apart: both shapes are of the part 'coupler'"),
        (lambda: design.apart(rod, "crank"), r"shapes are jk\.design\.bar\(\.\.\.\) or jk\.design\.solid"),
        (lambda: design.clearance(motion, rod, design.bar("crnk", "A", "B")), r"no part 'crnk'.*'crank'"),
        (lambda: design.clearance(motion, rod, design.bar("rocker", "A", "D")), r"'A' is between"),
        (lambda: design.clearance(motion, rod, design.bar("rocker", "X", "D")), r"'rocker' has no joint 'X'"),
        (lambda: design.bar("rocker", "C", "D", -1.0), r"bar: radius must be 0 or more"),
        (lambda: design.bar("rocker", (0, 0, np.nan), "D"), r"bar: start: point must be finite numbers"),
        (lambda: design.solid("crank", mechanism), r"no solid of 'crank': solids are those of files"),
        (lambda: design.solid("crank", "crank.stl"), r"or a trimesh\.Trimesh, got str"),
        (lambda: design.solid("crank", cube, hull="yes"), r"hull must be True or False"),
        (lambda: design.solid("crank", trimesh.Trimesh(cube.vertices, cube.faces[1:])), r"do not enclose a volume"),
        (
            lambda: design.solid("crank", trimesh.creation.icosphere(subdivisions=4)),
            r"5,120 triangles, up to 4,000 are compared: write hull=True",
        ),
    ):
        with pytest.raises(ValueError, match=said):
            call()
    balls = [trimesh.creation.icosphere(subdivisions=3) for _ in range(2)]
    with pytest.raises(ValueError, match=r"1,280 and 1,280 triangles, and up to 300,000 pairs"):
        design.clearance(
            motion, *(design.solid(part, ball) for part, ball in zip(("crank", "rocker"), balls, strict=True))
        )
    opened = trimesh.Trimesh(cube.vertices, cube.faces[1:])
    assert np.all(np.isfinite(design.clearance(motion, rod, design.solid("ground", opened, hull=True))))
