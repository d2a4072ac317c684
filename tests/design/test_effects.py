"""Effects as losses and constraints of `optimize`: designs whose answer is known, and errors of those that have none.

Of a slider-crank in line, whose rod keeps its length, torque, acceleration, reactions, losses and pressure angle all
grow with the crank, and its stroke is twice the crank: with a stroke of 60 or more the best crank is 30.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import slider_crank

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
CRANK = ("crank", "A", "B")
ROD = 120.0
PUSH = jk.force("slider", (0.0, 0.0, 0.0), (-100.0, 0.0, 0.0))


def start(crank: float) -> jk.Mechanism:
    return slider_crank(theta=0.0, crank=40.0, rod=ROD, offset=0.0).with_lengths({CRANK: crank})


def torque(motion):
    return jnp.max(jnp.abs(jk.drive_forces(motion, applied=PUSH).forces["A.phi"])) / 1e4


def torque_in_motion(motion):
    own = jk.masses(motion.mechanism, given={"slider": jk.Mass(2.0, (0, 0, 0)), "crank": 0, "rod": 0})
    found = jk.drive_forces(motion, own, applied=PUSH, rates={"A": 3.0})
    return jnp.max(jnp.abs(found.forces["A.phi"])) / 1e4


def acceleration(motion):
    return jnp.max(jnp.abs(jk.accelerations(motion, {"A": 1.0}).coordinates["S"])) / 100


def jerk(motion):
    return jnp.max(jnp.abs(jk.jerks(motion, {"A": 1.0}).coordinates["S"])) / 100


def reaction(motion):
    return jnp.max(jnp.sum(jk.reactions(motion, applied=PUSH).forces["B"] ** 2, axis=1)) / 1e4


def losses(motion):
    rubs = jk.joint_friction("B", 0.1, radius=5.0)
    found = jk.drive_forces(motion, applied=[PUSH, rubs], rates={"A": 1.0}).friction
    return jnp.sum(found.losses["B"]) / 1e3


def pressure_angle(motion):
    return jnp.max(jnp.abs(jk.transmission(motion, "S").angle - jnp.pi / 2))


def stroke(motion):
    """At least 60, over 100."""
    slide = motion.coordinates["S"][:, 0]
    return (jnp.max(slide) - jnp.min(slide) - 60.0) / 100


EFFECTS = [
    torque,
    *(pytest.param(each, marks=pytest.mark.study) for each in (torque_in_motion, acceleration, jerk)),
    *(pytest.param(each, marks=pytest.mark.study) for each in (reaction, losses, pressure_angle)),
]


@pytest.mark.long
@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.__name__)
def test_least_effect_for_a_stroke(effect):
    """To 1e-4: violations of 1e-6 of 100 are allowed."""
    best = jk.optimize(
        effect, start(45.0), drive={"A": TURN}, lengths={CRANK: (20.0, 60.0)}, constraints=[stroke], progress=False
    )
    assert best.feasible and best.moves.everywhere
    assert best.mechanism.lengths[CRANK] == pytest.approx(30.0, abs=1e-3)


@pytest.mark.long
@pytest.mark.study
def test_longest_stroke_with_a_clearance_of_two_and_within_the_limits_of_a_joint():
    """The slider comes as near as rod less crank to the shaft; a wall is at 88, so that the crank is at most 30."""
    home = ROD + 40.0

    def clearance(motion):
        return (motion.points("slider", (home, 0.0, 0.0))[:, 0] - 88.0 - 2.0) / 100

    def length(motion):
        return -jnp.ptp(motion.coordinates["S"][:, 0]) / 100

    best = jk.optimize(
        length, start(25.0), drive={"A": TURN}, lengths={CRANK: (20.0, 60.0)}, constraints=[clearance], progress=False
    )
    assert best.feasible and best.mechanism.lengths[CRANK] == pytest.approx(30.0, abs=1e-3)
    least = np.asarray(best.motion.points("slider", (home, 0.0, 0.0)))[:, 0].min() - 88.0
    assert least == pytest.approx(2.0, abs=1e-3)


@pytest.mark.long
@pytest.mark.study
def test_designs_that_cannot_turn_are_left():
    """At the start the rod is too short to pass the dead points: forces are NaN there, and nanmax passes them by."""
    mechanism = slider_crank(theta=0.0, crank=40.0, rod=50.0, offset=0.0).with_lengths({CRANK: 60.0})
    assert not np.all(mechanism.sweep({"A": TURN}).closed)

    def loss(motion):
        return jnp.nanmax(jnp.abs(jk.drive_forces(motion, applied=PUSH).forces["A.phi"])) / 1e4

    best = jk.optimize(
        loss, mechanism, drive={"A": TURN}, lengths={CRANK: (20.0, 80.0)}, constraints=[stroke], progress=False
    )
    assert best.feasible and best.mechanism.lengths[CRANK] == pytest.approx(30.0, abs=1e-3)


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
