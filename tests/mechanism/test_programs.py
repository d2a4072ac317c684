"""A sweep as a JAX program: precision, recompilation, transformations."""

import threading

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.trig import TURN
from jaxkin.joints.pairs import prismatic, revolute
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.sweep import sweep
from jaxkin.solve.execution.compiler import compilations
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status
from reference.mechanisms import cardan_shafts, planar_fourbar, rssr_linkage


@pytest.mark.long
def test_nothing_is_recompiled_for_new_numbers():
    range_ = np.linspace(0.0, 1.0, 37)
    planar_fourbar(1.0).sweep({"A": range_})
    before = compilations()
    planar_fourbar(0.7, crank=35.0).sweep({"A": 2 * range_})
    assert compilations() == before


def test_what_does_not_depend_on_the_values_is_found_once():
    linkage = planar_fourbar(1.0).linkage
    plan = plan_drive(linkage, ("A",))
    assert plan_drive(linkage, ("A",)) is plan
    assert plan_drive(linkage, ("D",)) is not plan


@pytest.mark.long
def test_float32_warns_once_and_reaches_what_it_says():
    import jaxkin.mechanism.sweep as module

    range_ = np.linspace(0.0, 2 * np.pi, 100)
    expected = planar_fourbar(1.0).sweep({"A": range_}).coordinates["D"]
    module._warned = False
    with jax.enable_x64(False):
        with pytest.warns(UserWarning, match="jax_enable_x64"):
            motion = planar_fourbar(1.0).sweep({"A": range_})
        again = planar_fourbar(1.0).sweep({"A": range_})  # a second warning would be an error here
        assert motion.coordinates["D"].dtype == jnp.float32
        assert np.all(motion.closed) and np.all(again.closed)
        assert np.max(motion.residual) < 2e-6
        np.testing.assert_allclose(motion.coordinates["D"], expected, atol=1e-5)


@pytest.mark.long
def test_a_sweep_works_inside_jit_and_vmap():
    range_ = jnp.linspace(0.0, 1.0, 20)

    @jax.jit
    def rocker(mechanism, inputs):
        return mechanism.sweep({"A": inputs}).coordinates["D"][:, 0]

    expected = planar_fourbar(1.0).sweep({"A": range_}).coordinates["D"][:, 0]
    np.testing.assert_allclose(rocker(planar_fourbar(1.0), range_), expected, atol=1e-14)
    fresh = planar_fourbar(1.0)
    captured = jax.jit(lambda inputs: fresh.sweep({"A": inputs}).coordinates["D"][:, 0])(range_)
    outside = fresh.sweep({"A": range_}).coordinates["D"][:, 0]
    np.testing.assert_allclose([captured, outside], [expected, expected], atol=1e-14)
    designs = [planar_fourbar(1.0, crank=crank) for crank in (35.0, 40.0)]
    batch = jax.tree.map(lambda *leaves: jnp.stack(leaves), *designs)
    found = jax.vmap(rocker, in_axes=(0, None))(batch, range_)
    np.testing.assert_allclose(found[1], expected, atol=1e-13)
    other = designs[0].sweep({"A": range_}).coordinates["D"][:, 0]
    np.testing.assert_allclose(found[0], other, atol=1e-13)


def test_a_motion_of_known_numbers_is_a_constant_of_a_traced_function():
    """Nothing that a trace has made is kept with the mechanism: it moves as well afterwards."""
    range_ = np.linspace(0.0, 1.0, 20)
    fresh = planar_fourbar(1.0)
    inside = jax.jit(lambda scale: scale * fresh.sweep({"A": range_}).coordinates["D"][:, 0])(2.0)
    outside = fresh.sweep({"A": range_}).coordinates["D"][:, 0]
    np.testing.assert_array_equal(inside, 2.0 * outside)


@pytest.mark.long
def test_an_optimiser_may_take_mechanism_and_gradient_apart_together():
    """What is no array is the same in both, though these numbers are no RSSR linkage, nor are the zeros."""
    mechanism, range_ = rssr_linkage(), np.linspace(0.0, 1.0, 5)

    @jax.jit
    @jax.value_and_grad
    def loss(mechanism):
        return jnp.sum((mechanism.sweep({"A": range_}).coordinates["D"] - 0.1) ** 2)

    before, gradient = loss(mechanism)
    momentum = jax.tree.map(jnp.zeros_like, mechanism)
    momentum = jax.tree.map(lambda m, g: 0.9 * m + g, momentum, gradient)
    little = 1e-3 * before / sum(jnp.sum(g**2) for g in jax.tree.leaves(gradient))
    better = jax.tree.map(lambda leaf, m: leaf - little * m, mechanism, momentum)
    after, _ = loss(better)
    # downhill the loss falls by the step times the square of the gradient, but for the second order of a thousandth
    np.testing.assert_allclose(1 - after / before, 1e-3, rtol=2e-2)
    assert np.all(better.sweep({"A": range_}).closed)


