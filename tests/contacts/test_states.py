"""Tables 1 and 2: every movement keeps its surfaces in contact and spans the freedoms of its state."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.contacts.frames import contact_frames
from jaxkin.contacts.rulings import plane_cone, ruling
from jaxkin.contacts.states import CONTACT_STATES, find_state
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import apply, perpendicular, rotation
from jaxkin.geometry.rigid import as_matrices
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.joint_motion import joint_motion

displacements = jax.jit(joint_motion)

KINDS = ("plane", "cylinder", "cone", "sphere")


def chain(movements, frames, q):
    """Displacements of surface 2 (ERRATA of Table 2) for a batch of q."""
    contact = joint("contact", ("p1", "p2"), JointKind.of_state("a"), movements, frames)
    return np.asarray(as_matrices(displacements(contact, jnp.asarray(q))))


def a_common_point(state, s1, touch):
    """A point of the contact region of two surfaces whose fit has no clearance."""
    if state.region == "circle":
        return touch.point + touch.radius * perpendicular(touch.direction)
    match s1:
        case Cylinder() if state.region == "surface":
            return touch.point + s1.radius * perpendicular(touch.direction)
        case Cone() if state.region == "surface":
            return s1.apex + 2.0 * ruling(s1, perpendicular(s1.axis))
        case Sphere() if state.region == "surface":
            return touch.point + s1.radius * np.array([0.6, 0.0, 0.8])
    return touch.point


def test_the_table_has_all_sixteen_states_and_two_forms_on_a_circle():
    rows = [(state.letter, state.region) for state in CONTACT_STATES]
    assert {letter for letter, _ in rows} >= set("abcdefghijklmnop")
    assert {letter for letter, region in rows if region == "circle"} >= {"j", "n"}
    assert len(rows) == len(set(rows))


def test_every_row_has_a_pair_of_faces(solids):
    assert {(pair.letter, pair.region) for pair in solids.pairs} >= {
        (state.letter, state.region) for state in CONTACT_STATES
    }


@pytest.mark.parametrize("state", CONTACT_STATES, ids=lambda state: f"{state.letter}-{state.region}")
def test_a_row_is_consistent(state):
    assert KINDS.index(state.kinds[0]) <= KINDS.index(state.kinds[1])
    assert len(state.frames) == len(state.movements)
    assert sum(len(MOVEMENTS[movement].coordinates) for movement in state.movements) == state.freedoms
    assert find_state(state.letter, state.region) is state
    if state.kinds[0] == state.kinds[1]:  # equal kinds come in either order
        assert {(b, a) for a, b in state.sides} == set(state.sides)


def test_states_that_do_not_exist_are_refused():
    assert find_state("j").region == find_state("n").region == "point"
    with pytest.raises(ValueError, match="'a' to 'p', got 'q'"):
        find_state("q")
    with pytest.raises(ValueError, match=r"\(b\) has the region 'line', got 'circle'"):
        find_state("b", "circle")


def test_movements_keep_contact_and_span_the_freedoms(pair, solids):
    state = find_state(pair.letter, pair.region)
    rng = np.random.default_rng(7)
    displacement = solids.random_displacement(rng)
    s1, s2 = (solids.moved(face, displacement).surface for face in (pair.face1, pair.face2))
    at = apply(displacement, pair.face2.triangles.mean(axis=(0, 1)))  # on the right side of the apexes
    touch = state.touch(s1, s2, at)
    centre = touch.point + (0.3 * touch.direction if state.region == "line" else 0.0)
    frames = contact_frames(state, s1, s2, touch, centre)

    for displaced in chain(state.movements, frames, rng.uniform(-0.25, 0.25, (20, state.freedoms))):
        moved = s2.moved(displaced)
        touch = state.touch(s1, moved, apply(displaced, at))
        assert abs(touch.gap) < 1e-10 and touch.tilt < 1e-10
        assert touch.clearance is None or abs(touch.clearance) < 1e-12
        # distance and tangency, from the surfaces themselves
        point = a_common_point(state, s1, touch)
        assert abs(s1.distance(point)) < 1e-10 and abs(moved.distance(point)) < 1e-10
        np.testing.assert_allclose(s1.normals(point), -moved.normals(point), atol=1e-10)

    # rank by central differences: their error, 1e-11, is far below the threshold
    q, step = rng.uniform(-0.2, 0.2, state.freedoms), 1e-6 * np.eye(state.freedoms)
    slopes = (chain(state.movements, frames, q + step) - chain(state.movements, frames, q - step)) / 2e-6
    singular = np.linalg.svd(slopes.reshape(state.freedoms, 16), compute_uv=False)
    assert (singular > 1e-3).sum() == state.freedoms


@pytest.mark.parametrize("size", [1e-5, 1e-3])
def test_gaps_are_measured(pair, solids, size):
    """Surface 2 moved off along the common normal is off by as much, to second order."""
    state = find_state(pair.letter, pair.region)
    s1, s2 = pair.face1.surface, pair.face2.surface
    touch = state.touch(s1, s2, np.zeros(3))
    fit = state.is_fit or state.region == "circle"
    away = np.eye(4)
    away[:3, 3] = size * (perpendicular(touch.direction) if fit and touch.direction.any() else touch.normal)
    if pair.letter == "o":
        away[0, 3] = size
    gap = state.touch(s1, s2.moved(away), np.zeros(3)).gap
    across = np.cos(s1.half_angle) if pair.letter == "k" else 1.0  # a cone moved across its axis
    assert gap == pytest.approx(size * across, rel=10 * size)


def test_tilts_are_measured(pair, solids):
    """Surface 2 turned about its contact, across a line or an axis, is tilted by as much."""
    state = find_state(pair.letter, pair.region)
    s1, s2 = pair.face1.surface, pair.face2.surface
    touch = state.touch(s1, s2, np.zeros(3))
    if state.region in ("point", "circle") or pair.letter == "o":
        assert touch.tilt == 0.0  # nothing has to be parallel
        return
    axis = (
        np.cross(touch.normal, touch.direction)
        if state.region == "line"
        else perpendicular(s2.normal if pair.letter == "a" else touch.direction)
    )
    turn = np.eye(4)
    turn[:3, :3] = rotation(axis, 1e-3)
    turn[:3, 3] = touch.point - turn[:3, :3] @ touch.point
    assert state.touch(s1, s2.moved(turn), touch.point).tilt == pytest.approx(1e-3, rel=1e-2)


@pytest.mark.parametrize("off", [0.0, 2e-16, -2e-16])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_cone_that_stands_on_a_plane_does_not_lie_on_it(off, side):
    """No side of the axis is towards a plane across it, though rounding leaves some of the axis there."""
    cone = Cone(np.zeros(3), np.array([0.0, 1.0 + off, 0.0]), 0.45, 1)
    along = ruling(cone, np.array([0.0, side, 0.0]))
    assert np.linalg.norm(along) == pytest.approx(1.0, abs=1e-15)
    assert along[1] == pytest.approx(np.cos(0.45), abs=1e-15)
    assert plane_cone(Plane(np.zeros(3), np.array([0.0, side, 0.0])), cone, np.ones(3)) is None
