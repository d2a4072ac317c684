"""Faces that meet only along an edge are in no contact; thin but real contacts are."""

import numpy as np

from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere

X, Y, Z = np.eye(3)
ORIGIN = np.zeros(3)
TURN = (-np.pi, np.pi)
FLAT = Plane(ORIGIN, Z)
UNDER = Plane(ORIGIN, -Z)  # its x axis is along `towards`, its y axis then the other way round


def disc(surface: Plane, radii, steps: int, centre=ORIGIN) -> Face:
    """A round plate or ring of the plane z = 0, with as many chords a turn."""
    angles = np.linspace(0, 2 * np.pi, steps + 1)
    inner, outer = (centre + r * np.stack([np.cos(angles), np.sin(angles), 0 * angles], -1) for r in radii)
    triangles = np.concatenate(
        [np.stack([inner[:-1], outer[:-1], outer[1:]], 1), np.stack([inner[:-1], outer[1:], inner[1:]], 1)]
    )
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=-1)
    triangles = triangles[areas > 1e-12]
    return Face("disc", surface, triangles if surface.normal[2] > 0 else triangles[:, ::-1])


def rims(solids):
    """Pairs of faces whose surfaces are in contact, but which meet only along an edge or at a corner."""
    patch = solids.patch
    floor = patch(FLAT, (-3, 3), (-3, 3), X)
    roller = Cylinder(Z, X, 1.0, 1)
    ball = patch(Sphere(ORIGIN, 1.0, 1), TURN, (0, np.pi / 2))
    socket = Sphere(ORIGIN, 1.0, -1)
    bore = patch(Cylinder(ORIGIN, Z, 1.0, -1), TURN, (0, 3))
    pin = Cylinder(ORIGIN, Z, 1.0, 1)
    seat = patch(Cone(ORIGIN, Z, 0.5, -1), TURN, (1, 2))
    return {
        "squares side by side": (patch(FLAT, (0, 1), (0, 1), X), patch(UNDER, (1, 2), (-1, 0), X)),
        "squares corner to corner": (patch(FLAT, (0, 1), (0, 1), X), patch(UNDER, (1, 2), (-2, -1), X)),
        "plate on a hole of its size": (disc(FLAT, (1, 3), 40), disc(UNDER, (0, 1), 31)),
        "fillet beside the floor": (floor, patch(roller, (0, np.pi / 2), (-1, 1), -Z)),
        "roller on the edge of the floor": (patch(FLAT, (-3, 3), (0, 3), X), patch(roller, TURN, (-1, 1), Y)),
        "cone along the edge of the floor": (
            patch(FLAT, (-3, 3), (0, 3), X),
            patch(Cone(ORIGIN, np.cos(0.4) * X + np.sin(0.4) * Z, 0.4, 1), TURN, (0.5, 2)),
        ),
        "ball on the edge of the floor": (
            patch(FLAT, (0, 3), (-3, 3), X),
            patch(Sphere(Z, 1.0, 1), TURN, (-1.5, 1.5), axis=X),
        ),
        "ball on the corner of the floor": (
            patch(FLAT, (0, 3), (0, 3), X),
            patch(Sphere(Z, 1.0, 1), TURN, (-1.5, 1.5), axis=X),
        ),
        "pin at the mouth of its hole": (bore, patch(pin, TURN, (3, 4))),
        "pin and trough edge to edge": (
            patch(Cylinder(ORIGIN, Z, 1.0, -1), (0, 1), (0, 3), X),
            patch(pin, (1, 3), (0, 3), X),
        ),
        "plug at the mouth of its seat": (seat, patch(Cone(ORIGIN, Z, 0.5, 1), TURN, (2, 3))),
        "half ball on half socket": (ball, patch(socket, TURN, (-np.pi / 2, 0), steps=17)),
        "cap on a socket of a smaller opening": (
            patch(Sphere(ORIGIN, 1.0, 1), TURN, (0.8, np.pi / 2), steps=29),
            patch(socket, TURN, (-1, 0.8)),
        ),
        "ball at the mouth of its bore": (bore, patch(Sphere(3 * Z, 1.0, 1), TURN, (-1.5, 1.5), axis=X)),
        "ball on the rim of its seat": (
            seat,
            patch(
                Sphere(np.array([0, 0, 2 / np.cos(0.5) ** 2]), 2 * np.tan(0.5) / np.cos(0.5), 1),
                TURN,
                (-1.5, 1.5),
                axis=X,
            ),
        ),
    }