@pytest.mark.long
def test_designs_in_a_batch_are_found_as_each_alone():
    """Those too that are put off, for limits of their own: a third of these cranks do not go round.

    Other steps of the continuation lead to the same poses: to rounding over the smallest singular value, here 1e-3.
    """
    mechanism, turn = planar_fourbar(1.0), jnp.linspace(0.0, TURN, 12)
    bars = [("ground", "A", "D"), ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")]
    designs = np.array([100.0, 40.0, 120.0, 80.0]) * np.random.default_rng(0).uniform(0.7, 1.3, (70, 4))

    def one(lengths):
        motion = mechanism.with_lengths(dict(zip(bars, lengths, strict=True))).sweep({"A": turn})
        return motion.status, jnp.concatenate(motion.displacements, axis=1)

    # a batch of batches is one batch
    nested = jax.jit(jax.vmap(jax.vmap(one)))(designs.reshape(2, 35, 4))
    status, displacements = (array.reshape(70, *array.shape[2:]) for array in nested)
    alone = jax.jit(one)
    for number, lengths in enumerate(designs):
        expected_status, expected = alone(lengths)
        np.testing.assert_array_equal(status[number], expected_status)
        closed = expected_status == Status.CLOSED.value
        np.testing.assert_allclose(displacements[number][closed], expected[closed], atol=1e-12)
    assert 0.1 < np.mean(np.any(status != Status.CLOSED.value, axis=1)) < 0.5


@pytest.mark.long
@pytest.mark.parametrize("size", [1, 2])
def test_a_small_batch_of_designs_with_several_loop_groups_is_right(size):
    """A ram that lifts a leg, and the leg a platform: two loop groups, of which a compiler got a batch of one wrong."""
    foot, ram = np.array([-1.73, 0.0, -1.08]), np.array([-1.0, 0.0, 0.04])
    along = (ram - foot) / np.linalg.norm(ram - foot)
    y = (0, 1, 0)
    joints = [
        revolute("F", "ground", "leg", point=(-0.5, 0, 0), axis=y),
        revolute("L", "leg", "pin", point=ram, axis=y),
        revolute("Q", "pin", "rod", point=ram - 0.08 * along, axis=along),
        prismatic("P", "rod", "cylinder", axis=along),
        revolute("B", "cylinder", "ground", point=foot, axis=y),
        revolute("U", "leg", "platform", point=(-1.5, 0, 0.08), axis=y),
        revolute("V", "platform", "arm", point=(0.0, 0, 0.08), axis=y),
        revolute("W", "arm", "ground", point=(1.0, 0, 0), axis=y),
    ]
    mechanism = Mechanism.build(fixed=["ground"], joints=joints)
    inputs = np.linspace(0.0, 0.5, 7)
    alone = mechanism.sweep({"F": inputs})
    batch = jax.tree.map(lambda leaf: jnp.stack([jnp.asarray(leaf)] * size), mechanism)
    status, displacements = jax.vmap(lambda one: (lambda m: (m.status, m.displacements))(one.sweep({"F": inputs})))(
        batch
    )
    assert np.all(alone.closed) and np.all(status == Status.CLOSED)
    for found, expected in zip(displacements, alone.displacements, strict=True):
        np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-12)


@pytest.mark.long
def test_nan_in_a_traced_input_is_a_status_and_spoils_no_other_pose():
    mechanism = cardan_shafts()
    inputs = jnp.linspace(0.0, 1.0, 5)
    motion = jax.jit(lambda u: sweep(mechanism, {"in": u}))(inputs.at[2].set(jnp.nan))
    assert list(motion.status) == [Status.CLOSED] * 2 + [Status.NONFINITE] + [Status.CLOSED] * 2
    expected = mechanism.sweep({"in": inputs}).coordinates["out"]
    keep = np.array([0, 1, 3, 4])
    np.testing.assert_allclose(motion.coordinates["out"][keep], expected[keep], atol=1e-13)


def test_nan_in_any_of_several_traced_inputs_is_a_status():
    """An arm of two hinges, in no loop: nothing is solved that could notice."""
    arm = Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("shoulder", "ground", "upper", point=(0, 0, 0), axis=(0, 0, 1)),
            revolute("elbow", "upper", "lower", point=(1, 0, 0), axis=(0, 0, 1)),
        ],
    )
    one, other = jnp.zeros(3).at[0].set(jnp.nan), jnp.zeros(3).at[2].set(jnp.inf)
    status = jax.jit(lambda one, other: sweep(arm, {"shoulder": one, "elbow": other}).status)(one, other)
    assert list(status) == [Status.NONFINITE, Status.CLOSED, Status.NONFINITE]


@pytest.mark.long
def test_programs_of_several_loop_groups_are_compiled_at_the_same_time_and_once():
    """A four-bar and a slider-crank: their poses, and the threads in which their two programs are compiled."""
    mechanism = Mechanism.build(
        fixed=["ground"],
        joints=[
            *planar_fourbar(1.0).all_joints,
            revolute("E", "ground", "crank 2", point=(300, 0, 0), axis=(0, 0, 1)),
            revolute("F", "crank 2", "rod", point=(320, 30, 0), axis=(0, 0, 1)),
            revolute("G", "rod", "slider", point=(410, 10, 0), axis=(0, 0, 1)),
            prismatic("S", "ground", "slider", axis=(1, 0, 0)),
        ],
    )
    compiled = []

    def listen(event: str, duration_secs: float, **about: str | int) -> None:
        del duration_secs
        if event.endswith("backend_compile_duration") and about.get("fun_name") == "jit(_solve)":
            compiled.append(threading.current_thread())

    poses = 299  # no other test has this length: its program is compiled here
    drive = {name: np.linspace(0.0, 0.5, poses) for name in ("A", "E")}
    options = SolverOptions(formulas=False, cores=2)
    jax.monitoring.register_event_duration_secs_listener(listen)
    try:
        motion = mechanism.sweep(drive, options=options)
    finally:
        jax.monitoring.unregister_event_duration_listener(listen)
    assert len(compiled) == 2 and threading.main_thread() not in compiled
    assert np.all(motion.closed)
    by_formulas = mechanism.sweep(drive)
    for name in ("D", "S"):
        np.testing.assert_allclose(motion.coordinates[name], by_formulas.coordinates[name], atol=1e-11)
