"""Derivatives of a sweep with respect to lengths, points, radii and pitch, against the closed forms of `reference`.

The closed forms are numpy code; with `jax.numpy` in its place they are differentiated exactly. Tolerance: 1e-9 of the
largest derivative, as asked for; rounding leaves about 1e-13.
"""

from unittest.mock import patch

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.dimensions.lengths import lengths_now, rearranged
from jaxkin.joints.pairs import revolute, screw
from jaxkin.mechanism.mechanism import Mechanism
from reference import planar, spatial
from reference.mechanisms import (
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    slider_crank,
    spherical_linkage,
)

INPUTS = jnp.linspace(0.1, 5.9, 12)
START = 1.0
WEIGHTS = jnp.cos(jnp.arange(12.0))


def agree(found, expected):
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.max(np.abs(expected)))


def exactly(function):
    """A closed form of `reference` with jax.numpy for numpy."""

    def run(*args):
        with patch.object(planar, "np", jnp), patch.object(spatial, "np", jnp):
            return function(*args)

    return run


BARS = [("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")]
CASES = {
    "slider-crank": (
        lambda: slider_crank(START),
        [("crank", "A", "B"), ("rod", "B", "C")],
        [40.0, 120.0],
        lambda m: m.sweep({"A": INPUTS}).coordinates["S"][:, 0],
        lambda x: planar.slider_crank(START + INPUTS, *x, -20.0).slider,
    ),
    "RSSR": (
        lambda: rssr_linkage(START),
        [("crank", "A", "B"), ("rod", "B", "C"), ("rocker", "D", "C")],
        [30.0, 140.0, 70.0],
        lambda m: m.sweep({"A": INPUTS}).coordinates["D"][:, 0],
        lambda x: spatial.rssr(START + INPUTS, *x).output,
    ),
    "spherical four-bar": (
        lambda: spherical_linkage(START),
        [("coupler", "B", "C", "angle"), ("crank", "A", "B", "angle")],
        [1.1, 0.5],
        lambda m: m.sweep({"A": INPUTS}).coordinates["D"][:, 0],
        lambda x: spatial.spherical_fourbar(START + INPUTS, 1.2, x[1], x[0], 0.9).output,
    ),
    "cam": (
        lambda: cam(START),
        [("touch", "radius"), ("cam", "shaft", "touch")],
        [15.0, 5.0],
        lambda m: m.sweep({"shaft": INPUTS}).coordinates["guide"][:, 0],
        lambda x: x[0] + x[1] * jnp.sin(START + INPUTS),
    ),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name == "slider-crank" else pytest.mark.long) for name in CASES]
)
def test_with_respect_to_lengths(name):
    build, keys, now, output, closed = CASES[name]
    mechanism, now = build(), jnp.array(now)
    listed = [mechanism.lengths[key if key in mechanism.lengths else (key[0], *key[2:0:-1])] for key in keys]
    np.testing.assert_allclose(listed, now, rtol=1e-12)

    def ours(x):
        return output(mechanism.with_lengths(dict(zip(keys, x, strict=True))))

    # one weighting of the poses: a Jacobian in either mode would be compiled for every case
    expected = jax.grad(lambda x: WEIGHTS @ exactly(closed)(x))(now)
    agree(jax.grad(lambda x: WEIGHTS @ ours(x))(now), expected)


@pytest.mark.long
def test_first_derivatives_of_a_fourbar():
    """With respect to its bars, in reverse; a larger change against the closed form itself."""
    mechanism = planar_fourbar(START)
    now = jnp.array([100.0, 40.0, 120.0, 80.0])
    ours, closed = fourbar_rocker(mechanism), exactly(lambda x: planar.fourbar(START + INPUTS, *x).rocker)
    gradient = jax.jit(lambda x: jax.vjp(ours, x)[1](WEIGHTS)[0])
    agree(gradient(now), jax.grad(lambda x: WEIGHTS @ closed(x))(now))
    far = now + jnp.array([-10.0, -6.0, 15.0, 9.0])
    agree(gradient(far), jax.grad(lambda x: WEIGHTS @ closed(x))(far))
    error = ours(far) - closed(far)
    np.testing.assert_allclose(jnp.cos(error - error[0]), 1.0, atol=1e-12)  # both turn fully; the zeros differ


