"""Several contacts of two parts as one lower pair: kinds by kinematics, and the surfaces themselves as judges."""

import numpy as np
import pytest

from jaxkin.contacts.states import CONTACT_STATES
from jaxkin.geometry.pose import inverse
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere
from jaxkin.joints.combine import combine
from jaxkin.joints.regularise import Noise, regularise
from jaxkin.joints.screws import chain, freedoms
from joints.touching import X, Y, Z, ball, displacement, face, gap, moved, pin, placed, roller, tip, touching

P = np.array([7.0, -4.0, 11.0])
HEXAGON = [np.cos(a) * X + np.sin(a) * Y for a in np.radians([30, 150, 270])]
BORE = (Cylinder(P, Z, 3.0, -1), Sphere(P, 3.0, 1))
SEAT = (Cone(P, Z, 0.5, -1), Sphere(P + 4 * Z, 4 * np.sin(0.5), 1))
PLUG = (Cone(P, Z, 0.5, -1), Cone(P, Z, 0.5, 1))
SWAPPED = ("q", "p")

# contacts, the pair that they amount to, a line on which its axis lies or its centre (None: only the direction, or all)
PAIRS = {
    "face": ([face(P, Z)], "planar", (None, Z)),
    "pin": ([pin(P, Z)], "cylindrical", (P, Z)),
    "ball": ([ball(P)], "spherical", (P, None)),
    "plug in its cone": ([touching(("p", "q"), "k", *PLUG, P)], "revolute", (P, Z)),
    "ball in a conical seat": ([touching(("p", "q"), "n", *SEAT, P, "circle")], "spherical", (P + 4 * Z, None)),
    "pin and shoulder (Fig. 2)": ([pin(P, Z), face([0, 0, 9], Z)], "revolute", (P, Z)),
    "shoulder and pin": ([face([0, 0, 9], -Z), pin(P, Z)], "revolute", (P, Z)),
    "pin with two collars": ([face([0, 0, 9], Z), pin(P, Z), face([0, 0, 2], -Z)], "revolute", (P, Z)),
    "pin in two bearings": ([pin(P, Z), pin(P + 50 * Z, -Z, 5.0)], "cylindrical", (P, Z)),
    "two parallel pins": ([pin(P, Z), pin(P + 20 * X, Z)], "prismatic", (None, Z)),
    "two crossed pins": ([pin(P, Z), pin(P, X)], "fixed", None),
    "two skew pins": ([pin(P, Z), pin(P + 9 * Y, X)], "fixed", None),
    "pin and a face along it": ([pin(P, Z), face(P, X)], "prismatic", (None, Z)),
    "pin and a slanted face": ([pin(P, Z), face(P, X + Z)], "fixed", None),
    "two faces": ([face(P, X), face([0, 0, 3], X + Y)], "prismatic", (None, Z)),
    "slot of two faces": ([face(P, X), face([50, 0, 3], -X)], "planar", (None, X)),
    "triangular rail": ([face(P + 9 * n, n) for n in HEXAGON], "prismatic", (None, Z)),
    "corner of three faces": ([face(P, X), face(P, Y), face(P, Z)], "fixed", None),
    "two balls": ([ball(P), ball(P + 30 * Y)], "revolute", (P, Y)),
    "three balls": ([ball(P), ball(P + 30 * Y), ball(P + 30 * X)], "fixed", None),
    "ball and pin in line": ([ball(P), pin(P + 30 * Y, Y)], "revolute", (P, Y)),
    "ball beside a pin": ([ball(P), pin(P + 30 * Y, Z)], "fixed", None),
    "ball and face": ([ball(P), face([0, 40, 0], Y)], "revolute", (P, Y)),
    "ball in its bore and face across": (
        [touching(("p", "q"), "j", *BORE, P, "circle"), face([0, 0, 5], Z)],
        "revolute",
        (P, Z),
    ),
    "two balls in one bore": (
        [
            touching(("p", "q"), "j", *BORE, P, "circle"),
            touching(("p", "q"), "j", BORE[0], Sphere(P + 9 * Z, 3.0, 1), P, "circle"),
        ],
        "cylindrical",
        (P, Z),
    ),
    "three tips on a plane": ([tip([0, 0, 0], Z), tip([50, 0, 0], Z), tip([0, 40, 0], Z, 5.0)], "planar", (None, Z)),
    "one ball on three planes": (
        [tip(P - 3 * n, n) for n in (X, Y, Z)],
        "spherical",
        (P, None),
    ),
    "two rollers on a plane": ([roller([0, 0, 0], Z, X), roller([0, 50, 0], Z, X)], "planar", (None, Z)),
    "roller in a vee": ([roller(P - 3 * X, X, Z), roller(P - 3 * Y, Y, Z)], "cylindrical", (P, Z)),
    "two pins along one rail, on a face": (
        [roller([0, -3, 0], Y, Z), roller([50, -3, 0], Y, Z), face([0, 0, 0], Z)],
        "prismatic",
        (None, X),
    ),
    "roller in a vee, the second told the other way": (
        [roller(P - 3 * X, X, Z), touching(SWAPPED, "b", Plane(P + 3 * Y, -Y), Cylinder(P, Z, 3.0, 1), P), face(P, Z)],
        "revolute",
        (P, Z),
    ),
    # no lower pair: a slot, and first-order freedoms that finite displacements forbid or that are screws
    "roller": ([roller(P, Z, X)], None, None),
    "pin in a slot, on a face": ([roller([0, -3, 0], Y, Z), roller([0, 3, 0], -Y, Z), face([0, 0, 0], Z)], None, None),
    "three tips on a line": ([tip([x, 0, 0], Z) for x in (0, 30, 70)], None, None),
    "tips against three walls whose normals meet": ([face(P, Z), *(tip(P - 20 * n, n) for n in HEXAGON)], None, None),
    "five tips at large": (
        [
            tip([0, 0, 0], Z),
            tip([60, 9, 4], X + Z),
            tip([5, 70, 2], X - Y),
            tip([9, 4, 80], Y),
            tip([30, 50, 60], X + 2 * Y),
        ],
        None,
        None,
    ),
}