def check(solids, face1, face2):
    return find_contacts((solids.part("one", face1), solids.part("two", face2)))


def test_an_edge_is_no_contact_but_a_report(solids):
    rng = np.random.default_rng(3)
    for name, faces in rims(solids).items():
        for _ in range(3):
            placed = solids.random_displacement(rng)
            contacts = check(solids, *(solids.moved(face, placed, 10.0) for face in faces))
            assert [str(contact) for contact in contacts] == [], name
            assert [miss.rim for miss in contacts.near_misses] == [True], name
            assert contacts.near_misses[0].reason == "the faces meet only along an edge"


def test_thin_and_small_contacts_are_contacts(solids):
    patch = solids.patch
    floor = patch(FLAT, (-50, 50), (-50, 50), X)
    bore = patch(Cylinder(ORIGIN, Z, 1.0, -1), TURN, (0, 3))
    pin = Cylinder(ORIGIN, Z, 1.0, 1)
    ball = Sphere(Z, 1.0, 1)
    pairs = {
        "a": [
            (floor, patch(UNDER, (-40, 40), (0, 0.2), X)),  # a rail
            (disc(FLAT, (9.6, 12), 48), disc(UNDER, (9, 10), 37)),  # a gasket
            (patch(FLAT, (0, 1), (0, 1), X), patch(UNDER, (0.98, 2), (-1, -0.01), X)),  # a corner
        ],
        "b": [
            (patch(FLAT, (-3, 3), (-0.01, 3), X), patch(Cylinder(Z, X, 1.0, 1), TURN, (-1, 1), Y)),
            (floor, patch(Cylinder(Z, X, 1.0, 1), (-0.01, 1), (-1, 1), -Z)),
            (patch(FLAT, (0.98, 3), (-3, 3), X), patch(Cylinder(Z, X, 1.0, 1), TURN, (-1, 1), Y)),
        ],
        "d": [(patch(FLAT, (-0.01, 3), (-3, 3), X), patch(ball, TURN, (-1.5, 1.5), axis=X))],
        "e": [
            (bore, patch(pin, TURN, (2.98, 4))),
            (bore, patch(pin, (0, 0.02), (1, 2))),
            (bore, patch(pin, (3.0, 3.4), (1, 2))),  # across the seam
        ],
        "k": [(patch(Cone(ORIGIN, Z, 0.5, -1), TURN, (1, 2)), patch(Cone(ORIGIN, Z, 0.5, 1), TURN, (1.98, 3)))],
        "o": [
            (patch(Sphere(ORIGIN, 1.0, 1), TURN, (0, 1.5)), patch(Sphere(ORIGIN, 1.0, -1), TURN, (-1, 0.1), steps=17)),
            (patch(Sphere(ORIGIN, 1.0, 1), TURN, (-1.5, 1.5)), patch(Sphere(ORIGIN, 1.0, -1), (0, 0.1), (0, 0.1))),
        ],
    }  # fmt: skip
    rng = np.random.default_rng(4)
    for letter, cases in pairs.items():
        for number, faces in enumerate(cases):
            placed = solids.random_displacement(rng)
            contacts = check(solids, *(solids.moved(face, placed) for face in faces))
            assert [contact.state for contact in contacts] == [letter], (letter, number)


def test_the_centre_is_the_centroid_of_what_is_shared(solids):
    (contact,) = check(
        solids, solids.patch(FLAT, (0, 2), (0, 1), X), solids.patch(UNDER, (1, 5), (-3, -0.5), X)
    )  # they share 1 < x < 2, 0.5 < y < 1
    np.testing.assert_allclose(contact.centre, [1.5, 0.75, 0], atol=1e-12)
    bore = solids.patch(Cylinder(ORIGIN, Z, 1.0, -1), TURN, (0, 3))
    (contact,) = check(solids, bore, solids.patch(Cylinder(ORIGIN, Z, 1.0, 1), TURN, (2, 7)))
    np.testing.assert_allclose(contact.frames[0, :3, 3], [0, 0, 2.5], atol=1e-4)  # within the length tolerance
    roller = Cylinder(Z, X, 1.0, 1)
    (contact,) = check(solids, solids.patch(FLAT, (0, 2), (-1, 1), X), solids.patch(roller, TURN, (1, 7)))
    np.testing.assert_allclose(contact.frames[:, :3, 3], [[1.5, 0, 0], [1.5, 0, 1]], atol=1e-12)
