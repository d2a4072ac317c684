"""A point or a ball on a surface against closed forms: plane, sphere, torus and paraboloid, each lifted by a slide.

An arm turns about z and carries the point, or the centre of the ball, around a circle of radius ARM; a table with the
surface slides along z, and is lifted to where the surface meets the point.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
ARM, START = 20.0, 0.3
TURN = np.linspace(0.0, 4 * np.pi, 49)


def carried(angle, xp=np):
    return ARM * xp.cos(angle + START), ARM * xp.sin(angle + START)


def lifted(points, height, *, turned=False, **more):
    """The mechanism, with the point at a height over z = 0 as assembled."""
    surface = jk.point_on_surface("contact", "table", "arm", surface=points, point2=(*carried(0.0), height), **more)
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "arm", point=(0, 0, 0), axis=Z),
            jk.prismatic("lift", "table", "ground", axis=(0, 0, -1))
            if turned
            else jk.prismatic("lift", "ground", "table", axis=Z),
            surface,
        ],
        unit="mm",
    )


def lift_of(motion):
    return np.asarray(motion.coordinates["lift"])[:, 0]


def plane(u, v):
    return u, v, 0.3 * u - 0.2 * v


def bowl(u, v):
    return u, v, (u * u + 0.5 * v * v) / 60


def ball(u, v, radius=30.0):
    return radius * np.cos(v) * np.cos(u), radius * np.cos(v) * np.sin(u), radius * np.sin(v)


def torus(u, v, ring=24.0, tube=10.0):
    far = ring + tube * np.cos(v)
    return far * np.cos(u), far * np.sin(u), tube * np.sin(v)


FULL = (0.0, 2 * np.pi)


@pytest.mark.long
def test_a_plane_is_exact():
    points = jk.surface_points(plane, (-30, 30), (-25, 25), samples=(6, 5))
    height = plane(*carried(0.0))[2]
    motion = lifted(points, height).sweep({"shaft": TURN}, throw=True)
    wanted = height - plane(*carried(TURN))[2]
    np.testing.assert_allclose(lift_of(motion), wanted, atol=1e-12)  # rounding of 30 mm
    found = motion.mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms) == (1, 0)
    assert jk.curve_contacts(motion).holds and "lost" not in str(motion)
    # coordinates are lengths along the rows, that of u in a plane with the slope 0.3
    u = (carried(TURN)[0] - carried(0.0)[0]) * np.hypot(1, 0.3)
    np.testing.assert_allclose(motion.coordinates["contact"][:, 0], u, atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("turned", [False, True])
def test_a_ball_on_a_sphere_stays_at_the_sum_of_the_radii(turned):
    """The centre of the sphere beside the shaft: the contact goes around it, and u gains a whole length each turn."""
    radius, centre = 6.0, np.array([3.0, -2.0])
    points = jk.surface_points(ball, FULL, (0.3, 1.2), closed=(True, False), samples=(160, 60))

    def height(angle):
        x, y = carried(angle)
        return np.sqrt((30.0 + radius) ** 2 - (x - centre[0]) ** 2 - (y - centre[1]) ** 2)

    mechanism = lifted(points, height(0.0), turned=turned, radius=radius, closed=(True, False), point=(*centre, 0.0))
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    # the spline is off by R h^4 / 384 = 2e-7 with h = 2 pi / 160, and more at the ends of v
    np.testing.assert_allclose(lift_of(motion), height(0.0) - height(TURN), atol=1e-6)
    patch = mechanism.joints["contact"].splines[0]
    turned_by = np.asarray(motion.coordinates["contact"])[-1, :2]
    np.testing.assert_allclose(turned_by, [2 * float(patch.knots_u[-1]), 0.0], atol=1e-9)
    contact = jk.curve_contacts(motion).contacts[0]
    np.testing.assert_allclose(contact.curvature, 1 / 30.0, rtol=1e-3)  # curvatures are right to the second order
    np.testing.assert_allclose(contact.clearance, 1 + radius / 30.0, rtol=1e-3)
    assert contact.what == "a ball" and not contact.lost.any()


@pytest.mark.long
@pytest.mark.parametrize("outside", [True, False])
def test_a_ball_in_and_on_a_torus(outside):
    """Closed along both; the centre is the sum, or the difference, of the radii from the circle of the ring."""
    radius, centre, tube = 3.0, 2.0, 10.0
    far = tube + radius if outside else tube - radius
    points = jk.surface_points(torus, FULL, FULL, closed=(True, True), samples=(96, 64))

    def height(angle):
        x, y = carried(angle)
        return np.sqrt(far**2 - (np.hypot(x - centre, y) - 24.0) ** 2)

    mechanism = lifted(points, height(0.0), radius=radius, closed=(True, True), point=(centre, 0.0, 0.0))
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    np.testing.assert_allclose(lift_of(motion), height(0.0) - height(TURN), atol=5e-6)  # 34 (2 pi / 96)^4 / 384 = 2e-6
    found = jk.curve_contacts(motion)
    assert found.holds and len(found.contacts) == 2
    np.testing.assert_array_equal([each.beyond.max() for each in found.contacts], 0.0)


@pytest.mark.long
def test_a_paraboloid_to_the_fourth_order():
    errors, told = [], []
    for count in (21, 41, 81):
        points = jk.surface_points(bowl, (-35, 35), (-35, 35), samples=(count, count))
        mechanism = lifted(points, bowl(*carried(0.0))[2])
        motion = mechanism.sweep({"shaft": TURN[:25]}, throw=True)
        errors.append(np.abs(lift_of(motion) - bowl(*carried(0.0))[2] + bowl(*carried(TURN[:25]))[2]).max())
        told.append(dict(mechanism.joints["contact"].evidence.sizes)["between points"])
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 3.5), errors
    # what is told is an estimate of the largest error anywhere: above what the circle meets, and not far above
    assert np.all((np.array(told) > 0.3 * np.array(errors)) & (np.array(told) < 10 * np.array(errors))), (told, errors)


@pytest.fixture(scope="module")
def on_bowl():
    """With as many points as the last of those above: one program serves both."""
    points = jk.surface_points(bowl, (-35, 35), (-35, 35), samples=(81, 81))
    return lifted(points, bowl(*carried(0.0))[2])


@pytest.mark.long
def test_velocities_accelerations_and_derivatives(on_bowl):
    motion = on_bowl.sweep({"shaft": TURN[:25:3]}, throw=True)
    height = lambda angle: -bowl(*carried(angle, jnp))[2]  # noqa: E731
    first, second = jax.vmap(jax.grad(height)), jax.vmap(jax.grad(jax.grad(height)))
    angle, speed = jnp.asarray(TURN[:25:3]), 3.0
    # slopes of the spline are right to the third order, bends to the second, of 0.9 mm between points over the least
    # radius of curvature, 30 mm
    spacing, slopes, bends = 0.9 / 30.0, speed * first(angle), speed**2 * second(angle)
    found = [rates(motion, {"shaft": speed}).coordinates["lift"][:, 0] for rates in (jk.velocities, jk.accelerations)]
    np.testing.assert_allclose(found[0], slopes, atol=float(jnp.abs(slopes).max()) * spacing**3)
    np.testing.assert_allclose(found[1], bends, atol=float(jnp.abs(bends).max()) * spacing**2)

    def total(points):
        moved = on_bowl.with_points({("contact", "surface"): points})
        return jnp.sum(moved.sweep({"shaft": TURN[:25:3]}).coordinates["lift"])

    points = np.asarray(on_bowl.joints["contact"].curves[0].points)
    way = np.random.default_rng(0).normal(size=points.shape)
    found = float(jnp.sum(jax.grad(total)(jnp.asarray(points)) * way))
    step = 1e-5
    difference = float(total(points + step * way) - total(points - step * way)) / (2 * step)
    assert found == pytest.approx(difference, rel=1e-6)  # rounding over the step, and its square


@pytest.mark.long
def test_saved_and_read_again_and_assembled_elsewhere(on_bowl, tmp_path):
    motion = on_bowl.sweep({"shaft": TURN[:25]}, throw=True)
    on_bowl.save(tmp_path / "bowl.json")
    again = jk.load(tmp_path / "bowl.json").mechanism().sweep({"shaft": TURN[:25]}, throw=True)
    np.testing.assert_array_equal(again.coordinates["contact"], motion.coordinates["contact"])
    there = on_bowl.at(motion, 7)
    moved = there.sweep({"shaft": TURN[:18]}, throw=True)
    np.testing.assert_allclose(lift_of(moved), lift_of(motion)[7:] - lift_of(motion)[7], atol=1e-11)
    low, high = there.joints["contact"].limits[0]
    u = float(motion.coordinates["contact"][7, 0])
    before = on_bowl.joints["contact"].limits[0]
    np.testing.assert_allclose([low, high], [before[0] - u, before[1] - u], atol=1e-12)


@pytest.mark.long
def test_the_edge_of_a_surface_is_told():
    points = jk.surface_points(bowl, (-35, 19.5), (-35, 35), samples=(41, 41))
    mechanism = lifted(points, bowl(*carried(0.0))[2])
    motion = mechanism.sweep({"shaft": -np.linspace(0, 0.3, 7)})
    found = jk.curve_contacts(motion)
    along_u, along_v = found.contacts
    assert not found.holds and along_u.lost.any() and not along_v.lost.any()
    assert "leaves the end of its surface along u" in str(motion)
    x = carried(-np.linspace(0, 0.3, 7))[0]
    np.testing.assert_array_equal(along_u.beyond > 0, x > 19.5)


@pytest.mark.long
def test_a_ball_larger_than_a_hollow_is_told():
    """In a trough z = x^2 / 60 a ball of radius 40 comes down one wall, and meets the other one at the middle.

    The contact at x = u, where the wall rises by tan a = u / 30, has the centre at u - 40 sin a.
    """
    radius, u = 40.0, np.array([35.0, 30.0, 24.0, 20.0, 16.0])
    steep = np.hypot(30.0, u)
    x, z = u - radius * u / steep, u**2 / 60 + radius * 30.0 / steep
    points = jk.surface_points(lambda u, v: (u, v, u * u / 60), (-60, 60), (-60, 60), samples=(121, 5))
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.prismatic("drive", "ground", "slide", axis=(1, 0, 0)),
            jk.prismatic("across", "slide", "block", axis=(0, 0, 1)),
            jk.point_on_surface("contact", "ground", "block", surface=points, point2=(x[0], 0, z[0]), radius=radius),
        ],
    )
    motion = mechanism.sweep({"drive": x - x[0]}, throw=True)
    np.testing.assert_allclose(motion.coordinates["across"][:, 0], z - z[0], atol=1e-6)  # the spline: 1 mm a point
    found = jk.curve_contacts(motion)
    contact = found.contacts[0]
    # 1 - radius times the curvature of the parabola, which the spline has to the second order of 1 mm over 30
    np.testing.assert_allclose(contact.clearance, 1 - radius * 30.0**2 / steep**3, atol=(1 / 30) ** 2)
    fine = np.linspace(-60, 60, 100_001)
    apart = np.hypot(fine - x[:, None], fine**2 / 60 - z[:, None]).min(axis=1)
    # the surface is looked at four times a piece: 0.1 mm off along it, its square over 8 times the radius
    np.testing.assert_allclose(contact.depth, radius - apart, atol=2e-3)
    np.testing.assert_array_equal(contact.depth > 0, x < 0)
    assert "would have a ball pass through the surface" in str(found) and not found.holds


GRID = jk.surface_points(bowl, (-35, 35), (-35, 35), samples=(6, 6))
LINE = jk.surface_points(lambda u, v: (14 * u + 9 * v, 0, 0), (0, 5), (0, 5), samples=(6, 6))


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"surface": GRID[:3]}, r"needs 4 points at least along u and along v, got \(3, 6\)"),
        ({"surface": GRID[:, :, :2]}, r"array of shape \(m, n, 3\).*got shape \(6, 6, 2\)"),
        ({"surface": "round"}, "got 'round'"),
        (
            {"surface": np.where(np.arange(6)[:, None, None] == 2, np.nan, GRID)},
            r"point \(2, 0\) of surface is not fin",
        ),
        ({"surface": GRID[[0, 1, 2, 2, 4, 5]]}, r"point \(2, 0\) and the next one along u are the same.*a pole"),
        ({"surface": GRID[[0, 1, 2, 3, 4, 0]], "closed": (True, False)}, "repeats the first one.*leave it out"),
        ({"surface": LINE}, "has no normal at its p"),
        ({"closed": True}, r"a pair \(along u, along v\), such as \(True, False\), got True"),
        ({"radius": -1.0}, "radius of a ball must be a positive number, got -1.0"),
        ({"point2": (0, np.nan, 0)}, "point2 must be three finite numbers"),
        ({"limits": {"w": (0, 1)}}, "there is no coordinate 'w'"),
        ({"limits": {"theta": (0, 1)}}, "angles of a ball"),
    ],
)
def test_bad_surfaces_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        jk.point_on_surface("contact", "table", "arm", **({"surface": GRID, "point2": (0, 0, 0)} | changes))


@pytest.mark.parametrize(
    "function, changes, message",
    [
        (lambda u, v: (u, v), {}, "must take arrays of u and v and return three arrays x, y, z of their shape"),
        (lambda u, v: (u, v, np.zeros(3)), {}, r"of their shape \(40, 40\)"),
        (bowl, {"u": (0, 0)}, r"u must be an interval \(from, to\)"),
        (bowl, {"samples": (3, 40)}, "samples must be two whole numbers of 4 or more"),
        (bowl, {"samples": (40,)}, r"samples must be two whole numbers, of u and v, got \(40,\)"),
        (bowl, {"closed": (True, False)}, "closed along u, but the ends of its interval are 1 apart"),
    ],
)
def test_bad_functions_are_refused(function, changes, message):
    given = {"u": (0.0, 1.0), "v": (0.0, 1.0)} | changes
    with pytest.raises(ValueError, match=message):
        jk.surface_points(function, **given)


def test_what_cannot_be_said_elsewhere_is_refused(tmp_path):
    mechanism = lifted(GRID, bowl(*carried(0.0))[2])
    for write, file in ((jk.write_mjcf, "m.xml"), (jk.write_urdf, "m.urdf"), (jk.write_asmt, "m.asmt")):
        with pytest.raises(ValueError, match="'contact'"):
            write(mechanism, tmp_path / file)
        assert not (tmp_path / file).exists()
    with pytest.raises(ValueError, match=r"no surface of joint 'lift'.*which has none"):
        mechanism.with_points({("lift", "surface"): GRID})
    with pytest.raises(ValueError, match="no profile of joint 'contact'"):
        mechanism.with_points({("contact", "profile"): GRID})
    with pytest.raises(ValueError, match="outside of jit and grad"):
        jax.grad(lambda scale: lifted(scale * GRID, 0.0).joints["contact"].pitch)(1.0)


def test_a_study_says_the_same(tmp_path):
    mechanism = lifted(GRID, 7.0, radius=2.0)
    mechanism = mechanism.close().mechanism if hasattr(mechanism.close(), "mechanism") else mechanism.close()
    jk.write_study(mechanism, tmp_path / "bowl.toml")
    again = jk.load_study(tmp_path / "bowl.toml").mechanism
    one, two = (each.joints["contact"] for each in (mechanism, again))
    assert one.kind == two.kind == "point on surface" and one.curves[0].closed == two.curves[0].closed
    # a ball has no directions of its own, and closing has turned it
    np.testing.assert_allclose(one.frames_1[:, :3, 3], two.frames_1[:, :3, 3], atol=1e-9)
    np.testing.assert_allclose(one.curves[0].start, two.curves[0].start, atol=1e-9)
    assert float(one.curves[0].height) == pytest.approx(float(two.curves[0].height), rel=1e-12)