def noise_for(scale: float) -> Noise:
    return Noise(1e-6, 1e-6 * 100 * scale)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("name", PAIRS)
def test_pair(name, scale):
    given, kind, where = PAIRS[name]
    place = displacement(np.random.default_rng(int(scale) + len(name)), 3.0, 100.0)
    contacts = [moved(contact, {"p": place, "q": place}, scale) for contact in given]
    pair = combine(contacts, noise_for(scale))
    assert (pair.kind if pair else None) == kind
    point, axis = where or (None, None)
    if axis is not None:
        # a few roundings of directions of size one
        np.testing.assert_allclose(np.cross(place[:3, :3] @ axis, pair.frame[:3, 2]), 0.0, atol=3e-15)
    if point is not None:
        offset = (place[:3, :3] @ point + place[:3, 3]) * scale - pair.frame[:3, 3]
        if axis is not None:
            offset = np.cross(offset, pair.frame[:3, 2])
        # rounding of positions a few hundred long, through two decompositions
        np.testing.assert_allclose(offset, 0.0, atol=1e-12 * scale)


@pytest.mark.parametrize("name", [name for name, (_, kind, _) in PAIRS.items() if kind])
def test_finite_displacements_of_the_pair_keep_all_surfaces_touching(name):
    rng = np.random.default_rng(5)
    contacts = placed(PAIRS[name][0], rng)
    pair = combine(contacts, noise_for(1.0))
    for _ in range(5):
        # the misfit is measured at a point that stays where it is, so slides stay short of the surfaces' parallels
        q = rng.uniform(-1.0, 1.0, freedoms([pair.movement]))
        there = chain([pair.movement], pair.frame[None], q)[0]
        for contact in contacts:
            wanted = there if contact.parts == contacts[0].parts else inverse(there)
            assert gap(contact, wanted) < 1e-12 * 100


@pytest.mark.parametrize("name", PAIRS)
def test_noise_of_the_reader_changes_no_kind(name):
    given, kind, _ = PAIRS[name]
    for seed in range(2):
        contacts = placed(given, np.random.default_rng(seed), noise=2e-7)
        pair = combine(regularise(contacts, noise_for(1.0)).contacts, noise_for(1.0))
        assert (pair.kind if pair else None) == kind


@pytest.mark.parametrize("name", [name for name, (given, _, _) in PAIRS.items() if len(given) > 1])
def test_order_of_contacts_changes_no_kind(name):
    given, kind, _ = PAIRS[name]
    pair = combine(given[::-1], noise_for(1.0))
    assert (pair.kind if pair else None) == kind


def test_contact_alone_is_a_pair_exactly_where_its_displacements_are_a_group():
    groups = {("a", "surface"), ("e", "surface"), ("k", "surface"), ("o", "surface"), ("n", "circle")}
    assert groups == {(row.letter, row.region) for row in CONTACT_STATES if len(row.movements) == 1}


def test_origin_is_where_the_first_contact_is():
    pair = combine([pin(P, Z), face([0, 0, 50], Z)], noise_for(1.0))
    np.testing.assert_allclose(pair.frame[:3, 3], P, atol=1e-13)


@pytest.mark.parametrize("tilt", [1e-5, 1e-4])
def test_bearings_that_miss_each_other_are_not_made_to_agree(tilt):
    axis = np.cos(tilt) * Z + np.sin(tilt) * X
    pair = combine([pin(P, Z), pin(P + 50 * Z, axis)], noise_for(1.0))
    assert pair.kind == "fixed"
    assert pair.margin < 2 * tilt  # small: the user is told


def test_clear_pairs_have_a_large_margin():
    assert combine([pin(P, Z), face(P, Z)], noise_for(1.0)).margin > 0.1