@pytest.mark.long
@pytest.mark.study
def test_all_kinds_of_derivatives_of_a_fourbar():
    """jvp, Hessian both ways round, and the Jacobian in either mode."""
    mechanism = planar_fourbar(START)
    now, direction = jnp.array([100.0, 40.0, 120.0, 80.0]), jnp.array([0.3, -1.0, 0.7, 0.2])
    ours, closed = fourbar_rocker(mechanism), exactly(lambda x: planar.fourbar(START + INPUTS, *x).rocker)
    agree(jax.jvp(ours, (now,), (direction,))[1], jax.jvp(closed, (now,), (direction,))[1])
    agree(jax.jacfwd(ours)(now), jax.jacfwd(closed)(now))
    agree(jax.jacrev(ours)(now), jax.jacfwd(closed)(now))
    expected = jax.hessian(lambda x: WEIGHTS @ closed(x))(now)
    agree(jax.hessian(lambda x: WEIGHTS @ ours(x))(now), expected)
    agree(jax.jacrev(jax.jacfwd(lambda x: WEIGHTS @ ours(x)))(now), expected)


def fourbar_rocker(mechanism):
    """The rocker as a function of the four bars."""
    return lambda x: mechanism.with_lengths(dict(zip(BARS, x, strict=True))).sweep({"A": INPUTS}).coordinates["D"][:, 0]


@pytest.mark.long
def test_with_respect_to_a_shaft_angle_and_inputs_at_once():
    mechanism = cardan_shafts(0.5)

    def ours(angle, inputs):
        return (
            mechanism.with_lengths({("ground", "in", "out", "angle"): angle}).sweep({"in": inputs}).coordinates["out"]
        )

    def closed(angle, inputs):
        return jnp.unwrap(jnp.arctan2(jnp.cos(angle) * jnp.sin(inputs), jnp.cos(inputs)))[:, None]

    # the cross keeps its right angles with both shafts, which stay where the yokes hold them
    for found, expected in zip(
        jax.grad(lambda *x: WEIGHTS @ ours(*x)[:, 0], (0, 1))(0.5, INPUTS),
        jax.grad(lambda *x: WEIGHTS @ closed(*x)[:, 0], (0, 1))(0.5, INPUTS),
        strict=True,
    ):
        agree(found, expected)


@pytest.mark.long
def test_with_respect_to_pitch_and_points():
    """A nut on a screw moves by pitch / 2 pi a radian; a pivot moved along the ground is a longer ground."""
    nut = Mechanism.build(
        fixed=["base"], joints=[screw("s", "base", "nut", point=(0, 0, 0), axis=(0, 0, 1), pitch=2.0)]
    )
    place = lambda pitch: nut.with_lengths({("s", "pitch"): pitch}).sweep({"s": INPUTS}).points("nut", (1, 0, 0))  # noqa: E731
    agree(jax.jacrev(place)(2.0)[:, 2], INPUTS / (2 * np.pi))

    mechanism = planar_fourbar(START)

    def ours(x):
        moved = mechanism.with_points({("ground", "D"): jnp.array([x, 0.0, 0.0])})
        return moved.sweep({"A": INPUTS}).coordinates["D"][:, 0]

    closed = exactly(lambda x: planar.fourbar(START + INPUTS, x).rocker)
    agree(jax.grad(lambda x: WEIGHTS @ ours(x))(100.0), jax.grad(lambda x: WEIGHTS @ closed(x))(100.0))


@pytest.mark.long
def test_gradient_over_a_whole_mechanism_predicts_every_small_change():
    """Moving any frame a little changes the loss by gradient times movement: all leaves, along a random line."""
    mechanism = slider_crank(START)

    def loss(mechanism):
        return jnp.sum(mechanism.sweep({"A": INPUTS}).coordinates["S"] ** 2)

    gradient = jax.grad(loss)(mechanism)
    key = jax.random.PRNGKey(1)
    leaves, tree = jax.tree.flatten(mechanism)
    noise = [jax.random.normal(jax.random.fold_in(key, i), np.shape(leaf)) for i, leaf in enumerate(leaves)]
    for number, leaf in enumerate(leaves):
        if np.ndim(leaf) == 3:  # points of the frames in the plane: rotations stay rotations
            keep = np.zeros((4, 4))
            keep[:2, 3] = 1.0
            noise[number] = noise[number] * keep
        else:
            noise[number] = noise[number] * 0.0
    predicted = sum(jnp.vdot(g, d) for g, d in zip(jax.tree.leaves(gradient), noise, strict=True))

    def along(t):
        return loss(jax.tree.unflatten(tree, [leaf + t * d for leaf, d in zip(leaves, noise, strict=True)]))

    step = 1e-4  # central differences of fourth order: error about step^4, rounding about 1e-16 / step of the loss
    numeric = (8 * (along(step) - along(-step)) - (along(2 * step) - along(-2 * step))) / (12 * step)
    np.testing.assert_allclose(predicted, numeric, rtol=1e-8)


