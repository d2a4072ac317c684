"""Effects as losses of `optimize`, with a constraint of the motion alone; and errors of those without derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from reference.mechanisms import slider_crank

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
CRANK = ("crank", "A", "B")
ROD = 120.0
PUSH = jk.force("slider", (0.0, 0.0, 0.0), (-100.0, 0.0, 0.0))


def start(crank: float) -> jk.Mechanism:
    return slider_crank(theta=0.0, crank=40.0, rod=ROD, offset=0.0).with_lengths({CRANK: crank})


def torque(motion):
    return jnp.max(jnp.abs(jk.drive_forces(motion, applied=PUSH).forces["A.phi"])) / 1e4


def stroke(motion):
    """At least 60, over 100."""
    slide = motion.coordinates["S"][:, 0]
    return (jnp.max(slide) - jnp.min(slide) - 60.0) / 100


@pytest.mark.long
@pytest.mark.study
def test_less_peak_torque_for_a_stroke():
    """The torque falls with the crank: the best one has just the stroke asked for, and is half of it.

    A stroke of 60 is met to 1e-6 of the size of 100 that the constraint is divided by: cranks differ by half of that.
    """
    best = jk.optimize(
        torque, start(45.0), drive={"A": TURN}, lengths={CRANK: (20.0, 60.0)}, constraints=[stroke], progress=False
    )
    assert best.feasible and best.moves.everywhere
    assert best.mechanism.lengths[CRANK] == pytest.approx(30.0, abs=1e-4)
    assert best.value == pytest.approx(float(torque(start(30.0).sweep({"A": TURN}))), rel=1e-5)


@pytest.mark.long
@pytest.mark.study
def test_the_longest_stroke_within_a_limit_is_the_range_that_limits_find():
    """A slide that ends at x = 90 lets a crank of 30 turn past its dead point, ROD - 30, and no longer one."""
    end = 90.0

    def short(motion):
        return -design.stroke(motion, "S") / 100

    # displacements are counted from the pose that was drawn, with a crank of 40
    within = design.above("S", end - 40.0 - ROD, size=100.0)
    best = jk.optimize(
        short, start(22.0), drive={"A": TURN}, lengths={CRANK: (15.0, 60.0)}, constraints=[within], progress=False
    )
    assert best.feasible
    crank = best.mechanism.lengths[CRANK]
    assert crank == pytest.approx(30.0, abs=1e-4)
    for own, turns in ((crank - 0.01, True), (crank + 0.01, False)):
        drawn = slider_crank(theta=0.0, crank=own, rod=ROD, offset=0.0)
        assert jk.limits(drawn, "A", ranges={"S": (end - own - ROD, np.inf)}).full_turn == turns


@pytest.mark.long
def test_what_cannot_be_met_is_named_with_its_size():
    """A stroke of 60 asks for a crank of 30, and 25 are the most: 10 of 100 are lacking."""

    def loss(motion):
        return jnp.mean(motion.coordinates["S"][:, 0] ** 2) / 1e4

    best = jk.optimize(
        loss, start(22.0), drive={"A": TURN}, lengths={CRANK: (20.0, 25.0)}, constraints=[stroke], progress=False
    )
    assert not best.feasible and best.violation == pytest.approx(0.1, abs=1e-6)
    assert "infeasible by 0.1" in str(best)
    assert "violates constraint 0 (stroke) by up to 0.1: give more starts, wider bounds" in str(best)


@pytest.mark.long
def test_effects_that_are_found_on_the_host_say_so_where_numbers_are_traced():
    """An error that names the effect, and not a number without a derivative."""
    mechanism = slider_crank(theta=0.0, offset=0.0)
    said = []

    def each(turn):
        motion = mechanism.sweep({"A": turn})
        moved = jax.tree.map(lambda leaf: leaf + 0.0 * turn[0], mechanism)
        for call in (
            lambda: jk.clashes(motion),
            lambda: jk.contact_validity(motion),
            lambda: jk.swept_volume(motion, "rod"),
            lambda: jk.coupler_curve(motion, "rod", (0.0, 0.0, 0.0)),
            lambda: jk.limits(moved, "A"),
            lambda: jk.assembly_modes(moved, {"A": 0.0}),
            lambda: jk.workspace(moved, {"A": [0.0, 1.0], "B": [0.0, 1.0]}, "rod", (0.0, 0.0, 0.0)),
            lambda: jk.equilibrium(moved, {"A": TURN}),
            motion.check,
        ):
            with pytest.raises(ValueError, match="jit, vmap and grad") as error:
                call()
            said.append(str(error.value))
        return turn

    jax.eval_shape(each, jnp.asarray(TURN))
    assert len(said) == 9
