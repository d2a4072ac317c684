"""The closure equations that users may put into optimisers of their own."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.catalogue import jansen
from reference.mechanisms import Z, planar_fourbar, rssr_linkage


def at_random(mechanism, size, rng):
    return {joint.name: size * rng.standard_normal(joint.freedoms) for joint in mechanism.all_joints}


@pytest.mark.long
@pytest.mark.parametrize("make", [planar_fourbar, jansen, rssr_linkage])
def test_the_assembled_pose_is_closed_and_the_jacobian_is_the_derivative(make):
    mechanism, rng = make(), np.random.default_rng(3)
    at_rest = mechanism.closure({})
    assert at_rest.residual.shape == (12 * len(mechanism.structure.loops),)
    assert np.abs(at_rest.residual).max() < 1e-14  # rounding of a few products
    q, direction = at_random(mechanism, 0.3, rng), at_random(mechanism, 1.0, rng)
    step = 1e-6  # rounding over it, and its square, are both 1e-10 and less
    there, back = (
        mechanism.closure({name: q[name] + sign * step * direction[name] for name in q}).residual for sign in (1, -1)
    )
    along = np.concatenate([direction[joint.name] for joint in mechanism.all_joints])
    assert np.allclose(mechanism.closure(q).jacobian @ along, (there - back) / (2 * step), atol=1e-8)


@pytest.mark.long
def test_a_four_bars_loop_is_open_by_the_chord_of_its_crank():
    """The crank alone is turned by t: all behind it turns with it about the first hinge."""
    mechanism, t = planar_fourbar(), 0.2
    found = mechanism.closure({"A": t})
    origins = np.array([joint.frames_1[0, :3, 3] for joint in mechanism.all_joints])
    centre = origins.mean(axis=0)
    length = np.sqrt(((origins - centre) ** 2).sum(axis=1).mean())
    chord = 2 * np.sin(t / 2) * np.linalg.norm(centre - origins[0])
    assert np.isclose(np.linalg.norm(found.residual[9:]) * length, chord, rtol=1e-12)
    assert np.isclose(np.linalg.norm(found.residual[:9]), 2 * np.sqrt(2) * np.sin(t / 2), rtol=1e-12)
    assert found.coordinates == ("A.phi", "B.phi", "C.phi", "D.phi")


@pytest.mark.long
def test_the_norm_is_the_residual_of_the_solver():
    """Of poses that cannot close, with loops of two sizes and a joint in no loop."""
    lengths = {"ground": 40.0, "crank": 20.0, "coupler": 25.0, "rocker": 30.0}
    small, large = (
        planar_fourbar(1.0, **{name: k * length for name, length in lengths.items()}).all_joints for k in (1, 9)
    )
    beside = [
        jk.revolute(
            f"{each.name}2",
            *(part if part == "ground" else f"{part}2" for part in each.parts),
            point=each.frames_1[0, :3, 3],
            axis=Z,
        )
        for each in large
    ]
    arm = jk.revolute("arm", "rocker", "arm", point=(5e3, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=[*small, *beside, arm])
    motion = mechanism.sweep({"A": np.full(2, 2.0), "A2": np.array([0.1, 3.0])})
    assert np.all(motion.status == jk.Status.UNREACHABLE)
    for pose, residual in enumerate(motion.residual):
        at = {name: rows[pose] for name, rows in motion.coordinates.items()}
        assert np.isclose(np.linalg.norm(mechanism.closure(at).residual), residual, rtol=1e-9)


@pytest.mark.long
def test_newton_steps_of_ones_own_lead_to_the_pose_of_the_sweep():
    """Gauss-Newton steps with `closure`, the crank held, inside `jit`."""
    mechanism = planar_fourbar()
    motion = mechanism.sweep({"A": jnp.array([0.0, 0.4])})
    swept = {name: rows[1] for name, rows in motion.coordinates.items()}
    assert np.linalg.norm(mechanism.closure(swept).residual) < 1e-13

    @jax.jit
    def step(free):
        found = mechanism.closure({"A": 0.4, "B": free[0], "C": free[1], "D": free[2]})
        return free - jnp.linalg.lstsq(found.jacobian[:, 1:], found.residual)[0]

    free = jnp.zeros(3)
    for _ in range(8):
        free = step(free)
    assert np.allclose(free, [swept[name][0] for name in "BCD"], atol=1e-12)


def test_the_result_may_leave_jit_and_be_kept_in_a_set():
    mechanism = planar_fourbar()
    here = mechanism.closure({"A": 0.2})
    inside = jax.jit(lambda t: mechanism.closure({"A": t}))(0.2)
    assert inside.coordinates == here.coordinates
    np.testing.assert_allclose(inside.residual, here.residual, atol=1e-15)  # rounding of a few products
    assert len({here, inside, here}) == 2 and here == here != inside
    residual, jacobian, coordinates = here
    assert (
        residual is here.residual and jacobian is here.jacobian and coordinates == ("A.phi", "B.phi", "C.phi", "D.phi")
    )


def test_wrong_coordinates_are_named():
    with pytest.raises(ValueError, match=r"no joint 'E'"):
        planar_fourbar().closure({"E": 0.1})
    with pytest.raises(ValueError, match=r"joint 'A' \(revolute\) has 1 coordinates.*got \(0.1, 0.2\)"):
        planar_fourbar().closure({"A": (0.1, 0.2)})