@pytest.mark.long
def test_a_failed_pose_spoils_no_gradient():
    """With a coupler too short for some crank angles the others keep their exact derivative, in reverse too."""
    mechanism = planar_fourbar(START, ground=40.0, crank=20.0, coupler=25.0, rocker=30.0)
    inputs = jnp.linspace(0.0, 3.0, 20)
    key = ("coupler", "B", "C")

    def ours(coupler):
        motion = mechanism.with_lengths({key: coupler}).sweep({"A": inputs})
        return jnp.where(motion.closed, motion.coordinates["D"][:, 0], 0.0)

    closed = np.asarray(mechanism.sweep({"A": inputs}).closed)
    assert 0 < closed.sum() < len(closed)
    exact = jax.jacfwd(exactly(lambda x: planar.fourbar(START + inputs, 40.0, 20.0, x, 30.0).rocker))(25.0)
    slope, reverse = jax.jit(lambda x: (jax.jacfwd(ours)(x), jax.grad(lambda x: jnp.sum(ours(x)))(x)))(25.0)
    agree(slope[closed], exact[closed])
    assert np.all(slope[~closed] == 0)
    np.testing.assert_allclose(reverse, np.sum(exact[closed]), rtol=1e-9)


@pytest.mark.long
def test_one_batch_of_designs():
    """Two hundred couplers in one compiled call, each as the closed form of its own."""
    mechanism = planar_fourbar(START)
    couplers = jnp.linspace(100.0, 130.0, 200)

    @jax.jit
    def rockers(couplers):
        def one(coupler):
            return mechanism.with_lengths({("coupler", "B", "C"): coupler}).sweep({"A": INPUTS}).coordinates["D"][:, 0]

        return jax.vmap(one)(couplers)

    base = planar.fourbar(np.array([START])).rocker
    expected = np.stack([planar.fourbar(START + np.asarray(INPUTS), coupler=c).rocker for c in np.asarray(couplers)])
    np.testing.assert_allclose(np.cos(rockers(couplers) + base - expected), 1.0, atol=1e-13)


@pytest.mark.long
def test_an_unused_joint_has_no_derivative():
    """Of a mechanism with a part that hangs on it freely, lengths of that part do not matter: exactly zero."""
    base = planar_fourbar(START)
    more = Mechanism.build(
        fixed=["ground"],
        joints=[
            *base.all_joints,
            revolute("E", "rocker", "flap", point=(70, 30, 0), axis=(0, 0, 1)),
            revolute("F", "flap", "tip", point=(75, 60, 0), axis=(0, 0, 1)),
        ],
    )
    slope = jax.grad(
        lambda x: jnp.sum(more.with_lengths({("flap", "E", "F"): x}).sweep({"A": INPUTS}).coordinates["D"])
    )(30.0)
    assert slope == 0.0


def test_a_program_holds_the_operations_of_lengths_of_one_kind_once():
    """Four bars are measured, and changed, by hardly more operations than one."""
    mechanism = planar_fourbar(START)
    bars = [("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")]
    now = lengths_now(mechanism.linkage, bars)

    def changed_and_measured(count: int):
        def function(values):
            linkage, _ = rearranged(mechanism.linkage, dict(zip(bars, values, strict=False)))
            return jnp.stack(lengths_now(linkage, bars[:count]))

        return function, jnp.array(now[:count]) * jnp.linspace(1.0, 1.1, count)

    one, four = (
        str(jax.make_jaxpr(function)(values)).count("\n") for function, values in map(changed_and_measured, (1, 4))
    )
    assert four < 2 * one
    function, values = changed_and_measured(4)
    np.testing.assert_allclose(jax.jit(function)(values), values, rtol=1e-14)
