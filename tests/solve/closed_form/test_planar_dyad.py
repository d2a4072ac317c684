"""Formulas of planar dyads: loops that close, on the branch of the assembled pose, right to rounding near limits."""

import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest

from jaxkin.solve.closed_form.planar_dyad import Complex, PlanarLink, link_ends, planar_dyad, signed_root

KINDS = ["RRR", "RRP", "RPR", "PRR", "RPP", "PRP", "PPR"]
EPS = np.finfo(float).eps
solve = jax.jit(planar_dyad, static_argnums=0)


def turning(angle, shift):
    """Matrix of a displacement of the plane."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin, shift[0]], [sin, cos, shift[1]], [0, 0, 1]])


def unknown(kind, place, q):
    """Matrix of an unknown motion: a turn about the point `place`, or a slide along it."""
    if kind == "P":
        return turning(0.0, q * place)
    return turning(0.0, place) @ turning(q, (0, 0)) @ turning(0.0, -place)


def as_complex(vector):
    return Complex(jnp.asarray(vector[0]), jnp.asarray(vector[1]))


def as_link(matrix, begin, end):
    """Turn of a displacement, and the vector from a point to where it takes another one."""
    begin, end = (jnp.array([jnp.ravel(part)[0] for part in point]) for point in (begin, end))
    return PlanarLink(as_complex(matrix[:2, 0]), as_complex(matrix[:2, :2] @ end + matrix[:2, 2] - begin))


def as_links(kinds, places, between):
    ends = link_ends(kinds, places)
    return [as_link(matrix, *each) for matrix, each in zip(between, ends, strict=True)]


def drawn(kinds, seed):
    """An assembled loop, and the same loop after a known joint before the first and one behind the second unknown have
    moved: places, and two lists of matrices."""
    rng = np.random.default_rng(seed)
    places = [rng.normal(size=2) if kind == "R" else turning(rng.uniform(0, 6), (0, 0))[:2, 0] for kind in kinds]
    still = [np.eye(3)] * 3
    moved = [turning(0, (0, 0)), unknown("R", rng.normal(size=2), 0.1), unknown("R", rng.normal(size=2), -0.4)]
    return places, still, moved


def solved(kinds, places, between, sign):
    places = [as_complex(place) for place in places]
    return solve(kinds, places, as_links(kinds, places, between), sign)


def sign_of(kinds, places, between):
    places = [as_complex(place) for place in places]
    return signed_root(kinds, places, as_links(kinds, places, between))


@pytest.mark.long
@pytest.mark.parametrize("kinds", KINDS)
def test_the_loop_closes_on_both_branches_and_is_at_rest_in_the_assembled_pose(kinds):
    reached = 0
    for seed in range(20):
        places, still, moved = drawn(kinds, seed)
        begun = float(sign_of(kinds, places, still))
        rest = solved(kinds, places, still, np.sign(begun))
        np.testing.assert_allclose(
            np.abs(begun), 1.0 if kinds.count("P") == 2 else np.sqrt(rest.discriminant), atol=1e-12
        )
        np.testing.assert_allclose(rest.coordinates, 0.0, atol=200 * EPS / abs(begun))
        for sign in (1.0, -1.0):
            found = solved(kinds, places, moved, sign)
            q, discriminant = found.coordinates, found.discriminant
            if discriminant <= 1e-3:
                continue
            reached += 1
            product = np.eye(3)
            for kind, place, each, known in zip(kinds, places, q, moved, strict=True):
                product = product @ unknown(kind, place, np.asarray(each)) @ known
            # some twenty products of numbers up to ten, over the root of the discriminant
            np.testing.assert_allclose(product, np.eye(3), atol=1e-12)
    assert reached > 20


def near_limit(kinds, seed, wanted):
    """A reachable pose of a dyad whose discriminant is about `wanted`: what is known, between a pose that closes and
    one that does not, is bisected."""
    places, still, _ = drawn(kinds, seed)
    closes, open_ = 0.0, 1.0

    def at(way):
        far = turning(0.3 * way, 50.0 * way * np.array([1.0, -0.7]))
        # what lies between the two turns is a side of the triangle, and may be as long as it likes
        return [far, *still[1:]] if kinds == "RPR" else [*still[:2], far]

    for _ in range(60):
        middle = 0.5 * (closes + open_)
        discriminant = solved(kinds, places, at(middle), 1.0).discriminant
        if wanted / 4 < discriminant < 4 * wanted:
            return places, at(middle)
        closes, open_ = (middle, open_) if discriminant > wanted else (closes, middle)
    raise AssertionError("no limit on the way")


def exact(kinds, places, between, begin):
    """The coordinates in fifty digits, by Newton's method from those of the formula."""

    def turned(angle):
        return mpmath.mpc(mpmath.cos(angle), mpmath.sin(angle))

    angles = [mpmath.atan2(k[1, 0], k[0, 0]) for k in between]

    def misfit(*q):
        turn, point = mpmath.mpf(0), mpmath.mpc(0)
        for kind, place, each, known, angle in zip(kinds, places, q, between, angles, strict=True):
            place = mpmath.mpc(*place)
            if kind == "R":
                point += turned(turn) * (place - turned(each) * place)
                turn += each
            else:
                point += turned(turn) * each * place / abs(place)
            point += turned(turn) * mpmath.mpc(*known[:2, 2])
            turn += angle
        return [mpmath.sin(turn), point.real, point.imag]

    return mpmath.findroot(misfit, [mpmath.mpf(float(each)) for each in begin], tol=1e-60)


@pytest.mark.parametrize("wanted", [1e-3, 1e-7, 1e-11])
@pytest.mark.parametrize("kinds", ["RRR", "RRP", "RPR"])
def test_beside_a_limit_the_error_is_rounding_over_the_root_of_the_discriminant(kinds, wanted):
    for seed in range(4):
        places, between = near_limit(kinds, seed, wanted)
        for sign in (1.0, -1.0):
            found = solved(kinds, places, between, sign)
            q, discriminant = found.coordinates, found.discriminant
            with mpmath.workdps(50):
                error = max(
                    abs(float(float(each) - true))
                    for each, true in zip(q, exact(kinds, places, between, q), strict=True)
                )
            assert error < 100 * EPS / np.sqrt(discriminant)


@pytest.mark.long
@pytest.mark.parametrize("kinds", ["RRR", "RRP"])
def test_out_of_reach_the_discriminant_is_negative_and_nothing_is_nan(kinds):
    places, still, _ = drawn(kinds, 0)
    far = jnp.array([30.0, -40.0])

    def coordinates(shift):
        ends = [as_complex(place) for place in places]
        moved = [*still[:2], jnp.eye(3).at[:2, 2].set(shift)]
        found = planar_dyad(kinds, ends, as_links(kinds, ends, moved), 1.0)
        return jnp.stack(found.coordinates), found.discriminant

    (slopes, _), found = jax.jacfwd(coordinates)(far), coordinates(far)
    assert found[1] < 0
    assert np.all(np.isfinite(found[0])) and np.all(np.isfinite(slopes))
